// What `import` says of a logger's file.

#include "findings/import_document.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "output/document_json.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::import_document_test {
namespace {

/// Twelve rows of a minute over noon, with marks after the sixth and at the end. As a HOBO logger's export has it: a button
/// that was pressed, and a last row that says only that the file ends.
nlohmann::ordered_json summary_of(const std::string& middle, const std::string& end) {
  std::string text = "\"#\",\"Date Time, GMT+01:00\",\"Temp, °C\",\"Button\",\"End Of File\"\n";
  for (int i = 0; i < 12; ++i) {
    const int minute = 54 + i;
    text += fmt::format("{},03/04/24 {}:{:02d}:00 {},{},,\n", i + 1, minute < 60 ? 11 : 12, minute % 60,
                        minute < 60 ? "AM" : "PM", 20.5 + 0.25 * i);
    if (i == 5) text += middle;
  }
  return output::document_json(
      findings::document_of(studies::import_logger(write_file("marks.csv", text + end), "", {}), {}));
}

TEST(ImportDocument, CountsRowsWithoutAReading) {
  const auto marked = summary_of("7,03/04/24 11:59:00 AM,,Logged,\n", "14,03/04/24 12:05:07 PM,,,Logged\n");
  EXPECT_EQ(marked["rows"], 12);
  EXPECT_EQ(marked["rows_without_reading"], 2);
  EXPECT_EQ(marked["duration_min"], 11.0);
  EXPECT_EQ(marked["longest_step_s"], 60.0);
  EXPECT_FALSE(summary_of("", "").contains("rows_without_reading"));
}

}  // namespace
}  // namespace driftwright::import_document_test
