#include "app/end_request.hpp"

#include <unistd.h>

#include <atomic>
#include <string_view>

namespace driftwright::app {
namespace {

std::atomic<bool> made = false;
static_assert(std::atomic<bool>::is_always_lock_free);  // else no handler may touch it

constexpr std::string_view kHeard =
    "\nending; what is known so far will be written (once more ends at once and writes nothing)\n";

void ask(int) {
  made = true;
  (void)!write(STDERR_FILENO, kHeard.data(), kHeard.size());
}

}  // namespace

EndRequest::EndRequest() {
  made = false;
  struct sigaction once {};
  once.sa_handler = ask;
  once.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &once, &interrupt_before_);
  sigaction(SIGTERM, &once, &terminate_before_);
}

EndRequest::~EndRequest() {
  sigaction(SIGINT, &interrupt_before_, nullptr);
  sigaction(SIGTERM, &terminate_before_, nullptr);
}

bool EndRequest::is_made() {
  return made;
}

}  // namespace driftwright::app
