#pragma once
// A machine for `driftwright schedule`, and what the verb writes of a program for it.

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/shared/command_line.hpp"

namespace driftwright {

/// One lumped body that grows 60 um along z over hours, as a milling head does, and half as much along x.
inline constexpr const char* kScheduledHead = R"(name: head
reference_temperature: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: head, capacity: 60 kJ/K}
  - {type: motor_loss, node: head, power: 300 W, at_speed: 2000 rpm, exponent: 1}
  - {type: link, node: head, to: ambient, conductance: 20 W/K}
ambient: [[0 h, 20 degC], [9 h, 20 degC]]
sensors: [{name: t_head, node: head}]
displacements:
  - {name: nose_z, sensitivities: [{node: head, sensitivity: 4 um/K}]}
  - {name: nose_x, sensitivities: [{node: head, sensitivity: -2 um/K}]}
cyclograms: {warm_up: [[60 min, 2000 rpm]]}
schedule:
  axes: {x: {displacement: nose_x, sign: -1, tolerance: 4 um}, z: {displacement: nose_z}}
  tolerance: 10 um
  rapid: 10 m/min
)";

struct Scheduled {
  CommandOutcome outcome;
  std::filesystem::path folder;
};

inline Scheduled run_schedule(const std::string& name, const std::string& program, const std::string& arguments = "",
                              const std::string& scenario = kScheduledHead) {
  const auto folder = fresh_folder(name);
  std::ofstream(folder / "head.yaml") << scenario;
  std::ofstream(folder / "part.ngc", std::ios::binary) << program;
  const auto out = folder / "out";
  return {run_program("schedule " + (folder / "head.yaml").string() + " --program " + (folder / "part.ngc").string() +
                      " -o " + out.string() + " " + arguments),
          out};
}

}  // namespace driftwright
