#pragma once
// What future readings are expected to show: which effects would be named, and how well the machine's numbers would be
// known.
//
// Whitened readings are y = J x + c_a s_a z + noise of variance 1, with numbers x ~ N(0, S²) and the fault a of size z
// standard deviations of its prior. With the readings' information I = [J c]'[J c] and what the numbers can take
// projected out
//
//     K = I_cc - I_cJ (I_JJ + S⁻²)⁻¹ I_Jc,   A = s_a² K_aa,  B = s_b² K_bb,  G = s_a s_b K_ab
//     E[log Z_a - log Z_0] = z²/2 A²/(1 + A) - 1/2 log(1 + A) - price_a
//     E[log Z_a - log Z_b] = z²/2 (A²/(1 + A) - G²/(1 + B)) - 1/2 log (1 + A)/(1 + B) - price_a + price_b
//     d'_ab = sqrt(A - G²/(1 + B))
//
// A fault is found if the first quantity is above the threshold, and named if the second is above the lead for every b of
// another kind: both hold from some size |z| on. Sizes have equal probability per factor (Jeffreys), from a hundredth of
// a standard deviation to two, so that the share of faults that are found is log(2 / z) / log(2 / 0.01): a reduction of
// the least detectable size by some factor counts the same for large and small effects. d'_ab is discrimination() of a at
// one standard deviation and of b, with nothing known of the numbers and of b's size. Noise of the evidence itself is
// left out: a fault at the threshold is found in half of the cases.
// Source: Kailath (discrimination.hpp); evidence as in fit.hpp; D_s-optimal designs: Atkinson & Donev, Optimum
// Experimental Designs (1992), ch. 10.

#include <Eigen/Core>
#include <string>
#include <vector>

namespace driftwright::diagnosis {

/// One law of an effect at one place, with one shape.
struct DoubtedLaw {
  std::string effect = {}, where = {}, law = {};
  double size_sd = 1.0;     ///< s_a, in the unit of its column
  double price_nats = 0.0;  ///< cost for the number of alternatives and for rarity
  double weight = 1.0;      ///< in the expectation; the sum over all laws is 1
};

/// The questions to the readings. Columns of the information: numbers first, then laws.
struct Question {
  Eigen::VectorXd number_sd;
  std::vector<DoubtedLaw> laws;
  double bar_nats = 4.0;   ///< evidence needed for a name, after the cost
  double lead_nats = 3.0;  ///< over laws of another kind
  [[nodiscard]] Eigen::Index n() const { return number_sd.size() + static_cast<Eigen::Index>(laws.size()); }
};

struct Prospect {
  double share_named = 0.0;      ///< of faults drawn with the question's weights, 0 to 1
  Eigen::VectorXd seen;          ///< share of the faults of each law that are large enough to be distinguished from nothing
  Eigen::VectorXd named;         ///< and from every other kind
  Eigen::VectorXd nats;          ///< E[log Z_a - log Z_0] at one standard deviation, without cost
  Eigen::MatrixXd d;             ///< d'_ab, 0 on the diagonal
  Eigen::MatrixXd taken;         ///< share of detected faults a that may be mistaken for b; 0 within one kind, or with none
  Eigen::VectorXd number_sigma;  ///< of each number, ratio after to before, 0 to 1
};

/// @param information  [J c]'[J c], n x n, of the readings; further readings add to it
[[nodiscard]] Prospect prospect(const Question& question, const Eigen::MatrixXd& information);
/// Its share_named only.
[[nodiscard]] double share_named(const Question& question, const Eigen::MatrixXd& information);

}  // namespace driftwright::diagnosis
