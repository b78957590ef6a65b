#pragma once
// The page of a stream over HTTP: `/` the page, `/events` what it shows as Server-Sent Events. In a thread of its own, below that of the stream.

#include <memory>
#include <string>

#include "follow/page_feed.hpp"

namespace driftwright::follow {

struct PageAddress {
  std::string host = "127.0.0.1";
  int port = 8080;    ///< 0: any that is free
  std::string token;  ///< asked of each request, as `?token=` or `Authorization: Bearer`; "": none, on loopback alone
};
/// @throws InputError  for an address beyond loopback without a token, a token of less than 16 characters, a port that is none
void require_safe(const PageAddress& address);

/// Whether two words are the same; how long it takes depends on the length of `given` alone.
[[nodiscard]] bool is_same_token(const std::string& given, const std::string& token);

class PageServer {
 public:
  /// Begins to listen. @param html  the page
  /// @throws InputError  as require_safe(), and where nobody can listen there
  PageServer(const PageAddress& address, std::string html);
  ~PageServer();
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;

  /// Of the stream, before its first row.
  void begin(const std::vector<Channel>& channels);
  [[nodiscard]] PageFeed& feed();
  /// "http://127.0.0.1:8080/", without the token.
  [[nodiscard]] std::string url() const;

 private:
  struct Running;
  std::unique_ptr<Running> running_;
};

}  // namespace driftwright::follow
