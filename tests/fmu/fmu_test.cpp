// Functional mock-up units as an importer of the standard runs them: the numbers of `predict` and of the observer, in
// both versions, in co-simulation at any step and in model exchange with the importer's own integrator. One file: one
// importer runs all units.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <minizip/unzip.h>

#include <cmath>
#include <cstdlib>
#include <random>
#include <regex>
#include <thread>

#include "base/quantity.hpp"
#include "base/record_channel.hpp"
#include "compensation/predictors/residual_process.hpp"
#include "output/fmu/fmu_file.hpp"
#include "studies/prediction.hpp"
#include "tests/fmu/importer.h"
#include "tests/shared/command_line.hpp"
#include "tests/shared/edited_text.hpp"

namespace driftwright::output::fmu_test {
namespace {

using fixtures::replaced;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr double kSame_um =
    1e-6;  // of drift; of temperatures 1e-6 K: rounding over 18000 steps stays a thousand times below

/// The files of a unit, read back from the zip.
std::map<std::string, std::string> unzipped(const std::filesystem::path& file) {
  std::map<std::string, std::string> files;
  const unzFile zip = unzOpen64(file.c_str());
  EXPECT_NE(zip, nullptr) << file;
  for (int at = unzGoToFirstFile(zip); at == UNZ_OK; at = unzGoToNextFile(zip)) {
    char name[256];
    unz_file_info64 info;
    EXPECT_EQ(unzGetCurrentFileInfo64(zip, &info, name, sizeof name, nullptr, 0, nullptr, 0), UNZ_OK);
    std::string bytes(info.uncompressed_size, '\0');
    EXPECT_EQ(unzOpenCurrentFile(zip), UNZ_OK);
    EXPECT_EQ(unzReadCurrentFile(zip, bytes.data(), static_cast<unsigned>(bytes.size())), static_cast<int>(bytes.size()));
    EXPECT_EQ(unzCloseCurrentFile(zip), UNZ_OK) << name << ": CRC";
    files[name] = bytes;
  }
  unzClose(zip);
  return files;
}

/// A unit written to a file, unpacked, and what its description says.
struct Unit {
  bool is_2 = true;
  std::map<std::string, std::string> files;
  std::filesystem::path folder, library;
  std::string guid;
  std::map<std::string, unsigned> reference;  ///< of variables
  std::vector<unsigned> states, derivatives;

  Unit(const FmuOrder& order, const std::string& name) : is_2(order.version == FmiVersion::k2), folder(fresh_folder(name)) {
    write_zip(folder / "unit.fmu", fmu_entries(order, {"test", "a test"}));
    files = unzipped(folder / "unit.fmu");
    for (const auto& [path, bytes] : files) {
      std::filesystem::create_directories((folder / path).parent_path());
      std::ofstream(folder / path, std::ios::binary) << bytes;
      if (path.ends_with(".so")) library = folder / path;
    }
    const std::string& xml = files["modelDescription.xml"];
    std::smatch m;
    EXPECT_TRUE(std::regex_search(xml, m, std::regex(is_2 ? " guid=\"([^\"]*)\"" : " instantiationToken=\"([^\"]*)\"")));
    guid = m[1];
    const std::regex variable(" name=\"([^\"]*)\" valueReference=\"([0-9]+)\"");
    for (std::sregex_iterator v(xml.begin(), xml.end(), variable), end; v != end; ++v) {
      const auto r = static_cast<unsigned>(std::stoul((*v)[2]));
      reference[(*v)[1]] = r;
      if (r >= 20000)
        derivatives.push_back(r);
      else if (r >= 10000)
        states.push_back(r);
    }
  }
};

/// The unit with what a compiler makes of its own sources, as on another system, in place of its binary.
Unit of_sources(Unit unit) {
  unit.library = unit.folder / "of_sources.so";
  const std::string command = fmt::format(
      "cd {}/sources && cc -std=c99 -O3 -ffp-contract=off -fPIC -shared -fvisibility=hidden -Wall -Wextra -Werror -pedantic "
      "-o ../of_sources.so *.c -lm 2>&1",
      unit.folder.string());
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  return unit;
}

/// What an importer must do.
struct Asked {
  bool co_simulation = true;
  double step_s = 60.0;
  std::size_t rewind_at_row = 0;
  int ambient_from_input = -1;
  bool tells_behind_step = false;
};
struct Told {
  std::vector<std::vector<double>> of;  ///< per output, per row
  importer_run run = {};
};

/// @param inputs  channels, each of which has the name of an input
Told import_unit(const Unit& unit, const Record& inputs, const std::vector<std::string>& outputs, const Asked& asked) {
  const std::size_t n_rows = inputs.n_samples();
  std::vector<unsigned> in, out;
  std::vector<double> rows;
  int ambient = -1;
  for (const Channel& c : inputs.channels) {
    if (c.name == "ambient_temperature") ambient = static_cast<int>(in.size());
    in.push_back(unit.reference.at(c.name));
  }
  for (std::size_t i = 0; i < n_rows; ++i) {
    for (const Channel& c : inputs.channels) rows.push_back(c.values[i]);
  }
  for (const std::string& name : outputs) out.push_back(unit.reference.at(name));
  std::vector<double> told(n_rows * out.size(), NAN);
  const std::string library = unit.library.string();
  Told result;
  importer_run& run = result.run;
  run.library = library.c_str();
  run.guid = unit.guid.c_str();
  run.is_co_simulation = asked.co_simulation;
  run.n_inputs = in.size();
  run.n_rows = n_rows;
  run.inputs = in.data();
  run.time_s = inputs.time_s.data();
  run.input_rows = rows.data();
  run.ambient_from_input = asked.ambient_from_input;
  run.ambient_from_input_reference = 3000;
  run.step_s = asked.step_s;
  run.ambient_input = asked.ambient_from_input == 1 ? ambient : -1;
  run.rewind_at_row = asked.rewind_at_row;
  run.tells_behind_step = asked.tells_behind_step;
  run.n_states = unit.states.size();
  run.states = unit.states.data();
  run.derivatives = unit.derivatives.data();
  run.n_outputs = out.size();
  run.outputs = out.data();
  run.output_rows = told.data();

  EXPECT_EQ(unit.is_2 ? import_fmi2(&run) : import_fmi3(&run), 0) << run.wrong;
  for (std::size_t o = 0; o < out.size(); ++o) {
    result.of.emplace_back();
    for (std::size_t i = 0; i < n_rows; ++i) result.of[o].push_back(told[i * out.size() + o]);
  }
  return result;
}

double largest_gap(const std::vector<double>& a, const std::vector<double>& b, std::size_t n) {
  double gap = 0.0;
  for (std::size_t i = 0; i < n; ++i) gap = std::isnan(a[i] - b[i]) ? HUGE_VAL : std::max(gap, std::abs(a[i] - b[i]));
  return gap;
}

std::vector<std::string> names_of(const std::vector<FmuOutput>& outputs) {
  std::vector<std::string> names;
  for (const FmuOutput& o : outputs) names.push_back(o.name);
  return names;
}

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
  [[nodiscard]] static Record speed_of(const Record& record) {
    return {.source = "inputs", .time_s = record.time_s, .channels = {{"spindle_speed", "rpm", record.at("speed").values}}};
  }
  void expect_as(const Record& predicted, const Told& told, double most) const {
    for (std::size_t o = 0; o < outputs.size(); ++o)
      EXPECT_LT(largest_gap(told.of[o], predicted.at(outputs[o]).values, predicted.n_samples()), most) << outputs[o];
  }
};

class Fmu : public ::testing::TestWithParam<FmiVersion> {
 protected:
  [[nodiscard]] std::string name(const char* what) const {
    return std::string(what) + (GetParam() == FmiVersion::k2 ? "2" : "3");
  }
};
INSTANTIATE_TEST_SUITE_P(Versions, Fmu, ::testing::Values(FmiVersion::k2, FmiVersion::k3),
                         [](const auto& p) { return p.param == FmiVersion::k2 ? "Fmi2" : "Fmi3"; });

TEST_P(Fmu, InCoSimulationIsWhatPredictSaysWhateverTheStep) {
  const Fp3& fp3 = Fp3::get();
  const Unit unit(fp3.order(GetParam()), name("steps"));
  for (const char* cyclogram : {"chaotic", "heat_cool_1000", "heat_cool_2000"}) {
    const Record predicted = fp3.predicted(cyclogram);
    const Told minutes = import_unit(unit, Fp3::speed_of(predicted), fp3.outputs, {}),
               seconds = import_unit(unit, Fp3::speed_of(predicted), fp3.outputs, {.step_s = 1.0});
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
  Record inputs = Fp3::speed_of(predicted), rows{.source = "rows", .time_s = {}, .channels = {{"spindle_speed", "rpm", {}}}};
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
  Record inputs = Fp3::speed_of(predicted);
  Channel ambient{"ambient_temperature", "degC", {}};
  for (double t_s : predicted.time_s)
    ambient.values.push_back(fp3.scenario.machine->ambient.at(t_s) + fp3.scenario.machine->reference_K - kZeroCelsius_K);
  inputs.channels.push_back(ambient);
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
  fp3.expect_as(predicted, import_unit(unit, Fp3::speed_of(predicted), fp3.outputs, {.rewind_at_row = 57}), kSame_um);
}

TEST_P(Fmu, ItsSourcesGiveTheNumbersOfItsBinary) {
  const Fp3& fp3 = Fp3::get();
  const Unit unit(fp3.order(GetParam()), name("sources"));
  const Record inputs = Fp3::speed_of(fp3.predicted("chaotic"));
  EXPECT_EQ(import_unit(unit, inputs, fp3.outputs, {}).of, import_unit(of_sources(unit), inputs, fp3.outputs, {}).of);
}

TEST_P(Fmu, MakesNoInstanceOfABinaryThatWasCutShort) {
  const Unit unit(Fp3::get().order(GetParam()), name("cut"));
  std::filesystem::resize_file(unit.library, std::filesystem::file_size(unit.library) - 8);
  const std::string library = unit.library.string();
  importer_run run = {};
  run.library = library.c_str();
  run.guid = unit.guid.c_str();
  run.is_co_simulation = 1;
  EXPECT_NE(GetParam() == FmiVersion::k2 ? import_fmi2(&run) : import_fmi3(&run), 0);
  EXPECT_THAT(run.wrong, HasSubstr("cannot be read; the file is not complete"));
}

TEST_P(Fmu, RunsTwiceAtOnce) {
  const Fp3& fp3 = Fp3::get();
  const Unit unit(fp3.order(GetParam()), name("threads"));
  const Record one = fp3.predicted("chaotic"), other = fp3.predicted("heat_cool_2000");
  Told of_one, of_other;
  std::thread first([&] { of_one = import_unit(unit, Fp3::speed_of(one), fp3.outputs, {.step_s = 1.0}); });
  std::thread second([&] { of_other = import_unit(unit, Fp3::speed_of(other), fp3.outputs, {.step_s = 1.0}); });
  first.join();
  second.join();
  fp3.expect_as(one, of_one, kSame_um);
  fp3.expect_as(other, of_other, kSame_um);
}

TEST_P(Fmu, IsValidByTheSchemaAndTheSameBytesEachTime) {
  const Fp3& fp3 = Fp3::get();
  const Unit unit(fp3.order(GetParam()), name("schema"));
  const bool is_2 = GetParam() == FmiVersion::k2;
  const auto validate = [&](const std::string& file, const std::string& schema) {
    const std::string command = fmt::format("xmllint --noout --nonet --schema {}/schema/{} {}/{} 2>&1",
                                            DRIFTWRIGHT_FMI_STANDARD, schema, unit.folder.string(), file);
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
  };
  validate("modelDescription.xml", is_2 ? "fmi2/fmi2ModelDescription.xsd" : "fmi3/fmi3ModelDescription.xsd");
  if (!is_2) validate("sources/buildDescription.xml", "fmi3/fmi3BuildDescription.xsd");
  EXPECT_EQ(unit.files, Unit(fp3.order(GetParam()), name("again")).files);
}

/// Readings with noise, one of which goes wrong, two thermometers that are exchanged later, and an ambient's thermometer that jumps for
/// longer than the rows that the observer goes back.
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
  Record inputs = Fp3::speed_of(run.readings);
  Channel ambient{"ambient_temperature", "degC", {}};
  for (double v : run.ambient.value) ambient.values.push_back(v + fp3.scenario.machine->reference_K - kZeroCelsius_K);
  inputs.channels.push_back(ambient);
  for (const std::string& s : observer.sensors()) inputs.channels.push_back(run.readings.at(s));
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

// Probings on a unit: four of a machine that is 8 um off, one of a chip, one that missed, at rows of samples, and one between two
// samples, which counts at the next. The numbers are those of the filter of the program on the drift times trust.
TEST_P(Fmu, OfAnObserverTakesProbings) {
  const Fp3& fp3 = Fp3::get();
  const scenarios::ReducedMachine& reduced = *fp3.model.reduced();
  const compensation::Observer observer(reduced.system, reduced.start, fp3.fmu.start_ambient_K, {"t05", "t06", "t07", "t10"},
                                        "drift_y");
  const MachineRun run = troubled_run(fp3);
  const compensation::Observation seen = observer.observe(run);
  const probe_process process{4.0, 5400.0, 0.5, 90.0, 1};
  const Unit unit({.model = observer_fmu(fp3.scenario, observer, process), .version = GetParam()}, name("probed"));
  Record inputs = Fp3::speed_of(run.readings);
  Channel ambient{"ambient_temperature", "degC", {}};
  for (double v : run.ambient.value) ambient.values.push_back(v + fp3.scenario.machine->reference_K - kZeroCelsius_K);
  inputs.channels.push_back(ambient);
  for (const std::string& s : observer.sensors()) inputs.channels.push_back(run.readings.at(s));
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

// --- laws that follow temperatures

/// A spindle whose oil thins and whose preload grows, a housing cooled by a formula that has a cusp between equal
/// temperatures, and a channel of three sections.
constexpr const char* kOiled = R"yaml(name: oiled
reference_temperature: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: shaft, capacity: 5.6 kJ/K}
  - {type: node, node: bearing, capacity: 0.7 kJ/K}
  - {type: node, node: housing, capacity: 19 kJ/K}
  - {type: node, node: column, capacity: 60 kJ/K}
  - type: bearing_friction
    node: bearing
    count: 2
    f0: 0.8
    viscosity_40: 25 mm^2/s
    viscosity_100: 5.4 mm^2/s
    mean_diameter: 90 mm
    f1: 0.0006
    load: 300 N
    preload_growth: 15 N/K
    inner: {node: shaft}
    outer: {node: housing}
  - {type: friction_law, node: column, power: 30 W, at_speed: 9000 rpm, decay: 0.02 1/K}
  - {type: motor_loss, node: shaft, power: 90 W, at_speed: 12000 rpm, exponent: 1.5}
  - {type: link, node: bearing, to: shaft, conductance: 15 W/K}
  - {type: link, node: bearing, to: housing, conductance: 30 W/K}
  - {type: link, node: housing, to: column, conductance: 20 W/K}
  - type: formula
    node: column
    conductance: "G*(1 + abs((T_c - T_a)/d)^0.25)"
    to: ambient
    G: 4 W/K
    d: 1 K
    T_c: column
    T_a: ambient
  - type: coolant_channel
    node: housing
    then: [bearing, column]
    medium: glycol_30
    flow: 0.4 L/min
    diameter: 8.9 mm
    length: 1200 mm
    set_point: 21 degC
    runs: while_spindle_turns
start: ambient
ambient: [[0 h, 20 degC], [1 h, 23 degC], [9 h, 22 degC]]
sensors: [{name: t_bearing, node: bearing}, {name: t_housing, node: housing}, {name: t_column, node: column}]
displacements:
  - {name: nose_z, sensitivities: [{node: shaft, sensitivity: 2.9 um/K}, {node: housing, sensitivity: -1.2 um/K}]}
cyclograms: {shift: [[70 min, 9000 rpm], [30 min, 0 rpm], [60 min, 4000 rpm]], fast: [[9 min, 9999 rpm]]}
solver: {model: reduced, relative_tolerance: 1e-9, absolute_tolerance: 1e-8 K, output_interval: 60 s}
)yaml";

/// The C-frame on a coarse mesh, with films of free convection and radiation, without its door that opens for a while.
std::string frame_yaml() {
  std::string text = read_text("scenarios/c_frame.yaml");
  const auto replace = [&](const std::string& what, const std::string& by) { text = replaced(text, what, by); };
  replace("mesh: parts/", "mesh: " + std::filesystem::absolute("scenarios/parts").string() + "/");
  replace("nc_program: parts/", "nc_program: " + std::filesystem::absolute("scenarios/parts").string() + "/");
  replace("mesh_size: {default: 90 mm, head: 60 mm, spindle: 40 mm}", "mesh_size: {default: 150 mm}");
  replace("element_order: 2", "element_order: 1");
  replace("film: 12 W/(m^2 K), from: 10 min, until: 15 min}", "film: 2 W/(m^2 K)}");
  replace("  relative_tolerance: 1e-3\n  absolute_tolerance: 5e-3 K\n",
          "  model: reduced\n  relative_tolerance: 1e-8\n  absolute_tolerance: 1e-7 K\n");
  replace("warm_up: [[60 min, 6000 rpm]]", "warm_up: [[60 min, 6000 rpm], [20 min, 0 rpm]]");
  replace("  fields_at: [10 min, 15 min]\n  stresses: true\n", "");
  return text;
}

struct Live {
  scenarios::Scenario scenario;
  FmuModel fmu;
  std::vector<std::string> outputs;
  Record predicted;
  explicit Live(const std::string& name, const std::string& yaml, const std::string& cyclogram)
      : scenario(scenarios::read_scenario(driftwright::write_file(name, yaml))) {
    require_exportable(scenario);
    const scenarios::Model model = scenarios::open_model(scenario, {}, {}, false);
    fmu = machine_fmu(scenario, *model.reduced());
    outputs = names_of(fmu.outputs);
    predicted = studies::predict_drift(scenario, scenario.cyclogram(cyclogram), {.model = "reduced"}, {}, "a test").record;
  }
  [[nodiscard]] std::size_t n_live() const {
    const auto is_live = [](const auto& law) { return law.live.has_value(); };
    return static_cast<std::size_t>(std::count_if(fmu.sources.begin(), fmu.sources.end(), is_live) +
                                    std::count_if(fmu.exchanges.begin(), fmu.exchanges.end(), is_live));
  }
  [[nodiscard]] Record speed() const { return Fp3::speed_of(predicted); }
  void expect_predicted(const Told& told) const {
    for (std::size_t o = 0; o < outputs.size(); ++o)
      EXPECT_LT(largest_gap(told.of[o], predicted.at(outputs[o]).values, predicted.n_samples()), kLive[is_length(o)])
          << outputs[o];
  }
  void expect_same(const Told& a, const Told& b, double share) const {
    for (std::size_t o = 0; o < outputs.size(); ++o)
      EXPECT_LT(largest_gap(a.of[o], b.of[o], predicted.n_samples()), share * kLive[is_length(o)]) << outputs[o];
  }
  static constexpr double kLive[2] = {1e-4, 1e-3};  ///< K; um and urad
  [[nodiscard]] std::size_t is_length(std::size_t o) const { return fmu.outputs[o].unit == "degC" ? 0 : 1; }
};

const Live& oiled() {
  static const Live live("oiled.yaml", kOiled, "shift");
  return live;
}
const Live& frame() {
  static const Live live("c_frame.yaml", frame_yaml(), "warm_up");
  return live;
}

TEST_P(Fmu, WithLawsOfTemperaturesIsWhatPredictSaysWhateverTheStep) {
  EXPECT_EQ(oiled().n_live(), 5u) << "two frictions, the formula, what the channel brings back to two sections";
  EXPECT_EQ(frame().n_live(), 13u) << "seven films of free convection, five of radiation, the bearings";
  for (const Live* live : {&oiled(), &frame()}) {
    const Unit unit({.model = live->fmu, .version = GetParam()}, name("live"));
    const Told minutes = import_unit(unit, live->speed(), live->outputs, {}),
               seconds = import_unit(unit, live->speed(), live->outputs, {.step_s = 1.0});
    live->expect_predicted(minutes);
    live->expect_predicted(seconds);
    live->expect_same(minutes, seconds, 0.1);
    EXPECT_EQ(minutes.run.allocated, 0) << "no memory is taken after the start";
    EXPECT_EQ(import_unit(of_sources(unit), live->speed(), live->outputs, {}).of, minutes.of);
    live->expect_same(import_unit(unit, live->speed(), live->outputs, {.rewind_at_row = 37}), minutes, 1e-9);
    RecordProperty("seconds_" + live->fmu.name, std::to_string(minutes.run.seconds));
  }
}

TEST_P(Fmu, WithLawsOfTemperaturesInModelExchangeIsTheSame) {
  const Live& live = oiled();
  Record rows = live.speed();
  const Told told = import_unit(Unit({.model = live.fmu, .version = GetParam()}, name("live_exchange")), rows, live.outputs,
                                {.co_simulation = false});
  live.expect_predicted(told);
  EXPECT_LT(told.run.jacobian_gap, 1e-6) << "directional derivatives along states and speed, against differences";
}

TEST_P(Fmu, WithLawsOfTemperaturesTakesTheAmbientAsAnInput) {
  const Live& live = oiled();
  Record inputs = live.speed();
  Channel ambient{"ambient_temperature", "degC", {}};
  for (double t_s : inputs.time_s)
    ambient.values.push_back(live.scenario.machine->ambient.at(t_s) + live.scenario.machine->reference_K - kZeroCelsius_K);
  inputs.channels.push_back(ambient);
  live.expect_predicted(import_unit(Unit({.model = live.fmu, .version = GetParam()}, name("live_ambient")), inputs,
                                    live.outputs, {.step_s = 7.0, .ambient_from_input = 1}));
}

/// A ball screw whose nut heats it where it is, in the motor encoder's loop, beside the same axis closed by a scale.
constexpr const char* kScrewAxis = R"(name: axis
reference_temperature: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: nut, capacity: 2 kJ/K}
  - {type: node, node: scale, capacity: 1 kJ/K}
  - {type: link, node: nut, to: ambient, conductance: 5 W/K}
  - {type: link, node: scale, to: nut, conductance: 1 W/K}
  - {type: feed_axis, node: nut, screw: s, axis: x, travel: 800 mm, fixed_gap: 100 mm, far_gap: 100 mm, diameter: 36 mm,
     lead: 10 mm, nut_length: 80 mm, torque: 1 N m, nut_conductance: 4 W/K, mounting: stretched, fixed_stiffness: 200 N/um,
     far_stiffness: 100 N/um, position: position_x, stroke: stroke_x_mm}
  - {type: linear_scale, displacement: by_scale, body: scale, expansion: 8e-6 1/K, fixed_at: 100 mm, position: position_x_mm}
start: ambient
ambient: [[0 h, 21 degC]]
displacements:
  - {name: at_nut, screw: s}
  - {name: by_scale, sensitivities: [{node: nut, sensitivity: 0.5 um/K}]}
cyclograms:
  strokes:
    columns: [duration, feed_x, position_x_mm, stroke_x_mm]
    rows: [[10 min, 5 m/min, 410 mm, 590 mm], [9 min, 3 m/min, 700 mm, 200 mm], [1 min, 6 m/min, 20 mm, 0 mm],
           [15 min, 6 m/min, 150 mm, 60 mm], [5 min, 0 m/min, 790 mm, 0 mm]]
solver: {model: reduced, output_interval: 1 min}
)";

// In co-simulation an output is told before the inputs of its row are set, so rows at which the axis moves are left out.
TEST_P(Fmu, TakesThePositionOfAFeedAxis) {
  const Live axis("screw_axis.yaml", kScrewAxis, "strokes");
  EXPECT_EQ(axis.n_live(), 0u) << "a formula of the drive is exact over a step";
  Record inputs{.source = "inputs", .time_s = axis.predicted.time_s, .channels = {}};
  for (const char* name : {"feed_x", "position_x", "stroke_x"}) inputs.channels.push_back(axis.predicted.at(name));
  const std::vector<double>& place_mm = inputs.channels[1].values;
  const Unit unit({.model = axis.fmu, .version = GetParam()}, name("axis"));
  const Told exchanged = import_unit(unit, inputs, axis.outputs, {.co_simulation = false});
  axis.expect_predicted(exchanged);
  EXPECT_LT(exchanged.run.jacobian_gap, 1e-6) << "along states, feed, position and stroke, against differences";
  const Told minutes = import_unit(unit, inputs, axis.outputs, {}),
             seconds = import_unit(unit, inputs, axis.outputs, {.step_s = 7.0});
  for (const Told* told : {&minutes, &seconds}) {
    for (std::size_t o = 0; o < axis.outputs.size(); ++o) {
      const std::vector<double>& predicted = axis.predicted.at(axis.outputs[o]).values;
      for (std::size_t i = 1; i < predicted.size(); ++i) {
        if (place_mm[i] != place_mm[i - 1]) continue;
        EXPECT_NEAR(told->of[o][i], predicted[i], kSame_um) << axis.outputs[o] << i;
      }
    }
  }
  EXPECT_EQ(import_unit(of_sources(unit), inputs, axis.outputs, {}).of, minutes.of);
  const auto drift_um = [&](std::size_t row) { return axis.predicted.at("at_nut").values[row]; };
  EXPECT_GT(std::abs(drift_um(18) - drift_um(19)), 5.0) << "the place makes the error";
}

TEST_P(Fmu, SaysThatALawHasNoValueWhereItsRangeEnds) {
  FmuOrder order{.model = oiled().fmu, .version = GetParam()};
  order.model.start.array() += 200.0 * order.model.ones.array();  // oil at 220 degC; the law ends at 180 degC
  const Unit unit(order, name("beyond"));
  const std::string library = unit.library.string();
  const double times_s[2] = {0.0, 60.0}, speeds_rpm[2] = {9000.0, 9000.0};
  const unsigned speed = unit.reference.at("spindle_speed");
  importer_run run = {};
  run.library = library.c_str();
  run.guid = unit.guid.c_str();
  run.is_co_simulation = 1;
  run.n_inputs = 1;
  run.n_rows = 2;
  run.inputs = &speed;
  run.time_s = times_s;
  run.input_rows = speeds_rpm;
  run.ambient_from_input = run.ambient_input = -1;
  run.step_s = 60.0;
  double no_output = 0.0;
  run.outputs = &speed;
  run.output_rows = &no_output;
  EXPECT_NE(GetParam() == FmiVersion::k2 ? import_fmi2(&run) : import_fmi3(&run), 0);
  EXPECT_THAT(run.wrong, HasSubstr("a law has no value at the temperatures"));
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
  refused(
      replaced(kHead, "effects:\n",
               "effects:\n  - {type: coolant, node: head, tank: cooler, flow: 6 L/min, passage_conductance: 50 W/K, volume: "
               "12 L, cooling_power: 900 W, set_point: 21 degC, hysteresis: 1 K}\n"),
      "--fmu " + target, "thermostat");
  refused(replaced(kScrewAxis, "mounting: stretched", "mounting: stretched, stretch: 30 um"), "--fmu " + target,
          "grows freely once it is used up");
  refused(replaced(kHead, "name: t_head", "name: spindle_speed"), "--fmu " + target, "rename");
  EXPECT_FALSE(std::filesystem::exists(fresh_folder("refused") / "x.fmu"));
}

}  // namespace
}  // namespace driftwright::output::fmu_test
