#include "identification/jury.hpp"

#include <array>
#include <cmath>
#include <limits>

#include "base/mean_error.hpp"
#include "compensation/judging/folds.hpp"

namespace driftwright::identification {
namespace {

constexpr std::array<double, 3> kPenalties = {1e-4, 1e-3, 1e-2};
constexpr std::array<double, 2> kStarts = {1e6, 1e-3};  // in balance; free
constexpr double kFloor = 0.02;                         // of a channel's deviation: misses below are not told from nothing

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

Eigen::VectorXd mean_over_channels(const Eigen::MatrixXd& log_rms) {
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

}  // namespace

bool is_as_good(const Loss& one, const Loss& best) {
  const Eigen::VectorXd worse = one.of_fold - best.of_fold;
  const MeanError error = mean_error(std::span(worse.data(), static_cast<std::size_t>(worse.size())));
  return one.mean - best.mean <= error.standard_error;
}

double deviation(const Eigen::VectorXd& y) {
  double n = 0.0, sum = 0.0, squares = 0.0;
  for (double v : y) {
    if (!std::isfinite(v)) continue;
    n += 1.0;
    sum += v;
    squares += v * v;
  }
  return n > 0.0 ? std::sqrt(std::max(0.0, squares / n - sum / n * sum / n)) : 0.0;
}

Jury::Jury(std::span<const Record> records, const RecordRoles& roles, double rise_K, const std::vector<std::size_t>& blocks)
    : records_(records),
      roles_(roles),
      rise_K_(rise_K),
      blocks_(blocks),
      folds_(hidden_rows(thinned(records, blocks), roles)) {}

Judged Jury::judged(const Structure& structure, const std::optional<Smoothness>& only) const {
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
        if (loss.mean < best.loss.mean) best = {s, std::move(log_rms), std::move(rms), std::move(loss), loss_of(simulated)};
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

}  // namespace driftwright::identification
