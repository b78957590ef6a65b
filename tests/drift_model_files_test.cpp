// A formula for a control: the C function compiled and run beside the program's own numbers.

#include "output/drift_model_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "base/errors.hpp"
#include "tests/sensor_records.hpp"
#include "tests/temporary_file.hpp"

namespace driftwright::output {
namespace {

using compensation::DriftModel;
using compensation::FailSafe;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// Four thermometers that tell of each other and a speed; a row in `period_s`.
Record machine(std::uint64_t seed, double period_s) {
  Record r = fixtures::sensor_record(seed, 300, 4, 0.02, 0.1);
  for (std::size_t i = 0; i < r.n_samples(); ++i) {
    r.channels[2].values[i] =
        0.5 * (r.channels[0].values[i] + r.channels[1].values[i]) + 0.01 * std::sin(5.0 * static_cast<double>(i));
    r.channels[3].values[i] = r.channels[0].values[i] + 0.01 * std::cos(7.0 * static_cast<double>(i));
    r.time_s[i] = 100.0 + period_s * static_cast<double>(i);
  }
  Random random(seed, 2);
  double speed = 0.0;
  r.channels.push_back({"spindle", "rpm", {}});
  for (std::size_t i = 0; i < r.n_samples(); ++i) {
    if (random.chance(0.05)) speed = 3000.0 * random.uniform();
    r.channels.back().values.push_back(speed);
  }
  return r;
}

DeployedModel deployed(bool from_start, double period_s) {
  DeployedModel d;
  d.model = {.kind = "regression with lags",
             .target = "drift_y",
             .target_unit = "um",
             .intercept = 1.0 / 3.0,
             .terms = {{.input = "X3", .unit = "degC", .coefficient = -0.7},  // not in the order of the guards
                       {.input = "X1", .unit = "degC", .coefficient = 1.1},
                       {.input = "X1", .unit = "degC", .coefficient = 2.3, .lag_s = 13.0 * period_s},
                       {.input = "X2", .unit = "degC", .coefficient = 0.02, .power = 2},
                       {.input = "X2", .unit = "degC", .coefficient = 0.01, .power = 2, .lag_s = 31.0 * period_s},
                       {.input = "X4", .unit = "degC", .coefficient = 0.9},
                       {.input = "spindle", .unit = "rpm", .coefficient = 1e-6, .power = 2, .lag_s = 20.0 * period_s},
                       {.input = "spindle", .unit = "rpm", .coefficient = 2e-4}},
             .from_start = from_start};
  const std::vector<Record> training = {machine(1, period_s), machine(2, period_s)};
  std::vector<std::vector<double>> predicted;
  for (const Record& r : training) predicted.push_back(d.model.predict(r));
  d.safe = compensation::learn_fail_safe(training, {"X1", "X2", "X3", "X4", "spindle"}, predicted, from_start);
  d.interval_um = 2.0 / 7.0;
  return d;
}

/// Compiles the function with a main of its own and gives its correction for each row.
std::vector<double> by_compiler(const DeployedModel& d, const Record& record) {
  const std::filesystem::path folder = fresh_folder("c");
  std::ofstream(folder / "model.c") << c_function(d, "a test");
  std::string call, reads;
  for (std::size_t k = 0; k < d.safe.guards.size(); ++k) call += fmt::format("x[{}], ", k);
  std::ofstream(folder / "main.c") << "#include <stdio.h>\n#include <stdlib.h>\n#include \"model.c\"\nint main(void) {\n"
                                   << "  static drift_y_state s;\n  double x[" << d.safe.guards.size()
                                   << "], dt_s;\n  char w[64];\n  int k;\n"
                                   << "  while (scanf(\"%63s\", w) == 1) {\n    dt_s = atof(w);\n    for (k = 0; k < "
                                   << d.safe.guards.size()
                                   << "; ++k) { if (scanf(\"%63s\", w) != 1) return 1; x[k] = atof(w); }\n"
                                   << "    printf(\"%.17g\\n\", drift_y_correction_um(&s, " << call
                                   << "dt_s));\n  }\n  return 0;\n}\n";
  std::ofstream rows(folder / "rows.txt");
  for (std::size_t i = 0; i < record.n_samples(); ++i) {
    rows << fmt::format("{:.17g}", i > 0 ? record.time_s[i] - record.time_s[i - 1] : 1e9);  // the first does not matter
    for (const FailSafe::Guard& g : d.safe.guards) rows << fmt::format(" {:.17g}", record.at(g.input).values[i]);
    rows << "\n";
  }
  rows.close();
  const std::string f = folder.string();
  EXPECT_EQ(std::system(fmt::format("cc -std=c99 -pedantic -Wall -Wextra -Werror -O1 -o {0}/run {0}/main.c -lm && {0}/run "
                                    "<{0}/rows.txt >{0}/out.txt",
                                    f)
                            .c_str()),
            0);
  std::ifstream out(folder / "out.txt");
  std::vector<double> values;
  for (double v; out >> v;) values.push_back(v);
  return values;
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
          {"first missing", set("X2", 0, 40, NAN)},
          {"never there", set("X3", 0, 300, NAN)},
          {"drive silent", set("spindle", 50, 300, NAN)},
          {"out of range",
           [](Record& r) {
             for (std::size_t j = 0; j < 4; ++j)
               for (std::size_t i = 150; i < 300; ++i) r.channels[j].values[i] += 0.3 * static_cast<double>(i - 150);
           },
           false}};
}

class CFunction : public ::testing::TestWithParam<std::tuple<bool, double>> {};
INSTANTIATE_TEST_SUITE_P(All, CFunction, ::testing::Combine(::testing::Bool(), ::testing::Values(60.0, 0.1, 7.3)));

TEST_P(CFunction, GivesTheNumbersOfTheProgramCallByCall) {
  const auto [from_start, period_s] = GetParam();
  const DeployedModel d = deployed(from_start, period_s);
  for (const Wrong& wrong : wrongs()) {
    Record record = machine(5, period_s);
    wrong.with(record);
    const compensation::Repaired r = compensation::repaired(d.safe, record);
    EXPECT_EQ(!r.events.empty(), wrong.is_named) << wrong.name;
    const std::vector<double> expected = compensation::guarded(d.safe, r, d.model.predict(r.readings)).correction_um;
    const std::vector<double> got = by_compiler(d, record);
    ASSERT_EQ(got.size(), expected.size()) << wrong.name;
    double most = 0.0;
    for (std::size_t i = 0; i < got.size(); ++i) {
      ASSERT_NEAR(got[i], expected[i], 1e-9) << wrong.name << " row " << i;
      most = std::max(most, std::abs(expected[i]));
    }
    EXPECT_GT(most, 1.0) << wrong.name;
  }
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
  EXPECT_THAT(by_compiler(d, r), ::testing::ElementsAre(83.0, 83.0));
}

TEST(FormulaText, SaysUnitsRangesAndLimits) {
  DeployedModel d = deployed(true, 60.0);
  const std::string text = formula_text(d);
  for (const char* part : {"drift_y [um] =", "um/degC", "um/rpm^2", "LAG(13 min, (X1 - X1 at start))",
                           "<= X1 - start <=", "<= spindle <=", "um/min", "95 % of the drift"})
    EXPECT_THAT(text, HasSubstr(part));
  d.interval_um = NAN;
  EXPECT_EQ(formula_text(d).find("95 %"), std::string::npos);
}

}  // namespace
}  // namespace driftwright::output
