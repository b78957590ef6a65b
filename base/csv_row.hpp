#pragma once
// Cells of a row of CSV that may contain any text (RFC 4180; line breaks become spaces). Records have their own, stricter
// format in record.hpp.

#include <string>
#include <vector>

namespace driftwright {

/// A cell, in quotes if it contains a comma or a quote.
[[nodiscard]] std::string csv_cell(std::string text);
/// The cells of a row, without quotes.
[[nodiscard]] std::vector<std::string> csv_cells(const std::string& row);

}  // namespace driftwright
