#include "diagnosis/stretch_choice.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>

#include "diagnosis/residual_structure.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr std::size_t kFewest = 3, kMost = 60;  // stretches of all runs
constexpr double kAtWork = 0.05;                // of a column's span above its least
constexpr int kMostTurns = 40;
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
  }

  [[nodiscard]] Eigen::Index n() const { return slope_.size(); }
  [[nodiscard]] static double price(Eigen::Index n, Eigen::Index k) {
    const auto log_factorial = [](Eigen::Index m) { return std::lgamma(static_cast<double>(m) + 1.0); };
    return std::log(static_cast<double>(n)) + log_factorial(n) - log_factorial(k) - log_factorial(n - k);
  }
  [[nodiscard]] double gain(const std::vector<char>& chosen) const {
    const Eigen::VectorXd w = Eigen::Map<const Eigen::Vector<char, Eigen::Dynamic>>(chosen.data(), n()).cast<double>();
    const auto k = static_cast<Eigen::Index>(w.sum());
    if (k == 0 || k == n()) return -1e300;
    const double slope = slope_.dot(w), curvature = w.dot(curvature_ * w), known = 1.0 / (e_.prior_sd * e_.prior_sd);
    if (!(curvature > 1e-9) || (e_.is_positive && slope < 0.0)) return -1e300;
    return 0.5 * slope * slope / (curvature + known) - 0.5 * std::log1p(curvature / known) - price(n(), k);
  }
  /// The best that is reached by taking one in or out at a time.
  [[nodiscard]] double improve(std::vector<char>& chosen) const {
    double best = gain(chosen);
    for (int turn = 0; turn < kMostTurns; ++turn) {
      std::size_t flip = chosen.size();
      for (std::size_t i = 0; i < chosen.size(); ++i) {
        chosen[i] ^= 1;
        if (const double value = gain(chosen); value > best + 1e-9) {
          best = value;
          flip = i;
        }
        chosen[i] ^= 1;
      }
      if (flip == chosen.size()) break;
      chosen[flip] ^= 1;
    }
    return best;
  }
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
    f.price_nats = price(n(), static_cast<Eigen::Index>(f.windows.size()));
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
};

}  // namespace

namespace {

/// Means of what is recorded in each cell. @param values  of each run, from row k to row k + 1
std::vector<std::vector<double>> means(const Edges& edges, const std::vector<Eigen::VectorXd>& values) {
  std::vector<std::vector<double>> level;
  for (std::size_t r = 0; r < edges.size(); ++r) {
    std::vector<double>& of_run = level.emplace_back();
    for (std::size_t k = 0; k + 1 < edges[r].size(); ++k)
      of_run.push_back(values[r].segment(edges[r][k], edges[r][k + 1] - edges[r][k]).mean());
  }
  return level;
}

}  // namespace

std::vector<WorkStretches> stretches_of_work(const std::vector<MeasuredRun>& runs) {
  // What is recorded of each run, from row to row: the speed, then further columns.
  std::vector<std::string> columns = {""};
  std::vector<std::map<std::string, Eigen::VectorXd>> recorded;
  for (const MeasuredRun& run : runs) {
    const auto n_steps = static_cast<Eigen::Index>(run.time_s.size()) - 1;
    auto& of_run = recorded.emplace_back();
    Eigen::VectorXd& speed = of_run[""] = Eigen::VectorXd(n_steps);
    for (Eigen::Index k = 0; k < n_steps; ++k) {
      const auto i = static_cast<std::size_t>(k);
      speed[k] = run.cyclogram.speed_rpm(0.5 * (run.time_s[i] + run.time_s[i + 1]));
    }
    for (const auto& [name, values] : beside_drive(run, 0.0)) {
      of_run[name] = values.head(n_steps);
      if (std::find(columns.begin(), columns.end(), name) == columns.end()) columns.push_back(name);
    }
    for (const std::string& column : columns) {
      if (!of_run.contains(column)) of_run[column] = Eigen::VectorXd::Zero(n_steps);
    }
  }
  std::erase_if(columns, [&](const std::string& c) {
    return std::any_of(recorded.begin(), recorded.end(), [&](const auto& of_run) { return !of_run.contains(c); });
  });
  std::vector<WorkStretches> list;
  for (const std::string& column : columns) {
    std::vector<std::vector<char>> at_work;
    for (const auto& of_run : recorded) {
      const Eigen::VectorXd& values = of_run.at(column);
      const double least = column.empty() ? 0.0 : values.minCoeff(), span = values.maxCoeff() - least;
      std::vector<char>& steps = at_work.emplace_back();
      for (double v : values) steps.push_back(span > 0.0 && v > least + (column.empty() ? 0.0 : kAtWork * span) ? 1 : 0);
    }
    auto s = stretches_of(at_work);
    const bool is_known =
        s && std::any_of(list.begin(), list.end(), [&](const WorkStretches& o) { return o.edges == s->edges; });
    if (s && !is_known) list.push_back(*std::move(s));
  }
  for (WorkStretches& s : list) {
    for (const std::string& column : columns) {
      std::vector<Eigen::VectorXd> values;
      for (const auto& of_run : recorded) values.push_back(of_run.at(column));
      s.levels.push_back(means(s.edges, values));
    }
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
