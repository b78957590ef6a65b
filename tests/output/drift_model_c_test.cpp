// What is judged is what is deployed: the exported C, compiled as a control would, gives the program's own bits over
// whole runs.

#include "output/drift_model_c.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>

#include "compensation/control/control_files.hpp"
#include "tests/shared/deployed_model.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::output::drift_model_c_test {
namespace {

using compensation::DriftModel;
using compensation::FailSafe;
using fixtures::deployed;
using fixtures::machine;
using fixtures::warm_machine;
using ::testing::HasSubstr;

constexpr double kFirstStep_s = 1e9;  // the time before the first row must not matter

/// What comes out of a row.
struct Row {
  double correction_um = 0.0, trust = 0.0;
  std::vector<double> repaired;
};

/// An exported model as a program of its own: rows of doubles in, rows of doubles out, both as bytes.
class Exported {
 public:
  Exported(const DeployedModel& d, const std::string& compiler) : n_(d.safe.guards.size()), folder_(fresh_folder("c")) {
    for (const FailSafe::Guard& g : d.safe.guards) inputs_.push_back(g.input);
    std::ofstream(folder_ / "model.c") << c_function(d, "a test");
    for (const compensation::ControlFile& file : compensation::control_files())
      std::ofstream(folder_ / file.name, std::ios::binary) << file.text;
    std::string call;
    for (std::size_t k = 0; k < n_; ++k) call += fmt::format("x[{}], ", k + 1);
    std::ofstream(folder_ / "main.c") << fmt::format(
        "#include <stdio.h>\n#include \"model.c\"\nint main(void) {{\n  static drift_y_state s;\n  double x[{0}], y[{1}];\n"
        "  int k;\n  while (fread(x, sizeof x, 1, stdin) == 1) {{\n    y[0] = drift_y_correction_um(&s, {2}x[0]);\n"
        "    y[1] = s.run.trust;\n    for (k = 2; k < {1}; ++k) y[k] = s.repaired[k - 2];\n"
        "    fwrite(y, sizeof y, 1, stdout);\n  }}\n  return 0;\n}}\n",
        n_ + 1, n_ + 2, call);
    EXPECT_EQ(std::system(fmt::format("{0} -Wall -Wextra -Werror -pedantic -o {1}/run {1}/main.c {1}/drift_correction.c -lm",
                                      compiler, folder_.string())
                              .c_str()),
              0);
  }

  [[nodiscard]] std::vector<Row> run(const Record& record) const {
    std::ofstream in(folder_ / "in", std::ios::binary);
    const auto write = [&](double v) { in.write(reinterpret_cast<const char*>(&v), sizeof v); };
    for (std::size_t i = 0; i < record.n_samples(); ++i) {
      write(i > 0 ? record.time_s[i] - record.time_s[i - 1] : kFirstStep_s);
      for (const std::string& input : inputs_) write(record.at(input).values[i]);
    }
    in.close();
    EXPECT_EQ(std::system(fmt::format("{0}/run <{0}/in >{0}/out", folder_.string()).c_str()), 0);
    std::ifstream out(folder_ / "out", std::ios::binary);
    std::vector<Row> rows;
    std::vector<double> y(n_ + 2);
    while (out.read(reinterpret_cast<char*>(y.data()), static_cast<std::streamsize>(y.size() * sizeof(double))))
      rows.push_back({y[0], y[1], {y.begin() + 2, y.end()}});
    return rows;
  }

 private:
  std::size_t n_;
  std::filesystem::path folder_;
  std::vector<std::string> inputs_;
};

std::uint64_t bits(double x) {
  return std::bit_cast<std::uint64_t>(x);
}

struct Wrong {
  const char* name;
  std::function<void(Record&)> with;
  bool is_named = true;
};
std::vector<Wrong> wrongs() {
  const auto set = [](const char* name, std::size_t from, std::size_t to, double value) {
    return [=](Record& r) {
      for (Channel& c : r.channels) {
        for (std::size_t i = from; c.name == name && i < to; ++i) c.values[i] = value;
      }
    };
  };
  const auto both = [](auto a, auto b) {
    return [=](Record& r) {
      a(r);
      b(r);
    };
  };
  return {{"intact", [](Record&) {}, false},
          {"stuck",
           [](Record& r) {
             for (std::size_t i = 80; i < 300; ++i) r.channels[0].values[i] = r.channels[0].values[80];
           }},
          {"open", set("X2", 50, 300, NAN)},
          {"fallen off and back", set("X3", 60, 120, 12.0)},
          {"back at row 97", set("X3", 60, 97, 12.0)},
          {"back at row 111", set("X3", 60, 111, 12.0)},
          {"back at row 123", set("X3", 60, 123, 12.0)},
          {"back at row 151", set("X3", 60, 151, 12.0)},
          {"gaps", both(set("X1", 20, 23, NAN), set("spindle", 40, 44, NAN)), false},
          {"two at once", both(set("X1", 90, 300, 99.0), set("X4", 100, 300, NAN))},
          {"jumps about",
           [](Record& r) {
             for (std::size_t i = 70; i < 300; i += 9) r.channels[1].values[i] += i % 2 ? 30.0 : -25.0;
           }},
          {"drifts away",
           [](Record& r) {
             for (std::size_t i = 40; i < 300; ++i) r.channels[3].values[i] += 0.07 * static_cast<double>(i - 40);
           }},
          {"infinite", set("X2", 90, 140, INFINITY)},
          {"first missing", set("X2", 0, 40, NAN)},
          {"never there", set("X3", 0, 300, NAN)},
          {"drive silent", set("spindle", 50, 300, NAN)},
          {"warm", [](Record& r) { r = warm_machine(5, r.time_s[1] - r.time_s[0]); }},
          {"out of range",
           [](Record& r) {
             for (std::size_t j = 0; j < 4; ++j)
               for (std::size_t i = 150; i < 300; ++i) r.channels[j].values[i] += 0.3 * static_cast<double>(i - 150);
           },
           false}};
}

/// Compilers and flags that a control may be built with.
struct Built {
  bool from_start;
  double period_s;
  const char* compiler;
};
class CFunction : public ::testing::TestWithParam<Built> {};
constexpr const char* kAsTold = "gcc -std=c99 -O2 -ffp-contract=off";
INSTANTIATE_TEST_SUITE_P(
    All, CFunction,
    ::testing::Values(Built{false, 60.0, kAsTold}, Built{true, 60.0, kAsTold}, Built{false, 0.1, kAsTold},
                      Built{true, 0.1, kAsTold}, Built{false, 7.3, kAsTold}, Built{true, 7.3, kAsTold},
                      Built{true, 7.3, "gcc -std=c99 -O0"}, Built{true, 7.3, "gcc -std=gnu99 -O3 -march=native"},
                      Built{true, 7.3, "clang -std=gnu99 -O3 -march=native"},
                      Built{true, 7.3, "gcc -std=c99 -O1 -fsanitize=address,undefined -fno-sanitize-recover=all"}));

TEST_P(CFunction, GivesTheBitsOfTheProgramCallByCall) {
  const auto [from_start, period_s, compiler] = GetParam();
  const std::string program = std::string(compiler).substr(0, std::string(compiler).find(' '));
  if (std::system(fmt::format("command -v {} >/dev/null 2>&1", program).c_str()) != 0)
    GTEST_SKIP() << "no " << program << " here";
  const DeployedModel d = deployed(from_start, period_s);
  const Exported exported(d, compiler);
  for (const Wrong& wrong : wrongs()) {
    Record record = machine(5, period_s);
    wrong.with(record);
    const compensation::Repaired r = compensation::repaired(d.safe, record);
    EXPECT_EQ(!r.events.empty(), wrong.is_named) << wrong.name;
    const compensation::GuardedCorrection expected = compensation::guarded(d.safe, r, d.model.predict(r.readings));
    const std::vector<Row> got = exported.run(record);
    ASSERT_EQ(got.size(), record.n_samples()) << wrong.name;
    double most = 0.0;
    for (std::size_t i = 0; i < got.size(); ++i) {
      ASSERT_EQ(bits(got[i].correction_um), bits(expected.correction_um[i])) << wrong.name << " row " << i;
      ASSERT_EQ(bits(got[i].trust), bits(expected.trust[i])) << wrong.name << " row " << i;
      for (std::size_t k = 0; k < d.safe.guards.size(); ++k) {
        ASSERT_EQ(bits(got[i].repaired[k]), bits(r.readings.at(d.safe.guards[k].input).values[i]))
            << wrong.name << " row " << i << " input " << k;
      }
      most = std::max(most, std::abs(expected.correction_um[i]));
    }
    EXPECT_EQ(most > 1.0, !(from_start && wrong.name == std::string("warm"))) << wrong.name;
  }
}

// The source file asks for plain products and sums itself; without that, GCC's own C for a processor with FMA has fused
// ones.
TEST(CFunction, HasNoFusedMultiplyAddWhateverTheFlags) {
#ifndef __x86_64__
  GTEST_SKIP() << "looks for instructions of x86-64";
#endif
  const std::filesystem::path folder = fresh_folder("fma");
  for (const compensation::ControlFile& file : compensation::control_files()) std::ofstream(folder / file.name) << file.text;
  const auto fused = [&](const std::string& name) {
    EXPECT_EQ(std::system(fmt::format("gcc -std=gnu99 -O2 -mfma -S -o {0}/{1}.s {0}/{1}", folder.string(), name).c_str()),
              0);
    return read_text(folder / (name + ".s")).find("vfmadd") != std::string::npos;
  };
  EXPECT_FALSE(fused("drift_correction.c"));
  std::string text = read_text(folder / "drift_correction.c");
  const std::string wanted = "#pragma GCC optimize(\"fp-contract=off\")";
  ASSERT_NE(text.find(wanted), std::string::npos);
  write_file("fma/without.c", text.replace(text.find(wanted), wanted.size(), ""));
  EXPECT_TRUE(fused("without.c"));
}

TEST(CFunction, IsRefusedWithFastMathWhereNoNumberIsMissing) {
  const std::filesystem::path folder = fresh_folder("fast");
  for (const compensation::ControlFile& file : compensation::control_files()) std::ofstream(folder / file.name) << file.text;
  EXPECT_NE(
      std::system(
          fmt::format("gcc -std=c99 -ffast-math -c -o {0}/o {0}/drift_correction.c 2>{0}/said", folder.string()).c_str()),
      0);
  EXPECT_THAT(read_text(folder / "said"), HasSubstr("without -ffast-math"));
}

TEST(ControlFiles, AreTheFilesThatAreCompiledInToTheByte) {
  std::vector<std::string> names;
  for (const compensation::ControlFile& file : compensation::control_files()) {
    names.push_back(file.name);
    const std::string source = read_text("compensation/control/" + file.name);
    EXPECT_GT(source.size(), 500u) << file.name;
    EXPECT_EQ(file.text, source) << file.name;
  }
  EXPECT_THAT(names, ::testing::ElementsAre("drift_correction.h", "drift_correction.c", "axis_offset.h", "axis_offset.c",
                                            "axis_travel.h", "axis_travel.c", "probe_feedback.h", "probe_feedback.c",
                                            "probe_members.h", "probe_members.c"));
}

TEST(CFunction, WithNamesThatCDoesNotKnowCompiles) {
  DeployedModel d;
  d.model = {.kind = "regression",
             .target = "drift_y",
             .target_unit = "um",
             .intercept = 2.0,
             .terms = {{.input = "X 1", .unit = "degC", .coefficient = 1.0},
                       {.input = "X-1", .unit = "degC", .coefficient = 2.0},
                       {.input = "1st", .unit = "degC", .coefficient = 3.0}}};
  for (const char* name : {"X 1", "X-1", "1st"})
    d.safe.guards.push_back(
        {.input = name, .unit = "degC", .low = -100, .high = 100, .most_jump = 1e9, .others_coefficient = {}});
  d.safe.lowest_um = -1e6;
  d.safe.highest_um = 1e6;
  const Record r{.source = "r",
                 .time_s = {0, 1},
                 .channels = {{"X 1", "degC", {1, 1}}, {"X-1", "degC", {10, 10}}, {"1st", "degC", {20, 20}}}};
  const std::vector<Row> got = Exported(d, "gcc -std=c99 -O2").run(r);
  ASSERT_EQ(got.size(), 2u);
  for (const Row& row : got) EXPECT_EQ(row.correction_um, 83.0);
}

// Probings in the exported C are the program's filter on top of the guarded correction: within the clamp, no faster than the
// slew limit, and by the same source file.
TEST(CFunction, TakesProbingsAsTheProgramDoes) {
  DeployedModel d = deployed(true, 60.0);
  d.residual = compensation::ResidualProcess{4.0, 5400.0};
  d.probe = {0.6, 90.0};
  const std::filesystem::path folder = fresh_folder("probed");
  std::ofstream(folder / "model.c") << c_function(d, "a test");
  for (const compensation::ControlFile& file : compensation::control_files())
    std::ofstream(folder / file.name, std::ios::binary) << file.text;
  std::ofstream(folder / "main.c")
      << "#include <stdio.h>\n#include \"model.c\"\nint main(void) {\n  static drift_y_state s;\n  double x[7], y[4];\n"
         "  while (fread(x, sizeof x, 1, stdin) == 1) {\n"
         "    y[0] = drift_y_probed_correction_um(&s, x[0], x[1], x[2], x[3], x[4], x[5], x[6]);\n"
         "    y[1] = s.probing.verdict;\n    y[2] = s.probing.n_refused;\n"
         "    y[3] = probe_deviation_um(&drift_y_probing, &s.probing, 0.0);\n    fwrite(y, sizeof y, 1, stdout);\n  }\n"
         "  return 0;\n}\n";
  ASSERT_EQ(
      std::system(fmt::format("gcc -std=c99 -O2 -ffp-contract=off -Wall -Wextra -Werror -pedantic -o {0}/run {0}/main.c "
                              "{0}/drift_correction.c {0}/probe_feedback.c -lm",
                              folder.string())
                      .c_str()),
      0);
  const Record r = machine(5, 60.0);
  std::vector<double> probed_um(r.n_samples(), NAN);
  for (const auto& [row, um] : std::vector<std::pair<std::size_t, double>>{
           {0, 1.0}, {40, 3.0}, {80, -2.0}, {120, 900.0}, {150, 4.0}, {200, -30.0}, {201, -31.0}})
    probed_um[row] = um;
  const compensation::Repaired repaired = compensation::repaired(d.safe, r);
  const std::vector<double> guarded_um =
      compensation::guarded(d.safe, repaired, d.model.predict(repaired.readings)).correction_um;
  std::ofstream in(folder / "in", std::ios::binary);
  const auto write = [&](double v) { in.write(reinterpret_cast<const char*>(&v), sizeof v); };
  for (std::size_t i = 0; i < r.n_samples(); ++i) {
    for (const FailSafe::Guard& g : d.safe.guards) write(r.at(g.input).values[i]);
    write(std::isnan(probed_um[i]) ? NAN : guarded_um[i >= 2 ? i - 2 : 0] + probed_um[i]);
    write(i > 0 ? 60.0 : kFirstStep_s);
  }
  in.close();
  ASSERT_EQ(std::system(fmt::format("{0}/run <{0}/in >{0}/out", folder.string()).c_str()), 0);
  std::ifstream out(folder / "out", std::ios::binary);
  compensation::ProbeFeedback feedback(*d.residual, d.probe, true);
  double in_force_um = guarded_um[0];
  int n_taken = 0, n_slewed = 0;
  std::vector<int> verdicts;
  for (std::size_t i = 0; i < r.n_samples(); ++i) {
    double y[4];
    ASSERT_TRUE(out.read(reinterpret_cast<char*>(y), sizeof y)) << i;
    feedback.row(guarded_um[i], 0.0, 60.0);
    if (!std::isnan(probed_um[i])) {
      n_taken += feedback.probe_drift_um(guarded_um[i >= 2 ? i - 2 : 0] + probed_um[i]);
      verdicts.push_back(static_cast<int>(y[1]));
    }
    const double wanted_um = std::clamp(guarded_um[i] + feedback.estimate_um(), d.safe.lowest_um, d.safe.highest_um);
    const double most_um = i > 0 ? 60.0 * d.safe.most_rate_um_s : 1e9;
    if (std::abs(wanted_um - in_force_um) > most_um) ++n_slewed;
    in_force_um += std::clamp(wanted_um - in_force_um, -most_um, most_um);
    ASSERT_NEAR(y[0], in_force_um, 1e-12 * (1.0 + std::abs(in_force_um))) << i;
    ASSERT_EQ(y[2], feedback.state().n_refused) << i;
    ASSERT_EQ(bits(y[3]), bits(feedback.deviation_um())) << i;
  }
  EXPECT_THAT(verdicts, ::testing::ElementsAre(PROBE_TOO_EARLY, PROBE_TAKEN, PROBE_TAKEN, PROBE_UNLIKELY, PROBE_TAKEN,
                                               PROBE_UNLIKELY, PROBE_JUMP));
  EXPECT_EQ(n_taken, 4);
  EXPECT_GT(n_slewed, 0);
}

// A blend whose weights move: the exported C gives what the deployed predictor and the filters of the program give, with
// probings that the members expected differently, a chip, and a thermometer that fails.
TEST(CFunction, MovesTheWeightsOfABlendAsTheProgramDoes) {
  const compensation::DeployedPredictor blend = fixtures::deployed_blend();
  const DeployedModel d = deployed_model(blend);
  const std::filesystem::path folder = fresh_folder("blend");
  std::ofstream(folder / "model.c") << c_function(d, "a test");
  for (const compensation::ControlFile& file : compensation::control_files())
    std::ofstream(folder / file.name, std::ios::binary) << file.text;
  std::ofstream(folder / "main.c")
      << "#include <stdio.h>\n#include \"model.c\"\nint main(void) {\n  static drift_y_state s;\n  double x[7], y[6];\n"
         "  while (fread(x, sizeof x, 1, stdin) == 1) {\n    int k;\n"
         "    y[0] = drift_y_probed_correction_um(&s, x[0], x[1], x[2], x[3], x[4], x[5], x[6]);\n"
         "    y[1] = probe_leading(s.probing.members, 3)->verdict;\n"
         "    y[2] = probe_members_deviation_um(drift_y_probing, s.probing.members, 3, 0.0);\n"
         "    for (k = 0; k < 3; ++k) y[3 + k] = s.probing.members[k].weight;\n    fwrite(y, sizeof y, 1, stdout);\n  }\n"
         "  return 0;\n}\n";
  ASSERT_EQ(
      std::system(fmt::format("gcc -std=c99 -O2 -ffp-contract=off -Wall -Wextra -Werror -pedantic -o {0}/run {0}/main.c "
                              "{0}/drift_correction.c {0}/probe_feedback.c {0}/probe_members.c -lm",
                              folder.string())
                      .c_str()),
      0);
  MachineRun run;
  run.readings = machine(5, 60.0);
  for (std::size_t i = 170; i < 230; ++i) run.readings.channels[1].values[i] = NAN;
  const compensation::GuardedCorrection c = compensation::correct(blend, run);
  ASSERT_EQ(c.members_um.size(), 2u);
  const std::size_t n = run.readings.n_samples();
  std::vector<double> probed_um(n, NAN);
  for (std::size_t row = 30; row < n; row += 30) probed_um[row] = c.members_um[row < 160 ? 0 : 1][row] + 0.5;
  probed_um[130] = 900.0;
  std::ofstream in(folder / "in", std::ios::binary);
  const auto write = [&](double v) { in.write(reinterpret_cast<const char*>(&v), sizeof v); };
  for (std::size_t i = 0; i < n; ++i) {
    for (const FailSafe::Guard& g : d.safe.guards) write(run.readings.at(g.input).values[i]);
    write(probed_um[i]);
    write(i > 0 ? 60.0 : kFirstStep_s);
  }
  in.close();
  ASSERT_EQ(std::system(fmt::format("{0}/run <{0}/in >{0}/out", folder.string()).c_str()), 0);
  std::ifstream out(folder / "out", std::ios::binary);
  compensation::ProbeFeedback feedback(compensation::probe_processes_of(blend, blend.probe));
  double in_force_um = c.correction_um[0], least_first = 1.0, most_first = 0.0;
  int n_refused = 0;
  for (std::size_t i = 0; i < n; ++i) {
    double y[6];
    ASSERT_TRUE(out.read(reinterpret_cast<char*>(y), sizeof y)) << i;
    feedback.row(std::vector<double>{c.correction_um[i], c.members_um[0][i], c.members_um[1][i]}, 0.0, 60.0);
    if (!std::isnan(probed_um[i])) {
      n_refused += !feedback.probe_drift_um(probed_um[i]);
      ASSERT_EQ(y[1], feedback.state().verdict) << i;
    }
    const double wanted_um = std::clamp(c.correction_um[i] + feedback.estimate_um(), d.safe.lowest_um, d.safe.highest_um);
    const double most_um = i > 0 ? 60.0 * d.safe.most_rate_um_s : 1e9;
    in_force_um += std::clamp(wanted_um - in_force_um, -most_um, most_um);
    ASSERT_NEAR(y[0], in_force_um, 1e-9) << i;
    ASSERT_NEAR(y[2], feedback.deviation_um(), 1e-9) << i;
    for (std::size_t k = 0; k < 3; ++k) ASSERT_NEAR(y[3 + k], feedback.members()[k].weight, 1e-9) << i << " " << k;
    least_first = std::min(least_first, y[4]);
    most_first = std::max(most_first, y[4]);
  }
  EXPECT_GE(n_refused, 1);      // the chip
  EXPECT_GT(most_first, 0.36);  // it begins at a third: the weights have moved there and back
  EXPECT_LT(least_first, 0.25);
}

TEST(CFunction, OfATermWithoutAGuardIsOurOwnMistake) {
  DeployedModel d = deployed(false, 60.0);
  d.model.terms[0].input = "nowhere";
  EXPECT_THROW((void)c_function(d, "a test"), std::logic_error);
}

TEST(CFunction, OfATargetThatIsCalledAsAFileOfOursCompiles) {
  for (const char* target : {"drift", "probe", "axis_offset"}) {
    DeployedModel d = deployed(true, 60.0);
    d.model.target = target;
    d.residual = compensation::ResidualProcess{4.0, 5400.0};
    const std::filesystem::path folder = fresh_folder("own_name");
    std::ofstream(folder / "model.c") << "#include \"axis_offset.h\"\n" << c_function(d, "a test");
    for (const compensation::ControlFile& file : compensation::control_files())
      std::ofstream(folder / file.name, std::ios::binary) << file.text;
    EXPECT_EQ(
        std::system(
            fmt::format("gcc -std=c99 -Wall -Werror -pedantic -c -o {0}/model.o {0}/model.c", folder.string()).c_str()),
        0)
        << target;
    EXPECT_THAT(c_function(d, "a test"), HasSubstr(fmt::format("double x_{}_correction_um(", target)));
  }
}

TEST(CFunction, OfAConstantCompilesThoughCKnowsNoEmptyTables) {
  DeployedModel d;
  d.model = {.kind = "mean", .target = "drift_y", .target_unit = "um", .intercept = 2.5, .terms = {}};
  d.safe.lowest_um = -1e6;
  d.safe.highest_um = 2.0;
  const std::vector<Row> got =
      Exported(d, "gcc -std=c99 -O2").run({.source = "r", .time_s = {0, 1}, .channels = {{"X", "degC", {1, 1}}}});
  ASSERT_EQ(got.size(), 2u);
  for (const Row& row : got) EXPECT_EQ(row.correction_um, 2.0);
}

}  // namespace
}  // namespace driftwright::output::drift_model_c_test
