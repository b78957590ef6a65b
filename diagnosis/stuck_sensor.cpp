#include "diagnosis/stuck_sensor.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

namespace driftwright::diagnosis {
namespace {

constexpr std::size_t kStuckRows = 30;   // equal readings of a channel with fine resolution
constexpr std::size_t kJudgedRows = 20;  // equal readings after which the other channels decide
constexpr std::size_t kFewestRows = 20;  // least rows outside the stretch, to fit on
constexpr double kManySteps = 5.0;       // steps that it should have moved
constexpr double kJumpSteps = 2.5;       // steps by which a stuck sensor must jump when it recovers
constexpr double kBeyondMisses = 3.0;    // ratio to the neighbour's errors elsewhere
constexpr double kExtrapolation = 2.0;   // ratio to the channel's own range elsewhere; a larger movement cannot be learned
constexpr double kLags_s[] = {900.0, 3600.0};

/// Runs of equal readings; rows without a reading do not end them.
std::vector<StuckStretch> equal_runs(const std::vector<double>& values, std::size_t fewest) {
  std::vector<StuckStretch> runs;
  std::size_t first = 0, last = 0, n = 0;
  const auto end_run = [&] {
    if (n >= fewest) runs.push_back({first, last, {}, 0.0});
  };
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i])) continue;
    if (n == 0 || values[i] != values[last]) {
      end_run();
      first = i;
      n = 0;
    }
    last = i;
    ++n;
  }
  end_run();
  return runs;
}

/// A channel through a first-order lag; gaps hold the last value.
std::vector<double> lagged(const std::vector<double>& time_s, const std::vector<double>& values, double lag_s) {
  std::vector<double> out(values.size(), 0.0);
  double at = std::nan("");
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isnan(values[i])) {
      at = std::isnan(at) ? values[i] : at + (values[i] - at) * -std::expm1(-(time_s[i] - time_s[i - 1]) / lag_s);
    }
    out[i] = at;
  }
  return out;
}

/// Rows x (1, neighbour, neighbour after each lag).
Eigen::MatrixXd features(const Record& record, const Channel& neighbour) {
  const auto n = static_cast<Eigen::Index>(record.n_samples());
  Eigen::MatrixXd x(n, 4);
  x.col(0).setOnes();
  x.col(1) = Eigen::Map<const Eigen::VectorXd>(neighbour.values.data(), n);
  for (Eigen::Index l = 0; l < 2; ++l) {
    const std::vector<double> late = lagged(record.time_s, neighbour.values, kLags_s[l]);
    x.col(2 + l) = Eigen::Map<const Eigen::VectorXd>(late.data(), n);
  }
  return x;
}

/// Range of the predictions of a fit to some rows for other rows, after subtracting the readings there if requested.
std::optional<double> range_of(const Eigen::MatrixXd& x, const std::vector<double>& y,
                               const std::vector<std::size_t>& learnt, const std::vector<std::size_t>& asked,
                               bool minus_readings) {
  if (learnt.size() < kFewestRows || asked.empty()) return std::nullopt;
  Eigen::MatrixXd xx = Eigen::MatrixXd::Zero(x.cols(), x.cols());
  Eigen::VectorXd xy = Eigen::VectorXd::Zero(x.cols()), middle = Eigen::VectorXd::Zero(x.cols());
  for (std::size_t i : learnt) middle += x.row(static_cast<Eigen::Index>(i)).transpose();
  middle /= static_cast<double>(learnt.size());
  middle[0] = 0.0;
  for (std::size_t i : learnt) {
    const Eigen::VectorXd row = x.row(static_cast<Eigen::Index>(i)).transpose() - middle;
    xx += row * row.transpose();
    xy += row * y[i];
  }
  xx.diagonal() *= 1.0 + 1e-6;  // for lags with equal values
  xx.diagonal().array() += 1e-12;
  const Eigen::VectorXd slope = xx.ldlt().solve(xy);
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t i : asked) {
    const double said = (x.row(static_cast<Eigen::Index>(i)).transpose() - middle).dot(slope);
    low = std::min(low, said - (minus_readings ? y[i] : 0.0));
    high = std::max(high, said - (minus_readings ? y[i] : 0.0));
  }
  return high - low;
}

struct Judgement {
  double moves = 0.0, misses = std::numeric_limits<double>::infinity();
};

/// The movement of the channel in a stretch as predicted by a neighbour, and the prediction's error in stretches
/// elsewhere that it was not fitted to.
Judgement judged_by(const Record& record, const Channel& neighbour, const Channel& channel, const StuckStretch& stretch) {
  const Eigen::MatrixXd x = features(record, neighbour);
  std::vector<std::size_t> inside, outside;
  for (std::size_t i = 0; i < channel.values.size(); ++i) {
    if (std::isnan(channel.values[i]) || !x.row(static_cast<Eigen::Index>(i)).allFinite()) continue;
    (i >= stretch.first && i <= stretch.last ? inside : outside).push_back(i);
  }
  Judgement j;
  const auto moves = range_of(x, channel.values, outside, inside, false);
  if (!moves) return j;
  const std::size_t length = std::min(inside.size(), outside.size() / 3);
  const bool at_the_end = outside.back() < stretch.first;  // then no row after it was used for the fit
  double worst = 0.0;
  int n = 0;
  for (std::size_t from = 0; length > 0 && from + length <= outside.size(); from += std::max<std::size_t>(1, length / 2)) {
    std::vector<std::size_t> learnt, asked;
    for (std::size_t k = 0; k < outside.size(); ++k) {
      if (k >= from && k < from + length) {
        asked.push_back(outside[k]);
      } else if (k < from || !at_the_end) {
        learnt.push_back(outside[k]);
      }
    }
    if (at_the_end && learnt.size() < outside.size() / 3) continue;
    const auto missed = range_of(x, channel.values, learnt, asked, true);
    if (!missed) continue;
    worst = std::max(worst, *missed);
    ++n;
  }
  if (n < 2) return j;
  return {*moves, worst};
}

}  // namespace

double quantum_of(const std::vector<double>& values) {
  constexpr double kFinest = 0.01, kRounding = 5.1e-4;  // records have three decimals
  std::map<double, int> distinct;
  int n = 0;
  for (double v : values) {
    if (std::isnan(v)) continue;
    ++distinct[v];
    ++n;
  }
  if (n < 10) return 0.0;
  const auto fits = [&](double step, double zero) {
    return std::all_of(distinct.begin(), distinct.end(), [&](const auto& d) {
      const double steps = (d.first - zero) / step;
      return step * std::abs(steps - std::round(steps)) < std::min(kRounding, 0.06 * step);
    });
  };
  for (double step : {10.0, 5.0, 2.0, 1.0, 0.5, 0.25, 0.2, 0.1, 0.0625, 0.05, 0.02, 0.01}) {
    if (fits(step, 0.0)) return step;
  }
  double smallest = std::numeric_limits<double>::infinity();
  for (auto d = distinct.begin(); d != distinct.end() && std::next(d) != distinct.end(); ++d)
    smallest = std::min(smallest, std::next(d)->first - d->first);
  if (!(smallest < 1e3 && smallest > kFinest)) return 0.0;
  return fits(smallest, 0.0) || fits(smallest, distinct.begin()->first) ? smallest : 0.0;
}

bool dithers(const std::vector<double>& values) {
  int n = 0, n_moves = 0, n_turns = 0;
  double last = std::nan(""), last_move = 0.0;
  for (double v : values) {
    if (std::isnan(v)) continue;
    ++n;
    const double move = v - last;
    last = v;
    if (std::isnan(move) || move == 0.0) continue;
    ++n_moves;
    if (move * last_move < 0.0) ++n_turns;
    last_move = move;
  }
  return n_moves > 0.5 * n && n_turns > 0.3 * n_moves;
}

std::vector<StuckStretch> stuck_stretches(const Record& record, const Channel& channel, double quantum) {
  std::vector<StuckStretch> stuck;
  for (StuckStretch stretch : equal_runs(channel.values, kJudgedRows)) {
    std::vector<double> elsewhere = channel.values;
    std::fill(elsewhere.begin() + static_cast<std::ptrdiff_t>(stretch.first),
              elsewhere.begin() + static_cast<std::ptrdiff_t>(stretch.last) + 1, std::nan(""));
    if (quantum == 0.0 || dithers(elsewhere)) {
      std::size_t n = 0;
      for (std::size_t i = stretch.first; i <= stretch.last; ++i) n += std::isnan(channel.values[i]) ? 0 : 1;
      if (n >= kStuckRows) stuck.push_back(stretch);
      continue;
    }
    const auto next = std::find_if(elsewhere.begin() + static_cast<std::ptrdiff_t>(stretch.last), elsewhere.end(),
                                   [](double v) { return !std::isnan(v); });
    const bool comes_back = next != elsewhere.end();  // if so, by a jump; a sensor at rest moves step by step
    if (comes_back && std::abs(*next - channel.values[stretch.last]) < kJumpSteps * quantum) continue;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (double v : elsewhere) {
      low = v < low ? v : low;
      high = v > high ? v : high;
    }
    if (!(high - low >= kManySteps * quantum)) continue;  // too coarse to learn from
    Judgement best;
    for (const Channel& other : record.channels) {
      const bool is_input = other.name.starts_with("feed_") || other.name == "cutting_power" || other.unit == "W" ||
                            other.unit == "W_m2" || other.unit == "percent" || other.unit == "V" || other.unit == "1";
      if (is_input || other.name == channel.name) continue;
      const Judgement j = judged_by(record, other, channel, stretch);
      if (j.misses >= best.misses) continue;
      best = j;
      stretch.neighbour = other.name;
    }
    const bool is_seen = best.moves < kExtrapolation * (high - low);
    if (!(is_seen && best.moves > kManySteps * quantum && best.moves > kBeyondMisses * best.misses)) continue;
    stretch.missed = best.moves;
    stuck.push_back(stretch);
  }
  return stuck;
}

}  // namespace driftwright::diagnosis
