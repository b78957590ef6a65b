// What was fitted to records of some duty cycles is written where it does no harm to one that it was not fitted to.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string_view>

#include "tests/shared/lumped_records.hpp"

namespace driftwright::diagnosis::other_duty_cycles_test {
namespace {

using ::testing::HasSubstr;

/// Three days of a slow cycle and two of a fast one.
std::string of_two_cycles(std::string text) {
  const std::size_t from = text.find("cyclograms:"), to = text.find("solver:");
  text.replace(from, to - from, R"(cyclograms:
  slow_1: [[150 min, 1000 rpm], [50 min, 0 rpm], [60 min, 1000 rpm]]
  slow_2: [[120 min, 1000 rpm], [40 min, 0 rpm], [90 min, 1000 rpm]]
  fast_1: [[100 min, 3000 rpm], [50 min, 0 rpm], [100 min, 3000 rpm]]
  slow_3: [[60 min, 1000 rpm], [30 min, 0 rpm], [100 min, 1000 rpm]]
  fast_2: [[160 min, 3000 rpm], [60 min, 0 rpm], [40 min, 3000 rpm]]
)");
  return text;
}

constexpr const char* kWritten = "power: 100 W, at_speed: 1000 rpm, exponent: 1.3";
// Twice the friction when slow, as much as is written when fast.
constexpr const char* kTrue = "power: 200 W, at_speed: 1000 rpm, exponent: 0.67";

Diagnosis diagnosed(const std::string& plain, std::string truth, const char* friction,
                    const std::set<std::string>& without = {}) {
  truth.replace(truth.find(kWritten), std::string_view(kWritten).size(), friction);
  const Beside beside(write_file("plain.yaml", plain), noisy_records(write_file("truth.yaml", truth), "cycles_"));
  DiagnosisOptions how;
  how.most_effects = 1;
  how.without = without;
  return diagnose(*beside.twin, nullptr, beside.runs, how);
}

/// Heat that comes and goes in some records without any visible cause.
std::string comes_and_goes(const std::vector<std::string>& records) {
  std::string list;
  for (const std::string& record : records) {
    for (const char* window : {"30 W, windows: [[11 min, 34 min]]", "-25 W, windows: [[52 min, 80 min]]",
                               "35 W, windows: [[97 min, 122 min]]", "-30 W, windows: [[140 min, 171 min]]"})
      list += fmt::format("{}{{type: heat_window, node: column, in: {}, power: {}}}", list.empty() ? "" : "\n  - ", record,
                          window);
  }
  return list;
}
// Effects that could replace the friction's growth, or the windows.
const std::set<std::string> kNotLookedFor = {"changed_law", "friction_law",    "heat_window",   "heat_source",
                                             "run_state",   "exchange_window", "speed_override"};

TEST(OtherDutyCycles, HoldBackWhatIsTrueOfOneAloneWhereMoreIsLeftThanAnythingExplains) {
  // The scenario's own power takes up what the slow days show.
  const std::string plain = of_two_cycles(kTwoNodes);
  const Diagnosis d = diagnosed(
      plain, with_effect(plain, comes_and_goes({"slow_1", "slow_2", "slow_3", "fast_1", "fast_2"})), kTrue, kNotLookedFor);
  ASSERT_EQ(d.verdict, Verdict::kUnexplained) << d.reason;
  EXPECT_FALSE(d.written.keeps_numbers);
  EXPECT_THAT(d.written.why_nothing,
              HasSubstr("of 2 duty cycles, each kept out whole, all together are predicted best by the "
                        "scenario as it was: "));
}

TEST(OtherDutyCycles, DoNotHoldBackWhatGainsFarMoreInOneThanItLosesInAnother) {
  // A night at rest, of which the scenario as it is misses next to nothing.
  std::string plain = of_two_cycles(kTwoNodes);
  const std::size_t from = plain.find("  fast_1:");
  plain.replace(from, plain.find('\n', from) - from, "  night: [[250 min, 0 rpm]]");
  plain.erase(plain.find("  fast_2:"), plain.find("solver:") - plain.find("  fast_2:"));
  const Diagnosis d = diagnosed(plain, with_effect(plain, comes_and_goes({"slow_1", "slow_2", "slow_3"})),
                                "power: 200 W, at_speed: 1000 rpm, exponent: 1.3", kNotLookedFor);
  ASSERT_EQ(d.verdict, Verdict::kUnexplained) << d.reason;
  EXPECT_TRUE(d.written.keeps_numbers) << d.written.why_nothing;
  EXPECT_LT(d.misses.extended, 0.5 * d.misses.as_written);
}

TEST(OtherDutyCycles, DoNotHoldBackWhatExplainsAll) {
  const std::string plain = of_two_cycles(kTwoNodes);
  const Diagnosis d = diagnosed(plain, plain, kTrue);
  // Less heat below a speed, or another speed in these records: no reading can distinguish them.
  ASSERT_TRUE(d.verdict == Verdict::kNamed || d.verdict == Verdict::kAmbiguous) << d.reason;
  EXPECT_TRUE(d.written.keeps_numbers) << d.written.why_nothing;
}

}  // namespace
}  // namespace driftwright::diagnosis::other_duty_cycles_test
