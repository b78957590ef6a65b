#pragma once
// Is what a fit leaves over more than noise?

#include "diagnosis/fit.hpp"

namespace driftwright::diagnosis {

/// The part of a channel's residual that smooth curves can follow, against what noise has of it.
struct Leftover {
  std::string channel, unit;
  double squares = 0.0;  ///< of the whitened residual on the curves: n_curves where there is only noise
  double n_curves = 0.0;
  double rms = 0.0;  ///< of that part, in the channel's SI unit
  [[nodiscard]] double sigmas() const;
};
/// One entry a channel, all runs together.
[[nodiscard]] std::vector<Leftover> leftovers(const Fitter& fitter, const Fit& fit);
/// All channels together.
[[nodiscard]] double sigmas(const std::vector<Leftover>& leftovers);

}  // namespace driftwright::diagnosis
