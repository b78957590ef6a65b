#include "compensation/predictors/scaled_modes.hpp"

#include <ceres/ceres.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "base/normal.hpp"
#include "solver/model_factors.hpp"
#include "solver/propagator.hpp"

namespace driftwright::compensation {
namespace {

constexpr double kPrior = 0.3;  // 1 sigma of a factor's logarithm: weak, so the tests decide
constexpr double kRowsEvery_s = 300.0;

/// Factors from their logarithms: sources, ambient, joints, rates, then displacements.
solver::ModelFactors factors_of(const solver::ReducedSystem& model, const double* log_factor) {
  const auto next = [&] { return std::exp(*log_factor++); };
  solver::ModelFactors f;
  for (std::size_t s = 0; s < model.sources.size(); ++s) f.source.push_back(next());
  const double ambient = next(), joints = next();
  for (const auto& e : model.exchanges) f.exchange.push_back(e.reaches_ambient() ? ambient : joints);
  f.rate = next();
  for (const std::string& unit : model.outputs.unit) f.output.push_back(unit == "K" ? 1.0 : next());
  return f;
}

}  // namespace

ScaledModes fit_scaled_modes(const solver::ReducedSystem& model, const Eigen::VectorXd& start, double ambient_K,
                             const std::vector<ThermalTest>& tests, const TestChannels& channels) {
  if (tests.empty()) throw InputError("a model cannot be scaled without tests");
  std::vector<std::size_t> output;
  for (const std::string& name : channels.name) {
    const auto found = std::find(model.outputs.name.begin(), model.outputs.name.end(), name);
    if (found == model.outputs.name.end()) throw InputError(fmt::format("the model has no output '{}'", name));
    output.push_back(static_cast<std::size_t>(found - model.outputs.name.begin()));
  }
  ScaledModes m;
  for (const auto& s : model.sources) m.factors.push_back({"heat of " + s.name});
  for (const char* name : {"films and links to the ambient", "joints and links between bodies", "rates of change"})
    m.factors.push_back({name});
  for (std::size_t o = 0; o < model.outputs.name.size(); ++o) {
    if (model.outputs.unit[o] != "K") m.factors.push_back({"displacement " + model.outputs.name[o]});
  }
  const auto n = static_cast<int>(m.factors.size());
  std::vector<ThermalTest> rows;
  for (const ThermalTest& t : tests) {
    if (!t.readings.allFinite()) throw InputError(fmt::format("test '{}' lacks readings", t.cyclogram.name));
    rows.push_back(averaged(t, kRowsEvery_s));
  }
  const double n_mean = static_cast<double>(tests.front().time_s.size()) / static_cast<double>(rows.front().time_s.size());
  std::vector<double> noise;
  for (std::size_t c = 0; c < channels.name.size(); ++c)
    noise.push_back(noise_of(tests, static_cast<Eigen::Index>(c)) / std::sqrt(n_mean));
  int n_residuals = n;
  for (const ThermalTest& t : rows) n_residuals += static_cast<int>(t.readings.size());
  const auto residual = [&](double const* const* parameters, double* out) {
    const solver::ReducedSystem s = solver::with_factors(model, factors_of(model, parameters[0]));
    const Eigen::VectorXd at_start = s.observe(start, ambient_K);
    solver::Propagator propagator(s);
    Eigen::Index at = 0;
    for (std::size_t t = 0; t < tests.size(); ++t) {
      TimeSeries ambient = tests[t].ambient;
      for (double& v : ambient.value) v += ambient_K;
      const solver::Trajectory run = propagator.run(tests[t].cyclogram, ambient, rows[t].time_s, start);
      for (std::size_t c = 0; c < output.size(); ++c) {
        const auto o = static_cast<Eigen::Index>(output[c]);
        const bool is_temperature = channels.unit[c] == "K";
        const double unit = is_temperature ? 1.0 : 1e6;
        for (Eigen::Index i = 0; i < run.outputs.cols(); ++i) {
          out[at++] =
              (rows[t].readings(static_cast<Eigen::Index>(c), i) - unit * (run.outputs(o, i) - at_start[o])) / noise[c];
        }
      }
    }
    for (int k = 0; k < n; ++k) out[at++] = parameters[0][k] / kPrior;
    return true;
  };
  std::vector<double> x(static_cast<std::size_t>(n), 0.0);
  auto* cost = new ceres::DynamicNumericDiffCostFunction<decltype(residual)>(&residual, ceres::DO_NOT_TAKE_OWNERSHIP);
  cost->AddParameterBlock(n);
  cost->SetNumResiduals(n_residuals);
  ceres::Problem problem;
  problem.AddResidualBlock(cost, nullptr, x.data());
  ceres::Solver::Options how;
  how.linear_solver_type = ceres::DENSE_QR;
  how.max_num_iterations = 30;
  how.function_tolerance = 1e-6;
  how.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(how, &problem, &summary);
  if (!summary.IsSolutionUsable())
    throw SolveError(fmt::format("the model could not be scaled to the tests: {}", summary.message));
  ceres::Covariance::Options precision;
  precision.algorithm_type = ceres::DENSE_SVD;
  precision.null_space_rank = -1;
  ceres::Covariance covariance(precision);
  std::vector<double> square(x.size() * x.size(), 0.0);
  const std::vector<std::pair<const double*, const double*>> blocks = {{x.data(), x.data()}};
  if (!covariance.Compute(blocks, &problem) || !covariance.GetCovarianceBlock(x.data(), x.data(), square.data()))
    throw SolveError("the factors of the scaled model have no intervals: their covariance could not be computed");
  const double variance = 2.0 * summary.final_cost / std::max(1, n_residuals - n);
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double sd = std::sqrt(std::max(0.0, variance * square[k * x.size() + k]));
    m.factors[k].value = std::exp(x[k]);
    m.factors[k].low = std::exp(x[k] - kNormal95 * sd);
    m.factors[k].high = std::exp(x[k] + kNormal95 * sd);
  }
  m.system = solver::with_factors(model, factors_of(model, x.data()));
  m.start = start;
  return m;
}

}  // namespace driftwright::compensation
