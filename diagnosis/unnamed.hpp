#pragma once
// Is it one cause that nobody has a name for, rather than those the search has named?
//
// Several named effects can add up to something that looks like one effect of another kind. Against them stands one unknown quantity q at one
// place: heat in a body, the ambient, or the reading of a channel. Its course is one of
//
//     constant;   a function of speed, a n/N + b (n/N)²;   in proportion to the turns made;
//     a smooth function of time: a Gaussian process of variance sd² (1/2 + exp(-Δt²/2l²)), pieces constant, the 1/2 common to all runs
//
// and its evidence is that of linear least squares about the best fit. It pays for the choice of place and course as a candidate does.
// Source: Rasmussen & Williams, Gaussian Processes for Machine Learning (2006), ch. 2 and 5.4.

#include "diagnosis/fit.hpp"

namespace driftwright::diagnosis {

struct Unnamed {
  enum class Quantity { kHeat, kAmbient, kReading } quantity = Quantity::kHeat;
  std::string where;                    ///< body, "ambient" or channel
  std::string follows;                  ///< "nothing", "speed", "the turns made", "time"
  std::vector<std::size_t> instead_of;  ///< claims of the hypothesis
  double log_evidence_gain = 0.0;       ///< over those claims [nats], prices paid by both
  std::vector<double> time_s, value;    ///< of the first run's rows [W, K, m, rad]
};

/// The best one in the place of some claims or of all, or nothing where there is no claim, or where the listener wants an end.
[[nodiscard]] std::optional<Unnamed> best_unnamed(const Fitter& fitter, const std::vector<Candidate>& candidates,
                                                  const Hypothesis& hypothesis, const Fit& fit,
                                                  const Listener& listener = {});

}  // namespace driftwright::diagnosis
