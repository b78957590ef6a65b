#pragma once
// How far each of several numbers moves one result, as horizontal bars about its middle: a tornado. An <svg> element.

#include <string>
#include <vector>

namespace driftwright::output {

struct TornadoPicture {
  std::string unit = {};  ///< of the result, as shown to people; under the axis
  double middle = 0.0;    ///< the result with all numbers at their means
  struct Bar {
    std::string label = {};              ///< the number
    double at_low = 0.0, at_high = 0.0;  ///< the result at its lower and upper end
    std::string low = {}, high = {};     ///< these ends, as text
  };
  std::vector<Bar> bars = {};  ///< from the top
};

/// Each bar is in two colours, one for each end of its number, which is written beside it. Colour-blind readers can
/// distinguish them. @throws std::logic_error  without bars, and for a value that is not finite
[[nodiscard]] std::string draw_tornado(const TornadoPicture& picture);

}  // namespace driftwright::output
