#include "base/config_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::config_map_test {
namespace {

using ::testing::AllOf, ::testing::HasSubstr, ::testing::ThrowsMessage;

using namespace schema;

ConfigMap read(const std::string& text) {
  return ConfigMap::read_file(write_file("config_map_test.yaml", text));
}

const schema::Map& part() {
  static const schema::Map map = {
      .name = "part",
      .keys = {schema::optional("film", quantity("W/(m^2 K)", 0, 10), ""), schema::optional("ambient", temperature(), "")}};
  return map;
}

/// A key of each kind.
const schema::Map& all_kinds() {
  static const schema::Map entry = {.name = "entry", .keys = {compulsory("a", integer(0, 9), "")}};
  static const schema::Map map = {
      .name = "all kinds",
      .keys = {
          schema::optional("name", text(), "x", ""), schema::optional("length", quantity("m", 0, 1), 0.5, ""),
          schema::optional("count", integer(0, 100), 3, ""), schema::optional("ambient", temperature(), ""),
          schema::optional("at", schema::vector3("m"), ""),
          schema::optional("rows", rows({quantity("s"), quantity("rpm", 0, 5000)}), ""),
          schema::optional("part", schema::map(part()), ""), schema::optional("list", schema::maps(entry), ""),
          schema::optional("kind", choice({"a", "b"}), "b", ""), schema::optional("axes", list(choice({"x", "y"}), 1), ""),
          schema::optional("spring", quantity_or_zero("N/m", 1e3, 1e13), ""), schema::optional("lid", flag(), "false", "")}};
  return map;
}

TEST(ConfigMap, ReadsWhatStandsThere) {
  const ConfigMap in = read(
                           "name: mill\nlength: 80 mm\ncount: 010\nambient: 20 degC\nat: [10 mm, 0 mm, 1.2 m]\n"
                           "rows: [[30 min, 2000 rpm], [1 h, 0 rpm]]\npart: {film: 5 W/(m^2 K)}\nlist: [{a: 1}, {a: 2}]\n"
                           "axes: [y, x]\nspring: 0 N/m\nlid: true\n")
                           .described_by(all_kinds());
  EXPECT_EQ(in.text("name"), "mill");
  EXPECT_DOUBLE_EQ(in.quantity("length"), 0.08);
  EXPECT_EQ(in.integer("count"), 10);  // not eight
  EXPECT_DOUBLE_EQ(in.quantity("ambient"), 293.15);
  EXPECT_TRUE(in.vector3("at").isApprox(Eigen::Vector3d(0.01, 0, 1.2), 1e-15));
  EXPECT_EQ(in.rows("rows"), (std::vector<std::vector<double>>{{1800, 2000}, {3600, 0}}));
  EXPECT_EQ(in.map("part").quantity("film"), 5.0);
  ASSERT_EQ(in.maps("list").size(), 2u);
  EXPECT_EQ(in.maps("list")[1].integer("a"), 2);
  EXPECT_EQ(in.texts("axes"), (std::vector<std::string>{"y", "x"}));
  EXPECT_EQ(in.quantity("spring"), 0.0);
  EXPECT_TRUE(in.flag("lid"));
  EXPECT_EQ(in.choice("kind"), "b");
  EXPECT_NO_THROW(in.reject_unknown_keys());
}

TEST(ConfigMap, FallbacksStandForMissingKeysAlone) {
  const ConfigMap in = read("{}").described_by(all_kinds());
  EXPECT_EQ(in.quantity("length"), 0.5);
  EXPECT_EQ(in.quantity("length", 0.7), 0.7) << "what the reader knows from elsewhere comes first";
  EXPECT_EQ(in.integer("count"), 3);
  EXPECT_EQ(in.text("name"), "x");
  EXPECT_EQ(in.choice("kind"), "b");
  EXPECT_FALSE(in.flag("lid"));
  EXPECT_TRUE(in.maps("list").empty());
  EXPECT_FALSE(in.optional_map("part").has_value());
  const ConfigMap wrong = read("length: wrong\n").described_by(all_kinds());
  EXPECT_THROW((void)wrong.quantity("length"), InputError);
}

TEST(ConfigMap, WhatIsDescribedAndWhatIsReadAreTheSame) {
  const ConfigMap in = read("film: 5 W/(m^2 K)\n").described_by(part());
  EXPECT_THROW((void)in.has("flim"), std::logic_error) << "no description has it";
  EXPECT_THROW((void)in.integer("film"), std::logic_error) << "described as another kind";
  EXPECT_THROW((void)read("film: 5 W\n").quantity("film"), std::logic_error) << "no description at all";
  (void)in.quantity("film");
  EXPECT_THROW(in.reject_unknown_keys(), std::logic_error) << "nobody has read `ambient`";
}

TEST(ConfigMap, UnknownKeyIsNamedWithItsPlaceAndTheNearestKnownOne) {
  const ConfigMap in = read("name: a\npart:\n  film: 5 W/(m^2 K)\n  ambeint: 24 degC\n").described_by(all_kinds());
  EXPECT_THAT(
      [&] { in.map("part").reject_unknown_keys(); },
      ThrowsMessage<InputError>(AllOf(HasSubstr("config_map_test.yaml:4:3: unknown key 'ambeint'"),
                                      HasSubstr("film, ambient"), HasSubstr("Did you mean 'ambient'?"),
                                      HasSubstr("[part.ambeint]"), HasSubstr("\n    4 |   ambeint: 24 degC\n      |   ^"))));
}

TEST(ConfigMap, AKeyFarFromAllOthersGetsNoSuggestion) {
  EXPECT_THAT([&] { read("elephant: 1\n").described_by(part()).reject_unknown_keys(); },
              ThrowsMessage<InputError>(::testing::Not(HasSubstr("Did you mean"))));
}

TEST(ConfigMap, KeysThatDependOnEachOtherAreLookedAtFirst) {
  const auto with = [](Group::Rule rule) {
    schema::Map map{.name = "group", .groups = {{rule, {"a", "b", "c"}, "not so"}}};
    for (const char* key : {"a", "b", "c"}) map.keys.push_back(schema::optional(key, text(), ""));
    return map;
  };
  const auto is_fine = [](const std::string& yaml, const schema::Map& map) {
    try {
      (void)read(yaml).described_by(map);
      return true;
    } catch (const InputError&) {
      return false;
    }
  };
  const std::string none = "{}", first = "a: 1", second = "b: 1", two = "{a: 1, b: 1}", all = "{a: 1, b: 1, c: 1}";
  struct Expected {
    Group::Rule rule;
    bool none, first, second, two, all;
  };
  for (const Expected& e : {Expected{Group::Rule::kExactlyOne, false, true, true, false, false},
                            Expected{Group::Rule::kAtLeastOne, false, true, true, true, true},
                            Expected{Group::Rule::kAtMostOne, true, true, true, false, false},
                            Expected{Group::Rule::kAllOrNone, true, false, false, false, true},
                            Expected{Group::Rule::kWantFirst, true, true, false, true, true}}) {
    SCOPED_TRACE(static_cast<int>(e.rule));
    const schema::Map map = with(e.rule);
    EXPECT_EQ(is_fine(none, map), e.none);
    EXPECT_EQ(is_fine(first, map), e.first);
    EXPECT_EQ(is_fine(second, map), e.second);
    EXPECT_EQ(is_fine(two, map), e.two);
    EXPECT_EQ(is_fine(all, map), e.all);
  }
}

TEST(ConfigMap, OfSeveralFormsTheOneWhoseConditionHolds) {
  const std::vector<schema::Map> forms = {
      {.name = "file", .keys = {compulsory("csv", text(), "")}, .when_key = "csv"},
      {.name = "round", .keys = {compulsory("type", choice({"round"}), "")}, .when_key = "type", .when_word = "round"},
      {.name = "square", .keys = {compulsory("type", choice({"square"}), "")}, .when_key = "type", .when_word = "square"}};
  EXPECT_EQ(read("csv: a").described_by(forms).description().name, "file");
  EXPECT_EQ(read("type: square").described_by(forms).description().name, "square");
  EXPECT_REFUSED(read("type: oval").described_by(forms), "write one of round, square instead");
  EXPECT_REFUSED(read("a: b").described_by(forms), "key 'type' is missing");
}

TEST(ConfigMap, AllCompulsoryKeysThatAreMissingAreNamedAtOnce) {
  using namespace schema;
  const Map form = {.name = "form",
                    .keys = {compulsory("a", text(), ""), compulsory("b", text(), ""), compulsory("c", text(), "")}};
  EXPECT_REFUSED(read("b: 1").described_by(form), "the keys 'a', 'c' are missing");
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
  EXPECT_REFUSED(GetParam().read(read(GetParam().text)), GetParam().message);
}

void nothing(const ConfigMap&) {}
/// Reads one key as it is described.
template <auto getter, const char* key>
void get(const ConfigMap& in) {
  (void)(in.described_by(all_kinds()).*getter)(key);
}
constexpr char kLength[] = "length", kCount[] = "count", kAmbient[] = "ambient", kKind[] = "kind", kAt[] = "at",
               kRows[] = "rows", kPart[] = "part", kList[] = "list", kName[] = "name", kAxes[] = "axes",
               kSpring[] = "spring";
constexpr double (ConfigMap::*kQuantityOf)(const std::string&) const = &ConfigMap::quantity;
constexpr std::string (ConfigMap::*kChoiceOf)(const std::string&) const = &ConfigMap::choice;
constexpr std::string (ConfigMap::*kTextOf)(const std::string&) const = &ConfigMap::text;
constexpr std::vector<std::vector<double>> (ConfigMap::*kRowsOf)(const std::string&) const = &ConfigMap::rows;
constexpr auto length = get<kQuantityOf, kLength>;
constexpr auto count = get<&ConfigMap::integer, kCount>;

INSTANTIATE_TEST_SUITE_P(
    Each, ConfigMapErrors,
    ::testing::Values(
        Bad{"a: 1\nb: 2\na: 3\n", nothing, ":3:1: key 'a' appears twice"},
        Bad{"part:\n  a: 1\n  a: 2\n", nothing, ":3:3: key 'a' appears twice"},
        Bad{"list: [{a: 1, a: 2}]\n", nothing, "appears twice"},
        Bad{"list: [{}]\n", get<&ConfigMap::maps, kList>, ":1:8: key 'a' is missing"},
        Bad{"name: 1\nlength: 80\n", length, ":2:9: '80' has no unit"},
        Bad{"length: 0,8 m\n", length, "decimals need a point: 0.8 m, not 0,8 m"},
        Bad{"{length: 0,8 m}\n", length, "decimals need a point: 0.8 m"},
        Bad{"length: .nan m\n", length, ":1:9: '.nan m' is not a number"},
        Bad{"length: nan m\n", length, "not a finite number"},
        Bad{"length: 2 m\n", length, "outside what is allowed, 0 to 1 m"},
        Bad{"length: [1 m]\n", length, "this must be a single value"},
        Bad{"length:\n", length, "the value is empty. Give one"},
        Bad{"count: 101\n", count, "'101' must be a whole number from 0 to 100"},
        Bad{"count: 2.5\n", count, "must be a whole number"}, Bad{"count: .nan\n", count, "must be a whole number"},
        Bad{"count: 99999999999999\n", count, "must be a whole number"},
        Bad{"ambient: -300 degC\n", get<kQuantityOf, kAmbient>,
            "-300 degC lies outside what is allowed, -272.15 to 2726.85 degC"},
        Bad{"kind: c\n", get<kChoiceOf, kKind>, "write one of a, b instead"},
        Bad{"axes: [x, w]\n", get<&ConfigMap::texts, kAxes>, ":1:11: 'w' is not known here; write one of x, y instead"},
        Bad{"axes: []\n", get<&ConfigMap::texts, kAxes>, "at least 1 are required"},
        Bad{"spring: 1 N/m\n", get<kQuantityOf, kSpring>, "1 N/m lies outside what is allowed, 0 N/m or 1000 to 1e+13 N/m"},
        Bad{"at: [1 m, 2 m]\n", get<&ConfigMap::vector3, kAt>, "three quantities"},
        Bad{"rows: [[1 s]]\n", get<kRowsOf, kRows>, "rows of [s, rpm]"},
        Bad{"rows: [[1 s, 6000 rpm]]\n", get<kRowsOf, kRows>, ":1:14: 6000 rpm lies outside what is allowed, 0 to 5000 rpm"},
        Bad{"rows: []\n", get<kRowsOf, kRows>, "at least one"},
        Bad{"part: 3\n", get<&ConfigMap::map, kPart>, "this must be a map of keys"},
        Bad{"list: {}\n", get<&ConfigMap::maps, kList>, "this must be a list of maps"},
        Bad{"name: ''\n", get<kTextOf, kName>, "the value is empty"}, Bad{"a: [1\n", nothing, "not valid YAML"},
        Bad{"- a\n", nothing, "this is not a scenario"}, Bad{"[a, b]: 1\n", nothing, "a key must be a word"}));

TEST(ConfigMap, RefusesAMissingFile) {
  EXPECT_REFUSED(ConfigMap::read_file("/nowhere/x.yaml"), "cannot be opened");
}

}  // namespace
}  // namespace driftwright::config_map_test
