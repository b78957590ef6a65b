// Names, signs and sums of the heat-flow record.

#include "machine/heat_flow_record.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftwright::scenarios::heat_flow_record_test {
namespace {

using solver::FlowKind;

solver::Trajectory run() {
  solver::Trajectory t;
  t.time_s = {0, 10, 40};
  t.flows = {{"heat_source head", FlowKind::kSource},
             {"convection side", FlowKind::kSurrounding},
             {"convection side", FlowKind::kSurrounding},
             {"contact a/b", FlowKind::kInternal}};
  t.heat_J.resize(4, 3);
  t.heat_J << 0, 100, 400, 0, -20, -110, 0, -1, -2, 0, 5, 65;
  t.stored_J.resize(3);
  t.stored_J << 0, 79, 288;
  return t;
}

TEST(HeatFlowRecord, HoldsTheMeanPowerSinceTheRowBefore) {
  const Record r = heat_flow_record(run(), "cycle");
  EXPECT_EQ(r.source, "cycle");
  const auto& source = r.at("heat_source_head").values;
  EXPECT_TRUE(std::isnan(source[0]));  // there is no interval before the first row
  EXPECT_DOUBLE_EQ(source[1], 10.0);
  EXPECT_DOUBLE_EQ(source[2], 10.0);  // 300 J in 30 s
  EXPECT_DOUBLE_EQ(r.at("convection_side").values[2], -3.0);
  EXPECT_DOUBLE_EQ(r.at("stored").values[2], 209.0 / 30.0);
}

TEST(HeatFlowRecord, NamesAreFitForAColumnAndUnlike) {
  const Record r = heat_flow_record(run(), "cycle");
  ASSERT_EQ(r.channels.size(), 5u);
  EXPECT_EQ(r.channels[2].header(), "convection_side_W");
  EXPECT_EQ(r.channels[3].header(), "convection_side_2_W");
  EXPECT_EQ(r.channels[4].header(), "within_contact_a_b_W");
}

}  // namespace
}  // namespace driftwright::scenarios::heat_flow_record_test
