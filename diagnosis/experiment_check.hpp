#pragma once
// Tests a proposed experiment: simulates records with each explanation, and checks which explanation they support.

#include "diagnosis/discrimination.hpp"

namespace driftwright::diagnosis {

/// Explanations of which one is true, with their probabilities so far: a cause, others in its place, nothing there.
struct OpenQuestion {
  std::vector<std::size_t> of;     ///< indices of explanations
  std::vector<double> weight;      ///< their sum is 1
  std::vector<std::size_t> place;  ///< of each, a number that quantity and place share
};

struct Check {
  int n = 0;
  int n_told = 0;
};

/// Draws explanations of each question in proportion to their probabilities, their numbers from their uncertainty,
/// simulates the machine, adds noise, and fits all explanations of the question to the records so far and the new one. The
/// question is resolved if the true explanation then has a probability of at least kSure. The seed is fixed: the result is
/// always the same.
/// @param fitter  for the records so far
/// @param run     the planned run, with its channels
/// @param noise   of its channels and those so far
/// @param power   exponent of the evidence between explanations
/// @param n_draws  per explanation of a question, on average
[[nodiscard]] Check check_by_simulation(const Fitter& fitter, const MeasuredRun& run,
                                        const std::map<std::string, NoiseModel>& noise,
                                        const std::vector<Explanation>& explanations,
                                        const std::vector<OpenQuestion>& questions, double power, int n_draws = 4);

}  // namespace driftwright::diagnosis
