// Functional mock-up units as an importer of the standard runs them: the numbers of `predict` and of the observer, in
// both versions, in co-simulation at any step and in model exchange with the importer's own integrator. The milling machine;
// fmu_laws_test.cpp has others.

#include <random>
#include <thread>

#include "compensation/predictors/residual_process.hpp"
#include "studies/prediction.hpp"
#include "tests/fmu/unit.hpp"
#include "tests/shared/edited_text.hpp"

namespace driftwright::output::fmu_test {
namespace {

using fixtures::replaced;
using ::testing::HasSubstr;

/// The milling machine, reduced once for all tests.
struct Fp3 {
  scenarios::Scenario scenario = scenarios::read_scenario("scenarios/fp3_spindle.yaml");
  scenarios::Model model = scenarios::open_model(scenario, {}, {}, false);
  FmuModel fmu = machine_fmu(scenario, *model.reduced());
  std::vector<std::string> outputs = names_of(fmu.outputs);

  static const Fp3& get() {
    static const Fp3 fp3;
    return fp3;
  }
  [[nodiscard]] FmuOrder order(FmiVersion version) const { return {.model = fmu, .version = version}; }
  /// What `predict` says, at full precision.
  [[nodiscard]] Record predicted(const std::string& cyclogram) const {
    return studies::predict_drift(scenario, scenario.cyclogram(cyclogram), {}, {}, "a test").record;
  }
  void expect_as(const Record& predicted, const Told& told, double most) const {
    for (std::size_t o = 0; o < outputs.size(); ++o)
      EXPECT_LT(largest_gap(told.of[o], predicted.at(outputs[o]).values, predicted.n_samples()), most) << outputs[o];
  }
};

class Fmu : public OfBothVersions {};
INSTANTIATE_TEST_SUITE_P(Versions, Fmu, ::testing::Values(FmiVersion::k2, FmiVersion::k3), kVersionName);

TEST_P(Fmu, InCoSimulationIsWhatPredictSaysWhateverTheStep) {
  const Fp3& fp3 = Fp3::get();
  const Unit unit(fp3.order(GetParam()), name("steps"));
  for (const char* cyclogram : {"chaotic", "heat_cool_1000", "heat_cool_2000"}) {
    const Record predicted = fp3.predicted(cyclogram);
    const Told minutes = import_unit(unit, speed_of(predicted), fp3.outputs, {}),
               seconds = import_unit(unit, speed_of(predicted), fp3.outputs, {.step_s = 1.0});
    fp3.expect_as(predicted, minutes, kSame_um);
    fp3.expect_as(predicted, seconds, kSame_um);
    for (std::size_t o = 0; o < fp3.outputs.size(); ++o)
      EXPECT_LT(largest_gap(minutes.of[o], seconds.of[o], predicted.n_samples()), kSame_um) << fp3.outputs[o];
    EXPECT_EQ(minutes.run.allocated, 0) << "no memory is taken after the start";
    RecordProperty(std::string("seconds_") + cyclogram, std::to_string(minutes.run.seconds));
  }
}

TEST_P(Fmu, InModelExchangeIsTheSameByTheImportersIntegrator) {
  const Fp3& fp3 = Fp3::get();
  const Unit unit(fp3.order(GetParam()), name("exchange"));
  ASSERT_EQ(unit.states.size(), static_cast<std::size_t>(fp3.fmu.start.size()));
  const Record predicted = fp3.predicted("chaotic");
  // Rows where the speed changes, and the end: between them the integrator is alone, but for the knots of the ambient.
  Record inputs = speed_of(predicted), rows{.source = "rows", .time_s = {}, .channels = {{"spindle_speed", "rpm", {}}}};
  std::vector<std::size_t> at;
  for (std::size_t i = 0; i < inputs.n_samples(); ++i) {
    const std::vector<double>& speed = inputs.channels[0].values;
    if (i > 0 && i + 1 < inputs.n_samples() && speed[i] == speed[i - 1]) continue;
    rows.time_s.push_back(inputs.time_s[i]);
    rows.channels[0].values.push_back(speed[i]);
    at.push_back(i);
  }
  const Told told = import_unit(unit, rows, fp3.outputs, {.co_simulation = false});
  for (std::size_t o = 0; o < fp3.outputs.size(); ++o) {
    std::vector<double> wanted;
    for (std::size_t i : at) wanted.push_back(predicted.at(fp3.outputs[o]).values[i]);
    EXPECT_LT(largest_gap(told.of[o], wanted, wanted.size()), kSame_um) << fp3.outputs[o];
  }
  EXPECT_EQ(told.run.n_events, static_cast<int>(rows.n_samples()) + 1)
      << "one at each row, and the ambient's knot at 120 min";
  EXPECT_LT(told.run.jacobian_gap, 1e-6) << "directional derivatives along states and speed, against differences";
}

TEST_P(Fmu, TakesTheAmbientAsAnInput) {
  const Fp3& fp3 = Fp3::get();
  const Unit unit(fp3.order(GetParam()), name("ambient"));
  const Record predicted = fp3.predicted("chaotic");
  Record inputs = speed_of(predicted);
  inputs.channels.push_back(ambient_of(fp3.scenario, inputs));
  fp3.expect_as(predicted, import_unit(unit, inputs, fp3.outputs, {.step_s = 7.0, .ambient_from_input = 1}), kSame_um);
  // Of a machine that starts as warm as its ambient, in an ambient that is 3 K warmer all the time, everything is as much
  // warmer.
  FmuOrder order = fp3.order(GetParam());
  order.model.start_follows_ambient = true;
  for (double& value : inputs.channels[1].values) value += 3.0;
  const Told warmer = import_unit(Unit(order, name("warmer")), inputs, {"t11"}, {.ambient_from_input = 1});
  for (std::size_t i = 0; i < predicted.n_samples(); ++i)
    EXPECT_NEAR(warmer.of[0][i], predicted.at("t11").values[i] + 3.0, 1e-6);
}

TEST_P(Fmu, GoesOnFromAStateThatWasWrittenAndRead) {
  const Fp3& fp3 = Fp3::get();
  const Unit unit(fp3.order(GetParam()), name("state"));
  const Record predicted = fp3.predicted("chaotic");
  fp3.expect_as(predicted, import_unit(unit, speed_of(predicted), fp3.outputs, {.rewind_at_row = 57}), kSame_um);
}

TEST_P(Fmu, ItsSourcesGiveTheNumbersOfItsBinary) {
  const Fp3& fp3 = Fp3::get();
  const Unit unit(fp3.order(GetParam()), name("sources"));
  const Record inputs = speed_of(fp3.predicted("chaotic"));
  EXPECT_EQ(import_unit(unit, inputs, fp3.outputs, {}).of, import_unit(of_sources(unit), inputs, fp3.outputs, {}).of);
}

TEST_P(Fmu, MakesNoInstanceOfABinaryThatWasCutShort) {
  const Unit unit(Fp3::get().order(GetParam()), name("cut"));
  std::filesystem::resize_file(unit.library, std::filesystem::file_size(unit.library) - 8);
  (void)import_unit(unit, {}, {}, {.fails_with = "cannot be read; the file is not complete"});
}

TEST_P(Fmu, RunsTwiceAtOnce) {
  const Fp3& fp3 = Fp3::get();
  const Unit unit(fp3.order(GetParam()), name("threads"));
  const Record one = fp3.predicted("chaotic"), other = fp3.predicted("heat_cool_2000");
  Told of_one, of_other;
  std::thread first([&] { of_one = import_unit(unit, speed_of(one), fp3.outputs, {.step_s = 1.0}); });
  std::thread second([&] { of_other = import_unit(unit, speed_of(other), fp3.outputs, {.step_s = 1.0}); });
  first.join();
  second.join();
  fp3.expect_as(one, of_one, kSame_um);
  fp3.expect_as(other, of_other, kSame_um);
}

TEST_P(Fmu, IsValidByTheSchemaAndTheSameBytesEachTime) {
  const Fp3& fp3 = Fp3::get();
  const Unit unit(fp3.order(GetParam()), name("schema"));
  expect_valid(unit);
  EXPECT_EQ(unit.files, Unit(fp3.order(GetParam()), name("again")).files);
}

/// Readings with noise, one of which goes wrong, two thermometers that are exchanged later, and an ambient's thermometer
/// that jumps for longer than the rows that the observer goes back.
MachineRun troubled_run(const Fp3& fp3) {
  const Record predicted = fp3.predicted("chaotic");
  MachineRun run{.cyclogram = fp3.scenario.cyclogram("chaotic"), .ambient = {}, .readings = predicted};
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 0.1);
  for (Channel& c : run.readings.channels) {
    if (c.unit != "degC") continue;
    for (std::size_t i = 0; i < c.values.size(); ++i) {
      c.values[i] += noise(random);
      if (c.name == "t05" && i > 120) c.values[i] = 35.0;
      if (c.name == "t06" && i % 17 == 3) c.values[i] = NAN;
    }
  }
  std::vector<double>& t07 = changeable_channel(run.readings, "t07").values;
  std::vector<double>& t10 = changeable_channel(run.readings, "t10").values;
  for (std::size_t i = 180; i < t07.size(); ++i) std::swap(t07[i], t10[i]);
  for (std::size_t i = 0; i < predicted.n_samples(); ++i) {
    run.ambient.time_s.push_back(predicted.time_s[i]);
    run.ambient.value.push_back(fp3.scenario.machine->ambient.at(predicted.time_s[i]) + (i > 60 && i < 100 ? 6.0 : 0.0));
  }
  return run;
}

Record inputs_of(const Fp3& fp3, const compensation::Observer& observer, const MachineRun& run) {
  Record inputs = speed_of(run.readings);
  Channel ambient{"ambient_temperature", "degC", {}};
  for (double v : run.ambient.value) ambient.values.push_back(v + fp3.scenario.machine->reference_K - kZeroCelsius_K);
  inputs.channels.push_back(ambient);
  for (const std::string& s : observer.sensors()) inputs.channels.push_back(run.readings.at(s));
  return inputs;
}

// Both run the same C; the test is of what is exported to it: numbers, laws as tables, samples, rows of the past.
TEST_P(Fmu, OfAnObserverSaysWhatTheObserverSays) {
  const Fp3& fp3 = Fp3::get();
  const scenarios::ReducedMachine& reduced = *fp3.model.reduced();
  compensation::Observer observer(reduced.system, reduced.start, fp3.fmu.start_ambient_K, {"t05", "t06", "t07", "t10"},
                                  "drift_y");
  const MachineRun run = troubled_run(fp3);
  MachineRun lesson = run;
  lesson.readings = fp3.predicted("chaotic");
  for (Channel& c : lesson.readings.channels) {
    if (c.name != "drift_y") continue;
    for (double& v : c.values) v *= 1.05;
  }
  observer.learn(std::span(&lesson, 1));  // what it has learned goes along
  const compensation::Observation seen = observer.observe(run);
  ASSERT_EQ(seen.distrusted.size(), 2u) << "the ambient thermometer, and t05";
  const Unit unit({.model = observer_fmu(fp3.scenario, observer), .version = GetParam()}, name("observer"));
  Record inputs = inputs_of(fp3, observer, run);
  const std::vector<std::string> outputs = {"drift_y",     "drift_y_deviation", "model.drift_y",
                                            "doubted.t05", "doubted.t06",       "trust"};
  const std::size_t n = inputs.n_samples() - 1;  // the last row begins no step
  std::vector<double> believed;
  for (Eigen::Index i = 0; i < seen.outputs.cols(); ++i)
    believed.push_back(
        1e6 * seen.outputs(std::find(reduced.system.outputs.name.begin(), reduced.system.outputs.name.end(), "drift_y") -
                               reduced.system.outputs.name.begin(),
                           i));
  std::vector<double> trust;
  const auto follower = observer.follow();
  for (std::size_t i = 0; i < run.readings.n_samples(); ++i) {
    (void)follower->next(run);
    trust.push_back(follower->deserved_trust());
  }
  EXPECT_LT(*std::min_element(trust.begin(), trust.end()), 0.999) << "while two thermometers are exchanged";
  const auto expect_it = [&](const Told& told) {
    EXPECT_LT(largest_gap(told.of[0], seen.drift_um, n), kSame_um);
    EXPECT_LT(largest_gap(told.of[1], seen.deviation_um, n), kSame_um);
    EXPECT_LT(largest_gap(told.of[2], believed, n), kSame_um);
    EXPECT_EQ(told.of[3][100], 0.0);
    EXPECT_EQ(told.of[3][n - 1], 1.0) << "t05 fell out";
    EXPECT_EQ(told.of[4][n - 1], 0.0);
    EXPECT_LT(largest_gap(told.of[5], trust, n), kSame_um);
  };
  const Told told = import_unit(unit, inputs, outputs, {.tells_behind_step = true});
  expect_it(told);
  const Told other = import_unit(of_sources(unit), inputs, outputs, {.tells_behind_step = true});
  for (std::size_t o = 0; o < outputs.size(); ++o) EXPECT_EQ(largest_gap(told.of[o], other.of[o], n), 0.0) << outputs[o];
  expect_it(import_unit(unit, inputs, outputs, {.step_s = 20.0, .rewind_at_row = 130, .tells_behind_step = true}));
  const Told exchanged = import_unit(unit, inputs, outputs, {.co_simulation = false});
  EXPECT_LT(largest_gap(exchanged.of[0], seen.drift_um, n + 1), kSame_um);
}

// Probings on a unit: four of a machine that is 8 um off, one of a chip, one that missed, at rows of samples, and one
// between two samples, which counts at the next. The numbers are those of the filter of the program on the drift times
// trust.
TEST_P(Fmu, OfAnObserverTakesProbings) {
  const Fp3& fp3 = Fp3::get();
  const scenarios::ReducedMachine& reduced = *fp3.model.reduced();
  const compensation::Observer observer(reduced.system, reduced.start, fp3.fmu.start_ambient_K, {"t05", "t06", "t07", "t10"},
                                        "drift_y");
  const MachineRun run = troubled_run(fp3);
  const compensation::Observation seen = observer.observe(run);
  const probe_process process{4.0, 5400.0, 0.5, 90.0, 1};
  const Unit unit({.model = observer_fmu(fp3.scenario, observer, process), .version = GetParam()}, name("probed"));
  Record inputs = inputs_of(fp3, observer, run);
  const std::size_t n = inputs.n_samples() - 1;  // the last row begins no step
  Channel probed{"probe_drift_y", "um", std::vector<double>(n + 1, 0.0)},
      strobe{"probe_strobe", "", std::vector<double>(n + 1, 0.0)};
  const auto probe = [&](std::size_t row, double um) {
    probed.values[row] = um;
    strobe.values[row] = 1.0;
  };
  for (std::size_t row : {20, 80, 140, 200}) probe(row, seen.drift_um[row] + 8.0);
  probe(110, seen.drift_um[110] + 300.0);
  probe(160, NAN);
  strobe.values[201] = 1.0;  // it stays on: no further probing
  inputs.channels.push_back(probed);
  inputs.channels.push_back(strobe);
  compensation::ProbeFeedback feedback(std::vector<probe_process>{process});
  std::vector<double> correction, residual, deviation, verdict, refused;
  const auto follower = observer.follow();
  for (std::size_t i = 0; i < n; ++i) {
    const double drift_um = follower->next(run), predicted_um = follower->deserved_trust() * drift_um;
    feedback.row(predicted_um, 0.0, i > 0 ? inputs.time_s[i] - inputs.time_s[i - 1] : 0.0);
    if (i > 0 && strobe.values[i] > strobe.values[i - 1]) (void)feedback.probe_drift_um(probed.values[i]);
    residual.push_back(feedback.estimate_um());
    correction.push_back(predicted_um + residual.back());
    deviation.push_back(feedback.deviation_um());
    verdict.push_back(feedback.state().verdict);
    refused.push_back(feedback.n_refused());
  }
  const std::vector<std::string> outputs = {"correction", "probe_residual", "probe_deviation", "probe_verdict",
                                            "refused_probings"};
  const auto expect_it = [&](const Told& told) {
    EXPECT_LT(largest_gap(told.of[0], correction, n), kSame_um);
    EXPECT_LT(largest_gap(told.of[1], residual, n), kSame_um);
    EXPECT_LT(largest_gap(told.of[2], deviation, n), kSame_um);
    EXPECT_EQ(largest_gap(told.of[3], verdict, n), 0.0);
    EXPECT_EQ(largest_gap(told.of[4], refused, n), 0.0);
  };
  expect_it(import_unit(unit, inputs, outputs, {.tells_behind_step = true}));
  expect_it(import_unit(of_sources(unit), inputs, outputs, {.tells_behind_step = true}));
  expect_it(import_unit(unit, inputs, outputs, {.step_s = 20.0, .rewind_at_row = 130, .tells_behind_step = true}));
  EXPECT_GT(residual[90], 3.0);  // a part of what is off
  EXPECT_EQ(verdict[110], PROBE_UNLIKELY);
  EXPECT_EQ(verdict[160], PROBE_NO_NUMBER);
  EXPECT_EQ(refused.back(), 2.0);
}
TEST(DriveLaw, IsMetToRoundingWhateverItsFormula) {
  const std::vector<DriveRange> ranges = {{DriveVariable::kSpeed, 3000.0}, {DriveVariable::kFeedX, 5000.0}};
  const auto law = [](const Drive& d) {
    const double n = d.speed_rpm, v = d.feed_m_s[0];
    const double kinked = 3.0 * std::max(120.0, std::pow(n, 2.0 / 3.0));  // as a bearing's oil at low speed
    return 7.0 + (n > 0.0 ? 1e-3 * kinked * n : 0.0) + 2.0 * std::pow(n / 2000.0, 0.7) + 900.0 * v;
  };
  const std::optional<DriveLaw> table = tabulated(law, ranges);
  ASSERT_TRUE(table);
  for (double n : {0.0, 1e-2, 1.0, 17.0, 250.0, 1310.0, 1314.534, 1315.0, 2999.0, 3000.0}) {
    for (double v : {0.0, 3.0, 4999.0}) {
      Drive d{.speed_rpm = n};
      set_value(DriveVariable::kFeedX, d, v);
      EXPECT_NEAR(table->at({n, v}), law(d), 1e-11 * law(d)) << n << " rpm, " << v << " mm/min";
    }
  }
  const auto geared = [](const Drive& d) { return (d.speed_rpm < 1200.0 ? 1.7 : 1.0) * d.speed_rpm; };
  const std::optional<DriveLaw> stage = tabulated(geared, ranges);
  ASSERT_TRUE(stage);
  for (double n : {600.0, 1199.99, 1200.01, 3000.0})
    EXPECT_NEAR(stage->at({n, 0.0}), geared({.speed_rpm = n}), 1e-11 * n) << n << " rpm";
  EXPECT_NEAR(stage->at({1200.0, 0.0}), 1200.0, 1e-9 * 1200.0);  // at the very speed of the change: a piece 1e-9 wide
  // As a film of a file between two of its speeds: nothing up to 1200 rpm, and few digits just above.
  const auto begins = [](const Drive& d) { return std::max(d.speed_rpm - 1200.0, 0.0) / 800.0; };
  const std::optional<DriveLaw> from_1200 = tabulated(begins, ranges);
  ASSERT_TRUE(from_1200);
  for (double n : {0.0, 600.0, 1199.99, 1200.01, 1201.0, 1999.0, 3000.0})
    EXPECT_NEAR(from_1200->at({n, 0.0}), begins({.speed_rpm = n}), 2e-14) << n << " rpm";
  EXPECT_TRUE(tabulated([](const Drive&) { return 5.0; }, ranges)->terms.empty());
  EXPECT_FALSE(tabulated([](const Drive& d) { return d.speed_rpm * d.feed_m_s[0]; }, ranges)) << "two variables together";
}

/// One body, its heat by speed, one more by feed; linear.
constexpr const char* kHead = R"(name: head
reference_temperature: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: head, capacity: 60 kJ/K}
  - {type: motor_loss, node: head, power: 300 W, at_speed: 2000 rpm, exponent: 1}
  - {type: link, node: head, to: ambient, conductance: 20 W/K}
start: ambient
ambient: [[0 h, 20 degC], [9 h, 20 degC]]
sensors: [{name: t_head, node: head}]
displacements: [{name: nose_z, sensitivities: [{node: head, sensitivity: 4 um/K}]}]
cyclograms:
  morning: [[60 min, 2000 rpm], [20 min, 500 rpm]]
)";

TEST(ExportVerb, WritesOneFileWithAReference) {
  const std::filesystem::path folder = fresh_folder("verb");
  const std::string file = driftwright::write_file("head.yaml", kHead);
  for (const char* version : {"2", "3"}) {
    const std::filesystem::path target = folder / (std::string("head") + version + ".fmu");
    const CommandOutcome done = run_program(fmt::format("export {} --fmu --fmi {} -o {}", file, version, target.string()));
    ASSERT_EQ(done.exit_code, 0) << done.output;
    const auto files = unzipped(target);
    for (const char* inside : {"modelDescription.xml", "sources/machine.c", "sources/model_data.c",
                               "documentation/index.html", "resources/reference_in.csv", "resources/reference_out.csv"})
      EXPECT_TRUE(files.contains(inside)) << inside;
    EXPECT_TRUE(files.contains(version[0] == '2' ? "binaries/linux64/head.so" : "binaries/x86_64-linux/head.so"));
    // 60 um with 50 min of time constant: nose_z after the first hour.
    const std::string& out = files.at("resources/reference_out.csv");
    const auto row = out.find("\n3600,");
    ASSERT_NE(row, std::string::npos);
    EXPECT_NEAR(std::stod(out.substr(out.find_last_of(',', out.find('\n', row + 1)) + 1)), 60.0 * -std::expm1(-1.2), 1e-6);
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 2) << "and nothing beside";
}

TEST(ExportVerb, RefusesInWordsWhatItCannotExport) {
  const auto refused = [](const std::string& yaml, const std::string& arguments, const std::string& why) {
    const CommandOutcome outcome =
        run_program(fmt::format("export {} {}", driftwright::write_file("refused.yaml", yaml), arguments));
    EXPECT_EQ(outcome.exit_code, 2) << outcome.output;
    EXPECT_THAT(outcome.output, HasSubstr(why));
  };
  const std::string target = "-o " + (fresh_folder("refused") / "x.fmu").string();
  refused(kHead, target, "--fmu");
  refused(kHead, "--fmu -o x.zip", "end with .fmu");
  refused(kHead, "--fmu --of observer " + target, "--model FILE");
  refused(kHead, "--fmu --model x.json " + target, "--of observer");
  refused(kHead, "--fmu --fmi 1 " + target, "--fmi");
  refused(replaced(kHead, "effects:\n", "effects:\n  - {type: sensor_bias, sensor: t_head, bias: 1 K}\n"), "--fmu " + target,
          "sensor_bias t_head");
  refused(replaced(kHead, "exponent: 1}", "exponent: 1, from: 1 h, until: 2 h}"), "--fmu " + target, "acts for a time");
  refused(
      replaced(kHead, "effects:\n",
               "effects:\n  - {type: friction_law, node: head, power: 9 W, decay: 0.02 1/K}\n  - {type: changed_law, law: "
               "friction_law head, growth_beyond: 0, beyond: 1000 rpm}\n"),
      "--fmu " + target, "follows temperatures of the machine, and has no formula");
  refused(replaced(kHead, "name: t_head", "name: spindle_speed"), "--fmu " + target, "rename");
  EXPECT_FALSE(std::filesystem::exists(fresh_folder("refused") / "x.fmu"));
}

}  // namespace
}  // namespace driftwright::output::fmu_test