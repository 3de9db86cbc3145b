#include "progress.h"

#include <unistd.h>

#include <cstdio>

namespace lacerta::cli {

bool StdoutIsTerminal() { return isatty(STDOUT_FILENO) == 1; }

ProgressLine::ProgressLine() : terminal_(isatty(STDERR_FILENO) == 1), start_(std::chrono::steady_clock::now()) {}

ProgressLine::~ProgressLine() {
  if (shown_) std::fprintf(stderr, "\r\033[K");
}

std::function<void(double share, const char* stage)> ProgressLine::Callback() {
  if (!terminal_) return {};
  return [this](double share, const char* stage) { Show(share, stage); };
}

void ProgressLine::Show(double share, const char* stage) {
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  std::fprintf(stderr, "\r\033[K%3.0f %%  %s", 100.0 * share, stage);
  constexpr double kLeastShare = 0.02;  // before, an estimate says nothing
  if (share > kLeastShare && share < 1.0) std::fprintf(stderr, "  (%.0f s left)", seconds * (1.0 - share) / share);
  std::fflush(stderr);
  shown_ = true;
}

}  // namespace lacerta::cli
