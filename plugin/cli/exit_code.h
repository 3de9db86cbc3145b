// What the command ends with: stable numbers that scripts may rely on.
#ifndef LACERTA_CLI_EXIT_CODE_H_
#define LACERTA_CLI_EXIT_CODE_H_

#include "lacerta/status.h"

namespace lacerta::cli {

enum ExitCode {
  kExitOk = 0,
  kExitUsage = 1,         // options that make no sense
  kExitBadInput = 2,      // a file that breaks its format or the limits
  kExitUnsupported = 3,   // a legal file that this version does not handle
  kExitIo = 4,            // a file that is missing, or reading or writing failed
  kExitTargetMissed = 5,  // the best possible output was written, but it misses the target
  kExitInternal = 6,      // a bug of ours
  kExitSomeFailed = 7,    // of several files some failed; the others are done
};

// The table above as text for --help.
extern const char kExitCodeHelp[];

// Prints "lacerta: error: ..." to stderr where the status is not ok; returns the exit code for it.
int Finish(const Status& status);

}  // namespace lacerta::cli

#endif  // LACERTA_CLI_EXIT_CODE_H_
