#include "compensation/quadrature.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace driftwright::compensation {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr QuadratureState k00{false, false}, k10{true, false}, k11{true, true}, k01{false, true};

// Forward means A leads B by 90 degrees: A rises first.
TEST(Quadrature, ForwardMotionLetsALead) {
  EXPECT_THAT(motion_rows(k00, 5), ElementsAre(k10, k11, k01, k00, k10));
  EXPECT_THAT(motion_rows(k11, -3), ElementsAre(k10, k00, k01));
  EXPECT_THAT(motion_rows(k01, 0), IsEmpty());
}

TEST(Quadrature, PlacesWrapAround) {
  EXPECT_EQ(state_of_phase(-1), k01);
  EXPECT_EQ(state_of_phase(-4), k00);
  EXPECT_EQ(state_of_phase(6), k11);
}

// 10 quarters forward, 13 back, from each of the four states.
TEST(Quadrature, DecoderCountsEveryQuarterBothWays) {
  for (QuadratureState start : {k00, k10, k11, k01}) {
    QuadratureDecoder decoder(start);
    const std::vector<QuadratureState> out = motion_rows(start, 10);
    for (QuadratureState s : out) decoder.step(s);
    EXPECT_EQ(decoder.count(), 10);
    for (QuadratureState s : motion_rows(out.back(), -13)) decoder.step(s);
    EXPECT_EQ(decoder.count(), -3);
    EXPECT_EQ(decoder.n_illegal(), 0);
  }
}

TEST(Quadrature, DecoderTakesItsFirstRowAsReferenceAndIgnoresRest) {
  QuadratureDecoder decoder;
  for (QuadratureState s : {k11, k11, k01, k01}) decoder.step(s);
  EXPECT_EQ(decoder.count(), 1);
  EXPECT_EQ(decoder.n_illegal(), 0);
}

TEST(Quadrature, TwoBitsAtOnceAreIllegalAndCountNothing) {
  for (auto [from, to] : {std::pair{k00, k11}, {k11, k00}, {k10, k01}, {k01, k10}}) {
    QuadratureDecoder decoder(from);
    decoder.step(to);
    EXPECT_EQ(decoder.n_illegal(), 1);
    EXPECT_EQ(decoder.count(), 0);
    decoder.step(to);  // the decoder goes on from where the signal is
    EXPECT_EQ(decoder.n_illegal(), 1);
  }
}

}  // namespace
}  // namespace driftwright::compensation
