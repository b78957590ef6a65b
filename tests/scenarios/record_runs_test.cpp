// Long records: parts of them, runs between rests, and what goes on from what came before.

#include "scenarios/reader/record_runs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "base/errors.hpp"
#include "compensation/predictors/drift_model.hpp"
#include "compensation/predictors/scored_rows.hpp"
#include "scenarios/reader/record_part.hpp"
#include "scenarios/reader/recorded_run.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::scenarios::record_runs_test {
namespace {

using ::testing::ElementsAre, ::testing::IsEmpty, ::testing::SizeIs;

struct Stretch {
  double hours, speed_rpm;
};

/// One row a minute from 100 s on. A body of one hour's time constant goes to 10 K at 1000 rpm, and with it a drift of 2
/// um/K: exact exponentials.
Record record_of(const std::vector<Stretch>& stretches) {
  Record r{.source = "week.csv",
           .time_s = {},
           .channels = {{"speed", "rpm", {}}, {"nose", "degC", {}}, {"tip_z", "um", {}}, {"room", "percent", {}}}};
  double T_K = 0.0, t_s = 100.0;
  for (const Stretch& s : stretches) {
    for (int i = 0; i < static_cast<int>(std::lround(60.0 * s.hours)); ++i) {
      r.time_s.push_back(t_s);
      r.channels[0].values.push_back(s.speed_rpm);
      r.channels[1].values.push_back(20.0 + T_K);
      r.channels[2].values.push_back(2.0 * T_K);
      r.channels[3].values.push_back(static_cast<double>(r.time_s.size()));
      T_K += (0.01 * s.speed_rpm - T_K) * (1.0 - std::exp(-1.0 / 60.0));
      t_s += 60.0;
    }
  }
  return r;
}

struct Cut {
  explicit Cut(const std::vector<Stretch>& stretches)
      : record(record_of(stretches)), run(run_of(record, nullptr, {}, Reading::kStrict)) {}
  [[nodiscard]] std::vector<RunRows> runs() const { return runs_between_rests(run, 0, record.n_samples()); }
  Record record;
  MachineRun run;
};

// exp(-1) of the way is left after one hour of rest, exp(-5) = 0.7 % after five.
TEST(RecordRuns, AreCutWhereTheDriveStartsAnewAfterARest) {
  const Cut c({{0.5, 0}, {2, 1000}, {1, 0}, {2, 500}, {5, 0}, {2, 1000}, {1, 0}, {1, 400}});
  EXPECT_THAT(c.runs(),
              ElementsAre(RunRows{0, 0, 210}, RunRows{0, 210, 630}, RunRows{630, 630, 810}, RunRows{630, 810, 870}));
}

TEST(RecordRuns, ShortRestsAndJitterDoNotCut) {
  EXPECT_THAT(Cut({{2, 1000}, {0.15, 0}, {2, 500}}).runs(), ElementsAre(RunRows{0, 0, 249}));
  EXPECT_THAT(Cut({{2, 1000}, {0.2, 0}, {2, 500}}).runs(), SizeIs(2));
  EXPECT_THAT(Cut({{2, 1000}, {1, 5}, {2, 500}}).runs(),
              SizeIs(2));  // 0.5 % of the top speed: what a tachometer reads at rest
  EXPECT_THAT(Cut({{1, 0}, {2, 1000}, {1, 0}}).runs(), SizeIs(1));  // a rest at either end divides nothing
}

TEST(RecordRuns, AtMostEightAtTheLongestRests) {
  std::vector<Stretch> days;
  for (int day = 0; day < 12; ++day) {
    days.push_back({1, 1000});
    days.push_back({day % 3 == 0 ? 3.0 : 0.5, 0});
  }
  days.push_back({1, 1000});
  const Cut c(days);
  const std::vector<RunRows> runs = c.runs();
  ASSERT_THAT(runs, SizeIs(8));
  std::vector<std::size_t> starts;
  for (const RunRows& run : runs) starts.push_back(run.first);
  for (const std::size_t long_rest_ends : {240u, 660u, 1080u, 1500u})
    EXPECT_THAT(starts, ::testing::Contains(long_rest_ends));
}

TEST(RecordRuns, AFeedIsNoRest) {
  Record r = record_of({{2, 1000}, {1, 0}, {2, 500}});
  r.channels.push_back({"feed_x", "mm_min", std::vector<double>(r.n_samples(), -600.0)});
  const MachineRun run = run_of(r, nullptr, {}, Reading::kStrict);
  EXPECT_THAT(runs_between_rests(run, 0, r.n_samples()), SizeIs(1));
}

// The machine came back to its ambient, which is warmer by now; without the ambient it has not come back.
TEST(RecordRuns, BalanceIsWithTheAmbient) {
  Record r = record_of({{2, 1000}, {5, 0}, {1, 1000}});
  Channel ambient{"ambient", "degC", {}};
  for (std::size_t i = 0; i < r.n_samples(); ++i) {
    const double rise_K = std::min(3.0, 0.02 * static_cast<double>(i));
    ambient.values.push_back(20.0 + rise_K);
    r.channels[1].values[i] += rise_K;
  }
  const MachineRun alone = run_of(r, nullptr, {}, Reading::kStrict);
  EXPECT_EQ(whole_run(alone, 420, r.n_samples()).history, 0u);
  r.channels.push_back(ambient);
  const MachineRun with_ambient = run_of(r, nullptr, {}, Reading::kStrict);
  EXPECT_EQ(whole_run(with_ambient, 420, r.n_samples()).history, 420u);
}

TEST(RecordPart, NamesRowsByTimeSinceTheFirst) {
  const Record r = record_of({{4, 1000}});
  const auto rows = [&](const std::string& part) { return rows_of(read_record_part("week.csv" + part), r); };
  using Rows = std::pair<std::size_t, std::size_t>;
  EXPECT_EQ(rows(""), (Rows{0, 240}));
  EXPECT_EQ(rows(":0h..1h"), (Rows{0, 60}));
  EXPECT_EQ(rows(":1h..4h"), (Rows{60, 240}));
  EXPECT_EQ(rows(":90min.."), (Rows{90, 240}));
  EXPECT_EQ(rows(":..0.5 h"), (Rows{0, 30}));
  const RecordPart part = read_record_part("C:/data/week.csv:20h..28h");
  EXPECT_EQ(part.file, "C:/data/week.csv");
  EXPECT_DOUBLE_EQ(part.from_s, 72000.0);
  const std::string odd = write_file("a..b:c..d.csv", "");  // a file of that name is that file
  EXPECT_EQ(read_record_part(odd).file, odd);
}

TEST(RecordPart, RefusesWhatIsNoPart) {
  const Record r = record_of({{4, 1000}});
  const std::pair<const char*, const char*> cases[] = {
      {"week.csv:1..2", "'1' has no unit"},  {"week.csv:1h..2K", "wrong unit 'K'"},
      {"week.csv:2h..1h", "ends before"},    {"week.csv:-1h..1h", "before the record's start"},
      {"week.csv:3h..5h", "record is 3.98"}, {"week.csv:5h..", "record is 3.98"},
      {"week.csv:1h..61min", "1 rows"}};
  for (const auto& [argument, words] : cases) EXPECT_REFUSED(rows_of(read_record_part(argument), r), argument, words);
  const auto overlap = [](const char* a, const char* b) { refuse_overlap(read_record_part(a), read_record_part(b)); };
  overlap("week.csv:0h..1h", "week.csv:1h..2h");
  overlap("week.csv:0h..1h", "other.csv:0h..1h");
  EXPECT_REFUSED(overlap("week.csv:0h..1.5h", "./week.csv:1h..2h"), "week.csv:0h..1.5h", "overlap");
  EXPECT_REFUSED(overlap("week.csv", "week.csv:1h..2h"), "overlap");
}

TEST(RecordPart, KnowsWhetherItHasRowsOfOthers) {
  const std::string week = write_file("week.csv", ""), other = write_file("other.csv", "");
  const auto has = [&](const std::string& part) {  // of the rows from 1 h to 2 h
    return has_rows_of(read_record_part(part), week, 3600.0, 7200.0);
  };
  for (const char* part : {"", ":0h..", ":..1.5h", ":2h..", ":1.2h..1.3h", ":0h..9h"}) EXPECT_TRUE(has(week + part)) << part;
  for (const char* part : {":..1h", ":0h..30min", ":2.01h..", ":3h..4h"}) EXPECT_FALSE(has(week + part)) << part;
  EXPECT_TRUE(has(std::filesystem::relative(week).string() + ":1h..2h"));
  EXPECT_FALSE(has(other));
}

TEST(RecordRuns, PartsOfDriveAndAmbient) {
  const Cyclogram c{.name = "c", .sections = {{100, {.speed_rpm = 1}}, {100, {.speed_rpm = 2}}, {100, {.speed_rpm = 3}}}};
  const Cyclogram part = part_of(c, 50, 220);
  ASSERT_THAT(part.sections, SizeIs(3));
  for (double t_s : {0.0, 49.0, 51.0, 149.0, 151.0, 169.0}) EXPECT_EQ(part.speed_rpm(t_s), c.speed_rpm(t_s + 50.0)) << t_s;
  EXPECT_DOUBLE_EQ(part.duration_s(), 170.0);
  const TimeSeries ambient{{0, 100, 200}, {0, 10, 0}}, of_ambient = part_of(ambient, 50, 150);
  for (double t_s : {0.0, 25.0, 50.0}) EXPECT_DOUBLE_EQ(of_ambient.at(t_s), ambient.at(t_s + 50.0));
  EXPECT_THAT(part_of(TimeSeries{}, 0, 10).time_s, IsEmpty());
}

/// Rows [0, last) of a record, of which the first `n_before` are lead-in.
MachineRun with_lead_in(const Record& record, std::size_t n_before, std::size_t last) {
  MachineRun run{.cyclogram = {}, .ambient = {}, .readings = record, .n_before = n_before, .history = "week"};
  run.readings.time_s.resize(last);
  for (Channel& c : run.readings.channels) c.values.resize(last);
  return run;
}

// A lag of an hour at the start of the part is what it has become by then; a part that began anew would begin at 0 again.
TEST(MachineRun, LagsStartFromTheHistory) {
  const Record whole = record_of({{3, 1000}, {1, 0}});
  const compensation::DriftModel model{.kind = "lag",
                                       .target = "tip_z",
                                       .target_unit = "um",
                                       .intercept = 0.0,
                                       .terms = {{.input = "speed", .unit = "rpm", .coefficient = 0.02, .lag_s = 3600.0}}};
  const MachineRun run = with_lead_in(whole, 180, 240);
  const std::vector<double> predicted = model.predict(run.readings);
  for (std::size_t i = 180; i < 240; ++i) EXPECT_NEAR(predicted[i], whole.at("tip_z").values[i], 1e-9);
  EXPECT_GT(predicted[180], 18.0);
  EXPECT_DOUBLE_EQ(model.predict(compensation::own_rows(run.readings, 180)).front(), 0.0);
}

TEST(MachineRun, IsScoredOnItsOwnRowsAndCountsFromTheStartOfItsHistory) {
  const Record whole = record_of({{3, 1000}, {1, 0}});
  const MachineRun run = with_lead_in(whole, 180, 240);
  const std::vector<double> drift = compensation::scored_readings(run, "tip_z", true).at("tip_z").values;
  for (std::size_t i = 0; i < 180; ++i) EXPECT_TRUE(std::isnan(drift[i]));
  EXPECT_DOUBLE_EQ(drift[180], whole.at("tip_z").values[180]);  // the machine is warm there: not 0
  const Record own = compensation::own_rows(whole, 180);
  EXPECT_EQ(own.n_samples(), 60u);
  EXPECT_DOUBLE_EQ(own.time_s.front(), 0.0);
  EXPECT_DOUBLE_EQ(own.at("nose").values.front(), whole.at("nose").values[180]);
}

TEST(MachineRun, RunsOfOneHistoryAreOneRunThatKnowsTheirDriftAlone) {
  const Record whole = record_of({{3, 1000}, {1, 0}});
  MachineRun other = with_lead_in(whole, 0, 50);
  other.history.clear();
  const std::vector<MachineRun> runs = {with_lead_in(whole, 0, 60), other, with_lead_in(whole, 180, 240)};
  const std::vector<MachineRun> joined = compensation::joined_histories(runs, "tip_z");
  ASSERT_THAT(joined, SizeIs(2));
  const std::vector<double>& drift = joined[0].readings.at("tip_z").values;
  ASSERT_EQ(drift.size(), 240u);
  for (std::size_t i = 0; i < 240; ++i) EXPECT_EQ(std::isnan(drift[i]), i >= 60 && i < 180) << i;
  EXPECT_EQ(joined[0].readings.at("nose").values, whole.at("nose").values);
  EXPECT_EQ(joined[1].readings.at("tip_z").values, other.readings.at("tip_z").values);
}

}  // namespace
}  // namespace driftwright::scenarios::record_runs_test
