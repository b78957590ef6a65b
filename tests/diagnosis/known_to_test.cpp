// `known_to` of numbers of a scenario: how it is written, what a diagnosis makes of it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/errors.hpp"
#include "diagnosis/scatter.hpp"
#include "tests/shared/lumped_records.hpp"

namespace driftwright::diagnosis::known_to_test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

std::string machine(const std::string& link, const std::string& node = "capacity: 40 kJ/K") {
  return R"(name: two_nodes
reference_temperature: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: head, capacity: 6 kJ/K}
  - {type: node, node: column, )" +
         node + R"(}
  - {type: heat_source, node: head, power: 100 W, at_speed: 1000 rpm, exponent: 1.3}
  - {type: link, node: head, to: column, )" +
         link + R"(}
  - {type: link, node: column, to: ambient, conductance: 14 W/K}
ambient: [[0 min, 20 degC], [400 min, 21 degC]]
sensors:
  - {name: t_head, node: head}
  - {name: t_column, node: column}
cyclograms:
  monday: [[60 min, 600 rpm], [60 min, 1900 rpm], [40 min, 0 rpm], [80 min, 1000 rpm], [60 min, 1400 rpm]]
  tuesday: [[50 min, 1800 rpm], [70 min, 300 rpm], [60 min, 1000 rpm], [60 min, 0 rpm], [60 min, 2000 rpm]]
solver: {output_interval: 1 min}
)";
}

std::vector<std::string> records_of(const std::string& text) {
  return noisy_records(write_file("known_to_truth.yaml", text), "known_to_", {.seed = 3});
}

const Knob* knob(const std::vector<Knob>& list, const std::string& effect, const std::string& where) {
  for (const Knob& k : list) {
    if (k.effect == effect && k.where == where) return &k;
  }
  return nullptr;
}

TEST(KnownTo, IsThePriorOfANumber) {
  const std::vector<std::string> records = records_of(machine("conductance: 12 W/K"));
  const auto sd = [&](const std::string& link, const std::string& node, const std::string& effect,
                      const std::string& where) {
    const Beside beside(write_file("known_to.yaml", machine(link, node)), records);
    const Knob* k = knob(scatter(*beside.twin), effect, where);
    return k ? k->prior_sd : 0.0;
  };
  const std::string link = "conductance: 12 W/K", node = "capacity: 40 kJ/K";
  EXPECT_EQ(sd(link, node, "contact", "head,column"), 0.1);
  EXPECT_EQ(sd(link + ", known_to: 25 %", node, "contact", "head,column"), 0.25);
  EXPECT_NEAR(sd(link + ", known_to: {conductance: guess}", node, "contact", "head,column"), std::log(2.0), 1e-12);
  EXPECT_EQ(sd(link + ", known_to: fixed", node, "contact", "head,column"), 0.0);
  EXPECT_EQ(sd(link, node, "heat_capacity", "column"), 0.1);
  EXPECT_EQ(sd(link, node + ", known_to: 3 %", "heat_capacity", "column"), 0.03);
  EXPECT_EQ(sd(link, node + ", known_to: fixed", "heat_capacity", "column"), 0.0);
}

TEST(KnownTo, OfAMaterialIsThatOfItsBody) {
  std::ifstream shipped("scenarios/c_frame.yaml");
  std::string text{std::istreambuf_iterator<char>(shipped), {}};
  const std::string plain = "  base: mineral_casting\n";
  ASSERT_NE(text.find(plain), std::string::npos);
  const std::string parts = "parts/", there = std::filesystem::absolute("scenarios/parts").string() + "/";
  for (std::size_t at = text.find(parts); at != std::string::npos; at = text.find(parts, at + there.size()))
    text.replace(at, parts.size(), there);
  text.replace(text.find(plain), plain.size(),
               "  base: {like: mineral_casting, known_to: {conductivity: 2 %, expansion: fixed}}\n");
  const std::string path = write_file("known_material.yaml", text);
  try {
    const scenarios::Scenario s = scenarios::read_scenario(path);
    const scenarios::MaterialEntry& base = s.machine->materials[0];
    EXPECT_EQ(base.region, "base");
    EXPECT_EQ(effects::known_to(base.known_to, "conductivity", 0.1), 0.02);
    EXPECT_EQ(effects::known_to(base.known_to, "expansion", 0.1), 0.0);
    EXPECT_EQ(effects::known_to(base.known_to, "heat_capacity", 0.1), 0.1);
    EXPECT_EQ(base.material.conductivity_W_mK, solver::material_library().at("mineral_casting").conductivity_W_mK);
  } catch (const InputError& e) {
    FAIL() << e.what();
  }
}

TEST(KnownTo, AnotherWordIsRefusedWhereItStands) {
  const auto message = [](const std::string& link) -> std::string {
    try {
      (void)scenarios::read_scenario(write_file("known_to_wrong.yaml", machine(link)));
      return "";
    } catch (const InputError& e) {
      return e.what();
    }
  };
  EXPECT_THAT(message("conductance: 12 W/K, known_to: roughly"),
              HasSubstr("'roughly' does not say how well a number is known"));
  EXPECT_THAT(message("conductance: 12 W/K, known_to: 500 %"), HasSubstr("known_to"));
  EXPECT_THAT(message("conductance: 12 W/K, known_to: 3 W/K"), HasSubstr("known_to"));
  EXPECT_THAT(message("conductance: 12 W/K, known_to: {power: 5 %}"), HasSubstr("calibrates: conductance"));
  EXPECT_THAT(message("conductance: 12 W/K, known_to: 20 %"), IsEmpty());
}

// A link that is twice what is written is calibration where it was a guess, and a cause where it was known to 10 %.
TEST(KnownTo, SaysWhatIsCalibrationAndWhatIsACause) {
  const std::vector<std::string> records = records_of(machine("conductance: 24 W/K"));
  const Diagnosis guessed =
      Beside(write_file("guess.yaml", machine("conductance: 12 W/K, known_to: guess")), records).diagnosed();
  EXPECT_EQ(guessed.verdict, Verdict::kConsistent) << guessed.reason;
  const Diagnosis known = Beside(write_file("known.yaml", machine("conductance: 12 W/K")), records).diagnosed();
  EXPECT_EQ(known.verdict, Verdict::kNamed) << known.reason;
  ASSERT_THAT(known.causes, SizeIs(1));
  EXPECT_EQ(known.causes[0].where, "head,column");
}

}  // namespace
}  // namespace driftwright::diagnosis::known_to_test
