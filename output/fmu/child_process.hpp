#pragma once
// The C compiler at work for us, in a folder that goes away.

#include <filesystem>
#include <string>
#include <vector>

namespace driftwright::output {

/// A folder of our own under the system's temporary one, gone with this object.
class TemporaryFolder {
 public:
  /// @param purpose  goes into its name
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
  int start_error = 0;   ///< errno where it could not be started, else 0
  bool is_done = false;  ///< it ended with exit code 0
  std::string messages;  ///< what it wrote to standard output and standard error
};

/// Runs a program that is found along PATH and waits for it. @param folder  its current one, where its messages are kept meanwhile
[[nodiscard]] ChildEnd run_child(std::vector<std::string> arguments, const std::filesystem::path& folder);

}  // namespace driftwright::output
