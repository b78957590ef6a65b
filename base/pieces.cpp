#include "base/pieces.hpp"

#include <fmt/format.h>

#include "base/errors.hpp"

namespace driftwright {

Shard read_shard(const std::string& text) {
  if (text.empty()) return {};
  const std::size_t slash = text.find('/');
  const std::string first = text.substr(0, slash), second = slash == std::string::npos ? "" : text.substr(slash + 1);
  const auto is_count = [](const std::string& word) {
    return !word.empty() && word.size() <= 7 && word.find_first_not_of("0123456789") == std::string::npos;
  };
  if (is_count(first) && is_count(second)) {
    const Shard shard{std::stoul(first), std::stoul(second)};
    if (shard.number >= 1 && shard.number <= shard.of) return shard;
  }
  throw InputError(fmt::format("--shard '{}' must be i/n with 1 <= i <= n, such as 3/8", text));
}

Pieces Pieces::from(std::size_t first) const {
  Pieces counted = *this;
  if (find) counted.find = [first, all = find](std::size_t piece) { return all(first + piece); };
  if (keep) counted.keep = [first, all = keep](std::size_t piece, const Numbers& numbers) { all(first + piece, numbers); };
  return counted;
}

}  // namespace driftwright
