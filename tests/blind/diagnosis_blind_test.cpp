// Effects unknown to the diagnosis, in records that it did not make (tests/blind), named at their place; and silence
// where there is none. The full set of 400 runs in bench/blind.sh.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "blind/case.hpp"
#include "diagnosis/diagnosis.hpp"
#include "studies/measured_twin.hpp"

namespace driftwright::diagnosis::diagnosis_blind_test {
namespace {

constexpr const char* kMachines = "tests/blind/machines";
constexpr double kLoud = 10.0;  // d' from which on an effect must be found

struct Told {
  nlohmann::json truth;
  Diagnosis diagnosis;
};

Told told(const std::filesystem::path& folder) {
  Told t{nlohmann::json::parse(std::ifstream(folder / "truth.json")), {}};
  const scenarios::Scenario scenario = scenarios::read_scenario((folder / "scenario.yaml").string());
  std::vector<std::string> measured;
  for (const char* name : {"measured_1.csv", "measured_2.csv"}) {
    if (std::filesystem::exists(folder / name)) measured.push_back((folder / name).string());
  }
  studies::MeasuredTwin m = studies::open_measured_twin(scenario, "diagnose", measured, {}, true);
  if (t.truth["without"].is_string()) m.how.without.insert(t.truth["without"].get<std::string>());
  t.diagnosis = diagnose(*m.twin, m.on_other_mesh ? &*m.on_other_mesh : nullptr, m.runs, m.how);
  std::filesystem::remove_all(folder.parent_path());
  return t;
}
std::filesystem::path cases_folder() {
  return std::filesystem::path(testing::TempDir()) / fmt::format("driftwright_blind-{}", getpid());
}
Told told(std::uint64_t seed) {
  blind::CaseMaker maker(kMachines);
  (void)maker.make(seed, cases_folder());
  return told(cases_folder() / fmt::format("case_{:04d}", seed));
}
/// A case of the motor spindle that the seed would leave without effect, with one that seeds do not draw.
Told told_of(const blind::Hidden& hidden) {
  const blind::Subject spindle = blind::make_subject(kMachines, "motor_spindle");
  std::uint64_t seed = 0;
  while (blind::class_of(seed) != blind::CaseClass::kNone || blind::subject_names()[blind::subject_of(seed)] != spindle.name)
    ++seed;
  blind::Case c = blind::make_case(spindle, seed);
  c.hidden = {{hidden, 0.0, 0.0}};
  blind::write_case(spindle, c, cases_folder() / "case");
  return told(cases_folder() / "case");
}

void expect_inside(const Cause& cause, const std::string& name, double truth) {
  const auto p =
      std::find_if(cause.parameters.begin(), cause.parameters.end(), [&](const auto& e) { return e.name == name; });
  ASSERT_NE(p, cause.parameters.end()) << name;
  EXPECT_GE(truth, std::min(p->low, p->high)) << name << " " << p->value;
  EXPECT_LE(truth, std::max(p->low, p->high)) << name << " " << p->value;
}

TEST(PeriodicHeat, IsNamedWithItsPowerAndPeriod) {
  const Told t = told_of({.what = blind::Hide::kOscillatingHeat, .where = "housing", .size = 60.0, .lag_s = 44.0 * 60.0});
  ASSERT_EQ(t.diagnosis.causes.size(), 1U) << t.diagnosis.reason;
  const Cause& c = t.diagnosis.causes[0];
  EXPECT_EQ(c.effect + " " + c.where, "heat_source housing") << t.diagnosis.reason;
  expect_inside(c, "power", c.parameters[0].value < 0.0 ? -60.0 : 60.0);  // negative: half a period later
  expect_inside(c, "period", 44.0);
  expect_inside(c, "mean", 0.0);
}

TEST(ContactThatLoosens, IsNamedWithItsFactorAndTime) {
  const Told t = told_of({.what = blind::Hide::kContactLater,
                          .where = "bearing_front,housing",
                          .size = std::log(0.4),
                          .time_s = 95.0 * 60.0,
                          .record = 0});
  ASSERT_EQ(t.diagnosis.causes.size(), 1U) << t.diagnosis.reason;
  const Cause& c = t.diagnosis.causes[0];
  EXPECT_EQ(c.effect + " " + c.where, "contact bearing_front,housing") << t.diagnosis.reason;
  expect_inside(c, "factor", 0.4);
  expect_inside(c, "time", 95.0);
}

class NoEffect : public testing::TestWithParam<int> {};
TEST_P(NoEffect, IsNotNamed) {
  const Told t = told(static_cast<std::uint64_t>(GetParam()));
  // of these six one, 18, is suspected: a contact that changes by 13 % within a record
  EXPECT_EQ(t.diagnosis.verdict, GetParam() == 18 ? Verdict::kSuspected : Verdict::kConsistent) << t.diagnosis.reason;
}
INSTANTIATE_TEST_SUITE_P(Seeds, NoEffect, testing::Values(2, 22));
INSTANTIATE_TEST_SUITE_P(SeedsAtLength, NoEffect, testing::Values(6, 14, 18, 26));

class LoudEffects : public testing::TestWithParam<int> {};
TEST_P(LoudEffects, AreNamedAtTheirPlace) {
  const Told t = told(static_cast<std::uint64_t>(GetParam()));
  EXPECT_TRUE(t.diagnosis.verdict == Verdict::kNamed || t.diagnosis.verdict == Verdict::kAmbiguous) << t.diagnosis.reason;
  int n_loud = 0;
  for (const auto& hidden : t.truth["effects"]) {
    if (hidden["d_prime_beside_others"] < kLoud) continue;
    ++n_loud;
    const std::string effect = hidden["effect"], where = hidden["where"];
    if (effect == "ambient") continue;  // its loudness was counted for an ambient that is known without error
    const auto matches = [&](const Cause& c) { return c.effect == effect && c.where == where; };
    EXPECT_TRUE(std::any_of(t.diagnosis.causes.begin(), t.diagnosis.causes.end(), matches))
        << effect << " at " << where << ": " << t.diagnosis.reason;
  }
  EXPECT_GT(n_loud, 0);
  EXPECT_LE(t.diagnosis.causes.size(), t.truth["effects"].size()) << t.diagnosis.reason;
  for (const ChannelGain& g : t.diagnosis.gain) {  // kept out of the fit: within a fifth of the noise
    // what is not known of the ambient of a record that nothing was fitted to is in it: 0.3 K, and 2 um of each kelvin
    EXPECT_LT(g.rmse_after, std::hypot(1.2 * g.noise_floor, g.unit == "K" ? 0.3 : 0.6)) << g.name;
  }
}
INSTANTIATE_TEST_SUITE_P(Seeds, LoudEffects, testing::Values(49));
INSTANTIATE_TEST_SUITE_P(SeedsAtLength, LoudEffects, testing::Values(0, 24, 43, 45, 47, 57));

TEST(EffectOutsideTheCatalogue, IsNotGivenAName) {
  const Told t = told(4);  // heat of acceleration
  EXPECT_NE(t.diagnosis.verdict, Verdict::kNamed) << t.diagnosis.reason;
}

// Where the catalogue is without the true law and another one at the same place does nearly the same, that one is named:
// its place is right.
TEST(EffectOutsideTheCatalogue, IsCalledByWhatDoesTheSameAtItsPlace) {
  const Told heat = told(164);  // heat of speed at a shaft, the key taken out: another friction there
  ASSERT_FALSE(heat.diagnosis.causes.empty()) << heat.diagnosis.reason;
  EXPECT_EQ(heat.diagnosis.causes[0].where, heat.truth["effects"][0]["where"]) << heat.diagnosis.reason;
}

class AnUnknownEffect : public testing::TestWithParam<int> {};
TEST_P(AnUnknownEffect, IsStatedAtItsPlace) {
  const Told t = told(static_cast<std::uint64_t>(GetParam()));
  ASSERT_FALSE(t.diagnosis.statements.stated.empty());
  const std::vector<std::string> place = {t.truth["effects"][0]["where"]};
  EXPECT_EQ(t.diagnosis.statements.stated[0].says.place, place) << t.diagnosis.reason;
}
INSTANTIATE_TEST_SUITE_P(Seeds, AnUnknownEffect, testing::Values(55));  // constant heat, its key taken out
INSTANTIATE_TEST_SUITE_P(SeedsAtLength, AnUnknownEffect,
                         testing::Values(215));  // creep of the turns made, no law of the catalogue

}  // namespace
}  // namespace driftwright::diagnosis::diagnosis_blind_test
