// Each of the commonest blunders in a record of one machine is recognised and said; a sound record, and records of a machine
// with a real fault, say nothing.

#include "diagnosis/blunders.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <random>

#include "diagnosis/blunder_drives.hpp"
#include "diagnosis/blunder_match.hpp"
#include "machine/machine.hpp"
#include "machine/run_record.hpp"
#include "tests/shared/edited_text.hpp"
#include "tests/shared/lumped_records.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::diagnosis::blunders_test {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

const std::string kSpindle =
    spindle_in_housing(6000, 4000, "  - {name: tail, sensitivities: [{node: housing, sensitivity: 2 um/K}]}\n");

struct Machine : AloneTwin {
  explicit Machine(const std::string& text) : AloneTwin(write_file("blunders_spindle.yaml", text)) {}
};

/// What a machine reads in that run, with 0.1 K and 0.5 um of noise.
MeasuredRun read_by(const Machine& truth) {
  MeasuredRun run = truth.runs[0];
  Twin::Workspace workspace(*truth.twin);
  const Eigen::MatrixXd readings = truth.twin->readings(truth.twin->as_written(), run, workspace);
  run.channels = {{"t_shaft", 0, "K", readings.row(0), 0.0, "degC"},
                  {"t_housing", 1, "K", readings.row(1), 0.0, "degC"},
                  {"nose", 2, "m", readings.row(2), 0.0, "um"},
                  {"tail", 3, "m", readings.row(3), 0.0, "um"}};
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (MeasuredChannel& c : run.channels) {
    for (double& v : c.value) v += (c.unit == "K" ? 0.1 : 0.5e-6) * normal(random);
  }
  return run;
}

std::string said_of(const MeasuredRun& run) {
  static const Machine scenario(kSpindle);
  return words(check_record(run, {}, *scenario.twin).blunders);
}

void scale_speed(MeasuredRun& run, double factor) {
  for (auto& s : run.cyclogram.sections) s.drive.speed_rpm *= factor;
}

TimeSeries recorded_course(const MeasuredRun& run, std::size_t channel) {
  TimeSeries series{run.time_s, {}};
  for (const double v : run.channels[channel].value) series.value.push_back(v);
  return series;
}

struct Case {
  const char* name;
  std::function<void(MeasuredRun&)> spoil;
  std::vector<std::string> says;  // one for each blunder
};
void PrintTo(const Case& c, std::ostream* out) {
  *out << c.name;
}

class Blunders : public ::testing::TestWithParam<Case> {};

TEST_P(Blunders, IsNamedAndNothingElse) {
  static const Machine truth(kSpindle);
  MeasuredRun run = read_by(truth);
  GetParam().spoil(run);
  const std::string said = said_of(run);
  for (const std::string& part : GetParam().says) EXPECT_THAT(said, HasSubstr(part));
  EXPECT_EQ(static_cast<std::size_t>(std::count(said.begin(), said.end(), '\n')) + 1, GetParam().says.size()) << said;
}

INSTANTIATE_TEST_SUITE_P(
    OfARecord, Blunders,
    ::testing::Values(
        Case{"speed_in_turns_a_second",
             [](MeasuredRun& r) { scale_speed(r, 1.0 / 60.0); },
             {"speed_rpm looks like revolutions a second (1/s, Hz): it reaches 100, and the simulation agrees if it is 6000 "
              "rpm. Write `factor: 60`"}},
        Case{"speed_in_thousands", [](MeasuredRun& r) { scale_speed(r, 1e-3); }, {"speed_rpm looks like thousands of rpm"}},
        Case{"mm_under_um", [](MeasuredRun& r) { r.channels[2].value *= 1e-3; }, {"nose_um looks like mm"}},
        Case{"mm_under_um_of_a_scenario_that_is_off",
             [](MeasuredRun& r) { r.channels[2].value *= 1.7e-3; },
             {"nose_um looks like mm"}},
        Case{"um_under_mm",
             [](MeasuredRun& r) {
               r.channels[2].recorded_unit = "mm";
               r.channels[2].value *= 1e3;
             },
             {"nose_mm looks like um"}},
        Case{"a_sign", [](MeasuredRun& r) { r.channels[3].value *= -1.0; }, {"tail_um seems to have the wrong sign"}},
        Case{"all_signs",
             [](MeasuredRun& r) {
               r.channels[2].value *= -1.0;
               r.channels[3].value *= -1.0;
             },
             {"nose_um seems to have the wrong sign", "tail_um seems to have the wrong sign"}},
        Case{"fahrenheit",
             [](MeasuredRun& r) { r.channels[0].value = 1.8 * (r.channels[0].value.array() + 20.0) + 32.0 - 20.0; },
             {"t_shaft_degC looks like degF: it reads 6"}},
        Case{"kelvin",
             [](MeasuredRun& r) { r.channels[1].value.array() += 273.15; },
             {"t_housing_degC looks like kelvin: it reads 293"}},
        Case{"thermometers_exchanged",
             [](MeasuredRun& r) { std::swap(r.channels[0].value, r.channels[1].value); },
             {"t_shaft and t_housing look exchanged"}},
        Case{"displacements_exchanged",
             [](MeasuredRun& r) { std::swap(r.channels[2].value, r.channels[3].value); },
             {"nose and tail look exchanged"}},
        Case{"minutes_under_seconds",
             [](MeasuredRun& r) { r = with_clock(r, 1.0 / 60.0); },
             {"the times look 60 times too short: minutes under time_s"}},
        Case{"seconds_under_minutes",
             [](MeasuredRun& r) { r = with_clock(r, 60.0); },
             {"the times look 60 times too long: seconds under time_min"}},
        Case{"ambient_on_the_machine",
             [](MeasuredRun& r) { r.ambient = recorded_course(r, 1); },
             {"ambient_degC looks like a thermometer on the machine: it follows what the scenario simulates for"}},
        Case{"ambient_exchanged",
             [](MeasuredRun& r) {
               r.ambient = recorded_course(r, 0);
               std::mt19937 random(9);
               std::normal_distribution<double> normal;
               for (double& v : r.channels[0].value) v = 0.1 * normal(random);
             },
             {"ambient and t_shaft look exchanged"}},
        Case{"drive_an_hour_early",
             [](MeasuredRun& r) {
               r.cyclogram.sections.front().duration_s -= 3600.0;
               set_grid(r);
             },
             {"speed and drives seem to be recorded 1 h earlier than the readings"}}),
    [](const auto& tested) { return tested.param.name; });

// Of a machine whose heat is twice that of the scenario: no gain within its scatter, but no machine is 48 K off.
TEST(FaultyMachine, ThatIsReadInFahrenheitIsNamed) {
  const Machine truth(fixtures::replaced(kSpindle, "power: 150 W", "power: 300 W"));
  MeasuredRun run = read_by(truth);
  EXPECT_EQ(said_of(run), "");
  run.channels[0].value = (1.8 * run.channels[0].value.array() + 48.0).matrix();
  EXPECT_THAT(said_of(run), HasSubstr("t_shaft_degC looks like degF"));
}

TEST(SoundRecords, SayNothing) {
  EXPECT_EQ(said_of(read_by(Machine(kSpindle))), "");
  const Machine doubled(fixtures::replaced(kSpindle, "power: 150 W", "power: 300 W")),
      halved(fixtures::replaced(kSpindle, "conductance: 9 W/K", "conductance: 4.5 W/K")),
      heavy(fixtures::replaced(kSpindle, "capacity: 5 kJ/K", "capacity: 20 kJ/K"));
  EXPECT_EQ(said_of(read_by(doubled)), "");
  EXPECT_EQ(said_of(read_by(halved)), "");
  EXPECT_EQ(said_of(read_by(heavy)), "");
  const Machine truth(kSpindle);
  MeasuredRun fallen = read_by(truth);
  for (const std::size_t channel : {0U, 1U}) {
    MeasuredRun run = fallen;
    Eigen::VectorXd& v = run.channels[channel].value;
    for (Eigen::Index i = 95; i < v.size(); ++i) v[i] *= 0.2;
    EXPECT_EQ(said_of(run), "") << channel;
  }
}

// A machine that was warm before cools while the scenario warms, so its displacements go the other way.
TEST(SoundRecords, OfAMachineThatBeginsWarmSayNothing) {
  const Machine truth(kSpindle);
  MeasuredRun warm = truth.runs[0];
  warm.start_K = Eigen::Vector2d(30.0, 25.0);
  Twin::Workspace workspace(*truth.twin);
  const Eigen::MatrixXd readings = truth.twin->readings(truth.twin->as_written(), warm, workspace);
  MeasuredRun run = read_by(truth);
  for (MeasuredChannel& c : run.channels) c.value = readings.row(c.output).transpose();
  EXPECT_EQ(said_of(run), "");
}

TEST(SoundRecords, OfAScenarioThatIsFarOffSayNothing) {
  const Machine truth(kSpindle);
  for (const double factor : {0.05, 0.4, 3.0, 30.0}) {
    for (const double offset_K : {-20.0, 0.0, 15.0}) {
      MeasuredRun run = read_by(truth);
      run.channels[0].value = factor * run.channels[0].value.array() + offset_K;
      run.channels[2].value *= factor;
      EXPECT_EQ(said_of(run), "") << factor << " " << offset_K;
    }
  }
  MeasuredRun turned = read_by(truth);  // half as much the other way is no sign: something is wrong with the model
  turned.channels[2].value *= -0.5;
  EXPECT_EQ(said_of(turned), "");
  MeasuredRun touches_nothing = read_by(truth);  // a thousandth of what is expected, and nothing of its course
  Twin::Workspace workspace(*truth.twin);
  const Eigen::MatrixXd simulated = truth.twin->readings(truth.twin->as_written(), truth.runs[0], workspace);
  touches_nothing.channels[2].value = 1e-3 * (touches_nothing.channels[2].value - simulated.row(2).transpose());
  EXPECT_EQ(said_of(touches_nothing), "");
}

// Every capacity differs by a factor: such a machine has its own pace and no other clock.
TEST(SoundRecords, OfAMachineWithAnotherPaceSayNothing) {
  const Machine truth(kSpindle);
  for (const double slower : {0.05, 0.25, 4.0, 20.0}) {
    const MeasuredRun other = with_clock(truth.runs[0], 1.0 / slower);
    Twin::Workspace workspace(*truth.twin);
    const Eigen::MatrixXd readings = truth.twin->readings(truth.twin->as_written(), other, workspace);
    MeasuredRun run = read_by(truth);
    for (MeasuredChannel& c : run.channels) c.value = readings.row(c.output).transpose();
    EXPECT_EQ(said_of(run), "") << slower;
  }
}

TEST(Renaming, IsProposedForTheColumnThatAMissingSensorReads) {
  const Machine truth(kSpindle);
  MeasuredRun run = read_by(truth);
  std::vector<MeasuredChannel> unnamed = {run.channels[1]};
  unnamed[0].name = "T3";
  unnamed[0].output = -1;
  run.channels.erase(run.channels.begin() + 1);
  const RecordCheck check = check_record(run, unnamed, *truth.twin);
  ASSERT_THAT(check.renamings, SizeIs(1));
  EXPECT_EQ(check.renamings[0].column, "T3_degC");
  EXPECT_EQ(check.renamings[0].header, "t_housing_degC");
  unnamed[0].value.setLinSpaced(0.0, 1.0);  // of a room that warms
  EXPECT_THAT(check_record(run, unnamed, *truth.twin).renamings, SizeIs(0));
}

// y = 1.2 m + 3 K exactly: the rest is zero, so the price of gain and offset is all that counts. With n = 1000 and noise of
// a thousandth of the course the prices do not move them: gain 1.2 to the step of the grid, 0.05 in its logarithm.
TEST(Match, FindsGainAndOffset) {
  ReadBeside r;
  r.model = Eigen::ArrayXd::LinSpaced(200, 0.0, 20.0);
  r.read = 1.2 * r.model + 3.0;
  const Match m = match(r, {}, 1000.0);
  EXPECT_NEAR(std::log(m.gain), std::log(1.2), 0.05);
  EXPECT_NEAR(m.offset, 3.0, 0.5);
  EXPECT_TRUE(m.is_met());
  // Shown in degF: 1.8 (m + 20) + 32 - 20 for values over 20 degC.
  r.read = 1.8 * r.model + 48.0;
  const Match foreign = match(r, {1.8, 48.0}, 1000.0);
  EXPECT_NEAR(foreign.gain, 1.0, 0.051);
  EXPECT_TRUE(foreign.is_met());
  EXPECT_FALSE(match(r, {}, 1000.0).is_met());  // 48 K off
  EXPECT_GT(foreign.nats - match(r, {}, 1000.0).nats, 12.0);
}

// The same course 50 K off: (50 / 8.33)^2 / 2 = 18 nats for a thermometer, nothing for a displacement, whose zero is
// arbitrary.
TEST(Match, AThermometerThatHasComeOffIsNotFarOff) {
  ReadBeside near;
  near.model = Eigen::ArrayXd::LinSpaced(50, 0.0, 20.0);
  near.read = near.model.reverse();
  ReadBeside far = near;
  far.read += 50.0;
  EXPECT_NEAR(nats_of_unrelated(near, 10.0) - nats_of_unrelated(far, 10.0), 18.0, 1e-9);
  near.is_temperature = far.is_temperature = false;
  EXPECT_NEAR(nats_of_unrelated(near, 10.0), nats_of_unrelated(far, 10.0), 1e-9);
}

}  // namespace
}  // namespace driftwright::diagnosis::blunders_test
