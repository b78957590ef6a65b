#pragma once
// Test programmes: the drive of a machine in slots of equal length, each at one of a few levels.

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "scenarios/reader/scenario.hpp"

namespace driftwright::studies {

/// Drives that programmes are made of; the first is rest.
struct TestLevels {
  std::vector<Drive> drives;
  int full = 0;            ///< level of the usual test: everything at its maximum
  std::vector<int> steps;  ///< the four quarters of it, the last one full
};
/// The level of each slot.
using TestProgramme = std::vector<int>;

inline constexpr int kTestSlots = 32;

/// Rest; spindle, axes and cutting power together at a quarter, half, three quarters and all of their maximum; for
/// machines with several of these also the spindle alone at half and full speed, cutting alone, and each axis alone. The
/// maximum is that of the scenario's cyclograms.
/// @param most_speed_rpm  0: the maximum of the scenario
/// @throws InputError  if no cyclogram drives anything
[[nodiscard]] TestLevels test_levels(const scenarios::Scenario& scenario, double most_speed_rpm);

[[nodiscard]] Cyclogram cyclogram_of(const TestProgramme& programme, const TestLevels& levels, double duration_s,
                                     const std::string& name);

/// Half the time at full, then half at rest.
[[nodiscard]] TestProgramme usual_test(const TestLevels& levels);
/// A quarter, half, three quarters and all of full in turn, then rest, a fifth of the time each: ISO 230-3 varies speeds
/// like this.
[[nodiscard]] TestProgramme stepped_test(const TestLevels& levels);

/// Up to ten sections of random lengths at random levels.
[[nodiscard]] TestProgramme random_test(const TestLevels& levels, std::mt19937_64& random);
/// One random change: a section's level, the border of two, the order of two, one section more, or one less.
[[nodiscard]] TestProgramme changed_test(TestProgramme programme, const TestLevels& levels, std::mt19937_64& random);
/// All programmes in which two neighbouring sections are merged, at the level of either.
[[nodiscard]] std::vector<TestProgramme> with_one_section_less(const TestProgramme& programme);

}  // namespace driftwright::studies
