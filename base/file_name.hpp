#pragma once
// Names of files that are made from names of elsewhere: of records, programs, cyclograms.

#include <cstddef>
#include <string>

namespace driftwright {

/// Bytes of the longest name of a file of results. File systems take 255; a folder of results under way has up to 20 more behind its name.
inline constexpr std::size_t kLongestFileName = 235;

/// stem + ending as the name of one file: UTF-8, without slashes and control characters, no longer than kLongestFileName. A stem that is too long is
/// cut between two letters, and the first half of its hash stands behind it, so that two long names stay two.
/// @param ending  of our own, such as ".csv", or that of a file of elsewhere
[[nodiscard]] std::string file_name(const std::string& stem, const std::string& ending);

}  // namespace driftwright
