// JSON from outside: how deep it may nest, where it stops to be JSON, and whether it is still what was written.

#include "base/bounded_json.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/errors.hpp"
#include "base/hashed_json.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::bounded_json_test {
namespace {

using Json = nlohmann::ordered_json;

std::string lists(std::size_t n) {
  return std::string(n, '[') + std::string(n, ']');
}
std::string objects(std::size_t n) {
  std::string text;
  for (std::size_t i = 0; i < n; ++i) text += "{\"a\":";
  return text + "1" + std::string(n, '}');
}

TEST(BoundedJson, NestsAHundredDeepAndNoDeeper) {
  EXPECT_EQ(parse_json(lists(100)).dump(), lists(100));
  EXPECT_EQ(parse_json(objects(100)).dump(), objects(100));
  for (const std::string& text :
       {lists(101), objects(101), lists(300000), objects(300000), std::string(300000, '['), "{\"a\":" + lists(100) + "}"})
    EXPECT_REFUSED(parse_json(text), "more than 100 deep");
}

TEST(BoundedJson, BracketsInATextAndBesideOneAnotherNestNothing) {
  const std::string text = "[\"" + std::string(1000, '[') + "\\\"" + std::string(1000, '{') + "\"]";
  EXPECT_EQ(parse_json(text).dump(), text);
  std::string beside = "[[]";
  for (int i = 0; i < 1000; ++i) beside += ",[]";
  EXPECT_EQ(parse_json(beside + "]").size(), 1001u);
}

TEST(BoundedJson, SaysFromWhereOnATextIsNoJson) {
  EXPECT_REFUSED(parse_json("{\n \"a\": 1,\n \"b\" 2}"), "not valid JSON from line 3, column 6 on");
  EXPECT_REFUSED(parse_json("[1, 2"), "line 1, column 6");
  EXPECT_REFUSED(parse_json(""), "line 1, column 1");
  EXPECT_REFUSED(parse_json("[1e999]"), "beyond 1.8e308");
}

TEST(HashedJson, IsWholeUntilAValueIsAnother) {
  const Json json = with_hash({{"a", {1, 2.5}}, {"b", "Geh\xE4use"}, {"c", NAN}});
  EXPECT_TRUE(is_whole(json));
  EXPECT_TRUE(is_whole(parse_json(json.dump(3))));  // the layout does not matter
  for (const char* key : {"a", "b", "c", "hash"}) {
    Json other = json;
    other[key] = 3;
    EXPECT_FALSE(is_whole(other)) << key;
    other.erase(key);
    EXPECT_FALSE(is_whole(other)) << key;
  }
  EXPECT_FALSE(is_whole(Json::array({"hash"})));
}

}  // namespace
}  // namespace driftwright::bounded_json_test
