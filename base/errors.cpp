#include "base/errors.hpp"

#include <fmt/format.h>

#include "base/delimited_text.hpp"

namespace driftwright {
namespace {

std::string render(const Where& where, const std::string& message) {
  std::string text = clean_name(where.file);
  if (where.line > 0) text += fmt::format(":{}:{}", where.line, where.column);
  text += ": " + message;
  if (!where.key.empty()) text += fmt::format(" [{}]", where.key);
  if (where.line > 0 && !where.excerpt.empty()) {
    text += fmt::format("\n{:5} | {}\n      | {:>{}}", where.line, where.excerpt, '^', where.column);
  }
  return text;
}

}  // namespace

InputError::InputError(const Where& where, const std::string& message) : std::runtime_error(render(where, message)) {}

}  // namespace driftwright
