#include "diagnosis/plain_regression.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "diagnosis/residual_structure.hpp"
#include "effects/reading_chain.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kRegressionLags_s[] = {0.0, 300.0, 1200.0, 4800.0};
constexpr double kAmbientLags_s[] = {0.0, 3600.0, 14400.0};
constexpr double kColumnLags_s[] = {0.0, 600.0, 3600.0};
constexpr double kPenalties[] = {1e-6, 1e-5, 1e-4, 1e-3, 3e-3, 0.01, 0.03, 0.1, 1.0};
constexpr Eigen::Index kParts = 8;     // of a single run
constexpr double kStandsStill = 1e-9;  // variance divided by the mean square, below which a column is constant

/// The drive after a first-order lag that starts at rest; each value holds until the next row.
Eigen::VectorXd held_behind(const Eigen::VectorXd& drive, const std::vector<double>& time_s, double lag_s) {
  if (lag_s <= 0.0) return drive;
  Eigen::VectorXd behind = Eigen::VectorXd::Zero(drive.size());
  for (Eigen::Index i = 1; i < drive.size(); ++i) {
    const double step_s = time_s[static_cast<std::size_t>(i)] - time_s[static_cast<std::size_t>(i - 1)];
    behind[i] = behind[i - 1] - std::expm1(-step_s / lag_s) * (drive[i - 1] - behind[i - 1]);
  }
  return behind;
}
/// The same for a sampled signal, starting at its first value.
Eigen::VectorXd sampled_behind(const Eigen::VectorXd& signal, const std::vector<double>& time_s, double lag_s) {
  Eigen::RowVectorXd behind = signal.transpose();
  effects::lag_behind(behind, time_s, lag_s);
  return behind.transpose();
}

/// A reading; a missing one has the value before.
Eigen::VectorXd held(const Eigen::VectorXd& reading) {
  Eigen::VectorXd whole = reading;
  double last = 0.0;
  for (double v : reading) {
    if (std::isnan(v)) continue;
    last = v;
    break;
  }
  for (double& v : whole) v = last = std::isnan(v) ? last : v;
  return whole;
}

/// The other data of a run besides its readings, n_times x n_columns.
Eigen::MatrixXd drive_columns(const MeasuredRun& run) {
  const auto n = static_cast<Eigen::Index>(run.time_s.size());
  Eigen::VectorXd speed(n), ambient(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double t_s = run.time_s[static_cast<std::size_t>(i)];
    speed[i] = 1e-3 * run.cyclogram.speed_rpm(t_s);
    ambient[i] = run.ambient.at(t_s);
  }
  std::vector<Eigen::VectorXd> columns;
  for (const Eigen::VectorXd& drive :
       {speed, Eigen::VectorXd(speed.array().square()), Eigen::VectorXd((speed.array() > 0.0).cast<double>())})
    for (double lag_s : kRegressionLags_s) columns.push_back(held_behind(drive, run.time_s, lag_s));
  for (double lag_s : kAmbientLags_s) columns.push_back(sampled_behind(ambient, run.time_s, lag_s));
  for (const auto& [name, recorded] : beside_drive(run, 0.0)) {
    for (double lag_s : kColumnLags_s) columns.push_back(held_behind(held(recorded), run.time_s, lag_s));
  }
  Eigen::MatrixXd all(n, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t c = 0; c < columns.size(); ++c) all.col(static_cast<Eigen::Index>(c)) = columns[c];
  return all;
}

/// Sums over a part of the rows, from which regressions on several parts are computed.
struct Sums {
  double n = 0.0, y = 0.0, yy = 0.0;
  Eigen::VectorXd x, xy;
  Eigen::MatrixXd xx;
  explicit Sums(Eigen::Index n_columns)
      : x(Eigen::VectorXd::Zero(n_columns)), xy(x), xx(Eigen::MatrixXd::Zero(n_columns, n_columns)) {}
  void add(const Eigen::VectorXd& row, double value) {
    n += 1.0;
    y += value;
    yy += value * value;
    x += row;
    xy += value * row;
    xx.selfadjointView<Eigen::Lower>().rankUpdate(row);
  }
  void add(const Sums& other, double factor) {
    n += factor * other.n;
    y += factor * other.y;
    yy += factor * other.yy;
    x += factor * other.x;
    xy += factor * other.xy;
    xx += factor * other.xx;
  }
};

struct Line {
  double at_zero = 0.0;
  Eigen::VectorXd slope;
  /// Squares of its errors in some rows.
  [[nodiscard]] double squares(const Sums& s) const {
    const Eigen::VectorXd xx_b = s.xx.selfadjointView<Eigen::Lower>() * slope;
    return s.yy - 2.0 * (at_zero * s.y + slope.dot(s.xy)) + at_zero * at_zero * s.n + 2.0 * at_zero * slope.dot(s.x) +
           slope.dot(xx_b);
  }
};

/// Minimises |y - a - x b|² / n + penalty |b deviation(x)|²; constant columns are left out.
Line ridge(const Sums& s, double penalty) {
  const Eigen::VectorXd mean = s.x / s.n;
  Eigen::MatrixXd a = s.xx.selfadjointView<Eigen::Lower>();
  a = (a / s.n - mean * mean.transpose()).eval();
  const Eigen::VectorXd variance = a.diagonal().cwiseMax(0.0);
  Eigen::VectorXd scale = Eigen::VectorXd::Zero(mean.size());
  for (Eigen::Index i = 0; i < scale.size(); ++i) {
    if (variance[i] > kStandsStill * (variance[i] + mean[i] * mean[i])) scale[i] = 1.0 / std::sqrt(variance[i]);
  }
  a = (scale.asDiagonal() * a * scale.asDiagonal()).eval();
  a.diagonal().array() += penalty;
  const Eigen::VectorXd b = scale.cwiseProduct(s.xy / s.n - mean * (s.y / s.n));
  Line line{.at_zero = 0.0, .slope = scale.cwiseProduct(a.ldlt().solve(b))};
  line.at_zero = s.y / s.n - mean.dot(line.slope);
  return line;
}

}  // namespace

Prediction plain_regression(const std::vector<MeasuredRun>& runs, const std::vector<MeasuredRun>& fitted, int n_outputs,
                            Regressors regressors) {
  std::vector<Eigen::MatrixXd> driven;
  Prediction prediction;
  std::vector<std::string> thermometers;  // that every run has
  for (const MeasuredRun& run : runs) {
    driven.push_back(drive_columns(run));
    prediction.push_back(Eigen::MatrixXd::Zero(n_outputs, static_cast<Eigen::Index>(run.time_s.size())));
  }
  for (const MeasuredChannel& c : runs.front().channels) {
    const bool is_everywhere =
        c.unit == "K" && std::all_of(runs.begin(), runs.end(), [&](const MeasuredRun& r) { return r.find(c.name); });
    if (is_everywhere && regressors == Regressors::kDriveAndReadings) thermometers.push_back(c.name);
  }
  std::vector<std::pair<std::string, int>> channels;
  for (const MeasuredRun& run : runs) {
    for (const MeasuredChannel& c : run.channels) {
      if (std::find(channels.begin(), channels.end(), std::pair(c.name, c.output)) == channels.end())
        channels.emplace_back(c.name, c.output);
    }
  }
  for (const auto& [name, output] : channels) {
    std::vector<Eigen::MatrixXd> columns = driven;
    for (std::size_t r = 0; r < runs.size(); ++r) {
      for (const std::string& t : thermometers) {
        if (t == name) continue;
        columns[r].conservativeResize(Eigen::NoChange, columns[r].cols() + 1);
        columns[r].rightCols<1>() = held(runs[r].find(t)->value);
      }
    }
    std::vector<Sums> parts;
    Sums all(columns.front().cols());
    for (std::size_t r = 0; r < runs.size(); ++r) {
      const MeasuredChannel* c = fitted[r].find(name);
      if (!c) continue;
      const Eigen::Index n_parts = runs.size() > 1 ? 1 : kParts, n = c->value.size();
      for (Eigen::Index p = 0; p < n_parts; ++p) {
        Sums part(columns[r].cols());
        for (Eigen::Index i = n * p / n_parts; i < n * (p + 1) / n_parts; ++i) {
          if (!std::isnan(c->value[i])) part.add(columns[r].row(i).transpose(), c->value[i]);
        }
        if (part.n == 0.0) continue;
        all.add(part, 1.0);
        parts.push_back(std::move(part));
      }
    }
    if (all.n == 0.0) continue;
    double least = 1e300, penalty = kPenalties[std::size(kPenalties) - 1];
    for (double tried : kPenalties) {
      double squares = 0.0;
      for (const Sums& part : parts) {
        Sums others = all;
        others.add(part, -1.0);
        if (others.n > 0.5) squares += ridge(others, tried).squares(part);
      }
      if (squares >= least) continue;
      least = squares;
      penalty = tried;
    }
    const Line line = ridge(all, penalty);
    for (std::size_t r = 0; r < runs.size(); ++r)
      prediction[r].row(output) = ((columns[r] * line.slope).array() + line.at_zero).transpose();
  }
  return prediction;
}

}  // namespace driftwright::diagnosis
