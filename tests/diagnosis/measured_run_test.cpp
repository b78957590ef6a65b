// Records as they come from a shop floor: gaps, stuck sensors, other units, no speed.

#include "diagnosis/measured_run.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <fstream>

#include "tests/shared/temporary_file.hpp"

namespace driftwright::diagnosis::measured_run_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

solver::Outputs outputs() {
  solver::Outputs o;
  o.name = {"t_front", "nose_z", "t_ambient"};
  o.unit = {"K", "m", "K"};
  o.ambient = Eigen::Vector3d(0.0, 0.0, 1.0);
  return o;
}

class MeasuredRunTest : public testing::Test {
 protected:
  MeasuredRun read(const std::string& text) {
    const std::string path = write_file("measured.csv", text);
    scenarios::MachineModel model;
    model.reference_K = 293.15;
    model.ambient = {{0.0}, {0.0}};
    return measured_run(read_record(path, std::nullopt), model, outputs());
  }
  std::string refusal(const std::string& text) {
    try {
      (void)read(text);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  }
};

TEST_F(MeasuredRunTest, TakesSpeedAsSectionsTheAmbientAsKnotsAndReadingsInSI) {
  std::string text = "time_min,speed_rpm,ambient_degC,t_front_degC,nose_z_um\n";
  for (int i = 0; i <= 60; ++i) {
    text += std::to_string(10 + i) + (i < 30 ? ",1000" : ",0") + ",21," + std::to_string(20.0 + 0.1 * i) + "," +
            std::to_string(0.5 * i) + "\n";
  }
  const MeasuredRun run = read(text);
  EXPECT_EQ(run.time_s.front(), 0.0);
  ASSERT_EQ(run.cyclogram.sections.size(), 2u);
  EXPECT_EQ(run.cyclogram.sections[0].duration_s, 1800.0);
  EXPECT_EQ(run.cyclogram.sections[1].drive.speed_rpm, 0.0);
  EXPECT_NEAR(run.ambient.at(1234.0), 1.0, 1e-9);
  ASSERT_NE(run.find("t_front"), nullptr);
  EXPECT_NEAR(run.find("t_front")->value[10], 1.0, 1e-9);
  EXPECT_NEAR(run.find("nose_z")->value[10], 5e-6, 1e-15);
  EXPECT_TRUE(std::isnan(run.find("nose_z")->value[30]));  // at the very change of speed it is open what has jumped
  EXPECT_FALSE(std::isnan(run.find("t_front")->value[30]));
  EXPECT_EQ(run.row_in_grid.size(), run.time_s.size());
  EXPECT_GT(run.grid_s.size(), run.time_s.size());
  EXPECT_EQ(run.grid_s[static_cast<std::size_t>(run.row_in_grid[40])], run.time_s[40]);
}

TEST_F(MeasuredRunTest, TakesFeedsCuttingPowerAndMillimetresInSI) {
  std::string text = "time_s,speed_rpm,feed_x_mm_min,feed_z_mm_min,cutting_power_W,nose_z_mm\n";
  for (int i = 0; i < 6; ++i) text += fmt::format("{},500,6000,{},250,{}\n", 60 * i, i < 3 ? "" : "1200", 0.001 * i * i);
  const MeasuredRun run = read(text);
  const Drive early = run.cyclogram.drive(30.0), late = run.cyclogram.drive(270.0);
  EXPECT_DOUBLE_EQ(early.feed_m_s[0], 0.1);
  EXPECT_EQ(early.feed_m_s[2], 0.0);
  EXPECT_DOUBLE_EQ(late.feed_m_s[2], 0.02);
  EXPECT_EQ(early.cutting_power_W, 250.0);
  EXPECT_NEAR(run.find("nose_z")->value[4], 16e-6, 1e-15);
  EXPECT_EQ(run.find("nose_z")->recorded_unit, "mm");
}

TEST_F(MeasuredRunTest, HoldsTheSpeedOverJitterAndGapsAndAsksOftenerAfterItsChanges) {
  std::string text = "time_s,speed_rpm,t_front_degC\n";
  for (int i = 0; i < 40; ++i) {
    const std::string speed = i == 12 || i == 0 ? "" : std::to_string((i < 20 ? 1000 : 400) + 3 * (i % 3));
    text += fmt::format("{},{},{:.3f}\n", 60 * i, speed, 20.0 + 0.0131 * i * i);
  }
  const MeasuredRun run = read(text);
  ASSERT_EQ(run.cyclogram.sections.size(), 2u);  // 3 and 6 rpm of 1006 are jitter
  EXPECT_EQ(run.cyclogram.sections[0].duration_s, 1200.0);
  EXPECT_EQ(run.cyclogram.sections[0].drive.speed_rpm, 1003.0);  // the first that is known
  // four times as often for six intervals after the start and after the change
  EXPECT_EQ(run.grid_s.size(), 40u + 3u * 12u);
  EXPECT_DOUBLE_EQ(run.grid_s[static_cast<std::size_t>(run.row_in_grid[20]) + 1], 1215.0);
}

TEST_F(MeasuredRunTest, TakesAThermometerInTheAmbientForTheAmbient) {
  std::string text = "time_s,speed_rpm,t_front_degC,t_ambient_degC\n";
  for (int i = 0; i < 40; ++i) text += std::to_string(60 * i) + ",500," + std::to_string(20.0 + 0.013 * i) + ",23\n";
  const MeasuredRun run = read(text);
  EXPECT_TRUE(run.has_ambient);
  EXPECT_NEAR(run.ambient.at(600.0), 3.0, 1e-9);
  EXPECT_EQ(run.find("t_ambient"), nullptr);  // it is an input now
}

/// The largest difference of a body's temperatures in a recorded ambient and in the ambient as it is read, from the same
/// start, by its exact answer to straight pieces.
double missed_K(const MeasuredRun& run, const std::vector<double>& ambient_K, double time_constant_s) {
  double recorded_K = run.ambient.at(0.0), read_K = recorded_K, most = 0.0;
  const double step_s = run.time_s[1] - run.time_s[0], kept = std::exp(-step_s / time_constant_s);
  const auto next = [&](double body, double from, double to) {
    const double lag = (to - from) / step_s * time_constant_s;
    return to - lag + kept * (body - from + lag);
  };
  for (std::size_t i = 1; i < ambient_K.size(); ++i) {
    recorded_K = next(recorded_K, ambient_K[i - 1], ambient_K[i]);
    read_K = next(read_K, run.ambient.at(run.time_s[i - 1]), run.ambient.at(run.time_s[i]));
    most = std::max(most, std::abs(recorded_K - read_K));
  }
  return most;
}

// A thermometer in the open air shows gusts, and a body of five hours feels them: 0.4 K from one reading to the next are
// 0.03 K of its own.
TEST_F(MeasuredRunTest, KeepsAnAmbientThatChangesByMoreThanThermometersErr) {
  for (const double wandering_K : {0.03, 0.4}) {
    Random random(11);
    std::string text = "time_s,speed_rpm,ambient_degC,t_front_degC\n";
    std::vector<double> ambient_K;
    for (int i = 0; i < 500; ++i) {
      ambient_K.push_back(4.0 * std::sin(i / 60.0) + wandering_K * random.normal());
      text += fmt::format("{},500,{:.6f},{}\n", 300 * i, 20.0 + ambient_K.back(), 20.0 + 0.01 * i);
    }
    const MeasuredRun run = read(text);
    EXPECT_LT(missed_K(run, ambient_K, 5.0 * 3600.0), 0.02) << wandering_K;
    // a machine that was at rest has the temperature of the air's course, 0 here, not that of its last gust
    EXPECT_NEAR(run.ambient.at(0.0), 0.0, 1.2 * wandering_K * 2.0 / std::sqrt(24.0) + 0.03) << wandering_K;
  }
}

// With rows ten minutes apart, noise of the thermometer cannot be distinguished from changes of the air. A course on a few
// knots would leave out changes that matter to bodies with time constants of minutes.
TEST_F(MeasuredRunTest, TakesAnAmbientOfFewRowsAsItIsRecorded) {
  Random random(12);
  std::string text = "time_s,speed_rpm,ambient_degC,t_front_degC\n";
  std::vector<double> ambient_K;
  double air_K = 0.0;
  for (int i = 0; i < 500; ++i) {
    air_K = 0.9 * air_K + 0.08 * random.normal();
    ambient_K.push_back(std::round(100.0 * air_K) / 100.0);
    text += fmt::format("{},500,{:.2f},{}\n", 600 * i, 20.0 + ambient_K.back(), 20.0 + 0.01 * i);
  }
  const MeasuredRun run = read(text);
  EXPECT_LT(missed_K(run, ambient_K, 130.0), 0.01);
  EXPECT_LT(missed_K(run, ambient_K, 900.0), 0.01);
}

TEST_F(MeasuredRunTest, LeavesOutAStuckSensorByNameAndCountsGaps) {
  std::string text = "time_s,speed_rpm,t_front_degC,nose_z_um\n";
  for (int i = 0; i < 40; ++i)
    text += std::to_string(60 * i) + ",500,23.4," + (i == 7 ? std::string() : std::to_string(1.01 * i * i)) + "\n";
  const MeasuredRun run = read(text);
  EXPECT_EQ(run.find("t_front"), nullptr);
  std::string all;
  for (const DataFinding& f : run.findings) all += f.what + "\n";
  EXPECT_THAT(all, AllOf(HasSubstr("t_front is stuck"), HasSubstr("23.4 degC"), HasSubstr("nose_z misses 1 of 40"),
                         HasSubstr("no ambient temperature")));
}

TEST_F(MeasuredRunTest, RecognisesTheStepOfAnInstrument) {
  std::string text = "time_s,speed_rpm,t_front_degC\n";
  for (int i = 0; i < 60; ++i) text += std::to_string(60 * i) + ",500," + std::to_string(20.0 + 0.1 * (i / 7)) + "\n";
  EXPECT_NEAR(read(text).find("t_front")->quantum, 0.1, 1e-12);
}

TEST_F(MeasuredRunTest, RecognisesStepsThatWereWrittenRoundedOrBelongToAConverter) {
  // 1/16 K cut to three decimals, long at rest; a converter's 0.244 K, long at its lower end: neither stuck nor saturated
  for (const double step : {0.0625, 0.244}) {
    std::string text = "time_s,speed_rpm,t_front_degC\n";
    for (int i = 0; i < 90; ++i)
      text += fmt::format("{},500,{:.3f}\n", 60 * i, step * (340 + (i < 50 ? 0 : (i - 50) / 3)) - 1e-4);
    const MeasuredRun run = read(text);
    ASSERT_NE(run.find("t_front"), nullptr) << step;
    EXPECT_NEAR(run.find("t_front")->quantum, step, 1e-9);
  }
}

/// A front bearing that warms by 15 K with a time constant of an hour, read in steps; its readings stick at some rows. The
/// rear bearing follows the same course, read to two digits and 5 min later.
std::string warming(double step_K, int stuck_from, int stuck_until) {
  std::string text = "time_s,speed_rpm,t_front_degC,t_rear_degC\n";
  double held_C = 0.0;
  for (int i = 0; i < 240; ++i) {
    const auto course = [](double t_min) {  // 100 min on, 70 min off, 70 min on
      const double x = t_min < 0.0 ? 0.0 : 1.0 - std::exp(-std::min(t_min, 100.0) / 60.0);
      const double y = t_min < 100.0 ? x : x * std::exp(-(std::min(t_min, 170.0) - 100.0) / 60.0);
      return t_min < 170.0 ? y : 1.0 + (y - 1.0) * std::exp(-(t_min - 170.0) / 60.0);
    };
    double front_C = step_K * std::round((20.0 + 15.0 * course(i)) / step_K);
    if (i == stuck_from) held_C = front_C;
    if (i >= stuck_from && i < stuck_until) front_C = held_C;
    text +=
        fmt::format("{},{},{:.3f},{:.2f}\n", 60 * i, i < 100 || i >= 170 ? 1000 : 0, front_C, 20.0 + 12.0 * course(i - 5.0));
  }
  return text;
}
std::string told(const MeasuredRun& run) {
  std::string all;
  for (const DataFinding& f : run.findings) all += f.what + "\n";
  return all;
}

TEST_F(MeasuredRunTest, CutsOffASensorInCoarseStepsFromWhereItNoLongerFollows) {
  const MeasuredRun run = read(warming(0.5, 110, 240));
  ASSERT_NE(run.find("t_front"), nullptr);
  const Eigen::VectorXd& v = run.find("t_front")->value;
  // from the first reading that it repeats; a step of 0.5 K takes 3 min there
  EXPECT_TRUE(v.tail(130).array().isNaN().all());
  EXPECT_FALSE(v.head(106).array().isNaN().any());
  EXPECT_THAT(told(run), AllOf(HasSubstr("t_front stays at "), HasSubstr(" min on (stuck: as "),
                               HasSubstr("these readings are left out")));
}

TEST_F(MeasuredRunTest, TakesOutWhereASensorStoodStillForAWhile) {
  const MeasuredRun run = read(warming(0.5, 110, 165));
  ASSERT_NE(run.find("t_front"), nullptr);
  const Eigen::VectorXd& v = run.find("t_front")->value;
  EXPECT_TRUE(v.segment(110, 55).array().isNaN().all());
  EXPECT_FALSE(v.tail(70).array().isNaN().any());
  EXPECT_THAT(told(run), HasSubstr(" to 164 min (stuck"));
}

TEST_F(MeasuredRunTest, CallsNoCoarseSensorStuckThatFollows) {
  for (const double step_K : {0.1, 0.5, 1.0, 2.0, 4.0}) {
    const MeasuredRun run = read(warming(step_K, 0, 0));
    ASSERT_NE(run.find("t_front"), nullptr) << step_K;
    EXPECT_FALSE(run.find("t_front")->value.array().isNaN().any()) << step_K << told(run);
  }
}

TEST_F(MeasuredRunTest, CutsOffAFineSensorThatRepeatsOneReading) {
  std::string text = "time_s,speed_rpm,t_front_degC\n";
  for (int i = 0; i < 100; ++i)
    text += fmt::format("{},500,{:.5f}\n", 60 * i,
                        20.0 + 0.0371234 * std::min(i, 65) + (i < 65 ? 0.01 * std::sin(7.0 * i) : 0.0));
  const MeasuredRun run = read(text);
  ASSERT_NE(run.find("t_front"), nullptr);
  EXPECT_EQ((run.find("t_front")->value.array() == run.find("t_front")->value.array()).count(), 65);
  EXPECT_THAT(told(run), AllOf(HasSubstr("from 65 min on"), HasSubstr("35 equal readings")));
}

TEST_F(MeasuredRunTest, CutsOffASensorWhoseNoiseIsLargerThanItsStep) {  // 0.1 K, noise of 0.3 K: 40 equal readings are none
  std::string text = "time_s,speed_rpm,t_front_degC\n";
  for (int i = 0; i < 100; ++i)
    text += fmt::format("{},500,{:.1f}\n", 60 * i, 23.0 + 0.3 * std::sin(12.9898 * ((i < 60 ? i * i : 3600) % 977)));
  const MeasuredRun run = read(text);
  ASSERT_NE(run.find("t_front"), nullptr);
  EXPECT_EQ(run.find("t_front")->quantum, 0.1);
  EXPECT_TRUE(run.find("t_front")->value.tail(40).array().isNaN().all());
  EXPECT_FALSE(run.find("t_front")->value.head(59).array().isNaN().any());
}

TEST_F(MeasuredRunTest, CallsNoCoarseSensorStuckForAChannelThatGoesItsOwnWay) {  // a bearing at rest beside a draughty door
  // first case: the door swings at the end and never followed the bearing; second case: the door followed the rise by
  // chance, and the bearing leaves its rest step by step
  for (const auto& [swing_K, share] : {std::pair{8.0, 0.25}, {4.0, 0.5}}) {
    std::string text = "time_s,speed_rpm,t_front_degC,door_degC\n";
    for (int i = 0; i < 200; ++i) {
      const double rise_K = i < 80 ? 0.0 : 15.0 * (1.0 - std::exp(-(i - 80) / 40.0));
      text += fmt::format("{},500,{:.1f},{:.2f}\n", 60 * i, 20.0 + 0.5 * std::round(rise_K / 0.5),
                          18.0 + swing_K * std::sin(i / 35.0) + share * rise_K);
    }
    const MeasuredRun run = read(text);
    ASSERT_NE(run.find("t_front"), nullptr);
    EXPECT_FALSE(run.find("t_front")->value.array().isNaN().any()) << told(run);
  }
}

TEST_F(MeasuredRunTest, LeavesOutAChannelOfWhichTooLittleIsLeft) {
  std::string text = "time_s,speed_rpm,t_front_degC,nose_z_um\n";
  for (int i = 0; i < 100; ++i)
    text += fmt::format("{},500,{:.5f},{}\n", 60 * i, i < 9 ? 20.0 + 0.0371234 * i : 20.3, 1.01 * i * i);
  const MeasuredRun run = read(text);
  EXPECT_EQ(run.find("t_front"), nullptr);
  EXPECT_THAT(told(run), HasSubstr("too little else is there: it is left out"));
  EXPECT_THAT(told(run), Not(HasSubstr("saturated; it is left out")));  // said once
}

TEST_F(MeasuredRunTest, LeavesOutASaturatedSensor) {  // clipped at 24 degC for 12 rows at a time
  std::string text = "time_s,speed_rpm,t_front_degC,nose_z_um\n";
  for (int i = 0; i < 100; ++i)
    text += fmt::format("{},500,{:.5f},{}\n", 60 * i, std::min(24.0, 22.0 + 2.6123 * std::sin(0.12 * i)), 1.01 * i * i);
  const MeasuredRun run = read(text);
  EXPECT_EQ(run.find("t_front"), nullptr);
  EXPECT_THAT(told(run), HasSubstr("at its limit of 24 degC: saturated"));
}

// Steps of 0.25 K that noise carries it across in most rows; a rest at the lowest reading is no longer than another one
// at a middle one.
TEST_F(MeasuredRunTest, KeepsASensorThatRestsAtItsLowestReading) {
  std::string text = "time_s,speed_rpm,t_front_degC,nose_z_um\n";
  for (int i = 0; i < 200; ++i) {
    const double moving_C = 20.0 + 0.25 * std::round(20.0 * std::sin(0.05 * i) + 3.0 * std::sin(2.1 * i));
    const double t_C = i >= 100 && i < 120 ? 14.0 : i >= 150 && i < 162 ? 12.0 : moving_C;
    text += fmt::format("{},500,{:.2f},{}\n", 60 * i, t_C, 1.01 * i * i);
  }
  const MeasuredRun run = read(text);
  ASSERT_NE(run.find("t_front"), nullptr) << told(run);
  EXPECT_THAT(told(run), Not(HasSubstr("saturated")));
}

TEST_F(MeasuredRunTest, LeavesOutASensorThatIsSaturatedAtBothEnds) {
  std::string text = "time_s,speed_rpm,t_front_degC,nose_z_um\n";
  for (int i = 0; i < 240; ++i)
    text +=
        fmt::format("{},500,{:.5f},{}\n", 60 * i, std::clamp(25.0 + 8.0123 * std::sin(0.12 * i), 19.0, 30.0), 1.01 * i * i);
  const MeasuredRun run = read(text);
  EXPECT_EQ(run.find("t_front"), nullptr);
  EXPECT_THAT(told(run), HasSubstr("at its limit of"));
}

TEST_F(MeasuredRunTest, KnowsTheStepOfAnInstrumentWithAnOffset) {  // 1/16 K and a calibration by 0.13 K
  std::string text = "time_s,speed_rpm,t_front_degC\n";
  for (int i = 0; i < 90; ++i) text += fmt::format("{},500,{:.4f}\n", 60 * i, 20.13 + 0.0625 * (i < 50 ? 0 : (i - 50) / 3));
  const MeasuredRun run = read(text);
  ASSERT_NE(run.find("t_front"), nullptr) << told(run);
  EXPECT_NEAR(run.find("t_front")->quantum, 0.0625, 1e-9);
}

TEST_F(MeasuredRunTest, RefusesAnAmbientInFahrenheitOrKelvin) {
  const auto record = [](double ambient) {
    std::string text = "time_s,speed_rpm,ambient_degC,t_front_degC\n";
    for (int i = 0; i < 5; ++i) text += fmt::format("{},0,{},{}\n", 60 * i, ambient, 20.0 + 0.1 * i);
    return text;
  };
  EXPECT_THAT(refusal(record(68.5)),
              AllOf(HasSubstr("ambient_degC looks like degF"), HasSubstr("68.5"), HasSubstr("20 degC")));
  EXPECT_THAT(refusal(record(294.1)), HasSubstr("ambient_degC looks like kelvin"));
  for (const double honest_C : {-15.0, 5.0, 38.0, 44.0}) EXPECT_EQ(refusal(record(honest_C)), "") << honest_C;
}

TEST_F(MeasuredRunTest, KeepsBothSidesOfAHoleAndReadsNothingWithinIt) {
  std::string text = "time_s,speed_rpm,t_front_degC\n";
  for (int i = 0; i < 100; ++i) {  // rows 20 to 39 have no speed, and the time of its drop is unknown
    const std::string speed = i < 20 ? "500" : i < 40 ? "" : "0";
    text += fmt::format("{},{},{:.3f}\n", 60 * i, speed, 20.0 + 0.013 * i);
  }
  const MeasuredRun run = read(text);
  EXPECT_EQ(run.time_s.size(), 100u);
  ASSERT_EQ(run.holes.size(), 1u);
  EXPECT_EQ(run.holes[0].begin_s, 19 * 60.0);
  EXPECT_EQ(run.holes[0].end_s, 40 * 60.0);
  const Eigen::VectorXd& value = run.find("t_front")->value;
  for (Eigen::Index i = 0; i < 100; ++i) EXPECT_EQ(std::isnan(value[i]), i > 19 && i < 40) << i;
  EXPECT_EQ(run.cyclogram.speed_rpm(30 * 60.0), 500.0);
  ASSERT_FALSE(run.findings.empty());
  EXPECT_THAT(run.findings.front().what,
              AllOf(HasSubstr("from 19 to 40 min no row says a speed"), HasSubstr("500 rpm before and 0 rpm after")));
}

TEST_F(MeasuredRunTest, SaysThatAHoleOfRowsIsOneWhateverTheSpeedBeforeAndAfter) {
  std::string text = "time_s,speed_rpm,t_front_degC\n";
  for (int i = 0; i < 100; ++i) {
    if (i < 20 || i >= 40) text += fmt::format("{},500,{:.3f}\n", 60 * i, 20.0 + 0.013 * i);
  }
  const MeasuredRun run = read(text);
  EXPECT_EQ(run.time_s.size(), 80u);
  EXPECT_EQ(run.holes.size(), 1u);
  ASSERT_FALSE(run.findings.empty());
  EXPECT_THAT(run.findings.front().what, HasSubstr("500 rpm before and 500 rpm after"));
}

TEST_F(MeasuredRunTest, TakesWhatALoggerWritesInBurstsForItsPace) {
  std::string text = "time_s,speed_rpm,t_front_degC\n";
  double t_s = 0.0;
  for (int burst = 0; burst < 40; ++burst) {  // three readings of a homing, then nothing for a minute; once for twenty
    for (int i = 0; i < 3; ++i) text += fmt::format("{},500,{:.3f}\n", t_s + 4.0 * i, 20.0 + 0.01 * burst + 0.003 * i);
    t_s += burst == 25 ? 1200.0 : 60.0;
  }
  const MeasuredRun run = read(text);
  ASSERT_EQ(run.holes.size(), 1u);
  EXPECT_EQ(run.holes[0].begin_s, 25 * 60.0 + 8.0);
  EXPECT_EQ(run.holes[0].end_s, 25 * 60.0 + 1200.0);
}

TEST(Grid, OfACyclogramThatEndsEarlyHoldsItsLastDriveToTheLastRow) {
  MeasuredRun run;
  run.time_s = {0.0, 600.0, 1200.0};
  run.cyclogram.sections = {{300.1, {.speed_rpm = 1000.0}}, {0.3, {.speed_rpm = 2000.0}}};
  set_grid(run);
  EXPECT_GE(run.cyclogram.duration_s(), 1200.0);
  EXPECT_NEAR(run.cyclogram.duration_s(), 1200.0, 1e-9);
  EXPECT_EQ(run.cyclogram.sections[0].duration_s, 300.1);
}

TEST_F(MeasuredRunTest, LeavesOutAReadingThatLeapsAwayAndBack) {
  std::string text = "time_s,speed_rpm,t_front_degC\n";
  for (int i = 0; i < 100; ++i)
    text += fmt::format("{},500,{:.3f}\n", 60 * i, i == 50 ? -999.0 : 20.0 + 0.013 * i + 0.05 * std::sin(7.0 * i));
  const MeasuredRun run = read(text);
  ASSERT_NE(run.find("t_front"), nullptr);
  EXPECT_TRUE(std::isnan(run.find("t_front")->value[50]));
  EXPECT_FALSE(std::isnan(run.find("t_front")->value[51]));
  ASSERT_FALSE(run.findings.empty());
  EXPECT_THAT(run.findings.front().what, HasSubstr("reads -999 degC at 50 min"));
}

TEST_F(MeasuredRunTest, RefusesARecordOfAnotherPose) {
  // Also one that rests there: a column that does not change is otherwise dropped.
  scenarios::MachineModel model;
  model.reference_K = 293.15;
  model.ambient = {{0.0}, {0.0}};
  model.axes.push_back({.name = "x",
                        .moves = {"table"},
                        .way = {.direction = Eigen::Vector3d::UnitX()},
                        .high_SI = 1.0,
                        .column = "position_x",
                        .where = {}});
  const auto read_at = [&](double position_mm) {
    std::string text = "time_s,speed_rpm,position_x_mm,nose_z_um\n";
    for (int i = 0; i < 6; ++i) text += fmt::format("{},500,{},{}\n", 60 * i, position_mm, 0.1 * i * i);
    return measured_run(read_record(write_file("at_a_pose.csv", text), std::nullopt), model, outputs());
  };
  EXPECT_EQ(read_at(0.0).time_s.size(), 6u);
  EXPECT_THAT([&] { (void)read_at(100.0); },
              testing::ThrowsMessage<InputError>(AllOf(HasSubstr("axis 'x' to 100 mm"), HasSubstr("0 mm"))));
}

TEST_F(MeasuredRunTest, SaysWhyTheOnlyChannelIsLeftOut) {
  std::string text = "time_s,speed_rpm,t_front_degC\n";
  for (int i = 0; i < 40; ++i) text += std::to_string(60 * i) + ",500,23.4\n";
  EXPECT_THAT(refusal(text), AllOf(HasSubstr("no channel to compare"), HasSubstr("t_front is stuck")));
}

TEST_F(MeasuredRunTest, RefusesWhatCannotBeComparedAndSaysWhatIsWanted) {
  EXPECT_THAT(refusal("time_s,t_front_degC\n0,20\n60,21\n120,22\n"),
              AllOf(HasSubstr("speed_rpm"), HasSubstr("t_front_degC")));
  EXPECT_THAT(refusal("time_s,speed_rpm,t_front_um\n0,0,20\n60,0,21\n120,0,22\n"),
              AllOf(HasSubstr("t_front is in um"), HasSubstr("degC")));
  EXPECT_THAT(refusal("time_s,speed_rpm,other_degC\n0,0,20\n60,0,21\n120,0,22\n"),
              AllOf(HasSubstr("no channel to compare"), HasSubstr("t_front")));
  EXPECT_THAT(refusal("time_s,speed_rpm,t_front_degC\n0,0,20\n60,0,21\n"), HasSubstr("2 rows"));
  EXPECT_THAT(refusal("time_s,speed_rpm,t_front_degC\n0,-5,20\n60,0,21\n120,0,22\n"), HasSubstr("speeds must be positive"));
}

}  // namespace
}  // namespace driftwright::diagnosis::measured_run_test
