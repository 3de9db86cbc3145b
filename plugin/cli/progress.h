// A line of progress on a terminal; nothing anywhere else.
#ifndef LACERTA_CLI_PROGRESS_H_
#define LACERTA_CLI_PROGRESS_H_

#include <chrono>
#include <functional>

namespace lacerta::cli {

bool StdoutIsTerminal();

class ProgressLine {
 public:
  ProgressLine();
  ~ProgressLine();  // clears the line
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  // For EncodeOptions::progress; must not outlive this object. Empty when stderr is no terminal.
  std::function<void(double share, const char* stage)> Callback();

 private:
  void Show(double share, const char* stage);

  bool terminal_;
  bool shown_ = false;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace lacerta::cli

#endif  // LACERTA_CLI_PROGRESS_H_
