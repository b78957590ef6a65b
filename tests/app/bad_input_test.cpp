// Bad input ends with exit code 2 and one message that names file, line, key and what was expected; nothing is written.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/shared/command_line.hpp"
#include "tests/shared/edited_text.hpp"

namespace driftwright::bad_input_test {
namespace {

using ::testing::HasSubstr;

struct Mistake {
  const char* name;
  const char* right;  ///< text of the shipped scenario
  const char* wrong;  ///< what the user wrote instead
  std::vector<const char*> message;
};

class BadScenario : public ::testing::TestWithParam<Mistake> {};

TEST_P(BadScenario, EndsWithTwoNamesThePlaceAndWritesNothing) {
  const Mistake& mistake = GetParam();
  const auto folder = fresh_folder(std::string("bad_") + mistake.name);
  const auto scenario = folder / "scenario.yaml";
  const std::string coarser = fixtures::replaced(read_text("scenarios/fp3_spindle.yaml"), "frame: 80 mm, spindle: 20 mm",
                                                 "frame: 100 mm, spindle: 30 mm");
  std::ofstream(scenario) << fixtures::replaced(coarser, mistake.right, mistake.wrong);
  const CommandOutcome outcome = run_program("run " + scenario.string() + " -o " + (folder / "out").string());
  EXPECT_EQ(outcome.exit_code, 2) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr(scenario.string() + ":"));
  for (const char* part : mistake.message) EXPECT_THAT(outcome.output, HasSubstr(part));
  int n_files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder)) ++n_files;
  EXPECT_EQ(n_files, 1) << "something was written beside the scenario";
}

INSTANTIATE_TEST_SUITE_P(
    Each, BadScenario,
    ::testing::Values(
        Mistake{"unknown_key",
                "    f1: 0.0009",
                "    f_1: 0.0009",
                {"unknown key 'f_1'", "known keys:", "Did you mean 'f1'?", "effects[0].f_1", "|     ^"}},
        Mistake{"missing_key", "    power: 85 W\n", "", {"key 'power' is missing", "effects[2]"}},
        Mistake{"wrong_unit",
                "film: 10 W/(m^2 K)",
                "film: 10 W/K",
                {"wrong unit 'W/K'", "must be a quantity in W/(m^2 K)", "effects[8].film"}},
        Mistake{"no_unit", "power: 85 W", "power: 85", {"has no unit", "'85 W'"}},
        Mistake{"no_unit_of_a_rapid", "rapid: 2 m/min", "rapid: 15000", {"has no unit", "such as '15000 mm/min'"}},
        Mistake{"no_unit_of_a_slow_rapid", "rapid: 2 m/min", "rapid: 15", {"has no unit", "such as '15 m/min'"}},
        Mistake{"empty_supports",
                "  - {surface: foot, fixed: [x, y, z]}\n",
                "",
                {"the value is empty: what holds surfaces to the ground", "Give one, or leave the key out"}},
        Mistake{"difference_for_temperature",
                "absolute_tolerance: 5e-3 K",
                "absolute_tolerance: 5 degC",
                {"must be a temperature difference in K"}},
        Mistake{"not_a_number", "power: 85 W", "power: nan W", {"is not a finite number", "effects[2].power"}},
        Mistake{"out_of_range", "f0: 0.7 ", "f0: -1 ", {"outside what is allowed", "effects[0].f0"}},
        Mistake{"unknown_effect",
                "type: motor_loss",
                "type: motor_los",
                {"'motor_los' is not known here", "Did you mean 'motor_loss'?"}},
        Mistake{"unknown_material",
                "knee: cast_iron_gjl250",
                "knee: cast_iron",
                {"'cast_iron' is not known here", "cast_iron_gjl250"}},
        Mistake{"duplicate_key", "name: fp3_spindle", "name: fp3_spindle\nname: twice", {"key 'name' appears twice"}},
        Mistake{"no_yaml", "study:", "study: [", {"this is not valid YAML"}},
        Mistake{"empty_cyclogram",
                "  warm_up_2000: [[300 min, 2000 rpm]]",
                "  warm_up_2000: []",
                {"at least one", "cyclograms.warm_up_2000"}},
        Mistake{
            "negative_duration", "[[300 min, 2000 rpm]]", "[[-300 min, 2000 rpm]]", {"its duration must be 1 ms or more"}},
        Mistake{
            "judged_on_training", "judge: chaotic", "judge: heat_cool_1000", {"judged on a cyclogram it was not fitted on"}},
        Mistake{"unknown_cyclogram", "judge: chaotic", "judge: caotic", {"no cyclogram 'caotic'", "warm_up_2000"}},
        Mistake{"parts_do_not_fit", "bore: 95 mm", "bore: 130 mm", {"diameters must fall"}},
        Mistake{"tilt_about_its_line",
                "name: tilt_x, about: x",
                "name: tilt_x, about: y",
                {"a line does not tilt about itself"}},
        Mistake{"positions_without_a_table",
                "1320 mm]}, table: {region: table, at: [120 mm, 320 mm, 840 mm]}}",
                "1320 mm]}, positions: {axis: x, at: [0 mm]}}",
                {"positions of the table", "displacements[0].positions"}},
        Mistake{
            "fields_of_no_format", "  fields_format: vtu", "  stresses: true\n  fields_format: none", {"without fields"}},
        Mistake{"target_as_candidate",
                "  judge: chaotic",
                "  candidates: [t01, t02, t03, drift_y]\n  judge: chaotic",
                {"cannot predict itself"}},
        Mistake{"unknown_candidate",
                "  judge: chaotic",
                "  candidates: [t01, t02, t03, t99]\n  judge: chaotic",
                {"no sensor 't99'"}},
        Mistake{"too_few_candidates",
                "  judge: chaotic",
                "  candidates: [t01, t02]\n  judge: chaotic",
                {"4 of 2 sensors cannot be chosen"}},
        Mistake{"name_leads_out", "name: fp3_spindle", "name: ../evil", {"'../evil' is no name"}},
        Mistake{"sensor_named_speed", "{name: t01,", "{name: speed,", {"column of every record"}},
        Mistake{"sensor_name_twice", "{name: t02,", "{name: t01,", {"'t01' is used twice"}},
        Mistake{"ambient_beyond_reason",
                "[0 min, 20.0 degC]",
                "[0 min, -300 degC]",
                {"-300 degC lies outside what is allowed, -73.15 to 126.85 degC", "[ambient]"}},
        Mistake{"ambient_backwards", "[120 min, 20.2 degC]", "[0 min, 20.2 degC]", {"times must increase"}},
        Mistake{
            "trained_twice", "train: [heat_cool_1000, ", "train: [heat_cool_1000, heat_cool_1000, ", {"is listed twice"}},
        Mistake{"judged_on_a_copy",
                "  warm_up_2000: [[300 min, 2000 rpm]]\n  chaotic: [[40 min, 1250 rpm]",
                "  chaotic: [[240 min, 1000 rpm], [420 min, 0 rpm]]\n  other: [[40 min, 1250 rpm]",
                {"judged on a cyclogram it was not fitted on"}},
        Mistake{"law_out_of_range",
                "[300 min, 2000 rpm]",
                "[300 min, 90000 rpm]",
                {"Reynolds number", "rotating_cylinder spindle_nose", "90000 rpm", "warm_up_2000"}},
        Mistake{"too_long", "[300 min, 2000 rpm]", "[1e9 h, 2000 rpm]", {"rows of output"}},
        Mistake{"no_support", "  - {surface: foot, fixed: [x, y, z]}", "  []", {"no support"}},
        Mistake{"bad_direction",
                "fixed: [x, y, z]",
                "fixed: [x, y, w]",
                {"'w' is not known here; write one of x, y, z instead"}},
        Mistake{"support_without_a_way", "fixed: [x, y, z]", "", {"how is this surface held?", "supports[0]"}},
        Mistake{"sliding_is_a_choice", "fixed: [x, y, z]", "sliding: yes", {"write one of true, false instead"}},
        Mistake{"spring_with_wrong_unit", "fixed: [x, y, z]", "springs: [1 N, 1 N/m, 1 N/m]", {"wrong unit 'N'"}},
        Mistake{"spring_too_soft",
                "fixed: [x, y, z]",
                "springs: [1 N/m, 0 N/m, 1 N/um]",
                {"1 N/m lies outside what is allowed, 0 N/m or 1000 to 1e+13 N/m", "supports[0].springs"}},
        Mistake{"joint_in_two_ways",
                "\nsupports:",
                "\njoints: [{name: knee/table, mechanics: tied, normal_stiffness: 1e9 N/m}]\nsupports:",
                {"one of `mechanics:", "joints[0].normal_stiffness"}},
        Mistake{"joint_with_half_its_springs",
                "\nsupports:",
                "\njoints: [{name: knee/table, normal_stiffness: 1e9 N/m}]\nsupports:",
                {"key 'tangential_stiffness' is missing", "joints[0]"}},
        Mistake{"negative_stiffness",
                "\nsupports:",
                "\njoints: [{name: knee/table, normal_stiffness: -1e9 N/m, tangential_stiffness: nan N/m}]\nsupports:",
                {"-1e+09 N/m lies outside", "joints[0].normal_stiffness"}},
        Mistake{"fields_format_is_a_choice",
                "fields_format: vtu",
                "fields_format: vtk",
                {"write one of vtu, xdmf, none instead"}},
        Mistake{"stresses_is_a_choice", "output_interval: 1 min", "stresses: on", {"write one of true, false instead"}},
        Mistake{"empty_study", "name: fp3_spindle", "name:", {"| name:", "the value is empty"}},
        // These show only once the mesh is there.
        Mistake{"not_held",
                "fixed: [x, y, z]",
                "fixed: [x, y]",
                {"'column' (and with it", "can still translate along z, rotate about x through z = 0.0 mm, rotate about y",
                 "supports[0]"}},
        Mistake{"spindle_not_held",
                "\nsupports:",
                "\njoints:\n"
                "  - {name: bearing_front/spindle, normal_stiffness: 4e8 N/m, tangential_stiffness: 0 N/m}\n"
                "  - {name: bearing_rear/spindle, normal_stiffness: 4e8 N/m, tangential_stiffness: 0 N/m}\n"
                "supports:",
                {"'spindle' is not held", "can still translate along y, rotate about y through x = 0.0 mm, z = 1320.0 mm"}},
        Mistake{"unknown_joint_in_joints",
                "\nsupports:",
                "\njoints: [{name: knee/tabel, mechanics: none}]\nsupports:",
                {"the mesh has no joint 'knee/tabel'", "Did you mean 'knee/table'?", "joints[0].name"}},
        Mistake{"joint_twice",
                "\nsupports:",
                "\njoints: [{name: knee/table, mechanics: tied}, {name: knee/table, mechanics: none}]\nsupports:",
                {"'knee/table' is listed twice under `joints`", "joints[1].name"}},
        Mistake{"unknown_region",
                "    region: bearing_rear",
                "    region: bearing_reer",
                {"the mesh has no region 'bearing_reer'", "Did you mean 'bearing_rear'?", "effects[1].region"}},
        Mistake{
            "unknown_surface", "surface: foot", "surface: feet", {"the mesh has no surface 'feet'", "supports[0].surface"}},
        Mistake{"unknown_joint", "joint: knee/table", "joint: table/knee", {"the mesh has no joint 'table/knee'"}},
        Mistake{"region_without_material", "  knee: cast_iron_gjl250\n", "", {"region 'knee' has no material"}},
        Mistake{"node_twice",
                "  - {type: air_node, node: air_nose,",
                "  - {type: node, node: air_nose, capacity: 5 J/K}\n  - {type: air_node, node: air_nose,",
                {"there is a lumped node 'air_nose' already", ".node"}},
        Mistake{"heated_ambient",
                "  - {type: air_node, node: air_nose,",
                "  - {type: heat_source, node: ambient, power: 5 W}\n  - {type: air_node, node: air_nose,",
                {"the ambient is no lumped node", ".node"}},
        Mistake{"link_to_nowhere",
                "  - {type: air_node, node: air_nose,",
                "  - {type: link, region: spindle, conductance: 1 W/K, to: air_nos}\n  - {type: air_node, node: air_nose,",
                {"no lumped node 'air_nos'", "Did you mean 'air_nose'?"}},
        Mistake{"joint_without_contact",
                "  - {type: contact, joint: knee/table, conductance: 1500 W/(m^2 K)}\n",
                "",
                {"joint 'knee/table' has no contact"}},
        Mistake{"sensor_outside",
                "at: [0 mm, -660 mm, 1430 mm]",
                "at: [0 mm, -660 mm, 1530 mm]",
                {"outside region 'motor'", "its nearest point is", "sensors[4].at"}},
        Mistake{"unknown_node",
                "{name: air, node: air_nose}",
                "{name: air, node: air_nos}",
                {"no lumped node 'air_nos'", "air_nose"}}),
    [](const auto& mistake) { return std::string(mistake.param.name); });

TEST(BadCommand, MissingFileUnknownVerbAndMissingArgumentEndWithTwo) {
  EXPECT_EQ(run_program("run /nowhere/x.yaml").exit_code, 2);
  EXPECT_THAT(run_program("run /nowhere/x.yaml").output, HasSubstr("/nowhere/x.yaml: the file cannot be opened"));
  EXPECT_EQ(run_program("run").exit_code, 2);
  EXPECT_EQ(run_program("rnu scenarios/fp3_spindle.yaml").exit_code, 2);
  EXPECT_THAT(run_program("rnu scenarios/fp3_spindle.yaml").output, HasSubstr("unknown verb 'rnu'"));
}

TEST(BadCommand, WordsThatAreNoneNameTheOneThatWasMeant) {
  for (const auto& [command, message] : {
           std::pair{"run no_such.yaml --threds 3",
                     "error: driftwright run has no option --threds. Did you mean '--threads'?"},
           {"diagnose no_such.yaml", "error: driftwright diagnose: --measured is required"},
           {"", "error: a verb is required"},
           {"--json", "error: driftwright has no option --json"},
           {"run scenarios/lumped_sweep.yaml",
            "lumped_sweep.yaml:16:3: this file is a study that varies a scenario: `driftwright sweep`"},
           {"sweep scenarios/lumped_spindle.yaml", "lumped_spindle.yaml:15:3: this file is a scenario: `driftwright run`"},
       }) {
    const CommandOutcome outcome = run_program(command);
    EXPECT_EQ(outcome.exit_code, 2) << command;
    EXPECT_THAT(outcome.output, HasSubstr(message));
  }
}

struct Conflict {
  const char* name;
  const char* command;
  const char* message;
};

class OptionsThatDoNotGoTogether : public ::testing::TestWithParam<Conflict> {};

// The scenario is no file: what is wrong with the options is said before anything is read.
TEST_P(OptionsThatDoNotGoTogether, AreRefusedBeforeAnythingIsRead) {
  const CommandOutcome outcome = run_program(GetParam().command);
  EXPECT_EQ(outcome.exit_code, 2) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr(GetParam().message));
  EXPECT_THAT(outcome.output, ::testing::Not(HasSubstr("no_such")));
}

INSTANTIATE_TEST_SUITE_P(
    Each, OptionsThatDoNotGoTogether,
    ::testing::Values(
        Conflict{"json_quiet", "check no_such.yaml --json --quiet", "--json excludes --quiet"},
        Conflict{"json_details", "check no_such.yaml --json --details", "--json excludes --details"},
        Conflict{"pause_alone", "predict no_such.yaml --cyclogram x --after-pause '3 min'",
                 "--after-pause requires --start"},
        Conflict{"train_alone", "validate no_such.yaml --train x.csv", "requires --test too"},
        Conflict{"test_alone", "validate no_such.yaml --test x.csv", "requires --train too"},
        Conflict{"after_alone", "compensate no_such.yaml --model x.json --through none --after x.csv",
                 "--after requires --measured"},
        Conflict{"measured_cyclogram",
                 "compensate no_such.yaml --model x.json --through none --measured x.csv --cyclogram y",
                 "--measured is allowed only with --through none"},
        Conflict{"probe_schedule", "compensate no_such.yaml --model x.json --through schedule --probe '60 min'",
                 "--probe is allowed only with --through none and a predictor's file"},
        Conflict{"probe_modes", "compensate no_such.yaml --model modes --through none --probe '60 min'",
                 "--probe is allowed only with --through none and a predictor's file"},
        Conflict{"measured_injector", "compensate no_such.yaml --model x.json --through injector --measured x.csv",
                 "--measured is allowed only with --through none"},
        Conflict{"file_through_frame", "compensate no_such.yaml --model x.json --through frame",
                 "--through frame allows only"},
        Conflict{"shard_merge", "sweep no_such.yaml --shard 1/2 --merge", "leave out --shard"},
        Conflict{"no_format", "export no_such.yaml", "--as"},
        Conflict{"two_formats", "export no_such.yaml --fmu --as c", "--fmu"},
        Conflict{"control_without_model", "export --as siemens --axis Z", "--model"},
        Conflict{"control_without_axis", "export --as siemens --model no_such.json", "--axis"},
        Conflict{"control_of_a_scenario", "export no_such.yaml --as fanuc --axis Z", "--as c"},
        Conflict{"axis_of_a_unit", "export no_such.yaml --fmu --axis Z", "--axis and --axis-moves are for a formula"},
        Conflict{"axis_of_plain_c", "export no_such.yaml --as c --axis X", "--axis and --axis-moves are for a formula"},
        Conflict{"moves_of_a_unit", "export no_such.yaml --fmu --axis-moves against_dk", "are for a formula"},
        Conflict{"fmi_of_plain_c", "export no_such.yaml --as c --fmi 3", "--fmi and --type are for"},
        Conflict{"type_of_a_control", "export --as st --model no_such.json --type me", "--fmi and --type are for"},
        Conflict{"observer_of_a_formula", "export --as c --model no_such.json --of observer",
                 "--of observer requires the scenario"},
        Conflict{"observer_alone", "export no_such.yaml --fmu --of observer", "--model"},
        Conflict{"machine_with_model", "export no_such.yaml --fmu --model x.json", "--of observer"},
        Conflict{"materials_markdown", "list materials --markdown", "--markdown is allowed only for effects"},
        Conflict{"separation_alone", "inject --correction x.csv --separation 5 </dev/null", "add --clocked"},
        Conflict{"topic_alone", "follow no_such.yaml --topic speed_rpm=mill/speed </dev/null",
                 "requires --mqtt HOST or --mtconnect"},
        Conflict{"two_links", "follow no_such.yaml --mqtt localhost --mtconnect http://localhost:5000",
                 "--mqtt excludes --mtconnect"},
        Conflict{"no_threads", "check no_such.yaml --threads 0", "--threads"},
        Conflict{"hal_alone", "inject --correction x.csv --hal x.hal </dev/null", "--halstream, which is not given"}),
    [](const auto& conflict) { return conflict.param.name; });

TEST(BadCommand, AMeshThatGmshCannotMakeEndsWithThree) {
  const std::string scenario =
      write_file("coarse.yaml", fixtures::replaced(read_text("scenarios/fp3_spindle.yaml"), "frame: 80 mm, spindle: 20 mm",
                                                   "frame: 1 m, spindle: 1 m"));
  const auto out = fresh_folder("coarse") / "out";
  const CommandOutcome outcome = run_program("run " + scenario + " -o " + out.string());
  EXPECT_EQ(outcome.exit_code, 3) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("try other dimensions or mesh sizes"));
  EXPECT_TRUE(std::filesystem::is_empty(out.parent_path()));
}

TEST(BadCommand, ARecordToPredictMustSayWhatDroveTheMachine) {
  for (const auto& [text, words] : {std::pair{"time_s,t_degC\n100,20\n200,21\n", "no channel speed_rpm"},
                                    std::pair{"time_s,speed_rpm\n0,\n200,\n", "speed_rpm is empty"},
                                    std::pair{"time_s,speed_rpm\n0,100\n200,-100\n300,0\n", "speeds must be positive"}}) {
    const CommandOutcome outcome =
        run_program("predict scenarios/fp3_spindle.yaml --cyclogram " + write_file("drive.csv", text));
    EXPECT_EQ(outcome.exit_code, 2) << words;
    EXPECT_THAT(outcome.output, HasSubstr(words));
  }
}

TEST(BadCommand, ARecordCannotTrainAndJudgeOrTrainTwice) {
  const std::string a = write_file("a.csv", "time_s,t_K,error_um\n0,1,0\n1,2,1\n"),
                    copy = write_file("copy.csv", "time_s,t_K,error_um\n0,1,0\n1,2,1\n"),
                    b = write_file("b.csv", "time_s,t_K,error_um\n0,1,0\n1,3,2\n");
  for (const std::string& arguments :
       {"--train " + a + " --test " + a, "--train " + a + " --train " + a + " --test " + b,
        "--train " + a + " --test " + copy, "--train " + b + " --test " + a + " --test " + copy}) {
    const CommandOutcome outcome = run_program("validate scenarios/spindle_22.yaml " + arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_THAT(outcome.output, HasSubstr("contain the same run")) << arguments;
  }
  for (const std::string& arguments :
       {"--train " + b + ":0s..0.9s --test " + b, "--train " + b + ":0s..0.6s --train " + b + ":0.5s.. --test " + a}) {
    const CommandOutcome outcome = run_program("validate scenarios/spindle_22.yaml " + arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_THAT(outcome.output, HasSubstr("overlap")) << arguments;
  }
}

TEST(BadCommand, ATargetInAnotherUnitThanMicrometresIsRefused) {
  const std::string a = write_file("a.csv", "time_s,t_K,error_mm\n0,1,0\n1,2,1\n"),
                    b = write_file("b.csv", "time_s,t_K,error_mm\n0,1,0\n1,3,2\n");
  const std::string scenario = write_file("mm.yaml", "name: mm\nstudy: {target: error_mm}\n");
  const CommandOutcome outcome = run_program("validate " + scenario + " --train " + a + " --test " + b);
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.output, HasSubstr("is in mm"));
}

TEST(BadCommand, AFolderWithOtherFilesIsRefusedAndKept) {
  const auto folder = fresh_folder("foreign");
  std::ofstream(folder / "thesis.txt") << "mine";
  const CommandOutcome outcome = run_program("run scenarios/fp3_spindle.yaml -o " + folder.string());
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.output, HasSubstr("--force"));
  EXPECT_EQ(read_text(folder / "thesis.txt"), "mine");
}

TEST(BadCommand, AScenarioWithoutMachineCannotBeRun) {
  const CommandOutcome outcome = run_program("run scenarios/spindle_22.yaml");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.output, HasSubstr("needs the key `machine`"));
}

TEST(BadCommand, ARecordWithoutTheTargetIsRefused) {
  const auto folder = fresh_folder("no_target");
  std::ofstream(folder / "a.csv") << "time_s,t_K\n0,1\n1,2\n";
  const std::string file = (folder / "a.csv").string();
  const CommandOutcome outcome = run_program("select scenarios/spindle_22.yaml --train " + file);
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.output, HasSubstr("no channel 'error_um'"));
}

TEST(Compare, OfScenariosSaysWhatToRun) {
  const CommandOutcome outcome = run_program("compare scenarios/first_machine.yaml scenarios/lumped_spindle.yaml");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(
      outcome.output,
      ::testing::AllOf(
          HasSubstr("driftwright simulate scenarios/first_machine.yaml --cyclogram shift -o results/first_machine\n"),
          HasSubstr("driftwright compare results/first_machine results/lumped_spindle")));
}

}  // namespace
}  // namespace driftwright::bad_input_test
