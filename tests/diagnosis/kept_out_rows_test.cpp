// Which records are of one duty cycle, and are kept out together.

#include "diagnosis/kept_out_rows.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace driftwright::diagnosis::kept_out_rows_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

using Pieces = std::vector<std::pair<double, double>>;  // min, rpm

MeasuredRun run_of(const Pieces& pieces) {
  MeasuredRun run;
  double t_s = 0.0;
  for (const auto& [duration_min, speed_rpm] : pieces) {
    run.cyclogram.sections.push_back({60.0 * duration_min, {.speed_rpm = speed_rpm}});
    for (int i = 0; i < 4; ++i) run.time_s.push_back(t_s + 15.0 * duration_min * i);
    t_s += 60.0 * duration_min;
  }
  run.channels = {{.name = "nose",
                   .output = 0,
                   .unit = "K",
                   .value = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(run.time_s.size()))}};
  return run;
}

const Pieces kSlow = {{60, 1000}, {20, 0}, {60, 1000}}, kFast = {{60, 3000}, {20, 0}, {60, 2500}};

TEST(DutyCycles, AreOfRecordsThatHoldTheSameSpeedsForAboutAsLong) {
  // The same speeds in another order, at another length and with an unplanned stop; a record in which nothing turns is a
  // cycle of its own.
  const std::vector<MeasuredRun> runs = {run_of(kSlow), run_of(kFast), run_of({{300, 1000}, {60, 0}}),
                                         run_of({{60, 2500}, {12, 0}, {60, 3000}}), run_of({{200, 0}})};
  EXPECT_THAT(duty_cycles(runs), ElementsAre(ElementsAre(0u, 2u), ElementsAre(1u, 3u), ElementsAre(4u)));
}

TEST(DutyCycles, AreJoinedByARecordThatIsLikeBoth) {
  // Speeds a fifth of the greater one apart are of one cycle.
  const auto at = [](double rpm) { return run_of({{100, rpm}}); };
  EXPECT_THAT(duty_cycles({at(1000), at(1600), at(1260)}), ElementsAre(ElementsAre(0u), ElementsAre(1u), ElementsAre(2u)));
  EXPECT_THAT(duty_cycles({at(1000), at(1500), at(1225)}), ElementsAre(ElementsAre(0u, 1u, 2u)));
}

TEST(DutyCycles, AreOneWhereNothingTurns) {
  EXPECT_THAT(duty_cycles({run_of({{100, 0}}), run_of({{10, 0}})}), ElementsAre(ElementsAre(0u, 1u)));
}

TEST(FoldsOfCycles, KeepOutEveryRecordOfACycleAndNothingElse) {
  const std::vector<MeasuredRun> runs = {run_of(kSlow), run_of(kFast), run_of(kSlow)};
  const std::vector<Fold> folds = folds_of_cycles(runs);
  ASSERT_EQ(folds.size(), 2u);
  EXPECT_THAT(folds[0].whole, ElementsAre(0u, 2u));
  EXPECT_THAT(folds[1].whole, ElementsAre(1u));
  for (const Fold& fold : folds) {
    for (std::size_t r = 0; r < runs.size(); ++r) {
      const bool is_out = std::count(fold.whole.begin(), fold.whole.end(), r) > 0;
      EXPECT_EQ(fold.fitted[r].channels[0].value.hasNaN(), is_out) << r;
      EXPECT_EQ(fold.kept_out[r].channels[0].value.hasNaN(), !is_out) << r;
    }
  }
}

TEST(FoldsOfCycles, AreNoneWhereRecordsAreKeptOutOneByOneAnyway) {
  EXPECT_THAT(folds_of_cycles({run_of(kSlow)}), IsEmpty());
  EXPECT_THAT(folds_of_cycles({run_of(kSlow), run_of(kFast)}), IsEmpty());
  EXPECT_THAT(folds_of_cycles({run_of(kSlow), run_of(kSlow)}), IsEmpty()) << "a single cycle";
}

}  // namespace
}  // namespace driftwright::diagnosis::kept_out_rows_test
