#pragma once
// Cells of a row of CSV that may hold words of any kind (RFC 4180; line breaks become spaces). Records have their own, stricter
// form in record.hpp.

#include <string>
#include <vector>

namespace driftwright {

/// A cell, in quotes where it holds a comma or a quote.
[[nodiscard]] std::string csv_cell(std::string text);
/// The cells of a row, without quotes.
[[nodiscard]] std::vector<std::string> csv_cells(const std::string& row);

}  // namespace driftwright
