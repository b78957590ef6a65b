// `hall` of earlier releases is read as `ambient`, with a note for each place; both at once, and ambiguous words, are
// refused.

#include "effects/former_words.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>

#include "base/config_map.hpp"
#include "base/config_text.hpp"
#include "machine/machine_key.hpp"
#include "scenarios/reader/scenario.hpp"
#include "scenarios/reader/sweep_plan.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::scenarios::former_words_test {
namespace {

using effects::FormerWord;
using effects::in_present_words;
using effects::name_in_present_words;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A scenario as an earlier release had it.
std::string in_former_words(std::string text) {
  text = std::regex_replace(text, std::regex(R"((^|\n)ambient:)"), "$1hall:");
  return std::regex_replace(text, std::regex(R"(\b(to|node|start|surrounding|body|follows): ambient\b)"), "$1: hall");
}

std::string of_effects(const std::vector<effects::Effect>& list) {
  std::string text;
  for (const effects::Effect& e : list) text += effects::yaml_of(e) + "\n";
  return text;
}

std::vector<std::string> presents(const std::vector<FormerWord>& found) {
  std::vector<std::string> texts;
  for (const FormerWord& word : found) texts.push_back(word.present);
  return texts;
}

const std::string kMachine = R"(name: lump
reference_temperature: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: body, capacity: 4 kJ/K}
  - {type: link, node: body, to: ambient, conductance: 5 W/K}
  - {type: sensor_place, sensor: hall, share: 0.1, body: ambient}
  - {type: changed_law, law: link body - ambient, factor: 1.2}
  - {type: displacement_path, displacement: z, sensitivity: 1 um/K, body: {node: ambient}}
start: ambient
ambient: [[0 h, 22 degC]]
sensors: [{name: hall, node: ambient}, {name: t, node: body}]
displacements: [{name: z, sensitivities: [{node: body, sensitivity: 2 um/K}]}]
cyclograms: {rest: [[1 h, 0 rpm]]}
)";

std::string lump_in_former_words() {
  std::string text = in_former_words(kMachine);
  return std::regex_replace(text, std::regex("body - ambient"), "body - hall");
}

TEST(FormerWords, AreFoundWhereverTheyNamedTheAmbientAndNowhereElse) {
  std::vector<FormerWord> found;
  const ConfigNodePtr tree = in_present_words(read_config_text(lump_in_former_words(), "lump.yaml"), found);
  EXPECT_EQ(written(*tree), written(*read_config_text(kMachine, "lump.yaml")));  // the sensor keeps its name
  EXPECT_THAT(presents(found), ElementsAre("to: ambient", "body: ambient", "law: link body - ambient", "node: ambient",
                                           "start: ambient", "ambient: ...", "node: ambient"));
  EXPECT_EQ(found[0].where.line, 6);
  EXPECT_EQ(found[5].where.line, 11);
  std::vector<FormerWord> again;
  EXPECT_EQ(in_present_words(tree, again)->keys.size(), tree->keys.size());
  EXPECT_THAT(again, SizeIs(0));
}

TEST(FormerWords, EveryShippedScenarioReadsAsBefore) {
  int n = 0;
  for (const char* folder : {"scenarios", "scenarios/measured", "tests/blind/machines"}) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      if (entry.path().extension() != ".yaml") continue;
      const std::string present = text_of(entry.path());
      if (present.find("\nambient:") == std::string::npos) continue;  // a study
      SCOPED_TRACE(entry.path());
      const std::string former = in_former_words(present);
      ASSERT_NE(former, present);
      const auto beside = entry.path().parent_path() / "former_words_of_a_test.yaml";  // it may name files beside it
      std::vector<FormerWord> found;
      const Scenario a = read_scenario(entry.path().string());
      const Scenario b =
          read_scenario(ConfigMap::of_tree(in_present_words(read_config_text(former, beside.string()), found)));
      EXPECT_FALSE(found.empty());
      EXPECT_EQ(machine_text(*a.machine), machine_text(*b.machine));
      EXPECT_EQ(of_effects(a.machine->effects), of_effects(b.machine->effects));
      EXPECT_EQ(a.machine->ambient.time_s, b.machine->ambient.time_s);
      EXPECT_EQ(a.machine->ambient.value, b.machine->ambient.value);
      EXPECT_EQ(a.machine->start, b.machine->start);
      for (std::size_t s = 0; s < a.machine->sensors.size(); ++s)
        EXPECT_EQ(a.machine->sensors[s].place.index(), b.machine->sensors[s].place.index());
      ++n;
    }
  }
  EXPECT_GE(n, 15);
}

TEST(FormerWords, AreToldOnceWithWhatToWrite) {
  const std::string path = write_file("told.yaml", lump_in_former_words());
  ::testing::internal::CaptureStderr();
  (void)read_scenario(path);
  (void)read_scenario(path);
  const std::string told = ::testing::internal::GetCapturedStderr();
  EXPECT_EQ(std::count(told.begin(), told.end(), '\n'), 7) << told;
  EXPECT_THAT(told, AllOf(HasSubstr("note: " + path + ":6: `hall` is now called `ambient`; write `to: ambient`"),
                          HasSubstr(path + ":11: `hall` is now called `ambient`; write `ambient: ...`")));
}

TEST(FormerWords, BesideThePresentOneAreRefused) {
  const std::string both = write_file("both.yaml", kMachine + "hall: 20 degC\n");
  EXPECT_REFUSED(read_scenario(both), "both.yaml:15", "former name of `ambient`", "leave out one");
}

TEST(FormerWords, OfSweepsAreReadToo) {
  const std::string lump = write_file("lump.yaml", lump_in_former_words());
  ::testing::internal::CaptureStderr();
  const SweepPlan plan = read_sweep_plan(write_file("study.yaml", "name: s\nscenario: " + lump + R"(
design: list
vary:
  - {name: air, key: "hall[0][1]", values: [20 degC, 24 degC]}
  - {name: loss, key: "effects[link@body@hall].conductance", values: [5 W/K, 6 W/K]}
  - {name: begins, key: start, values: [hall, steady]}
  - {name: path, key: "effects[sensor_place].body", values: [hall, body]}
collect: [z.end]
)"));
  const std::string told = ::testing::internal::GetCapturedStderr();
  const Scenario member = read_scenario(plan.scenario_of(0));
  EXPECT_NEAR(member.machine->ambient.value[0], 0.0, 1e-9);
  EXPECT_EQ(member.machine->start, Start::kAmbient);
  EXPECT_EQ(member.machine->effects[2].references.at("body").name, "ambient");
  EXPECT_THAT(told, AllOf(HasSubstr("write `ambient[0][1]`"), HasSubstr("write `effects[link@body@ambient].conductance`")));
  EXPECT_EQ(plan.variations[2].values[0].label, "hall");  // the table's column says what the user wrote
}

TEST(FormerWords, OfFilesOfPredictorsAreReadAsNames) {
  EXPECT_EQ(name_in_present_words("hall"), "ambient");
  EXPECT_EQ(name_in_present_words("link body - hall"), "link body - ambient");
  EXPECT_EQ(name_in_present_words("town_hall"), "town_hall");
}

}  // namespace
}  // namespace driftwright::scenarios::former_words_test
