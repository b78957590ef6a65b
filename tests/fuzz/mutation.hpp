#pragma once
// An input that is broken by chance, the same for the same seed and number.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace driftwright::fuzz {

struct Sample {
  std::string extension;  ///< ".csv"
  std::string bytes;
};

/// Good files, folders taken with all that is in them and of one of these extensions; sorted by name. @throws InputError  where there is none
[[nodiscard]] std::vector<Sample> read_corpus(const std::vector<std::filesystem::path>& places,
                                              const std::vector<std::string>& extensions);

/// One of them after one to eight mutations; each hundredth as it is.
/// @param words  that mean something in the format, to be put in
[[nodiscard]] Sample mutated(const std::vector<Sample>& corpus, const std::vector<std::string>& words, std::uint64_t seed,
                             std::uint64_t number);

}  // namespace driftwright::fuzz
