#include "follow/http_request.hpp"

#include <algorithm>
#include <charconv>

#include "base/characters.hpp"

namespace driftwright::follow {
namespace {

using Pairs = std::vector<std::pair<std::string, std::string>>;

/// Cuts off and returns the text before a mark, and removes the mark; all text if there is no mark.
std::string_view cut(std::string_view& text, std::string_view mark) {
  const std::size_t at = text.find(mark);
  const std::string_view before = text.substr(0, at);
  text = at == std::string_view::npos ? std::string_view() : text.substr(at + mark.size());
  return before;
}

std::string decoded(std::string_view text, bool plus_is_space) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned code = 0;
    const char* const digits = text.data() + i + 1;
    if (text[i] == '%' && i + 2 < text.size() && std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2) {
      plain += static_cast<char>(code);
      i += 2;
    } else {
      plain += plus_is_space && text[i] == '+' ? ' ' : text[i];
    }
  }
  return plain;
}

Pairs read_query(std::string_view text) {
  Pairs query;
  while (!text.empty()) {
    std::string_view value = cut(text, "&");
    const std::string name = decoded(cut(value, "="), true);
    query.emplace_back(name, decoded(value, true));
  }
  return query;
}

std::string small(std::string_view text) {
  std::string s(text);
  for (char& c : s) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return s;
}

}  // namespace

std::optional<HttpRequest> read_request(std::string_view head) {
  std::string_view line = cut(head, "\r\n");
  HttpRequest request;
  request.method = cut(line, " ");
  std::string_view target = cut(line, " ");
  if (request.method.empty() || !target.starts_with('/') || (line != "HTTP/1.1" && line != "HTTP/1.0")) return std::nullopt;
  request.path = decoded(cut(target, "?"), false);
  request.query = read_query(target);
  for (line = cut(head, "\r\n"); !line.empty(); line = cut(head, "\r\n")) {
    const std::string name = small(cut(line, ":"));
    // No space may precede the colon (RFC 9112): another program might read the header differently.
    if (name.empty() || name.find_first_of(" \t") != std::string::npos) return std::nullopt;
    request.headers.emplace_back(name, trimmed(line));
  }
  const auto is_host = [](const auto& h) { return h.first == "host"; };
  if (std::count_if(request.headers.begin(), request.headers.end(), is_host) > 1) return std::nullopt;
  return request;
}

std::string value_of(const Pairs& pairs, std::string_view name) {
  const auto at = std::find_if(pairs.begin(), pairs.end(), [&](const auto& p) { return p.first == name; });
  return at == pairs.end() ? "" : at->second;
}

}  // namespace driftwright::follow
