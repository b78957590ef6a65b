#pragma once
// Whoever waits for long work.

#include <functional>
#include <string>

namespace driftwright {

/// Is told what is being done and how much of it is, and may ask for an end. Each may be left out.
struct Listener {
  std::function<void(const std::string& work)> on_begin = {};
  std::function<void(double share)> on_share = {};  ///< 0 to 1; never called by two threads at once
  std::function<bool()> wants_end_now = {};         ///< from any thread; once true, it stays so

  void begin(const std::string& work) const {
    if (on_begin) on_begin(work);
  }
  void share(double done) const {
    if (on_share) on_share(done);
  }
  /// What is known so far is all that is still wanted.
  [[nodiscard]] bool wants_end() const { return wants_end_now && wants_end_now(); }
  /// One that may ask for an end and is told of nothing: of work that is part of other work.
  [[nodiscard]] Listener within() const { return {.on_begin = {}, .on_share = {}, .wants_end_now = wants_end_now}; }
};

}  // namespace driftwright
