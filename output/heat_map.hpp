#pragma once
// A matrix of numbers as coloured cells, with each number in its cell, as an <svg> element.

#include <string>
#include <vector>

namespace driftwright::output {

struct HeatMap {
  struct Column {
    std::string group;  ///< neighbouring columns of one group share a heading; may be empty
    std::string title;  ///< may be empty
  };
  std::vector<Column> columns;
  std::vector<std::string> rows;
  std::vector<std::vector<double>> values;  ///< one list per row, one value per column; NaN: none; infinite: without bound
  double limit = 1.0;                       ///< > 0; values below are good (blue), above bad (orange), near it pale
  std::string unit;                         ///< as shown to people
};

/// The colour depends on the logarithm of value / limit and is full at a quarter and at four times the limit.
/// Colour-blind readers can distinguish the colours, and each cell shows its number.
/// @throws std::logic_error  if the values do not fit rows and columns
[[nodiscard]] std::string draw_heat_map(const HeatMap& map);

}  // namespace driftwright::output
