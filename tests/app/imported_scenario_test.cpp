// A scenario whose mesh is a file, through the program as a user runs it.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/record.hpp"
#include "tests/shared/column_and_head.hpp"
#include "tests/shared/command_line.hpp"

namespace driftwright::imported_scenario_test {
namespace {

using fixtures::column_and_head, fixtures::inp_text;
using ::testing::AllOf, ::testing::ContainsRegex, ::testing::HasSubstr, ::testing::Not;

const char* const kScenario = R"(name: imported
reference_temperature: 20 degC
machine:
  mesh: parts/machine.inp
  units: mm
  surfaces:
    - {name: foot, region: column, plane: {through: [0 mm, 0 mm, 0 mm], normal: [0, 0, -1]}}
    - {name: column_top, region: column, plane: {through: [0 mm, 0 mm, 300 mm], normal: [0, 0, 1]}}
    - {name: head_bottom, region: head, plane: {through: [0 mm, 0 mm, 300 mm], normal: [0, 0, -1]}}
    - {name: outside, remaining: true}
  joints:
    - {name: column/head, a: column_top, b: head_bottom}
materials: {column: cast_iron_gjl250, head: cast_iron_gjl250}
supports:
  - {surface: foot, fixed: [x, y, z]}
effects:
  - {type: heat_source, region: head, power: 20 W, at_speed: 1000 rpm, exponent: 1}
  - {type: convection, surface: outside, film: 10 W/(m^2 K)}
  - {type: contact, joint: column/head, conductance: 2000 W/(m^2 K)}
ambient: [[0 min, 20 degC]]
sensors:
  - {name: t1, region: head, at: [50 mm, 150 mm, 400 mm]}
displacements:
  - {name: z, along: z, tool: {region: head, at: [50 mm, 200 mm, 350 mm]}, table: {region: column, at: [50 mm, 100 mm, 0 mm]}}
cyclograms:
  warm_up: [[1000 h, 1000 rpm]]
solver: {output_interval: 100 h}
)";

std::filesystem::path write_scenario(const std::string& name, std::string scenario, const std::string& inp) {
  const auto folder = fresh_folder(name);
  std::filesystem::create_directories(folder / "parts");
  std::ofstream(folder / "parts" / "machine.inp") << inp;
  std::ofstream(folder / "scenario.yaml") << scenario;
  return folder;
}

TEST(ImportedScenario, IsCheckedMeshedAndSimulated) {
  const auto folder = write_scenario("imported", kScenario, inp_text(column_and_head()));
  const std::string scenario = (folder / "scenario.yaml").string();
  const CommandOutcome check = run_program("check " + scenario);
  EXPECT_EQ(check.exit_code, 0) << check.output;
  EXPECT_THAT(check.output, ContainsRegex("cells +28\n +regions +2\n +joints +1\n"));

  const CommandOutcome outcome = run_program("simulate " + scenario + " -o " + (folder / "out").string());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("fields in fields.pvd"), Not(HasSubstr("note:"))));  // few times, as vtu
  const Record record = read_record_csv((folder / "out" / "record.csv").string());
  // Steady: 20 W leave through 10 W/(m^2 K) on the outside, 4 x 0.03 + (2 x 0.01 + 2 x 0.02 + 0.02 + 0.01) = 0.21 m^2:
  // 9.52 K on its average. The head is warmer than the column, and iron conducts well: within 4 K of it.
  const double t1_degC = record.at("t1").values.back();
  EXPECT_GT(t1_degC, 20.0 + 20.0 / (10 * 0.21));
  EXPECT_LT(t1_degC, 24.0 + 20.0 / (10 * 0.21));
  // 300 mm of column and 50 mm of head, 11e-6 1/K or so, at 9 K: some 35 um.
  EXPECT_NEAR(record.at("z").values.back(), 35.0, 10.0);
}

TEST(ImportedScenario, ReadsTheMeshThatTheProgramWrote) {
  const auto folder = write_scenario("rewritten", kScenario, inp_text(column_and_head()));
  const std::string out = (folder / "out").string();
  const CommandOutcome first = run_program("mesh " + (folder / "scenario.yaml").string() + " -o " + out);
  ASSERT_EQ(first.exit_code, 0) << first.output;
  std::string text = kScenario;
  const auto from = text.find("  mesh: parts"), to = text.find("materials:");
  text.replace(from, to - from, "  mesh: out/mesh.vtu\n  units: m\n");
  std::ofstream(folder / "again.yaml") << text;
  const CommandOutcome again = run_program("mesh " + (folder / "again.yaml").string() + " -o " + out + "2");
  ASSERT_EQ(again.exit_code, 0) << again.output;
  EXPECT_EQ(again.output.substr(0, again.output.find("results in")),
            first.output.substr(0, first.output.find("results in")));
}

TEST(ImportedScenario, FieldsFormatChoosesTheFilesAndTheTerminalNamesTheOneToOpen) {
  const auto folder = write_scenario("fields_format", kScenario, inp_text(column_and_head()));
  const std::string solver = "solver: {output_interval: 100 h}";
  const auto run = [&](const std::string& name, const std::string& settings) {
    std::string text = kScenario;
    text.replace(text.find(solver), solver.size(), "solver: {" + settings + "}");
    std::ofstream(folder / (name + ".yaml")) << text;
    const CommandOutcome outcome =
        run_program("simulate " + (folder / (name + ".yaml")).string() + " -o " + (folder / name).string());
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    return outcome.output;
  };
  const std::string vtu = run("vtu", "output_interval: 9 h, fields_every: 9 h, fields_format: vtu");
  EXPECT_THAT(vtu, AllOf(HasSubstr("fields in fields.pvd"), HasSubstr("note: fields at 113 times"),
                         HasSubstr("fields_format: xdmf")));
  EXPECT_TRUE(std::filesystem::exists(folder / "vtu/fields/fields_0112.vtu"));
  const std::string xdmf = run("xdmf", "output_interval: 9 h, fields_every: 9 h, fields_format: xdmf");
  EXPECT_THAT(xdmf, AllOf(HasSubstr("fields in fields.xdmf"), Not(HasSubstr("note:"))));
  EXPECT_THAT(read_text(folder / "xdmf/fields.xdmf"), HasSubstr("fields.h5:/times/0112/temperature_degC"));
  EXPECT_TRUE(std::filesystem::exists(folder / "xdmf/fields.h5"));
  EXPECT_FALSE(std::filesystem::exists(folder / "xdmf/fields.pvd"));
  const std::string none = run("none", "output_interval: 9 h, fields_every: 9 h, fields_format: none");
  EXPECT_THAT(none, AllOf(Not(HasSubstr("fields in")), Not(HasSubstr("name one cyclogram")), Not(HasSubstr("note:"))));
  for (const char* left : {"fields", "fields.pvd", "fields.xdmf", "fields.h5"}) {
    EXPECT_FALSE(std::filesystem::exists(folder / "none" / left)) << left;
  }
  // Fields are written of the run, they are no part of it.
  const Record with = read_record_csv((folder / "vtu/record.csv").string());
  const Record without = read_record_csv((folder / "none/record.csv").string());
  ASSERT_EQ(with.n_samples(), without.n_samples());
  for (const char* channel : {"t1", "z"}) EXPECT_EQ(with.at(channel).values, without.at(channel).values);
}

TEST(ImportedScenario, AFilmInsideABodyIsRefused) {
  std::string inp = inp_text(column_and_head());
  inp += "*SURFACE, NAME=inner\n100, S2\n";  // upper face of the lowest element of the column, under another one
  std::string text = kScenario;
  text.replace(text.find("surface: outside, film"), 22, "surface: inner, film");
  const auto folder = write_scenario("inner_film", text, inp);
  const CommandOutcome outcome = run_program("check " + (folder / "scenario.yaml").string());
  EXPECT_EQ(outcome.exit_code, 2) << outcome.output;
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("surface 'inner' lies inside a body at ["), HasSubstr("effects[1].surface")));
}

struct Mistake {
  const char* name;
  const char* right;
  const char* wrong;
  std::vector<const char*> message;
};
class BadImport : public ::testing::TestWithParam<Mistake> {};

TEST_P(BadImport, EndsWithTwoAndSaysWhy) {
  std::string files[] = {kScenario, inp_text(column_and_head())};
  bool found = false;
  for (std::string& text : files) {
    const auto at = text.find(GetParam().right);
    if (at == std::string::npos) continue;
    text.replace(at, std::string(GetParam().right).size(), GetParam().wrong);
    found = true;
    break;
  }
  ASSERT_TRUE(found);
  const auto folder = write_scenario(std::string("bad_") + GetParam().name, files[0], files[1]);
  const CommandOutcome outcome = run_program("check " + (folder / "scenario.yaml").string());
  EXPECT_EQ(outcome.exit_code, 2) << outcome.output;
  for (const char* part : GetParam().message) EXPECT_THAT(outcome.output, HasSubstr(part));
}

INSTANTIATE_TEST_SUITE_P(
    Each, BadImport,
    ::testing::Values(
        Mistake{"no_unit", "  units: mm\n", "", {"key 'units' is missing", "scenario.yaml:"}},
        Mistake{"wrong_unit", "units: mm", "units: m", {"400 m large", "unit mm (0.4 m)?"}},
        Mistake{"other_unit", "units: mm", "units: furlong", {"'furlong' is not known here", "inch"}},
        Mistake{"no_file", "parts/machine.inp", "parts/nowhere.inp", {"there is no file", "parts/nowhere.inp"}},
        Mistake{
            "other_format", "parts/machine.inp", "parts/machine.cdb", {"'.cdb' files cannot be read", ".msh, .inp, .vtu"}},
        Mistake{"step_key",
                "  units: mm\n",
                "  units: mm\n  element_order: 2\n",
                {"this key is for STEP files", "machine.element_order"}},
        Mistake{"unknown_region_of_pick",
                "foot, region: column",
                "foot, region: colum",
                {"no region 'colum'; there are column, head"}},
        Mistake{"unknown_region",
                "materials: {column:",
                "materials: {colunm:",
                {"no region 'colunm'", "Did you mean 'column'?"}},
        Mistake{"two_picks", "remaining: true}", "remaining: true, cylinder: {}}", {"one of plane, cylinder and remaining"}},
        Mistake{"no_normal", "normal: [0, 0, -1]", "normal: [0, 0, 0]", {"the direction must have a length above zero"}},
        Mistake{"joint_without_contact",
                "  - {type: contact, joint: column/head, conductance: 2000 W/(m^2 K)}\n",
                "",
                {"joint 'column/head' has no contact"}},
        Mistake{"element_type",
                "TYPE=C3D20, ELSET=column",
                "TYPE=C3D20X, ELSET=column",
                {"elements of type c3d20x are not computed with"}},
        Mistake{"contact_twice",
                "  - {type: contact, joint: column/head, conductance: 2000 W/(m^2 K)}\n",
                "  - {type: contact, joint: column/head, conductance: 2000 W/(m^2 K)}\n"
                "  - {type: contact, joint: column/head, conductance: 2000 W/(m^2 K)}\n",
                {"contact column/head is given twice there"}},
        Mistake{"fields_after_the_end",
                "output_interval: 100 h",
                "output_interval: 100 h, fields_at: [1 h, 2000 h]",
                {"`fields_at` names 120000 min", "ends at 60000 min"}},
        Mistake{"joint_of_itself", "b: head_bottom", "b: column_top", {"share nodes"}},
        Mistake{"at_in_name", "name: outside, remaining", "name: out@side, remaining", {"'@' marks the sides of joints"}},
        Mistake{"inverted", "\n100, 10, 11,", "\n100, 11, 10,", {"element 100 in region 'column' is inverted"}}),
    [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace driftwright::imported_scenario_test
