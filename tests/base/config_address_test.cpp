#include "base/config_address.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/config_map.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::config_address_test {
namespace {

using ::testing::AllOf, ::testing::HasSubstr, ::testing::ThrowsMessage;

const char* const kText = R"(ambient: [[0 h, 22 degC], [4 h, 23 degC]]
materials:
  part: steel
  part.1: iron
effects:
  - {type: node, node: shaft, capacity: 5 kJ/K}
  - {type: link, node: shaft, to: housing, conductance: 15 W/K}
  - {type: link, node: shaft, to: ambient, conductance: 1 W/K}
  - {type: convection, surface: a@b, film: 7 W/(m^2 K)}
numbers: [1, 2]
empty: []
)";

ConfigNodePtr tree() {
  static const ConfigNodePtr root = read_config_tree(write_file("config_address_test.yaml", kText));
  return root;
}

std::string text_at(const std::string& address) {
  const ConfigNode* node = tree().get();
  for (const std::size_t step : find_address(*tree(), address, {})) node = node->items[step].get();
  return node->text;
}

TEST(Address, FindsByNumberKeyAndName) {
  EXPECT_EQ(text_at("ambient[1][1]"), "23 degC");
  EXPECT_EQ(text_at("effects[0].capacity"), "5 kJ/K");
  EXPECT_EQ(text_at("effects[node].capacity"), "5 kJ/K");
  EXPECT_EQ(text_at("effects[housing].conductance"), "15 W/K");
  EXPECT_EQ(text_at("effects[link@shaft@ambient].conductance"), "1 W/K");
  EXPECT_EQ(text_at("effects[ambient@link].conductance"), "1 W/K");  // in any order
}

TEST(Address, TakesTheLongestKeyAndNamesWithAnAt) {
  EXPECT_EQ(text_at("materials.part"), "steel");
  EXPECT_EQ(text_at("materials.part.1"), "iron");
  EXPECT_EQ(text_at("effects[a@b].film"), "7 W/(m^2 K)");
}

struct Bad {
  const char* address;
  const char* message;
};
class AddressErrors : public ::testing::TestWithParam<Bad> {};

TEST_P(AddressErrors, NameThePlaceOfTheAddressAndWhatThereIs) {
  EXPECT_THAT(
      [] {
        (void)find_address(*tree(), GetParam().address, Where{"study.yaml", 7, 3, "vary[0].key", ""});
      },
      ThrowsMessage<InputError>(AllOf(HasSubstr("study.yaml:7:3: "), HasSubstr(GetParam().message))));
}

INSTANTIATE_TEST_SUITE_P(
    Each, AddressErrors,
    ::testing::Values(
        Bad{"efects[0]", "no key 'efects'; there are ambient, materials, effects, numbers, empty. Did you mean 'effects'?"},
        Bad{"effects[0].capacty",
            "'effects[0]' has no key 'capacty'; there are type, node, capacity. Did you mean 'capacity'?"},
        Bad{"effects[9]", "'effects' has 4 entries, [0] to [3]"}, Bad{"effects[99999999999999999999]", "has 4 entries"},
        Bad{"empty[0]", "'empty' is an empty list"}, Bad{"effects[lnk@shaft]", "no entry of 'effects' is named 'lnk@shaft'"},
        Bad{"effects[lnk@shaft]", "Did you mean 'link@shaft'?"},
        Bad{"effects[link]",
            "2 entries of 'effects' are named 'link': [1] link@shaft@housing (line 7), [2] link@shaft@ambient"},
        Bad{"numbers[two]", "entries of 'numbers' have no names"}, Bad{"materials[0]", "'materials' is no list"},
        Bad{"materials.part.density", "'materials.part' is no map and has no key 'density'"},
        Bad{"effects[0", "a number or a name is required between [ and ]"},
        Bad{"effects[]", "a number or a name is required"}, Bad{"effects[0]capacity", "a dot is required before 'capacity'"},
        Bad{"effects[0].", "a key is required after each dot"}, Bad{"", "has no key ''"}));

TEST(EditedTree, SharesTheRestAndKeepsTheLinesOfBoth) {
  const ConfigNodePtr study = read_config_tree(write_file("config_address_study.yaml", "values:\n  - -3 W/K\n"));
  const ConfigNodePtr value = study->find("values")->items[0];
  const ConfigNodePtr edited = replaced(tree(), find_address(*tree(), "effects[2].conductance", {}), value);
  EXPECT_EQ(edited->items[0], tree()->items[0]) << "what was not edited is shared";
  EXPECT_EQ(text_at("effects[2].conductance"), "1 W/K") << "the old tree stays as it was";
  const ConfigMap in = ConfigMap::of_tree(edited);
  const schema::Map link = {.name = "link",
                            .keys = {schema::compulsory("conductance", schema::quantity("W/K", 0, 100), "")}};
  EXPECT_EQ(in.maps("effects")[1].described_by(link).quantity("conductance"), 15.0);
  EXPECT_THAT([&] { (void)in.maps("effects")[2].described_by(link).quantity("conductance"); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("config_address_study.yaml:2:5: -3 W/K lies outside"),
                                              HasSubstr("[effects[2].conductance]"), HasSubstr("2 |   - -3 W/K"))));
  EXPECT_REFUSED(in.maps("effects")[2].text("film"), "config_address_test.yaml:8:5: key 'film' is missing");
}

TEST(ConfigTree, AnAliasStandsForItsAnchorAndNeverForItself) {
  const ConfigNodePtr root = read_config_tree(write_file("alias.yaml", "a: &x {b: 1}\nc: *x\n"));
  EXPECT_EQ(root->items[0], root->items[1]);
  EXPECT_REFUSED(read_config_tree(write_file("alias.yaml", "a: &x [*x]\n")), ":1:8: an alias is used inside its own anchor");
}

}  // namespace
}  // namespace driftwright::config_address_test
