#pragma once
// A randomly broken input, the same for the same seed and number.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace driftwright::fuzz {

struct Sample {
  std::string extension;  ///< ".csv"
  std::string bytes;
};

/// Good files; folders give all files below them with one of these extensions; sorted by name. @throws InputError  if
/// there are none
[[nodiscard]] std::vector<Sample> read_corpus(const std::vector<std::filesystem::path>& places,
                                              const std::vector<std::string>& extensions);

/// One of the files after one to eight mutations; one in a hundred is unchanged.
/// @param words  meaningful words of the format, to be inserted
[[nodiscard]] Sample mutated(const std::vector<Sample>& corpus, const std::vector<std::string>& words, std::uint64_t seed,
                             std::uint64_t number);

}  // namespace driftwright::fuzz
