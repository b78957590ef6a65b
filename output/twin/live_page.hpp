#pragma once
// The page beside a running machine: its picture, coloured by the rows of a stream (docs/how-to/follow.md). All numbers
// come from the stream.

#include <optional>
#include <string>
#include <vector>

#include "output/twin/page_parts.hpp"

namespace driftwright::output {

struct LivePage {
  std::string name = {}, subtitle = {};
  std::string note = {};  ///< says what is not shown; "": none
  std::string made_by = {};
  double reference_degC = 20.0;
  std::optional<TwinSurface> surface = {};
  std::vector<PictureMark> marks = {};      ///< on the surface
  std::optional<TwinNetwork> network = {};  ///< for a machine of lumped nodes
};

/// The text of the HTML file. It requests `events` from its own address, with the same query; names are inserted as text,
/// never as markup.
[[nodiscard]] std::string live_html(const LivePage& page);

}  // namespace driftwright::output
