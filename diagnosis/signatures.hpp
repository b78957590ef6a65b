#pragma once
// The effect of each law of each candidate on the readings, and its evidence by linear theory.

#include "base/listener.hpp"
#include "diagnosis/fit.hpp"
#include "diagnosis/projection.hpp"

namespace driftwright::diagnosis {

/// The change of the whitened, condensed readings (Comparison::condensed()) by one law with one shape, at its trial size,
/// per unit of size.
struct Signature {
  std::size_t candidate = 0, variant = 0;
  Eigen::VectorXd shape;  ///< x of the claim's knobs, with the size at its trial value
  Eigen::VectorXd column;
};
/// One law of a candidate.
struct Law {
  std::size_t candidate = 0, variant = 0;
};
[[nodiscard]] std::vector<Law> laws_of(const std::vector<Candidate>& candidates);
/// Which shapes of a law get a signature: those of its grid; or with them, where there are readings, those on the way from
/// the best of them to the shape that gains most by linear theory.
enum class Shapes { kOfGrid, kUpToTheBest };
/// The signatures of some laws, in addition to a fit. They depend little on the other claims.
/// @param fit  for kOfGrid its x and prediction are enough
[[nodiscard]] std::vector<Signature> signatures(const Fitter& fitter, const std::vector<Candidate>& candidates,
                                                const std::vector<Law>& laws, const Hypothesis& hypothesis, const Fit& fit,
                                                Shapes shapes, const Listener& listener = {});

/// The evidence that a candidate would add to a fit, by linear theory.
struct Score {
  std::size_t candidate = 0, variant = 0;
  double gain = -1e300;    ///< nats
  Eigen::VectorXd start;   ///< x of the claim's knobs
  Eigen::VectorXd beside;  ///< nuisance numbers beside it, at most 1 sigma from the scenario's
};

/// The claim of a score.
[[nodiscard]] Claim claim_of(const std::vector<Candidate>& candidates, const Score& score);

/// x of everything: the nuisance numbers, then those of the claims.
[[nodiscard]] Eigen::VectorXd joined(const Eigen::VectorXd& nuisance, const Eigen::VectorXd& claims);
/// A hypothesis with one more claim.
[[nodiscard]] Hypothesis with(Hypothesis hypothesis, Claim claim);
/// The projection for a fit. At its optimum J'r = B⁻²x, with B its prior_width(), so the data about x = 0 of the
/// linearised problem are r + J x. Readings are condensed.
[[nodiscard]] Projection projection_of(const Fitter& fitter, const Hypothesis& hypothesis, const Fit& fit);

/// The result of linear theory for one shape of a law.
struct LinearGain {
  double x = 0.0;     ///< its size
  double gain = 0.0;  ///< of evidence, after the cost of the law and its shapes [nats]
};
/// @param ss  squares of the rest of its signature after other numbers. @param sr  its product with the rest of the
/// readings
[[nodiscard]] LinearGain linear_gain(const Variant& law, double ss, double sr);

/// Start values of a claim's knobs for a fit: its shape, and the size by linear theory. @param x  the size
[[nodiscard]] Eigen::VectorXd start_at(const Variant& law, const Eigen::VectorXd& shape, double x);

/// The best shape of each law of each candidate, best candidate first.
[[nodiscard]] std::vector<Score> scores(const Fitter& fitter, const std::vector<Candidate>& candidates,
                                        const std::vector<Signature>& signatures, const Hypothesis& hypothesis,
                                        const Fit& fit);

}  // namespace driftwright::diagnosis
