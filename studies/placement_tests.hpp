#pragma once
// Which test thermometers need: hours and speeds that a regression is fitted to.

#include "studies/placement.hpp"

namespace driftwright::studies {

/// Programmes of one, two, four and eight hours: the top speed, the middle one or both, held or on and off, with and without rest behind; of other drives
/// where speeds do not differ. In the scenario's own ambient.
[[nodiscard]] std::vector<Cyclogram> possible_tests(const std::vector<Drive>& drives);

/// What a set leaves behind each of them (PlacementJudge::behind_test()). Tests of other shards are left out.
/// @param judge   made when it is required
/// @param pieces  one a test
[[nodiscard]] std::vector<TriedTest> tried_tests(const scenarios::Scenario& scenario,
                                                 const std::function<const PlacementJudge&()>& judge,
                                                 const std::vector<int>& set, const Pieces& pieces,
                                                 const Listener& listener);

/// The shortest of those that leave at most a tenth more than the best; of equally long ones the best. -1: none was tried.
[[nodiscard]] int least_test(const std::vector<TriedTest>& tests, double Residual::*of);

}  // namespace driftwright::studies
