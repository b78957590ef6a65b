#pragma once
// A whole LinuxCNC without a screen: three axes of 5 m, a user interface that is a script.

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "tests/shared/one_hal.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright {

inline bool has_linuxcnc() {
  return std::system("command -v linuxcnc >/dev/null 2>&1 && /usr/bin/python3 -c 'import linuxcnc' >/dev/null 2>&1") == 0;
}

/// @param of_axes  further lines of each axis @param of_joint_0  of the first joint
inline std::string headless_ini(const std::string& of_axes, const std::string& of_joint_0) {
  const auto part = [](const std::string& head) {
    return "[" + head + "]\nMIN_LIMIT = -5000\nMAX_LIMIT = 5000\nMAX_VELOCITY = 4000\nMAX_ACCELERATION = 20000\n";
  };
  std::string text = read_text("tests/shared/linuxcnc.ini") +
                     "MAX_LINEAR_VELOCITY = 4000\nDEFAULT_LINEAR_VELOCITY = 4000\nMAX_LINEAR_ACCELERATION = 20000\n";
  for (const char* letter : {"X", "Y", "Z"}) text += part(std::string("AXIS_") + letter) + of_axes;
  for (int j = 0; j < 3; ++j)
    text += part("JOINT_" + std::to_string(j)) + "TYPE = LINEAR\nFERROR = 1000\nMIN_FERROR = 1000\nHOME_SEQUENCE = 0\n" +
            (j == 0 ? of_joint_0 : "");
  return text;
}

/// HAL of iocontrol, as all machines have it.
inline constexpr const char* kHeadlessIo = R"(net estop iocontrol.0.user-enable-out => iocontrol.0.emc-enable-in
net prepare iocontrol.0.tool-prepare => iocontrol.0.tool-prepared
net change iocontrol.0.tool-change => iocontrol.0.tool-changed
)";

/// Runs LinuxCNC with sim.ini in the folder, which has each file of `files`, and reads the lines "name number" of
/// result.txt.
/// @param files  script.py and sim.hal among them @param seconds  at most
inline std::map<std::string, double> run_headless(const std::filesystem::path& folder,
                                                  const std::map<std::string, std::string>& files, int seconds) {
  using std::filesystem::perms;
  for (const auto& [name, text] : files) {
    std::filesystem::create_directories((folder / name).parent_path());
    std::ofstream(folder / name) << text;
  }
  std::filesystem::create_directories(folder / "fifo");
  std::filesystem::permissions(folder / "script.py", perms::all);
  std::filesystem::permissions(folder / "fifo", perms::all);  // the realtime process gives root up and makes its pipe there
  const std::string command = "cd " + folder.string() +
                              " && RTAPI_UID=65534 RTAPI_FIFO_PATH=" + (folder / "fifo" / "f").string() + " " + kOneHal +
                              "timeout " + std::to_string(seconds) + " linuxcnc -r sim.ini > log.txt 2>&1";
  std::map<std::string, double> found;
  found["exit"] = std::system(command.c_str());
  std::istringstream rows(read_text(folder / "result.txt"));
  for (std::string name; rows >> name;) {
    if (!(rows >> found[name])) {
      found["error"] = 1.0;
      break;
    }
  }
  return found;
}

}  // namespace driftwright
