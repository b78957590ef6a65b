#pragma once
// A matrix of numbers as coloured cells, with each number in its cell, as an <svg> element.

#include <string>
#include <vector>

namespace driftwright::output {

struct HeatMap {
  struct Column {
    std::string group;  ///< columns of one group that follow each other share a heading; may be empty
    std::string title;  ///< may be empty
  };
  std::vector<Column> columns;
  std::vector<std::string> rows;
  std::vector<std::vector<double>> values;  ///< of each row, one a column; NaN: there is none; infinite: without bound
  double limit = 1.0;                       ///< > 0; what is below it is good: blue, above it bad: orange, at it pale
  std::string unit;                         ///< as people see it
};

/// Colours go with the logarithm of value / limit, full at a quarter and at four times the limit; they are distinguished by the colour-blind, and
/// the numbers stand in the cells.
/// @throws std::logic_error  where values do not fit rows and columns
[[nodiscard]] std::string draw_heat_map(const HeatMap& map);

}  // namespace driftwright::output
