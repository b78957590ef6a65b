// What `diagnose` and `calibrate` compute from records of two lumped bodies.

#include "studies/measured_diagnosis.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "base/errors.hpp"
#include "studies/prediction.hpp"
#include "tests/shared/lumped_records.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::studies::measured_diagnosis_test {
namespace {

using ::testing::AllOf, ::testing::HasSubstr, ::testing::Not;

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
  return text;
}

/// Records of the two bodies with 7 W/K from the head to the ambient in place of 4 W/K.
std::vector<std::string> records() {
  static const std::vector<std::string> paths = diagnosis::noisy_records(
      write_file("truth.yaml", replaced(diagnosis::kTwoNodes, "conductance: 4 W/K", "conductance: 7 W/K")), "measured_",
      {.row_s = 120.0, .noise_K = 0.05});
  return paths;
}

MeasuredTwin twin_of(const std::string& scenario) {
  return open_measured_twin(scenarios::read_scenario(write_file("plain.yaml", scenario)), "calibrate", records(), {});
}

TEST(Calibrate, PredictsByTheScenarioThatItWritesAlsoInWordsOfAnEarlierRelease) {
  const std::string former = replaced(replaced(diagnosis::kTwoNodes, "ambient: [[", "hall: [["), "to: ambient", "to: hall");
  for (const std::string& text : {std::string(diagnosis::kTwoNodes), former}) {
    const MeasuredTwin m = twin_of(text);
    const auto [found, written] = calibrate(m, "calibrated.yaml", {});
    ASSERT_TRUE(written.is_readable()) << written.extended.not_written.front();
    EXPECT_THAT(written.difference, HasSubstr("calibrated.yaml"));
    EXPECT_THAT(written.extended.text, HasSubstr(text == former ? "to: hall" : "to: ambient"));
    ASSERT_EQ(found.gain.size(), 3U);
    for (const diagnosis::ChannelGain& g : found.gain) EXPECT_LT(g.rmse_written, 0.5 * g.rmse_all_before) << g.name;
    const scenarios::Scenario again = scenarios::read_scenario(write_file("calibrated.yaml", written.extended.text));
    const diagnosis::Prediction by_file = read_of(m, again.machine->effects);
    ASSERT_EQ(by_file.size(), found.extended.size());
    for (std::size_t r = 0; r < by_file.size(); ++r) EXPECT_EQ(by_file[r], found.extended[r]);
  }
}

int n_of(const std::string& text, const std::string& what) {
  int n = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

/// Half of the band at the end of the nose's course.
double half_band_um(const scenarios::Scenario& s) {
  const Prediction p = predict_drift(s, s.cyclogram("monday"), {.with_band = true}, {}, "test");
  return p.band ? 0.5 * (p.band->high("nose")->values.back() - p.band->low("nose")->values.back()) : 0.0;
}

TEST(Calibrate, WritesWhatItsFitLeavesOpenOfAllNumbersTogether) {
  const MeasuredTwin m = twin_of(diagnosis::kTwoNodes);
  const auto [found, written] = calibrate(m, "calibrated.yaml", {});
  ASSERT_TRUE(found.written.keeps_numbers) << found.written.why_nothing;
  EXPECT_EQ(n_of(written.extended.text, "known_together:"), 1);
  EXPECT_THAT(written.extended.text, Not(HasSubstr("written anew")));
  scenarios::Scenario again = scenarios::read_scenario(write_file("calibrated.yaml", written.extended.text));
  const scenarios::KnownTogether& known = again.machine->known_together;
  const Eigen::MatrixXd covariance = known.factor * known.factor.transpose();
  std::vector<Eigen::Index> own;
  for (std::size_t i = 0; i < found.scatter.size(); ++i) {
    if (found.scatter[i].effect != "ambient") own.push_back(static_cast<Eigen::Index>(i));
  }
  ASSERT_EQ(covariance.rows(), static_cast<Eigen::Index>(own.size()));
  for (Eigen::Index i = 0; i < covariance.rows(); ++i) {
    const double sd = std::sqrt(covariance(i, i));
    for (Eigen::Index j = 0; j < covariance.rows(); ++j)
      EXPECT_NEAR(covariance(i, j), found.search.fit.covariance(own[i], own[j]), 2e-3 * sd * std::sqrt(covariance(j, j)));
  }
  const double together_um = half_band_um(again);
  again.machine->known_together.factor = covariance.diagonal().cwiseSqrt().asDiagonal().toDenseMatrix();
  EXPECT_GT(together_um, 0.0) << "the values beside the factor are those of the file";
  EXPECT_LT(together_um, 0.3 * half_band_um(again));  // each number by itself
}

// After the mark that ends a document, a further key would be in another one, which no reader takes.
TEST(Calibrate, SaysWhatIsKnownTogetherAlsoWhereTheFileEndsByAMark) {
  const scenarios::KnownTogether known{
      .numbers = {"heat_source head power"}, .values = {100.0}, .factor = Eigen::MatrixXd::Constant(1, 1, 0.1)};
  const MeasuredTwin m = twin_of(std::string(diagnosis::kTwoNodes) + "...\n");
  const std::string text = diagnosis::extended_scenario(m.scenario, *m.twin, m.runs, {}, {}, {}, known).text;
  EXPECT_EQ(scenarios::read_scenario(write_file("ended.yaml", text)).machine->known_together.numbers, known.numbers);
}

// The block is no prior, so the same records do not count twice; a second fit replaces it.
TEST(Calibrate, TakesNoPriorFromWhatAnEarlierFitLeftOpen) {
  const auto [found, written] = calibrate(twin_of(diagnosis::kTwoNodes), "calibrated.yaml", {});
  const MeasuredTwin second = open_measured_twin(
      scenarios::read_scenario(write_file("calibrated.yaml", written.extended.text)), "calibrate", records(), {});
  const MeasuredDiagnosis twice = calibrate(second, "twice.yaml", {});
  ASSERT_EQ(twice.found.scatter.size(), found.scatter.size());
  for (std::size_t i = 0; i < found.scatter.size(); ++i)
    EXPECT_EQ(twice.found.scatter[i].prior_sd, found.scatter[i].prior_sd);
  if (twice.found.written.keeps_numbers) {
    EXPECT_EQ(n_of(twice.written.extended.text, "known_together:"), 1);
  }
}

/// Everything in one folder: the scenario with a former word and a plan in a file, a record with another name, results.
TEST(Diagnose, WritesAFileThatIsReadWhereverItsFolderIsMovedTo) {
  namespace fs = std::filesystem;
  const fs::path project = fresh_folder("project"), elsewhere = temporary_folder() / "elsewhere";
  fs::create_directories(project / "plans");
  write_file("project/plans/friday.csv", "time_s,speed_rpm\n0,900\n2400,0\n6000,1600\n10800,1600\n");
  std::string text = replaced(replaced(diagnosis::kTwoNodes, "ambient: [[", "hall: [["), "to: ambient", "to: hall");
  text = replaced(text, "[[40 min, 900 rpm], [60 min, 0 rpm], [80 min, 1600 rpm]]", "{csv: plans/friday.csv}");
  const std::string scenario = write_file("project/mill.yaml", text);
  fs::copy_file(records().front(), project / "sunday.csv");  // 7 W/K for 4, in a record that is no cyclogram of the scenario
  const MeasuredTwin m = open_measured_twin(scenarios::read_scenario(scenario), "diagnose",
                                            std::vector<std::string>{(project / "sunday.csv").string()}, {});
  const auto [found, written] = diagnose(m, {.file = project / "results/new/extended.yaml"}, {});  // no such folder yet
  ASSERT_TRUE(written.is_readable()) << written.extended.not_written.front();
  EXPECT_THAT(written.extended.text, AllOf(HasSubstr("# mill.yaml with what"), HasSubstr("measured: sunday.csv"),
                                           HasSubstr("friday: {csv: \"../../plans/friday.csv\"}"), HasSubstr("hall: [[")));
  EXPECT_THAT(written.extended.text, Not(HasSubstr(temporary_folder().string())));
  EXPECT_THAT(written.difference, AllOf(HasSubstr("--- mill.yaml"), Not(HasSubstr(temporary_folder().string()))));
  fs::create_directories(project / "results/new");
  write_file("project/results/new/extended.yaml", written.extended.text);
  fs::rename(project, elsewhere);
  const scenarios::Scenario again = scenarios::read_scenario((elsewhere / "results/new/extended.yaml").string());
  EXPECT_EQ(again.cyclogram("friday").duration_s(), 10800.0);
  const diagnosis::Prediction by_file = read_of(m, again.machine->effects);
  EXPECT_EQ(by_file.front(), found.extended.front());
  // Few digits cost nothing: the file predicts the rows of the fit as well as the fit does, to a hundredth of the noise.
  for (const diagnosis::ChannelGain& g : found.gain) EXPECT_LT(g.rmse_written, 1.01 * g.noise_floor + 0.01) << g.name;
}

TEST(Diagnose, RefusesToLeaveOutAKeyThatNoCandidateHas) {
  const MeasuredTwin m = twin_of(diagnosis::kTwoNodes);
  EXPECT_REFUSED(diagnose(m, {.without = {"heat_sorce"}}, {}), "heat_sorce", "heat_source");
}

}  // namespace
}  // namespace driftwright::studies::measured_diagnosis_test
