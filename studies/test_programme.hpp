#pragma once
// Test programmes: what the drive of a machine is told, in slots of equal length, each at one of a few levels.

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "scenarios/reader/scenario.hpp"

namespace driftwright::studies {

/// Drives that programmes are made of; the first is rest.
struct TestLevels {
  std::vector<Drive> drives;
  int full = 0;            ///< what the usual test heats by: everything at its most
  std::vector<int> steps;  ///< quarters of it, the last one full
};
/// A level of each slot.
using TestProgramme = std::vector<int>;

inline constexpr int kTestSlots = 32;

/// Rest; spindle, axes and cutting power together at a quarter, half, three quarters of and all of their most; of machines with several of these also the spindle alone at half and
/// all of its top speed, cutting, and each axis alone. The most is what some cyclogram of the scenario has.
/// @param most_speed_rpm  0: as the scenario
/// @throws InputError  where no cyclogram drives anything
[[nodiscard]] TestLevels test_levels(const scenarios::Scenario& scenario, double most_speed_rpm);

[[nodiscard]] Cyclogram cyclogram_of(const TestProgramme& programme, const TestLevels& levels, double duration_s,
                                     const std::string& name);

/// Half the time at full, half at rest.
[[nodiscard]] TestProgramme usual_test(const TestLevels& levels);
/// A quarter to all of full one after the other, then rest, a fifth of the time each: as ISO 230-3 varies speeds.
[[nodiscard]] TestProgramme stepped_test(const TestLevels& levels);

/// Up to ten sections of random lengths at random levels.
[[nodiscard]] TestProgramme random_test(const TestLevels& levels, std::mt19937_64& random);
/// One thing changed: a section's level, where two meet, the order of two, a section more, a section less.
[[nodiscard]] TestProgramme changed_test(TestProgramme programme, const TestLevels& levels, std::mt19937_64& random);
/// Each programme with two neighbouring sections at one of their levels.
[[nodiscard]] std::vector<TestProgramme> with_one_section_less(const TestProgramme& programme);

}  // namespace driftwright::studies
