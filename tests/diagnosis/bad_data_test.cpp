// Records that are right in themselves and wrong beside the scenario: other units, a machine still warm, too few readings.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "base/foreign_temperature.hpp"
#include "diagnosis/diagnosis.hpp"
#include "diagnosis/happening.hpp"
#include "diagnosis/missing_data.hpp"
#include "diagnosis/unseen_drive.hpp"
#include "diagnosis/warm_start.hpp"
#include "machine/machine.hpp"
#include "machine/run_record.hpp"
#include "tests/shared/lumped_records.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::diagnosis::bad_data_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

/// The twin of the spindle and a run that reads exactly what it says, from `start_K` of shaft and housing.
struct Bench : AloneTwin {
  explicit Bench(const std::string& machine_text = spindle_in_housing(1000, 600))
      : AloneTwin(write_file("bad_data_spindle.yaml", machine_text)) {
    if (!scenario.machine->displacements.empty()) measure({0.0, 0.0});
  }
  void measure(const Eigen::Vector2d& start_K) {
    MeasuredRun warm = runs[0];
    warm.start_K = start_K;
    Twin::Workspace workspace(*twin);
    const Eigen::MatrixXd readings = twin->readings(twin->as_written(), warm, workspace);
    runs[0].channels = {{"t_shaft", 0, "K", readings.row(0), 0.0, "degC"},
                        {"t_housing", 1, "K", readings.row(1), 0.0, "degC"},
                        {"nose", 2, "m", readings.row(2), 0.0, "um"}};
  }
  MeasuredChannel& channel(std::size_t i) { return runs[0].channels[i]; }
  std::string told() const {
    std::string all;
    for (const DataFinding& f : runs[0].findings) all += f.what + "\n";
    return all;
  }
};

TEST(ForeignUnits, ATemperatureThatMayWellBeIsLeft) {
  EXPECT_EQ(foreign_temperature({13.0, 14.0, 15.0}, -10.0, -10.0),
            std::nullopt);  // 14 degF are -10 degC, and 24 K is no proof
  EXPECT_EQ(foreign_temperature({31.0, 32.0, 33.0}, 0.0, 0.0), "degF");
  EXPECT_EQ(foreign_temperature({}, 0.0, 0.0), std::nullopt);
}

/// Reproducible noise: a sine of no period that a machine has.
void add_noise(MeasuredChannel& c, double amplitude) {
  for (Eigen::Index i = 0; i < c.value.size(); ++i)
    c.value[i] += amplitude * std::sin(12.9898 * static_cast<double>(i * i % 977));
}

TEST(WarmStart, IsAFindingAndNoCause) {
  Bench b;
  b.measure({13.0, 9.0});
  add_noise(b.channel(0), 0.05);
  add_noise(b.channel(1), 0.05);
  add_noise(b.channel(2), 0.2e-6);
  find_warm_starts(b.runs, *b.twin);
  EXPECT_THAT(b.told(), AllOf(HasSubstr("2 of 2 thermometers read more than 4 K beside"), HasSubstr("t_shaft by +13.")));
  ASSERT_EQ(b.runs[0].start_K.size(), 2);
  EXPECT_NEAR(b.runs[0].start_K[0], 13.0, 0.3);
  EXPECT_NEAR(b.runs[0].start_K[1], 9.0, 0.3);
  const Diagnosis d = diagnose(*b.twin, nullptr, b.runs, {});
  EXPECT_EQ(d.verdict, Verdict::kConsistent) << d.reason;
}

TEST(WarmStart, OfABodyWithoutThermometerIsFitted) {
  Bench b;
  b.measure({13.0, 6.0});
  b.runs[0].channels.erase(b.runs[0].channels.begin() + 1);
  add_noise(b.channel(0), 0.05);
  add_noise(b.channel(1), 0.2e-6);
  find_warm_starts(b.runs, *b.twin);
  EXPECT_NEAR(b.runs[0].start_K[1], 9.1, 0.5);  // 0.7 of its neighbour: that is all a first reading says
  EXPECT_FALSE(start_columns(*b.twin, b.runs).empty());
  const Diagnosis d = diagnose(*b.twin, nullptr, b.runs, {});
  EXPECT_EQ(d.verdict, Verdict::kConsistent) << d.reason;
}

TEST(WarmStart, IsNotTakenForABiasOrAnAmbientThatIsOff) {
  Bench b;
  b.channel(0).value.array() += 6.0;  // one thermometer of two
  find_warm_starts(b.runs, *b.twin);
  b.channel(0).value.array() -= 3.0;
  b.channel(1).value.array() += 3.0;
  find_warm_starts(b.runs, *b.twin);
  EXPECT_EQ(b.told(), "");
  EXPECT_EQ(b.runs[0].start_K.size(), 0);
}

/// 1000 s of time constant, 60 K at 1000 rpm.
std::string shaft_alone(const std::string& cyclogram) {
  return R"(name: body
reference_temperature: 20 degC
start: ambient
machine: {generator: lumped}
effects:
  - {type: node, node: shaft, capacity: 1000 J/K}
  - {type: heat_source, node: shaft, power: 60 W, at_speed: 1000 rpm, exponent: 1}
  - {type: link, node: shaft, to: ambient, conductance: 1 W/K}
ambient: [[0 min, 20 degC]]
sensors: [{name: t_shaft, node: shaft}]
cyclograms:
  cycle: )" +
         cyclogram + "\nsolver: {output_interval: 1 min}\n";
}

// One body, 1000 J/K with 1 W/K to the ambient, of which 60 W at 1000 rpm: T' = (P - T) / 1000 s. Of a hole from 100 to
// 164 min the first part is 32 min long: full less none there is 60 (1 - e^-1.92) at its end, and half of that is one
// standard deviation.
TEST(UnseenDrive, IsWhatTheDriveOfAHoleMayHaveDone) {
  Bench b(shaft_alone("[[60 min, 1000 rpm], [60 min, 0 rpm], [120 min, 500 rpm]]").c_str());
  b.runs[0].holes = {{6000.0, 9840.0}};
  const std::vector<Prediction> columns = hole_columns(*b.twin, b.runs);
  ASSERT_THAT(columns, SizeIs(5));
  double begin_s = 6000.0;
  for (std::size_t part = 0; part < 5; ++part) {
    const double length_s = 3840.0 / (part < 4 ? std::pow(2.0, part + 1.0) : 16.0);
    const Eigen::MatrixXd& readings = columns[part].front();
    for (const int row : {90, 170, 200, 239}) {
      const double after_s = 60.0 * row - begin_s - length_s;
      const double expected = row < 100 ? 0.0 : 0.5 * 60.0 * (1.0 - std::exp(-1e-3 * length_s)) * std::exp(-1e-3 * after_s);
      EXPECT_NEAR(readings(0, row), expected, 0.02) << part << " " << row;
    }
    begin_s += length_s;
  }
}

// Nobody turns; the ambient goes to and fro as A sin(2 pi t / P), and a hole is as long as P. From the line between the
// ends of a stretch of P, which is level, it strays by A (sin(u + 2 pi s) - sin(u)), whose mean square over all u is A^2
// (1 - cos(2 pi s)), over s = 1/16 .. 15/16 A^2 16/15. With C dT/dt = -G (T - h) an ambient that is warmer by a for so
// long leaves a (1 - e^-t/tau).
TEST(UnseenDrive, IsTheAmbientToo) {
  Bench b(shaft_alone("[[240 min, 0 rpm]]").c_str());
  constexpr double kAmplitude_K = 1.5, kPeriod_s = 2400.0;
  MeasuredRun& run = b.runs[0];
  run.has_ambient = true;
  run.ambient = {};
  for (int i = 0; i <= 240; ++i) {
    run.ambient.time_s.push_back(60.0 * i);
    run.ambient.value.push_back(kAmplitude_K * std::sin(2.0 * M_PI * 60.0 * i / kPeriod_s));
  }
  run.holes = {{6000.0, 6000.0 + kPeriod_s}};
  EXPECT_THAT(hole_columns(*b.twin, b.runs), IsEmpty());  // rows go on, and say what the ambient was
  std::erase_if(run.time_s, [&](double t_s) { return t_s > run.holes[0].begin_s && t_s < run.holes[0].end_s; });
  set_grid(run);
  run.has_ambient = false;
  EXPECT_THAT(hole_columns(*b.twin, b.runs), IsEmpty());  // the scenario says the ambient, in holes as anywhere
  run.has_ambient = true;
  const double strays_K = kAmplitude_K * std::sqrt(16.0 / 15.0);
  const std::vector<Prediction> columns = hole_columns(*b.twin, b.runs);
  ASSERT_THAT(columns, SizeIs(5));
  double begin_s = 6000.0;
  for (std::size_t part = 0; part < 5; ++part) {
    const double length_s = kPeriod_s / (part < 4 ? std::pow(2.0, part + 1.0) : 16.0);
    for (std::size_t row = 0; row < run.time_s.size(); ++row) {
      const double after_s = run.time_s[row] - begin_s - length_s;
      const double expected =
          run.time_s[row] < 8000.0 ? 0.0 : strays_K * (1.0 - std::exp(-1e-3 * length_s)) * std::exp(-1e-3 * after_s);
      EXPECT_NEAR(columns[part].front()(0, static_cast<Eigen::Index>(row)), expected, 0.02) << part << " " << row;
    }
    begin_s += length_s;
  }
  run.holes = {{3000.0, 12000.0}};  // no stretch is as long: all that is left of the record says how far it strays
  std::erase_if(run.time_s, [&](double t_s) { return t_s > 3000.0 && t_s < 12000.0; });
  set_grid(run);
  EXPECT_THAT(hole_columns(*b.twin, b.runs), SizeIs(5));
}

TEST(Happening, OfWhichHalfLiesInAHoleIsUnseen) {
  Bench b;
  b.runs[0].holes = {{600.0, 1200.0}};
  const auto happening = [&](double begin_s, double end_s) {
    return Happening{.body = effects::node("column"), .in = {{&b.runs[0], {{begin_s, end_s}}}}};
  };
  EXPECT_TRUE(is_unseen(happening(650.0, 1100.0)));
  EXPECT_TRUE(is_unseen(happening(700.0, 1600.0)));
  EXPECT_FALSE(is_unseen(happening(700.0, 2000.0)));
  EXPECT_FALSE(is_unseen(happening(1200.0, 1500.0)));
}

TEST(MissingData, NamesNothingAndWritesNothing) {  // 54 readings, of which one thermometer is plainly off
  Bench b;
  MeasuredRun& run = b.runs[0];
  run.time_s.resize(18);
  run.cyclogram.sections = {{run.time_s.back(), {.speed_rpm = 1000.0}}};
  for (MeasuredChannel& c : run.channels) c.value = Eigen::VectorXd(c.value.head(18));
  set_grid(run);
  add_noise(b.channel(0), 0.05);
  add_noise(b.channel(1), 0.05);
  add_noise(b.channel(2), 0.2e-6);
  b.channel(1).value.array() += 3.0;
  const Diagnosis d = diagnose(*b.twin, nullptr, b.runs, {});
  EXPECT_EQ(d.verdict, Verdict::kInsufficientData) << d.reason;
  ASSERT_FALSE(d.causes.empty());
  for (const Cause& c : d.causes) {
    EXPECT_EQ(c.standing, Standing::kSuspected) << c.effect;
    EXPECT_NE(c.doubt, "") << c.effect;
    EXPECT_FALSE(c.is_written) << c.effect;
  }
}

TEST(MissingData, NamesTheChannelsTheThermometersAndTheTime) {
  Bench b;
  b.runs[0].channels.erase(b.runs[0].channels.begin(), b.runs[0].channels.begin() + 2);
  b.runs[0].has_ambient = false;
  b.runs[0].time_s = {0.0, 10800.0, 21600.0};
  b.runs[0].cyclogram.sections = {{21600.0, {.speed_rpm = 800.0}}};
  EXPECT_THAT(what_is_missing(*b.twin, b.runs, 3, 150),
              AllOf(HasSubstr("3 readings of 1 channel are too few"), HasSubstr("do not hold t_shaft, t_housing."),
                    HasSubstr("a thermometer on each of shaft, housing"),
                    HasSubstr("No ambient temperature (ambient_degC) in cycle"), HasSubstr("at 800 rpm throughout"),
                    HasSubstr("A row comes every 180 min; one every 10 min is required.")));
}

TEST(MissingData, IsSilentOnWhatIsThere) {
  Bench b;
  EXPECT_THAT(what_is_missing(*b.twin, b.runs, 100, 150),
              AllOf(Not(HasSubstr("do not hold")), Not(HasSubstr("No temperature")), Not(HasSubstr("No ambient")),
                    Not(HasSubstr("throughout")), Not(HasSubstr("A row comes"))));
}

TEST(MissingData, KnowsHowLongTheMachineTakes) {
  Bench b;
  // s^2 + (12/5000 + 21/20000) s + 12/5000 21/20000 - 12/5000 12/20000 = 0: the slower time constant is 2872 s. The shaft
  // starts with a little more than 1 K of that mode, and times are looked at in steps of a tenth.
  EXPECT_GT(settling_time_s(*b.twin, b.runs[0]), 2872.0);
  EXPECT_LT(settling_time_s(*b.twin, b.runs[0]), 1.1 * 1.17 * 2872.0);
}

}  // namespace
}  // namespace driftwright::diagnosis::bad_data_test
