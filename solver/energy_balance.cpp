#include "solver/energy_balance.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/errors.hpp"

namespace driftwright::solver {
namespace {

constexpr double kLargestGap = 0.01;  // of the exchanged heat
constexpr double kSlack_K = 0.01;     // of the whole machine: with almost no heat flow the gap consists of rounding

}  // namespace

void require_balance(const Trajectory& run, double capacity_J_K) {
  const Eigen::Index n = run.heat_J.cols();
  if (n == 0) return;
  double in_J = 0.0, turned_over_J = 0.0;
  for (std::size_t j = 0; j < run.flows.size(); ++j) {
    if (run.flows[j].kind == FlowKind::kInternal) continue;
    in_J += run.heat_J(static_cast<Eigen::Index>(j), n - 1);
    turned_over_J += 0.5 * std::abs(run.heat_J(static_cast<Eigen::Index>(j), n - 1));
  }
  const double stored_J = run.stored_J[n - 1];
  turned_over_J += 0.5 * std::abs(stored_J);
  if (std::abs(in_J - stored_J) <= kLargestGap * turned_over_J + kSlack_K * capacity_J_K) return;
  throw SolveError(fmt::format(
      "the heat does not balance: {:.4g} J went in and {:.4g} J are stored after {:.6g} s, of {:.4g} J turned over; "
      "{:.0f} % and {:g} K of the machine are allowed. The model's files may be damaged; a finer `relative_tolerance` under "
      "`solver` helps where heat capacity follows temperature",
      in_J, stored_J, run.time_s.empty() ? 0.0 : run.time_s.back(), turned_over_J, 100.0 * kLargestGap, kSlack_K));
}

}  // namespace driftwright::solver
