#include "app/record_study.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/errors.hpp"
#include "compensation/product_sums.hpp"
#include "compensation/regression_quality.hpp"

namespace driftwright::app {
namespace {

constexpr std::size_t kMostPairs = 5;    // of near-duplicates that are named
constexpr double kCommonScatter = 0.03;  // of a sensor's share from run to run, at least
constexpr double kWorthAWord = 0.01;     // share of rows in which a sensor is missing

/// Sizes of the sensors' movements in each record, against the mean one there: n_records x n_sensors, logarithms.
Eigen::MatrixXd shares(const std::vector<Record>& records, const std::vector<std::string>& sensors) {
  Eigen::MatrixXd share(static_cast<Eigen::Index>(records.size()), static_cast<Eigen::Index>(sensors.size()));
  for (Eigen::Index r = 0; r < share.rows(); ++r) {
    for (Eigen::Index s = 0; s < share.cols(); ++s) {
      const std::vector<double>& x = records[static_cast<std::size_t>(r)].at(sensors[static_cast<std::size_t>(s)]).values;
      double sum = 0.0, squares = 0.0, n = 0.0;
      for (double v : x) {
        if (std::isnan(v)) continue;
        sum += v;
        squares += v * v;
        ++n;
      }
      share(r, s) = std::log(std::max(1e-3, std::sqrt(std::max(0.0, squares / n - sum * sum / (n * n)))));
    }
    share.row(r).array() -= share.row(r).mean();
  }
  return share;
}

/// Pairs of sensors that in one record behave as each other: exchanging them there brings that record in line with the others, and out
/// of line it is by far more than sensors commonly are from run to run.
std::vector<std::tuple<std::string, std::string, std::string>> exchanged(const std::vector<Record>& records,
                                                                         const std::vector<std::string>& sensors) {
  std::vector<std::tuple<std::string, std::string, std::string>> found;
  if (records.size() < 2 || sensors.size() < 4) return found;
  const Eigen::MatrixXd share = shares(records, sensors);
  for (Eigen::Index r = 0; r < share.rows(); ++r) {
    const Eigen::RowVectorXd others = (share.colwise().sum() - share.row(r)) / static_cast<double>(share.rows() - 1);
    Eigen::RowVectorXd off = (share.row(r) - others).cwiseAbs();
    std::vector<double> sorted(off.begin(), off.end());
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
    const double common = std::max(kCommonScatter, sorted[sorted.size() / 2]);
    for (Eigen::Index a = 0; a < share.cols(); ++a) {
      for (Eigen::Index b = a + 1; b < share.cols(); ++b) {
        const double as_is = std::min(off(a), off(b)),
                     as_other = std::max(std::abs(share(r, a) - others(b)), std::abs(share(r, b) - others(a)));
        if (as_is > 4.0 * common && as_other < 2.0 * common)
          found.emplace_back(sensors[static_cast<std::size_t>(a)], sensors[static_cast<std::size_t>(b)],
                             records[static_cast<std::size_t>(r)].source);
      }
    }
  }
  if (records.size() == 2 && found.size() == 2) found.pop_back();  // of two records, which of them it is cannot be told
  return found;
}

}  // namespace

StudyRecords read_records(const scenarios::Study& study, const RecordOptions& options) {
  StudyRecords records;
  const auto read = [&](const std::string& file, std::vector<Record>& into) {
    Record record = read_record_csv(file);
    const Channel& target = record.at(study.target);
    if (target.unit != "um")
      throw InputError(fmt::format(
          "{}: the target '{}' is in {}; strategies, tolerances and corrections are in um: name and scale the column so",
          file, study.target, target.unit));
    for (const std::vector<Record>* others : {&records.train, &records.test}) {
      for (const Record& other : *others) {
        if (other.time_s == record.time_s && other.at(study.target).values == target.values)
          throw InputError(
              fmt::format("{} and {} hold the same run; one run can be trained on or judged by, once", other.source, file));
      }
    }
    into.push_back(std::move(record));
  };
  for (const std::string& file : options.train) read(file, records.train);
  for (const std::string& file : options.test) read(file, records.test);
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
  for (const auto& [a, b, source] : exchanged(records, moving))
    lines.push_back(fmt::format(
        "{} and {} look exchanged in {}: each rises there as the other does elsewhere; look at the wiring", a, b, source));
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
