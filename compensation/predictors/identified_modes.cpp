#include "compensation/predictors/identified_modes.hpp"

#include <ceres/ceres.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/dense.hpp"
#include "base/errors.hpp"
#include "base/normal.hpp"

namespace driftwright::compensation {
namespace {

constexpr double kGrowthExponent = 0.7;  // of rates, as of forced films
constexpr double kMostGrowth = 4.0;
constexpr double kShortest_s = 60.0;  // time constant
constexpr double kWorthAMode = 0.97;  // of the held-out error

double rate_1_s(double time_constant_s, double growth, double x) {
  return (1.0 + growth * (x > 0.0 ? std::pow(x, kGrowthExponent) : 0.0)) / time_constant_s;
}

/// Power m of a speed; standstill has a separate level, because films and idle heat change there at once.
double steady_level(int m, double x) {
  if (m == 0) return x > 0.0 ? 0.0 : 1.0;
  return x > 0.0 ? std::pow(x, m - 1) : 0.0;
}

/// First-order states with one rate per section: for the level of each power, then for the ambient. n_powers + 1 columns.
Eigen::MatrixXd mode_states(const Cyclogram& cyclogram, const TimeSeries& ambient, const std::vector<double>& output_s,
                            double time_constant_s, double growth, double top_rpm, int powers) {
  Eigen::MatrixXd states(static_cast<Eigen::Index>(output_s.size()), powers + 1);
  Eigen::VectorXd now = Eigen::VectorXd::Zero(powers + 1);
  std::size_t next = 0;
  const auto write_until = [&](double end_s, bool is_last, auto&& at) {
    for (; next < output_s.size() && (output_s[next] < end_s || is_last); ++next)
      states.row(static_cast<Eigen::Index>(next)) = at(output_s[next]).transpose();
  };
  const std::vector<LinearStretch> stretches = linear_stretches(cyclogram, ambient);
  for (const LinearStretch& s : stretches) {
    const double x = s.drive.speed_rpm / top_rpm, lambda = rate_1_s(time_constant_s, growth, x);
    const double ambient_K = ambient.at(s.start_s), slope_K_s = (ambient.at(s.end_s) - ambient_K) / (s.end_s - s.start_s);
    const auto at = [&, start = now](double t_s) {
      const double dt_s = t_s - s.start_s, e = std::exp(-lambda * dt_s);
      Eigen::VectorXd y(powers + 1);
      for (int m = 0; m < powers; ++m) {
        const double level = steady_level(m, x);
        y[m] = level + (start[m] - level) * e;
      }
      const double behind_K = slope_K_s / lambda;  // distance at which a ramp is followed
      y[powers] = ambient_K + slope_K_s * dt_s - behind_K + (start[powers] - ambient_K + behind_K) * e;
      return y;
    };
    write_until(s.end_s, &s == &stretches.back(), at);
    now = at(s.end_s);
  }
  return states;
}

/// Tests averaged over some minutes, one below the other, each channel in units of its noise.
struct Table {
  std::vector<ThermalTest> tests;
  std::vector<double> speed_rpm;  ///< highest of each test
  Eigen::MatrixXd y;              ///< n_rows x n_channels
  Eigen::VectorXd noise;          ///< of each channel's averaged readings
  Eigen::VectorXd range;          ///< of each channel, in units of its noise
  double top_rpm = 0.0, longest_s = 0.0;
  double warmest_K = 10.0;  ///< largest range of a temperature, if one was read
};

Table table_of(const std::vector<ThermalTest>& tests, const TestChannels& channels, const IdentificationOptions& options) {
  Table t;
  std::set<double> speeds;
  Eigen::Index n_rows = 0;
  for (const ThermalTest& test : tests) {
    if (test.readings.rows() != static_cast<Eigen::Index>(channels.name.size()) ||
        test.readings.cols() != static_cast<Eigen::Index>(test.time_s.size()) || test.time_s.size() < 8) {
      throw InputError(fmt::format("test '{}': {} channels at 8 times or more are required; there are {} x {}",
                                   test.cyclogram.name, channels.name.size(), test.readings.rows(), test.readings.cols()));
    }
    for (std::size_t i = 0; i < test.time_s.size(); ++i) {
      for (std::size_t c = 0; c < channels.name.size(); ++c) {
        if (!std::isfinite(test.readings(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(i)))) {
          throw InputError(
              fmt::format("test '{}': no reading of '{}' at {} s", test.cyclogram.name, channels.name[c], test.time_s[i]));
        }
      }
      if (i > 0 && !(test.time_s[i] > test.time_s[i - 1])) {
        throw InputError(fmt::format("test '{}': time does not increase at {} s", test.cyclogram.name, test.time_s[i]));
      }
    }
    double top_rpm = 0.0;
    for (const auto& s : test.cyclogram.sections) {
      if (s.drive != Drive{.speed_rpm = s.drive.speed_rpm}) {
        throw InputError(
            fmt::format("test '{}' has feeds or cutting power; a test at fixed speeds has none", test.cyclogram.name));
      }
      if (s.drive.speed_rpm > 0.0) speeds.insert(s.drive.speed_rpm);
      top_rpm = std::max(top_rpm, s.drive.speed_rpm);
    }
    t.speed_rpm.push_back(top_rpm);
    t.top_rpm = std::max(t.top_rpm, top_rpm);
    t.longest_s = std::max(t.longest_s, test.time_s.back());
    t.tests.push_back(averaged(test, options.mean_over_s));
    n_rows += t.tests.back().readings.cols();
  }
  const int n_missing = options.powers - 1 - static_cast<int>(speeds.size());
  if (n_missing > 0) {
    throw InputError(
        fmt::format("tests at {} speeds above 0 rpm cannot give steady levels by {} powers of speed: {} more {} required",
                    speeds.size(), options.powers - 1, n_missing, n_missing == 1 ? "is" : "are"));
  }
  const auto n_channels = static_cast<Eigen::Index>(channels.name.size());
  double warmest_K = 0.0;
  t.noise.resize(n_channels);
  t.range.resize(n_channels);
  for (Eigen::Index c = 0; c < n_channels; ++c) {
    double low = 0.0, high = 0.0;
    for (const ThermalTest& test : t.tests) {
      low = std::min(low, test.readings.row(c).minCoeff());
      high = std::max(high, test.readings.row(c).maxCoeff());
    }
    const double rows =
        static_cast<double>(tests.front().time_s.size()) / static_cast<double>(t.tests.front().time_s.size());
    t.noise[c] = std::max(noise_of(tests, c) / std::sqrt(rows), kLeastNoise * std::max(1e-12, high - low));
    t.range[c] = std::max(1.0, (high - low) / t.noise[c]);
    if (channels.unit[static_cast<std::size_t>(c)] == "K") warmest_K = std::max(warmest_K, high - low);
  }
  if (warmest_K > 0.0) t.warmest_K = warmest_K;
  t.y.resize(n_rows, n_channels);
  Eigen::Index row = 0;
  for (const ThermalTest& test : t.tests) {
    t.y.middleRows(row, test.readings.cols()) = test.readings.transpose() * t.noise.cwiseInverse().asDiagonal();
    row += test.readings.cols();
  }
  return t;
}

/// Logarithm of the slowest time constant, of the ratio of each to the next faster one, then the growth.
using Shape = std::vector<double>;
constexpr double kClosest = 2.2, kFurthest = 40.0;  // limits of the ratios: closer modes would only cancel each other

std::vector<double> time_constants_s(const Shape& shape) {
  std::vector<double> list;
  double log_s = 0.0;
  for (std::size_t k = 0; k + 1 < shape.size(); ++k) {
    log_s = k == 0 ? shape[0] : log_s - shape[k];
    list.push_back(std::exp(log_s));
  }
  return list;
}

Eigen::MatrixXd basis(const Table& t, const Shape& shape, int powers, std::size_t test) {
  const std::size_t n_modes = shape.size() - 1;
  const ThermalTest& of = t.tests[test];
  Eigen::MatrixXd columns(static_cast<Eigen::Index>(of.time_s.size()), static_cast<Eigen::Index>(n_modes) * (powers + 1));
  const std::vector<double> time_constant_s = time_constants_s(shape);
  for (std::size_t k = 0; k < n_modes; ++k) {
    columns.middleCols(static_cast<Eigen::Index>(k) * (powers + 1), powers + 1) =
        mode_states(of.cyclogram, of.ambient, of.time_s, time_constant_s[k], shape.back(), t.top_rpm, powers);
  }
  return columns;
}

/// Steady levels for given time constants: least squares with a prior that none is larger than the channel itself (1 sigma
/// is its range), and that a kelvin of ambient has no larger effect than a kelvin of machine. Without the prior, columns
/// that the tests distinguish badly would cancel in the tests, but not elsewhere.
struct Linear {
  Eigen::MatrixXd amplitude;  ///< n_columns x n_channels, in units of noise
  Eigen::MatrixXd residual;   ///< of the used rows, then amplitude over its prior
};
Linear linear(const Table& t, const Shape& shape, int powers, std::size_t left_out) {
  std::vector<Eigen::MatrixXd> parts;
  Eigen::Index n = 0;
  for (std::size_t i = 0; i < t.tests.size(); ++i) {
    parts.push_back(i == left_out ? Eigen::MatrixXd() : basis(t, shape, powers, i));
    n += parts.back().rows();
  }
  const Eigen::Index n_columns = static_cast<Eigen::Index>(shape.size() - 1) * (powers + 1);
  Eigen::MatrixXd columns(n, n_columns), y(n, t.y.cols());
  Eigen::Index row = 0, from = 0;
  for (std::size_t i = 0; i < t.tests.size(); ++i) {
    const Eigen::Index rows = t.tests[i].readings.cols();
    if (i != left_out) {
      columns.middleRows(row, rows) = parts[i];
      y.middleRows(row, rows) = t.y.middleRows(from, rows);
      row += rows;
    }
    from += rows;
  }
  for (Eigen::Index c = powers; c < n_columns; c += powers + 1) columns.col(c) /= t.warmest_K;
  const dense::SymmetricEigen eigen(columns.transpose() * columns);
  const Eigen::VectorXd square = eigen.eigenvalues().cwiseMax(0.0);
  const Eigen::MatrixXd in_eigen = eigen.eigenvectors().transpose() * (columns.transpose() * y);
  Linear l{Eigen::MatrixXd(n_columns, y.cols()), Eigen::MatrixXd(n + n_columns, y.cols())};
  for (Eigen::Index c = 0; c < y.cols(); ++c) {
    const double ridge = std::pow(1.0 / t.range[c], 2);
    l.amplitude.col(c) = eigen.eigenvectors() * in_eigen.col(c).cwiseQuotient((square.array() + ridge).matrix());
    l.residual.col(c).tail(n_columns) = l.amplitude.col(c) / t.range[c];
  }
  l.residual.topRows(n) = y - columns * l.amplitude;
  for (Eigen::Index c = powers; c < n_columns; c += powers + 1) l.amplitude.row(c) /= t.warmest_K;
  return l;
}

struct Fitted {
  Shape shape;
  double cost = 0.0;
  Eigen::MatrixXd covariance;  ///< of the shape, noise as estimated from the residual
};

Fitted fit_shape(const Table& t, Shape start, const IdentificationOptions& options, std::size_t left_out,
                 bool with_covariance) {
  const auto n = static_cast<int>(start.size());
  const Linear sizes = linear(t, start, options.powers, left_out);
  const auto n_residuals = static_cast<int>(sizes.residual.size());
  const auto residual = [&](double const* const* parameters, double* out) {
    const Linear l = linear(t, {parameters[0], parameters[0] + n}, options.powers, left_out);
    Eigen::Map<Eigen::MatrixXd>(out, l.residual.rows(), l.residual.cols()) = l.residual;
    return true;
  };
  auto* cost = new ceres::DynamicNumericDiffCostFunction<decltype(residual)>(&residual, ceres::DO_NOT_TAKE_OWNERSHIP);
  cost->AddParameterBlock(n);
  cost->SetNumResiduals(n_residuals);
  ceres::Problem problem;
  problem.AddResidualBlock(cost, nullptr, start.data());
  problem.SetParameterLowerBound(start.data(), 0, std::log(kShortest_s));
  problem.SetParameterUpperBound(start.data(), 0, std::log(5.0 * t.longest_s));
  for (int k = 1; k + 1 < n; ++k) {
    problem.SetParameterLowerBound(start.data(), k, std::log(kClosest));
    problem.SetParameterUpperBound(start.data(), k, std::log(kFurthest));
  }
  problem.SetParameterLowerBound(start.data(), n - 1, 0.0);
  problem.SetParameterUpperBound(start.data(), n - 1, kMostGrowth);
  if (!options.with_growth) problem.SetManifold(start.data(), new ceres::SubsetManifold(n, {n - 1}));
  ceres::Solver::Options how;
  how.linear_solver_type = ceres::DENSE_QR;
  how.max_num_iterations = 60;
  how.function_tolerance = 1e-7;
  how.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(how, &problem, &summary);
  if (!summary.IsSolutionUsable())
    throw SolveError(fmt::format("modes could not be fitted to the tests: {}", summary.message));
  Fitted f{start, summary.final_cost, {}};
  if (with_covariance) {
    ceres::CRSMatrix jacobian;
    problem.Evaluate({}, nullptr, nullptr, nullptr, &jacobian);
    const int n_free = jacobian.num_cols;  // a fixed growth is the last parameter and has no column
    Eigen::MatrixXd square = Eigen::MatrixXd::Zero(n_free, n_free);
    for (int row = 0; row < jacobian.num_rows; ++row) {
      for (int a = jacobian.rows[static_cast<std::size_t>(row)]; a < jacobian.rows[static_cast<std::size_t>(row) + 1]; ++a) {
        for (int b = jacobian.rows[static_cast<std::size_t>(row)]; b < jacobian.rows[static_cast<std::size_t>(row) + 1];
             ++b) {
          square(jacobian.cols[static_cast<std::size_t>(a)], jacobian.cols[static_cast<std::size_t>(b)]) +=
              jacobian.values[static_cast<std::size_t>(a)] * jacobian.values[static_cast<std::size_t>(b)];
        }
      }
    }
    square.diagonal().array() += 1e-12 * (1.0 + square.trace());
    // levels are also fitted; residuals of their prior do not count
    const auto n_levels = static_cast<int>(2 * sizes.amplitude.size());
    f.covariance.setZero(n, n);
    f.covariance.topLeftCorner(n_free, n_free) =
        2.0 * f.cost / std::max(1, n_residuals - n_levels - n_free) *
        dense::solve_square(square, Eigen::MatrixXd::Identity(square.rows(), square.cols()));
  }
  return f;
}

/// Time constants spread evenly in their logarithm over the range that tests can show.
Shape first_guess(const Table& t, int n_modes, const IdentificationOptions& options) {
  const double slow = std::log(0.7 * t.longest_s), fast = std::log(n_modes < 3 ? 1800.0 : 400.0);
  Shape shape = {n_modes == 1 ? 0.5 * (slow + fast) : slow};
  for (int k = 1; k < n_modes; ++k) shape.push_back(std::max(std::log(1.05 * kClosest), (slow - fast) / (n_modes - 1)));
  shape.push_back(options.with_growth ? 0.1 : 0.0);
  return shape;
}

/// Root mean square error of tests of inner speeds, each predicted from the others, in units of noise.
double held_out(const Table& t, const Fitted& all, const IdentificationOptions& options) {
  double sum = 0.0;
  int n = 0;
  for (std::size_t test = 0; test < t.tests.size(); ++test) {
    const double rpm = t.speed_rpm[test];
    const bool is_inside =
        rpm < t.top_rpm && std::any_of(t.speed_rpm.begin(), t.speed_rpm.end(), [&](double s) { return s < rpm; });
    if (!is_inside) continue;  // an outer speed would be extrapolated
    const Fitted without = fit_shape(t, all.shape, options, test, false);
    const Eigen::MatrixXd predicted =
        basis(t, without.shape, options.powers, test) * linear(t, without.shape, options.powers, test).amplitude;
    Eigen::Index from = 0;
    for (std::size_t i = 0; i < test; ++i) from += t.tests[i].readings.cols();
    sum += (t.y.middleRows(from, predicted.rows()) - predicted).squaredNorm() / static_cast<double>(predicted.size());
    ++n;
  }
  if (n > 0) return std::sqrt(sum / n);
  // too few tests to leave one out: generalised cross-validation (Craven & Wahba, Numer. Math. 31 (1979) 377-403)
  const double n_readings = static_cast<double>(t.y.rows()),
               n_free = static_cast<double>(all.shape.size() - 1) * (options.powers + 1) + 1.0;
  return std::sqrt(2.0 * all.cost / static_cast<double>(t.y.size())) / std::max(0.01, 1.0 - n_free / n_readings);
}

}  // namespace

IdentifiedModes identify_modes(const std::vector<ThermalTest>& tests, const TestChannels& channels,
                               const IdentificationOptions& options) {
  if (tests.empty()) throw InputError("modes cannot be identified without tests");
  const Table t = table_of(tests, channels, options);
  constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  Fitted best;
  double best_error = 1e300;
  for (int n_modes = 1; n_modes <= options.most_modes; ++n_modes) {
    Fitted f = fit_shape(t, first_guess(t, n_modes, options), options, kNone, true);
    const double error = held_out(t, f, options);
    if (!std::isfinite(error)) throw SolveError(fmt::format("the error of {} modes is not finite", n_modes));
    if (!(error < kWorthAMode * best_error)) break;
    best = std::move(f);
    best_error = error;
  }
  const std::size_t n_modes = best.shape.size() - 1;
  const Eigen::MatrixXd a = linear(t, best.shape, options.powers, kNone).amplitude;
  const std::vector<double> time_constant_s = time_constants_s(best.shape);
  IdentifiedModes m;
  m.channels = channels;
  m.tested = tested_speeds(tests);
  for (std::size_t k = 0; k < n_modes; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    // log τ_k = s_0 - s_1 - ... - s_k
    Eigen::VectorXd of_shape = Eigen::VectorXd::Zero(best.covariance.rows());
    of_shape[0] = 1.0;
    of_shape.segment(1, i).setConstant(-1.0);
    const double sd = std::sqrt(std::max(0.0, of_shape.dot(best.covariance * of_shape)));
    m.modes.push_back({time_constant_s[k], time_constant_s[k] * std::exp(-kNormal95 * sd),
                       time_constant_s[k] * std::exp(kNormal95 * sd), best.shape.back()});
    const Eigen::MatrixXd of_mode =
        t.noise.asDiagonal() * a.middleRows(i * (options.powers + 1), options.powers + 1).transpose();
    m.level.emplace_back(of_mode.leftCols(options.powers));
    m.ambient.emplace_back(of_mode.col(options.powers));
  }
  return m;
}

Eigen::MatrixXd IdentifiedModes::predict(const Cyclogram& cyclogram, const TimeSeries& ambient_K,
                                         const std::vector<double>& output_s, bool extrapolate) const {
  require_tested(cyclogram, tested, extrapolate);
  Eigen::MatrixXd y =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(channels.name.size()), static_cast<Eigen::Index>(output_s.size()));
  for (std::size_t k = 0; k < modes.size(); ++k) {
    const auto powers = static_cast<int>(level[k].cols());
    const Eigen::MatrixXd states =
        mode_states(cyclogram, ambient_K, output_s, modes[k].time_constant_s, modes[k].growth, tested.top_rpm, powers);
    y.noalias() += level[k] * states.leftCols(powers).transpose();
    y.noalias() += ambient[k] * states.col(powers).transpose();
  }
  return y;
}

}  // namespace driftwright::compensation
