#pragma once
// File names made from names that the program did not choose: of records, programs, cyclograms.

#include <cstddef>
#include <string>

namespace driftwright {

/// Largest length of a result file's name [bytes]. File systems allow 255; while results are being written, up to 20 bytes
/// are appended.
inline constexpr std::size_t kLongestFileName = 235;

/// stem + ending as a valid file name: UTF-8, without slashes and control characters, at most kLongestFileName bytes. A stem
/// that is too long is cut between two letters and followed by the first half of its hash, so that two long names stay
/// different.
/// @param ending  one of the program, such as ".csv", or that of an input file
[[nodiscard]] std::string file_name(const std::string& stem, const std::string& ending);

}  // namespace driftwright
