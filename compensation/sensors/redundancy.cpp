#include "compensation/sensors/redundancy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/errors.hpp"
#include "base/median.hpp"
#include "compensation/sensors/blocks.hpp"
#include "compensation/sensors/product_sums.hpp"

namespace driftwright::compensation {
namespace {

constexpr double kRidge = 0.03;            // penalty of a relation, columns of unit deviation
constexpr double kMedianToSigma = 1.4826;  // of a normal distribution
constexpr std::size_t kLeastRecords = 4;   // the median of three relations is the fewest that outvotes one

Relation relation_of(const ProductSums& sums, const Eigen::MatrixXd& rows) {
  std::vector<int> columns(static_cast<std::size_t>(sums.n_inputs()));
  std::iota(columns.begin(), columns.end(), 0);
  const ScaledFit fit = fit_columns(rows, columns, kRidge);
  const double unit = sums.deviation(sums.n_inputs());
  Relation r{.intercept = sums.mean(sums.n_inputs()) + unit * fit.intercept, .coefficient = {}};
  for (Eigen::Index j = 0; j < sums.n_inputs(); ++j) {
    r.coefficient.push_back(unit * fit.slope(j) / sums.deviation(j));
    r.intercept -= r.coefficient.back() * sums.mean(j);
  }
  return r;
}

/// The difference that a run of rows keeps for at least kDepartsFor_s: the largest of the smallest ones, and its first row.
struct Lasting {
  double off = 0.0;
  std::size_t row = 0;
};
Lasting lasting(const std::vector<double>& time_s, const std::vector<double>& off) {
  Lasting most;
  for (std::size_t i = 0; i < off.size(); ++i) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = i; k < off.size() && std::isfinite(off[k]); ++k) {
      least = std::min(least, std::abs(off[k]));
      if (least <= most.off) break;
      if (time_s[k] - time_s[i] < kDepartsFor_s) continue;
      most = {least, i};
      break;
    }
  }
  return most;
}

/// A thermometer less its prediction by the relations of the other records, row by row, and the scatter of these.
struct Departure {
  std::vector<double> off, scatter;
};
Departure departure(const std::vector<double>& read, const std::vector<std::vector<double>>& expected) {
  Departure d;
  std::vector<double> at;
  for (std::size_t i = 0; i < read.size(); ++i) {
    at.clear();
    for (const std::vector<double>& e : expected) {
      if (std::isfinite(read[i] - e[i])) at.push_back(read[i] - e[i]);
    }
    d.off.push_back(at.empty() ? std::numeric_limits<double>::quiet_NaN() : upper_median(at));
    for (double& off : at) off = std::abs(off - d.off.back());
    d.scatter.push_back(kMedianToSigma * upper_median(at));
  }
  return d;
}

/// One thermometer, judged by the others.
struct Judged {
  DoubtedThermometer as_doubted;
  double times = 0.0;  // its usual difference
};
Judged judged(std::span<const Record> given, const std::string& name, const std::vector<std::string>& others,
              double reading_K) {
  const std::vector<Record> records = in_blocks({given.begin(), given.end()}, name);
  const ProductSums sums = product_sums(records, others, name);
  std::vector<Departure> departures;
  std::vector<double> all;
  for (std::size_t r = 0; r < records.size(); ++r) {
    std::vector<std::vector<double>> expected;
    for (std::size_t fitted = 0; fitted < records.size(); ++fitted) {
      const bool has_enough = sums.by_record[fitted](0, 0) > static_cast<double>(others.size() + 1);
      if (fitted != r && has_enough)
        expected.push_back(relation_of(sums, sums.by_record[fitted]).predict(records[r], others));
    }
    departures.push_back(departure(records[r].at(name).values, expected));
    for (double off : departures.back().off) {
      if (std::isfinite(off)) all.push_back(std::abs(off));
    }
  }
  Judged worst{.as_doubted = {.name = name, .record = {}}};
  if (all.empty()) return worst;
  const double usual = std::max(kMedianToSigma * upper_median(all), reading_K);
  worst.as_doubted.usual_K = usual;
  for (std::size_t r = 0; r < records.size(); ++r) {
    std::vector<double>& off = departures[r].off;
    for (std::size_t i = 0; i < off.size(); ++i) off[i] *= usual / std::max(usual, departures[r].scatter[i]);
    const Lasting l = lasting(records[r].time_s, off);
    if (!(l.off > worst.as_doubted.off_K)) continue;
    std::size_t first = l.row;  // it had departed before it was farthest off
    while (first > 0 && std::abs(off[first - 1]) > kDeparts * usual) --first;
    worst.as_doubted.record = records[r].source;
    worst.as_doubted.from_s = records[r].time_s[first];
    worst.as_doubted.off_K = l.off;
  }
  worst.times = worst.as_doubted.off_K / usual;
  return worst;
}

bool changes(std::span<const Record> records, const std::string& channel) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Record& record : records) {
    for (double x : record.at(channel).values) {
      if (!std::isfinite(x)) continue;
      low = std::min(low, x);
      high = std::max(high, x);
    }
  }
  return high > low;
}

}  // namespace

std::vector<double> Relation::predict(const Record& record, const std::vector<std::string>& others) const {
  std::vector<double> predicted(record.n_samples(), intercept);
  for (std::size_t j = 0; j < others.size(); ++j) {
    const std::vector<double>& x = record.at(others[j]).values;
    for (std::size_t i = 0; i < x.size(); ++i) predicted[i] += coefficient[j] * x[i];
  }
  return predicted;
}

Relation relation(std::span<const Record> records, const std::string& input, const std::vector<std::string>& others) {
  const ProductSums sums = product_sums(records, others, input);
  return relation_of(sums, sums.total());
}

std::vector<DoubtedThermometer> doubted_thermometers(std::span<const Record> records, std::vector<std::string> thermometers,
                                                     const std::vector<std::string>& beside, double reading_K) {
  if (records.size() > 1 && records.size() < kLeastRecords) return {};
  std::erase_if(thermometers, [&](const std::string& name) { return !changes(records, name); });
  const std::size_t most = thermometers.size() / 3;
  std::vector<DoubtedThermometer> doubted;
  while (thermometers.size() > 1) {
    Judged worst;
    for (const std::string& name : thermometers) {
      std::vector<std::string> others = thermometers;
      std::erase(others, name);
      others.insert(others.end(), beside.begin(), beside.end());
      try {
        Judged j = judged(records, name, others, reading_K);
        if (j.times > worst.times) worst = std::move(j);
      } catch (const InputError&) {  // no row has all readings, or it never changes in those that have
        continue;
      }
    }
    if (!(worst.times > kDeparts)) break;
    if (doubted.size() == most) return {};
    std::erase(thermometers, worst.as_doubted.name);
    doubted.push_back(std::move(worst.as_doubted));
  }
  for (DoubtedThermometer& d : doubted)
    d.is_alone = std::count_if(doubted.begin(), doubted.end(),
                               [&](const DoubtedThermometer& other) { return other.record == d.record; }) == 1;
  return doubted;
}

}  // namespace driftwright::compensation
