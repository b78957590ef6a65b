#include "base/config_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/temporary_file.hpp"

namespace driftwright {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

ConfigMap read(const std::string& text) {
  return ConfigMap::read_file(write_file("config_map_test.yaml", text));
}

TEST(ConfigMap, ReadsWhatStandsThere) {
  const ConfigMap in = read(
      "name: mill\nlength: 80 mm\ncount: 010\nhall: 20 degC\nat: [10 mm, 0 mm, 1.2 m]\n"
      "rows: [[30 min, 2000 rpm], [1 h, 0 rpm]]\npart: {film: 5 W/(m^2 K)}\nlist: [{a: 1}, {a: 2}]\n");
  EXPECT_EQ(in.text("name"), "mill");
  EXPECT_DOUBLE_EQ(in.quantity("length", "m", 0, 1), 0.08);
  EXPECT_EQ(in.integer("count", 0, 100), 10);  // not eight
  EXPECT_DOUBLE_EQ(in.temperature_K("hall"), 293.15);
  EXPECT_TRUE(in.vector3("at", "m").isApprox(Eigen::Vector3d(0.01, 0, 1.2), 1e-15));
  EXPECT_EQ(in.rows("rows", {"s", "rpm"}), (std::vector<std::vector<double>>{{1800, 2000}, {3600, 0}}));
  EXPECT_EQ(in.map("part").quantity("film", "W/(m^2 K)", 0, 10), 5.0);
  ASSERT_EQ(in.maps("list").size(), 2u);
  EXPECT_EQ(in.maps("list")[1].integer("a", 0, 9), 2);
  EXPECT_TRUE(in.maps("none").empty());
  EXPECT_FALSE(in.optional_map("none").has_value());
  EXPECT_NO_THROW(in.reject_unknown_keys());
}

TEST(ConfigMap, FallbacksStandForMissingKeysAlone) {
  const ConfigMap in = read("length: wrong\n");
  EXPECT_EQ(in.quantity("width", "m", 0, 1, 0.5), 0.5);
  EXPECT_EQ(in.integer("count", 0, 9, 3), 3);
  EXPECT_EQ(in.text("name", "x"), "x");
  EXPECT_EQ(in.choice("kind", {"a", "b"}, "b"), "b");
  EXPECT_THROW((void)in.quantity("length", "m", 0, 1, 0.5), InputError);
}

TEST(ConfigMap, UnknownKeyIsNamedWithItsPlaceAndTheNearestKnownOne) {
  const ConfigMap in = read("first: 1\npart:\n  film: 5 W/(m^2 K)\n  ambeint: 24 degC\n");
  const ConfigMap part = in.map("part");
  (void)part.quantity("film", "W/(m^2 K)", 0, 10);
  (void)part.has("ambient");
  EXPECT_THAT(
      [&] { part.reject_unknown_keys(); },
      ThrowsMessage<InputError>(AllOf(HasSubstr("config_map_test.yaml:4:3: unknown key 'ambeint'"),
                                      HasSubstr("ambient, film"), HasSubstr("Did you mean 'ambient'?"),
                                      HasSubstr("[part.ambeint]"), HasSubstr("\n    4 |   ambeint: 24 degC\n      |   ^"))));
}

TEST(ConfigMap, AKeyFarFromAllOthersGetsNoSuggestion) {
  const ConfigMap in = read("elephant: 1\n");
  (void)in.has("film");
  EXPECT_THAT([&] { in.reject_unknown_keys(); }, ThrowsMessage<InputError>(::testing::Not(HasSubstr("Did you mean"))));
}

TEST(NearestWord, CountsEdits) {
  EXPECT_EQ(nearest_word("convecton", {"contact", "convection"}), "convection");
  EXPECT_EQ(nearest_word("xyz", {"convection"}), "");
}

struct Bad {
  const char* text;
  void (*read)(const ConfigMap&);
  const char* message;
};
class ConfigMapErrors : public ::testing::TestWithParam<Bad> {};

TEST_P(ConfigMapErrors, NameThePlaceAndWhatIsWrong) {
  EXPECT_THAT([] { GetParam().read(read(GetParam().text)); }, ThrowsMessage<InputError>(HasSubstr(GetParam().message)));
}

void nothing(const ConfigMap&) {}
void length(const ConfigMap& in) {
  (void)in.quantity("length", "m", 0.0, 1.0);
}
void count(const ConfigMap& in) {
  (void)in.integer("count", 1, 5);
}

INSTANTIATE_TEST_SUITE_P(
    Each, ConfigMapErrors,
    ::testing::Values(
        Bad{"a: 1\nb: 2\na: 3\n", nothing, ":3:1: key 'a' appears twice"},
        Bad{"part:\n  a: 1\n  a: 2\n", [](const ConfigMap& in) { (void)in.map("part"); }, ":3:3: key 'a' appears twice"},
        Bad{"list: [{a: 1, a: 2}]\n", [](const ConfigMap& in) { (void)in.maps("list"); }, "appears twice"},
        Bad{"a: 1\n", length, ":1:1: key 'length' is missing"}, Bad{"a: 1\nlength: 80\n", length, ":2:9: '80' has no unit"},
        Bad{"length: .nan m\n", length, ":1:9: '.nan m' is not a number"},
        Bad{"length: nan m\n", length, "not a finite number"},
        Bad{"length: 2 m\n", length, "outside what is allowed, 0 to 1 m"},
        Bad{"length: [1 m]\n", length, "a single value is wanted"}, Bad{"length:\n", length, "a single value is wanted"},
        Bad{"count: 6\n", count, "'6' is no whole number from 1 to 5"}, Bad{"count: 2.5\n", count, "no whole number"},
        Bad{"count: .nan\n", count, "no whole number"}, Bad{"count: 99999999999999\n", count, "no whole number"},
        Bad{"t: -300 degC\n", [](const ConfigMap& in) { (void)in.temperature_K("t"); }, "1 K to 3000 K"},
        Bad{"kind: c\n",
            [](const ConfigMap& in) {
              (void)in.choice("kind", {"a", "b"});
            },
            "one of a, b is wanted"},
        Bad{"at: [1 m, 2 m]\n", [](const ConfigMap& in) { (void)in.vector3("at", "m"); }, "three quantities"},
        Bad{"r: [[1 s]]\n",
            [](const ConfigMap& in) {
              (void)in.rows("r", {"s", "rpm"});
            },
            "rows of [s, rpm]"},
        Bad{"r: []\n", [](const ConfigMap& in) { (void)in.rows("r", {"s"}); }, "at least one"},
        Bad{"part: 3\n", [](const ConfigMap& in) { (void)in.map("part"); }, "a map of keys is wanted"},
        Bad{"part: {}\n", [](const ConfigMap& in) { (void)in.maps("part"); }, "a list of maps is wanted"},
        Bad{"name: ''\n", [](const ConfigMap& in) { (void)in.text("name"); }, "the value is empty"},
        Bad{"a: [1\n", nothing, "not valid YAML"}, Bad{"- a\n", nothing, "no map of keys"},
        Bad{"[a, b]: 1\n", nothing, "a key must be a word"}));

TEST(ConfigMap, RefusesAMissingFile) {
  EXPECT_THAT([] { (void)ConfigMap::read_file("/nowhere/x.yaml"); },
              ThrowsMessage<InputError>(HasSubstr("cannot be opened")));
}

}  // namespace
}  // namespace driftwright
