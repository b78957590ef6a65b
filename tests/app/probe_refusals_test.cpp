// What `probe-plan` and `validate --probe` refuse, in this process: starting the program for each line would take longer
// than all of them.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <filesystem>
#include <functional>

#include "app/verbs.hpp"
#include "base/errors.hpp"
#include "compensation/predictors/formula_predictor.hpp"
#include "output/predictor_file.hpp"
#include "tests/shared/deployed_model.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::app::probe_refusals_test {
namespace {

using ::testing::HasSubstr, ::testing::ThrowsMessage;

constexpr const char* kShop = R"(name: shop
reference_temperature: 20 degC
ambient: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: spindle, capacity: 6 kJ/K}
  - {type: heat_source, node: spindle, power: 60 W, at_speed: 3000 rpm, exponent: 1}
  - {type: link, node: spindle, to: ambient, conductance: 5 W/K}
sensors: [{name: t_spindle, node: spindle}]
displacements: [{name: nose_z, sensitivities: [{node: spindle, sensitivity: 2 um/K}]}]
cyclograms: {shift: [[50 min, 3000 rpm], [20 min, 0 rpm], [40 min, 1500 rpm]], still: [[60 min, 0 rpm]]}
)";

/// A model's file of `validate` for this displacement.
std::string model_of(const std::string& file, const std::string& target, bool knows_process = true) {
  output::DeployedModel model = fixtures::deployed(true, 60.0);
  output::PredictorFile written;
  compensation::DeployedPredictor& d = written.predictor;
  d.name = "regression with lags";
  d.target = target;
  d.from_start = true;
  d.sensors = {"X1", "X2", "X3", "X4"};
  d.ambient = "X4";
  d.reason = "because";
  d.fail_safe = std::move(model.safe);
  d.predictor = std::make_shared<compensation::FormulaPredictor>(std::move(model.model));
  d.interval_um = model.interval_um;
  if (knows_process) d.residual = compensation::ResidualProcess{5.0, 7200.0};
  return write_file(file, predictor_json(written, {"1", "a test"}).dump());
}

/// A shop's scenario and model, and options that plan; a test changes one of them.
struct Shop {
  std::string scenario = write_file("plain.yaml", kShop);
  std::string model = model_of("model.json", "nose_z");
  std::string results = (temporary_folder() / "refused").string();

  [[nodiscard]] ProbePlanOptions options() const {
    ProbePlanOptions o;
    o.scenario = scenario;
    o.out = results;
    o.quiet = true;
    o.job = "shift";
    o.model = model;
    return o;
  }
  void expect_refused(const std::function<void(ProbePlanOptions&)>& change, const std::string& says) const {
    ProbePlanOptions o = options();
    change(o);
    EXPECT_REFUSED(probe_plan(o), says);
    EXPECT_FALSE(std::filesystem::exists(results)) << says;
  }
};

TEST(ProbePlanRefuses, GaugesThatAreNoThreeLengths) {
  const Shop shop;
  shop.expect_refused([](auto& o) { o.gauge = "1 mm, 2 mm"; }, "three lengths with commas are required");
  shop.expect_refused([](auto& o) { o.gauge = "1 mm, 2 mm, 3 mm, 4 mm"; }, "three lengths with commas are required");
  shop.expect_refused([](auto& o) { o.gauge = "1, 2 mm, 3 mm"; }, "--gauge '1': '1' has no unit");
  shop.expect_refused([](auto& o) { o.gauge = "1 mm, 2 mm, 300 m"; }, "--gauge ' 300 m': -100 m to 100 m is allowed");
  shop.expect_refused([](auto& o) { o.gauge = "1 mm, 2 mm, 3 mm"; }, "--probe-tool is required");
}

TEST(ProbePlanRefuses, JobsThatAreNoneOrHaveNoWork) {
  const Shop shop;
  shop.expect_refused([](auto& o) { o.job = "nothing"; }, "there is no cyclogram 'nothing'");
  shop.expect_refused([](auto& o) { o.job = "nope.ngc"; }, "nope.ngc: there is no such file");
  shop.expect_refused([](auto& o) { o.job = "still"; }, "cyclogram 'still': nothing is driven in it");
  shop.expect_refused([](auto& o) { o.job = write_file("part.ngc", "G21 G90\nG4 P1200\nM2\n"); }, "key `schedule`");
}

TEST(ProbePlanRefuses, FilesThatAreNoModelOfTheMachine) {
  const Shop shop;
  shop.expect_refused([&](auto& o) { o.model = shop.scenario; }, "plain.yaml: this is not valid JSON");
  shop.expect_refused([](auto& o) { o.model = temporary_folder().string(); }, "this is a folder");
  shop.expect_refused([](auto& o) { o.model = model_of("mute.json", "nose_z", false); }, "key `probing` is null");
  shop.expect_refused([](auto& o) { o.model = model_of("other.json", "drift_y"); },
                      "its target 'drift_y' is no displacement of " + shop.scenario + ", which has nose_z");
  std::string broken = read_text(shop.model);
  broken.replace(broken.find("7200"), 4, "7201");
  shop.expect_refused([&](auto& o) { o.model = write_file("broken.json", broken); }, "key `hash`");
}

TEST(ProbePlanRefuses, PointsThatTheRecordsDoNotHave) {
  const Shop shop;
  const std::string rings = write_file("rings.csv", "time_s,ring_1_um,ring_2_um\n0,0,0\n60,1,2\n120,2,1\n180,3,5\n");
  const std::string one = write_file("one.csv", "time_s,ring_1_um\n0,0\n60,1\n120,2\n");
  shop.expect_refused(
      [&](auto& o) {
        o.points = {rings};
        o.counting = {"ring_9"};
      },
      "ring_9");
  shop.expect_refused([&](auto& o) { o.points = {one}; }, "two displacements");
}

TEST(ProbePlanRefuses, QuantitiesOutsideTheirRange) {
  const Shop shop;
  shop.expect_refused([](auto& o) { o.tolerance = "0 um"; }, "--tolerance '0 um'");
  shop.expect_refused([](auto& o) { o.tolerance = "5"; }, "--tolerance '5'");
  shop.expect_refused([](auto& o) { o.margin = "110 %"; }, "--margin '110 %': 0 % to 95 % is allowed");
  shop.expect_refused([](auto& o) { o.margin = "5 um"; }, "a share, such as 20 %");
  shop.expect_refused([](auto& o) { o.noise = "0 um"; }, "--probe-noise");
  shop.expect_refused([](auto& o) { o.lag = "-1 s"; }, "--probe-lag");
  shop.expect_refused([](auto& o) { o.probing_time = "2 h"; }, "--probing-time");
  shop.expect_refused([](auto& o) { o.between = "x"; }, "--between");
}

TEST(ValidateRefuses, ProbingsWithoutTimes) {
  const Shop shop;
  RecordOptions options;
  options.scenario = shop.scenario;
  options.out = shop.results;
  options.quiet = true;
  options.target = "nose_z";
  const auto run = [](const std::string& file, int um_per_K) {
    std::string rows = "time_s,speed_rpm,t_spindle_degC,nose_z_um\n";
    for (int i = 0; i < 120; ++i)
      rows += fmt::format("{},{},{},{}\n", 60 * i, i < 60 ? 3000 : 0, 20 + i % 60, um_per_K * (i % 60));
    return write_file(file, rows);
  };
  options.train = {run("a.csv", 2)};
  options.test = {run("c.csv", 3)};
  const auto refused = [&](const std::string& probe, const std::string& probing_time) {
    options.probe = probe;
    options.probing_time = probing_time;
    return [options] { validate(options); };
  };
  EXPECT_THAT(refused("60 min,", "2 min"), ThrowsMessage<InputError>(HasSubstr("--probe ''")));
  EXPECT_THAT(refused("60 min, 0 min", "2 min"), ThrowsMessage<InputError>(HasSubstr("--probe '60 min, 0 min'")));
  EXPECT_THAT(refused("60 min", "2"), ThrowsMessage<InputError>(HasSubstr("--probing-time '2'")));
  EXPECT_FALSE(std::filesystem::exists(shop.results));
}

}  // namespace
}  // namespace driftwright::app::probe_refusals_test
