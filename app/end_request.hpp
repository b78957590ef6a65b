#pragma once
// Ctrl-C in work whose results so far are worth having.

#include <csignal>

namespace driftwright::app {

/// While it lives, the first SIGINT (Ctrl-C) or SIGTERM asks for an end; the next one ends the program as ever. One at a time.
class EndRequest {
 public:
  EndRequest();
  ~EndRequest();
  EndRequest(const EndRequest&) = delete;
  EndRequest& operator=(const EndRequest&) = delete;

  [[nodiscard]] static bool is_made();

 private:
  struct sigaction interrupt_before_ {
  }, terminate_before_{};
};

}  // namespace driftwright::app
