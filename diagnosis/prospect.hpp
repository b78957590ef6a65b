#pragma once
// What readings that are still to come are expected to tell: which effects would be named, how well the machine's numbers would be known.
//
// Whitened readings are y = J x + c_a s_a z + noise of variance 1, with numbers x ~ N(0, S²) and the fault a of size z standard deviations of its prior.
// With the readings' information I = [J c]'[J c] and what the numbers can take projected out
//
//     K = I_cc - I_cJ (I_JJ + S⁻²)⁻¹ I_Jc,   A = s_a² K_aa,  B = s_b² K_bb,  G = s_a s_b K_ab
//     E[log Z_a - log Z_0] = z²/2 A²/(1 + A) - 1/2 log(1 + A) - price_a
//     E[log Z_a - log Z_b] = z²/2 (A²/(1 + A) - G²/(1 + B)) - 1/2 log (1 + A)/(1 + B) - price_a + price_b
//     d'_ab = sqrt(A - G²/(1 + B))
//
// A fault is told once the first is above the bar and the second above what another kind may come near, for every b of another kind: that is from some size
// |z| on. Sizes are as likely within any factor (Jeffreys), from a hundredth of a standard deviation to two, so that the share of faults that are told is
// log(2 / z) / log(2 / 0.01): what makes the least size that is told smaller by some factor counts alike for loud and for quiet effects. d'_ab is discrimination() of a at
// one standard deviation and of b, both with nothing known of numbers and of b's size. Noise in the evidence itself is left out: a fault at the bar is told every other time.
// Source: Kailath (discrimination.hpp); evidence as in fit.hpp; D_s-optimal designs: Atkinson & Donev, Optimum Experimental Designs (1992), ch. 10.

#include <Eigen/Core>
#include <string>
#include <vector>

namespace driftwright::diagnosis {

/// One law of an effect at one place, one shape of it.
struct DoubtedLaw {
  std::string effect = {}, where = {}, law = {};
  double size_sd = 1.0;     ///< s_a, in the unit that its column is taken per
  double price_nats = 0.0;  ///< how many others there are, and how rare it is
  double weight = 1.0;      ///< in what is expected; all add up to 1
};

/// What readings are asked about. Columns of the information: numbers first, then laws.
struct Question {
  Eigen::VectorXd number_sd;
  std::vector<DoubtedLaw> laws;
  double bar_nats = 4.0;   ///< evidence that names, price paid
  double lead_nats = 3.0;  ///< over what is of another kind
  [[nodiscard]] Eigen::Index n() const { return number_sd.size() + static_cast<Eigen::Index>(laws.size()); }
};

struct Prospect {
  double share_named = 0.0;  ///< of faults drawn as the question weighs them, 0 to 1
  Eigen::VectorXd seen;      ///< share of the faults of each law that are large enough to be told from nothing
  Eigen::VectorXd named;     ///< and from every other kind
  Eigen::VectorXd nats;      ///< E[log Z_a - log Z_0] at one standard deviation, without prices
  Eigen::MatrixXd d;         ///< d'_ab, 0 on the diagonal
  Eigen::MatrixXd
      taken;  ///< share of the faults a that are seen and that b may stand in for; 0 where both are of one kind, or none is seen
  Eigen::VectorXd number_sigma;  ///< of each number, afterwards over before, 0 to 1
};

/// @param information  [J c]'[J c], n x n, of the readings; others to come are added to it
[[nodiscard]] Prospect prospect(const Question& question, const Eigen::MatrixXd& information);
/// Its share_named alone.
[[nodiscard]] double share_named(const Question& question, const Eigen::MatrixXd& information);

}  // namespace driftwright::diagnosis
