#pragma once
// The head of an HTTP request (RFC 9112), as far as a server of one page needs it.

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace driftwright::follow {

struct HttpRequest {
  std::string method;                                        ///< "GET"
  std::string path;                                          ///< "/events", decoded, without the query after the `?`
  std::vector<std::pair<std::string, std::string>> query;    ///< names and values, decoded
  std::vector<std::pair<std::string, std::string>> headers;  ///< names in lower case
};

/// @param head  up to the empty line, with or without it
/// @return none for text that is no request of HTTP/1.0 or 1.1, or that names two hosts
[[nodiscard]] std::optional<HttpRequest> read_request(std::string_view head);

/// The value of a header or a query parameter, the first of several; "" if there is none.
[[nodiscard]] std::string value_of(const std::vector<std::pair<std::string, std::string>>& pairs, std::string_view name);

}  // namespace driftwright::follow
