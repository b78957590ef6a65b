#include "app/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace driftwright::app {

Progress::Progress(bool quiet) : on_terminal_(!quiet && isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  end();
}

void Progress::end() {
  if (on_terminal_ && !work_.empty()) fmt::print(stderr, "\r\033[K");
  work_.clear();
}

Listener Progress::listener() {
  return {.on_begin = [this](const std::string& work) { begin(work); },
          .on_share = [this](double share) { update(share); },
          .wants_end_now = {}};
}

void Progress::begin(const std::string& work) {
  work_ = work;
  shown_percent_ = -1;
  update(0.0);
}

void Progress::update(double share) {
  const int percent = static_cast<int>(100.0 * share);
  if (!on_terminal_ || percent == shown_percent_) return;
  shown_percent_ = percent;
  fmt::print(stderr, "\r\033[K{} ...{}", work_, percent == 0 ? "" : fmt::format(" {} %", percent));
  std::fflush(stderr);
}

}  // namespace driftwright::app
