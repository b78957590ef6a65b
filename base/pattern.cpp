#include "base/pattern.hpp"

#include "base/errors.hpp"

namespace driftwright {

Pattern::Pattern(const char* expression) {
  if (regcomp(&compiled_, expression, REG_EXTENDED) != 0)
    throw RangeError(std::string("no regular expression: ") + expression);
}

Pattern::~Pattern() {
  regfree(&compiled_);
}

std::optional<std::vector<std::string>> Pattern::find(const std::string& text) const {
  std::vector<regmatch_t> at(compiled_.re_nsub + 1);
  if (regexec(&compiled_, text.c_str(), at.size(), at.data(), 0) != 0) return std::nullopt;
  std::vector<std::string> parts;
  for (const regmatch_t& part : at) parts.push_back(part.rm_so < 0 ? "" : text.substr(part.rm_so, part.rm_eo - part.rm_so));
  return parts;
}

}  // namespace driftwright
