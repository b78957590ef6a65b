#pragma once
// The page beside a running machine: its picture, which rows of a stream then colour (docs/how-to/follow.md). What it shows comes by the stream alone.

#include <optional>
#include <string>
#include <vector>

#include "output/twin/page_parts.hpp"

namespace driftwright::output {

struct LivePage {
  std::string name = {}, subtitle = {};
  std::string note = {};  ///< a sentence on what is not shown; "": none
  std::string made_by = {};
  double reference_degC = 20.0;
  std::optional<TwinSurface> surface = {};
  std::vector<PictureMark> marks = {};      ///< of the surface
  std::optional<TwinNetwork> network = {};  ///< of a machine of lumped nodes
};

/// The text of the HTML file. It asks `events` beside itself, with the query that it was opened with; names are text and never markup.
[[nodiscard]] std::string live_html(const LivePage& page);

}  // namespace driftwright::output
