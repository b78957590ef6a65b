// A stream as it is followed: the numbers that were judged, whatever happens to rows, and a restart that changes nothing.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/errors.hpp"
#include "base/file_bytes.hpp"
#include "base/random.hpp"
#include "compensation/predictors/formula_predictor.hpp"
#include "follow/axis_probing.hpp"
#include "follow/followed_predictor.hpp"
#include "follow/session.hpp"
#include "follow/state_file.hpp"
#include "output/predictor_file.hpp"
#include "tests/shared/deployed_model.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::follow::follow_session_test {
namespace {

using namespace compensation;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

output::PredictorFile formula(bool from_start) {
  output::DeployedModel model = fixtures::deployed(from_start, 60.0);
  output::PredictorFile file;
  DeployedPredictor& d = file.predictor;
  d.name = "regression with lags";
  d.target = "drift_y";
  d.from_start = from_start;
  d.sensors = {"X1", "X2", "X3", "X4"};
  d.fail_safe = std::move(model.safe);
  d.predictor = std::make_shared<FormulaPredictor>(std::move(model.model));
  d.interval_um = model.interval_um;
  file.judged = {{"verdict", "safe within limits"}};
  return file;
}

std::string path_of(const output::PredictorFile& file, const std::string& name = "model.json") {
  return driftwright::write_file(name, output::predictor_json(file, {"1", "a test"}).dump());
}

Session session_of(const std::string& path) {
  std::vector<Session::Model> models;
  models.push_back({path, content_hash(read_bytes(path)), followed_predictor(path, {})});
  return Session(std::move(models));
}

StreamRow row_of(const Record& r, std::size_t i) {
  StreamRow row{.time_s = r.time_s[i], .values = {}};
  for (const Channel& c : r.channels) row.values.push_back(c.values[i]);
  return row;
}

TEST(FollowSession, GivesTheCorrectionThatWasJudged) {
  const Record r = fixtures::machine(7, 60.0);
  const output::PredictorFile file = formula(true);
  const GuardedCorrection judged = correct(file.predictor, {.cyclogram = {}, .ambient = {}, .readings = r});
  Session session = session_of(path_of(file));
  session.begin(r.channels);
  for (std::size_t i = 0; i < r.n_samples(); ++i) {
    const FollowLine line = session.take(row_of(r, i));
    ASSERT_EQ(line.axes.size(), 1u);
    EXPECT_EQ(line.axes[0].predicted_um, judged.correction_um[i]);
    if (i > 5) {  // once the axis is there
      EXPECT_NEAR(line.axes[0].correction_um, judged.correction_um[i], 1e-9) << i;
    }
    EXPECT_EQ(line.axes[0].trust, judged.trust[i]);
    EXPECT_EQ(line.run_s, r.time_s[i] - r.time_s[0]);
    EXPECT_EQ(line.axes[0].verdict, "safe within limits");
  }
}

TEST(FollowSession, DoesNotFollowWhatValidateCallsUnsafe) {
  output::PredictorFile file = formula(true);
  file.judged = {{"verdict", "unsafe"}, {"why", "a sensor that drifts leaves 40 um"}};
  const std::string path = path_of(file, "unsafe.json");
  EXPECT_REFUSED(followed_predictor(path, {}), path, "a sensor that drifts leaves 40 um", "--despite-verdict");
  EXPECT_NO_THROW((void)followed_predictor(path, {.despite_verdict = true}));
}

TEST(FollowSession, ARestartChangesNothing) {
  const Record r = fixtures::machine(7, 60.0);
  const std::string path = path_of(formula(true));
  const std::filesystem::path state = temporary_folder() / "axis.state";
  Session whole = session_of(path), first = session_of(path);
  whole.begin(r.channels);
  first.begin(r.channels);
  for (std::size_t i = 0; i < 140; ++i) EXPECT_EQ(line_text(whole.take(row_of(r, i))), line_text(first.take(row_of(r, i))));
  write_state(state, first);
  Session second = session_of(path);
  second.begin(r.channels);
  EXPECT_TRUE(resume_from(state, second));
  for (std::size_t i = 140; i < r.n_samples(); ++i)
    EXPECT_EQ(line_text(whole.take(row_of(r, i))), line_text(second.take(row_of(r, i)))) << i;
  EXPECT_FALSE(resume_from(temporary_folder() / "none.state", second));
}

// Lags that start at standstill are wrong on a machine that has just worked. A restart does not forget it.
TEST(FollowSession, AWarmStartIsOffAndSaidUntilItIsForgotten) {
  const Record r = fixtures::warm_machine(7, 60.0);
  for (const bool from_start : {true, false}) {
    const std::string path = path_of(formula(from_start));
    Session session = session_of(path);
    session.begin(r.channels);
    FollowLine line = session.take(row_of(r, 0));
    EXPECT_EQ(line.state, "off");
    EXPECT_THAT(line.why, HasSubstr(kStrangeStart));
    EXPECT_EQ(line.axes[0].trust, 0.0);
    const std::filesystem::path state = temporary_folder() / "axis.state";
    write_state(state, session);
    Session again = session_of(path);
    again.begin(r.channels);
    EXPECT_TRUE(resume_from(state, again));
    for (std::size_t i = 1; i < r.n_samples(); ++i) line = again.take(row_of(r, i));
    if (from_start) {
      EXPECT_EQ(line.axes[0].trust, 0.0);
      EXPECT_THAT(line.why, HasSubstr(kStrangeStart));
    } else {
      EXPECT_GT(line.axes[0].trust, 0.99);  // 300 rows; the longest lag has 31
      EXPECT_THAT(line.why, Not(HasSubstr(kStrangeStart)));
    }
  }
}

TEST(FollowSession, AStateOfAnotherModelOrADamagedOneIsRefused) {
  const Record r = fixtures::machine(7, 60.0);
  const std::string path = path_of(formula(true));
  const std::filesystem::path state = temporary_folder() / "axis.state";
  Session session = session_of(path);
  session.begin(r.channels);
  (void)session.take(row_of(r, 0));
  write_state(state, session);
  output::PredictorFile changed = formula(true);
  changed.predictor.reason = "another fit";
  Session other = session_of(path_of(changed, "other.json"));
  other.begin(r.channels);
  EXPECT_REFUSED(resume_from(state, other), "is not the file");
  Session narrow = session_of(path);
  narrow.begin({r.channels.begin(), r.channels.end()});
  std::string text = read_bytes(state);
  text.replace(text.find("\"run_s\""), 7, "\"run_t\"");
  driftwright::write_file("axis.state", text);
  EXPECT_REFUSED(resume_from(state, narrow), "axis.state", "damaged");
}

TEST(FollowSession, SaysThatItIsHeldOrOffAndWhy) {
  const Record r = fixtures::machine(7, 60.0);
  Session session = session_of(path_of(formula(false)));
  session.begin(r.channels);
  FollowLine line;
  for (std::size_t i = 0; i < 100; ++i) line = session.take(row_of(r, i));
  EXPECT_EQ(line.state, "on");
  const double before_um = line.axes[0].correction_um;
  line = session.take(row_of(r, 99));
  EXPECT_EQ(line.state, "held");
  EXPECT_THAT(line.faults, ElementsAre("doubled"));
  EXPECT_EQ(line.axes[0].correction_um, before_um);
  line = session.pass_over("no row at all");
  EXPECT_EQ(line.state, "held");
  EXPECT_EQ(line.why, "no row at all");
  EXPECT_EQ(line.axes[0].correction_um, before_um);
  line = session.wait(1200.0);
  EXPECT_EQ(line.state, "reduced");
  EXPECT_THAT(line.why, HasSubstr("no row for 1200 s"));
  EXPECT_LT(std::abs(line.axes[0].correction_um), std::abs(before_um));
  line = session.wait(10800.0);
  EXPECT_EQ(line.state, "off");
}

TEST(FollowSession, AStreamThatLacksWhatTheModelReadsIsRefused) {
  Record r = fixtures::machine(7, 60.0);
  Session session = session_of(path_of(formula(false)));
  std::vector<Channel> channels = r.channels;
  channels[1].unit = "K";
  EXPECT_REFUSED(session.begin(channels), "which the stream has in K");
  channels.erase(channels.begin() + 1);
  EXPECT_REFUSED(session.begin(channels), "which the stream does not have");
  std::vector<Session::Model> twice;
  const std::string path = path_of(formula(false));
  for (int k = 0; k < 2; ++k) twice.push_back({path, "", followed_predictor(path, {})});
  EXPECT_REFUSED(Session(std::move(twice)), "corrected by another model");
}

// Rows late, doubled, swapped, missing, with holes and impossible values, clocks that are set, for some thousand rows: no
// correction is other than a number within the clamp, and none moves faster than the slew limit.
TEST(FollowSession, NoCorrectionStepsWhateverTheRowsAre) {
  const output::PredictorFile file = formula(false);
  const FailSafe& safe = *file.predictor.fail_safe;
  const std::string path = path_of(file);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(seed, 23);
    const Record r = fixtures::machine(seed, 60.0);
    Session session = session_of(path);
    session.begin(r.channels);
    double clock_s = 1e6 * random.uniform(), last_um = 0.0, run_s = 0.0;
    std::vector<StreamRow> late;
    for (std::size_t i = 0; i < r.n_samples(); ++i) {
      StreamRow row = row_of(r, i);
      row.time_s += clock_s;
      if (random.chance(0.1))
        row.values[static_cast<std::size_t>(random.below(5))] = random.chance(0.5) ? NAN : 1e9 * random.normal();
      if (random.chance(0.01)) clock_s += 1e5 * random.normal();
      if (random.chance(0.05)) continue;
      std::vector<StreamRow> now = {row};
      if (random.chance(0.05)) now.push_back(row);
      if (random.chance(0.05)) {
        late.push_back(row);
        now.clear();
      } else if (!late.empty() && random.chance(0.5)) {
        now.push_back(late.back());
        late.pop_back();
      }
      for (StreamRow& one : now) {
        const FollowLine line = random.chance(0.02) ? session.pass_over("noise") : session.take(std::move(one));
        const double um = line.axes[0].correction_um, step_s = line.run_s ? *line.run_s - run_s : 0.0;
        run_s = line.run_s.value_or(run_s);
        ASSERT_TRUE(std::isfinite(um));
        ASSERT_GE(um, safe.lowest_um - 1e-9);
        ASSERT_LE(um, safe.highest_um + 1e-9);
        ASSERT_LE(std::abs(um - last_um), safe.most_rate_um_s * std::max(step_s, 0.0) + 1e-9) << seed << " " << i;
        last_um = um;
      }
    }
    EXPECT_GT(session.faults()[static_cast<std::size_t>(Fault::kDoubled)], 0);
  }
}

/// 2 um/K (T - 20): 10 um at 25 degC. The drift does not count from the start.
output::PredictorFile two_um_per_K() {
  output::PredictorFile file;
  DeployedPredictor& d = file.predictor;
  d.name = "by hand";
  d.target = "drift_y";
  d.sensors = {"T"};
  d.predictor =
      std::make_shared<FormulaPredictor>(DriftModel{.kind = "by hand",
                                                    .target = "drift_y",
                                                    .target_unit = "um",
                                                    .intercept = -40.0,
                                                    .terms = {{.input = "T", .unit = "degC", .coefficient = 2.0}}});
  FailSafe safe;
  safe.guards = {{.input = "T", .unit = "degC", .low = 0, .high = 100, .most_jump = 1e9, .others_coefficient = {}}};
  safe.lowest_um = -100;
  safe.highest_um = 100;
  safe.most_rate_um_s = 2.0;
  safe.period_s = 60.0;
  safe.stale_s = 300.0;
  safe.fade_s = 600.0;
  d.fail_safe = safe;
  d.interval_um = 12.0;
  d.residual = ResidualProcess{5.0, 7200.0, 0.1};
  d.probe = {0.5, 0.0};
  file.judged = {{"verdict", "safe within limits"}};
  return file;
}

Session probed_session(const FollowOptions& options = {}, const std::string& column = "probe_drift_y",
                       const output::PredictorFile& file = two_um_per_K()) {
  const std::string path = path_of(file, "probed.json");
  std::vector<Session::Model> models;
  models.push_back({path, content_hash(read_bytes(path)), followed_predictor(path, options)});
  Session session(std::move(models));
  session.begin({{"T", "degC", {}}, {column, "um", {}}});
  return session;
}

/// A row each minute at 25 degC.
FollowLine minute(Session& session, int k, double probed_um = NAN) {
  return session.take({.time_s = 60.0 * k, .values = {25.0, probed_um}});
}

/// The filter of the file of two_um_per_K(), in the row before which it has passed n minutes with a prediction of 10 um.
ProbeFeedback after_minutes(int n) {
  ProbeFeedback feedback({5.0, 7200.0}, {.noise_um = 0.5}, false);
  for (int k = 0; k <= n; ++k) feedback.row(10.0, 0.0, k > 0 ? 60.0 : 0.0);
  return feedback;
}

// The model is 9 um off, which stays. One probing with 0.3 um of its noise leaves less than that noise; then what it found
// fades as the filter has it, and the interval widens from 1.96 noises or so to that of `validate` and beyond, because the
// probing says that errors are larger than in the fit.
TEST(FollowProbing, AConstantOffsetIsTakenUpAndFades) {
  Session session = probed_session();
  FollowLine line;
  for (int k = 0; k < 30; ++k) line = minute(session, k);
  EXPECT_NEAR(line.axes[0].correction_um, 10.0, 1e-9);
  ASSERT_TRUE(line.axes[0].probing);
  EXPECT_FALSE(line.axes[0].probing->answer);
  EXPECT_NEAR(*line.axes[0].interval_um, 12.0, 1e-9);
  line = minute(session, 30, 19.3);
  ProbeFeedback feedback = after_minutes(30);
  const double bound_um = 4.0 * std::hypot(feedback.deviation_um(), 0.5);
  EXPECT_TRUE(feedback.probe_drift_um(19.3));
  ASSERT_TRUE(line.axes[0].probing->answer);
  EXPECT_TRUE(line.axes[0].probing->answer->is_taken);
  EXPECT_NEAR(line.axes[0].probing->answer->off_um, 9.3, 1e-9);
  EXPECT_NEAR(line.axes[0].probing->answer->bound_um, bound_um, 1e-9);
  EXPECT_LT(std::abs(19.0 - line.axes[0].correction_um), 0.5);
  EXPECT_EQ(line.axes[0].predicted_um, 10.0);
  EXPECT_THAT(line_text(line), AllOf(HasSubstr("probing taken: it is 9.3 um from what is expected (4 sigmas are 55.2 um)"),
                                     HasSubstr(R"("interval_95_um_in":{"15 min":)")));
  EXPECT_NEAR(line.axes[0].probing->answer->intervals_um[1].second, 12.0 / 5.0 * feedback.deviation_um(3600.0), 1e-9);
  for (int k = 0; k < 600; ++k) {
    if (k > 0) {
      line = minute(session, 30 + k);
      feedback.row(10.0, 0.0, 60.0);
    }
    ASSERT_NEAR(line.axes[0].correction_um, 10.0 + feedback.estimate_um(), 1e-9) << k;
    ASSERT_NEAR(*line.axes[0].interval_um, 12.0 / 5.0 * feedback.deviation_um(), 1e-9) << k;
    EXPECT_EQ(line.axes[0].probing->answer.has_value(), k == 0);
  }
  EXPECT_LT(line.axes[0].correction_um, 15.0);
  EXPECT_GT(*line.axes[0].interval_um, 12.0);
}

// What a probe reads on the corrected axis is the drift minus the correction that was in force, also with a lag and while
// the axis is on its way.
TEST(FollowProbing, WhatIsLeftOnTheCorrectedAxisIsTheSameNews) {
  for (const double lag_s : {0.0, 90.0}) {
    const FollowOptions options{.most_rate_um_s = 0.05, .probe_lag_s = lag_s};
    Session by_drift = probed_session(options), by_left = probed_session(options, "probe_left_drift_y");
    std::vector<double> in_force_um = {0.0};  // after each minute
    for (int k = 0; k < 200; ++k) {
      const bool is_probed = k == 3 || k == 40 || k == 41;
      // touched one and a half minutes ago, between the answers to the rows k - 2 and k - 1
      const double at_touch_um = in_force_um[in_force_um.size() - (lag_s == 0.0 || k < 2 ? 1 : 2)];
      const FollowLine a = minute(by_drift, k, is_probed ? 14.0 : NAN);
      const FollowLine b = minute(by_left, k, is_probed ? 14.0 - at_touch_um : NAN);
      ASSERT_NEAR(a.axes[0].correction_um, b.axes[0].correction_um, 1e-9) << k << " " << lag_s;
      in_force_um.push_back(a.axes[0].correction_um);
    }
  }
}

TEST(FollowProbing, AChipIsRefusedAndAConfirmedJumpTaken) {
  Session session = probed_session(), untouched = probed_session();
  FollowLine line;
  const auto both = [&](int k, double um) {
    line = minute(session, k, um);
    return std::abs(line.axes[0].correction_um - minute(untouched, k).axes[0].correction_um);
  };
  for (int k = 0; k < 30; ++k) (void)both(k, NAN);
  EXPECT_EQ(both(30, 90.0), 0.0);
  EXPECT_FALSE(line.axes[0].probing->answer->is_taken);
  EXPECT_THAT(
      line_text(line),
      AllOf(HasSubstr("probing refused: it is 80.0 um from what is expected (4 sigmas are 55.2 um); measured another tool, "
                      "chips, or the machine was touched? Probe again"),
            HasSubstr(R"("refused":1,"is_taken":false)")));
  EXPECT_EQ(both(31, -80.0), 0.0);  // another chip
  EXPECT_LT(both(32, 10.5), 0.6);   // as expected
  EXPECT_TRUE(line.axes[0].probing->answer->is_taken);
  (void)both(33, 90.0);
  EXPECT_FALSE(line.axes[0].probing->answer->is_taken);
  (void)both(34, 91.0);
  EXPECT_TRUE(line.axes[0].probing->answer->is_taken);
  EXPECT_THAT(line.axes[0].probing->answer->words, HasSubstr("taken as a jump of the axis"));
  EXPECT_NEAR(line.axes[0].correction_um, 90.5, 0.5);
  for (int k = 35; k < 635; ++k) line = minute(session, k);
  EXPECT_NEAR(line.axes[0].correction_um, 90.5, 1.0);  // 5 time constants later; an axis that was knocked stays there
  EXPECT_EQ(line.axes[0].probing->n_refused, 3);
}

// The probe goes on reading 4 um on the corrected axis, though the correction has taken up as much each time. Steps are 0.5
// um, so some 4 um off a repetition has a chance of 0.5 * 0.242 / 4, 1 in 33: four of them are too many.
TEST(FollowProbing, AStuckProbeIsRefusedAndSaid) {
  Session session = probed_session({}, "probe_left_drift_y");
  FollowLine line;
  int k = 0;
  for (const double um : {0.5, 1.0, 4.0, 4.0, 4.0, 4.0, 4.0, 4.0}) {
    for (int wait = 0; wait < 60; ++wait) line = minute(session, k++);
    line = minute(session, k++, um);
  }
  EXPECT_FALSE(line.axes[0].probing->answer->is_taken);
  EXPECT_THAT(line.axes[0].probing->answer->words, HasSubstr("it is the same number as in the probings before"));
}

TEST(FollowProbing, AsksForAProbingWhereTheIntervalPassesHalfOfTheTolerance) {
  Session session = probed_session({.tolerance_um = 10.0});
  EXPECT_THAT(line_text(minute(session, 0)),
              HasSubstr("probe now: the interval of 12.0 um passes half of the tolerance of 10 um"));
  FollowLine line = minute(session, 1, 12.0);
  int n_minutes = 0;
  for (; line.axes[0].probing->probe_now.empty() && n_minutes < 1000; ++n_minutes) line = minute(session, 2 + n_minutes);
  ProbeFeedback feedback = after_minutes(1);
  EXPECT_TRUE(feedback.probe_drift_um(12.0));
  int expected = 0;
  for (; 12.0 / 5.0 * feedback.deviation_um() <= 5.0; ++expected) feedback.row(10.0, 0.0, 60.0);
  EXPECT_EQ(n_minutes, expected);
  EXPECT_GT(n_minutes, 2);
}

TEST(FollowProbing, ARestartChangesNothing) {
  const std::filesystem::path state = temporary_folder() / "probed.state";
  Session whole = probed_session({.probe_lag_s = 100.0}), first = probed_session({.probe_lag_s = 100.0});
  const auto probed_um = [](int k) { return k == 20 ? 13.0 : k == 59 || k == 60 ? 95.0 : NAN; };
  for (int k = 0; k < 60; ++k)
    EXPECT_EQ(line_text(minute(whole, k, probed_um(k))), line_text(minute(first, k, probed_um(k))));
  write_state(state, first);  // between two probings that agree
  Session second = probed_session({.probe_lag_s = 100.0});
  EXPECT_TRUE(resume_from(state, second));
  for (int k = 60; k < 100; ++k)
    EXPECT_EQ(line_text(minute(whole, k, probed_um(k))), line_text(minute(second, k, probed_um(k)))) << k;
}

TEST(FollowProbing, AStateOfAnotherVersionIsRefused) {
  Session session = probed_session();
  (void)minute(session, 0);
  nlohmann::ordered_json state = session.state();
  EXPECT_NO_THROW(session.recall(state));
  std::string text = state.dump();
  const std::size_t at = text.find("\"probing\":[");
  ASSERT_NE(at, std::string::npos);
  text.insert(at + 11, "0,");
  EXPECT_THAT([&] { session.recall(nlohmann::ordered_json::parse(text)); },
              ThrowsMessage<InputError>(HasSubstr("another version")));
}

/// A blend of two members, 10 um to either side of it.
output::PredictorFile blend_of_two() {
  output::PredictorFile file = two_um_per_K();
  DeployedPredictor& d = file.predictor;
  const DriftModel mean = *d.predictor->formula();
  std::vector<DriftModel> members = {mean, mean};
  members[0].intercept += 10.0;
  members[1].intercept -= 10.0;
  d.predictor = std::make_shared<FormulaPredictor>(mean, members);
  d.name = "blend";
  d.member_residuals = {{"high", {4.0, 3600.0, 0.1}}, {"low", {4.0, 3600.0, 0.1}}};
  return file;
}

// At 25 degC the blend says 10 um, its members 20 and 0 um. A probing of 20 um: the correction is that of the filters of the
// program, the line says the weights, and a restart changes nothing.
TEST(FollowProbing, MovesTheWeightsOfABlend) {
  const std::filesystem::path state = temporary_folder() / "blend.state";
  Session session = probed_session({}, "probe_drift_y", blend_of_two());
  ProbeFeedback feedback(
      std::vector<probe_process>{{5.0, 7200.0, 0.5, 0.0, 0}, {4.0, 3600.0, 0.5, 0.0, 0}, {4.0, 3600.0, 0.5, 0.0, 0}});
  FollowLine line;
  const auto probed_um = [](int k) { return k == 30 || k == 90 ? 20.0 : NAN; };
  for (int k = 0; k < 60; ++k) {
    line = minute(session, k, probed_um(k));
    feedback.row(std::vector<double>{10.0, 20.0, 0.0}, 0.0, 60.0);
    if (std::isfinite(probed_um(k))) (void)feedback.probe_drift_um(probed_um(k));
    ASSERT_NEAR(line.axes[0].predicted_um, 10.0, 1e-9);
    ASSERT_NEAR(line.axes[0].probing->residual_um, feedback.estimate_um(), 1e-9) << k;
    ASSERT_NEAR(line.axes[0].probing->deviation_um, feedback.deviation_um(), 1e-9) << k;
    ASSERT_EQ(line.axes[0].probing->weights.size(), 3u);
    for (std::size_t m = 0; m < 3; ++m)
      ASSERT_NEAR(line.axes[0].probing->weights[m].second, feedback.members()[m].weight, 1e-9) << k << " " << m;
    if (k == 29) {
      EXPECT_NEAR(line.axes[0].correction_um, 10.0, 1e-9);
    }
  }
  EXPECT_EQ(line.axes[0].probing->weights[1].first, "high");
  EXPECT_GT(line.axes[0].probing->weights[1].second, 0.7);
  EXPECT_LT(std::abs(line.axes[0].correction_um - 20.0), 2.0);
  EXPECT_THAT(line_text(line), HasSubstr(R"("weights":{"blend":0.)"));
  write_state(state, session);
  Session second = probed_session({}, "probe_drift_y", blend_of_two());
  EXPECT_TRUE(resume_from(state, second));
  for (int k = 60; k < 120; ++k)
    EXPECT_EQ(line_text(minute(session, k, probed_um(k))), line_text(minute(second, k, probed_um(k)))) << k;
}

TEST(FollowProbing, AProbingInARowThatIsPassedOverIsSaid) {
  Session session = probed_session();
  for (int k = 0; k < 10; ++k) (void)minute(session, k);
  const FollowLine line = minute(session, 8, 12.0);
  EXPECT_EQ(line.state, "held");
  EXPECT_EQ(line.why, "the row is passed over: late; its probing was not used, probe again");
  EXPECT_EQ(line.axes[0].probing->residual_um, 0.0);
}

TEST(FollowProbing, WhatCannotBeTakenIsRefused) {
  const auto begun = [](std::vector<Channel> channels, const output::PredictorFile& file) {
    channels.insert(channels.begin(), {"T", "degC", {}});
    const std::string path = path_of(file, "probed.json");
    std::vector<Session::Model> models;
    models.push_back({path, "", followed_predictor(path, {})});
    Session session(std::move(models));
    session.begin(channels);
  };
  EXPECT_REFUSED(begun({{"probe_drift_z", "um", {}}}, two_um_per_K()), "'probe_drift_z_um'", "Corrected here: drift_y");
  EXPECT_REFUSED(begun({{"probe_drift_y", "um", {}}, {"probe_left_drift_y", "um", {}}}, two_um_per_K()),
                 "only one of them is allowed");
  output::PredictorFile file = two_um_per_K();
  file.predictor.residual.reset();
  EXPECT_REFUSED(begun({{"probe_drift_y", "um", {}}}, file), "'probe_drift_y_um'", "key `probing`");
  EXPECT_NO_THROW(begun({{"probe_1", "degC", {}}}, file));  // a thermometer
}

}  // namespace
}  // namespace driftwright::follow::follow_session_test
