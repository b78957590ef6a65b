#include "base/file_name.hpp"

#include <algorithm>

#include "base/delimited_text.hpp"
#include "base/file_bytes.hpp"

namespace driftwright {
namespace {

constexpr std::size_t kHash = 16, kLongestEnding = 64;

/// The first bytes of a text, at most `most`, cut between two letters.
std::string whole_letters(const std::string& text, std::size_t most) {
  if (text.size() <= most) return text;
  while (most > 0 && (static_cast<unsigned char>(text[most]) & 0xC0U) == 0x80U) --most;
  return text.substr(0, most);
}

}  // namespace

std::string file_name(const std::string& stem, const std::string& ending) {
  const std::string last = clean_name(ending);
  if (last.size() > kLongestEnding) return file_name(stem + ending, "");
  std::string name = clean_name(stem);
  if (name.size() + last.size() > kLongestFileName)
    name = whole_letters(name, kLongestFileName - kHash - 1 - last.size()) + "_" + content_hash(stem).substr(0, kHash);
  name += last;
  std::replace(name.begin(), name.end(), '/', '_');
  return name.empty() || name == "." || name == ".." ? "_" + name : name;
}

}  // namespace driftwright
