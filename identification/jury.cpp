#include "identification/jury.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/mean_error.hpp"
#include "compensation/judging/folds.hpp"

namespace driftwright::identification {
namespace {

constexpr std::array<double, 3> kPenalties = {1e-4, 1e-3, 1e-2};
constexpr std::array<double, 3> kPenaltiesBeside = {1.0, 1e-2, 1e-4};  // of the terms that extend a scenario
constexpr std::array<double, 1> kAllKept = {1e6};                      // of the scenario's lost part: kept completely
constexpr std::array<double, 2> kLessKept = {1e-2, 1e-4};              // may lose
constexpr std::array<double, 2> kStarts = {1e6, 1e-3};                 // in balance; free
// Of the smallest error of a member of the mean: members with larger errors are left out, as in the blend of `validate`.
constexpr double kEnters = 1.5;
constexpr double kFloor = 0.02;  // of a channel's deviation: smaller errors count as equal

/// Records with the first row of each block, from which folds are made.
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
  std::vector<MachineRun> runs;
  for (const Record& r : records) {
    MachineRun run;
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

/// Gives displacements as a group the same weight as thermometers, for any number of each.
void weigh(Loss& loss, std::size_t n_thermometers, const std::vector<HiddenRows>& folds) {
  const auto n_t = static_cast<Eigen::Index>(n_thermometers), n_d = loss.log_rms.cols() - n_t;
  const Eigen::VectorXd thermometers = mean_over_channels(loss.log_rms.leftCols(n_t));
  loss.of_fold = mean_over_channels(loss.log_rms.rightCols(n_d));
  for (Eigen::Index f = 0; f < loss.of_fold.size(); ++f) {
    double& of_fold = loss.of_fold[f];
    if (!std::isfinite(of_fold))
      of_fold = thermometers[f];
    else if (std::isfinite(thermometers[f]))
      of_fold = 0.5 * (of_fold + thermometers[f]);
  }
  loss.mean = mean_of_kinds(loss.of_fold, folds);
}

/// The penalties to try for a network from records alone: records that begin in balance, and free starts.
std::array<std::vector<Smoothness>, 2> alone(bool of_thermometers) {
  std::array<std::vector<Smoothness>, 2> lists;
  for (std::size_t free : {0, 1}) {
    for (double p : kPenalties) {
      if (of_thermometers) {
        lists[free].push_back({.thermometers = p, .start_of_thermometers = kStarts[free]});
        continue;
      }
      for (double a : kPenalties) lists[free].push_back({.drive = p, .ambient = a, .start_of_displacements = kStarts[free]});
    }
  }
  return lists;
}

/// The same for the extension of a scenario, of which all is kept, or less; of equal results the first is used, which keeps
/// the scenario most.
std::array<std::vector<Smoothness>, 2> beside_scenario(bool of_thermometers, std::span<const double> kept) {
  std::array<std::vector<Smoothness>, 2> lists;
  for (std::size_t free : {0, 1}) {
    for (double s : kept) {
      for (double p : kPenaltiesBeside) {
        if (of_thermometers) {
          lists[free].push_back({.thermometers = p, .scenario_of_thermometers = s, .start_of_thermometers = kStarts[free]});
          continue;
        }
        for (double a : kPenaltiesBeside)
          lists[free].push_back(
              {.drive = p, .ambient = a, .scenario_of_displacements = s, .start_of_displacements = kStarts[free]});
      }
    }
  }
  return lists;
}

}  // namespace

MeanError missed_more(const Loss& one, const Loss& other) {
  const Eigen::VectorXd more = one.of_fold - other.of_fold;
  return mean_error(std::span(more.data(), static_cast<std::size_t>(more.size())));
}

MeanError missed_more(const Loss& one, const Loss& other, std::size_t channel) {
  const Eigen::VectorXd more =
      one.log_rms.col(static_cast<Eigen::Index>(channel)) - other.log_rms.col(static_cast<Eigen::Index>(channel));
  return mean_error(std::span(more.data(), static_cast<std::size_t>(more.size())));
}

bool is_as_good(const Loss& one, const Loss& best) {
  return one.mean - best.mean <= missed_more(one, best).standard_error;
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

Jury::Jury(std::span<const Record> records, const RecordRoles& roles, double rise_K, const std::vector<std::size_t>& blocks,
           std::span<const Record> simulated)
    : records_(records),
      roles_(roles),
      rise_K_(rise_K),
      blocks_(blocks),
      simulated_(simulated),
      folds_(hidden_rows(thinned(records, blocks), roles)) {}

Judged Jury::judged(const Structure& structure, const Judged* like) const {
  const FosterProblem problem(records_, roles_, structure, rise_K_, blocks_, simulated_);
  std::vector<FosterProblem::Normal> normals;
  std::vector<FosterProblem::Part> parts;
  std::vector<double> floor;
  for (const HiddenRows& f : folds_) {
    normals.push_back(problem.normal(f.hidden));
    parts.push_back(problem.part(f.hidden));
  }
  for (std::size_t c = 0; c < problem.channels().size(); ++c) floor.push_back(kFloor * deviation(problem.measured(c)));
  const std::size_t n_t = problem.n_thermometers(), n_c = problem.channels().size();
  Judged result{.structure = structure, .members = {}, .scenario = {}, .loss = {}, .n_bodies = problem.bodies().size()};
  result.members.resize(n_c);
  result.loss.log_rms.setConstant(static_cast<Eigen::Index>(folds_.size()), static_cast<Eigen::Index>(n_c),
                                  std::numeric_limits<double>::quiet_NaN());
  result.loss.rms = result.loss.log_rms;
  struct Tried {
    std::vector<Smoothness> members;
    Eigen::MatrixXd log_rms, rms;
    Loss loss, simulated;  ///< with the terms of single records, and as the written scenario is simulated
  };
  const auto tried = [&](std::size_t from, std::size_t to, const std::vector<Smoothness>& members) {
    Tried t{.members = members,
            .log_rms = Eigen::MatrixXd(static_cast<Eigen::Index>(folds_.size()), static_cast<Eigen::Index>(to - from)),
            .rms = {},
            .loss = {},
            .simulated = {}};
    t.rms = t.log_rms;
    Eigen::MatrixXd simulated = Eigen::MatrixXd::Zero(t.rms.rows(), t.rms.cols());
    for (std::size_t f = 0; f < folds_.size(); ++f) {
      for (std::size_t c = from; c < to; ++c) {
        const auto row = static_cast<Eigen::Index>(f), column = static_cast<Eigen::Index>(c - from);
        const ChannelFit fit = mean_fit(problem.fits(normals[f], c, members));
        t.rms(row, column) = problem.rms(parts[f], c, fit);
        t.log_rms(row, column) = std::log(std::hypot(t.rms(row, column), floor[c]));
        if (!problem.extends_scenario())
          simulated(row, column) = std::log(std::hypot(problem.rms(parts[f], c, fit, false), floor[c]));
      }
    }
    const auto loss_of = [&](const Eigen::MatrixXd& logs) {
      Loss loss{.log_rms = {}, .rms = {}, .of_fold = mean_over_channels(logs)};
      loss.mean = mean_of_kinds(loss.of_fold, folds_);
      return loss;
    };
    t.loss = loss_of(t.log_rms);
    t.simulated = loss_of(simulated);
    return t;
  };
  const auto best_of = [&](std::size_t from, std::size_t to, const std::vector<Smoothness>& list) {
    Tried best = tried(from, to, {list.front()});
    for (const Smoothness& s : std::span(list).subspan(1)) {
      if (Tried t = tried(from, to, {s}); t.loss.mean < best.loss.mean) best = std::move(t);
    }
    return best;
  };
  // For a network alone, records begin in balance, unless the written scenario, which knows no other start, is better by
  // more than a standard error with free starts. For an extension they do so unless kept-out rows are better with free
  // starts: a heat must not explain a machine that was warm.
  const auto best_start = [&](std::size_t from, std::size_t to, const std::array<std::vector<Smoothness>, 2>& lists) {
    Tried best = best_of(from, to, lists[0]), free = best_of(from, to, lists[1]);
    const bool is_extension = problem.extends_scenario();
    return is_as_good(is_extension ? best.loss : best.simulated, is_extension ? free.loss : free.simulated) ? best : free;
  };
  const auto use = [&](std::size_t from, std::size_t to, const Tried& best) {
    for (std::size_t c = from; c < to; ++c) result.members[c] = best.members;
    result.loss.log_rms.middleCols(static_cast<Eigen::Index>(from), best.rms.cols()) = best.log_rms;
    result.loss.rms.middleCols(static_cast<Eigen::Index>(from), best.rms.cols()) = best.rms;
  };
  if (like) {
    result.scenario = like->scenario;
    for (std::size_t c = 0; c < n_c; ++c) use(c, c + 1, tried(c, c + 1, like->members[c]));
  } else if (problem.extends_scenario()) {  // each channel lacks different terms
    const bool hides_speeds =
        std::any_of(folds_.begin(), folds_.end(), [](const HiddenRows& f) { return f.kind == "speed"; });
    const auto at_speeds = [&](const Tried& t) {
      std::vector<double> errors;
      for (std::size_t f = 0; f < folds_.size(); ++f) {
        if (folds_[f].kind == "speed") errors.push_back(t.loss.of_fold[static_cast<Eigen::Index>(f)]);
      }
      return mean_error(errors).mean;
    };
    for (std::size_t c = 0; c < n_c; ++c) {
      Smoothness still{.start_of_thermometers = kStarts[0], .start_of_displacements = kStarts[0], .is_scenario_alone = true},
          free{.start_of_thermometers = kStarts[1], .start_of_displacements = kStarts[1], .is_scenario_alone = true};
      const Tried as_it_is = best_start(c, c + 1, {{{still}, {free}}});
      const Tried all = best_start(c, c + 1, beside_scenario(c < n_t, kAllKept));
      const Tried less = best_start(c, c + 1, beside_scenario(c < n_t, kLessKept));
      result.scenario.push_back(as_it_is.members.front());
      const bool may_lose = !hides_speeds || at_speeds(less) < at_speeds(all);
      const double most =
          std::log(kEnters) + std::min({as_it_is.loss.mean, all.loss.mean, may_lose ? less.loss.mean : all.loss.mean});
      std::vector<Smoothness> members;
      if (as_it_is.loss.mean <= most) members.push_back(as_it_is.members.front());
      if (all.loss.mean <= most || (!roles_.speed.empty() && !hides_speeds)) members.push_back(all.members.front());
      if (may_lose && less.loss.mean <= most) members.push_back(less.members.front());
      use(c, c + 1, tried(c, c + 1, members));
    }
  } else {
    if (n_t > 0) use(0, n_t, best_start(0, n_t, alone(true)));
    if (n_c > n_t) use(n_t, n_c, best_start(n_t, n_c, alone(false)));
  }
  weigh(result.loss, n_t, folds_);
  return result;
}

Loss Jury::of_scenario(const Judged& extension) const {
  const FosterProblem problem(records_, roles_, extension.structure, rise_K_, blocks_, simulated_);
  const std::size_t n_c = problem.channels().size();
  Loss loss;
  loss.rms.setConstant(static_cast<Eigen::Index>(folds_.size()), static_cast<Eigen::Index>(n_c),
                       std::numeric_limits<double>::quiet_NaN());
  loss.log_rms = loss.rms;
  for (std::size_t f = 0; f < folds_.size(); ++f) {
    const FosterProblem::Normal normal = problem.normal(folds_[f].hidden);
    const FosterProblem::Part part = problem.part(folds_[f].hidden);
    for (std::size_t c = 0; c < n_c; ++c) {
      const double rms = problem.rms(part, c, problem.fit(normal, c, extension.scenario[c]));
      const auto row = static_cast<Eigen::Index>(f), column = static_cast<Eigen::Index>(c);
      loss.rms(row, column) = rms;
      loss.log_rms(row, column) = std::log(std::hypot(rms, kFloor * deviation(problem.measured(c))));
    }
  }
  weigh(loss, problem.n_thermometers(), folds_);
  return loss;
}

}  // namespace driftwright::identification
