// For the programs of this folder: what cannot go on without a result.
#ifndef LACERTA_TESTS_BENCH_MUST_H_
#define LACERTA_TESTS_BENCH_MUST_H_

#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>

#include "lacerta/status.h"

namespace lacerta {

// The value of a result. Without one the program ends, having told why; what: the file or mesh concerned.
template <typename T>
T Must(StatusOr<T> result, const std::string& what) {
  if (result.ok()) return std::move(result).value();
  std::fprintf(stderr, "%s: %s\n", what.c_str(), result.status().message().c_str());
  std::exit(1);
}

}  // namespace lacerta

#endif  // LACERTA_TESTS_BENCH_MUST_H_
