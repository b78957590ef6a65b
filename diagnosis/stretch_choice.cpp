#include "diagnosis/stretch_choice.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>

namespace driftwright::diagnosis {
namespace {

constexpr std::size_t kFewest = 3, kMost = 60;  // stretches of all runs
constexpr double kAtWork = 0.05;                // of a column's span above its least
constexpr const char* kFeeds[] = {"feed_x", "feed_y", "feed_z"};
constexpr const char *kSpeed = "speed", *kCutting = "cutting_power";
constexpr int kMostExchanges = 40;
constexpr double kLevelWidths[] = {0.05, 0.2, 0.6};  // of a quantity's span, over which sizes are alike
constexpr double kJitter = 1e-9;

/// @param at_work  of each run, whether there is work from row k to row k + 1
std::optional<WorkStretches> stretches_of(const std::vector<std::vector<char>>& at_work) {
  WorkStretches s;
  std::size_t n_stretches = 0;
  for (const std::vector<char>& steps : at_work) {
    std::vector<Eigen::Index>& edges = s.edges.emplace_back();
    std::vector<char>& is_work = s.is_work.emplace_back();
    for (std::size_t k = 0; k < steps.size(); ++k) {
      if (k > 0 && steps[k] == steps[k - 1]) continue;
      edges.push_back(static_cast<Eigen::Index>(k));
      is_work.push_back(steps[k]);
      if (steps[k] != 0) ++n_stretches;
    }
    edges.push_back(static_cast<Eigen::Index>(steps.size()));
  }
  if (n_stretches < kFewest || n_stretches > kMost) return std::nullopt;
  return s;
}

/// A choice and what it brings.
class Chooser {
 public:
  Chooser(const WindowEvidence& evidence, const WorkStretches& stretches) : e_(evidence) {
    for (std::size_t r = 0; r < e_.runs.size(); ++r) {
      for (std::size_t k = 0; k < stretches.is_work[r].size(); ++k) {
        if (stretches.is_work[r][k] != 0)
          cells_.push_back({r, static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(k) + 1});
      }
    }
    const auto n = static_cast<Eigen::Index>(cells_.size());
    slope_.resize(n);
    curvature_.resize(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      slope_[i] = e_.slope[at(i)];
      for (Eigen::Index j = 0; j < n; ++j) curvature_(i, j) = e_.curvature(at(i), at(j));
    }
    const auto log_factorial = [](Eigen::Index m) {
      double sum = 0.0;
      for (Eigen::Index i = 2; i <= m; ++i) sum += std::log(static_cast<double>(i));
      return sum;
    };
    for (Eigen::Index k = 0; k <= n; ++k)
      price_.push_back(k < n ? std::log(static_cast<double>(n)) + log_factorial(n) - log_factorial(k) - log_factorial(n - k)
                             : 0.0);
  }

  [[nodiscard]] Eigen::Index n() const { return slope_.size(); }
  /// @param slope, curvature  of the chosen ones, k of n
  [[nodiscard]] double gain(double slope, double curvature, Eigen::Index k) const {
    const double known = 1.0 / (e_.prior_sd * e_.prior_sd);
    if (!(curvature > 1e-9) || (e_.is_positive && slope < 0.0)) return -1e300;
    return 0.5 * slope * slope / (curvature + known) - 0.5 * std::log1p(curvature / known) -
           price_[static_cast<std::size_t>(k)];
  }
  /// The best that is reached by taking one in or out at a time, neither all of them nor none.
  [[nodiscard]] double improve(std::vector<char>& chosen) const {
    Eigen::VectorXd w = Eigen::Map<const Eigen::Vector<char, Eigen::Dynamic>>(chosen.data(), n()).cast<double>();
    Eigen::VectorXd along = curvature_ * w;
    auto k = static_cast<Eigen::Index>(w.sum());
    const auto is_choice = [&](Eigen::Index of) { return of > 0 && of < n(); };
    double best = is_choice(k) ? gain(slope_.dot(w), w.dot(along), k) : -1e300;
    for (int turn = 0; turn < kMostExchanges; ++turn) {
      const double slope = slope_.dot(w), curvature = w.dot(along);
      Eigen::Index flip = -1;
      for (Eigen::Index i = 0; i < n(); ++i) {
        const double sign = w[i] > 0.0 ? -1.0 : 1.0;
        const Eigen::Index of = k + (sign > 0.0 ? 1 : -1);
        if (!is_choice(of)) continue;
        const double value = gain(slope + sign * slope_[i], curvature + 2.0 * sign * along[i] + curvature_(i, i), of);
        if (value > best + 1e-9) {
          best = value;
          flip = i;
        }
      }
      if (flip < 0) break;
      const double sign = w[flip] > 0.0 ? -1.0 : 1.0;
      w[flip] += sign;
      k += sign > 0.0 ? 1 : -1;
      along += sign * curvature_.col(flip);
    }
    for (Eigen::Index i = 0; i < n(); ++i) chosen[static_cast<std::size_t>(i)] = w[i] > 0.0 ? 1 : 0;
    return best;
  }
  /// What all of them bring, which is no choice and costs none: a law of the drive.
  [[nodiscard]] double gain_of_all() const { return gain(slope_.sum(), curvature_.sum(), n()); }
  /// What sizes bring that follow a level in any shape: about 0 with covariance s² e^{-|v - v'|/w}, s as large as the choice's, which they pay for as it does.
  /// @param level  of each stretch
  [[nodiscard]] double gain_by(const Eigen::VectorXd& level, double width, const FoundWindows& of) const {
    Eigen::MatrixXd covariance(n(), n());
    for (Eigen::Index i = 0; i < n(); ++i)
      covariance.col(i) = of.size * of.size * (-(level.array() - level[i]).abs() / width).exp();
    covariance.diagonal().array() += kJitter * of.size * of.size;
    const Eigen::MatrixXd root = covariance.llt().matrixL();
    const Eigen::MatrixXd information = root.transpose() * curvature_ * root + Eigen::MatrixXd::Identity(n(), n());
    const Eigen::LLT<Eigen::MatrixXd> factor(information);
    const Eigen::VectorXd slope = root.transpose() * slope_;
    return 0.5 * slope.dot(factor.solve(slope)) - factor.matrixLLT().diagonal().array().log().sum() -
           0.5 * std::log1p(e_.prior_sd * e_.prior_sd * curvature_of(of));
  }
  /// Of each stretch. @param of_cell  by run and cell
  [[nodiscard]] Eigen::VectorXd of_stretches(const std::vector<std::vector<double>>& of_cell) const {
    Eigen::VectorXd values(n());
    for (Eigen::Index i = 0; i < n(); ++i) {
      const FoundWindows::Window& c = cells_[static_cast<std::size_t>(i)];
      values[i] = of_cell[c.run][static_cast<std::size_t>(c.first)];
    }
    return values;
  }
  [[nodiscard]] FoundWindows found(const std::vector<char>& chosen, double value) const {
    FoundWindows f;
    f.gain = value;
    Eigen::VectorXd w = Eigen::VectorXd::Zero(n());
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      if (chosen[i] == 0) continue;
      f.windows.push_back(cells_[i]);
      w[static_cast<Eigen::Index>(i)] = 1.0;
    }
    f.size = slope_.dot(w) / (w.dot(curvature_ * w) + 1.0 / (e_.prior_sd * e_.prior_sd));
    f.price_nats = price_[f.windows.size()];
    return f;
  }

 private:
  [[nodiscard]] double curvature_of(const FoundWindows& of) const {
    double sum = 0.0;
    for (const FoundWindows::Window& a : of.windows) {
      for (const FoundWindows::Window& b : of.windows)
        sum += e_.curvature(e_.runs[a.run].first + a.first, e_.runs[b.run].first + b.first);
    }
    return sum;
  }
  [[nodiscard]] Eigen::Index at(Eigen::Index i) const {
    const FoundWindows::Window& c = cells_[static_cast<std::size_t>(i)];
    return e_.runs[c.run].first + c.first;
  }

  const WindowEvidence& e_;
  std::vector<FoundWindows::Window> cells_;
  Eigen::VectorXd slope_;
  Eigen::MatrixXd curvature_;
  std::vector<double> price_;  // of k of them
};

}  // namespace

namespace {

using Recorded = std::map<std::string, Eigen::VectorXd>;  // of a run, from row to row

/// What is recorded of a run's work: speed, feeds, cutting power and further columns.
Recorded recorded_in(const MeasuredRun& run) {
  const auto n_steps = static_cast<Eigen::Index>(run.time_s.size()) - 1;
  Recorded values;
  for (const char* name : {kSpeed, kCutting, kFeeds[0], kFeeds[1], kFeeds[2]}) values[name] = Eigen::VectorXd::Zero(n_steps);
  const auto& sections = run.cyclogram.sections;
  std::size_t at = 0;
  double end_s = sections.empty() ? 0.0 : sections[0].duration_s;
  for (Eigen::Index k = 0; k < n_steps && !sections.empty(); ++k) {
    const auto row = static_cast<std::size_t>(k);
    const double middle_s = 0.5 * (run.time_s[row] + run.time_s[row + 1]);
    while (at + 1 < sections.size() && middle_s >= end_s) end_s += sections[++at].duration_s;
    const Drive& drive = sections[at].drive;
    values[kSpeed][k] = drive.speed_rpm;
    values[kCutting][k] = drive.cutting_power_W;
    for (std::size_t axis = 0; axis < 3; ++axis) values[kFeeds[axis]][k] = drive.feed_m_s[axis];
  }
  for (const Cyclogram::Column& c : run.cyclogram.columns) {
    Eigen::VectorXd& of_column = values[c.header()] = Eigen::VectorXd(n_steps);
    for (Eigen::Index step = 0; step < n_steps; ++step) of_column[step] = c.at(run.time_s[static_cast<std::size_t>(step)]);
  }
  return values;
}

/// Means of what is recorded in each cell.
std::vector<std::vector<double>> means(const Edges& edges, const std::vector<Recorded>& recorded, const std::string& of) {
  std::vector<std::vector<double>> level;
  for (std::size_t r = 0; r < edges.size(); ++r) {
    const Eigen::VectorXd& values = recorded[r].at(of);
    std::vector<double>& of_run = level.emplace_back();
    for (std::size_t k = 0; k + 1 < edges[r].size(); ++k)
      of_run.push_back(values.segment(edges[r][k], edges[r][k + 1] - edges[r][k]).mean());
  }
  return level;
}

}  // namespace

std::vector<WorkStretches> stretches_of_work(const std::vector<MeasuredRun>& runs) {
  std::vector<Recorded> recorded;
  for (const MeasuredRun& run : runs) recorded.push_back(recorded_in(run));
  std::vector<std::string> names;  // of what all runs have and what changes in some
  for (const auto& [name, values] : recorded.front()) {
    double least = values.minCoeff(), most = values.maxCoeff();
    bool is_in_all = true;
    for (const Recorded& of_run : recorded) {
      const auto found = of_run.find(name);
      is_in_all = is_in_all && found != of_run.end();
      if (!is_in_all) break;
      least = std::min(least, found->second.minCoeff());
      most = std::max(most, found->second.maxCoeff());
    }
    if (is_in_all && most > least) names.push_back(name);
  }
  std::vector<WorkStretches> list;
  for (const std::string& name : names) {
    if (name.ends_with("degC")) continue;  // a temperature does not work
    const bool is_drive = name == kSpeed || name == kCutting || name.starts_with("feed_");
    double least = is_drive ? 0.0 : 1e300, most = -1e300;
    for (const Recorded& of_run : recorded) {
      least = std::min(least, of_run.at(name).minCoeff());
      most = std::max(most, of_run.at(name).maxCoeff());
    }
    const double rests_to = least + (is_drive ? 0.0 : kAtWork * (most - least));
    std::vector<std::vector<char>> at_work;
    for (const Recorded& of_run : recorded) {
      std::vector<char>& steps = at_work.emplace_back();
      for (double v : of_run.at(name)) steps.push_back(v > rests_to ? 1 : 0);
    }
    auto s = stretches_of(at_work);
    const bool is_known = s && std::any_of(list.begin(), list.end(), [&](const WorkStretches& o) {
                            return o.edges == s->edges && o.is_work == s->is_work;
                          });
    if (s && !is_known) list.push_back(*std::move(s));
  }
  for (WorkStretches& s : list) {
    for (const std::string& name : names) s.levels.push_back(means(s.edges, recorded, name));
  }
  return list;
}

std::optional<FoundWindows> choose_stretches(const WindowEvidence& evidence, const WorkStretches& stretches) {
  const Chooser chooser(evidence, stretches);
  const auto n = static_cast<std::size_t>(chooser.n());
  std::vector<char> best;
  double value = -1e300;
  const auto begin_with = [&](std::vector<char> chosen) {
    const double reached = chooser.improve(chosen);
    if (!(reached > value)) return;
    value = reached;
    best = std::move(chosen);
  };
  for (std::size_t every = 2; every <= 3; ++every) {
    for (std::size_t first = 0; first < every; ++first) {
      std::vector<char> chosen(n, 0);
      for (std::size_t i = first; i < n; i += every) chosen[i] = 1;
      begin_with(std::move(chosen));
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<char> chosen(n, 0);
    chosen[i] = 1;
    begin_with(std::move(chosen));
  }
  if (best.empty()) return std::nullopt;
  const FoundWindows found = chooser.found(best, value);
  if (chooser.gain_of_all() >= found.gain) return std::nullopt;
  const double n_tried = static_cast<double>(std::size(kLevelWidths) * std::max<std::size_t>(1, stretches.levels.size()));
  for (const auto& level : stretches.levels) {
    const Eigen::VectorXd of = chooser.of_stretches(level);
    const double span = of.maxCoeff() - of.minCoeff();
    for (const double width : kLevelWidths) {
      if (span > 0.0 && chooser.gain_by(of, width * span, found) - std::log(n_tried) > found.gain) return std::nullopt;
    }
  }
  return found;
}

}  // namespace driftwright::diagnosis
