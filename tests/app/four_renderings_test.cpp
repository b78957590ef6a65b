// The same numbers are in a verb's JSON, on its terminal, in its CSV files and on its page.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "tests/shared/command_line.hpp"

namespace driftwright::four_renderings_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr, ::testing::Not;
using Json = nlohmann::json;

/// A number as printed.
struct Token {
  double value = 0.0;
  double half_unit = 0.0;  ///< of its last digit
};

std::vector<Token> tokens_of(const std::string& text) {
  static const std::regex kNumber(R"(([-+]?\d+)(?:\.(\d+))?(?:e([-+]?\d+))?)");
  std::vector<Token> tokens;
  for (std::sregex_iterator m(text.begin(), text.end(), kNumber), end; m != end; ++m) {
    const int exponent = (*m)[3].matched ? std::stoi((*m)[3]) : 0;
    tokens.push_back({std::stod(m->str()), 0.5 * std::pow(10.0, exponent - static_cast<int>((*m)[2].length()))});
  }
  return tokens;
}

/// Whether a number was printed, rounded, as itself or in per cent. A whole number matches only values within 5 % of it.
bool stands_in(const std::vector<Token>& tokens, double number) {
  const auto is = [](const Token& t, double x) {
    const double off = std::abs(t.value - x), slack = 1e-5 * std::abs(x);  // JSON has six digits
    if (off > t.half_unit + slack) return false;
    return t.half_unit < 0.1 || off <= 0.05 * std::abs(x);
  };
  return std::any_of(tokens.begin(), tokens.end(), [&](const Token& t) { return is(t, number) || is(t, 100.0 * number); });
}

struct Number {
  std::string path;  ///< "channels.peak"
  double value = 0.0;
};
void collect(const Json& json, const std::string& path, std::vector<Number>& numbers) {
  if (json.is_number()) numbers.push_back({path, json.get<double>()});
  if (json.is_array()) {
    for (const Json& element : json) collect(element, path, numbers);
  }
  if (json.is_object()) {
    for (const auto& [key, value] : json.items()) collect(value, path.empty() ? key : path + "." + key, numbers);
  }
}

/// What people can read of a page: no style, pictures or tags.
std::string words_of(std::string html) {
  for (const char* drawn : {"style", "svg"}) {
    const std::string open = std::string("<") + drawn, close = std::string("</") + drawn + ">";
    for (std::size_t at = html.find(open); at != std::string::npos; at = html.find(open, at))
      html.erase(at, html.find(close, at) + close.size() - at);
  }
  std::string words;
  bool in_tag = false;
  for (char c : html) {
    if (c == '<') in_tag = true;
    words += in_tag ? ' ' : c;
    if (c == '>') in_tag = false;
  }
  return words;
}

std::string all_csv(const fs::path& folder) {
  std::string text;
  for (const auto& file : fs::recursive_directory_iterator(folder)) {
    if (file.path().extension() == ".csv") text += read_text(file.path()) + "\n";
  }
  return text;
}

/// @param for_programs  keys that are not shown to people: numbers from which a sentence was made, or too many for a table
void expect_same_numbers(const std::string& arguments, const fs::path& out, const std::set<std::string>& for_programs,
                         const std::string& json_file = "summary.json") {
  const CommandOutcome told = run_program(arguments + " -o " + out.string() + " --details");
  ASSERT_EQ(told.exit_code, 0) << told.output;
  const std::string text = read_text(out / json_file);
  const CommandOutcome printed = run_program(arguments + " -o " + out.string() + " --json 2> /dev/null #");
  EXPECT_EQ(printed.output, text) << "--json prints the file";
  std::vector<Number> numbers;
  collect(Json::parse(text), "", numbers);
  const std::vector<Token> terminal = tokens_of(told.output), page = tokens_of(words_of(read_text(out / "report.html"))),
                           csv = tokens_of(all_csv(out));
  EXPECT_GT(numbers.size(), 5U);
  for (const Number& n : numbers) {
    EXPECT_TRUE(std::any_of(csv.begin(), csv.end(),
                            [&](const Token& t) { return std::abs(t.value - n.value) <= 1e-5 * std::abs(n.value); }))
        << arguments << ": " << n.path << " = " << n.value << " in no CSV";
    if (for_programs.contains(n.path)) continue;
    EXPECT_TRUE(stands_in(terminal, n.value)) << arguments << ": " << n.path << " = " << n.value << " not on the terminal";
    EXPECT_TRUE(stands_in(page, n.value)) << arguments << ": " << n.path << " = " << n.value << " not on the page";
  }
}

class FourRenderings : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { folder_ = fresh_folder("four_renderings"); }
  static std::string out(const std::string& name) { return (folder_ / name).string(); }
  static inline fs::path folder_;
};

TEST_F(FourRenderings, OfPredict) {
  expect_same_numbers("predict scenarios/lumped_spindle.yaml --cyclogram shift", out("predict"), {});
}

TEST_F(FourRenderings, OfSimulate) {
  expect_same_numbers("simulate scenarios/lumped_spindle.yaml --cyclogram shift --cyclogram warm_up", out("simulate"), {});
}

TEST_F(FourRenderings, OfMesh) {
  expect_same_numbers("mesh scenarios/fp3_spindle.yaml", out("mesh"), {});
}

// What programs alone get of `run`: errors of a model that people read in a sentence, and its counters.
TEST_F(FourRenderings, OfRunSelectAndCompensate) {
  expect_same_numbers("run scenarios/cnc_mill_13.yaml", out("run"),
                      {"model.temperature_unknowns", "energy_balance_gap", "tolerance_um", "corrections.before.mean_um",
                       "corrections.after.mean_um", "regressions.rank", "drift_at_one_temperature.first.time_s",
                       "drift_at_one_temperature.second.time_s"});
  std::string train;
  for (const auto& file : fs::directory_iterator(folder_ / "run/records")) train += " --train " + file.path().string();
  expect_same_numbers("select scenarios/cnc_mill_13.yaml" + train, out("select"), {"n_resamples"});
  expect_same_numbers("compensate scenarios/cnc_mill_13.yaml --model modes --through none", out("compensate"), {});
}

TEST_F(FourRenderings, QuietPrintsNothing) {
  const CommandOutcome quiet =
      run_program("predict scenarios/lumped_spindle.yaml --cyclogram shift --quiet -o " + out("quiet"));
  EXPECT_EQ(quiet.exit_code, 0);
  EXPECT_EQ(quiet.output, "");
  EXPECT_TRUE(fs::exists(folder_ / "quiet/summary.json"));
  const CommandOutcome both =
      run_program("predict scenarios/lumped_spindle.yaml --cyclogram shift --quiet --json -o " + out("both"));
  EXPECT_EQ(both.exit_code, 2);
  EXPECT_THAT(both.output, HasSubstr("--quiet"));
}

TEST_F(FourRenderings, TablesThatAreDetailsWaitForTheirFlag) {
  const std::string predict = "simulate scenarios/lumped_spindle.yaml --cyclogram shift -o " + out("details");
  EXPECT_THAT(run_program(predict).output, Not(HasSubstr("Heat that flows within the machine")));
  EXPECT_THAT(run_program(predict + " --details").output, HasSubstr("Heat that flows within the machine"));
}

}  // namespace
}  // namespace driftwright::four_renderings_test
