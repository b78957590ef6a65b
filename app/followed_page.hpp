#pragma once
// The page of a followed stream: what it shows before the first row, and with each row.

#include <string>

#include "app/follow.hpp"
#include "follow/page_server.hpp"
#include "follow/session.hpp"

namespace driftwright::app {

/// The address from `--serve`, `--bind` and `--token`. @pre options.serve
/// @throws InputError  for a token file without a token, and for an address that may not be used without one
[[nodiscard]] follow::PageAddress page_address(const FollowVerbOptions& options);

/// The HTML page. It draws the machine of the first model that can be drawn, if there is one.
[[nodiscard]] std::string followed_page(const FollowVerbOptions& options, const follow::Session& session);

/// The row that the page shows for the line just written.
[[nodiscard]] follow::PageRow page_row(const follow::Session& session, const follow::FollowLine& line);

}  // namespace driftwright::app
