// Keys of diagnosis.json that others rely on (docs/reference/diagnosis.md), from causes by hand; and the order in which the
// reports of `diagnose`, `calibrate`, `validate` and `place` are read.

#include "findings/diagnosis_data.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "findings/cause_section.hpp"
#include "findings/cause_words.hpp"
#include "findings/diagnosis_answer.hpp"
#include "findings/diagnosis_document.hpp"
#include "findings/diagnosis_words.hpp"
#include "findings/placement_document.hpp"
#include "findings/strategy_section.hpp"
#include "output/document_html.hpp"
#include "output/document_json.hpp"
#include "output/document_text.hpp"

namespace driftwright::findings::diagnosis_data_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using Json = nlohmann::ordered_json;

TEST(DiagnosisData, CausesHaveTheirNumbersAndAlternatives) {
  diagnosis::Cause cause{"convection", "nose", "another film", {{"factor", "1", 1.5, 1.4, 1.6}}, 41.25, {}};
  cause.alternatives.push_back({"radiation", "nose", "sun", {{"power", "W", 12.0, 9.0, 15.0}}, 39.0, {}});
  output::Section section;
  add_causes_data(section, {cause});
  const Json json = output::document_json({.body = section});
  ASSERT_EQ(json["causes"].size(), 1U);
  const Json& named = json["causes"][0];
  EXPECT_EQ(named["effect"], "convection");
  EXPECT_EQ(named["where"], "nose");
  EXPECT_EQ(named["law"], "another film");
  EXPECT_EQ(named["log_evidence_gain"], 41.25);
  EXPECT_TRUE(named.contains("standing"));
  EXPECT_EQ(named["written"], true);
  EXPECT_FALSE(named.contains("why_not_written"));
  EXPECT_EQ(named["parameters"], Json::parse(R"([{"name": "factor", "value": 1.5, "unit": "1", "ci95": [1.4, 1.6]}])"));
  ASSERT_EQ(named["alternatives"].size(), 1U);
  EXPECT_EQ(named["alternatives"][0]["effect"], "radiation");
  EXPECT_EQ(named["alternatives"][0]["alternatives"], Json::array());
}

// The value of `where` that programs read is fixed, whatever scenarios call the air around a machine.
TEST(DiagnosisData, TheAmbientIsStillCalledHallUnderWhere) {
  diagnosis::Cause cause{"ambient", "ambient", "an offset", {}, 41.25, {}};
  cause.alternatives.push_back({"link", "housing,ambient", "another path", {}, 39.0, {}});
  cause.alternatives.push_back({"sensor_bias", "t_ambient", "a bias", {}, 38.0, {}});
  output::Section section;
  add_causes_data(section, {cause});
  const Json json = output::document_json({.body = section})["causes"][0];
  EXPECT_EQ(json["effect"], "ambient");
  EXPECT_EQ(json["where"], "hall");
  EXPECT_EQ(json["alternatives"][0]["where"], "housing,hall");
  EXPECT_EQ(json["alternatives"][1]["where"], "t_ambient");  // a sensor's name is the user's
}

TEST(DiagnosisData, CausesThatAreNotWrittenSayWhy) {
  diagnosis::Cause cause{"convection", "nose", "another film", {}, 41.25, {}};
  cause.is_written = false;
  cause.why_not_written = "rows that were kept out are predicted worse with it";
  output::Section section;
  add_causes_data(section, {cause});
  const Json json = output::document_json({.body = section})["causes"][0];
  EXPECT_EQ(json["written"], false);
  EXPECT_EQ(json["why_not_written"], "rows that were kept out are predicted worse with it");
}

TEST(DiagnosisData, NoCausesAreAnEmptyList) {
  output::Section section;
  add_causes_data(section, {});
  EXPECT_EQ(output::document_json({.body = section})["causes"], Json::array());
}

TEST(DiagnosisData, StatementsHaveTheirCourseInShownUnits) {
  diagnosis::Diagnosis d;
  diagnosis::Stated s;
  s.says.quantity = diagnosis::StatedQuantity::kDisplacement;
  s.says.place = {"nose"};
  s.says.unit = "m";
  s.course = {{.record = "monday", .edge_s = {0.0, 60.0, 180.0}, .value = {0.0, 5e-6}}};
  d.statements.stated.push_back(s);
  output::Section section;
  add_statements_data(section, d);
  const Json json = output::document_json({.body = section})["statements"][0]["course"][0];
  EXPECT_EQ(json["record"], "monday");
  EXPECT_EQ(json["edge_min"], Json::parse("[0.0, 1.0, 3.0]"));
  EXPECT_EQ(json["value"], Json::parse("[0.0, 5.0]"));
}

/// A record of one indicator, which moved by a step that the scenario lacks.
struct StepOfAnIndicator {
  studies::MeasuredTwin measured;
  diagnosis::Diagnosis d;
  diagnosis::ExtendedScenario extended;

  StepOfAnIndicator() {
    measured.scenario.name = "mill";
    measured.scenario.path = "mill.yaml";
    diagnosis::MeasuredRun run;
    run.name = "monday";
    run.path = "monday.csv";
    run.time_s = {0.0, 60.0};
    run.cyclogram.sections = {{60.0, {}}};
    run.ambient = {{0.0}, {0.0}};
    run.start_K = Eigen::VectorXd::Zero(1);  // warm: its file is not read for ISO 230-3
    run.channels = {{"nose", 0, "m", Eigen::VectorXd::Constant(2, 5e-6)}};
    measured.runs = {run};
    d.as_written = {Eigen::MatrixXd::Zero(1, 2)};
    d.extended = {Eigen::MatrixXd::Constant(1, 2, 5e-6)};
    d.search.fit.prediction = d.extended;
    d.search.findings.resize(1);
    d.noise["nose"] = {.white = 1e-6};
    diagnosis::Cause cause{"mount_shift", "nose", "step, in monday", {{"shift", "um", 5.0, 4.0, 6.0}}, 41.25, {}};
    cause.standing = diagnosis::Standing::kNamed;
    cause.probability = 0.97;
    d.causes = {cause};
    d.verdict = diagnosis::Verdict::kNamed;
    d.reason = "mount_shift at nose";
    d.statements.nothing = 0.01;
    for (const double probability : {0.97, 0.02}) {
      diagnosis::Stated stated;
      stated.says.quantity = diagnosis::StatedQuantity::kDisplacement;
      stated.says.place = {probability > 0.5 ? "nose" : "table"};
      stated.says.follows = "constant";
      stated.says.law = "constant";
      stated.says.unit = "m";
      stated.probability = probability;
      d.statements.stated.push_back(stated);
    }
    d.gain.push_back({.name = "nose", .unit = "um", .noise_floor = 1.0, .rmse_before = 5.0, .rmse_after = 1.0});
    d.misses.as_written = 5.0;
    d.misses.extended = 1.0;
    d.calibrated.push_back({.name = "heat", .unit = "W", .value = 40.0, .low = 35.0, .high = 45.0, .deviation = 0.2});
  }
  [[nodiscard]] DiagnosisFindings findings(const std::string& file) const { return {measured, d, extended, "", file}; }
};

/// Answer, picture, what to do next, numbers, folded: no table before the numbers, and nothing that is folded among them.
void expect_read_from_the_top(const output::Document& document) {
  const std::string page = output::document_html(document).page;
  const std::size_t answer = page.find("<div class=\"verdict"), picture = page.find("<figure"),
                    next = page.find("<h2>What to do next</h2>"), numbers = page.find("<h2>The numbers</h2>"),
                    table = page.find("<table"), experts = page.find("<h2>For experts</h2>"),
                    folded = page.find("<details", std::min(experts, page.size()));
  for (const std::size_t at : {answer, picture, next, numbers, table, experts, folded})
    ASSERT_NE(at, std::string::npos) << page.substr(0, 4000);
  EXPECT_LT(answer, picture);
  EXPECT_LT(picture, next);
  EXPECT_LT(next, numbers);
  EXPECT_LT(numbers, table) << "a table comes before the answer, the picture and what to do next";
  EXPECT_LT(table, experts);
  EXPECT_LT(experts, folded);
  EXPECT_LT(numbers, page.find("<details")) << "something is folded before the numbers";
}

TEST(Reports, OfADiagnosisAreReadFromTheTop) {
  const StepOfAnIndicator found;
  expect_read_from_the_top(diagnosis_document(found.findings("extended.yaml"), {}));
}

TEST(Reports, OfADiagnosisSayWhatCouldBeLearnedBesideIt) {
  const StepOfAnIndicator found;
  const studies::Remainder learned{
      .channels = {{.name = "nose", .unit = "um", .rmse_file = 4.5, .rmse_with_remainder = 1.25, .is_learned = true}},
      .why_not = ""},
      none{.channels = {}, .why_not = "The readings are too few."};
  const auto document = [&](const studies::Remainder& remainder) {
    DiagnosisFindings findings = found.findings("extended.yaml");
    findings.remainder = &remainder;
    return diagnosis_document(findings, {});
  };
  const auto gain = output::document_json(document(learned)).at("gain");
  ASSERT_EQ(gain.at("remainder").size(), 1u);
  EXPECT_EQ(gain.at("remainder")[0].at("rmse_with_remainder"), 1.25);
  EXPECT_EQ(gain.at("remainder")[0].at("learned"), "yes");
  EXPECT_THAT(output::document_html(document(none)).page,
              ::testing::HasSubstr("Nothing was learned beside extended.yaml: The readings are too few."));
}

TEST(Reports, OfACalibrationAreReadFromTheTop) {
  const StepOfAnIndicator found;
  expect_read_from_the_top(calibration_document(found.findings("calibrated.yaml"), {}));
}

TEST(Reports, OfAPlacementAreReadFromTheTop) {
  studies::Placement p;
  p.options.n = 1;
  p.spots = {{}};
  p.spots.front().region = "head";
  p.names = {"p1"};
  p.chosen = {.way = "chosen", .sets = {{0}}, .left = {{.observer_um = 2.0, .regression_um = 3.0}}};
  p.chosen_lost = p.chosen.left;
  p.objective_um = p.observer_um = p.regression_um = {2.0};
  p.drift_um = 20.0;
  p.channels = {"nose"};
  expect_read_from_the_top(document_of(p, {}, {"{name: p1, node: head}"}, {}));
}

TEST(Reports, OfStrategiesAreReadFromTheTop) {
  compensation::StrategyMatrix m;
  m.settings.strategies.target = "nose";
  m.settings.tolerance_um = 10.0;
  m.runs.push_back({.family = "measured", .season = "", .name = "tuesday", .run = {}});
  compensation::JudgedStrategy strategy;
  strategy.fitted.name = "ridge, all sensors";
  strategy.safety = compensation::Safety::kSafe;
  strategy.why = "it leaves at most 2.0 µm of the drift";
  compensation::Case c;
  c.before = {.rmse = 10.0, .peak_abs = 20.0, .mean = 5.0, .n = 10};
  c.after = {.rmse = 1.0, .peak_abs = 2.0, .mean = 0.1, .n = 10};
  strategy.cases = {c};
  m.strategies = {strategy};
  m.choice = {.name = strategy.fitted.name, .why = "the smallest error"};
  output::Document document{.title = "mill"};
  document.body.sections.push_back(strategy_section(m, {}, {}));
  expect_read_from_the_top(document);
  const std::string terminal = output::document_text(document);
  EXPECT_THAT(
      terminal,
      StartsWith(
          "mill\n  Safe to use on the machine: ridge, all sensors: In the judged runs it leaves at most 2.0 µm of nose"));
  EXPECT_THAT(terminal, HasSubstr("--model models/ridge_all_sensors.json"));
}

TEST(Reports, AnswerInWordsForSomebodyAtTheMachine) {
  const StepOfAnIndicator found;
  const output::Verdict answer = answer_of(found.d, compared_of(found.measured.runs));
  EXPECT_EQ(answer.title, "The cause is named");
  EXPECT_EQ(
      answer.text,
      "The movement of nose is not what the scenario says: step, in monday; shift 5 µm. This is very likely (97 %). On "
      "readings that were kept out of the fit the error of extended.yaml is 1.0 times their noise, that of the scenario as "
      "it is 5.0 times.");
  const std::vector<std::string> steps =
      next_steps(found.measured, found.d, compared_of(found.measured.runs), {"", "", "results/mill"});
  ASSERT_EQ(steps.size(), 2U);
  EXPECT_EQ(steps[0], "Look at the indicator of nose: its mount, what it touches, and its input at the logger.");
  EXPECT_THAT(steps[1], HasSubstr("`driftwright diagnose results/mill/extended.yaml --measured monday.csv`"));
  const std::string page = output::document_html(diagnosis_document(found.findings("extended.yaml"), {})).page;
  EXPECT_THAT(page, AllOf(HasSubstr("nose in monday: measured and simulated"), HasSubstr("simulated with the cause"),
                          HasSubstr("All that might be missing: 2 possibilities")));
}

// A statement is shown with the law of the cause that names it; another one with the share of its course.
TEST(Reports, GiveAStatementTheCourseOfTheCauseThatNamesIt) {
  StepOfAnIndicator found;
  for (diagnosis::Stated& s : found.d.statements.stated) {
    s.says.follows = "unknown";
    s.says.law = "any course";
    s.p_follows = 0.75;
  }
  const auto page = [&] { return output::document_html(diagnosis_document(found.findings("extended.yaml"), {})).page; };
  const char* unknown = "of a course that follows nothing recorded (75 %)";
  const std::string named = page();
  EXPECT_THAT(named, AllOf(HasSubstr("<td>displacement nose</td><td>step, in monday</td>"),
                           HasSubstr(std::string("<td>displacement table</td><td>") + unknown)));
  found.d.causes[0].standing = diagnosis::Standing::kSuspected;
  EXPECT_THAT(page(), HasSubstr(std::string("<td>displacement nose</td><td>") + unknown));
}

// Two causes in one channel: a step of 5 um, and 2 um that another one adds. Each picture shows the machine without its
// cause and with both, in the channel where that cause shows most.
TEST(Reports, ShowOfEachCauseWhatTheMachineWouldDoWithoutIt) {
  StepOfAnIndicator found;
  diagnosis::MeasuredRun& run = found.measured.runs[0];
  run.channels[0].value = Eigen::VectorXd::Constant(2, 7e-6);
  run.channels.push_back({"table", 1, "m", Eigen::VectorXd::Constant(2, 4e-6)});
  found.d.noise["table"] = {.white = 1e-6};
  found.d.as_written = {Eigen::MatrixXd::Zero(2, 2)};
  Eigen::MatrixXd all(2, 2), without_first(2, 2), without_second(2, 2);
  all << 7e-6, 7e-6, 4e-6, 4e-6;
  without_first << 2e-6, 2e-6, 4e-6, 4e-6;  // the step is in nose alone
  without_second << 5e-6, 5e-6, 0.0, 0.0;   // the other one adds 2 um to nose and 4 um to table
  found.d.search.fit.prediction = {all};
  found.d.without_cause = {{without_first}, {without_second}};
  diagnosis::Cause other{"expansion", "bed", "another expansion", {{"factor", "1", 1.5, 1.4, 1.6}}, 30.0, {}};
  other.own = "node at bed, line 7";
  found.d.causes.push_back(other);
  const output::Section section = causes_section(found.measured, found.d);
  ASSERT_EQ(section.sections.size(), 2U);
  const auto plot_of = [](const output::Section& cause) -> const output::Plot* {
    for (const output::Block& block : cause.blocks) {
      if (const auto* plot = std::get_if<output::Plot>(&block)) return plot;
    }
    return nullptr;
  };
  const output::Plot *first = plot_of(section.sections[0]), *second = plot_of(section.sections[1]);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->title, "Cause 1: nose in monday");
  EXPECT_EQ(second->title, "Cause 2: table in monday");
  ASSERT_EQ(first->series.size(), 3U);
  EXPECT_NEAR(first->series[0].y[0], 7.0, 1e-9);   // measured
  EXPECT_NEAR(first->series[1].y[0], 2.0, 1e-9);   // without it
  EXPECT_NEAR(first->series[2].y[0], 7.0, 1e-9);   // mended
  EXPECT_NEAR(second->series[1].y[0], 0.0, 1e-9);  // not the scenario as it is: the step stays
  EXPECT_NEAR(second->series[2].y[0], 4.0, 1e-9);
  found.d.causes.pop_back();
  found.d.without_cause.pop_back();
  EXPECT_FALSE(plot_of(causes_section(found.measured, found.d).sections[0]));  // the picture at the top is of this one
}

TEST(Reports, SayFirstThatFewChannelsWereCompared) {
  StepOfAnIndicator found;
  found.d.causes.clear();
  found.d.search.findings.clear();
  found.d.verdict = diagnosis::Verdict::kConsistent;
  for (const char* name : {"t1", "t2", "t3", "t4", "t5"})
    found.measured.runs[0].left_out.push_back({name, "the scenario has no such sensor"});
  const output::Verdict answer = answer_of(found.d, compared_of(found.measured.runs));
  EXPECT_EQ(answer.kind, output::Verdict::Kind::kNeutral);
  EXPECT_EQ(answer.title, "No difference found, but only 1 of 6 channels was compared");
  EXPECT_THAT(answer.text, StartsWith("1 of 6 channels of the records is compared"));
}

TEST(Reports, SayFirstWhatWasComparedAndWhatLooksWrong) {
  StepOfAnIndicator found;
  found.measured.blunders = {
      {.path = "monday.csv", .what = "nose_um looks like mm", .instead = "Call the column nose_mm", .nats = 50.0}};
  found.measured.renamings = {{.path = "monday.csv", .column = "T3_degC", .header = "t_housing_degC"}};
  const Compared compared = compared_of(found.measured.runs);
  const std::string first = said_first_text(found.measured, compared);
  EXPECT_THAT(first,
              StartsWith("monday.csv: nose_um looks like mm. Call the column nose_mm. T3_degC reads what the scenario "
                         "simulates for t_housing_degC: call"));
  found.d.verdict = diagnosis::Verdict::kConsistent;
  const output::Verdict answer = answer_of(found.d, compared, first);
  EXPECT_EQ(answer.kind, output::Verdict::Kind::kNeutral);
  EXPECT_THAT(answer.text, StartsWith(first));
  EXPECT_EQ(diagnosis_document(found.findings("extended.yaml"), {}).subtitle,
            "measured: monday.csv; its one channel is compared");
  EXPECT_EQ(compared_clause({.n = 1, .of = 3, .left_out = {{"t1", "no sensor"}, {"t2", "no sensor"}}}),
            "1 of 3 channels is compared; left out: t1, t2");
}

TEST(CauseWords, SayTimesAndSharesInTheSentence) {
  diagnosis::Diagnosis d;
  d.search.findings.resize(2);
  d.causes.resize(2);
  d.causes[0].effect = "sensor_detached";
  d.causes[0].where = "t_column";
  d.causes[0].law = "from a time on, in tuesday";
  d.causes[0].parameters = {{"share", "1", 0.844}, {"time", "min", 95.0}};
  d.causes[1].effect = "heat_window";
  d.causes[1].where = "drum";
  d.causes[1].law = "heat for a while";
  d.causes[1].parameters = {{"power", "W", 71.5}, {"begin", "min", 117.0}, {"length", "min", 65.0}};
  EXPECT_EQ(cause_sentence(d, 0),
            "The reading of thermometer t_column is wrong: sensor that comes off its body, from 95 min on, in tuesday; 84 % "
            "of air in the reading.");
  EXPECT_EQ(cause_sentence(d, 1), "The heat in drum is not what the scenario says: heat from 117 to 182 min; power 71.5 W.");
}

TEST(CauseWords, NameTheUsersOwnEffectAndItsLine) {
  diagnosis::Diagnosis d;
  d.search.findings.resize(1);
  d.causes.resize(1);
  d.causes[0].effect = "friction_law";
  d.causes[0].where = "head";
  d.causes[0].law = "another growth with speed";
  d.causes[0].own = "motor_loss at head, line 7";
  d.causes[0].parameters = {{"exponent", "1", 2.075}};
  EXPECT_EQ(
      cause_sentence(d, 0),
      "The heat in head is not what the scenario says (motor_loss at head, line 7): another growth with speed; exponent "
      "2.08.");
  output::Section section;
  add_causes_data(section, d.causes);
  const Json json = output::document_json({.body = section})["causes"][0];
  EXPECT_EQ(json["effect"], "friction_law");  // programs compare this key
  EXPECT_EQ(json["own"], "motor_loss at head, line 7");
}

TEST(CauseWords, NameWhatToLookAtForEachQuantity) {
  using enum diagnosis::StatedQuantity;
  EXPECT_THAT(look_text(kHeat, "spindle"), AllOf(HasSubstr("spindle"), HasSubstr("lubrication")));
  EXPECT_THAT(look_text(kExchange, "column,ambient"), AllOf(HasSubstr("column and ambient"), HasSubstr("door")));
  EXPECT_THAT(look_text(kReading, "t1"), HasSubstr("thermometer t1"));
  EXPECT_THAT(look_text(kClock, "clock"), HasSubstr("logger"));
  EXPECT_EQ(look_text({}, "a,b,c,d,e"), "Look at a, b, c and 2 others.");
  EXPECT_EQ(sure_text(0.999), "almost certain (more than 99 %)");
  EXPECT_EQ(sure_text(0.92), "very likely (92 %)");
  EXPECT_EQ(sure_text(0.002), "unlikely (less than 1 %)");
}

}  // namespace
}  // namespace driftwright::findings::diagnosis_data_test
