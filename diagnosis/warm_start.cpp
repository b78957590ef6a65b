#include "diagnosis/warm_start.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <cmath>

namespace driftwright::diagnosis {
namespace {

constexpr double kWarm_K = 4.0;
constexpr double kTogether = 0.7;       // correlation of the starts of two bodies
constexpr double kFirstRow_K = 0.5;     // standard deviation of a first reading: noise, and uneven temperatures of bodies
constexpr double kKnownStart_K = 0.02;  // a start known better than this counts as known

struct First {
  std::vector<int> outputs;
  Eigen::VectorXd beside_K;  // reading minus twin
  const MeasuredChannel* farthest = nullptr;
  double farthest_K = 0.0;
  int n_warm = 0;
};
First first_readings(const MeasuredRun& run, const Eigen::MatrixXd& prediction) {
  constexpr Eigen::Index kRows = 3;
  First first;
  std::vector<double> beside;
  for (const MeasuredChannel& c : run.channels) {
    if (c.unit != "K") continue;
    Eigen::Index i = 0;
    while (i < std::min(kRows, c.value.size()) && std::isnan(c.value[i])) ++i;
    if (i == kRows || i == c.value.size()) continue;
    const double by_K = c.value[i] - prediction(c.output, i);
    first.outputs.push_back(c.output);
    beside.push_back(by_K);
    if (std::abs(by_K) > kWarm_K) ++first.n_warm;
    if (std::abs(by_K) <= std::abs(first.farthest_K)) continue;
    first.farthest_K = by_K;
    first.farthest = &c;
  }
  first.beside_K = Eigen::Map<const Eigen::VectorXd>(beside.data(), static_cast<Eigen::Index>(beside.size()));
  return first;
}

}  // namespace

void find_warm_starts(std::vector<MeasuredRun>& runs, const Twin& twin) {
  Twin::Workspace workspace(twin);
  for (MeasuredRun& run : runs) {
    const First first = first_readings(run, twin.readings(twin.as_written(), run, workspace));
    const bool is_warm = first.n_warm > 0 && first.n_warm >= std::min<int>(2, static_cast<int>(first.outputs.size()));
    if (!is_warm) continue;
    const Eigen::MatrixXd bodies = twin.warmer_bodies();
    Eigen::MatrixXd seen(first.beside_K.size(), bodies.cols());
    for (Eigen::Index o = 0; o < seen.rows(); ++o)
      seen.row(o) = twin.outputs().state.col(first.outputs[static_cast<std::size_t>(o)]).transpose() * bodies;
    const double variance = first.beside_K.squaredNorm() / static_cast<double>(first.beside_K.size());
    Eigen::MatrixXd prior = Eigen::MatrixXd::Constant(bodies.cols(), bodies.cols(), kTogether * variance);
    prior.diagonal().setConstant(variance);
    Eigen::MatrixXd noise = seen * prior * seen.transpose();
    noise.diagonal().array() += kFirstRow_K * kFirstRow_K;
    const Eigen::LLT<Eigen::MatrixXd> factor(noise);
    run.start_K = prior * seen.transpose() * factor.solve(first.beside_K);
    const Eigen::MatrixXd doubt = prior - prior * seen.transpose() * factor.solve(seen * prior);
    const Eigen::LDLT<Eigen::MatrixXd> root(doubt);
    const Eigen::MatrixXd columns = root.transpositionsP().transpose() * Eigen::MatrixXd(root.matrixL()) *
                                    root.vectorD().cwiseMax(0.0).cwiseSqrt().asDiagonal();
    run.start_doubt_K.resize(columns.rows(), 0);
    for (Eigen::Index k = 0; k < columns.cols(); ++k) {
      if (columns.col(k).norm() < kKnownStart_K) continue;
      run.start_doubt_K.conservativeResize(Eigen::NoChange, run.start_doubt_K.cols() + 1);
      run.start_doubt_K.rightCols<1>() = columns.col(k);
    }
    run.findings.push_back(
        {first.farthest->name,
         fmt::format(
             "the machine is not at the ambient temperature as the record begins: {} of {} thermometers read more than "
             "{:g} K beside the scenario's start, {} by {:+.1f} K; the run starts from its first readings, and bodies "
             "without a thermometer are fitted. Let a record begin with the machine at rest for a night",
             first.n_warm, first.outputs.size(), kWarm_K, first.farthest->name, first.farthest_K),
         false});
  }
}

std::vector<Prediction> start_columns(const Twin& twin, const std::vector<MeasuredRun>& runs) {
  std::vector<Prediction> columns;
  Twin::Workspace workspace(twin);
  const auto readings = [&](const MeasuredRun& run) { return twin.readings(twin.as_written(), run, workspace); };
  for (std::size_t r = 0; r < runs.size(); ++r) {
    if (runs[r].start_doubt_K.cols() == 0) continue;
    const Eigen::MatrixXd base = readings(runs[r]);
    for (Eigen::Index k = 0; k < runs[r].start_doubt_K.cols(); ++k) {
      MeasuredRun other = runs[r];
      other.start_K += other.start_doubt_K.col(k);
      Prediction column;
      for (const MeasuredRun& run : runs)
        column.push_back(Eigen::MatrixXd::Zero(base.rows(), static_cast<Eigen::Index>(run.time_s.size())));
      column[r] = readings(other) - base;
      columns.push_back(std::move(column));
    }
  }
  return columns;
}

}  // namespace driftwright::diagnosis
