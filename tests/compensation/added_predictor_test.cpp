// Two kinds of predictors of which the program knows nothing but this file and their names in a list (CMakeLists.txt here):
// each is judged, guarded, written, read, followed on a stream and, where it gives a formula, exported to a control.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/errors.hpp"
#include "base/file_bytes.hpp"
#include "base/json_value.hpp"
#include "base/random.hpp"
#include "compensation/judging/judgement_json.hpp"
#include "compensation/judging/strategy_verdict.hpp"
#include "compensation/predictors/driven_predictor.hpp"
#include "compensation/predictors/formula_predictor.hpp"
#include "compensation/predictors/predictor_kind.hpp"
#include "follow/followed_predictor.hpp"
#include "follow/session.hpp"
#include "output/drift_model_c.hpp"
#include "output/predictor_file.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::compensation {
namespace added_predictor_test {
namespace {

using json::Json;

/// What a bar between two thermometers bends: d = factor (warm - cold).
class Lever final : public Predictor {
 public:
  Lever(std::string warm, std::string cold, double factor_um_K)
      : warm_(std::move(warm)), cold_(std::move(cold)), factor_um_K_(factor_um_K), formula_(model()) {}
  [[nodiscard]] std::vector<Input> inputs() const override { return formula_.inputs(); }
  [[nodiscard]] bool is_driven() const override { return false; }
  [[nodiscard]] std::optional<Written> written() const override {
    return Written{.kind = "lever", .content = {{"warm", warm_}, {"cold", cold_}, {"factor_um_K", factor_um_K_}}};
  }
  [[nodiscard]] const DriftModel* formula() const override { return formula_.formula(); }
  [[nodiscard]] std::unique_ptr<Follower> follow() const override { return formula_.follow(); }

 private:
  [[nodiscard]] DriftModel model() const {
    DriftModel m;
    m.kind = "lever";
    m.target = "nose";
    m.target_unit = "um";
    m.terms = {{.input = warm_, .unit = "degC", .coefficient = factor_um_K_},
               {.input = cold_, .unit = "degC", .coefficient = -factor_um_K_}};
    return m;
  }

  std::string warm_, cold_;
  double factor_um_K_;
  FormulaPredictor formula_;
};

std::shared_ptr<const Predictor> read_lever(const Json& j, const DriftTarget&) {
  return std::make_shared<Lever>(json::value<std::string>(j, "warm"), json::value<std::string>(j, "cold"),
                                 json::finite(j, "factor_um_K"));
}

/// d = head_um_K (T_head - T_ambient) + speed_um_rpm L, 40 min dL/dt = n - L: it reads a thermometer, the drive and the
/// ambient, and is no formula.
class WarmHead final : public Predictor {
 public:
  WarmHead(double head_um_K, double speed_um_rpm) : head_um_K_(head_um_K), speed_um_rpm_(speed_um_rpm) {}
  [[nodiscard]] std::vector<Input> inputs() const override { return {{"head", "degC"}}; }
  [[nodiscard]] bool is_driven() const override { return true; }
  [[nodiscard]] double reference_K() const override { return 293.15; }
  [[nodiscard]] std::optional<Written> written() const override {
    return Written{.kind = "warm_head", .content = {{"head_um_K", head_um_K_}, {"speed_um_rpm", speed_um_rpm_}}};
  }
  [[nodiscard]] std::unique_ptr<Follower> follow() const override { return std::make_unique<Run>(*this); }

 private:
  class Run final : public Follower {
   public:
    explicit Run(const WarmHead& head) : head_(head) {}
    double next(const MachineRun& run) override {
      const std::vector<double>& t_s = run.readings.time_s;
      const std::size_t at = run.at(row_);
      if (row_ > 0) {
        const double n_rpm = run.cyclogram.drive(t_s[at - 1] - run.cyclogram_from_s).speed_rpm;
        lag_rpm_ += -std::expm1(-(t_s[at] - t_s[at - 1]) / 2400.0) * (n_rpm - lag_rpm_);
      }
      ++row_;
      const double ambient_degC = run.ambient.at(t_s[at]) + 20.0;
      return head_.head_um_K_ * (run.readings.at("head").values[at] - ambient_degC) + head_.speed_um_rpm_ * lag_rpm_;
    }
    [[nodiscard]] std::vector<double> memory() const override { return {static_cast<double>(row_), lag_rpm_}; }
    void recall(std::span<const double> memory) override {
      row_ = static_cast<std::size_t>(memory[0]);
      lag_rpm_ = memory[1];
    }

   private:
    const WarmHead& head_;
    std::size_t row_ = 0;
    double lag_rpm_ = 0.0;
  };

  double head_um_K_, speed_um_rpm_;
};

std::shared_ptr<const Predictor> read_warm_head(const Json& j, const DriftTarget&) {
  return std::make_shared<WarmHead>(json::finite(j, "head_um_K"), json::finite(j, "speed_um_rpm"));
}

}  // namespace
}  // namespace added_predictor_test

PredictorKind lever_kind() {
  return {.key = "lever", .read = added_predictor_test::read_lever};
}

PredictorKind warm_head_kind() {
  return {.key = "warm_head", .read = added_predictor_test::read_warm_head};
}

namespace added_predictor_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr double kNoise_um = 0.2;
constexpr std::array<double, 10> kSpeeds_rpm = {0, 3000, 0, 2000, 1000, 3000, 1000, 0, 3000, 2000};  // half an hour each

/// Five hours of a machine whose nose moves as the predictor says, with noise: `speed`, `air`, `head` and `bed`. Each seed
/// begins at another of the speeds.
MachineRun machine(const Predictor& truth, std::uint64_t seed) {
  Random random(seed, 41);
  Record r{.source = "record " + std::to_string(seed), .time_s = {}, .channels = {}};
  r.channels = {{"speed", "rpm", {}}, {"air", "degC", {}}, {"head", "degC", {}}, {"bed", "degC", {}}};
  double rpm = 0.0, head_K = 0.0, bed_K = 0.0;
  for (int i = 0; i < 300; ++i) {
    if (i % 30 == 0) rpm = kSpeeds_rpm[(static_cast<std::size_t>(i / 30) + 3 * seed) % kSpeeds_rpm.size()];
    const double air_degC = 20.0 + 0.01 * i;
    for (const auto& [channel, value] :
         {std::pair{0, rpm}, {1, air_degC}, {2, air_degC + head_K + 0.02 * random.normal()}, {3, air_degC + bed_K}})
      r.channels[static_cast<std::size_t>(channel)].values.push_back(value);
    r.time_s.push_back(60.0 * i);
    head_K += (6e-3 * rpm - head_K) / 30.0;  // with 30 min
    bed_K += (2e-3 * rpm - bed_K) / 120.0;
  }
  MachineRun run{.cyclogram = {.name = r.source, .sections = {}}, .ambient = {}, .readings = r};
  for (std::size_t i = 0; i < r.n_samples(); ++i) {
    run.cyclogram.sections.push_back({60.0, {.speed_rpm = r.channels[0].values[i]}});
    run.ambient.time_s.push_back(r.time_s[i]);
    run.ambient.value.push_back(r.channels[1].values[i] - 20.0);
  }
  std::vector<double> nose_um = live(truth, run);
  for (double& um : nose_um) um += kNoise_um * random.normal();
  run.readings.channels.push_back({"nose", "um", std::move(nose_um)});
  return run;
}

/// A predictor as `validate` deploys one: with a fail-safe for each of its inputs, learned from two runs.
DeployedPredictor deployed(std::shared_ptr<const Predictor> predictor) {
  DeployedPredictor d;
  d.name = "an added one";
  d.target = "nose";
  d.ambient = "air";
  d.predictor = std::move(predictor);
  d.interval_um = 1.96 * kNoise_um;
  std::vector<Record> training;
  std::vector<std::vector<double>> predicted_um;
  for (const std::uint64_t seed : {1, 2}) {
    const MachineRun run = machine(*d.predictor, seed);
    training.push_back(run.readings);
    predicted_um.push_back(live(*d.predictor, run));
  }
  for (const Input& input : guarded_inputs(*d.predictor)) d.sensors.push_back(input.name);
  d.fail_safe = learn_fail_safe(training, d.sensors, predicted_um, false);
  return d;
}

/// Judged on one run, with the verdict.
struct JudgedOnce {
  StrategyMatrix matrix;
  JudgedStrategy strategy;
  Judgement judgement;
};
JudgedOnce judged(const DeployedPredictor& d, const MachineRun& run) {
  JudgedOnce j;
  j.matrix.settings.strategies.target = d.target;
  j.matrix.settings.tolerance_um = 20.0;
  j.matrix.runs = {{.family = "work", .season = "", .name = "tuesday", .run = run}};
  j.strategy.fitted = d;
  j.judgement = judge(d, run, run.readings.at(d.target).values);
  j.strategy.cases = {j.judgement.scores};
  give_verdict(j.matrix, j.strategy);
  return j;
}

std::string path_of(const output::PredictorFile& file) {
  return driftwright::write_file("added.json", output::predictor_json(file, {"1", "a test"}).dump());
}

follow::Session session_of(const std::string& path, const Record& stream) {
  std::vector<follow::Session::Model> models;
  models.push_back({path, content_hash(read_bytes(path)), follow::followed_predictor(path, {})});
  follow::Session session(std::move(models));
  session.begin(stream.channels);
  return session;
}

follow::StreamRow row_of(const Record& r, std::size_t i) {
  follow::StreamRow row{.time_s = r.time_s[i], .values = {}};
  for (const Channel& c : r.channels) row.values.push_back(c.values[i]);
  return row;
}

struct Added {
  const char* kind;
  std::shared_ptr<const Predictor> (*make)();
};
class AnAddedPredictor : public ::testing::TestWithParam<Added> {};
INSTANTIATE_TEST_SUITE_P(
    OfEachSort, AnAddedPredictor,
    ::testing::Values(
        Added{"lever", []() -> std::shared_ptr<const Predictor> { return std::make_shared<Lever>("head", "bed", 0.6); }},
        Added{"warm_head", []() -> std::shared_ptr<const Predictor> { return std::make_shared<WarmHead>(0.5, 1e-3); }}),
    [](const auto& one) { return std::string(one.param.kind); });

TEST_P(AnAddedPredictor, IsJudgedAndGuarded) {
  const DeployedPredictor d = deployed(GetParam().make());
  MachineRun run = machine(*d.predictor, 3);
  const Judgement intact = judged(d, run).judgement;
  EXPECT_LT(intact.scores.after.rmse, 0.3 * intact.scores.before.rmse);
  std::vector<double>& head_degC = run.readings.channels[2].values;
  std::fill(head_degC.begin() + 150, head_degC.end(), 150.0);  // a broken wire; the bare prediction follows it
  const Judgement broken = judged(d, run).judgement;
  EXPECT_GT(broken.scores.peak_unguarded_um, 50.0);
  EXPECT_LT(broken.scores.after.peak_abs, 0.3 * broken.scores.peak_unguarded_um);
  EXPECT_THAT(broken.scores.events, ::testing::Contains(HasSubstr("head")));
}

TEST_P(AnAddedPredictor, IsFollowedFromItsFileAsItWasJudged) {
  const DeployedPredictor d = deployed(GetParam().make());
  const MachineRun run = machine(*d.predictor, 3);
  const Record& r = run.readings;
  const JudgedOnce j = judged(d, run);
  const Json verdict = judgement_json(j.matrix, j.strategy);
  const std::string path = path_of({d, verdict});
  const Json file = Json::parse(read_bytes(path));
  EXPECT_EQ(file["predictor"], GetParam().kind);
  EXPECT_EQ(output::predictor_json(output::read_predictor(path), {"1", "a test"}), file);

  follow::Session session = session_of(path, r);
  for (std::size_t i = 0; i < r.n_samples(); ++i) {
    const follow::FollowLine line = session.take(row_of(r, i));
    ASSERT_EQ(line.axes.size(), 1u);
    ASSERT_NEAR(line.axes[0].predicted_um, j.judgement.correction_um[i], 1e-9) << i;
    EXPECT_EQ(line.axes[0].verdict, "safe to deploy");
    if (i != 140) continue;  // a restart
    const nlohmann::ordered_json state = session.state();
    session = session_of(path, r);
    session.recall(state);
  }
}

TEST_P(AnAddedPredictor, GoesToAControlIfItGivesAFormula) {
  const DeployedPredictor d = deployed(GetParam().make());
  const DriftModel* formula = d.predictor->formula();
  if (!formula) {
    EXPECT_THAT([&] { (void)output::deployed_model(d); },
                ThrowsMessage<std::logic_error>(AllOf(HasSubstr("'an added one'"), HasSubstr("Predictor::formula()"))));
    return;
  }
  const MachineRun run = machine(*d.predictor, 3);
  EXPECT_EQ(formula->predict(run.readings), live(*d.predictor, run));
  const std::string c = output::c_function(output::deployed_model(d), "a test");
  EXPECT_THAT(c, HasSubstr("double nose_correction_um(nose_state *s, double head_degC, double bed_degC, double dt_s)"));
  EXPECT_THAT(c, HasSubstr("#define NOSE_TERMS 2"));
}

TEST_P(AnAddedPredictor, IsNeitherWrittenNorReadUnguarded) {
  output::PredictorFile file{.predictor = deployed(GetParam().make()), .judged = nullptr};
  const Json whole = output::predictor_json(file, {"1", "a test"});
  FailSafe& safe = *file.predictor.fail_safe;
  safe.guards.erase(safe.guards.begin());
  EXPECT_THAT(
      [&] {
        (void)output::predictor_json(file, {"1", "a test"});
      },
      ThrowsMessage<std::logic_error>(HasSubstr("reads 'head' in degC without a guard")));
  file.predictor.fail_safe.reset();
  EXPECT_THROW((void)output::predictor_json(file, {"1", "a test"}), std::logic_error);
  Json null = whole, none = whole;
  null["fail_safe"] = nullptr;
  none["fail_safe"]["guards"] = Json::array();
  for (const Json& unguarded : {null, none}) {
    const std::string path = driftwright::write_file("unguarded.json", unguarded.dump());
    EXPECT_THAT([&] { (void)output::read_predictor(path); },
                ThrowsMessage<InputError>(AllOf(HasSubstr("unguarded.json"), HasSubstr("'head' in degC has no guard"))));
  }
}

TEST(PredictorKinds, AreNamedWhereAFileHasAnother) {
  Json file = output::predictor_json({.predictor = deployed(std::make_shared<WarmHead>(0.5, 1e-3)), .judged = nullptr},
                                     {"1", "a test"});
  file["predictor"] = "oracle";
  const std::string path = driftwright::write_file("oracle.json", file.dump());
  EXPECT_REFUSED(output::read_predictor(path), "formula, observer, constant, earlier_runs, lever, warm_head are known");
}

/// Of a kind that no list names.
class Nameless final : public Predictor {
 public:
  [[nodiscard]] std::vector<Input> inputs() const override { return {}; }
  [[nodiscard]] bool is_driven() const override { return false; }
  [[nodiscard]] std::optional<Written> written() const override { return Written{.kind = "nameless", .content = {}}; }
  [[nodiscard]] std::unique_ptr<Follower> follow() const override { return nullptr; }
};

TEST(PredictorKinds, OfNoListAndPredictorsThatAreNotStoredAreNotWritten) {
  output::PredictorFile file;
  file.predictor.name = "it";
  file.predictor.predictor = std::make_shared<Nameless>();
  EXPECT_THAT(
      [&] {
        (void)output::predictor_json(file, {"1", "a test"});
      },
      ThrowsMessage<std::logic_error>(AllOf(HasSubstr("'nameless'"), HasSubstr("PREDICTOR_KINDS"))));
  file.predictor.predictor = std::make_shared<DrivenPredictor>(
      [](const Cyclogram&, const TimeSeries&, const std::vector<double>& time_s) { return time_s; });
  EXPECT_THAT(
      [&] {
        (void)output::predictor_json(file, {"1", "a test"});
      },
      ThrowsMessage<std::logic_error>(HasSubstr("'it' is not stored in files")));
}

}  // namespace
}  // namespace added_predictor_test
}  // namespace driftwright::compensation
