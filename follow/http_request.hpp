#pragma once
// The head of an HTTP request (RFC 9112), as far as a page of one program has to know it.

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace driftwright::follow {

struct HttpRequest {
  std::string method;                                        ///< "GET"
  std::string path;                                          ///< "/events", decoded, without what stands behind the `?`
  std::vector<std::pair<std::string, std::string>> query;    ///< names and values, decoded
  std::vector<std::pair<std::string, std::string>> headers;  ///< names in small letters
};

/// @param head  up to the empty line, with or without it. @return none for what is no request of HTTP/1.0 or 1.1, or names two hosts
[[nodiscard]] std::optional<HttpRequest> read_request(std::string_view head);

/// Of a header or a parameter of the query; "" where there is none, the first of several.
[[nodiscard]] std::string value_of(const std::vector<std::pair<std::string, std::string>>& pairs, std::string_view name);

}  // namespace driftwright::follow
