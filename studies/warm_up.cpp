#include "studies/warm_up.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <atomic>
#include <cmath>
#include <limits>

#include "base/parallel.hpp"
#include "effects/reading_chain.hpp"
#include "machine/machine.hpp"

namespace driftwright::studies {
namespace {

using Sections = std::vector<Cyclogram::Section>;

constexpr double kLeast_s = 1.0;         // shorter sections are left out
constexpr double kSpeedStep_rpm = 10.0;  // speeds are whole multiples of it, times whole seconds
constexpr double kExact = 0.005;         // of a warm-up's time: how closely the shortest is looked for
constexpr int kTimes = 16;               // at which one speed is tried before times are halved
constexpr int kSpeeds = 25;              // up to the limit, of one speed
constexpr double kBeyond = 1.2;  // of the best time so far: the least of a peak shows between times alone
constexpr int kStages = 7, kShares = 7;  // of two: speeds from rest to the limit, and shares of the first in the time
constexpr int kScanned = 8;              // times at which two are tried where one is never enough
constexpr int kMostParts = 200;
constexpr std::size_t kLongestRemark = 200;
constexpr double kWorthTelling = 0.99;  // of a peak: a time that is not enough and takes off less is not worth the wait

double total_s(const Sections& sections) {
  double sum_s = 0.0;
  for (const auto& section : sections) sum_s += section.duration_s;
  return sum_s;
}

/// Two speeds and the share of the first in the time.
using Shape = std::array<double, 3>;

/// Whole seconds and tens of rpm, so that what is written is what was judged.
Sections staged(double time_s, const Shape& shape, double most_rpm) {
  const auto rpm = [&](double share) {
    return std::min(most_rpm, kSpeedStep_rpm * std::round(std::clamp(share, 0.0, 1.0) * most_rpm / kSpeedStep_rpm));
  };
  const double first_s = std::round(std::clamp(shape[2], 0.0, 1.0) * time_s), second_s = std::round(time_s) - first_s;
  Sections sections;
  if (first_s >= kLeast_s) sections.push_back({first_s, {.speed_rpm = rpm(shape[0])}});
  if (second_s >= kLeast_s) {
    const double second_rpm = rpm(shape[1]);
    if (!sections.empty() && sections.back().drive.speed_rpm == second_rpm) {
      sections.back().duration_s += second_s;
    } else {
      sections.push_back({second_s, {.speed_rpm = second_rpm}});
    }
  }
  return sections;
}

/// Runs programmes on the model.
class Trials {
 public:
  Trials(const scenarios::Scenario& scenario, const Cyclogram& job, const WarmUpOptions& options, double most_rpm,
         const Listener& listener)
      : job_(job), transient_(scenario.solver.transient), interval_s_(scenario.solver.output_interval_s) {
    Cyclogram horizon = job;  // as far ahead as any programme looks, and as fast
    horizon.sections.insert(horizon.sections.begin(), {options.most_s, Drive{.speed_rpm = most_rpm}});
    PredictingModels models;
    ahead_ = outlook_of(scenario, horizon, options.from, listener, "warmup", models);
    now_s_ = ahead_.series.start_s();
    for (const auto& d : ahead_.machine.displacements) {
      const auto& wanted = options.channels;
      if (wanted.empty() || std::find(wanted.begin(), wanted.end(), d.name) != wanted.end()) channels_.push_back(d.name);
    }
    for (const std::string& name : options.channels) {
      if (std::find(channels_.begin(), channels_.end(), name) != channels_.end()) continue;
      std::string there;
      for (const auto& d : ahead_.machine.displacements) there += (there.empty() ? "" : ", ") + d.name;
      throw InputError(fmt::format("--channel '{}': no displacement of the machine; there are {}", name, there));
    }
    if (channels_.empty()) throw InputError(ahead_.machine.where, "`warmup` needs a displacement that drifts: add one to `displacements`");
    before_.name = job.name;
    reads_back_ = !effects::reading_chain(ahead_.machine.effects, job.name).empty();
    for (const Cyclogram::Section& section : ahead_.series.cyclogram.sections) {
      if (before_.duration_s() >= now_s_) break;
      before_.sections.push_back(section);
    }
    const auto has_thermostats = [](const auto& system) { return !system.thermostats.empty(); };
    const scenarios::Model& model = *ahead_.model;
    const bool switches = model.reduced() ? has_thermostats(model.reduced()->system) : has_thermostats(model.full()->system);
    if (!reads_back_ && !switches && now_s_ > 0.0) {  // what was before is in the state alone
      (void)scenarios::simulate_run(ahead_.machine, transient_, model, ahead_.start, before_, {now_s_},
                                    [&](double, const Eigen::VectorXd& state) { now_ = state; });
      transient_.from_s = now_s_;
      before_.sections = {{now_s_, Drive{}}};
    } else {
      now_ = ahead_.start;
    }
  }

  /// Rows of the job behind a warm-up, times and displacements from its first row on.
  [[nodiscard]] Record job_rows(const Sections& sections) const {
    Cyclogram all = before_;
    all.sections.insert(all.sections.end(), sections.begin(), sections.end());
    const double start_s = all.duration_s();
    all.sections.insert(all.sections.end(), job_.sections.begin(), job_.sections.end());
    std::vector<double> time_s;
    const double end_s = all.duration_s();
    if (reads_back_) {  // instruments remember what was before, from the first row on
      for (double t_s : scenarios::output_times_s(all, interval_s_)) {
        if (t_s < start_s - 1e-6) time_s.push_back(t_s);
      }
    }
    const auto n_before = static_cast<std::ptrdiff_t>(time_s.size());
    for (double t_s : scenarios::output_times_s(job_, interval_s_)) time_s.push_back(std::min(start_s + t_s, end_s));
    time_s.back() = end_s;
    ++n_tried_;
    Record rows = scenarios::simulate_run(ahead_.machine, transient_, *ahead_.model, now_, all, time_s).record;
    rows.time_s.erase(rows.time_s.begin(), rows.time_s.begin() + n_before);
    for (double& t_s : rows.time_s) t_s -= start_s;
    for (Channel& channel : rows.channels) channel.values.erase(channel.values.begin(), channel.values.begin() + n_before);
    for (Channel& channel : rows.channels) {
      if (channel.unit != "um" && channel.unit != "urad") continue;
      const double zero = channel.values.front();
      for (double& value : channel.values) value -= zero;
    }
    return rows;
  }

  /// A programme that the machine has no solution for is not enough.
  [[nodiscard]] WarmUp tried(Sections sections, double tolerance_um) const {
    WarmUp result{.way = {}, .sections = std::move(sections)};
    Record rows;
    try {
      rows = job_rows(result.sections);
    } catch (const SolveError&) {
      if (result.sections.empty()) throw;
      result.peak_um = std::numeric_limits<double>::max();
      return result;
    }
    for (const std::string& name : channels_) {
      for (double value_um : rows.at(name).values) {
        if (std::abs(value_um) < result.peak_um) continue;
        result.peak_um = std::abs(value_um);
        result.peak_channel = name;
      }
    }
    result.is_enough = result.peak_um <= tolerance_um;
    return result;
  }

  [[nodiscard]] const Outlook& ahead() const { return ahead_; }
  [[nodiscard]] const Cyclogram& job() const { return job_; }
  [[nodiscard]] const std::vector<std::string>& channels() const { return channels_; }
  [[nodiscard]] int n_tried() const { return n_tried_; }

 private:
  const Cyclogram& job_;
  solver::TransientOptions transient_;
  double interval_s_ = 0.0;
  Outlook ahead_;
  double now_s_ = 0.0;
  Cyclogram before_;
  bool reads_back_ = false;  ///< instruments remember
  Eigen::VectorXd now_;
  std::vector<std::string> channels_;
  mutable std::atomic<int> n_tried_ = 0;
};

class Search {
 public:
  Search(const Trials& trials, double tolerance_um, double most_rpm, double most_s, const Listener& listener)
      : trials_(trials), tolerance_um_(tolerance_um), most_rpm_(most_rpm), most_s_(most_s), listener_(listener) {}

  [[nodiscard]] WarmUp constant(double time_s, double share) const {
    return trials_.tried(staged(time_s, {share, share, 1.0}, most_rpm_), tolerance_um_);
  }
  [[nodiscard]] WarmUp of(double time_s, const Shape& shape) const {
    return trials_.tried(staged(time_s, shape, most_rpm_), tolerance_um_);
  }

  /// The least time at one speed; where none is enough, what comes nearest. @param most_s  no longer one is of interest
  [[nodiscard]] WarmUp least_time(double share, double most_s) const {
    const WarmUp at_once = trials_.tried({}, tolerance_um_);
    if (at_once.is_enough) return at_once;
    std::vector<double> time_s = {0.0};
    std::vector<WarmUp> ways = {at_once};
    while (!ways.back().is_enough && static_cast<int>(ways.size()) <= kTimes) {
      time_s.push_back(most_s * std::pow(static_cast<double>(ways.size()) / kTimes, 2.0));
      ways.push_back(constant(time_s.back(), share));
    }
    // A job may be within the tolerance for a moment between two of these, on the way from too cold to too warm: there the peak has a least.
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

  /// The best of all speeds above rest.
  [[nodiscard]] WarmUp constant() const {
    listener_.begin("one speed");
    std::vector<double> shares;
    for (int i = 1; i <= kSpeeds; ++i) shares.push_back(static_cast<double>(i) / kSpeeds);
    WarmUp best = best_of(shares, most_s_);
    if (best.sections.empty() || !best.is_enough) return best;
    for (double step = 0.5 / kSpeeds; step * most_rpm_ >= 0.5 * kSpeedStep_rpm; step *= 0.5) {
      for (bool helped = true; helped;) {
        const double at = best.sections.front().drive.speed_rpm / most_rpm_;
        const WarmUp next = best_of({std::max(at - step, 0.0), std::min(at + step, 1.0)},
                                    std::min(most_s_, kBeyond * best.duration_s()));
        helped = next.is_enough && next.duration_s() < best.duration_s() && !next.sections.empty();
        if (helped) best = next;
      }
    }
    return best;
  }

  /// The least drift at one speed in a given time.
  [[nodiscard]] WarmUp constant_in(double time_s) const {
    std::vector<WarmUp> ways(kSpeeds + 1);
    parallel_for(ways.size(), [&](std::size_t i) { ways[i] = constant(time_s, static_cast<double>(i) / kSpeeds); });
    return *std::min_element(ways.begin(), ways.end(), [](const WarmUp& a, const WarmUp& b) { return a.peak_um < b.peak_um; });
  }

  /// The best of two speeds in a given time; the first that is within the tolerance. @param shape  where to begin, and where it ended
  [[nodiscard]] WarmUp staged_in(double time_s, Shape& shape) const {
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

  /// The shortest of two speeds. @param known  the shortest that is known, or what comes nearest
  [[nodiscard]] WarmUp staged_best(const WarmUp& known) const {
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

 private:
  /// The least peak at one speed between two times, or the first that is enough, by golden section.
  [[nodiscard]] WarmUp least_between(double low_s, double high_s, double share) const {
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
  /// The least time at one speed that is enough, by halves. @param low_s  at which it is not
  [[nodiscard]] WarmUp shortened(WarmUp best, double low_s, double share) const {
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
  [[nodiscard]] WarmUp best_of(const std::vector<double>& shares, double most_s) const {
    std::vector<WarmUp> tried(shares.size());
    parallel_for(shares.size(), [&](std::size_t i) { tried[i] = least_time(shares[i], most_s); });
    return *std::min_element(tried.begin(), tried.end(), [](const WarmUp& a, const WarmUp& b) {
      if (a.is_enough != b.is_enough) return a.is_enough;
      return a.is_enough ? a.duration_s() < b.duration_s() : a.peak_um < b.peak_um;
    });
  }

  /// Steps along each of the three numbers, halved where none helps, until the tolerance is kept.
  [[nodiscard]] WarmUp improved(WarmUp best, double time_s, Shape& shape) const {
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
        const auto least = std::min_element(tried.begin(), tried.end(),
                                            [](const WarmUp& a, const WarmUp& b) { return a.peak_um < b.peak_um; });
        helped = least->peak_um < best.peak_um;
        if (!helped) continue;
        shape = around[static_cast<std::size_t>(least - tried.begin())];
        best = *least;
      }
    }
    return best;
  }

  const Trials& trials_;
  double tolerance_um_, most_rpm_, most_s_;
  const Listener& listener_;
};

/// The shortest rest behind which the job stays within the tolerance.
WarmUp rested(const Search& search, double most_s) {
  WarmUp best = search.least_time(0.0, most_s);
  best.way = "at rest";
  return best;
}

/// The job itself, part after part.
WarmUp by_jobs(const Trials& trials, double tolerance_um, double most_s) {
  Sections before;
  WarmUp best = trials.tried(before, tolerance_um);
  const double job_s = trials.job().duration_s();
  for (int part = 1; !best.is_enough && part < kMostParts && total_s(before) + job_s <= most_s; ++part) {
    before.insert(before.end(), trials.job().sections.begin(), trials.job().sections.end());
    const WarmUp next = trials.tried(before, tolerance_um);
    if (next.peak_um < best.peak_um || next.is_enough) best = next;
  }
  best.way = "the job itself, part after part";
  return best;
}

double fastest_rpm(const scenarios::Scenario& scenario, const Cyclogram& job) {
  double most_rpm = 0.0;
  for (const auto& section : job.sections) most_rpm = std::max(most_rpm, section.drive.speed_rpm);
  for (const Cyclogram& c : scenario.cyclograms) {
    for (const auto& section : c.sections) most_rpm = std::max(most_rpm, section.drive.speed_rpm);
  }
  return most_rpm;
}

}  // namespace

double WarmUp::duration_s() const {
  return total_s(sections);
}

WarmUpPlan plan_warm_up(const scenarios::Scenario& scenario, const Cyclogram& job, const WarmUpOptions& options,
                        const Listener& listener) {
  const double asked_rpm = options.most_speed_rpm > 0.0 ? options.most_speed_rpm : fastest_rpm(scenario, job);
  const double most_rpm = kSpeedStep_rpm * std::floor(asked_rpm / kSpeedStep_rpm);
  if (!(most_rpm >= kSpeedStep_rpm))
    throw InputError("no cyclogram of the scenario turns the spindle; say with --speed-limit how fast a warm-up may");
  const Trials trials(scenario, job, options, most_rpm, listener);
  const double tolerance_um = options.tolerance_um * (1.0 - options.kept_free);
  const Search search(trials, tolerance_um, most_rpm, options.most_s, listener);
  WarmUpPlan plan{.channels = trials.channels(),
                  .tolerance_um = options.tolerance_um,
                  .most_speed_rpm = most_rpm,
                  .most_s = options.most_s,
                  .kept_free = options.kept_free,
                  .predicted_by = trials.ahead().model->words(),
                  .started_from = trials.ahead().started_from};
  listener.begin("at once, at rest and by jobs");
  plan.at_once = trials.tried({}, tolerance_um);
  plan.at_once.way = "at once";
  plan.at_rest = rested(search, options.most_s);
  plan.by_jobs = by_jobs(trials, tolerance_um, options.most_s);
  plan.constant = search.constant();
  const bool rests = plan.at_rest.is_enough && (!plan.constant.is_enough || plan.at_rest.duration_s() < plan.constant.duration_s());
  plan.staged = search.staged_best(rests ? plan.at_rest : plan.constant);
  listener.begin("minutes against micrometres");
  constexpr int kLevels = 8;
  const double longest_s = plan.staged.is_enough ? std::max(1.5 * plan.staged.duration_s(), 600.0) : options.most_s;
  const Search least(trials, 0.0, most_rpm, options.most_s, listener);  // of no tolerance: as little as there can be
  Shape shape = {1.0, 0.5, 0.5};
  for (int i = 0; i <= kLevels && !listener.wants_end(); ++i) {
    const double time_s = std::min(longest_s, options.most_s) * i / kLevels;
    WarmUp one = plan.at_once, two = plan.at_once;
    if (i > 0) {
      one = least.constant_in(time_s);
      two = least.staged_in(time_s, shape);
      if (one.peak_um < two.peak_um) two = one;
      two.is_enough = two.peak_um <= tolerance_um;
      const bool is_better = plan.staged.is_enough ? two.is_enough && two.duration_s() < plan.staged.duration_s()
                                                   : two.is_enough || two.peak_um < kWorthTelling * plan.staged.peak_um;
      if (is_better) plan.staged = two;
    }
    plan.levels.push_back({.duration_s = time_s, .constant_um = one.peak_um, .staged_um = two.peak_um});
    listener.share(static_cast<double>(i) / kLevels);
  }
  const auto is_one_speed = [](const Sections& sections) { return sections.size() == 1 && sections.front().drive.speed_rpm > 0.0; };
  if (is_one_speed(plan.staged.sections)) plan.constant = plan.staged;
  plan.at_once.way = "at once";
  plan.constant.way = "one speed";
  plan.staged.way = "two speeds";
  plan.job_at_once = trials.job_rows({});
  plan.job_warm = trials.job_rows(plan.staged.sections);
  plan.n_tried = trials.n_tried();
  return plan;
}

std::string warm_up_program(const std::vector<Cyclogram::Section>& sections, const std::string& remark) {
  std::string plain;  // a bracket would end the comment, and what follows would be read
  for (char c : remark.substr(0, kLongestRemark)) plain += c >= ' ' && c <= '~' && c != '(' && c != ')' && c != ';' ? c : '_';
  std::string text = fmt::format("({})\nG21 G94\n", plain);
  bool turns = false;
  for (const Cyclogram::Section& section : sections) {
    const double rpm = section.drive.speed_rpm;
    if (rpm > 0.0) text += turns ? fmt::format("S{:.0f}\n", rpm) : fmt::format("S{:.0f} M3\n", rpm);
    if (rpm == 0.0 && turns) text += "M5\n";
    turns = rpm > 0.0;
    text += fmt::format("G4 P{:.0f} ({:.4g} min)\n", section.duration_s, section.duration_s / 60.0);
  }
  if (turns) text += "M5\n";
  return text + "M2\n";
}

}  // namespace driftwright::studies
