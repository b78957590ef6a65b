#include "base/errors.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/delimited_text.hpp"

namespace driftwright {
namespace {

constexpr std::size_t kShown = 160, kShownBefore = 100;  // bytes shown of a source line, and of them before the column

/// A source line with a caret below the column; of a long line the part around it.
std::string excerpt_of(const Where& where) {
  const std::string& line = where.excerpt;
  const auto is_inside = [&](std::size_t at) {
    return at < line.size() && (static_cast<unsigned char>(line[at]) & 0xC0u) == 0x80u;
  };
  const std::size_t at = std::min(static_cast<std::size_t>(std::max(where.column, 1)) - 1, line.size());
  std::size_t from = line.size() > kShown && at > kShownBefore ? at - kShownBefore : 0;
  while (is_inside(from)) ++from;
  std::size_t until = std::min(from + kShown, line.size());
  while (is_inside(until)) --until;
  const std::string before = from > 0 ? "..." : "", behind = until < line.size() ? "..." : "";
  return fmt::format("\n{:5} | {}{}{}\n      | {:>{}}", where.line, before, line.substr(from, until - from), behind, '^',
                     before.size() + at - from + 1);
}

std::string render(const Where& where, const std::string& message) {
  std::string text = clean_name(where.file);
  if (where.line > 0) text += fmt::format(":{}:{}", where.line, where.column);
  text += ": " + message;
  if (!where.key.empty()) text += fmt::format(" [{}]", where.key);
  if (where.line > 0 && !where.excerpt.empty()) text += excerpt_of(where);
  return text;
}

}  // namespace

InputError::InputError(const Where& where, const std::string& message) : std::runtime_error(render(where, message)) {}

}  // namespace driftwright
