#pragma once
// Is what a fit leaves over more than noise?

#include "diagnosis/fit.hpp"

namespace driftwright::diagnosis {

/// The part of a channel's residual that smooth curves can follow, against what noise has of it.
struct Leftover {
  std::string channel, unit;
  double squares = 0.0;  ///< of the whitened residual on the curves: n_curves where there is only noise
  double n_curves = 0.0;
  double rms = 0.0;           ///< of that part, in the channel's SI unit
  double jump_squares = 0.0;  ///< what the best single step at any row would take off the whitened squares
  double jump = 0.0;          ///< size of that step, in the same unit
  [[nodiscard]] double sigmas() const;
};
/// One entry a channel, all runs together, worst first. @param noise  by channel
[[nodiscard]] std::vector<Leftover> leftovers(const std::vector<MeasuredRun>& runs, const Prediction& prediction,
                                              const std::map<std::string, NoiseModel>& noise);
/// All channels together.
[[nodiscard]] double sigmas(const std::vector<Leftover>& leftovers);

}  // namespace driftwright::diagnosis
