#pragma once
// Runs a program such as the C compiler in a temporary folder.

#include <filesystem>
#include <string>
#include <vector>

namespace driftwright::output {

/// A folder of our own under the system's temporary one; it is removed with this object.
class TemporaryFolder {
 public:
  /// @param purpose  part of its name
  /// @throws InputError  naming the folder and the system's reason
  explicit TemporaryFolder(const std::string& purpose);
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] std::filesystem::path path() const { return path_; }

 private:
  std::string path_;
};

struct ChildEnd {
  int start_error = 0;   ///< errno if it could not be started, else 0
  bool is_done = false;  ///< it ended with exit code 0
  std::string messages;  ///< what it wrote to standard output and standard error
};

/// Runs a program that is found along PATH and waits for it.
/// @param folder  its working directory; its messages are stored there meanwhile
[[nodiscard]] ChildEnd run_child(std::vector<std::string> arguments, const std::filesystem::path& folder);

}  // namespace driftwright::output
