#pragma once
// Ctrl-C during long work: the results so far are kept and written.

#include <csignal>

namespace driftwright::app {

/// While this object exists, the first SIGINT (Ctrl-C) or SIGTERM only sets a flag; the next one ends the program as
/// usual. Only one object may exist at a time.
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
