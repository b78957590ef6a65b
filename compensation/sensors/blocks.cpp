#include "compensation/sensors/blocks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/record_channel.hpp"

namespace driftwright::compensation {
std::vector<Record> in_blocks(std::vector<Record> records, const std::string& target) {
  if (records.size() != 1) return records;
  const std::vector<double> drift = records.front().at(target).values;
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < drift.size(); ++i) {
    if (std::isfinite(drift[i])) rows.push_back(i);
  }
  if (rows.size() < 2 * kBlocks) return records;
  std::vector<Record> blocks(kBlocks, records.front());
  for (std::size_t b = 0; b < kBlocks; ++b) {
    std::vector<double>& own = changeable_channel(blocks[b], target).values;
    std::fill(own.begin(), own.end(), std::numeric_limits<double>::quiet_NaN());
    for (std::size_t k = rows.size() * b / kBlocks; k < rows.size() * (b + 1) / kBlocks; ++k) own[rows[k]] = drift[rows[k]];
  }
  return blocks;
}

double longest_lag_s(const std::vector<Record>& records, const std::string& target) {
  double shortest_s = std::numeric_limits<double>::infinity();
  for (const Record& record : records) {
    const std::vector<double>& drift = record.at(target).values;
    const auto last = std::find_if(drift.rbegin(), drift.rend(), [](double v) { return std::isfinite(v); });
    if (last == drift.rend()) continue;
    const auto row = static_cast<std::size_t>(drift.rend() - last) - 1;
    shortest_s = std::min(shortest_s, record.time_s[row] - record.time_s.front());
  }
  return shortest_s / 3.0;
}

}  // namespace driftwright::compensation
