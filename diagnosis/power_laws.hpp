#pragma once
// Heat that follows speed, as power laws.

#include <vector>

#include "effects/effect.hpp"

namespace driftwright::diagnosis {

struct PowerLaw {
  double power_W = 0.0;  ///< at the stated speed
  double exponent = 1.0;
};
struct PowerLaws {
  std::vector<PowerLaw> terms;  ///< whose sum it is; none where it follows no power of speed
  double deviation = 0.0;       ///< largest relative one at the speeds that were asked about
};

/// The heat of an effect as one or two power laws where it is such a sum (a bearing's two torques, a loss and its idle part); else the one
/// with the same power and growth at the stated speed.
/// @param effect     whose first heat looks at the speed alone
/// @param speeds_rpm  where the deviation is looked at, all > 0
[[nodiscard]] PowerLaws power_laws(const effects::Effect& effect, double at_speed_rpm,
                                   const std::vector<double>& speeds_rpm);

}  // namespace driftwright::diagnosis
