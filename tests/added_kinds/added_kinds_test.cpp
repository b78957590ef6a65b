// Five kinds of effects, one of each sort, of which the program knows nothing but their files in tests/added_kinds and
// their names in a list: each is simulated, fitted, found in records that it was hidden in, written into the scenario,
// and listed among the effects.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "diagnosis/calibration.hpp"
#include "effects/catalogue_table.hpp"
#include "tests/shared/edited_text.hpp"
#include "tests/shared/lumped_records.hpp"

namespace driftwright::diagnosis::added_kinds_test {
namespace {

using ::testing::HasSubstr, ::testing::IsEmpty, ::testing::SizeIs;

/// The two nodes of other tests, with one link and one record less.
std::string machine() {
  using fixtures::replaced;
  return replaced(replaced(kTwoNodes, "  - {type: link, node: head, to: ambient, conductance: 4 W/K}\n", ""),
                  "  friday: [[40 min, 900 rpm], [60 min, 0 rpm], [80 min, 1600 rpm]]\n", "");
}

struct Added {
  const char* key;
  const char* entry;  ///< of the truth
  const char* where;
  const char* number;
  double value;      ///< of the number
  double tolerance;  ///< relative: some two of its standard deviations
};

class AnAddedKind : public testing::TestWithParam<Added> {};

TEST_P(AnAddedKind, IsSimulatedFoundWrittenAndListed) {
  const Added& added = GetParam();
  const Found found(machine(), with_effect(machine(), added.entry), std::string(added.key) + "_", {.seed = 3});
  const Diagnosis& d = found.d;
  EXPECT_EQ(d.verdict, Verdict::kNamed) << d.reason;
  ASSERT_THAT(d.causes, SizeIs(1)) << d.reason;
  EXPECT_EQ(d.causes[0].effect, added.key);
  EXPECT_EQ(d.causes[0].where, added.where);
  EXPECT_THAT(d.causes[0].alternatives, IsEmpty());
  EXPECT_NEAR(d.causes[0].parameters[0].value, added.value, added.tolerance * std::abs(added.value));
  found.expect_written_is_found_no_more(std::string("- {type: ") + added.key);
  EXPECT_THAT(effects::catalogue_table(), HasSubstr(std::string("| `") + added.key + "` |"));
}

TEST_P(AnAddedKind, IsOneOfTheUncertainNumbersOfAScenarioThatHasIt) {
  const Added& added = GetParam();
  std::string off = added.entry;  // its number a tenth too small
  const std::string digits = fmt::format("{:g}", added.value);
  ASSERT_NE(off.find(digits), std::string::npos);
  off.replace(off.find(digits), digits.size(), fmt::format("{:g}", 0.9 * added.value));
  const Beside beside(write_file("off.yaml", with_effect(machine(), off)),
                      noisy_records(write_file("truth.yaml", with_effect(machine(), added.entry)),
                                    std::string(added.key) + "_", {.seed = 3}));
  const Diagnosis d = calibrate(*beside.twin, nullptr, beside.runs, {});
  const auto number = std::find_if(d.calibrated.begin(), d.calibrated.end(),
                                   [&](const Estimate& e) { return e.name.starts_with(std::string(added.key) + " "); });
  ASSERT_NE(number, d.calibrated.end());
  // On the way from the scenario's number to the true one. How far depends on what else could have done it: all heats and
  // exchanges smaller by one factor are the same temperatures, so that the priors share the tenth among them (a
  // conductance of 7 W/K that is written as 6.3 becomes 6.5).
  EXPECT_GT(number->value, 0.9 * added.value + 0.15 * 0.1 * added.value);
  EXPECT_LT(number->value, 1.05 * added.value);
}

INSTANTIATE_TEST_SUITE_P(
    OfEachSort, AnAddedKind,
    ::testing::Values(
        Added{"humming_heat", "{type: humming_heat, node: head, power: 60 W}", "head", "power", 60.0, 0.1},
        Added{"fanned_exchange", "{type: fanned_exchange, node: head, conductance: 7 W/K}", "head", "conductance", 7.0,
              0.15},
        Added{"creeping_glue", "{type: creeping_glue, displacement: nose, creep: 6 um}", "nose", "creep", 6.0, 0.1},
        Added{"sensor_gain", "{type: sensor_gain, sensor: t_column, gain: 1.4}", "t_column", "gain", 1.4, 0.05},
        Added{"slipping_belt", "{type: slipping_belt, slip: 150 rpm}", "spindle", "slip", 150.0, 0.15}),
    [](const auto& one) { return std::string(one.param.key); });

}  // namespace
}  // namespace driftwright::diagnosis::added_kinds_test
