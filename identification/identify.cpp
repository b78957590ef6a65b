#include "identification/identify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "base/parallel.hpp"
#include "base/rows_as_one.hpp"
#include "identification/jury.hpp"

namespace driftwright::identification {
namespace {

constexpr std::array<double, 3> kExponents = {5.0 / 3.0, 2.0, 1.0};  // the first one is used unless others are better
constexpr std::array<std::size_t, 4> kPoles = {2, 3, 4, 6};
constexpr double kRowsOfShortest = 3.0;  // rows within the shortest time constant
constexpr double kShortest = 0.003;      // of the longest record: lower limit of the shortest time constant
constexpr double kLongest = 1.0 / 3.0;   // longest time constant, of the longest record
constexpr double kRest = 0.05;           // of the top speed: lower speeds are rest, closer speeds are one level
constexpr double kHottest = 3.0;         // rise of heated bodies over the largest of a thermometer
constexpr double kDefaultRise_K = 10.0;  // without a thermometer
constexpr double kLagOfSign = 0.03;      // of a record: lag of a column before it is compared with thermometers
constexpr std::size_t kFewestBlocks = 30;
constexpr double kLeastChange = 1e-3;  // of a channel's deviation: 0.01 K of 10 K, which no thermometer resolves
constexpr double kMostRows = 3000.0;   // of all records; more rows are averaged

double top_of(std::span<const Record> records, const std::string& channel) {
  double top = 0.0;
  for (const Record& r : records) top = std::max(top, held(r.at(channel)).cwiseAbs().maxCoeff());
  return top;
}

std::vector<double> time_constants(std::span<const Record> records, std::size_t n) {
  double row_s = std::numeric_limits<double>::max(), longest_s = 0.0;
  for (const Record& r : records) {
    const double length_s = r.time_s.back() - r.time_s.front();
    row_s = std::min(row_s, length_s / static_cast<double>(r.n_samples() - 1));
    longest_s = std::max(longest_s, length_s);
  }
  const double from = std::log(std::max(kRowsOfShortest * row_s, kShortest * longest_s)),
               to = std::log(kLongest * longest_s);
  std::vector<double> tau_s;
  // the centres of equal intervals
  for (std::size_t k = 0; k < n; ++k)
    tau_s.push_back(std::exp(from + (static_cast<double>(k) + 0.5) / static_cast<double>(n) * (to - from)));
  return tau_s;
}

/// True if most thermometers fall when a column rises.
bool cools(std::span<const Record> records, const RecordRoles& roles, const std::string& drive) {
  double votes = 0.0;
  for (const std::string& t : roles.thermometers) {
    double product = 0.0, size = 0.0;
    for (const Record& r : records) {
      Eigen::VectorXd x = lagged_steps(r.time_s, held(r.at(drive)), kLagOfSign * (r.time_s.back() - r.time_s.front()));
      Eigen::VectorXd y = held(r.at(t));
      x.array() -= x.mean();
      y.array() -= y.mean();
      product += x.dot(y);
      size += x.norm() * y.norm();
    }
    if (size > 0.0) votes += product / size;
  }
  return votes < 0.0;
}

/// True if a speed has at least two levels apart from rest.
bool has_levels(std::span<const Record> records, const std::string& speed, double top) {
  double least = top;
  for (const Record& r : records) {
    for (double rpm : held(r.at(speed))) {
      if (std::abs(rpm) > kRest * top) least = std::min(least, std::abs(rpm));
    }
  }
  return least < (1.0 - kRest) * top;
}

std::vector<Judged> structures(std::span<const Record> records, const RecordRoles& roles) {
  std::vector<std::vector<Law>> of_speed;
  std::vector<char> is_default;
  if (!roles.speed.empty()) {
    const double top = top_of(records, roles.speed);
    const Law turning{.kind = Law::Kind::kTurning, .channel = roles.speed, .top = top};
    of_speed.push_back({turning});
    is_default.push_back(1);
    for (double exponent : kExponents) {
      if (!has_levels(records, roles.speed, top)) break;  // one speed does not determine a law
      const Law power{.kind = Law::Kind::kPower, .channel = roles.speed, .exponent = exponent, .top = top};
      of_speed.push_back({power});
      of_speed.push_back({turning, power});
      is_default.insert(is_default.end(), 2, exponent == kExponents[0]);
    }
  } else {
    of_speed.emplace_back();
    is_default.push_back(1);
  }
  std::vector<Judged> list;
  for (std::size_t l = 0; l < of_speed.size(); ++l) {
    std::vector<Law> laws = of_speed[l];
    for (const std::string& drive : roles.drives)
      laws.push_back({.kind = Law::Kind::kColumn,
                      .channel = drive,
                      .sign = cools(records, roles, drive) ? -1.0 : 1.0,
                      .top = top_of(records, drive)});
    for (std::size_t n_poles : kPoles) {
      Judged j;
      j.structure.laws = laws;
      for (double tau_s : time_constants(records, n_poles)) {
        Pole pole{tau_s, {}};
        for (std::size_t k = 0; k < laws.size(); ++k) pole.laws.push_back(k);
        j.structure.poles.push_back(std::move(pole));
      }
      j.has_default_exponent = is_default[l] != 0;
      list.push_back(std::move(j));
    }
  }
  return list;
}

/// A structure without one of its bodies; none if that body is the ambient's part of a pole with heated bodies.
std::optional<Structure> without(const Structure& structure, bool has_ambient, std::size_t body) {
  Structure less = structure;
  std::size_t at = 0;
  for (Pole& p : less.poles) {
    if (body < at + p.laws.size()) {
      p.laws.erase(p.laws.begin() + static_cast<std::ptrdiff_t>(body - at));
      if (!has_ambient) std::erase_if(less.poles, [](const Pole& q) { return q.laws.empty(); });
      return less.poles.empty() ? std::nullopt : std::optional(less);
    }
    at += p.laws.size();
  }
  const std::size_t pole = body - at;
  if (!less.poles[pole].laws.empty() || less.poles.size() == 1) return std::nullopt;
  less.poles.erase(less.poles.begin() + static_cast<std::ptrdiff_t>(pole));
  return less;
}

std::string time_words(double tau_s) {
  const double min = tau_s / 60.0;
  if (min < 1.5) return fmt::format("{:.0f}s", tau_s);
  return min < 600.0 ? fmt::format("{:.0f}min", min) : fmt::format("{:.0f}h", min / 60.0);
}

std::string name_of(const NetworkBody& body, const Structure& structure) {
  if (!body.law) return "ambient_" + time_words(body.tau_s);
  const Law& law = structure.laws[*body.law];
  switch (law.kind) {
    case Law::Kind::kTurning:
      return "turning_" + time_words(body.tau_s);
    case Law::Kind::kPower:
      return "speed_" + time_words(body.tau_s);
    case Law::Kind::kColumn:
      break;
  }
  return law.channel + "_" + time_words(body.tau_s);
}

/// Number of rows of each record that are averaged into one, so that all records together have at most kMostRows.
std::vector<std::size_t> blocks_of(std::span<const Record> records) {
  double n = 0.0;
  for (const Record& r : records) n += static_cast<double>(r.n_samples());
  const auto every = static_cast<std::size_t>(std::max(1.0, std::ceil(n / kMostRows)));
  std::vector<std::size_t> blocks;
  for (const Record& r : records) blocks.push_back(std::clamp<std::size_t>(r.n_samples() / kFewestBlocks, 1, every));
  return blocks;
}

/// Rise of heated bodies: larger than that of any thermometer.
double rise_of(std::span<const Record> records, const RecordRoles& roles) {
  double rise_K = 0.0;
  for (const std::string& t : roles.thermometers) {
    for (const Record& r : records) {
      const Eigen::VectorXd v = held(r.at(t));
      rise_K = std::max(rise_K, v.maxCoeff() - v.minCoeff());
    }
  }
  return rise_K > 0.0 ? kHottest * rise_K : kDefaultRise_K;
}

struct Chosen {
  Judged judged;
  std::vector<double> gains;  ///< of each body
};

/// Chooses the structure that predicts kept-out rows.
Chosen choose(const Jury& jury, std::vector<Judged> tried, bool has_ambient, const Listener& listener) {
  listener.begin("laws and number of bodies");
  for_each_index(
      tried.size(), [] { return 0; },
      [&](std::size_t i, int&) {
        const bool is_default = tried[i].has_default_exponent;
        tried[i] = jury.judged(tried[i].structure);
        tried[i].has_default_exponent = is_default;
      });
  const Judged& least = *std::min_element(tried.begin(), tried.end(),
                                          [](const Judged& a, const Judged& b) { return a.loss.mean < b.loss.mean; });
  std::vector<const Judged*> order;
  for (const Judged& j : tried) order.push_back(&j);
  std::stable_sort(order.begin(), order.end(), [](const Judged* a, const Judged* b) {
    return a->n_bodies != b->n_bodies ? a->n_bodies < b->n_bodies : a->has_default_exponent > b->has_default_exponent;
  });
  Judged now = **std::find_if(order.begin(), order.end(), [&](const Judged* j) { return is_as_good(j->loss, least.loss); });

  listener.begin("bodies that are not missed");
  std::vector<double> gains;
  for (bool goes_on = true; goes_on;) {
    goes_on = false;
    std::vector<std::optional<Judged>> less(now.n_bodies);
    for_each_index(
        less.size(), [] { return 0; },
        [&](std::size_t b, int&) {
          if (const auto structure = without(now.structure, has_ambient, b)) less[b] = jury.judged(*structure, &now);
        });
    gains.assign(less.size(), 0.0);
    std::size_t best = less.size();
    for (std::size_t b = 0; b < less.size(); ++b) {
      if (!less[b]) continue;
      gains[b] = std::expm1(less[b]->loss.mean - now.loss.mean);
      if (best == less.size() || less[b]->loss.mean < less[best]->loss.mean) best = b;
    }
    if (best < less.size() && less[best]->loss.mean <= now.loss.mean) {
      now = *less[best];
      goes_on = true;
    }
  }
  return {std::move(now), std::move(gains)};
}

Identified network_of(std::span<const Record> records, const RecordRoles& roles, std::span<const Record> simulated,
                      const Listener& listener) {
  Identified result;
  result.roles = roles;
  result.is_extension = !simulated.empty();
  result.blocks = blocks_of(records);
  const double rise_K = rise_of(records, roles);
  const Jury jury(records, roles, rise_K, result.blocks, simulated);
  const auto [now, gains] = choose(jury, structures(records, roles), !roles.ambient.empty(), listener);

  listener.begin("fitting");
  const FosterProblem problem(records, roles, now.structure, rise_K, result.blocks, simulated);
  const FosterProblem::Normal normal = problem.normal(std::vector<bool>(problem.n_rows(), false));
  const FosterProblem::Part all = problem.part(std::vector<bool>(problem.n_rows(), true));
  result.structure = now.structure;
  result.reference_degC = problem.reference_degC();
  for (std::size_t b = 0; b < problem.bodies().size(); ++b)
    result.bodies.push_back({problem.bodies()[b], name_of(problem.bodies()[b], now.structure), gains[b]});
  std::set<std::string> kinds;
  for (const HiddenRows& f : jury.folds()) {
    if (kinds.insert(f.kind).second) result.kinds.push_back({f.kind, {}});
  }
  result.folds = jury.folds();
  const std::optional<Loss> scenario = result.is_extension ? std::optional(jury.of_scenario(now)) : std::nullopt;
  const bool is_extended = scenario && surely_above(missed_more(*scenario, now.loss)) > 0.0;
  for (std::size_t c = 0; c < problem.channels().size(); ++c) {
    IdentifiedChannel channel;
    channel.name = problem.channels()[c];
    channel.unit = records[0].at(channel.name).unit;
    std::vector<ChannelFit> fits = problem.fits(normal, c, now.members[c]);
    channel.fit = mean_fit(fits);
    const Loss* loss = &now.loss;
    if (scenario) {
      channel.missed_more_without = missed_more(*scenario, now.loss, c);
      const ChannelFit alone = problem.fit(normal, c, now.scenario[c]);
      const double change =
          (problem.predicted(c, channel.fit, false) - problem.predicted(c, alone, false)).cwiseAbs().maxCoeff();
      channel.is_extended = is_extended && surely_above(channel.missed_more_without) > 0.0 &&
                            change > kLeastChange * deviation(problem.measured(c));
      channel.scenario_simulated = problem.rms(all, c, alone, false);
      channel.scenario_kept_out = missed(scenario->rms.col(static_cast<Eigen::Index>(c)), jury.folds());
      if (!channel.is_extended) {
        fits = {alone};
        channel.fit = alone;
        loss = &*scenario;
      }
    }
    channel.predicted = problem.predicted(c, channel.fit, true);
    channel.misses = problem.misses(c, channel.fit);
    channel.ledger = ledger(problem, c, channel.fit);
    if (scenario) channel.missing = ledger_of_missing(problem, c, channel.fit);
    channel.swing = deviation(problem.measured(c));
    channel.missed_own = problem.rms(all, c, channel.fit);
    for (KeptOutKind& kind : result.kinds)
      kind.rms.push_back(missed(loss->rms.col(static_cast<Eigen::Index>(c)), jury.folds(), kind.kind));
    channel.missed_kept_out = missed(loss->rms.col(static_cast<Eigen::Index>(c)), jury.folds());
    const Eigen::VectorXd squares = loss->rms.col(static_cast<Eigen::Index>(c)).cwiseAbs2();
    channel.square_kept_out = mean_error(std::span(squares.data(), static_cast<std::size_t>(squares.size())));
    channel.missed_simulated = problem.rms(all, c, channel.fit, false);
    channel.fit.covariance *= channel.missed_own * channel.missed_own * rows_as_one(std::span(&channel.misses, 1));
    if (channel.fit.covariance.size() > 0) channel.fit.covariance += spread(fits);
    result.channels.push_back(std::move(channel));
  }
  return result;
}

}  // namespace

double missed(const Eigen::VectorXd& rms, std::span<const HiddenRows> folds, const std::string& kind) {
  double logs = 0.0, there = 0.0;
  for (std::size_t f = 0; f < folds.size(); ++f) {
    const double log = std::log(rms[static_cast<Eigen::Index>(f)]);
    if (folds[f].kind != kind || !std::isfinite(log)) continue;
    logs += log;
    there += 1.0;
  }
  return there > 0.0 ? std::exp(logs / there) : std::numeric_limits<double>::quiet_NaN();
}

double missed(const Eigen::VectorXd& rms, std::span<const HiddenRows> folds) {
  std::set<std::string> kinds;
  for (const HiddenRows& f : folds) kinds.insert(f.kind);
  double sum = 0.0, n = 0.0;
  for (const std::string& kind : kinds) {
    const double of_kind = missed(rms, folds, kind);
    if (!std::isfinite(of_kind)) continue;
    sum += std::log(of_kind);
    n += 1.0;
  }
  return n > 0.0 ? std::exp(sum / n) : std::numeric_limits<double>::quiet_NaN();
}

Identified identify(std::span<const Record> records, const RoleHints& hints, const Listener& listener) {
  return network_of(records, record_roles(records, hints), {}, listener);
}

Identified extend(std::span<const Record> records, const RecordRoles& roles, std::span<const Record> simulated,
                  const Listener& listener) {
  return network_of(records, roles, simulated, listener);
}

}  // namespace driftwright::identification
