#pragma once
// Tables that the program writes, as cells.

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "base/csv_row.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::fixtures {

using Table = std::vector<std::vector<std::string>>;

/// Header and rows of a table, without comments.
inline Table read_table(const std::filesystem::path& file) {
  Table rows;
  std::istringstream in(read_text(file));
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("#")) rows.push_back(csv_cells(line));
  }
  return rows;
}

}  // namespace driftwright::fixtures
