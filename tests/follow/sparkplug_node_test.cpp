// Births and deaths of a Sparkplug B node: whose values are in force, and when a birth is requested.

#include "follow/sparkplug_node.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sparkplug_b.pb.h"

namespace driftwright::follow::sparkplug_node_test {
namespace {

using ::testing::Contains, ::testing::Each, ::testing::HasSubstr, ::testing::Pair;

constexpr std::uint64_t kAlias = 5;

/// A message of one metric; with its name, its alias, or both.
std::string message(std::optional<std::uint64_t> seq, const std::string& name, double value, bool has_alias = true) {
  sparkplug::Payload payload;
  if (seq) payload.set_seq(*seq);
  auto* metric = payload.add_metrics();
  metric->set_name(name);
  if (has_alias) metric->set_alias(kAlias);
  metric->set_datatype(10);
  metric->set_double_value(value);
  return payload.SerializeAsString();
}

std::string node_message(std::optional<std::uint64_t> seq, std::uint64_t birth_number) {
  sparkplug::Payload payload;
  if (seq) payload.set_seq(*seq);
  auto* metric = payload.add_metrics();
  metric->set_name("bdSeq");
  metric->set_datatype(8);
  metric->set_long_value(birth_number);
  return payload.SerializeAsString();
}

std::string topic(const std::string& type) {
  return "spBv1.0/shop/" + type + "/mill" + (type.starts_with('D') ? "/spindle" : "");
}

/// A node whose device gave a speed of 1000 with its birth, number 7; the next message is number 2.
SparkplugNode born() {
  SparkplugNode node({"shop", "mill", "spindle"});
  EXPECT_EQ(node.take(topic("NBIRTH"), node_message(0, 7)), "");
  EXPECT_EQ(node.take(topic("DBIRTH"), message(1, "speed", 1000.0)), "");
  EXPECT_THAT(node.metrics(), Contains(Pair("speed", "1000")));
  return node;
}

TEST(SparkplugNode, ValuesOfADeadNodeAreMissingUntilItsDeviceIsBornAgain) {
  SparkplugNode node = born();
  EXPECT_EQ(node.take(topic("NDEATH"), node_message({}, 7)), "");
  EXPECT_FALSE(node.is_alive());
  EXPECT_THAT(node.metrics(), Each(Pair("speed", std::nullopt)));
  EXPECT_EQ(node.take(topic("NBIRTH"), node_message(0, 8)), "");
  EXPECT_TRUE(node.is_alive());
  EXPECT_THAT(node.metrics(), Each(Pair("speed", std::nullopt)));  // the device has said nothing yet
  EXPECT_EQ(node.take(topic("DBIRTH"), message(1, "speed", 2000.0)), "");
  EXPECT_THAT(node.metrics(), Contains(Pair("speed", "2000")));
}

TEST(SparkplugNode, ABirthOfTheNodeAloneEndsWhatItsDevicesSaid) {  // its death was lost on the way
  SparkplugNode node = born();
  EXPECT_EQ(node.take(topic("NBIRTH"), node_message(0, 8)), "");
  EXPECT_THAT(node.metrics(), Each(Pair("speed", std::nullopt)));
}

TEST(SparkplugNode, TheDeathOfABirthBeforeIsNone) {
  SparkplugNode node = born();
  EXPECT_THAT(node.take(topic("NDEATH"), node_message({}, 6)), HasSubstr("a birth before"));
  EXPECT_TRUE(node.is_alive());
  EXPECT_THAT(node.metrics(), Contains(Pair("speed", "1000")));
}

TEST(SparkplugNode, ADeathIsBelievedWhereTheBirthInForceIsNotKnown) {
  SparkplugNode node = born();
  node.lose_sight();  // the link was away: a birth may have been missed
  EXPECT_EQ(node.take(topic("NDEATH"), node_message({}, 9)), "");
  EXPECT_FALSE(node.is_alive());
  EXPECT_THAT(node.metrics(), Each(Pair("speed", std::nullopt)));
}

TEST(SparkplugNode, ADeviceDiesAlone) {
  SparkplugNode node = born();
  EXPECT_EQ(node.take(topic("DDEATH"), message(2, "", 0.0)), "");
  EXPECT_TRUE(node.is_alive());
  EXPECT_THAT(node.metrics(), Each(Pair("speed", std::nullopt)));
}

TEST(SparkplugNode, AnEmptyNameIsNoNameAndOneOfNoBirthIsAskedFor) {
  SparkplugNode node = born();
  EXPECT_EQ(node.take(topic("DDATA"), message(2, "", 1500.0)), "");  // some libraries write an empty name beside the alias
  EXPECT_THAT(node.metrics(), Contains(Pair("speed", "1500")));
  EXPECT_FALSE(node.wants_birth());
  EXPECT_THAT(node.take(topic("DDATA"), message(3, "torque", 3.0, false)), HasSubstr("'torque' is of no birth"));
  EXPECT_TRUE(node.wants_birth());
  EXPECT_EQ(node.metrics().count("torque"), 0U);
}

TEST(SparkplugNode, WhatIsSaidBehindADeathIsOfNoUse) {
  SparkplugNode node = born();
  EXPECT_EQ(node.take(topic("NDEATH"), node_message({}, 7)), "");
  EXPECT_THAT(node.take(topic("DDATA"), message(2, "speed", 1500.0)), HasSubstr("birth has not been heard"));
  EXPECT_TRUE(node.wants_birth());
  EXPECT_THAT(node.metrics(), Each(Pair("speed", std::nullopt)));
}

}  // namespace
}  // namespace driftwright::follow::sparkplug_node_test
