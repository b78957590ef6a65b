#pragma once
// A component of LinuxCNC as its tests run it: exported, compiled with substitutes for HAL, and fed cycle by cycle.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "compensation/control/control_files.hpp"
#include "output/drift_model_c.hpp"
#include "output/linuxcnc_component.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::output {

/// A component with plain C in place of HAL: `pin`, `param`, `variable` and `include` as halcompile's manual has them.
class Component {
 public:
  explicit Component(const std::filesystem::path& folder, const std::string& file = "model_axis.comp") : folder_(folder) {
    const std::string all = read_text(folder / file);
    const std::size_t cut = all.find("\n;;\n");
    EXPECT_NE(cut, std::string::npos);
    std::string text = std::regex_replace(all.substr(0, cut), std::regex("\"\"\"[^]*?\"\"\""), "\"\"");
    const std::map<std::string, std::string> types = {
        {"float", "volatile double"}, {"bit", "volatile unsigned char"}, {"signed", "volatile int"}};
    std::string includes, fields, macros, starts, reads, writes;
    const std::regex item(R"re((pin|param) (in|out|rw) (float|bit|signed) (\w+)(?: = (\S+))? "[^"\n]*";)re");
    for (std::sregex_iterator it(text.begin(), text.end(), item), end; it != end; ++it) {
      const std::string kind = (*it)[1], direction = (*it)[2], type = (*it)[3], name = (*it)[4], start = (*it)[5];
      fields += fmt::format("  {} {};\n", types.at(type), name);
      // what halcompile lets be read only cannot be written to
      macros += fmt::format("#define {0} ({1}instance.{0})\n", name, direction == "in" ? "0 + " : "");
      if (!start.empty()) starts += fmt::format("  instance.{} = {};\n", name, start);
      if (direction == "out") {
        outs_.push_back(name);
        writes += fmt::format("    printf(\"%.17g \", (double)instance.{});\n", name);
      } else {
        ins_.push_back(name);
        values_[name] = start.empty() ? 0.0 : std::stod(start);
        reads += fmt::format("    if (scanf(\"%lf\", &value) != 1) return 1;\n    instance.{} = value;\n", name);
      }
    }
    const std::regex variable(R"(variable (\w+) (\w+);)"), include(R"re(include ("[^"\n]*");)re");
    for (std::sregex_iterator it(text.begin(), text.end(), variable), end; it != end; ++it) {
      fields += fmt::format("  {} {};\n", (*it)[1].str(), (*it)[2].str());
      macros += fmt::format("#define {0} (instance.{0})\n", (*it)[2].str());
    }
    for (std::sregex_iterator it(text.begin(), text.end(), include), end; it != end; ++it)
      includes += fmt::format("#include {}\n", (*it)[1].str());
    std::ofstream(folder / "stand_in.c") << fmt::format(
        "#include <stdio.h>\n{}static struct {{\n{}}} instance;\nstatic void cycle(long period);\n"
        "int main(void) {{\n  double value;\n  long cycles, period, i;\n{}"
        "  while (scanf(\"%ld %ld\", &cycles, &period) == 2) {{\n{}    for (i = 0; i < cycles; ++i) cycle(period);\n{}"
        "    printf(\"\\n\");\n  }}\n  return 0;\n}}\n{}#define fperiod (period * 1e-9)\n"
        "#define FUNCTION(name) static void cycle(long period)\n{}\n",
        includes, fields, starts, reads, writes, macros, all.substr(cut + 4));
    EXPECT_EQ(std::system(fmt::format("gcc -std=c99 -pedantic -Wall -Wextra -Werror -O1 -o {0}/stand_in {0}/stand_in.c -lm",
                                      folder.string())
                              .c_str()),
              0);
  }

  /// Pins and parameters, as C has them.
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> all = ins_;
    all.insert(all.end(), outs_.begin(), outs_.end());
    return all;
  }
  /// A value of an input or parameter from now on.
  void set(const std::string& name, double value) {
    ASSERT_TRUE(values_.contains(name)) << name;
    values_[name] = value;
  }
  /// Some cycles with what is set.
  void cycles(int n, long period_ns) {
    rows_ += fmt::format("{} {}", n, period_ns);
    for (const std::string& name : ins_) rows_ += fmt::format(" {:.17g}", values_[name]);
    rows_ += "\n";
  }
  /// All outputs after each call of cycles(), from the start of the component.
  [[nodiscard]] std::vector<std::map<std::string, double>> outputs() const {
    std::ofstream(folder_ / "rows") << rows_;
    EXPECT_EQ(std::system(fmt::format("{0}/stand_in <{0}/rows >{0}/out", folder_.string()).c_str()), 0);
    std::ifstream file(folder_ / "out");
    std::vector<std::map<std::string, double>> result;
    for (std::string line; std::getline(file, line);) {
      std::istringstream numbers(line);
      for (const std::string& name : outs_) {
        if (&name == &outs_.front()) result.emplace_back();
        std::string word;
        numbers >> word;
        result.back()[name] = std::stod(word);
      }
    }
    return result;
  }

 private:
  std::filesystem::path folder_;
  std::vector<std::string> ins_, outs_;
  std::map<std::string, double> values_;
  std::string rows_;
};

inline constexpr long kCycle_ns = 1000000;  // a servo thread
inline constexpr int kSecond = 1000;        // cycles

/// d = 2 um/K (T - 20) and nothing that doubts it: what the axis does is the component's own.
inline DeployedModel two_um_per_K() {
  DeployedModel d;
  d.model = {.kind = "by hand",
             .target = "drift_y",
             .target_unit = "um",
             .intercept = -40.0,
             .terms = {{.input = "T", .unit = "degC", .coefficient = 2.0}}};
  d.safe.guards = {{.input = "T", .unit = "degC", .low = 0, .high = 100, .most_jump = 1e9, .others_coefficient = {}}};
  d.safe.lowest_um = -100;
  d.safe.highest_um = 100;
  d.safe.most_rate_um_s = 0.5;
  d.safe.period_s = 1.0;
  d.safe.stale_s = 5.0;
  d.safe.fade_s = 50.0;
  return d;
}

/// Seconds with a heartbeat that turns over five times in each.
inline void beating(Component& c, int seconds, int& heartbeat) {
  for (int i = 0; i < 5 * seconds; ++i) {
    heartbeat = !heartbeat;
    c.set("heartbeat", heartbeat);
    c.cycles(kSecond / 5, kCycle_ns);
  }
}

/// A folder with the files that exports include.
inline std::filesystem::path folder_for_exports(const std::string& name) {
  std::filesystem::path folder = fresh_folder(name);
  for (const compensation::ControlFile& file : compensation::control_files())
    std::ofstream(folder / file.name, std::ios::binary) << file.text;
  return folder;
}

}  // namespace driftwright::output
