#pragma once
// Serves the page of a stream over HTTP: `/` the page, `/events` its rows as Server-Sent Events. It runs in a thread of
// its own, with a lower priority than the stream.

#include <memory>
#include <string>

#include "follow/page_feed.hpp"

namespace driftwright::follow {

struct PageAddress {
  std::string host = "127.0.0.1";
  int port = 8080;    ///< 0: any that is free
  std::string token;  ///< required of each request, as `?token=` or `Authorization: Bearer`; "": none, on loopback only
};
/// @throws InputError  for an address beyond loopback without a token, a token of less than 16 characters, or an invalid
/// port
void require_safe(const PageAddress& address);

/// Whether two words are equal; the run time depends on the length of `given` alone.
[[nodiscard]] bool is_same_token(const std::string& given, const std::string& token);

class PageServer {
 public:
  /// Starts to listen. @param html  the page
  /// @throws InputError  as require_safe(), and if it cannot listen there
  PageServer(const PageAddress& address, std::string html);
  ~PageServer();
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;

  /// Sets the channels of the stream; call it before its first row.
  void begin(const std::vector<Channel>& channels);
  [[nodiscard]] PageFeed& feed();
  /// "http://127.0.0.1:8080/", without the token.
  [[nodiscard]] std::string url() const;

 private:
  struct Running;
  std::unique_ptr<Running> running_;
};

}  // namespace driftwright::follow
