#include "follow/state_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "base/bounded_json.hpp"
#include "base/file_bytes.hpp"
#include "base/hashed_json.hpp"
#include "follow/state_json.hpp"

namespace driftwright::follow {

void write_state(const std::filesystem::path& file, const Session& session) {
  const std::string text = compact_text(with_hash(session.state())) + "\n", partial = file.string() + ".partial";
  const auto fail = [&] {
    const int why = errno;
    (void)::unlink(partial.c_str());
    throw InputError(fmt::format("--state {}: {}", file.string(), std::strerror(why)));
  };
  const int f = ::open(partial.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (f < 0) fail();
  for (std::size_t written = 0; written < text.size();) {
    const ssize_t n = ::write(f, text.data() + written, text.size() - written);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) {
      const int why = errno;
      (void)::close(f);
      errno = why;
      fail();
    }
    written += static_cast<std::size_t>(n);
  }
  if (::fsync(f) != 0) {
    const int why = errno;
    (void)::close(f);
    errno = why;
    fail();
  }
  if (::close(f) != 0 || ::rename(partial.c_str(), file.c_str()) != 0) fail();
}

bool resume_from(const std::filesystem::path& file, Session& session) {
  if (!std::filesystem::exists(file)) return false;
  if (!std::filesystem::is_regular_file(file))  // the rename in write_state() would replace it
    throw InputError(
        fmt::format("--state {}: a folder, device or pipe of this name exists; it must be a file", file.string()));
  try {
    const Json j = parse_json(read_bytes(file));
    if (!is_whole(j)) throw InputError("key `hash` does not fit what the file holds: it is damaged");
    session.recall(j);
  } catch (const nlohmann::json::exception& e) {
    throw InputError(fmt::format("--state {}: {}", file.string(), e.what()));
  } catch (const InputError& e) {
    throw InputError(fmt::format("--state {}: {}. Without that file `follow` begins anew", file.string(), e.what()));
  }
  return true;
}

}  // namespace driftwright::follow
