#pragma once
// Shows progress on a terminal; silent in a pipe.

#include <string>

#include "base/listener.hpp"

namespace driftwright::app {

/// One line on standard error that is rewritten as work proceeds and erased at the end.
class Progress {
 public:
  /// @param quiet  show nothing on a terminal either
  explicit Progress(bool quiet = false);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Starts a new piece of work with this name.
  void begin(const std::string& work);
  /// Sets the share of it that is done, 0 to 1.
  void update(double share);
  /// A listener that feeds this line. It must not outlive this object.
  [[nodiscard]] Listener listener();
  /// Erases the line; call before anything else is printed.
  void end();

 private:
  bool on_terminal_;
  std::string work_;
  int shown_percent_ = -1;
};

}  // namespace driftwright::app
