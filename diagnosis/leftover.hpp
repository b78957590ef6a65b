#pragma once
// Tests whether the residual of a fit is more than noise.

#include "diagnosis/fit.hpp"

namespace driftwright::diagnosis {

/// The part of a channel's residual that smooth curves can follow, compared with that of noise.
struct Leftover {
  std::string channel, unit;
  double squares = 0.0;  ///< of the whitened residual along the curves; n_curves for pure noise
  double n_curves = 0.0;
  double rms = 0.0;           ///< of that part, in the channel's SI unit
  double jump_squares = 0.0;  ///< reduction of the whitened squares by the best single step at any row
  double jump = 0.0;          ///< size of that step, in the same unit
  [[nodiscard]] double sigmas() const;
};
/// One entry per channel, over all runs, worst first. @param noise  by channel
[[nodiscard]] std::vector<Leftover> leftovers(const std::vector<MeasuredRun>& runs, const Prediction& prediction,
                                              const std::map<std::string, NoiseModel>& noise);
/// Over all channels.
[[nodiscard]] double sigmas(const std::vector<Leftover>& leftovers);

}  // namespace driftwright::diagnosis
