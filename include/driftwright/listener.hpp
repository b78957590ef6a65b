#pragma once
// Callbacks for long work: progress, and a request to end early.

#include <functional>
#include <string>

namespace driftwright {

/// Receives the name of the work and its progress, and may request an end. Each callback may be left out.
struct Listener {
  std::function<void(const std::string& work)> on_begin = {};  ///< called when a piece of work begins
  std::function<void(double share)> on_share = {};             ///< progress, 0 to 1; never called by two threads at once
  std::function<bool()> wants_end_now = {};                    ///< called from any thread; must stay true once it is true

  void begin(const std::string& work) const {
    if (on_begin) on_begin(work);
  }
  void share(double done) const {
    if (on_share) on_share(done);
  }
  /// True: end now, and return what is known so far.
  [[nodiscard]] bool wants_end() const { return wants_end_now && wants_end_now(); }
  /// A listener that forwards only the request to end: for work that is a part of other work.
  [[nodiscard]] Listener within() const { return {.on_begin = {}, .on_share = {}, .wants_end_now = wants_end_now}; }
};

}  // namespace driftwright
