#include "driftwright/command.hpp"

#include "app/command_line.hpp"
#include "base/version.hpp"

namespace driftwright {

int command(const std::vector<std::string>& arguments) {
  std::vector<const char*> argv = {"driftwright"};
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  return app::command_line(static_cast<int>(argv.size()), argv.data());
}

const char* version() {
  return kVersion;
}

}  // namespace driftwright
