#pragma once
// What goes on, on a terminal; silent in a pipe.

#include <string>

#include "base/listener.hpp"

namespace driftwright::app {

/// One line on standard error that is rewritten as work goes on and erased at the end.
class Progress {
 public:
  /// @param quiet  shows nothing on a terminal either
  explicit Progress(bool quiet = false);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Names the work now begun.
  void begin(const std::string& work);
  /// Share of it that is done, 0 to 1.
  void update(double share);
  /// Hears of all that is done. Must not outlive this.
  [[nodiscard]] Listener listener();
  /// Erases the line; call before anything else is printed.
  void end();

 private:
  bool on_terminal_;
  std::string work_;
  int shown_percent_ = -1;
};

}  // namespace driftwright::app
