#pragma once
// Finds the test that thermometers need: hours and speeds of a run that a regression is fitted to.

#include "studies/placement.hpp"

namespace driftwright::studies {

/// Programmes of one, two, four and eight hours: the top speed, the middle one or both, constant or on and off, with and
/// without rest at the end; with other drives if speeds do not differ. In the scenario's own ambient.
[[nodiscard]] std::vector<Cyclogram> possible_tests(const std::vector<Drive>& drives);

/// The drift that a set leaves after each test (PlacementJudge::behind_test()). Tests of other shards are left out.
/// @param judge   called when it is needed
/// @param pieces  one per test
[[nodiscard]] std::vector<TriedTest> tried_tests(const scenarios::Scenario& scenario,
                                                 const std::function<const PlacementJudge&()>& judge,
                                                 const std::vector<int>& set, const Pieces& pieces,
                                                 const Listener& listener);

/// The shortest of the tests that leave at most a tenth more than the best; of equally long ones the best. -1: none was
/// tried.
[[nodiscard]] int least_test(const std::vector<TriedTest>& tests, double Residual::*of);

}  // namespace driftwright::studies
