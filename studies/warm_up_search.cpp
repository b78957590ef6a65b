#include "studies/warm_up_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.hpp"

namespace driftwright::studies {
namespace {

constexpr double kLeast_s = 1.0;  // shorter sections are left out
constexpr double kExact = 0.005;  // relative accuracy of the shortest time
constexpr int kTimes = 16;        // times at which one speed is tried before the bisection
constexpr int kSpeeds = 25;       // number of speeds up to the limit, for one speed
constexpr double kBeyond = 1.2;   // relative to the best time so far: the minimum of a peak appears only between times
constexpr int kStages = 7,
              kShares = 7;  // for two speeds: speeds from rest to the limit, and shares of the first in the time
constexpr std::size_t kMostWarmUpSections = 4;
constexpr int kEnds = 10;            // divisions of the time, at which one of three sections may end
constexpr int kImproved = 3;         // number of best programmes with another section that are improved
constexpr double kFirstGain = 0.02;  // first share of its time that another section is tried to save
constexpr int kScanned = 8;          // times at which two speeds are tried if one is never enough

bool has_less_drift(const WarmUp& a, const WarmUp& b) {
  return a.peak_um < b.peak_um;
}

std::size_t n_sections(const WarmUpSearch::Shape& shape) {
  return (shape.size() + 1) / 2;
}

/// Whole seconds and tens of rpm, so that the written programme is the judged one.
std::vector<Cyclogram::Section> staged(double time_s, const WarmUpSearch::Shape& shape, double most_rpm) {
  const auto rpm = [&](double share) {
    return std::min(most_rpm, kWarmUpStep_rpm * std::round(std::clamp(share, 0.0, 1.0) * most_rpm / kWarmUpStep_rpm));
  };
  std::vector<Cyclogram::Section> sections;
  const std::size_t n = n_sections(shape);
  double from_s = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double end_s = i + 1 < n ? std::round(std::clamp(shape[n + i], 0.0, 1.0) * time_s) : std::round(time_s);
    if (end_s - from_s < kLeast_s) continue;
    const double speed_rpm = rpm(shape[i]);
    if (!sections.empty() && sections.back().drive.speed_rpm == speed_rpm) {
      sections.back().duration_s += end_s - from_s;
    } else {
      sections.push_back({end_s - from_s, {.speed_rpm = speed_rpm}});
    }
    from_s = end_s;
  }
  return sections;
}

WarmUpSearch::Shape shape_of(const WarmUp& way, double most_rpm) {
  WarmUpSearch::Shape speeds, ends;
  double time_s = 0.0;
  for (const Cyclogram::Section& section : way.sections) {
    speeds.push_back(section.drive.speed_rpm / most_rpm);
    ends.push_back((time_s += section.duration_s) / way.duration_s());
  }
  speeds.insert(speeds.end(), ends.begin(), ends.end() - 1);
  return speeds;
}

/// Inserts a section of a tenth of the time before section `at`, or after all.
WarmUpSearch::Shape with_section(const WarmUpSearch::Shape& shape, std::size_t at, double share) {
  constexpr double kTenth = 0.1;
  const std::size_t n = n_sections(shape);
  WarmUpSearch::Shape longer(shape.begin(), shape.begin() + static_cast<std::ptrdiff_t>(n));
  longer.insert(longer.begin() + static_cast<std::ptrdiff_t>(at), share);
  const double begins = (1.0 - kTenth) * (at == 0 ? 0.0 : at == n ? 1.0 : shape[n + at - 1]);
  for (std::size_t i = 0; i < n; ++i) {
    if (i == at) longer.push_back(begins + kTenth);
    if (i + 1 < n) longer.push_back((1.0 - kTenth) * shape[n + i] + (i >= at ? kTenth : 0.0));
    if (i + 1 == at && at == n) longer.push_back(begins);
  }
  return longer;
}

}  // namespace

WarmUp WarmUpSearch::constant(double time_s, double share) const {
  return trials_.tried(staged(time_s, {share}, most_rpm_), tolerance_um_);
}

WarmUp WarmUpSearch::of(double time_s, const Shape& shape) const {
  return trials_.tried(staged(time_s, shape, most_rpm_), tolerance_um_);
}

WarmUp WarmUpSearch::least_time(double share, double most_s) const {
  const WarmUp at_once = trials_.tried({}, tolerance_um_);
  if (at_once.is_enough) return at_once;
  std::vector<double> time_s = {0.0};
  std::vector<WarmUp> ways = {at_once};
  while (!ways.back().is_enough && static_cast<int>(ways.size()) <= kTimes) {
    time_s.push_back(most_s * std::pow(static_cast<double>(ways.size()) / kTimes, 2.0));
    ways.push_back(constant(time_s.back(), share));
  }
  // Between two of these times the job may be within the tolerance briefly, on the way from too cold to too warm: the
  // peak has a minimum there.
  for (std::size_t i = 1; i + 1 < ways.size(); ++i) {
    if (ways[i].peak_um > ways[i - 1].peak_um || ways[i].peak_um > ways[i + 1].peak_um) continue;
    const WarmUp least = least_between(time_s[i - 1], time_s[i + 1], share);
    if (least.is_enough) return shortened(least, time_s[i - 1], share);
    if (least.peak_um < ways[i].peak_um) ways[i] = least;
  }
  if (ways.back().is_enough) return shortened(ways.back(), time_s[time_s.size() - 2], share);
  WarmUp best = at_once;
  for (const WarmUp& way : ways) {
    if (way.peak_um < kWorthTelling * best.peak_um) best = way;
  }
  return best;
}

WarmUp WarmUpSearch::constant() const {
  listener_.begin("one speed");
  std::vector<double> shares;
  for (int i = 1; i <= kSpeeds; ++i) shares.push_back(static_cast<double>(i) / kSpeeds);
  WarmUp best = best_of(shares, most_s_);
  if (best.sections.empty() || !best.is_enough) return best;
  for (double step = 0.5 / kSpeeds; step * most_rpm_ >= 0.5 * kWarmUpStep_rpm; step *= 0.5) {
    for (bool helped = true; helped;) {
      const double at = best.sections.front().drive.speed_rpm / most_rpm_;
      const WarmUp next =
          best_of({std::max(at - step, 0.0), std::min(at + step, 1.0)}, std::min(most_s_, kBeyond * best.duration_s()));
      helped = next.is_enough && next.duration_s() < best.duration_s() && !next.sections.empty();
      if (helped) best = next;
    }
  }
  return best;
}

WarmUp WarmUpSearch::constant_in(double time_s) const {
  std::vector<WarmUp> ways(kSpeeds + 1);
  parallel_for(ways.size(), [&](std::size_t i) { ways[i] = constant(time_s, static_cast<double>(i) / kSpeeds); });
  return *std::min_element(ways.begin(), ways.end(), has_less_drift);
}

WarmUp WarmUpSearch::staged_in(double time_s, Shape& shape) const {
  WarmUp best = improved(of(time_s, shape), time_s, shape);
  if (best.is_enough) return best;
  std::vector<Shape> grid;
  for (int i = 0; i < kStages; ++i) {
    for (int j = 0; j < kStages; ++j) {
      for (int k = 1; k <= kShares; ++k)
        grid.push_back({static_cast<double>(i) / (kStages - 1), static_cast<double>(j) / (kStages - 1),
                        static_cast<double>(k) / (kShares + 1)});
    }
  }
  std::vector<WarmUp> tried(grid.size());
  parallel_for(grid.size(), [&](std::size_t i) { tried[i] = of(time_s, grid[i]); });
  std::vector<std::size_t> order(grid.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return tried[a].peak_um < tried[b].peak_um; });
  for (std::size_t i = 0; i < 3 && !best.is_enough; ++i) {
    Shape from = grid[order[i]];
    const WarmUp next = improved(tried[order[i]], time_s, from);
    if (next.peak_um >= best.peak_um) continue;
    best = next;
    shape = from;
  }
  return best;
}

WarmUp WarmUpSearch::staged_best(const WarmUp& known) const {
  listener_.begin("two speeds");
  if (known.is_enough && known.sections.empty()) return known;
  const double share = known.sections.empty() ? 0.5 : known.sections.front().drive.speed_rpm / most_rpm_;
  Shape shape = {share, share, 0.5};
  WarmUp best = known;
  double low_s = 0.0;
  for (int i = 1; i <= kScanned && !best.is_enough && !listener_.wants_end(); ++i) {
    const double time_s = most_s_ * std::pow(static_cast<double>(i) / kScanned, 2.0);
    const WarmUp next = staged_in(time_s, shape);
    if (next.is_enough || next.peak_um < kWorthTelling * best.peak_um) best = next;
    if (!best.is_enough) low_s = time_s;
    listener_.share(static_cast<double>(i) / kScanned);
  }
  if (!best.is_enough) return best;
  const double first_s = best.duration_s();
  while (best.duration_s() - low_s > std::max(1.0, kExact * best.duration_s())) {
    if (listener_.wants_end()) break;
    const double time_s = std::round(0.5 * (low_s + best.duration_s()));
    Shape at = shape;
    const WarmUp next = staged_in(time_s, at);
    if (next.is_enough && next.duration_s() < best.duration_s()) {
      best = next;
      shape = at;
    } else {
      low_s = time_s;
    }
    listener_.share(1.0 - (best.duration_s() - low_s) / first_s);
  }
  return best;
}

WarmUp WarmUpSearch::with_one_more(const WarmUp& known, double time_s) const {
  const Shape shape = shape_of(known, most_rpm_);
  std::vector<Shape> longer;
  for (std::size_t at = 0; at <= n_sections(shape); ++at) {
    for (double share : {0.0, 0.25, 0.5, 0.75, 1.0}) longer.push_back(with_section(shape, at, share));
  }
  if (n_sections(shape) == 2) {  // on or off, which is fastest if heat follows the drive and the machine is linear
    for (int speeds = 0; speeds < 8; ++speeds) {
      for (int i = 1; i < kEnds; ++i) {
        for (int j = i + 1; j < kEnds; ++j)
          longer.push_back({static_cast<double>(speeds & 1), static_cast<double>((speeds >> 1) & 1),
                            static_cast<double>(speeds >> 2), static_cast<double>(i) / kEnds,
                            static_cast<double>(j) / kEnds});
      }
    }
  }
  std::vector<WarmUp> tried(longer.size());
  parallel_for(longer.size(), [&](std::size_t i) { tried[i] = of(time_s, longer[i]); });
  WarmUp best;
  for (int i = 0; i < kImproved && !best.is_enough; ++i) {
    const auto least = std::min_element(tried.begin(), tried.end(), has_less_drift);
    const WarmUp next = improved(*least, time_s, longer[static_cast<std::size_t>(least - tried.begin())]);
    if (i == 0 || next.peak_um < best.peak_um) best = next;
    least->peak_um = std::numeric_limits<double>::max();
  }
  return best;
}

WarmUp WarmUpSearch::refined(const WarmUp& known) const {
  WarmUp best = known;
  for (bool helped = !best.sections.empty(); helped && best.sections.size() < kMostWarmUpSections;) {
    listener_.begin(fmt::format("{} speeds", best.sections.size() + 1));
    if (!best.is_enough) {
      const WarmUp next = with_one_more(best, best.duration_s());
      helped = next.is_enough || next.peak_um < kWorthTelling * best.peak_um;
      if (helped) best = next;
      continue;
    }
    const double known_s = best.duration_s();
    double least_s = 0.0;  // longest time without a sufficient programme
    for (double gain = kFirstGain; best.duration_s() - least_s > std::max(1.0, kExact * best.duration_s());) {
      if (listener_.wants_end()) break;
      const double time_s = std::round(std::max(best.duration_s() * (1.0 - gain), 0.5 * (least_s + best.duration_s())));
      const WarmUp next = with_one_more(best, time_s);
      gain = next.is_enough ? 2.0 * gain : 0.5 * gain;
      if (next.is_enough && next.duration_s() < best.duration_s()) {
        best = next;
      } else {
        least_s = time_s;
      }
    }
    helped = best.duration_s() < known_s;
  }
  return best;
}

WarmUp WarmUpSearch::least_between(double low_s, double high_s, double share) const {
  constexpr double kGolden = 0.6180339887498949;
  double a_s = high_s - kGolden * (high_s - low_s), b_s = low_s + kGolden * (high_s - low_s);
  WarmUp a = constant(a_s, share), b = constant(b_s, share);
  for (int i = 0; i < 14 && !a.is_enough && !b.is_enough && high_s - low_s > 2.0; ++i) {
    if (a.peak_um < b.peak_um) {
      high_s = b_s;
      b = a;
      b_s = a_s;
      a_s = high_s - kGolden * (high_s - low_s);
      a = constant(a_s, share);
    } else {
      low_s = a_s;
      a = b;
      a_s = b_s;
      b_s = low_s + kGolden * (high_s - low_s);
      b = constant(b_s, share);
    }
  }
  return a.is_enough || (!b.is_enough && a.peak_um < b.peak_um) ? a : b;
}

WarmUp WarmUpSearch::shortened(WarmUp best, double low_s, double share) const {
  while (best.duration_s() - low_s > std::max(1.0, kExact * best.duration_s())) {
    const double time_s = std::round(0.5 * (low_s + best.duration_s()));
    const WarmUp next = constant(time_s, share);
    if (next.is_enough && next.duration_s() < best.duration_s()) {
      best = next;
    } else {
      low_s = time_s;
    }
  }
  return best;
}

WarmUp WarmUpSearch::best_of(const std::vector<double>& shares, double most_s) const {
  std::vector<WarmUp> tried(shares.size());
  parallel_for(shares.size(), [&](std::size_t i) { tried[i] = least_time(shares[i], most_s); });
  return *std::min_element(tried.begin(), tried.end(), [](const WarmUp& a, const WarmUp& b) {
    if (a.is_enough != b.is_enough) return a.is_enough;
    return a.is_enough ? a.duration_s() < b.duration_s() : a.peak_um < b.peak_um;
  });
}

WarmUp WarmUpSearch::improved(WarmUp best, double time_s, Shape& shape) const {
  for (double step = 0.12; step > 0.004 && !best.is_enough; step *= 0.5) {
    for (bool helped = true; helped && !best.is_enough;) {
      std::vector<Shape> around;
      for (std::size_t i = 0; i < shape.size(); ++i) {
        for (double sign : {-1.0, 1.0}) {
          Shape next = shape;
          next[i] = std::clamp(next[i] + sign * step, 0.0, 1.0);
          if (next != shape) around.push_back(next);
        }
      }
      std::vector<WarmUp> tried(around.size());
      parallel_for(around.size(), [&](std::size_t i) { tried[i] = of(time_s, around[i]); });
      const auto least = std::min_element(tried.begin(), tried.end(), has_less_drift);
      helped = least->peak_um < best.peak_um;
      if (!helped) continue;
      shape = around[static_cast<std::size_t>(least - tried.begin())];
      best = *least;
    }
  }
  return best;
}

}  // namespace driftwright::studies
