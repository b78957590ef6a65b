#include "base/csv_row.hpp"

#include <gtest/gtest.h>

namespace driftwright::output::csv_row_test {
namespace {

TEST(CsvRow, ReadsBackWhatItWrites) {
  const std::vector<std::string> cells = {"1", "", "two words", "a,b", "say \"hm\", or", "\"", "line\nbreak"};
  std::string row;
  for (std::size_t i = 0; i < cells.size(); ++i) row.append(i ? "," : "").append(csv_cell(cells[i]));
  EXPECT_EQ(row, "1,,two words,\"a,b\",\"say \"\"hm\"\", or\",\"\"\"\",line break");
  std::vector<std::string> back = cells;
  back.back() = "line break";
  EXPECT_EQ(csv_cells(row), back);
}

}  // namespace
}  // namespace driftwright::output::csv_row_test
