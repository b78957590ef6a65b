// Records with holes, rows without a speed and a logger's rarer rows: what they hide is no cause, and what lasts is found
// on both sides.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "tests/shared/lumped_records.hpp"

namespace driftwright::diagnosis::records_with_holes_test {
namespace {

using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

/// Without its rows from `first` to `last`, a row a minute.
std::string with_hole(const std::string& record, int first, int last, const std::string& name) {
  std::ifstream whole(record);
  std::string kept, row;
  for (int i = -1; std::getline(whole, row); ++i) {
    if (i < first || i > last) kept += row + "\n";
  }
  return write_file(name, kept);
}

// The rows on both sides of a hole count, and what the machine did meanwhile is no cause: a change of speed, or a stop of
// which nothing is recorded.
TEST(ARecordWithAHole, CountsOnBothSidesOfIt) {
  std::string truth = kTwoNodes;
  const std::string monday = "monday: [[60 min, 600 rpm], [60 min, 1900 rpm], ";
  truth.replace(truth.find(monday), monday.size(),
                "monday: [[60 min, 600 rpm], [15 min, 1900 rpm], [20 min, 0 rpm], [25 min, 1900 rpm], ");
  const std::vector<std::string> records = noisy_records(write_file("truth.yaml", truth), "hole_");
  for (const auto& [first, last] :
       {std::pair{51, 69}, {73, 97}}) {  // speed changes in the first one; 1900 rpm before and after the second one
    const Beside beside(write_file("plain.yaml", kTwoNodes),
                        {with_hole(records[0], first, last, "gap_monday.csv"), records[1]});
    ASSERT_THAT(beside.runs[0].holes, SizeIs(1));
    EXPECT_THAT(beside.runs[1].holes, IsEmpty());
    EXPECT_DOUBLE_EQ(beside.runs[0].holes[0].begin_s, 60.0 * (first - 1));
    EXPECT_DOUBLE_EQ(beside.runs[0].holes[0].end_s, 60.0 * (last + 1));
    EXPECT_EQ(beside.runs[0].time_s.front(), 0.0);
    EXPECT_EQ(beside.runs[0].time_s.back(), 300.0 * 60.0);
    const Diagnosis d = beside.diagnosed();
    EXPECT_EQ(d.verdict, Verdict::kConsistent) << first << ": " << d.reason;
  }
}

// What is wrong in all of a record is found on both sides of its hole.
TEST(ARecordWithAHole, HidesNoCauseThatLasts) {
  const std::string truth = with_effect(kTwoNodes, "{type: heat_source, node: column, power: 25 W}");
  const std::vector<std::string> records = noisy_records(write_file("truth.yaml", truth), "hole_");
  const Beside beside(write_file("plain.yaml", kTwoNodes),
                      {with_hole(records[0], 51, 90, "gap_monday.csv"), with_hole(records[1], 100, 150, "gap_tuesday.csv")});
  const Diagnosis d = beside.diagnosed();
  ASSERT_THAT(d.causes, SizeIs(1)) << d.reason;
  EXPECT_EQ(d.causes[0].effect, "heat_source");
  EXPECT_EQ(d.causes[0].where, "column");
  EXPECT_NEAR(d.causes[0].parameters[0].value, 25.0, 3.0);
  EXPECT_TRUE(d.causes[0].is_written) << d.causes[0].why_not_written;  // what the holes leave open does not speak against it
}

// The readings of an hour and a half after a hole depend on the unknown drive in the hole. Such rows are not used to judge,
// and if there are no others, no gain is reported.
TEST(ARecordWithAHole, LeavesNothingToJudgeByWhereItIsJustBeforeAllThatIsKeptOut) {
  const std::vector<std::string> records = noisy_records(write_file("plain.yaml", kTwoNodes), "hole_");
  for (const auto& [first, last, is_open] : {std::tuple{150, 195, true}, {5, 12, false}}) {
    const Beside beside(write_file("plain.yaml", kTwoNodes), {with_hole(records[0], first, last, "gap_monday.csv")});
    const Diagnosis d = beside.diagnosed();
    EXPECT_EQ(d.verdict, Verdict::kConsistent) << d.reason;
    EXPECT_EQ(std::isnan(d.misses.as_written), is_open);
    EXPECT_EQ(std::isnan(d.misses.extended), is_open);
    ASSERT_THAT(d.gain, Not(IsEmpty()));
    for (const ChannelGain& g : d.gain) {
      EXPECT_EQ(std::isnan(g.rmse_before), is_open) << g.name;
      EXPECT_EQ(std::isnan(g.rmse_after), is_open) << g.name;
      EXPECT_EQ(std::isnan(g.peak_after), is_open) << g.name;
    }
  }
}

/// Without the speed in rows `first` to `last`, all else as it was.
std::string without_speed(const std::string& record, int first, int last, const std::string& name) {
  std::ifstream whole(record);
  std::string kept, row;
  for (int i = -1; std::getline(whole, row); ++i) {
    const std::size_t comma = row.find(',');
    const bool is_blank = i >= first && i <= last;
    kept += (is_blank ? row.substr(0, comma + 1) + row.substr(row.find(',', comma + 1)) : row) + "\n";
  }
  return write_file(name, kept);
}

// Readings with an unknown speed say nothing: within a record, at its beginning and at its end.
TEST(ARecordWithAHole, IsNotReadWhereTheSpeedIsMissing) {
  const std::vector<std::string> records = noisy_records(write_file("plain.yaml", kTwoNodes), "hole_");
  for (const auto& [first, last] : {std::pair{61, 130}, {0, 79}, {226, 300}}) {
    const Beside beside(write_file("plain.yaml", kTwoNodes),
                        {without_speed(records[0], first, last, "gap_monday.csv"), records[1]});
    ASSERT_THAT(beside.runs[0].holes, SizeIs(1)) << first;
    const Diagnosis d = beside.diagnosed();
    EXPECT_EQ(d.verdict, Verdict::kConsistent) << first << ": " << d.reason;
  }
}

// A logger that writes less often from a time on leaves no holes.
TEST(ARecordWithAHole, IsNoneOfRowsThatAreFurtherApartFromATimeOn) {
  const std::vector<std::string> records = noisy_records(write_file("plain.yaml", kTwoNodes), "hole_");
  std::ifstream whole(records[0]);
  std::string kept, row;
  for (int i = -1; std::getline(whole, row); ++i) {
    if (i <= 170 || i % 6 == 0) kept += row + "\n";
  }
  const Beside beside(write_file("plain.yaml", kTwoNodes), {write_file("gap_monday.csv", kept), records[1]});
  EXPECT_THAT(beside.runs[0].holes, IsEmpty());
}

}  // namespace
}  // namespace driftwright::diagnosis::records_with_holes_test
