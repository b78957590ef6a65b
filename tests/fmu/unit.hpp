#pragma once
// A functional mock-up unit for tests: written, unpacked, and run by an importer of the standard.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <minizip/unzip.h>

#include <cmath>
#include <cstdlib>
#include <regex>

#include "base/quantity.hpp"
#include "base/record_channel.hpp"
#include "output/fmu/fmu_file.hpp"
#include "tests/fmu/importer.h"
#include "tests/shared/command_line.hpp"

namespace driftwright::output::fmu_test {

inline constexpr double kSame_um =
    1e-6;  // of drift; of temperatures 1e-6 K: rounding over 18000 steps stays a thousand times below

/// The files of a unit, read back from the zip.
inline std::map<std::string, std::string> unzipped(const std::filesystem::path& file) {
  std::map<std::string, std::string> files;
  const unzFile zip = unzOpen64(file.c_str());
  EXPECT_NE(zip, nullptr) << file;
  for (int at = unzGoToFirstFile(zip); at == UNZ_OK; at = unzGoToNextFile(zip)) {
    char name[256];
    unz_file_info64 info;
    EXPECT_EQ(unzGetCurrentFileInfo64(zip, &info, name, sizeof name, nullptr, 0, nullptr, 0), UNZ_OK);
    std::string bytes(info.uncompressed_size, '\0');
    EXPECT_EQ(unzOpenCurrentFile(zip), UNZ_OK);
    EXPECT_EQ(unzReadCurrentFile(zip, bytes.data(), static_cast<unsigned>(bytes.size())), static_cast<int>(bytes.size()));
    EXPECT_EQ(unzCloseCurrentFile(zip), UNZ_OK) << name << ": CRC";
    files[name] = bytes;
  }
  unzClose(zip);
  return files;
}

/// A unit written to a file, unpacked, and what its description says.
struct Unit {
  bool is_2 = true;
  std::map<std::string, std::string> files;
  std::filesystem::path folder, library;
  std::string guid;
  std::map<std::string, unsigned> reference;  ///< of variables
  std::vector<unsigned> states, derivatives;
  std::size_t n_indicators = 0;

  Unit(const FmuOrder& order, const std::string& name) : is_2(order.version == FmiVersion::k2), folder(fresh_folder(name)) {
    write_zip(folder / "unit.fmu", fmu_entries(order, {"test", "a test"}));
    files = unzipped(folder / "unit.fmu");
    for (const auto& [path, bytes] : files) {
      std::filesystem::create_directories((folder / path).parent_path());
      std::ofstream(folder / path, std::ios::binary) << bytes;
      if (path.ends_with(".so")) library = folder / path;
    }
    const std::string& xml = files["modelDescription.xml"];
    std::smatch m;
    EXPECT_TRUE(std::regex_search(xml, m, std::regex(is_2 ? " guid=\"([^\"]*)\"" : " instantiationToken=\"([^\"]*)\"")));
    guid = m[1];
    std::size_t told_indicators = 0;
    if (is_2) {
      EXPECT_TRUE(std::regex_search(xml, m, std::regex(" numberOfEventIndicators=\"([0-9]+)\"")));
      told_indicators = std::stoul(m[1]);
    } else {
      for (auto at = xml.find("<EventIndicator"); at != std::string::npos; at = xml.find("<EventIndicator", at + 1))
        ++told_indicators;
    }
    const std::regex variable(" name=\"([^\"]*)\" valueReference=\"([0-9]+)\"");
    for (std::sregex_iterator v(xml.begin(), xml.end(), variable), end; v != end; ++v) {
      const auto r = static_cast<unsigned>(std::stoul((*v)[2]));
      reference[(*v)[1]] = r;
      if (r >= 40000)
        ++n_indicators;
      else if (r >= 20000 && r < 30000)
        derivatives.push_back(r);
      else if (r >= 10000 && r < 20000)
        states.push_back(r);
    }
    EXPECT_EQ(n_indicators, told_indicators);
  }
};

inline void expect_valid(const Unit& unit) {
  const auto validate = [&](const std::string& file, const std::string& schema) {
    const std::string command = fmt::format("xmllint --noout --nonet --schema {}/schema/{} {}/{} 2>&1",
                                            DRIFTWRIGHT_FMI_STANDARD, schema, unit.folder.string(), file);
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
  };
  validate("modelDescription.xml", unit.is_2 ? "fmi2/fmi2ModelDescription.xsd" : "fmi3/fmi3ModelDescription.xsd");
  if (!unit.is_2) validate("sources/buildDescription.xml", "fmi3/fmi3BuildDescription.xsd");
}

/// The unit with what a compiler makes of its own sources, as on another system, in place of its binary.
inline Unit of_sources(Unit unit) {
  unit.library = unit.folder / "of_sources.so";
  const std::string command = fmt::format(
      "cd {}/sources && cc -std=c99 -O1 -ffp-contract=off -fPIC -shared -fvisibility=hidden -Wall -Wextra -Werror -pedantic "
      "-o ../of_sources.so *.c -lm 2>&1",
      unit.folder.string());
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  return unit;
}

/// What an importer must do.
struct Asked {
  bool co_simulation = true;
  double step_s = 60.0;
  std::size_t rewind_at_row = 0;
  int ambient_from_input = -1;
  bool tells_behind_step = false;
  const char* fails_with = nullptr;  ///< words with which the run must end
};
struct Told {
  std::vector<std::vector<double>> of;  ///< per output, per row
  importer_run run = {};
};

/// @param inputs  channels, each of which has the name of an input
inline Told import_unit(const Unit& unit, const Record& inputs, const std::vector<std::string>& outputs,
                        const Asked& asked) {
  const std::size_t n_rows = inputs.n_samples();
  std::vector<unsigned> in, out;
  std::vector<double> rows;
  int ambient = -1;
  for (const Channel& c : inputs.channels) {
    if (c.name == "ambient_temperature") ambient = static_cast<int>(in.size());
    in.push_back(unit.reference.at(c.name));
  }
  for (std::size_t i = 0; i < n_rows; ++i) {
    for (const Channel& c : inputs.channels) rows.push_back(c.values[i]);
  }
  for (const std::string& name : outputs) out.push_back(unit.reference.at(name));
  std::vector<double> told(n_rows * out.size(), NAN);
  const std::string library = unit.library.string();
  Told result;
  importer_run& run = result.run;
  run.library = library.c_str();
  run.guid = unit.guid.c_str();
  run.is_co_simulation = asked.co_simulation;
  run.n_inputs = in.size();
  run.n_rows = n_rows;
  run.inputs = in.data();
  run.time_s = inputs.time_s.data();
  run.input_rows = rows.data();
  run.ambient_from_input = asked.ambient_from_input;
  run.ambient_from_input_reference = 3000;
  run.step_s = asked.step_s;
  run.ambient_input = asked.ambient_from_input == 1 ? ambient : -1;
  run.rewind_at_row = asked.rewind_at_row;
  run.tells_behind_step = asked.tells_behind_step;
  run.n_states = unit.states.size();
  run.states = unit.states.data();
  run.derivatives = unit.derivatives.data();
  run.n_indicators = unit.n_indicators;
  run.n_outputs = out.size();
  run.outputs = out.data();
  run.output_rows = told.data();

  EXPECT_EQ(unit.is_2 ? import_fmi2(&run) : import_fmi3(&run), asked.fails_with ? 1 : 0) << run.wrong;
  EXPECT_THAT(run.wrong, ::testing::HasSubstr(asked.fails_with ? asked.fails_with : ""));
  for (std::size_t o = 0; o < out.size(); ++o) {
    result.of.emplace_back();
    for (std::size_t i = 0; i < n_rows; ++i) result.of[o].push_back(told[i * out.size() + o]);
  }
  return result;
}

inline double largest_gap(const std::vector<double>& a, const std::vector<double>& b, std::size_t n) {
  double gap = 0.0;
  for (std::size_t i = 0; i < n; ++i) gap = std::isnan(a[i] - b[i]) ? HUGE_VAL : std::max(gap, std::abs(a[i] - b[i]));
  return gap;
}

inline std::vector<std::string> names_of(const std::vector<FmuOutput>& outputs) {
  std::vector<std::string> names;
  for (const FmuOutput& o : outputs) names.push_back(o.name);
  return names;
}

/// The drive of a record as an input.
inline Record speed_of(const Record& record) {
  return {.source = "inputs", .time_s = record.time_s, .channels = {{"spindle_speed", "rpm", record.at("speed").values}}};
}
/// The ambient of a scenario as an input, over the rows of other inputs.
inline Channel ambient_of(const scenarios::Scenario& scenario, const Record& inputs) {
  Channel ambient{"ambient_temperature", "degC", {}};
  for (double t_s : inputs.time_s)
    ambient.values.push_back(scenario.machine->ambient.at(t_s) + scenario.machine->reference_K - kZeroCelsius_K);
  return ambient;
}

/// Tests of both versions of the standard.
class OfBothVersions : public ::testing::TestWithParam<FmiVersion> {
 protected:
  [[nodiscard]] std::string name(const char* what) const {
    return std::string(what) + (GetParam() == FmiVersion::k2 ? "2" : "3");
  }
};
inline constexpr auto kVersionName = [](const auto& p) { return p.param == FmiVersion::k2 ? "Fmi2" : "Fmi3"; };

}  // namespace driftwright::output::fmu_test
