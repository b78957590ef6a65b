#pragma once
// The range that a reduced model must cover: the size of its inputs, and the range of its coefficients.

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

  /// Extends this demand to cover another one of the same balance.
  void include(const ReductionDemand& other);
  /// Sets of coefficients to build the basis for: the middle, and if any coefficient varies also all low and all high.
  [[nodiscard]] std::vector<Eigen::VectorXd> points() const;
};

/// Demand of some cyclograms and standstill. Laws that depend on temperatures are evaluated from 2 K to 40 K above the
/// ambient.
///
/// Numbers are rounded outwards to powers of two, except for coefficients that never change. So cyclograms with similar
/// demands share one reduced model, and the choice does not depend on earlier runs.
[[nodiscard]] ReductionDemand reduction_demand(const effects::HeatBalance& balance,
                                               const std::vector<const Cyclogram*>& cyclograms, const TimeSeries& ambient,
                                               double reference_K);

}  // namespace driftwright::solver
