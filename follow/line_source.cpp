#include "follow/line_source.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "base/errors.hpp"

namespace driftwright::follow {
namespace {

constexpr std::size_t kLongestSourceLine = 1'000'000;  // a longer line is cut, and is no row

}  // namespace

LineSource::Got LineSource::next(std::string& line, double wait_s) {
  for (;;) {
    if (const std::size_t end = rest_.find('\n', begin_); end != std::string::npos) {
      line.assign(rest_, begin_, end - begin_);
      begin_ = end + 1;
      if (begin_ == rest_.size()) {
        rest_.clear();
        begin_ = 0;
      }
      return Got::kLine;
    }
    if (at_end_) {
      if (begin_ >= rest_.size()) return Got::kEnd;
      line.assign(rest_, begin_);
      rest_.clear();
      begin_ = 0;
      return Got::kLine;
    }
    if (begin_ > 0) {
      rest_.erase(0, begin_);
      begin_ = 0;
    }
    if (rest_.size() > kLongestSourceLine) {
      line = std::move(rest_);
      rest_ = {};
      return Got::kLine;
    }
    pollfd wanted{.fd = file_, .events = POLLIN, .revents = 0};
    const int n_ready = ::poll(&wanted, 1, static_cast<int>(1000.0 * wait_s) + 1);
    if (n_ready == 0 || (n_ready < 0 && errno == EINTR)) return Got::kNothingYet;
    std::array<char, 65536> bytes;
    const ssize_t n = n_ready < 0 ? -1 : ::read(file_, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) return Got::kNothingYet;
    if (n < 0) throw InputError(fmt::format("{}: {}", name_, std::strerror(errno)));
    if (n == 0) at_end_ = true;
    rest_.append(bytes.data(), static_cast<std::size_t>(n));
  }
}

}  // namespace driftwright::follow
