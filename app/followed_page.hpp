#pragma once
// The page of a followed stream: what stands on it before the first row.

#include <string>

#include "app/follow.hpp"
#include "follow/page_server.hpp"
#include "follow/session.hpp"

namespace driftwright::app {

/// Where `--serve`, `--bind` and `--token` say. @pre options.serve @throws InputError  where nobody may listen so
[[nodiscard]] follow::PageAddress page_address(const FollowVerbOptions& options);

/// The page: the machine of a scenario among the models, where there is one that can be drawn.
[[nodiscard]] std::string followed_page(const FollowVerbOptions& options, const follow::Session& session);

/// What it shows of a line that was said just now.
[[nodiscard]] follow::PageRow page_row(const follow::Session& session, const follow::FollowLine& line);

}  // namespace driftwright::app
