#include "app/record_study.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/errors.hpp"
#include "compensation/product_sums.hpp"
#include "compensation/regression_quality.hpp"

namespace driftwright::app {
namespace {

constexpr std::size_t kMostPairs = 5;  // of near-duplicates that are named
constexpr double kWorthAWord = 0.01;   // share of rows in which a sensor is missing

}  // namespace

StudyRecords read_records(const scenarios::Study& study, const RecordOptions& options) {
  StudyRecords records;
  for (const std::string& file : options.train) {
    for (const std::string& test : options.test) {
      std::error_code ignored;
      if (std::filesystem::equivalent(file, test, ignored)) {
        throw InputError(fmt::format("{}: a record cannot be both trained on and judged by", file));
      }
    }
    if (std::count(options.train.begin(), options.train.end(), file) > 1) {
      throw InputError(fmt::format("{}: --train names this record twice; it would count double", file));
    }
    records.train.push_back(read_record_csv(file));
    (void)records.train.back().at(study.target);
  }
  for (const std::string& file : options.test) {
    records.test.push_back(read_record_csv(file));
    (void)records.test.back().at(study.target);
  }
  return records;
}

std::vector<std::string> sensor_warnings(const std::vector<Record>& records, const std::vector<std::string>& candidates) {
  std::vector<std::string> lines;
  std::vector<std::string> moving;
  for (const std::string& name : candidates) {
    std::size_t n = 0, n_missing = 0;
    double low = INFINITY, high = -INFINITY;
    for (const Record& record : records) {
      for (double v : record.at(name).values) {
        ++n;
        if (std::isnan(v)) {
          ++n_missing;
          continue;
        }
        low = std::min(low, v);
        high = std::max(high, v);
      }
    }
    const double missing = static_cast<double>(n_missing) / static_cast<double>(n);
    if (missing > kWorthAWord)
      lines.push_back(fmt::format("{} has no value in {:.0f} % of the rows; no fit that uses it sees these rows", name,
                                  100.0 * missing));
    if (n_missing < n && !(high > low)) {
      lines.push_back(
          fmt::format("{} reads {:.4g} in every row: flat, broken or not connected; it is not chosen", name, low));
    } else if (n_missing < n) {
      moving.push_back(name);
    }
  }
  if (moving.size() < 2) return lines;
  const std::vector<compensation::NearDuplicate> pairs = compensation::near_duplicates(records, moving);
  for (std::size_t i = 0; i < std::min(pairs.size(), kMostPairs); ++i) {
    lines.push_back(fmt::format(
        "{} and {} move as one (correlation {:.4f}); a regression on both shares the effect between them arbitrarily",
        pairs[i].first, pairs[i].second, pairs[i].correlation));
  }
  if (pairs.size() > kMostPairs) lines.push_back(fmt::format("so do {} more pairs", pairs.size() - kMostPairs));
  return lines;
}

}  // namespace driftwright::app
