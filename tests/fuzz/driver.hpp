#pragma once
// Runs a reader on broken inputs, one after another, and counts how it handles them.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace driftwright::fuzz {

struct Target {
  std::string name;
  std::vector<std::filesystem::path> corpus;                    ///< files and folders, from the top of the project
  std::vector<std::string> extensions;                          ///< of files in those folders
  std::vector<std::string> words;                               ///< meaningful in the format
  std::function<void(const std::filesystem::path& file)> read;  ///< throws to refuse an input
  std::string file_name = "input";                              ///< name of an input's file, without extension
};

/// A whole fuzzing program: --seconds S, --inputs N, --seed K, --from N (the first number), --keep FOLDER (for inputs
/// that were findings), --only N (that input alone, in this process).
///
/// Inputs are read in a child process. If it crashes or takes more than 20 s of processor time, another child continues
/// with the next input. Memory is limited to 6 GB; inputs that need more count as refused.
/// @return 0 without findings, 1 with some, 2 for wrong options
int run(int argc, char** argv, const Target& target);

}  // namespace driftwright::fuzz
