// Seeds of the fuzz targets, for the tests of the mutator.
#ifndef LACERTA_TESTS_FUZZ_READ_SEED_H_
#define LACERTA_TESTS_FUZZ_READ_SEED_H_

#include <fstream>
#include <iterator>
#include <string>

#include "lacerta/mesh.h"

namespace lacerta::fuzz {

// name: "target/file"
inline Bytes ReadSeed(const std::string& name) {
  std::ifstream in(std::string(LACERTA_FUZZ_SEEDS_DIR) + "/" + name, std::ios::binary);
  return Bytes(std::istreambuf_iterator<char>(in), {});
}

}  // namespace lacerta::fuzz

#endif  // LACERTA_TESTS_FUZZ_READ_SEED_H_
