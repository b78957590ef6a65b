#pragma once
// Runs a reader on broken inputs, one after another, and counts how it takes them.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace driftwright::fuzz {

struct Target {
  std::string name;
  std::vector<std::filesystem::path> corpus;                    ///< files and folders, from the top of the project
  std::vector<std::string> extensions;                          ///< of files in those folders
  std::vector<std::string> words;                               ///< that mean something in the format
  std::function<void(const std::filesystem::path& file)> read;  ///< throws what it refuses with
  std::string file_name = "input";                              ///< that an input gets, without its extension
};

/// The whole of a fuzzing program: --seconds S, --inputs N, --seed K, --from N (the first number), --keep FOLDER (for inputs that were
/// findings), --only N (that input alone, in this process).
///
/// Inputs are read in a child process; one that dies or takes longer than 20 s of processor time is followed by another child, from the next input on. Memory is
/// bounded by 6 GB, and what needs more counts as refused.
/// @return 0 without findings, 1 with some, 2 for wrong options
int run(int argc, char** argv, const Target& target);

}  // namespace driftwright::fuzz
