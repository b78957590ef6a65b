#pragma once
// What a reduced model will be asked: how strong its inputs get, and between which values its coefficients move.

#include <Eigen/Core>
#include <vector>

#include "base/cyclogram.hpp"
#include "effects/heat_balance.hpp"

namespace driftwright::solver {

/// Sources in the order of HeatBalance::heats; exchanges in that of assemble_heat(): films, links, contacts.
struct ReductionDemand {
  Eigen::VectorXd power_W;    ///< largest magnitude of each source
  Eigen::VectorXd low, high;  ///< of each exchange's coefficient [W/(m^2 K)] or [W/K]
  double ambient_K = 1.0;     ///< largest magnitude of the ambient temperature over the reference
  double duration_s = 0.0;    ///< of the longest cyclogram

  /// Widens this demand to meet another one of the same balance, too.
  void include(const ReductionDemand& other);
  /// Sets of coefficients to hold at: the middle, and where some coefficient moves also all low and all high.
  [[nodiscard]] std::vector<Eigen::VectorXd> points() const;
};

/// Demand of some cyclograms and standstill. Laws that look at temperatures are taken from 2 K to 40 K above the ambient.
///
/// Numbers are rounded outwards to powers of two, but for coefficients that never move: so cyclograms that ask nearly the same share one
/// reduced model, and which one does not depend on what has been run before.
[[nodiscard]] ReductionDemand reduction_demand(const effects::HeatBalance& balance,
                                               const std::vector<const Cyclogram*>& cyclograms, const TimeSeries& ambient,
                                               double reference_K);

}  // namespace driftwright::solver
