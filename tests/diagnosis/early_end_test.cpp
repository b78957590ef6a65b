// A diagnosis that the user ended: at every stage it says what is known, that it is incomplete, and writes nothing.

#include <gtest/gtest.h>

#include <set>

#include "tests/shared/lumped_records.hpp"

namespace driftwright::diagnosis::early_end_test {
namespace {

constexpr const char* kBox = R"(name: box
reference_temperature: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: heater, capacity: 240 J/K}
  - {type: node, node: wall, capacity: 900 J/K}
  - {type: heat_source, node: heater, power: 40 W, at_speed: 1000 rpm, exponent: 1}
  - {type: link, node: heater, to: wall, conductance: 3 W/K}
  - {type: link, node: wall, to: ambient, conductance: 0.8 W/K}
ambient: [[0 h, 21 degC]]
sensors:
  - {name: heater, node: heater}
  - {name: wall, node: wall}
displacements:
  - name: lift
    sensitivities:
      - {node: wall, sensitivity: 2 um/K}
cyclograms:
  day: [[40 min, 1000 rpm], [30 min, 0 rpm], [50 min, 1000 rpm]]
  evening: [[50 min, 1000 rpm], [40 min, 0 rpm], [30 min, 500 rpm]]
solver: {output_interval: 60 s}
)";

/// Two records of the box with constant heat in its wall, which is found.
const Beside& beside() {
  static const Beside b(
      write_file("plain.yaml", kBox),
      noisy_records(write_file("truth.yaml", with_effect(kBox, "{type: heat_source, node: wall, power: 3 W, exponent: 0}")),
                    "box_", {.noise_K = 0.05, .noise_um = 0.1}));
  return b;
}

/// A diagnosis that nobody ends: what it finds, the stages that it goes through in their order, and the shares that it
/// tells.
struct Whole {
  Diagnosis diagnosis;
  std::vector<std::string> stages;
  std::vector<double> shares;
};
const Whole& whole() {
  static const Whole w = [] {
    Whole all;
    const Listener listener{.on_begin = [&](const std::string& work) { all.stages.push_back(work); },
                            .on_share = [&](double share) { all.shares.push_back(share); }};
    all.diagnosis = diagnose(*beside().twin, nullptr, beside().runs, {}, listener);
    return all;
  }();
  return w;
}

TEST(ADiagnosis, IsCompleteWhereNobodyWantsAnEnd) {
  const Diagnosis& d = whole().diagnosis;
  EXPECT_EQ(d.ended_at, "");
  EXPECT_EQ(d.verdict, Verdict::kAmbiguous) << d.reason;  // with a warmer ambient
  EXPECT_TRUE(d.written.keeps_numbers);
}

TEST(ADiagnosis, SaysWhatIsKnownWhereverItIsEnded) {
  const std::vector<std::string>& all = whole().stages;
  ASSERT_GT(all.size(), 6U);
  bool has_cause = false;
  for (std::size_t last = 0; last < all.size(); ++last) {
    SCOPED_TRACE(all[last]);
    std::size_t n_begun = 0;
    const Listener listener{.on_begin = [&](const std::string&) { ++n_begun; },
                            .wants_end_now = [&] { return n_begun > last; }};
    const Diagnosis d = diagnose(*beside().twin, nullptr, beside().runs, {}, listener);
    EXPECT_NE(d.ended_at, "");
    EXPECT_NE(d.reason.find("before it was complete"), std::string::npos) << d.reason;
    EXPECT_NE(d.verdict, Verdict::kConsistent);
    EXPECT_NE(d.verdict, Verdict::kNamed);
    for (const Cause& c : d.causes) EXPECT_EQ(c.standing, Standing::kSuspected);
    EXPECT_EQ(d.gain.size(), 3U);
    has_cause = has_cause || !d.causes.empty();
  }
  EXPECT_TRUE(has_cause) << "the last stages know the cause";
}

TEST(ADiagnosis, TellsHowFarItIs) {
  std::set<int> percent;
  for (const double share : whole().shares) {
    EXPECT_GE(share, 0.0);
    EXPECT_LE(share, 1.0);
    percent.insert(static_cast<int>(100.0 * share));
  }
  EXPECT_GT(percent.size(), 20U);
}

}  // namespace
}  // namespace driftwright::diagnosis::early_end_test
