#pragma once
// Lengths and words as inserted lines have them, for the languages that write them (nc/language.hpp).

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace driftwright {

/// The value of an offset after rounding to 1e-6 mm or 1e-7 inch, as it is written.
[[nodiscard]] double as_written_m(double x_m, double unit_m);

/// "0.0125", "-3": no trailing zeros, no exponent.
[[nodiscard]] std::string written_length(double x_m, double unit_m);
/// "+0.0125", "-3".
[[nodiscard]] std::string signed_length(double x_m, double unit_m);

/// " X0.0125 Z-3": the axes that have a value. @param write  written_length or signed_length
[[nodiscard]] std::string axis_words(const std::array<std::optional<double>, 3>& x_m, double unit_m,
                                     std::string (*write)(double x_m, double unit_m));

/// A straight line in words of ISO 6983, with `feed` (such as "F200") or none; in incremental mode by G90 and back.
/// @param words  its motion word and positions, such as "G1 X5"
[[nodiscard]] std::vector<std::string> iso_straight_lines(std::string words, const std::string& feed, bool absolute);

}  // namespace driftwright
