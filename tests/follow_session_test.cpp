// A stream as it is followed: the numbers that were judged, whatever happens to rows, and a restart that changes nothing.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/errors.hpp"
#include "base/file_bytes.hpp"
#include "base/random.hpp"
#include "compensation/predictors/formula_predictor.hpp"
#include "follow/followed_predictor.hpp"
#include "follow/session.hpp"
#include "follow/state_file.hpp"
#include "output/predictor_file.hpp"
#include "tests/deployed_model.hpp"
#include "tests/temporary_file.hpp"

namespace driftwright::follow::follow_session_test {
namespace {

using namespace compensation;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

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
  return driftwright::write_file(name, output::predictor_json(file, {}, {"1", "a test"}).dump());
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
  EXPECT_THAT([&] { (void)followed_predictor(path, {}); },
              ::testing::ThrowsMessage<InputError>(
                  ::testing::AllOf(::testing::HasSubstr(path), ::testing::HasSubstr("a sensor that drifts leaves 40 um"),
                                   ::testing::HasSubstr("--despite-verdict"))));
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
  EXPECT_THAT([&] { (void)resume_from(state, other); }, ThrowsMessage<InputError>(HasSubstr("is not the file")));
  Session narrow = session_of(path);
  narrow.begin({r.channels.begin(), r.channels.end()});
  std::string text = read_bytes(state);
  text.replace(text.find("\"run_s\""), 7, "\"run_t\"");
  driftwright::write_file("axis.state", text);
  EXPECT_THAT([&] { (void)resume_from(state, narrow); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("axis.state"), HasSubstr("damaged"))));
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
  EXPECT_THAT([&] { session.begin(channels); }, ThrowsMessage<InputError>(HasSubstr("which the stream has in K")));
  channels.erase(channels.begin() + 1);
  EXPECT_THAT([&] { session.begin(channels); }, ThrowsMessage<InputError>(HasSubstr("which the stream does not have")));
  std::vector<Session::Model> twice;
  const std::string path = path_of(formula(false));
  for (int k = 0; k < 2; ++k) twice.push_back({path, "", followed_predictor(path, {})});
  EXPECT_THAT([&] { (void)Session(std::move(twice)); }, ThrowsMessage<InputError>(HasSubstr("corrected by another model")));
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

}  // namespace
}  // namespace driftwright::follow::follow_session_test
