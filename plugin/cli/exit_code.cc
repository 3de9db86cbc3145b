#include "exit_code.h"

#include <cstdio>

namespace lacerta::cli {

const char kExitCodeHelp[] =
    "Exit codes:\n"
    "  0  done\n"
    "  1  usage: options that make no sense; nothing was written\n"
    "  2  bad input: a file is damaged or exceeds the limits; nothing was written\n"
    "  3  unsupported: a legal file that this version does not handle; nothing was written\n"
    "  4  input/output: a file is missing, or reading or writing failed; nothing was written\n"
    "  5  target missed: the best possible output was written, but it does not meet the target\n"
    "  6  internal error: please report it\n"
    "  7  several files: some failed, as told for each; the others are done\n";

int Finish(const Status& status) {
  if (status.ok()) return kExitOk;
  std::fprintf(stderr, "lacerta: error: %s\n", status.message().c_str());
  switch (status.code()) {
    case StatusCode::kOk:
      return kExitOk;
    case StatusCode::kInvalidArgument:
      return kExitUsage;
    case StatusCode::kInvalidData:
    case StatusCode::kLimitExceeded:
      return kExitBadInput;
    case StatusCode::kUnsupported:
      return kExitUnsupported;
    case StatusCode::kNotFound:
    case StatusCode::kIoError:
      return kExitIo;
    case StatusCode::kInternal:
      return kExitInternal;
  }
  return kExitInternal;
}

}  // namespace lacerta::cli
