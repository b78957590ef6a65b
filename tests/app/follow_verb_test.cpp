// `driftwright follow` as a user runs it: the drift of `predict`, row by row; restarts; replays; what it refuses. One file:
// all cases follow one machine.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/record.hpp"
#include "tests/shared/command_line.hpp"

namespace driftwright::follow_verb_test {
namespace {

using ::testing::AllOf, ::testing::HasSubstr, ::testing::Not;
using Json = nlohmann::json;

/// One body of 60 kJ/K on 20 W/K to the ambient: 15 K and 60 um at 2000 rpm with a time constant of 50 min. The ambient
/// warms. To one axis something learned is added.
constexpr const char* kHead = R"(name: head
reference_temperature: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: head, capacity: 60 kJ/K}
  - {type: motor_loss, node: head, power: 300 W, at_speed: 2000 rpm, exponent: 1}
  - {type: link, node: head, to: ambient, conductance: 20 W/K}
  - {type: learned, displacement: nose_y, keeps: 0.8, follows: speed, at_speed: 1800 rpm, exponent: 1.6, grows: [[0 min, -2 um], [12 min, -8 um]]}
  - {type: learned, displacement: nose_y, follows: running, grows: [[7 min, 3 um]]}
  - {type: learned, displacement: nose_y, follows: ambient, grows: [[20 min, -4 um]]}
start: ambient
ambient: [[0 h, 21 degC], [2 h, 23 degC], [9 h, 22 degC]]
sensors: [{name: t_head, node: head}]
displacements:
  - {name: nose_z, sensitivities: [{node: head, sensitivity: 4 um/K}]}
  - {name: nose_y, sensitivities: [{node: head, sensitivity: -1 um/K}]}
cyclograms:
  day: [[60 min, 2000 rpm], [20 min, 500 rpm], [30 min, 1000 rpm], [45 min, 2000 rpm], [25 min, 0 rpm]]
solver: {model: reduced}
)";

struct Followed {
  int exit_code = -1;
  std::vector<Json> lines;
  std::string text, words;
};

/// A line of a shell that says where rows come from.
Followed follow(const std::string& arguments, const std::string& rows_from) {
  const auto folder = temporary_folder();
  const CommandOutcome outcome = run_program("--version >/dev/null; cd " + folder.string() + " && (" + rows_from + " " +
                                             DRIFTWRIGHT_PROGRAM + " follow " + arguments + " 2>words.txt >lines.txt)");
  Followed f{.exit_code = outcome.exit_code,
             .lines = {},
             .text = read_text(folder / "lines.txt"),
             .words = read_text(folder / "words.txt")};
  std::istringstream lines(f.text);
  for (std::string line; std::getline(lines, line);) f.lines.push_back(Json::parse(line));
  return f;
}

/// The record that `predict` writes of a cyclogram of the scenario NAME.yaml, also as CYCLOGRAM.csv.
Record predicted_of(const std::string& name, const std::string& text, const std::string& cyclogram) {
  const auto folder = temporary_folder();
  write_file(name + ".yaml", text);
  const CommandOutcome outcome = run_program("predict " + (folder / (name + ".yaml")).string() + " --cyclogram " +
                                             cyclogram + " -o " + (folder / "predicted").string() + " --force --quiet");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  const auto csv = folder / (cyclogram + ".csv");
  std::filesystem::copy_file(folder / "predicted" / "record.csv", csv, std::filesystem::copy_options::overwrite_existing);
  return read_record_csv(csv.string());
}
Record predicted_day() {
  return predicted_of("head", kHead, "day");
}

TEST(FollowVerb, TellsTheDriftThatPredictTells) {
  const Record day = predicted_day();
  const Followed f = follow("head.yaml --slew '100 um/s'", "cat day.csv |");
  ASSERT_EQ(f.exit_code, 0) << f.words;
  ASSERT_EQ(f.lines.size(), day.n_samples());
  for (const char* axis : {"nose_z", "nose_y"}) {
    const std::vector<double>& drift = day.at(axis).values;
    double most_um = 0.0, off_um = 0.0;
    for (std::size_t i = 0; i < drift.size(); ++i) {
      most_um = std::max(most_um, std::abs(drift[i]));
      off_um = std::max(off_um, std::abs(f.lines[i]["axes"][axis]["predicted_um"].get<double>() - drift[i]));
      if (i == 0) continue;  // the axis is at 0, and moves at the slew
      off_um = std::max(off_um, std::abs(f.lines[i]["axes"][axis]["correction_um"].get<double>() - drift[i]));
    }
    EXPECT_GT(most_um, 10.0);
    EXPECT_LT(off_um, 2e-5) << axis;  // seven digits of the record
  }
  EXPECT_EQ(f.lines.back()["state"], "on");
}

/// A ball screw in the motor encoder's loop, beside the same axis closed by a scale.
constexpr const char* kAxis = R"(name: axis
reference_temperature: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: nut, capacity: 2 kJ/K}
  - {type: node, node: scale, capacity: 1 kJ/K}
  - {type: link, node: nut, to: ambient, conductance: 5 W/K}
  - {type: link, node: scale, to: nut, conductance: 1 W/K}
  - {type: feed_axis, node: nut, screw: s, axis: x, travel: 800 mm, fixed_gap: 100 mm, far_gap: 100 mm, diameter: 36 mm,
     lead: 10 mm, nut_length: 80 mm, torque: 1 N m, nut_conductance: 4 W/K, mounting: fixed_free, position: position_x,
     stroke: stroke_x_mm}
  - {type: linear_scale, displacement: by_scale, body: scale, expansion: 8e-6 1/K, fixed_at: 100 mm, position: position_x_mm}
start: ambient
ambient: [[0 h, 21 degC]]
displacements:
  - {name: at_nut, screw: s}
  - {name: by_scale, sensitivities: [{node: nut, sensitivity: 0.5 um/K}]}
cyclograms:
  strokes:
    columns: [duration, feed_x, position_x_mm, stroke_x_mm]
    rows: [[10 min, 6 m/min, 400 mm, 800 mm], [9 min, 3 m/min, 700 mm, 200 mm], [1 min, 6 m/min, 20 mm, 0 mm],
           [15 min, 6 m/min, 150 mm, 60 mm], [5 min, 0 m/min, 790 mm, 0 mm]]
solver: {relative_tolerance: 1e-8, absolute_tolerance: 1e-8 K, output_interval: 1 min}
)";

// Heat where the nut was, the error where it is: from 53 um to 5 um within a row as the nut goes to the fixed bearing.
TEST(FollowVerb, FollowsTheRecordedPositionOfAFeedAxis) {
  const Record strokes = predicted_of("axis", kAxis, "strokes");
  const Followed f = follow("axis.yaml --slew '100 um/s'", "cat strokes.csv |");
  ASSERT_EQ(f.exit_code, 0) << f.words;
  ASSERT_EQ(f.lines.size(), strokes.n_samples());
  for (const char* axis : {"at_nut", "by_scale"}) {
    for (std::size_t i = 0; i < strokes.n_samples(); ++i)
      EXPECT_NEAR(f.lines[i]["axes"][axis]["predicted_um"].get<double>(), strokes.at(axis).values[i], 1e-3) << axis << i;
  }
  EXPECT_GT(strokes.at("at_nut").values[18], 45.0);
  EXPECT_LT(strokes.at("at_nut").values[19], 6.0);
  // a restart changes nothing: the heat goes on to where the nut was
  std::filesystem::remove(temporary_folder() / "axis.state");
  const Followed first = follow("axis.yaml --slew '100 um/s' --state axis.state", "head -n 26 strokes.csv |");
  const Followed second = follow("axis.yaml --slew '100 um/s' --state axis.state", "sed '/^[0-9]/{1,26d}' strokes.csv |");
  EXPECT_EQ(first.text + second.text, f.text);
}

// Rows 3 to 5 have no position: the last one is held. A position 20 mm past the travel is refused: the correction is held,
// and the line says why.
TEST(FollowVerb, HoldsAPositionThatIsMissingOrPastTheTravel) {
  write_file("axis.yaml", kAxis);
  const auto rows = [](const std::string& held, const std::string& end) {
    std::string text = "time_s,speed_rpm,feed_x_mm_min,position_x_mm,stroke_x_mm,ambient_degC\n";
    for (int minute = 0; minute <= 20; ++minute) {
      const std::string at = minute >= 3 && minute <= 5 ? held : minute >= 19 ? end : "600";
      text += std::to_string(60 * minute) + ",0,6000," + at + ",40,21\n";
    }
    write_file("rows.csv", text);
    return follow("axis.yaml --slew '100 um/s'", "cat rows.csv |");
  };
  const Followed whole = rows("600", "600"), missing = rows("", "600"), past = rows("600", "820");
  ASSERT_EQ(whole.exit_code, 0) << whole.words;
  EXPECT_EQ(missing.text, whole.text);
  ASSERT_EQ(past.lines.size(), 21U);
  const auto corrected_um = [&](std::size_t row) {
    return past.lines[row]["axes"]["at_nut"]["correction_um"].get<double>();
  };
  EXPECT_GT(corrected_um(18), 10.0);
  EXPECT_EQ(corrected_um(20), corrected_um(18));
  EXPECT_THAT(past.lines[20].dump(), HasSubstr("\"doubted\":[\"position_x\"]"));
  write_file(
      "rows.csv",
      "time_s,speed_rpm,feed_x_mm_min,position_x_mm,stroke_x_mm,ambient_degC\n0,0,6000,,40,21\n60,0,6000,600,40,21\n");
  const Followed late = follow("axis.yaml", "cat rows.csv |");
  ASSERT_EQ(late.lines.size(), 2U);
  EXPECT_THAT(late.lines[0].dump(), HasSubstr("\"why\":\"no row has given position_x yet\""));
  EXPECT_THAT(late.lines[1].dump(), HasSubstr("\"state\":\"on\""));
  const Followed none = follow("axis.yaml", "echo 'time_s,speed_rpm,feed_x_mm_min,stroke_x_mm,ambient_degC' |");
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_THAT(none.words, HasSubstr("'position_x_mm', which the stream does not have"));
}

// A control that no longer gives its speed, or a thermometer of the air that came off: the machine's drive is unknown now.
TEST(FollowVerb, FadesWhereRowsNoLongerGiveTheDrive) {
  write_file("head.yaml", kHead);
  for (const char* missing : {"speed", "ambient"}) {
    std::string rows = "time_s,speed_rpm,ambient_degC\n";
    for (int minute = 0; minute <= 180; ++minute) {
      const bool is_blind = minute > 100;
      const bool no_speed = is_blind && missing == std::string("speed");
      rows += std::to_string(60 * minute) + (no_speed ? "," : ",2000") + (is_blind && !no_speed ? ",\n" : ",21\n");
    }
    write_file("rows.csv", rows);
    const std::string arguments = "head.yaml --slew '100 um/s' --hold '10 min' --fade '20 min'";
    const Followed f = follow(arguments, "cat rows.csv |");
    ASSERT_EQ(f.exit_code, 0) << f.words;
    // a restart in between changes nothing, be it that its first row is doubled
    const std::string state = std::string(" --state ") + missing + ".state";
    std::filesystem::remove(temporary_folder() / (std::string(missing) + ".state"));
    const Followed first = follow(arguments + state, "head -n 132 rows.csv |");
    const Followed second = follow(arguments + state, "sed '2,132d' rows.csv |");
    EXPECT_EQ(first.text + second.text, f.text) << missing;
    const Followed doubled = follow(arguments + state, "sed '2,181d' rows.csv |");
    EXPECT_THAT(doubled.text, HasSubstr("\"doubted\":[\"" + std::string(missing) + "\"]")) << missing;
    const auto correction_um = [&](std::size_t minute) {
      return f.lines[minute]["axes"]["nose_z"]["correction_um"].get<double>();
    };
    EXPECT_EQ(f.lines[110]["state"], "on") << missing;
    EXPECT_GT(correction_um(110), correction_um(100)) << missing;  // it warms on
    // 50 min old, of which a hold and two and a half rows are allowed
    const double predicted_um = f.lines[150]["axes"]["nose_z"]["predicted_um"].get<double>();
    EXPECT_NEAR(correction_um(150), std::exp(-37.5 / 20.0) * predicted_um, 1e-3) << missing;
    EXPECT_EQ(f.lines[150]["state"], "reduced") << missing;
    EXPECT_THAT(f.lines[150]["why"].get<std::string>(), HasSubstr(missing));
  }
}

// An hour at 2000 rpm leads to 42 um. Four rows at 4000 rpm are above the limit: the correction is held, and goes on after
// them.
TEST(FollowVerb, KeepsTheLimitsOfTheMachine) {
  std::string rows = "time_s,speed_rpm,ambient_degC\n";
  for (int minute = 0; minute <= 120; ++minute)
    rows += std::to_string(60 * minute) + (minute > 60 && minute <= 64 ? ",4000" : ",2000") + ",20\n";
  write_file("rows.csv", rows);
  const auto corrections_um = [](const Followed& f) {
    std::vector<double> um;
    for (const Json& line : f.lines) um.push_back(line["axes"]["nose_z"]["correction_um"].get<double>());
    return um;
  };
  write_file("limited.yaml", std::string(kHead) + "limits: {speed: 2000 rpm}\n");
  const Followed held = follow("limited.yaml --slew '100 um/s'", "cat rows.csv |");
  ASSERT_EQ(held.exit_code, 0) << held.words;
  const std::vector<double> held_um = corrections_um(held);
  ASSERT_EQ(held_um.size(), 121U);
  EXPECT_GT(held_um[60], 30.0);
  for (std::size_t minute = 61; minute <= 64; ++minute) EXPECT_EQ(held_um[minute], held_um[60]) << minute;
  EXPECT_THAT(held.lines[62].dump(), HasSubstr("\"doubted\":[\"speed\"]"));
  EXPECT_GT(held_um[66], held_um[60] + 1.0);
  write_file("limited.yaml", std::string(kHead) + "limits: {correction: 20 um}\n");
  const std::vector<double> small_um = corrections_um(follow("limited.yaml --slew '100 um/s'", "cat rows.csv |"));
  ASSERT_EQ(small_um.size(), 121U);
  EXPECT_EQ(*std::max_element(small_um.begin(), small_um.end()), 20.0);
}

TEST(FollowVerb, TakesSpeedAndAmbientThatComeInRowsOfTheirOwn) {
  write_file("head.yaml", kHead);
  std::string rows = "time_s,speed_rpm,ambient_degC\n0,2000,21\n";
  for (int i = 1; i <= 720; ++i) rows += std::to_string(10 * i) + (i % 2 == 0 ? ",2000,\n" : ",,21\n");
  write_file("rows.csv", rows);
  const Followed f = follow("head.yaml", "cat rows.csv |");
  ASSERT_EQ(f.exit_code, 0) << f.words;
  EXPECT_EQ(f.lines.back()["state"], "on");
  EXPECT_EQ(f.lines.back()["axes"]["nose_z"]["trust"], 1.0);
}

// What was followed is what a job starts from: the day as it was recorded, a rest and a job drift as all of it in one
// simulation does.
TEST(FollowVerb, LeavesARecordThatJobsStartFrom) {
  (void)predicted_day();
  const Followed f = follow("head.yaml --record seen.csv", "cat day.csv |");
  ASSERT_EQ(f.exit_code, 0) << f.words;
  std::string yaml = kHead;
  const std::string day = "[60 min, 2000 rpm], [20 min, 500 rpm], [30 min, 1000 rpm], [45 min, 2000 rpm], [25 min, 0 rpm]";
  yaml.insert(yaml.find("solver:"),
              "  job: [[50 min, 1500 rpm]]\n  all: [" + day + ", [20 min, 0 rpm], [50 min, 1500 rpm]]\n");
  write_file("jobs.yaml", yaml);
  const auto predicted = [&](const std::string& out, const std::string& arguments) {
    const std::string folder = temporary_folder().string();
    const CommandOutcome outcome = run_program("predict " + folder + "/jobs.yaml --cyclogram " + arguments + " -o " +
                                               folder + "/" + out + " --force --quiet");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    return read_record_csv(folder + "/" + out + "/record.csv");
  };
  const Record whole = predicted("whole", "all");
  const Record warm =
      predicted("warm", "job --start " + (temporary_folder() / "seen.csv").string() + " --after-pause '20 min'");
  const Record cold = predicted("cold", "job");
  const auto at = [](const Record& record, double time_s) {
    const auto i = std::lower_bound(record.time_s.begin(), record.time_s.end(), time_s - 1e-6) - record.time_s.begin();
    return record.at("nose_z").values.at(static_cast<std::size_t>(i));
  };
  const double begun_s = 200.0 * 60.0;
  for (const double t_s : {600.0, 1500.0, 3000.0}) {
    const double drift_um = at(whole, begun_s + t_s) - at(whole, begun_s);
    EXPECT_NEAR(at(warm, t_s) - at(warm, 0.0), drift_um, 0.15) << t_s;
    EXPECT_GT(std::abs(at(cold, t_s) - at(cold, 0.0) - drift_um), 1.0) << t_s;
  }
}

TEST(FollowVerb, AReplayGivesTheSameBytesAtAnyPace) {
  (void)predicted_day();
  const std::string by_pipe = follow("head.yaml", "cat day.csv |").text;
  EXPECT_EQ(follow("head.yaml --replay day.csv", "").text, by_pipe);
  EXPECT_EQ(follow("head.yaml --replay day.csv --pace 20000", "").text, by_pipe);
}

TEST(FollowVerb, GoesOnFromItsStateAndWritesARecord) {
  const Record day = predicted_day();
  const auto folder = temporary_folder();
  const std::string whole = follow("head.yaml --replay day.csv", "").text;
  for (const char* name : {"axis.state", "seen.csv"}) std::filesystem::remove(folder / name);
  std::string header, head, tail;
  std::istringstream rows(read_text(folder / "day.csv"));
  int n = 0;
  for (std::string line; std::getline(rows, line);) {
    if (line.starts_with('#')) continue;
    if (header.empty()) {
      header = line + "\n";
    } else {
      (n++ < 70 ? head : tail) += line + "\n";
    }
  }
  write_file("head.csv", header + head);
  write_file("tail.csv", header + tail);
  const std::string arguments = "head.yaml --state axis.state --record seen.csv";
  const Followed first = follow(arguments, "cat head.csv |"), second = follow(arguments, "cat tail.csv |");
  EXPECT_EQ(first.exit_code, 0) << first.words;
  EXPECT_EQ(first.text + second.text, whole);
  EXPECT_THAT(second.words, HasSubstr("goes on from axis.state"));
  const Record seen = read_record_csv((folder / "seen.csv").string());
  EXPECT_EQ(seen.time_s, day.time_s);
  EXPECT_EQ(seen.at("t_head").values, day.at("t_head").values);
  std::ofstream(folder / "head.yaml", std::ios::app) << "\n";
  const Followed other = follow(arguments, "cat tail.csv |");
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.words, HasSubstr("is not the file that the state was kept with"));
}

TEST(FollowVerb, BadRowsAreCountedAndAnsweredAll) {
  (void)predicted_day();
  const Followed f =
      follow("head.yaml --slew '1 um/s'",
             "(head -12 day.csv; echo 'a,b'; echo; sed -n 12p day.csv; sed -n 13,20p day.csv; printf '\\377\\000,1\\n') |");
  EXPECT_EQ(f.exit_code, 0) << f.words;
  EXPECT_THAT(f.words, AllOf(HasSubstr("unreadable_row 2"), HasSubstr("doubled 1")));
  double last_um = 0.0;
  for (const Json& line : f.lines) {
    const double um = line["axes"]["nose_z"]["correction_um"].get<double>();
    EXPECT_LE(std::abs(um - last_um), 60.0 + 1e-9);
    last_um = um;
  }
}

TEST(FollowVerb, SaysWhatItCannotFollow) {
  (void)predicted_day();
  const auto refused = [&](const std::string& arguments, const std::string& rows_from, const std::string& words) {
    const Followed f = follow(arguments, rows_from);
    EXPECT_EQ(f.exit_code, 2) << arguments;
    EXPECT_THAT(f.words, HasSubstr(words)) << arguments;
    EXPECT_EQ(f.text, "");
  };
  refused("head.yaml", "echo 'time_s,speed_rpm' |", "'ambient_degC', which the stream does not have");
  refused("head.yaml", "echo 'nonsense' |", "no unit");
  refused("head.yaml --pace 3", "true |", "--pace");
  refused("head.yaml --probe-noise '-1 um'", "true |", "--probe-noise '-1 um' must be above 0");
  refused("head.yaml --probe-lag '3 um'", "true |", "--probe-lag");
  refused("head.yaml --tolerance '10 um'", "cat day.csv |", "--tolerance require a column of probings");
  refused("head.yaml", "echo 'time_s,speed_rpm,ambient_degC,probe_nose_z_um' |", "a probing that no followed model takes");
  refused("head.yaml --slew '0 um/s'", "true |", "must be above 0");
  refused("head.yaml head.yaml", "true |", "corrected by another model");
  refused("nowhere.json", "true |", "no such file");
  refused("head.yaml --replay /dev/zero", "true |", "a header or a JSON row comes first");
  refused("head.yaml --replay .", "true |", "--replay .: Is a directory");
  refused("head.yaml --state pipe", "mkfifo pipe; cat day.csv |", "it must be a file");
  refused("head.yaml --state /dev/zero", "cat day.csv |", "it must be a file");
  std::string grows = kHead;
  grows.insert(grows.find("start: ambient"),
               "  - {type: spindle_growth, displacement: nose_z, growth: 5 um, at_speed: 2000 rpm, lag: 5 min}\n");
  write_file("grows.yaml", grows);
  refused("grows.yaml", "true |", "spindle_growth nose_z");
  std::string column = kHead;
  column.insert(
      column.find("start: ambient"),
      "  - {type: learned, displacement: nose_z, follows: column, column: bed_W, at: 100, grows: [[5 min, 4 um]]}\n");
  write_file("column.yaml", column);
  refused("column.yaml", "true |", "follows the recorded column 'bed_W'");
}

/// Two bodies with thermometers. @param power_W  of the heat at 2000 rpm
std::string two_bodies(double power_W, const char* interval) {
  return fmt::format(R"(name: two_bodies
reference_temperature: 20 degC
machine: {{generator: lumped}}
effects:
  - {{type: node, node: spindle, capacity: 8 kJ/K}}
  - {{type: node, node: head, capacity: 40 kJ/K}}
  - {{type: heat_source, node: spindle, power: {} W, at_speed: 2000 rpm, exponent: 1}}
  - {{type: link, node: spindle, to: head, conductance: 15 W/K}}
  - {{type: link, node: spindle, to: ambient, conductance: 2 W/K}}
  - {{type: link, node: head, to: ambient, conductance: 12 W/K}}
start: ambient
ambient: [[0 h, 20 degC], [9 h, 21 degC]]
sensors: [{{name: t_spindle, node: spindle}}, {{name: t_head, node: head}}, {{name: t_ambient, node: ambient}}]
displacements: [{{name: nose_z, sensitivities: [{{node: spindle, sensitivity: 3 um/K}}, {{node: head, sensitivity: 2 um/K}}]}}]
cyclograms:
  monday: [[60 min, 2000 rpm], [60 min, 0 rpm], [60 min, 1000 rpm]]
  tuesday: [[90 min, 1500 rpm], [40 min, 0 rpm], [50 min, 2000 rpm]]
  wednesday: [[40 min, 1800 rpm], [20 min, 0 rpm], [60 min, 1200 rpm]]
solver: {{model: reduced, output_interval: {}}}
)",
                     power_W, interval);
}

class FollowedObserver : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const auto folder = temporary_folder();
    const std::string yaml = write_file("two_bodies.yaml", two_bodies(150.0, "1 min"));
    const CommandOutcome judged =
        run_program("validate " + yaml + " -o " + (folder / "judged").string() + " --force --quiet");
    ASSERT_EQ(judged.exit_code, 0) << judged.output;
  }
  /// What the machine of a power does, at rows of an interval, as lines of CSV with the header first.
  static std::vector<std::string> rows(double power_W, const char* interval) {
    const auto folder = temporary_folder() / "truth";
    const std::string yaml = write_file("truth.yaml", two_bodies(power_W, interval));
    const CommandOutcome done =
        run_program("predict " + yaml + " --cyclogram wednesday -o " + folder.string() + " --force --quiet");
    EXPECT_EQ(done.exit_code, 0) << done.output;
    std::vector<std::string> lines;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      if (entry.path().filename() != "record.csv") continue;
      std::istringstream text(read_text(entry.path()));
      for (std::string line; std::getline(text, line);) {
        if (!line.starts_with("#")) lines.push_back(line);
      }
    }
    return lines;
  }
  static std::size_t column(const std::vector<std::string>& rows, const std::string& name) {
    std::istringstream header(rows.front());
    std::string cell;
    for (std::size_t c = 0; std::getline(header, cell, ','); ++c) {
      if (cell == name) return c;
    }
    throw std::logic_error("no column " + name);
  }
  static std::vector<std::string> cells_of(const std::string& row) {
    std::istringstream text(row);
    std::vector<std::string> cells;
    for (std::string one; std::getline(text, one, ',');) cells.push_back(one);
    return cells;
  }
  static std::string row_of(const std::vector<std::string>& cells) {
    std::string row;
    for (const std::string& one : cells) row += (row.empty() ? "" : ",") + one;
    return row;
  }
  static Followed followed(const std::vector<std::string>& rows) {
    std::string text;
    for (const std::string& row : rows) text += row + "\n";
    write_file("rows.csv", text);
    return follow("judged/models/observer.json --slew '10 um/s'", "cat rows.csv |");
  }
};

// Power 2.5 times as large, at rows of a minute, of ten seconds and of one: trust falls, and calm errors are rare.
TEST_F(FollowedObserver, AWrongModelLosesTrustHoweverOftenRowsCome) {
  for (const char* interval : {"1 min", "10 s", "1 s"}) {
    const std::vector<std::string> all = rows(375.0, interval);
    const Followed f = followed(all);
    ASSERT_EQ(f.exit_code, 0) << f.words;
    ASSERT_EQ(f.lines.size() + 1, all.size());
    const std::size_t drift = column(all, "nose_z_um");
    const double first_um = std::stod(cells_of(all[1])[drift]);
    double least_trust = 1.0;
    std::size_t n_calm_and_wrong = 0;
    for (std::size_t i = 0; i < f.lines.size(); ++i) {
      const Json& axis = f.lines[i]["axes"]["nose_z"];
      const double off_um = std::stod(cells_of(all[i + 1])[drift]) - first_um - axis["correction_um"].get<double>();
      least_trust = std::min(least_trust, axis["trust"].get<double>());
      n_calm_and_wrong += axis["trust"] > 0.95 && std::abs(off_um) > 2.0 * axis["interval_95_um"].get<double>();
    }
    EXPECT_LT(least_trust, 0.3) << interval;
    EXPECT_LT(n_calm_and_wrong, f.lines.size() / 8) << interval;  // the first minutes of heat
  }
}

// No thermometer gives a reading: nothing says that the model is right, and it is not trusted.
TEST_F(FollowedObserver, WithoutAnyReadingThereIsNoTrust) {
  std::vector<std::string> all = rows(150.0, "1 min");
  const std::size_t spindle = column(all, "t_spindle_degC"), head = column(all, "t_head_degC");
  for (std::size_t i = 1; i < all.size(); ++i) {
    std::vector<std::string> cells = cells_of(all[i]);
    cells[spindle] = cells[head] = "";
    all[i] = row_of(cells);
  }
  const Followed f = followed(all);
  ASSERT_EQ(f.exit_code, 0) << f.words;
  EXPECT_LT(f.lines.back()["axes"]["nose_z"]["trust"], 0.01);
  EXPECT_THAT(f.lines.back()["axes"]["nose_z"]["doubted"].dump(), HasSubstr("without a reading"));
}

// A single speed of 60000 rpm is no reading; 3500 rpm, where 2000 were judged, takes trust away; so does a hall of 60 degC.
TEST_F(FollowedObserver, IsNotTrustedBeyondWhatItWasJudgedOn) {
  const std::vector<std::string> right = rows(150.0, "1 min");
  const std::size_t speed = column(right, "speed_rpm"), ambient = column(right, "t_ambient_degC");
  const auto changed = [&](std::size_t from, std::size_t to, std::size_t c, const char* value) {
    std::vector<std::string> all = right;
    for (std::size_t i = from; i < to; ++i) {
      std::vector<std::string> cells = cells_of(all[i]);
      cells[c] = value;
      all[i] = row_of(cells);
    }
    const Followed f = followed(all);
    EXPECT_EQ(f.exit_code, 0) << f.words;
    EXPECT_EQ(f.lines.size() + 1, all.size());
    return f;
  };
  const Followed once = changed(20, 21, speed, "60000");
  EXPECT_GT(once.lines[30]["axes"]["nose_z"]["trust"], 0.9);
  EXPECT_THAT(once.lines[30]["axes"]["nose_z"]["doubted"].dump(), Not(HasSubstr("judged on")));
  const Followed fast = changed(20, 60, speed, "3500");
  EXPECT_LT(fast.lines[45]["axes"]["nose_z"]["trust"], 0.5);
  EXPECT_THAT(fast.lines[45]["axes"]["nose_z"]["doubted"].dump(), HasSubstr("beyond those it was judged on"));
  const Followed hot = changed(20, 60, ambient, "60");
  EXPECT_LT(hot.lines[58]["axes"]["nose_z"]["trust"], 0.5);
}

// A scenario is followed as far as it says something of the speed.
TEST(FollowVerb, ASpeedThatNoLawKnowsIsNoReading) {
  const Record day = predicted_day();
  (void)day;
  const Followed f =
      follow("head.yaml --slew '100 um/s'",
             "awk -F, 'BEGIN{OFS=\",\"} /^#/{print;next} /^time/{for(i=1;i<=NF;i++) if($i==\"speed_rpm\") c=i; "
             "print;next} {n++; if(n==20) $c=900000; print}' day.csv |");
  ASSERT_EQ(f.exit_code, 0) << f.words;
  EXPECT_THAT(f.lines[19]["axes"]["nose_z"]["doubted"].dump(), HasSubstr("speed"));
  EXPECT_EQ(f.lines.back()["state"], "on");
}

}  // namespace
}  // namespace driftwright::follow_verb_test
