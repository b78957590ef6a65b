#include "identification/identify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/parallel.hpp"
#include "base/rows_as_one.hpp"
#include "compensation/judging/folds.hpp"

namespace driftwright::identification {
namespace {

constexpr std::array<double, 3> kExponents = {5.0 / 3.0, 2.0, 1.0};  // the first unless others are better
constexpr std::array<std::size_t, 4> kPoles = {2, 3, 4, 6};
constexpr std::array<double, 3> kPenalties = {1e-4, 1e-3, 1e-2};
constexpr std::array<double, 2> kStarts = {1e6, 1e-3};  // in balance; free
constexpr double kRowsOfShortest = 3.0;                 // rows that the shortest time constant spans
constexpr double kLongest = 1.0 / 3.0;                  // of the longest record
constexpr double kRest = 0.05;                          // of the top speed: slower is rest, nearer is one level
constexpr double kHottest = 3.0;                        // rise of heated bodies over the largest of a thermometer
constexpr double kDefaultRise_K = 10.0;                 // where there is no thermometer
constexpr double kFloor = 0.02;                         // of a channel's deviation: misses below are not told from nothing
constexpr double kLagOfSign = 0.03;                     // of a record, behind which a column is held against thermometers
constexpr std::size_t kFewestBlocks = 30;
constexpr double kMostRows = 3000.0;  // of all records; more are thinned evenly

std::vector<Record> thinned(std::span<const Record> records, const std::vector<std::size_t>& blocks);

/// Folds as rows of all records, one after the other.
struct HiddenRows {
  std::string kind;
  std::vector<bool> hidden;
};

std::vector<HiddenRows> hidden_rows(std::span<const Record> records, const RecordRoles& roles) {
  std::vector<compensation::ObservedRun> runs;
  for (const Record& r : records) {
    compensation::ObservedRun run;
    run.readings = r;
    runs.push_back(std::move(run));
  }
  const std::string target = roles.displacements.empty() ? roles.thermometers.front() : roles.displacements.front();
  std::vector<std::string> thermometers = roles.thermometers;
  if (!roles.ambient.empty()) thermometers.push_back(roles.ambient);
  std::erase(thermometers, target);
  std::vector<HiddenRows> list;
  for (const compensation::Fold& fold : compensation::folds_of(
           runs, {.target = target, .from_start = false, .thermometers = thermometers, .speed = roles.speed})) {
    HiddenRows rows{fold.kind, {}};
    for (const auto& of_run : fold.hidden) rows.hidden.insert(rows.hidden.end(), of_run.begin(), of_run.end());
    list.push_back(std::move(rows));
  }
  return list;
}

/// Logarithms of kept-out misses: a row a fold, a column a channel.
struct Loss {
  Eigen::MatrixXd log_rms, rms;  ///< with a floor; without
  Eigen::VectorXd of_fold;       ///< mean over channels, thermometers and displacements half each; NaN where none judges
  double mean = 0.0;             ///< over kinds of the mean over their folds
};

double mean_of_kinds(const Eigen::VectorXd& of_fold, const std::vector<HiddenRows>& folds) {
  std::map<std::string, std::pair<double, double>> kinds;
  for (std::size_t f = 0; f < folds.size(); ++f) {
    const double value = of_fold[static_cast<Eigen::Index>(f)];
    if (!std::isfinite(value)) continue;
    kinds[folds[f].kind].first += value;
    kinds[folds[f].kind].second += 1.0;
  }
  double sum = 0.0;
  for (const auto& [kind, of] : kinds) sum += of.first / of.second;
  return kinds.empty() ? 0.0 : sum / static_cast<double>(kinds.size());
}

/// Whether one is no worse than another beyond a standard error of their difference over the folds.
bool is_as_good(const Loss& one, const Loss& best) {
  std::vector<double> worse;
  for (Eigen::Index f = 0; f < one.of_fold.size(); ++f) {
    const double d = one.of_fold[f] - best.of_fold[f];
    if (std::isfinite(d)) worse.push_back(d);
  }
  if (worse.size() < 2) return one.mean <= best.mean;
  const auto n = static_cast<double>(worse.size());
  double mean = 0.0, squares = 0.0;
  for (double d : worse) mean += d / n;
  for (double d : worse) squares += (d - mean) * (d - mean);
  return one.mean - best.mean <= std::sqrt(squares / (n - 1.0) / n);
}

struct Judged {
  Structure structure;
  Smoothness smoothness;
  Loss loss;
  std::size_t n_bodies = 0;
  bool has_default_exponent = true;
};

/// A structure judged by kept-out rows.
class Jury {
 public:
  Jury(std::span<const Record> records, const RecordRoles& roles, double rise_K, const std::vector<std::size_t>& blocks)
      : records_(records),
        roles_(roles),
        rise_K_(rise_K),
        blocks_(blocks),
        folds_(hidden_rows(thinned(records, blocks), roles)) {}
  [[nodiscard]] const std::vector<HiddenRows>& folds() const { return folds_; }

  /// With the penalties that do best; of those given alone, where there are some.
  [[nodiscard]] Judged judged(const Structure& structure, const std::optional<Smoothness>& only = {}) const {
    const FosterProblem problem(records_, roles_, structure, rise_K_, blocks_);
    std::vector<FosterProblem::Normal> normals;
    for (const HiddenRows& f : folds_) normals.push_back(problem.normal(f.hidden));
    const std::size_t n_t = problem.n_thermometers(), n_c = problem.channels().size();
    Judged result{.structure = structure, .smoothness = {}, .loss = {}, .n_bodies = problem.bodies().size()};
    result.loss.log_rms.setConstant(static_cast<Eigen::Index>(folds_.size()), static_cast<Eigen::Index>(n_c),
                                    std::numeric_limits<double>::quiet_NaN());
    result.loss.rms = result.loss.log_rms;
    // Of some channels: what penalties do best where records begin in balance, and where their starts are free; these where the scenario that is written, which knows of none, is better with them beyond a standard error.
    const auto try_all = [&](std::size_t from, std::size_t to, const std::vector<Smoothness>& in_balance,
                             const std::vector<Smoothness>& free, const auto& take) {
      const auto width = static_cast<Eigen::Index>(to - from);
      struct Best {
        Smoothness smoothness;
        Eigen::MatrixXd log_rms, rms;
        Loss loss, simulated;  ///< with what is true of a record alone, and as the written scenario is simulated
      };
      const auto best_of = [&](const std::vector<Smoothness>& tried) {
        Best best;
        best.loss.mean = std::numeric_limits<double>::max();
        for (const Smoothness& s : tried) {
          Eigen::MatrixXd log_rms(static_cast<Eigen::Index>(folds_.size()), width), rms = log_rms, simulated = log_rms;
          for (std::size_t f = 0; f < folds_.size(); ++f) {
            for (std::size_t c = from; c < to; ++c) {
              const auto row = static_cast<Eigen::Index>(f), column = static_cast<Eigen::Index>(c - from);
              const ChannelFit fit = problem.fit(normals[f], c, s);
              const double floor = kFloor * deviation(problem.measured(c));
              rms(row, column) = FosterProblem::rms(problem.misses(c, fit), folds_[f].hidden);
              log_rms(row, column) = std::log(std::hypot(rms(row, column), floor));
              simulated(row, column) =
                  std::log(std::hypot(FosterProblem::rms(problem.misses(c, fit, false), folds_[f].hidden), floor));
            }
          }
          const auto loss_of = [&](const Eigen::MatrixXd& logs) {
            Loss loss{.log_rms = {}, .rms = {}, .of_fold = mean_over_channels(logs)};
            loss.mean = mean_of_kinds(loss.of_fold, folds_);
            return loss;
          };
          Loss loss = loss_of(log_rms);
          if (loss.mean < best.loss.mean)
            best = {s, std::move(log_rms), std::move(rms), std::move(loss), loss_of(simulated)};
        }
        return best;
      };
      Best best = best_of(in_balance);
      if (!free.empty()) {
        Best other = best_of(free);
        if (!is_as_good(best.simulated, other.simulated)) best = std::move(other);
      }
      take(best.smoothness);
      result.loss.log_rms.middleCols(static_cast<Eigen::Index>(from), width) = best.log_rms;
      result.loss.rms.middleCols(static_cast<Eigen::Index>(from), width) = best.rms;
    };
    std::vector<Smoothness> of_thermometers[2], of_displacements[2];
    if (only) {
      of_thermometers[0] = of_displacements[0] = {*only};
    } else {
      for (std::size_t free : {0, 1}) {
        for (double p : kPenalties) {
          of_thermometers[free].push_back({.thermometers = p, .start_of_thermometers = kStarts[free]});
          for (double a : kPenalties)
            of_displacements[free].push_back({.drive = p, .ambient = a, .start_of_displacements = kStarts[free]});
        }
      }
    }
    if (n_t > 0)
      try_all(0, n_t, of_thermometers[0], of_thermometers[1], [&](const Smoothness& s) {
        result.smoothness.thermometers = s.thermometers;
        result.smoothness.start_of_thermometers = s.start_of_thermometers;
      });
    if (n_c > n_t)
      try_all(n_t, n_c, of_displacements[0], of_displacements[1], [&](const Smoothness& s) {
        result.smoothness.drive = s.drive;
        result.smoothness.ambient = s.ambient;
        result.smoothness.start_of_displacements = s.start_of_displacements;
      });
    // displacements count as much as thermometers do, however many there are
    result.loss.of_fold = mean_over_channels(result.loss.log_rms.rightCols(static_cast<Eigen::Index>(n_c - n_t)));
    if (n_c == n_t) result.loss.of_fold.setConstant(std::numeric_limits<double>::quiet_NaN());
    const Eigen::VectorXd of_thermometers_too =
        mean_over_channels(result.loss.log_rms.leftCols(static_cast<Eigen::Index>(n_t)));
    for (Eigen::Index f = 0; f < result.loss.of_fold.size(); ++f) {
      double& of_fold = result.loss.of_fold[f];
      if (!std::isfinite(of_fold))
        of_fold = of_thermometers_too[f];
      else if (std::isfinite(of_thermometers_too[f]))
        of_fold = 0.5 * (of_fold + of_thermometers_too[f]);
    }
    result.loss.mean = mean_of_kinds(result.loss.of_fold, folds_);
    return result;
  }

  static double deviation(const Eigen::VectorXd& y) {
    double n = 0.0, sum = 0.0, squares = 0.0;
    for (double v : y) {
      if (!std::isfinite(v)) continue;
      n += 1.0;
      sum += v;
      squares += v * v;
    }
    return n > 0.0 ? std::sqrt(std::max(0.0, squares / n - sum / n * sum / n)) : 0.0;
  }

 private:
  static Eigen::VectorXd mean_over_channels(const Eigen::MatrixXd& log_rms) {
    Eigen::VectorXd mean(log_rms.rows());
    for (Eigen::Index f = 0; f < log_rms.rows(); ++f) {
      double sum = 0.0, n = 0.0;
      for (double v : log_rms.row(f)) {
        if (!std::isfinite(v)) continue;
        sum += v;
        n += 1.0;
      }
      mean[f] = n > 0.0 ? sum / n : std::numeric_limits<double>::quiet_NaN();
    }
    return mean;
  }

  std::span<const Record> records_;
  const RecordRoles& roles_;
  double rise_K_;
  const std::vector<std::size_t>& blocks_;
  std::vector<HiddenRows> folds_;
};

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
  const double from = std::log(std::max(kRowsOfShortest * row_s, 0.003 * longest_s)), to = std::log(kLongest * longest_s);
  std::vector<double> tau_s;
  // in the middles of even steps
  for (std::size_t k = 0; k < n; ++k)
    tau_s.push_back(std::exp(from + (static_cast<double>(k) + 0.5) / static_cast<double>(n) * (to - from)));
  return tau_s;
}

bool cools(std::span<const Record> records, const RecordRoles& roles, const std::string& drive);

/// Whether a speed stands at two levels at least, rest aside.
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
      if (!has_levels(records, roles.speed, top)) break;  // one speed tells of no law
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

/// A structure without one of its bodies; none where that is the ambient's part of a pole with heated bodies.
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

/// So many rows of each record are taken as one that all have no more than kMostRows, and each as many as it needs.
std::vector<std::size_t> blocks_of(std::span<const Record> records) {
  double n = 0.0;
  for (const Record& r : records) n += static_cast<double>(r.n_samples());
  const auto every = static_cast<std::size_t>(std::max(1.0, std::ceil(n / kMostRows)));
  std::vector<std::size_t> blocks;
  for (const Record& r : records) blocks.push_back(std::clamp<std::size_t>(r.n_samples() / kFewestBlocks, 1, every));
  return blocks;
}

/// Records with the first row of each block: what folds are told by.
std::vector<Record> thinned(std::span<const Record> records, const std::vector<std::size_t>& blocks) {
  std::vector<Record> few(records.begin(), records.end());
  for (std::size_t r = 0; r < few.size(); ++r) {
    const std::size_t rows = few[r].n_samples() / blocks[r];
    const auto keep = [&](std::vector<double>& v) {
      for (std::size_t i = 0; i < rows; ++i) v[i] = v[i * blocks[r]];
      v.resize(rows);
    };
    keep(few[r].time_s);
    for (Channel& c : few[r].channels) keep(c.values);
  }
  return few;
}

/// Whether thermometers fall, most of them, where a column rises.
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

}  // namespace

Identified identify(std::span<const Record> records, const RoleHints& hints, const Listener& listener) {
  Identified result;
  result.roles = record_roles(records, hints);
  const RecordRoles& roles = result.roles;
  const std::vector<std::size_t> blocks = blocks_of(records);

  double rise_K = 0.0;
  for (const std::string& t : roles.thermometers) {
    for (const Record& r : records) {
      const Eigen::VectorXd v = held(r.at(t));
      rise_K = std::max(rise_K, v.maxCoeff() - v.minCoeff());
    }
  }
  rise_K = rise_K > 0.0 ? kHottest * rise_K : kDefaultRise_K;

  listener.begin("laws and number of bodies");
  const Jury jury(records, roles, rise_K, blocks);
  std::vector<Judged> tried = structures(records, roles);
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
  const bool has_ambient = !roles.ambient.empty();
  std::vector<double> gains;
  for (bool goes_on = true; goes_on;) {
    goes_on = false;
    std::vector<std::optional<Judged>> less(now.n_bodies);
    for_each_index(
        less.size(), [] { return 0; },
        [&](std::size_t b, int&) {
          if (const auto structure = without(now.structure, has_ambient, b))
            less[b] = jury.judged(*structure, now.smoothness);
        });
    gains.assign(less.size(), 0.0);
    std::size_t best = less.size();
    for (std::size_t b = 0; b < less.size(); ++b) {
      if (!less[b]) continue;
      gains[b] = std::expm1(less[b]->loss.mean - now.loss.mean);
      if (best == less.size() || less[b]->loss.mean < less[best]->loss.mean) best = b;
    }
    if (best < less.size() && less[best]->loss.mean <= now.loss.mean) {
      const Smoothness kept = now.smoothness;
      now = *less[best];
      now.smoothness = kept;
      goes_on = true;
    }
  }

  listener.begin("fitting");
  const FosterProblem problem(records, roles, now.structure, rise_K, blocks);
  const std::vector<bool> none(problem.n_rows(), false), every(problem.n_rows(), true);
  const FosterProblem::Normal normal = problem.normal(none);
  result.structure = now.structure;
  result.smoothness = now.smoothness;
  result.blocks = blocks;
  result.reference_degC = problem.reference_degC();
  for (std::size_t b = 0; b < problem.bodies().size(); ++b)
    result.bodies.push_back({problem.bodies()[b], name_of(problem.bodies()[b], now.structure), gains[b]});
  std::map<std::string, std::size_t> kinds;
  for (const HiddenRows& f : jury.folds()) {
    if (kinds.emplace(f.kind, result.kinds.size()).second)
      result.kinds.push_back(
          {f.kind, std::vector<double>(problem.channels().size(), std::numeric_limits<double>::quiet_NaN())});
  }
  for (std::size_t c = 0; c < problem.channels().size(); ++c) {
    IdentifiedChannel channel;
    channel.name = problem.channels()[c];
    channel.unit = records[0].at(channel.name).unit;
    channel.fit = problem.fit(normal, c, now.smoothness);
    channel.predicted = problem.predicted(c, channel.fit, true);
    channel.misses = problem.misses(c, channel.fit);
    channel.ledger = ledger(problem, c, channel.fit);
    channel.swing = Jury::deviation(problem.measured(c));
    channel.missed_own = FosterProblem::rms(channel.misses, every);
    double sum = 0.0, n = 0.0;
    for (KeptOutKind& kind : result.kinds) {
      double logs = 0.0, there = 0.0;
      for (std::size_t f = 0; f < jury.folds().size(); ++f) {
        const double log = std::log(now.loss.rms(static_cast<Eigen::Index>(f), static_cast<Eigen::Index>(c)));
        if (jury.folds()[f].kind != kind.kind || !std::isfinite(log)) continue;
        logs += log;
        there += 1.0;
      }
      if (there == 0.0) continue;
      kind.rms[c] = std::exp(logs / there);
      sum += logs / there;
      n += 1.0;
    }
    channel.missed_kept_out = n > 0.0 ? std::exp(sum / n) : std::numeric_limits<double>::quiet_NaN();
    channel.missed_simulated = FosterProblem::rms(problem.misses(c, channel.fit, false), every);
    if (channel.fit.standard_deviation.size() > 0)
      channel.fit.standard_deviation *= channel.missed_own * std::sqrt(rows_as_one(std::span(&channel.misses, 1)));
    result.channels.push_back(std::move(channel));
  }
  return result;
}

}  // namespace driftwright::identification
