#pragma once
// LinuxCNC's own interpreter, stand-alone (Debian package linuxcnc-uspace), to check what programs do.

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "tests/shared/one_hal.hpp"

namespace driftwright {

inline bool has_rs274() {
  return std::system("command -v rs274 >/dev/null 2>&1") == 0;
}

inline constexpr const char* kNoRs274 = "no rs274 here; Debian's linuxcnc-uspace has it";

struct Rs274Motion {
  char kind = 'L';                               ///< R rapid, L line, A arc, P probe
  std::array<double, 3> program_mm = {0, 0, 0};  ///< end point, in the coordinates of the program
  std::array<double, 3> machine_mm = {0, 0, 0};  ///< the same with the work offset and the shift of G52 and G92
  double printed_mm = 6e-5;                      ///< its accuracy: four decimals of the unit in force
};

struct Rs274Run {
  bool accepted = false;  ///< exit code 0, and it reached the end
  std::string said;
  std::vector<Rs274Motion> motions;
  std::map<int, double> parameters;  ///< of the parameter file after the run
};

/// @param parameters  for the parameter file before the run, such as 5223 for G54's z; in inches, as this interpreter
/// uses without a machine
inline Rs274Run run_rs274(const std::filesystem::path& program, const std::map<int, double>& parameters = {}) {
  const std::filesystem::path var = program.parent_path() / (program.stem().string() + "_rs274.var");
  std::map<int, double> all;
  for (int n = 5161; n <= 5189; ++n) {
    if (n <= 5169 || n >= 5181) all[n] = 0.0;
  }
  for (int n = 5210; n <= 5220; ++n) all[n] = n == 5220 ? 1.0 : 0.0;
  for (int system = 0; system < 9; ++system) {
    for (int n = 0; n < 10; ++n) all[5221 + 20 * system + n] = 0.0;
  }
  for (const auto& [number, value] : parameters) all[number] = value;
  {
    std::ofstream file(var);
    for (const auto& [number, value] : all) file << number << "\t" << value << "\n";
  }
  Rs274Run run;
  const std::string command = "cd " + program.parent_path().string() + " && " + kOneHal + "rs274 -g -v " + var.string() +
                              " " + program.string() + " 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  char buffer[4096];
  while (std::fgets(buffer, sizeof buffer, pipe)) run.said += buffer;
  run.accepted = pclose(pipe) == 0 && run.said.find("PROGRAM_END") != std::string::npos;
  double unit_mm = 1.0;
  std::array<double, 3> g5x = {0, 0, 0}, g92 = {0, 0, 0};  // mm
  std::istringstream stream(run.said);
  for (std::string line; std::getline(stream, line);) {
    const auto numbers = [&](const char* call, std::array<double, 6>& n, const char* format) {
      const std::size_t at = line.find(call);
      return at != std::string::npos &&
             std::sscanf(line.c_str() + at, format, &n[0], &n[1], &n[2], &n[3], &n[4], &n[5]) >= 3;
    };
    std::array<double, 6> n{};
    if (line.find("USE_LENGTH_UNITS(CANON_UNITS_INCHES)") != std::string::npos) unit_mm = 25.4;
    if (line.find("USE_LENGTH_UNITS(CANON_UNITS_MM)") != std::string::npos) unit_mm = 1.0;
    const auto moved = [&](char kind, const std::array<double, 3>& to) {
      Rs274Motion motion{.kind = kind};
      motion.printed_mm = 6e-5 * unit_mm;
      for (int axis = 0; axis < 3; ++axis) {
        motion.program_mm[axis] = unit_mm * to[axis];
        motion.machine_mm[axis] = motion.program_mm[axis] + g5x[axis] + g92[axis];
      }
      run.motions.push_back(motion);
    };
    if (numbers("SET_G5X_OFFSET(", n, "SET_G5X_OFFSET(%*d, %lf, %lf, %lf, %lf, %lf, %lf"))
      g5x = {unit_mm * n[0], unit_mm * n[1], unit_mm * n[2]};
    if (numbers("SET_G92_OFFSET(", n, "SET_G92_OFFSET(%lf, %lf, %lf, %lf, %lf, %lf"))
      g92 = {unit_mm * n[0], unit_mm * n[1], unit_mm * n[2]};
    if (numbers("STRAIGHT_TRAVERSE(", n, "STRAIGHT_TRAVERSE(%lf, %lf, %lf, %lf, %lf, %lf")) moved('R', {n[0], n[1], n[2]});
    if (numbers("STRAIGHT_FEED(", n, "STRAIGHT_FEED(%lf, %lf, %lf, %lf, %lf, %lf")) moved('L', {n[0], n[1], n[2]});
    if (numbers("STRAIGHT_PROBE(", n, "STRAIGHT_PROBE(%lf, %lf, %lf, %lf, %lf, %lf")) moved('P', {n[0], n[1], n[2]});
    if (numbers("ARC_FEED(", n, "ARC_FEED(%lf, %lf, %lf, %lf, %lf, %lf")) moved('A', {n[0], n[1], n[5]});  // in the plane XY
  }
  std::ifstream file(var);
  int number = 0;
  double value = 0.0;
  while (file >> number >> value) run.parameters[number] = value;
  return run;
}

}  // namespace driftwright
