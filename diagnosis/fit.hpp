#pragma once
// The most probable numbers of a hypothesis, and its evidence.
//
//     Φ(x) = 1/2 |W (y - f(x))|² + Σ ρ_i(x_i / sd_i),    log Z ≈ -Φ(x̂) - 1/2 log det(S (J'J + B⁻²) S),   S = diag(sd)
//
// x: every uncertain number of the scenario (scatter) and those of the hypothesis. W: whitening. J: slopes of W f at x̂.
// ρ(u): of scatter u²/2, normal; of a claim's numbers 5/2 log(1 + u²/5), Student's t of 4 degrees of freedom, scaled so that
// near 0 it is u²/2 as well: what size a fault usually has is known roughly, and one far beyond it is not drawn back. B:
// widths of the normal priors that draw x̂ to zero as much, sd² B⁻² = ρ'(u)/u, which is positive everywhere where ρ'' is
// not. The second term of log Z is what more freedom costs: Laplace's approximation of the marginal likelihood, with B⁻² in
// the place of the priors' curvature.
// Source: MacKay, Neural Computation 4 (1992) 415-447; Gauss-Newton with step control.

#include <memory>
#include <optional>

#include "base/listener.hpp"
#include "diagnosis/candidates.hpp"
#include "diagnosis/comparison.hpp"

namespace driftwright::diagnosis {

/// What is claimed: some effects with their knobs.
struct Claim {
  std::size_t candidate = 0;  ///< which of the list
  std::size_t variant = 0;
  std::vector<Knob> knobs;
  bool all_or_nothing = false;
  double price_nats = 0.0;  ///< as Variant has it
  bool happens = false;     ///< the same
};
using Hypothesis = std::vector<Claim>;
/// The knobs of a hypothesis, claim by claim.
[[nodiscard]] std::vector<const Knob*> knobs_of(const Hypothesis& hypothesis);
/// Of each of them, whether it is turned by slopes; one that is not keeps the value of the fit's start.
[[nodiscard]] std::vector<char> smooth_knobs(const Hypothesis& hypothesis);
/// Logarithm of how many rows the jumps of a claim could have happened at [nats].
[[nodiscard]] double price_of_times(const Claim& claim);

/// Width of the normal prior that draws a claim's number to zero as much as its own does, and what its own costs [nats].
[[nodiscard]] double heavy_tailed_width(double prior_sd, double x);
[[nodiscard]] double heavy_tailed_cost(double prior_sd, double x);

/// What is left of a hypothesis without some of its claims.
struct Remainder {
  Hypothesis hypothesis;
  std::vector<Eigen::Index> x;  ///< which of the whole one's x it keeps: scatter, linear columns, knobs of the claims left
};
[[nodiscard]] Remainder without_claims(const Hypothesis& hypothesis, const std::vector<std::size_t>& claims,
                                       Eigen::Index n_nuisance);

struct Fit {
  Eigen::VectorXd x;         ///< scatter, then linear columns, then the knobs of each claim
  Eigen::VectorXd residual;  ///< W (y - f)
  Prediction prediction;
  double log_evidence = -1e300;
  double misfit = 0.0;         ///< Φ
  Eigen::MatrixXd covariance;  ///< of x, by Laplace; times and cables that are no slopes have none
  Eigen::MatrixXd slopes;      ///< of W f by x, columns of claims; those of scatter are the fitter's
  [[nodiscard]] Eigen::VectorXd claim_x(Eigen::Index n_nuisance) const { return x.tail(x.size() - n_nuisance); }
};

/// Fits hypotheses to runs. Scatter's slopes are taken once at the scenario's numbers and once again by settle().
class Fitter {
 public:
  /// @param linear    further columns [per run: n_outputs x n_times] with an unknown amplitude of standard deviation 1
  /// @param listener  told how many of scatter's slopes are there; its wish for an end is not heard
  Fitter(const Twin& twin, const std::vector<MeasuredRun>& runs, std::vector<Knob> scatter, std::vector<Prediction> linear,
         const Listener& listener = {});

  /// The same with other readings: some of them left out, the noise as it is, where there is one. @param runs  with the same
  /// rows, the missing ones NaN; outlive it
  Fitter(const Fitter& other, const std::vector<MeasuredRun>& runs);

  /// Further columns with an unknown amplitude of standard deviation 1; the noise is to be set anew.
  void add_linear(const std::vector<Prediction>& columns);
  /// How well one of scatter's numbers is known: 1 sigma of its prior.
  void set_prior_sd(std::size_t number, double prior_sd) { scatter_.at(number).prior_sd = prior_sd; }
  /// Largest distance of scatter's numbers from the scenario's values. A number that is further off is a fault, and
  /// statements look for it.
  void hold_within(double sigmas) { most_sigmas_ = sigmas; }
  /// Whitens anew. @param noise  by channel. @param shared  what channels of a run have together; empty: nothing
  void set_noise(const std::map<std::string, NoiseModel>& noise, std::shared_ptr<const SharedNoise> shared = {});
  /// Takes scatter's slopes at a fit of a hypothesis: later fits of others start there.
  void settle(const Hypothesis& hypothesis, const Fit& at);

  /// Scatter's slopes of the last settle(); or recomputed where a fit has moved far.
  enum class Slopes { kKept, kTakenAnew };
  /// @param start  x of the claims, in order; scatter starts where it was last settled
  /// @throws SolveError  when the machine has no solution there
  [[nodiscard]] Fit fit(const Hypothesis& hypothesis, const Eigen::VectorXd& start, Twin::Workspace& workspace) const;
  /// The most probable other numbers while one keeps its value. @param start  all of x  @param held  which of x keeps its
  /// value
  [[nodiscard]] Fit fit_others(const Hypothesis& hypothesis, const Eigen::VectorXd& start, Eigen::Index held,
                               Twin::Workspace& workspace, Slopes slopes = Slopes::kTakenAnew) const;

  /// Scatter and linear columns of the last settle().
  [[nodiscard]] const Eigen::VectorXd& settled() const { return nuisance_; }
  [[nodiscard]] Eigen::Index n_nuisance() const { return static_cast<Eigen::Index>(scatter_.size() + linear_.size()); }
  [[nodiscard]] const std::vector<Knob>& scatter() const { return scatter_; }
  [[nodiscard]] const std::vector<Prediction>& linear() const { return linear_; }
  [[nodiscard]] const Comparison& comparison() const { return *comparison_; }
  [[nodiscard]] const std::map<std::string, NoiseModel>& noise() const { return noise_; }           ///< by channel
  [[nodiscard]] const std::shared_ptr<const SharedNoise>& shared_noise() const { return shared_; }  ///< null: none
  [[nodiscard]] const std::vector<MeasuredRun>& runs() const { return runs_; }
  [[nodiscard]] const Twin& twin() const { return twin_; }
  /// W f's slopes by scatter and linear columns.
  [[nodiscard]] const Eigen::MatrixXd& nuisance_slopes() const { return slopes_; }
  [[nodiscard]] Eigen::VectorXd nuisance_sd() const;
  /// Of x of a hypothesis: the nuisance, then the knobs of each claim.
  [[nodiscard]] Eigen::VectorXd prior_sd(const Hypothesis& hypothesis) const;
  /// Of the normal priors that draw x to zero as much as theirs do, which of claims have heavier tails.
  [[nodiscard]] Eigen::VectorXd prior_width(const Hypothesis& hypothesis, const Eigen::VectorXd& x) const;

  [[nodiscard]] TwinState state(const Hypothesis& hypothesis, const Eigen::VectorXd& x) const;
  /// Readings of all runs; `responses`, unless null, keeps the machine's outputs or, where `reuse`, brings them.
  [[nodiscard]] Prediction predict(const Hypothesis& hypothesis, const Eigen::VectorXd& x, Twin::Workspace& workspace,
                                   Prediction* responses = nullptr, bool reuse = false) const;

  /// Readings as a file with these numbers would give them: of the machine alone, further columns at zero.
  [[nodiscard]] Prediction predict_machine(const Hypothesis& hypothesis, const Eigen::VectorXd& x,
                                           Twin::Workspace& workspace) const;

  /// One of each run, null where there is none: what states near it are answered from.
  using KeptRuns = std::vector<std::shared_ptr<const solver::KeptStates>>;
  /// @param for_slopes  as Twin::kept_run()
  [[nodiscard]] KeptRuns kept_runs(const TwinState& state, Twin::Workspace& workspace, bool for_slopes = true) const;

  /// The same as predict() where a prediction of other numbers, or of fewer claims, is known: runs in which the same effects
  /// act are taken from it.
  /// @param about      of the known state, which others are answered from where it can be
  /// @param responses  the machine's outputs at the known state; they become those at x
  [[nodiscard]] Prediction predict_beside(const TwinState& known_state, const Prediction& known,
                                          const Hypothesis& hypothesis, const Eigen::VectorXd& x, Twin::Workspace& workspace,
                                          const KeptRuns& about = {}, Prediction* responses = nullptr) const;

 private:
  class Climb;  ///< one fit (climb.cpp)
  void take_linear(std::vector<Prediction> columns);
  /// Readings of a state, whose responses are those of the machine.
  [[nodiscard]] Eigen::MatrixXd readings(const TwinState& state, std::size_t run, const Eigen::VectorXd& x,
                                         Eigen::MatrixXd response) const;
  /// x with further columns at zero: their amplitudes have no part in slopes of the machine.
  [[nodiscard]] Eigen::VectorXd of_machine(Eigen::VectorXd x) const;
  /// Slope of the readings by one of scatter's numbers. @param x  of_machine(). @param base, about  there
  [[nodiscard]] Prediction slope(const Hypothesis& hypothesis, const Eigen::VectorXd& x, const Prediction& base,
                                 const KeptRuns& about, std::size_t which, Twin::Workspace& workspace) const;
  void take_slopes(const Hypothesis& hypothesis, const Eigen::VectorXd& x, const Listener& listener = {});
  /// W f's slopes by scatter and linear columns at an x far from where scatter was settled. @param responses  of the machine
  /// there
  [[nodiscard]] Eigen::MatrixXd slopes_at(const Hypothesis& hypothesis, const Fit& at, Prediction responses) const;
  [[nodiscard]] Eigen::MatrixXd whitened_slopes(const std::vector<Prediction>& differences) const;
  void whiten_slopes();

  const Twin& twin_;
  const std::vector<MeasuredRun>& runs_;
  std::vector<Knob> scatter_;
  std::vector<Prediction> linear_;
  struct LinearRow {
    std::size_t of;  ///< index of the column
    Eigen::Index channel;
  };
  std::vector<std::vector<LinearRow>> linear_rows_;  ///< by run: where columns are not zero
  double most_sigmas_ = 1e300;
  std::map<std::string, NoiseModel> noise_;
  std::shared_ptr<const SharedNoise> shared_;
  std::optional<Comparison> comparison_;
  Eigen::VectorXd nuisance_;             ///< where it was settled
  std::vector<Prediction> differences_;  ///< of readings by scatter, not whitened
  Eigen::MatrixXd slopes_, squares_;     ///< whitened; slopes' slopes
  /// The same at the scenario's own numbers, for fits that begin there.
  std::vector<Prediction> written_differences_;
  Eigen::MatrixXd written_slopes_, written_squares_;
};

}  // namespace driftwright::diagnosis
