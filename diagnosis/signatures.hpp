#pragma once
// What each law of each candidate does to the readings, and how much evidence linear theory says it would bring.

#include "base/listener.hpp"
#include "diagnosis/fit.hpp"
#include "diagnosis/projection.hpp"

namespace driftwright::diagnosis {

/// What one law of a candidate does to the whitened readings, condensed (Comparison::condensed()), at trial size and one shape, per unit of its size.
struct Signature {
  std::size_t candidate = 0, variant = 0;
  Eigen::VectorXd shape;  ///< x of the claim's knobs, the size at its trial
  Eigen::VectorXd column;
};
/// One law of a candidate.
struct Law {
  std::size_t candidate = 0, variant = 0;
};
[[nodiscard]] std::vector<Law> laws_of(const std::vector<Candidate>& candidates);
/// Those of some laws, on top of a fit. They change little with what else is claimed.
[[nodiscard]] std::vector<Signature> signatures(const Fitter& fitter, const std::vector<Candidate>& candidates,
                                                const std::vector<Law>& laws, const Hypothesis& hypothesis, const Fit& fit,
                                                const Listener& listener = {});

/// How much evidence a candidate would bring on top of a fit: what the linear theory says.
struct Score {
  std::size_t candidate = 0, variant = 0;
  double gain = -1e300;   ///< nats
  double fall = 0.0;      ///< of Φ [nats]: how much better it fits, nothing paid
  Eigen::VectorXd start;  ///< x of the claim's knobs
};

/// What a score is of, as a hypothesis has it.
[[nodiscard]] Claim claim_of(const std::vector<Candidate>& candidates, const Score& score);

/// x of everything: the numbers of the nuisance, then those of the claims.
[[nodiscard]] Eigen::VectorXd joined(const Eigen::VectorXd& nuisance, const Eigen::VectorXd& claims);
/// A hypothesis and one claim more.
[[nodiscard]] Hypothesis with(Hypothesis hypothesis, Claim claim);
/// Of a fit: at its optimum J'r = B⁻²x, B its prior_width(), so the data about x = 0 of the linearised problem are r + J x. Readings are condensed.
[[nodiscard]] Projection projection_of(const Fitter& fitter, const Hypothesis& hypothesis, const Fit& fit);

/// What linear theory says of one shape of a law.
struct LinearGain {
  double x = 0.0;     ///< its size
  double fall = 0.0;  ///< of Φ [nats]
  double gain = 0.0;  ///< of evidence, the law's price and that of its shapes paid [nats]
};
/// @param ss  squares of its signature that other numbers leave. @param sr  its product with what they leave of the readings
[[nodiscard]] LinearGain linear_gain(const Variant& law, double ss, double sr);

/// x of a claim's knobs where a fit of it begins: its shape, and a size as linear theory has it. @param x  the size
[[nodiscard]] Eigen::VectorXd start_at(const Variant& law, const Eigen::VectorXd& shape, double x);

/// The best shape of each law of each candidate, best first.
[[nodiscard]] std::vector<Score> scores(const Fitter& fitter, const std::vector<Candidate>& candidates,
                                        const std::vector<Signature>& signatures, const Hypothesis& hypothesis,
                                        const Fit& fit);

}  // namespace driftwright::diagnosis
