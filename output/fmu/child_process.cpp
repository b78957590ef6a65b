#include "output/fmu/child_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "base/errors.hpp"

namespace driftwright::output {

namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder(const std::string& purpose)
    : path_((fs::temp_directory_path() / ("driftwright-" + purpose + "-XXXXXX")).string()) {
  if (mkdtemp(path_.data()) == nullptr) {
    throw InputError(fmt::format("cannot make a temporary folder '{}': {}; TMPDIR says where it is made", path_, std::strerror(errno)));
  }
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

ChildEnd run_child(std::vector<std::string> arguments, const fs::path& folder) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "messages", O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);
  std::vector<char*> argv;
  for (std::string& a : arguments) argv.push_back(a.data());
  argv.push_back(nullptr);
  pid_t pid = 0;
  ChildEnd end{.start_error = posix_spawnp(&pid, argv[0], &actions, nullptr, argv.data(), environ), .messages = {}};
  posix_spawn_file_actions_destroy(&actions);
  if (end.start_error != 0) return end;
  int status = 0;
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  end.is_done = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  std::ifstream in(folder / "messages", std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  end.messages = text.str();
  return end;
}

}  // namespace driftwright::output
