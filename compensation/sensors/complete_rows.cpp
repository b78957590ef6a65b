#include "compensation/sensors/complete_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"

namespace driftwright::compensation {

CompleteRows complete_rows(std::span<const Record> records, const std::vector<std::string>& channels) {
  if (records.empty()) throw InputError("no record was given; at least one is required");

  CompleteRows rows;
  std::vector<std::vector<double>> kept;
  for (const Record& record : records) {
    rows.first.push_back(static_cast<Eigen::Index>(kept.size()));
    std::vector<const Channel*> columns;
    for (std::size_t j = 0; j < channels.size(); ++j) {
      columns.push_back(&record.at(channels[j]));
      if (&record == &records.front()) rows.units.push_back(columns[j]->unit);
      if (columns[j]->unit != rows.units[j]) {
        throw InputError(fmt::format("channel '{}' is in {} in {} but in {} in {}; give it one unit", channels[j],
                                     rows.units[j], records.front().source, columns[j]->unit, record.source));
      }
    }
    for (std::size_t i = 0; i < record.n_samples(); ++i) {
      std::vector<double> row;
      for (const Channel* column : columns) row.push_back(column->values[i]);
      if (std::all_of(row.begin(), row.end(), [](double x) { return std::isfinite(x); })) {
        kept.push_back(std::move(row));
      } else {
        ++rows.n_left_out;
      }
    }
  }

  rows.first.push_back(static_cast<Eigen::Index>(kept.size()));
  rows.values.resize(static_cast<Eigen::Index>(kept.size()), static_cast<Eigen::Index>(channels.size()));
  for (Eigen::Index i = 0; i < rows.values.rows(); ++i) {
    const std::vector<double>& row = kept[static_cast<std::size_t>(i)];
    rows.values.row(i) = Eigen::Map<const Eigen::RowVectorXd>(row.data(), rows.values.cols());
  }
  return rows;
}

}  // namespace driftwright::compensation
