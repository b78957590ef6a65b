#include "compensation/injector/quadrature.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace driftwright::compensation::quadrature_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr Lines k00 = 0, k10 = kLineA, k11 = kLineA | kLineB, k01 = kLineB;

// Forward means A leads B by 90 degrees: A rises first.
TEST(Quadrature, ForwardMotionLetsALead) {
  EXPECT_THAT(motion_rows(k00, 5), ElementsAre(k10, k11, k01, k00, k10));
  EXPECT_THAT(motion_rows(k11, -3), ElementsAre(k10, k00, k01));
  EXPECT_THAT(motion_rows(k01, 0), IsEmpty());
}

TEST(Quadrature, PlacesWrapAround) {
  EXPECT_EQ(lines_of_phase(-1), k01);
  EXPECT_EQ(lines_of_phase(-4), k00);
  EXPECT_EQ(lines_of_phase(6), k11);
  for (int phase : {0, 1, 2, 3}) EXPECT_EQ(phase_of(lines_of_phase(phase)), phase);
}

// 10 quarters forward, 13 back, from each of the four states.
TEST(Quadrature, X4CountsEveryQuarterBothWays) {
  for (Lines start : {k00, k10, k11, k01}) {
    QuadratureCounter counter(start);
    const std::vector<Lines> out = motion_rows(start, 10);
    for (Lines s : out) counter.step(s);
    EXPECT_EQ(counter.count(), 10);
    for (Lines s : motion_rows(out.back(), -13)) counter.step(s);
    EXPECT_EQ(counter.count(), -3);
    EXPECT_EQ(counter.n_jumps(), 0);
  }
}

// By hand: from 00 ten quarters forward pass A's edges at 1, 3, 5, 7, 9 and "A rises while B is low" at 1, 5, 9.
TEST(Quadrature, X2CountsEdgesOfAAndX1OneOfThem) {
  QuadratureCounter x2(k00, Counting::kX2), x1(k00, Counting::kX1);
  for (Lines row : motion_rows(k00, 10)) {
    x2.step(row);
    x1.step(row);
  }
  EXPECT_EQ(x2.count(), 5);
  EXPECT_EQ(x1.count(), 3);
  for (Lines row : motion_rows(k11, -10)) {
    x2.step(row);
    x1.step(row);
  }
  EXPECT_EQ(x2.count(), 0);  // the way back takes away what the way out gave
  EXPECT_EQ(x1.count(), 0);
}

TEST(Quadrature, AJumpCountsNothing) {
  for (auto [from, to] : {std::pair{k00, k11}, {k11, k00}, {k10, k01}, {k01, k10}}) {
    for (Counting counting : {Counting::kX4, Counting::kX2, Counting::kX1}) {
      QuadratureCounter counter(from, counting);
      counter.step(to);
      counter.step(to);  // it goes on from where the signal is
      EXPECT_EQ(counter.n_jumps(), 1);
      EXPECT_EQ(counter.count(), 0);
    }
  }
}

TEST(EncoderReader, TakesItsFirstRowAsReferenceAndIgnoresRest) {
  EncoderReader reader;
  for (Lines s : {k11, k11, k01, k01}) (void)reader.step(s);
  EXPECT_EQ(reader.count(), 1);
  EXPECT_TRUE(reader.trusted());
}

TEST(EncoderReader, ALostEdgeIsCountedWithTheStepBehindIt) {
  for (int direction : {+1, -1}) {
    EncoderReader reader;
    std::vector<Lines> rows = motion_rows(k00, direction * 12);
    rows.erase(rows.begin() + 5);  // lost
    (void)reader.step(k00);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      (void)reader.step(rows[i]);
      if (i == 5) {
        EXPECT_TRUE(reader.in_doubt());
      }
    }
    EXPECT_EQ(reader.count(), direction * 12);
    EXPECT_EQ(reader.n_jumps(), 1);
  }
}

TEST(EncoderReader, ADisturbanceThereAndBackCountsNothing) {
  EncoderReader reader;
  for (Lines row : {k00, k11, k00, k10}) (void)reader.step(row);
  EXPECT_EQ(reader.count(), 1);
  EXPECT_EQ(reader.n_jumps(), 2);
  EXPECT_FALSE(reader.trusted());  // until a whole period has followed
  for (Lines row : {k11, k01, k00}) (void)reader.step(row);
  EXPECT_TRUE(reader.trusted());
}

}  // namespace
}  // namespace driftwright::compensation::quadrature_test
