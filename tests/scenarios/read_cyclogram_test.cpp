#include "scenarios/reader/read_cyclogram.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "machine/machine.hpp"
#include "machine/run_record.hpp"
#include "nc/program.hpp"
#include "scenarios/reader/read_ambient.hpp"
#include "scenarios/reader/recorded_run.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::scenarios::read_cyclogram_test {
namespace {

using ::testing::HasSubstr;

Cyclogram read(const std::string& entry) {
  const ConfigMap in = ConfigMap::read_file(write_file("scenario.yaml", "cyclograms:\n" + entry));
  const schema::Map schema = cyclograms_schema();
  const ConfigMap cyclograms = in.map("cyclograms").described_by(schema);
  return read_cyclogram(cyclograms, cyclograms.keys().at(0));
}

TEST(ReadCyclogram, TakesAPlainList) {
  const Cyclogram c = read("  warm_up: [[300 min, 2000 rpm], [1 h, 0 rpm]]\n");
  EXPECT_EQ(c.name, "warm_up");
  EXPECT_EQ(c.sections, (std::vector<Cyclogram::Section>{{18000, {.speed_rpm = 2000}}, {3600, {}}}));
}

TEST(ReadCyclogram, ReadsTheRowsThatItWrites) {
  const Cyclogram c = read(
      "  day:\n    columns: [duration, speed, feed_z, bed_degC, heater_W]\n"
      "    rows: [[30 min, 2000 rpm, 1.5 m/min, 60 degC, 0 W], [1 min, 2000 rpm, 1.5 m/min, 60 degC, 0 W],\n"
      "           [90 s, 2000 rpm, 1.5 m/min, 60 degC, 123.456789 W], [1 h, 0 rpm, 0 m/s, 21.5 degC, 0 W]]\n");
  const std::string written = rows_yaml(c);
  EXPECT_THAT(written,
              ::testing::StartsWith("{columns: [duration, speed, feed_z, bed_degC, heater_W], rows: [[1860 s, 2000 rpm, "));
  const Cyclogram again = read("  day: " + written + "\n");
  EXPECT_DOUBLE_EQ(again.duration_s(), c.duration_s());
  for (double t_s : {1.0, 1859.0, 1861.0, 1949.0, 1951.0, 5000.0}) {
    EXPECT_EQ(again.drive(t_s), c.drive(t_s)) << t_s;
    EXPECT_NEAR(again.column("bed")->at(t_s), c.column("bed")->at(t_s), 1e-9) << t_s;
    EXPECT_NEAR(again.column("heater")->at(t_s), c.column("heater")->at(t_s), 1e-6) << t_s;
  }
}

TEST(ReadCyclogram, TakesNamedColumnsAndRepeats) {
  const Cyclogram c = read(
      "  milling:\n    columns: [duration, speed, feed_x, feed_z, cutting_power]\n"
      "    rows: [[30 min, 2000 rpm, 3 m/min, 60 mm/min, 0.4 kW], [1 min, 0 rpm, 0 m/s, 0 m/s, 0 W]]\n    repeat: 4\n");
  ASSERT_EQ(c.sections.size(), 8u);
  EXPECT_EQ(c.duration_s(), 4 * 31 * 60.0);
  const Drive& d = c.sections[2].drive;
  EXPECT_EQ(d.speed_rpm, 2000.0);
  EXPECT_DOUBLE_EQ(d.feed_m_s[0], 0.05);
  EXPECT_EQ(d.feed_m_s[1], 0.0);
  EXPECT_DOUBLE_EQ(d.feed_m_s[2], 0.001);
  EXPECT_DOUBLE_EQ(d.cutting_power_W, 400.0);
  EXPECT_EQ(c.sections[3].drive, Drive{});
  EXPECT_EQ(read("  feed_only: {columns: [duration, feed_y], rows: [[1 s, 1 m/s]], repeat: 3}\n").sections,
            (std::vector<Cyclogram::Section>{{3.0, {.speed_rpm = 0, .feed_m_s = {0, 1, 0}}}}));
}

TEST(ReadCyclogram, TakesFurtherColumnsThatEffectsMayAskFor) {
  const Cyclogram c = read(
      "  pulses:\n    columns: [duration, heater_W, speed, bed_degC, sun_W_m2]\n"
      "    rows: [[3 min, 0.2 kW, 100 rpm, 60 degC, 50 W/m^2], [2 min, 0 W, 0 rpm, 40 degC, 0 W/m^2]]\n    repeat: 2\n");
  ASSERT_EQ(c.sections.size(), 4u);
  EXPECT_EQ(c.sections[2].drive, Drive{.speed_rpm = 100});
  ASSERT_EQ(c.columns.size(), 3u);
  EXPECT_EQ(c.columns[0].header(), "heater_W");
  EXPECT_EQ(c.columns[0].rows.time_s, (std::vector<double>{0, 180, 300, 480}));
  EXPECT_EQ(c.columns[0].rows.value, (std::vector<double>{200, 0, 200, 0}));
  EXPECT_NEAR(c.column("bed")->at(200), 40.0, 1e-9);
  EXPECT_EQ(c.column("sun_W_m2")->at(310), 50.0);
}

TEST(ReadCyclogram, TakesARecordWhoseLastRowEndsIt) {
  (void)write_file("drive.csv",
                   "time_min,speed_rpm,feed_x_mm_min,cutting_power_W,nose_degC\n"
                   "0,1000,-600,50,20\n1,1000,600,50,\n2,0,0,0,21\n5,777,,,\n");
  const Cyclogram c = read("  from_record: {csv: drive.csv, repeat: 2}\n");
  const Cyclogram::Section turning{120, {.speed_rpm = 1000, .feed_m_s = {0.01, 0, 0}, .cutting_power_W = 50}}, rest{180, {}};
  EXPECT_EQ(c.sections, (std::vector<Cyclogram::Section>{turning, rest, turning, rest}));
}

TEST(ReadCyclogram, TakesAnNcProgramBesideTheScenario) {
  (void)write_file("part.ngc", "S1000 M3\nG1 X100 F600\nT1 M6\nG4 P500\nG28\nM88\nM30\n");
  const Cyclogram c = read(
      "  part:\n    nc_program: part.ngc\n    repeat: 20\n    rapid: 15 m/min\n    resolution: 1 s\n    tool_change: 8 s\n"
      "    dwell_unit: ms\n    machine_zero: [100 mm, 0 mm, 400 mm]\n    cutting_power: 300 W\n    ignore: [M88]\n");
  // 10 s of milling, then 8 s of tool change and 0.5 s of dwell at rest, 400 mm of rapid along z in 1.6 s.
  ASSERT_EQ(c.sections.size(), 60u);
  EXPECT_NEAR(c.duration_s(), 20 * 20.1, 1e-9);
  EXPECT_EQ(c.sections[0].drive, (Drive{.speed_rpm = 1000, .feed_m_s = {0.01, 0, 0}, .cutting_power_W = 300}));
  EXPECT_EQ(c.sections[1].drive, Drive{});
  EXPECT_DOUBLE_EQ(c.sections[2].drive.feed_m_s[2], 0.25);
  EXPECT_THAT(c.remarks, ::testing::ElementsAre(HasSubstr("part.ngc: machining time 20.1 s")));
}

TEST(ReadCyclogram, TimesTheShippedPocketAsSummedByHand) {
  const double turn = 2 * std::numbers::pi;
  const double helix = std::hypot(2 * turn * 5, 3.0);                                       // two turns of 5 mm, 3 mm down
  const double layer = 14 + 6 + 28 + 12 + 28 + 6 + 10 + 12 + 44 + 24 + 44 + 12 + turn * 2;  // slot, ring, wall, corners
  // Holes of 14 mm from R by pecks of 4: fed 4, then 0.254 more each time; out 4, 8, 12, back 0.254 less, out 14.
  const double fed = 14 + 3 * 0.254, rapid_in_hole = (4 + 8 + 12) * 2 - 3 * 0.254 + 14;
  const double rapids = 50 + std::hypot(30.0, 20.0) + 48 + 56  // to the pocket and out of it
                        + std::hypot(62.0, 28.0) + 76 + 56 + 76 + 2 * 48 + 4 * rapid_in_hole;
  const double seconds = 2 * 8.0 + rapids / 250 + (2 + 2 * helix) / 10 + (2 * layer + 24) / 20 + 4 * fed / 5 + 2.0;
  const NcProgram program = read_nc_program("scenarios/parts/pocket.ngc",
                                            {.rapid_m_s = 0.25, .tool_change_s = 8.0, .machine_zero_m = {}, .ignored = {}});
  EXPECT_NEAR(program.duration_s(), seconds, 1e-9);  // rounding of seventy moves
  // LinuxCNC 2.9's interpreter (rs274 -g), its canonical commands timed by a script at the same speeds: 72.27507 s; travels
  // 700, 344 and 562 mm.
  EXPECT_NEAR(program.duration_s(), 72.27507, 5e-6);
  std::array<double, 3> travel_mm = {0, 0, 0};
  for (const NcMove& move : program.moves) {
    for (int axis = 0; axis < 3; ++axis) travel_mm[axis] += 1e3 * move.travel_m[axis];
  }
  EXPECT_THAT(travel_mm, ::testing::ElementsAre(::testing::DoubleNear(700, 1e-9), ::testing::DoubleNear(344, 1e-9),
                                                ::testing::DoubleNear(562, 1e-9)));
}

struct Wrong {
  const char* name;
  const char* entry;
  std::vector<const char*> message;
};
class CyclogramErrors : public ::testing::TestWithParam<Wrong> {};

TEST_P(CyclogramErrors, NameThePlaceAndWhatIsAllowed) {
  (void)write_file("late.csv", "time_s,speed_rpm\n5,1\n9,1\n");
  (void)write_file("gap.csv", "time_s,speed_rpm\n0,\n9,1\n");
  (void)write_file("fast.csv", "time_s,speed_rpm,feed_z_mm_min\n0,1,7e6\n9,1,0\n");
  (void)write_file("no_speed.csv", "time_s,feed_x_mm_min\n0,1\n9,1\n");
  (void)write_file("unit.csv", "time_s,speed_rpm,cutting_power_K\n0,1,1\n9,1,1\n");
  (void)write_file("empty.ngc", "M30\n");
  (void)write_file("fast.ngc", "S2000000 M3\nG4 P1\nM30\n");
  (void)write_file("bad.ngc", "G0 X1\nG77\nM30\n");
  try {
    (void)read(GetParam().entry);
    FAIL() << "was accepted";
  } catch (const InputError& e) {
    for (const char* part : GetParam().message) EXPECT_THAT(e.what(), HasSubstr(part));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Each, CyclogramErrors,
    ::testing::Values(
        Wrong{"no_kind",
              "  a: {repeat: 2}\n",
              {"scenario.yaml:2:", "one of the keys rows, csv, nc_program", "[cyclograms.a]"}},
        Wrong{"two_kinds", "  a: {csv: x.csv, nc_program: y.ngc}\n", {"`csv` and `nc_program` exclude each other"}},
        Wrong{"not_a_name", "  a b: [[1 s, 1 rpm]]\n", {"'a b' is no name"}},
        Wrong{"negative_speed", "  a: [[1 s, -1 rpm]]\n", {"the speed is -1 rpm; 0 to 1e+06 rpm"}},
        Wrong{"no_duration", "  a: [[0 s, 1 rpm]]\n", {"1 ms or more"}},
        Wrong{
            "columns_without_duration", "  a: {columns: [speed], rows: [[1 rpm]]}\n", {"the first column must be duration"}},
        Wrong{"unknown_column",
              "  a: {columns: [duration, torque], rows: [[1 s, 1 W]]}\n",
              {"'torque' is no column", "cutting_power"}},
        Wrong{
            "column_twice", "  a: {columns: [duration, speed, speed], rows: [[1 s, 1 rpm, 1 rpm]]}\n", {"is listed twice"}},
        Wrong{"row_too_short",
              "  a: {columns: [duration, speed], rows: [[1 s]]}\n",
              {"this must be rows of [s, rpm]", "[cyclograms.a.rows]"}},
        Wrong{"negative_power",
              "  a: {columns: [duration, cutting_power], rows: [[1 s, -5 W]]}\n",
              {"the cutting_power is -5 W; 0 to 1e+09 W"}},
        Wrong{"wrong_unit", "  a: {columns: [duration, feed_x], rows: [[1 s, 5 W]]}\n", {"wrong unit 'W'"}},
        Wrong{"no_repeats",
              "  a: {columns: [duration, speed], rows: [[1 s, 1 rpm]], repeat: 0}\n",
              {"must be a whole number from 1"}},
        Wrong{"unknown_key",
              "  a: {columns: [duration, speed], rows: [[1 s, 1 rpm]], rapid: 1 m/s}\n",
              {"unknown key 'rapid'"}},
        Wrong{"record_missing", "  a: {csv: nowhere.csv}\n", {"nowhere.csv: the file cannot be opened"}},
        Wrong{"record_late", "  a: {csv: late.csv}\n", {"late.csv: a cyclogram starts at time 0, this one at 5 s"}},
        Wrong{"record_gap", "  a: {csv: gap.csv}\n", {"speed_rpm is missing at 0 s"}},
        Wrong{"record_fast", "  a: {csv: fast.csv}\n", {"feed_z 7e+06 mm_min at 0 s; 6e+06 mm_min at most is allowed"}},
        Wrong{"record_without_speed", "  a: {csv: no_speed.csv}\n", {"no channel speed_rpm"}},
        Wrong{"record_unit", "  a: {csv: unit.csv}\n", {"channel cutting_power is in K; it must be in W"}},
        Wrong{"nc_nothing", "  a: {nc_program: empty.ngc}\n", {"takes no time"}},
        Wrong{"nc_fast", "  a: {nc_program: fast.ngc}\n", {"the spindle at 2e+06 rpm"}},
        Wrong{"nc_bad", "  a: {nc_program: bad.ngc, rapid: 1 m/s}\n", {"bad.ngc:2:1: G77"}},
        Wrong{"nc_ignore", "  a: {nc_program: bad.ngc, rapid: 1 m/s, ignore: [g77]}\n", {"'g77' is no G or M word"}},
        Wrong{"nc_dwell_unit", "  a: {nc_program: bad.ngc, dwell_unit: min}\n", {"one of s, ms"}}),
    [](const auto& wrong) { return std::string(wrong.param.name); });

TimeSeries ambient(const std::string& entry) {
  return read_ambient(ConfigMap::read_file(write_file("scenario.yaml", "ambient: " + entry + "\n"))
                          .described_by({.name = "ambient of a test", .keys = {ambient_key()}}),
                      293.15);
}

TEST(Ambient, OfOneTemperatureIsConstant) {
  const TimeSeries h = ambient("22.5 degC");
  EXPECT_NEAR(h.at(0.0), 2.5, 1e-12);
  EXPECT_NEAR(h.at(1e6), 2.5, 1e-12);
  EXPECT_REFUSED(ambient("22.5 K"), "ambient");
}

TEST(ReadCyclogram, TakesAFileOfALoggerByItsColumns) {
  (void)write_file("drive.log", "Zeit;n\n08:00:00;1500\n08:01:00;0\n08:02:00;0\n");
  const Cyclogram c = read(
      "  logged: {csv: drive.log, columns: {time: {column: Zeit, format: \"%H:%M:%S\"}, channels: {speed: {column: n, unit: "
      "rpm}}}}\n");
  EXPECT_EQ(c.sections, (std::vector<Cyclogram::Section>{{60, {.speed_rpm = 1500}}, {60, {}}}));
}

TEST(ReadAmbient, TakesAFileOfALoggerByItsColumns) {
  (void)write_file("ambient.log", "Zeit;T\n0;68\n2;77\n");
  const TimeSeries h = ambient(
      "{csv: ambient.log, channel: t_ambient, columns: {time: {column: Zeit, unit: h}, channels: {t_ambient: {column: T, "
      "unit: "
      "degF}}}}");
  EXPECT_EQ(h.time_s, (std::vector<double>{0, 7200}));
  EXPECT_NEAR(h.value[0], 0.0, 1e-9);
  EXPECT_NEAR(h.value[1], 5.0, 1e-9);
}

TEST(ReadAmbient, TakesRowsOrAChannelOfARecord) {
  (void)write_file("ambient.csv", "time_h,ambient_degC,door_1\n0,21,0\n2,25.5,1\n");
  for (const char* entry : {"[[0 s, 21 degC], [2 h, 298.65 K]]", "{csv: ambient.csv, channel: ambient}"}) {
    const TimeSeries h = ambient(entry);
    EXPECT_EQ(h.time_s, (std::vector<double>{0, 7200}));
    ASSERT_EQ(h.value.size(), 2u);
    EXPECT_NEAR(h.value[0], 1.0, 1e-12);  // kelvin of some hundred, rounded
    EXPECT_NEAR(h.value[1], 5.5, 1e-12);
  }
}

TEST(ReadAmbient, RefusesWhatIsNoAmbientTemperature) {
  (void)write_file("ambient.csv", "time_h,ambient_degC,door_1\n0,21,0\n2,,1\n");
  EXPECT_REFUSED(ambient("{csv: ambient.csv, channel: ambient}"),
                 "ambient_degC is missing or outside -73 to 127 degC at 7200 s");
  EXPECT_REFUSED(ambient("{csv: ambient.csv, channel: door}"), "door_1 is no temperature in degC");
  EXPECT_REFUSED(ambient("{csv: ambient.csv, channel: roof}"), "no channel 'roof'");
  EXPECT_REFUSED(ambient("{csv: ambient.csv, channel: ambient, offset: 3}"), "unknown key 'offset'");
  EXPECT_REFUSED(ambient("[[0 s, 21 degC], [0 s, 22 degC]]"), "times must increase");
  EXPECT_REFUSED(ambient("[[0 s, 200 degC]]"), "200 degC lies outside what is allowed, -73.15 to 126.85 degC");
}

TEST(ReadCyclogram, TakesAMeasuredRecordFromItsFirstRowOn) {
  (void)write_file("measured_late.csv", "time_s,speed_rpm\n3600,1000\n3660,\n3720,500\n3780,0\n");
  const Cyclogram c = read("  run: {csv: measured_late.csv, measured: true}\n");
  ASSERT_EQ(c.sections.size(), 2u);
  EXPECT_EQ(c.sections[0].duration_s, 120.0);
  EXPECT_EQ(c.sections[0].drive.speed_rpm, 1000.0);
  EXPECT_EQ(c.sections[1].duration_s, 60.0);
  EXPECT_EQ(c.sections[1].drive.speed_rpm, 500.0);
}

TEST(ToRecord, CarriesFeedsAndCuttingPowerWhereTheCyclogramUsesThem) {
  const solver::Outputs outputs{};
  solver::Trajectory run;
  run.time_s = {0, 10, 20};
  run.outputs.resize(0, 3);
  const Cyclogram plain{.name = "plain", .sections = {{20, {.speed_rpm = 100}}}};
  EXPECT_EQ(to_record(run, outputs, plain, 293.15).channels.size(), 1u);
  const Cyclogram milling{
      .name = "milling",
      .sections = {{10, {.speed_rpm = 100, .feed_m_s = {0, 0.05, 0}, .cutting_power_W = 400}}, {10, {.speed_rpm = 100}}}};
  const Record record = to_record(run, outputs, milling, 293.15);
  ASSERT_EQ(record.channels.size(), 3u);
  EXPECT_EQ(record.at("feed_y_mm_min").values, (std::vector<double>{3000, 0, 0}));
  EXPECT_EQ(record.at("cutting_power_W").values, (std::vector<double>{400, 0, 0}));
  EXPECT_EQ(run_of(record, nullptr, {}, Reading::kPlan).cyclogram.sections, milling.sections);
}

}  // namespace
}  // namespace driftwright::scenarios::read_cyclogram_test
