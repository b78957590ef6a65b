// What the program says where its surroundings fail it: exit code 2 and words, never a bug of ours.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <string>

#include "tests/shared/command_line.hpp"

namespace driftwright::environment_test {
namespace {

using ::testing::AllOf, ::testing::AnyOf, ::testing::HasSubstr, ::testing::Not;

/// A variable of the environment for as long as this lives.
class Environment {
 public:
  Environment(const char* name, const char* value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
    (void)setenv(name, value, 1);
  }
  ~Environment() { (void)(before_ ? setenv(name_, before_->c_str(), 1) : unsetenv(name_)); }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

std::string export_of(const std::string& file) {
  return "export scenarios/first_machine.yaml --fmu -o " + (temporary_folder() / file).string();
}

TEST(Environment, HelpAndVersionOnAFullDiskEndWithTwo) {
  for (const char* asked : {"--version", "--help", "simulate --help", "--completion bash", "--man", "list effects"}) {
    const CommandOutcome outcome =
        run_program(std::string(asked) + " 2>&1 >/dev/full #");  // run_program() would send standard error there, too
    EXPECT_EQ(outcome.exit_code, 2) << asked;
    EXPECT_THAT(outcome.output, AllOf(HasSubstr("error: "), Not(HasSubstr("internal")))) << asked;
  }
}

TEST(Environment, ExportNeedsNoCompilerAndNoFolderOfTemporaryFiles) {
  const std::string command = export_of("alone.fmu");
  const Environment compiler("CC", "false"), path("PATH", "/nowhere"), nowhere("TMPDIR", "/proc");
  const CommandOutcome outcome = run_program(command);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_TRUE(std::filesystem::exists(temporary_folder() / "alone.fmu"));
}

TEST(Environment, AFileThatIsLongerThanFilesMayBeIsNoSignal) {
  const auto out = temporary_folder() / "limited";
  const CommandOutcome outcome = run_program("--version >/dev/null; ulimit -f 8; " + std::string(DRIFTWRIGHT_PROGRAM) +
                                             " simulate scenarios/first_machine.yaml --quiet -o " + out.string());
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("error: "), Not(HasSubstr("internal"))));
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(Environment, TooLittleMemoryForTheLibrariesEndsInTime) {
  std::string scenario = read_text("scenarios/first_machine.yaml");
  scenario.resize(scenario.find("cyclograms:"));
  scenario +=
      "cyclograms: {shift: [[60 min, 6000 rpm]], climb: [[40 min, 1500 rpm], [40 min, 3000 rpm]], other: [[60 min, 2000 "
      "rpm]]}\n"
      "study: {target: nose_z, train: [shift, climb], judge: other, sensors_to_choose: 1, tolerance: 5 um}\n";
  const std::string run = std::string(DRIFTWRIGHT_PROGRAM) + " run " + write_file("tight.yaml", scenario) + " --quiet -o " +
                          (temporary_folder() / "tight").string();
  ASSERT_EQ(run_program("--version >/dev/null; " + run).exit_code, 0);
  int n_refused = 0;
  for (const int limit_MB : {200, 250, 300, 350}) {  // OpenBLAS alone needs 128
    const CommandOutcome outcome =
        run_program(fmt::format("--version >/dev/null; ulimit -v {}; timeout -s KILL 60 {}", limit_MB * 1024, run));
    EXPECT_THAT(outcome.exit_code, AnyOf(0, 2)) << limit_MB << " MB: " << outcome.output;
    if (outcome.exit_code != 2) continue;
    EXPECT_THAT(outcome.output, HasSubstr("not enough memory")) << limit_MB << " MB";
    ++n_refused;
  }
  EXPECT_GT(n_refused, 0);
}

TEST(Environment, AMachineWithoutAMeshFitsWhereTheProgramDoes) {  // which has its own memory already when it looks
  const CommandOutcome outcome = run_program(std::string("--version >/dev/null; ulimit -v 307200; ") + DRIFTWRIGHT_PROGRAM +
                                             " check scenarios/first_machine.yaml");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
}

TEST(Environment, MoreThreadsThanTheMemoryHasRoomForAreNotBegun) {
  const std::string sweep = fmt::format("{} sweep scenarios/lumped_sweep.yaml --quiet -o {}", DRIFTWRIGHT_PROGRAM,
                                        (temporary_folder() / "many_threads").string());
  for (const int limit_MB : {300, 600}) {
    const CommandOutcome outcome = run_program(fmt::format(
        "--version >/dev/null; export OMP_NUM_THREADS=64; ulimit -v {}; timeout -s KILL 60 {}", limit_MB * 1024, sweep));
    EXPECT_THAT(outcome.exit_code, AnyOf(0, 2)) << limit_MB << " MB: " << outcome.output;
  }
}

TEST(Environment, ANameThatNoFileMayHaveIsRefusedWhereItStands) {
  const std::string scenario = read_text("scenarios/first_machine.yaml");
  for (const char* name : {"first_machine\n", "shift:"}) {  // of the scenario, of a cyclogram
    const std::size_t at = scenario.find(name);
    ASSERT_NE(at, std::string::npos);
    const auto check = [&](std::size_t n) {
      std::string text = scenario;
      text.replace(at, std::string(name).size() - 1, std::string(n, 'n'));
      return run_program("check " + write_file("long_name.yaml", text));
    };
    EXPECT_EQ(check(200).exit_code, 0) << name;
    const CommandOutcome outcome = check(201);
    EXPECT_EQ(outcome.exit_code, 2) << name;
    EXPECT_THAT(outcome.output, AllOf(HasSubstr("long_name.yaml:"), HasSubstr("is no name"), HasSubstr("200 at most")))
        << name;
  }
}

TEST(Environment, ResultsOfANameThatNoFileMayHaveAreRefusedBeforeTheRun) {
  const std::string out = (temporary_folder() / std::string(300, 'x')).string();
  const CommandOutcome outcome =
      run_program("simulate scenarios/fp3_spindle.yaml -o " + out);  // two seconds and more where it runs
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("File name too long"), Not(HasSubstr("reduc")), Not(HasSubstr("internal"))));
  for (const std::string& verb : {"view scenarios/first_machine.yaml -o " + out + ".html",
                                  "export scenarios/first_machine.yaml --fmu -o " + out, "init " + out}) {
    const CommandOutcome refused = run_program(verb);
    EXPECT_EQ(refused.exit_code, 2) << verb;
    EXPECT_THAT(refused.output, Not(HasSubstr("internal"))) << verb;
  }
}

}  // namespace
}  // namespace driftwright::environment_test
