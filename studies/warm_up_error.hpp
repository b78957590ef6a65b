#pragma once
// Warm-ups of machines that differ from the model: the share of the tolerance that must be kept free so that nearly all
// of them stay within it.

#include "studies/warm_up_trials.hpp"

namespace driftwright::studies {

/// Machines that differ from the model: each heat source, film, joint and link times exp(sigma N(0, 1)).
class DrawnMachines {
 public:
  /// @param trials  must outlive this @param first_seed  of the first machine; the others use the following seeds
  DrawnMachines(const WarmUpTrials& trials, double sigma, int first_seed, int n)
      : trials_(trials), sigma_(sigma), first_seed_(first_seed), n_(n) {}

  [[nodiscard]] int n() const { return n_; }
  /// Peaks of the job after each programme on each machine [um], n_programmes x n().
  [[nodiscard]] Eigen::MatrixXd peaks_um(const std::vector<std::vector<Cyclogram::Section>>& programmes,
                                         const Listener& listener) const;
  /// Number of machines on which the job stays within a tolerance.
  [[nodiscard]] int n_kept(const std::vector<Cyclogram::Section>& programme, double tolerance_um,
                           const Listener& listener) const;

 private:
  const WarmUpTrials& trials_;
  double sigma_;
  int first_seed_, n_;
};

/// Share of drawn machines on which a programme must keep the tolerance: the goal is 95 of 100, plus a margin for the
/// sampling error of 200 draws.
inline constexpr double kKeptOfDraws = 0.97;
inline constexpr int kDraws = 200;

/// The share of the tolerance that a programme must keep free on the unchanged model: found from the shortest warm-up at
/// one speed after which a share kKeptOfDraws of the drawn machines stays within the whole tolerance. None if no time up
/// to the limit is enough.
[[nodiscard]] std::optional<double> free_share(const WarmUpTrials& trials, const DrawnMachines& machines, double speed_rpm,
                                               double most_s, double tolerance_um, const Listener& listener);

}  // namespace driftwright::studies
