#include "compensation/fail_safe.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/errors.hpp"
#include "compensation/drift_model.hpp"
#include "compensation/product_sums.hpp"

namespace driftwright::compensation {
namespace {

// Room beside what the training records kept.
constexpr double kRangeRoom = 0.2;  // of a range's width, on both sides
constexpr double kClampRoom = 0.5;  // of the drift's
constexpr double kJumpRoom = 2.0;   // times the largest
constexpr double kSlewRoom = 2.0;   // times the largest rate of the prediction, over ten rows
constexpr double kApartRoom = 2.0;  // times the largest distance on a run left out
constexpr double kLeastRoom_K = 3.0, kLeastJump_K = 1.0, kLeastApart_K = 1.5;  // below, instruments are what is seen
constexpr double kMoved_K = 3.0, kNeverApart_K = 1e3;  // less than that is no movement to learn a relation from
constexpr double kRidge = 0.03;                        // penalty of a relation, columns of unit deviation
constexpr std::size_t kSlewRows = 10;
constexpr double kSoonEnough = 1e-6;  // of a period: times that are sums of steps round
constexpr double kUntold = 1e-6;      // pivot below which only others in doubt tell of an input

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  void take(double x) {
    if (std::isnan(x)) return;
    low = std::min(low, x);
    high = std::max(high, x);
  }
  [[nodiscard]] double width() const { return high - low; }
};

/// What the others say of an input: ridge regression, for what thermometers that move alike have in common holds in another hall too,
/// and their small differences do not.
struct Relation {
  double intercept = 0.0;
  std::vector<double> coefficient;  // of the others
  [[nodiscard]] std::vector<double> predict(const Record& record, const std::vector<std::string>& others) const {
    std::vector<double> predicted(record.n_samples(), intercept);
    for (std::size_t j = 0; j < others.size(); ++j) {
      const std::vector<double>& x = record.at(others[j]).values;
      for (std::size_t i = 0; i < x.size(); ++i) predicted[i] += coefficient[j] * x[i];
    }
    return predicted;
  }
};
Relation relation(std::span<const Record> records, const std::string& input, const std::vector<std::string>& others) {
  const ProductSums sums = product_sums(records, others, input);
  std::vector<int> columns(others.size());
  std::iota(columns.begin(), columns.end(), 0);
  const ScaledFit fit = fit_columns(sums.total(), columns, kRidge);
  const double unit = sums.deviation(sums.n_inputs());
  Relation r{.intercept = sums.mean(sums.n_inputs()) + unit * fit.intercept, .coefficient = {}};
  for (std::size_t j = 0; j < others.size(); ++j) {
    const auto k = static_cast<Eigen::Index>(j);
    r.coefficient.push_back(unit * fit.slope(k) / sums.deviation(k));
    r.intercept -= r.coefficient.back() * sums.mean(k);
  }
  return r;
}

bool moved(std::span<const Record> training, const std::string& input) {
  Range range;
  for (const Record& record : training) {
    for (double x : record.at(input).values) range.take(x);
  }
  return range.width() > kMoved_K;
}

/// The largest distance between an input and what the others lead to, on records left out where there are two or more.
double most_apart(std::span<const Record> training, const std::string& input, const std::vector<std::string>& others) {
  double apart = 0.0;
  for (std::size_t left_out = 0; left_out < training.size(); ++left_out) {
    std::vector<Record> rest;
    for (std::size_t r = 0; r < training.size(); ++r) {
      if (r != left_out || training.size() == 1) rest.push_back(training[r]);
    }
    const std::vector<double> expected = relation(rest, input, others).predict(training[left_out], others);
    const std::vector<double>& read = training[left_out].at(input).values;
    for (std::size_t i = 0; i < read.size(); ++i) {
      if (std::isfinite(read[i] - expected[i])) apart = std::max(apart, std::abs(read[i] - expected[i]));
    }
  }
  return apart;
}

/// What one guard remembers from row to row.
struct Watch {
  double start = kMissing;  // first reading, where readings count from it
  double base = 0.0;        // what they are written with: the first reading of the first row
  double last = kMissing, last_s = 0.0;
  double doubted_until_s = -std::numeric_limits<double>::infinity();
  bool was_doubted = false;
};

double expected_by_others(const FailSafe::Guard& guard, const std::vector<double>& x) {
  double expected = guard.others_intercept;
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (guard.others_coefficient[k] != 0.0) expected += guard.others_coefficient[k] * x[k];
  }
  return expected;
}

/// Replaces those that are out by what the other inputs lead to, all at once: x_k - sum_l b_kl x_l = b_k + sum_j b_kj x_j with k and l out
/// and j not. One that only others that are out tell of is untold and stays as it is.
void replace(const FailSafe& safe, const std::vector<char>& is_out, std::vector<double>& x, std::vector<char>& is_untold) {
  const std::size_t n = x.size();
  std::vector<std::vector<double>> a(n, std::vector<double>(n + 1, 0.0));
  for (std::size_t k = 0; k < n; ++k) {
    is_untold[k] = 0;
    if (!is_out[k]) continue;
    a[k][k] = 1.0;
    a[k][n] = safe.guards[k].others_intercept;
    for (std::size_t j = 0; j < n; ++j) {
      const double b = safe.guards[k].others_coefficient[j];
      if (is_out[j]) {
        a[k][j] -= b;
      } else if (b != 0.0) {
        a[k][n] += b * x[j];
      }
    }
  }
  for (std::size_t k = 0; k < n; ++k) {
    if (!is_out[k]) continue;
    if (!(a[k][k] > kUntold)) {
      is_untold[k] = 1;
      for (std::size_t j = 0; j < n; ++j) a[k][j] = j == k ? 1.0 : 0.0;
      a[k][n] = x[k];
    }
    for (std::size_t i = 0; i < n; ++i) {
      if (!is_out[i] || i == k) continue;
      const double share = a[i][k] / a[k][k];
      for (std::size_t j = k; j <= n; ++j) a[i][j] -= share * a[k][j];
    }
  }
  for (std::size_t k = 0; k < n; ++k) {
    if (is_out[k]) x[k] = a[k][n] / a[k][k];
  }
}

}  // namespace

FailSafe learn_fail_safe(std::span<const Record> as_given, const std::vector<std::string>& inputs,
                         const std::vector<std::vector<double>>& predicted, bool from_start) {
  std::vector<Record> training(as_given.begin(), as_given.end());
  if (from_start) {
    for (Record& record : training) record = counted_from_start(std::move(record), {});
  }
  FailSafe safe;
  safe.from_start = from_start;
  Range drift;
  double rate = 0.0;
  std::vector<double> steps_s;
  for (std::size_t r = 0; r < training.size(); ++r) {
    const std::vector<double>&d = predicted[r], &t = training[r].time_s;
    for (std::size_t i = 0; i < d.size(); ++i) {
      drift.take(d[i]);
      if (i > 0) steps_s.push_back(t[i] - t[i - 1]);
      const std::size_t rows = std::min(kSlewRows, d.size() - 1);
      if (i < rows || rows == 0) continue;
      const double over = (d[i] - d[i - rows]) / (t[i] - t[i - rows]);
      if (std::isfinite(over)) rate = std::max(rate, std::abs(over));
    }
  }
  if (steps_s.empty())
    throw InputError("training records of one row tell nothing about steps; two rows at least are needed");
  std::nth_element(steps_s.begin(), steps_s.begin() + static_cast<std::ptrdiff_t>(steps_s.size() / 2), steps_s.end());
  safe.period_s = steps_s[steps_s.size() / 2];
  safe.stale_s = 5.0 * safe.period_s;
  safe.fade_s = 10.0 * safe.period_s;
  drift.take(0.0);  // no correction is always allowed
  safe.lowest_um = drift.low - kClampRoom * drift.width();
  safe.highest_um = drift.high + kClampRoom * drift.width();
  safe.most_rate_um_s = kSlewRoom * rate;

  for (const std::string& input : inputs) {
    const bool is_speed = is_drive(training.front().at(input).unit);
    FailSafe::Guard g;
    g.input = input;
    g.unit = training.front().at(input).unit;
    Range range;
    double jump = 0.0;
    for (const Record& record : training) {
      const std::vector<double>& x = record.at(input).values;
      for (std::size_t i = 0; i < x.size(); ++i) {
        range.take(x[i]);
        if (i > 0 && std::isfinite(x[i] - x[i - 1])) jump = std::max(jump, std::abs(x[i] - x[i - 1]));
      }
    }
    const double room = std::max(kRangeRoom * range.width(), is_speed ? 0.0 : kLeastRoom_K);
    g.low = range.low - room;
    g.high = range.high + room;
    g.most_jump = is_speed ? std::numeric_limits<double>::infinity() : std::max(kJumpRoom * jump, kLeastJump_K);
    std::vector<std::string> others;
    for (const std::string& other : inputs) {
      if (other != input && !is_drive(training.front().at(other).unit) && moved(training, other)) others.push_back(other);
    }
    if (!is_speed && !others.empty()) {
      // one that hardly moved in the training runs is told by its mean there, and in doubt only when it is missing or jumps
      const bool has_moved = moved(training, input);
      const Relation r = has_moved ? relation(training, input, others)
                                   : Relation{0.5 * (range.low + range.high), std::vector<double>(others.size(), 0.0)};
      g.others_intercept = r.intercept;
      for (const std::string& other : inputs) {
        const auto at = std::find(others.begin(), others.end(), other);
        g.others_coefficient.push_back(at == others.end() ? 0.0
                                                          : r.coefficient[static_cast<std::size_t>(at - others.begin())]);
      }
      g.most_apart = has_moved ? std::max(kApartRoom * most_apart(training, input, others), kLeastApart_K) : kNeverApart_K;
    }
    safe.guards.push_back(std::move(g));
  }
  return safe;
}

int most_replaced(std::size_t n_inputs) {
  return std::max(1, static_cast<int>(n_inputs / 3));
}

Repaired repaired(const FailSafe& safe, Record readings) {
  const std::size_t n = safe.guards.size();
  Repaired result{.readings = std::move(readings), .deserved = {}, .events = {}};
  const std::vector<double>& time_s = result.readings.time_s;
  std::vector<std::vector<double>*> channel;
  for (const FailSafe::Guard& g : safe.guards) {
    channel.push_back(
        &result.readings.channels[static_cast<std::size_t>(&result.readings.at(g.input) - result.readings.channels.data())]
             .values);
  }
  std::vector<Watch> watches(n, Watch{.last_s = time_s.front()});
  const int most_doubted = most_replaced(n);
  std::vector<double> x(n), before(n, 0.0);
  std::vector<char> is_out(n), is_untold(n, 0);
  std::vector<std::string> why(n);
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    const double t_s = time_s[i];
    const auto doubt = [&](std::size_t k, std::string reason) {
      if (why[k].empty()) why[k] = std::move(reason);
      watches[k].doubted_until_s = t_s + kBackAfter * safe.fade_s;
    };
    const auto is_doubted = [&](std::size_t k) { return t_s < watches[k].doubted_until_s - kSoonEnough * safe.period_s; };
    for (std::size_t k = 0; k < n; ++k) {
      const FailSafe::Guard& g = safe.guards[k];
      Watch& w = watches[k];
      why[k].clear();
      double read = (*channel[k])[i];
      if (safe.from_start && !is_drive(g.unit)) {
        if (std::isnan(w.start) && i == 0) w.base = std::isnan(read) ? 0.0 : read;
        if (std::isnan(w.start)) w.start = read - before[k];  // one that comes late goes on from what stood for it
        read -= w.start;
      }
      if (std::isnan(read)) {
        if (std::isnan(w.last) || t_s - w.last_s > safe.stale_s + kSoonEnough * safe.period_s) doubt(k, "gives no reading");
      } else {
        const double steps = std::max(1.0, (t_s - w.last_s) / safe.period_s);
        if (std::isfinite(w.last) && std::abs(read - w.last) > steps * g.most_jump)
          doubt(k, fmt::format("jumps by {:.2f} {}", read - w.last, g.unit));
        w.last = read;
        w.last_s = t_s;
      }
      x[k] = std::isnan(w.last) ? 0.0 : w.last;
    }
    for (std::size_t pass = 0; pass <= n; ++pass) {
      for (std::size_t k = 0; k < n; ++k) is_out[k] = is_doubted(k) && !safe.guards[k].others_coefficient.empty();
      if (std::any_of(is_out.begin(), is_out.end(), [](char out) { return out; })) replace(safe, is_out, x, is_untold);
      for (std::size_t k = 0; pass == 0 && k < n; ++k) {
        if (is_out[k] && !(std::abs(watches[k].last - x[k]) <= kBackWithin * safe.guards[k].most_apart)) doubt(k, {});
      }
      std::size_t worst = n;
      double most = 1.0;
      for (std::size_t k = 0; k < n; ++k) {
        const FailSafe::Guard& g = safe.guards[k];
        if (is_doubted(k) || g.others_coefficient.empty()) continue;
        const double apart = std::abs(x[k] - expected_by_others(g, x)) / g.most_apart;
        if (apart > most) {
          most = apart;
          worst = k;
        }
      }
      if (worst == n) break;
      const FailSafe::Guard& g = safe.guards[worst];
      doubt(worst, fmt::format("is {:+.2f} {} from what the others say", x[worst] - expected_by_others(g, x), g.unit));
    }
    double deserved = 1.0;
    int n_doubted = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const FailSafe::Guard& g = safe.guards[k];
      Watch& w = watches[k];
      const bool is_rise = safe.from_start && !is_drive(g.unit);
      if (is_rise && i == 0) x[k] = 0.0;
      if (is_doubted(k) && (++n_doubted > most_doubted || g.others_coefficient.empty() || is_untold[k])) deserved = 0.0;
      const double outside = std::max({0.0, g.low - x[k], x[k] - g.high});
      if (outside > 0.0) deserved = std::min(deserved, std::max(0.0, 1.0 - outside / (g.high - g.low)));
      if (is_doubted(k) && !w.was_doubted)
        result.events.push_back(fmt::format("from {:.0f} min: {} {}", t_s / 60.0, g.input, why[k]));
      w.was_doubted = is_doubted(k);
      (*channel[k])[i] = std::clamp(x[k], g.low, g.high) + (is_rise ? w.base : 0.0);
      before[k] = x[k];
    }
    result.deserved.push_back(deserved);
  }
  return result;
}

GuardedCorrection guarded(const FailSafe& safe, const Repaired& readings, std::span<const double> predicted) {
  GuardedCorrection result{.correction_um = {}, .trust = {}, .events = readings.events};
  const std::vector<double>& time_s = readings.readings.time_s;
  double trust = 1.0, in_force = 0.0, last = 0.0;
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    const double step_s = i > 0 ? time_s[i] - time_s[i - 1] : 0.0, deserved = readings.deserved[i];
    trust = i == 0 ? deserved : trust + (1.0 - std::exp(-step_s / safe.fade_s)) * (deserved - trust);
    if (std::isfinite(predicted[i])) last = predicted[i];
    const double wanted = std::clamp(trust * last, safe.lowest_um, safe.highest_um);
    const double most_um = safe.most_rate_um_s * step_s;
    in_force = i == 0 ? wanted : in_force + std::clamp(wanted - in_force, -most_um, most_um);
    result.correction_um.push_back(in_force);
    result.trust.push_back(trust);
  }
  return result;
}

}  // namespace driftwright::compensation
