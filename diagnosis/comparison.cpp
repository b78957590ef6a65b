#include "diagnosis/comparison.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/residual_structure.hpp"
#include "effects/reading_chain.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kSlow_s = 1200.0;  // time constant of what instruments and integrators are off by
constexpr std::size_t kRowsForColumns = 60;  // fewer tell no noise from what follows them

}  // namespace

Comparison::Comparison(const std::vector<MeasuredRun>& runs, const std::map<std::string, NoiseModel>& noise) {
  for (std::size_t r = 0; r < runs.size(); ++r) {
    for (const MeasuredChannel& c : runs[r].channels) {
      whiteners_.emplace_back(noise.at(c.name), runs[r].time_s, present(c.value));
      blocks_.push_back({r, c.name, c.output, n_, whiteners_.back().n()});
      const Eigen::Index n = whiteners_.back().n(), together = std::max<Eigen::Index>(1, n / kEnough);
      condensed_.push_back({n_condensed(), (n + together - 1) / together, together});
      n_ += n;
    }
  }
  measured_.resize(n_);
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    whiteners_[b].apply(runs[blocks_[b].run].find(blocks_[b].channel)->value,
                        measured_.segment(blocks_[b].first, blocks_[b].n));
  }
}

Eigen::VectorXd Comparison::whitened(const Prediction& prediction) const {
  Eigen::VectorXd w(n_);
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const Eigen::VectorXd series = prediction[blocks_[b].run].row(blocks_[b].output).transpose();
    whiteners_[b].apply(series, w.segment(blocks_[b].first, blocks_[b].n));
  }
  return w;
}

Eigen::MatrixXd Comparison::condensed(const Eigen::Ref<const Eigen::MatrixXd>& whitened) const {
  Eigen::MatrixXd few(n_condensed(), whitened.cols());
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const Condensed& c = condensed_[b];
    for (Eigen::Index k = 0; k < c.n; ++k) {
      const Eigen::Index from = k * c.together, n = std::min(c.together, blocks_[b].n - from);
      few.row(c.first + k) =
          whitened.middleRows(blocks_[b].first + from, n).colwise().sum() / std::sqrt(static_cast<double>(n));
    }
  }
  return few;
}

Eigen::VectorXd relative_speed(const MeasuredRun& run) {
  Eigen::VectorXd speed(static_cast<Eigen::Index>(run.time_s.size()));
  for (std::size_t i = 0; i < run.time_s.size(); ++i)
    speed[static_cast<Eigen::Index>(i)] = run.cyclogram.speed_rpm(run.time_s[i]);
  const double top = speed.maxCoeff();
  return top > 0.0 ? Eigen::VectorXd(speed / top) : speed;
}

Eigen::MatrixXd curves_of(const MeasuredRun& run) {
  Eigen::MatrixXd curves = smooth_curves(run.time_s, relative_speed(run));
  if (run.time_s.size() < kRowsForColumns) return curves;
  for (const auto& [name, recorded] : beside_drive(run, 0.0)) {
    const double span = recorded.maxCoeff() - recorded.minCoeff();
    if (!(span > 0.0)) continue;
    for (double lag_s : {0.0, 180.0, 720.0}) {
      Eigen::RowVectorXd curve = (recorded.array() - recorded[0]).transpose() / span;
      effects::lag_behind(curve, run.time_s, lag_s);
      curves.conservativeResize(Eigen::NoChange, curves.cols() + 1);
      curves.rightCols<1>() = curve.transpose();
    }
  }
  return curves;
}

std::map<std::string, NoiseModel> estimate_noise(const std::vector<MeasuredRun>& runs, const Prediction& prediction,
                                                 const NoiseFloor& least) {
  std::map<std::string, std::vector<NoiseSeries>> series;
  std::map<std::string, double> floors, slow;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const Eigen::MatrixXd curves = curves_of(runs[r]);
    for (const MeasuredChannel& c : runs[r].channels) {
      const Eigen::Index n_readings = (c.value.array() == c.value.array()).count();
      series[c.name].push_back(
          {runs[r].time_s, c.value - prediction[r].row(c.output).transpose(), telling(curves, n_readings)});
      const double floor = c.unit == "K" ? least.white_K : c.unit == "m" ? least.white_m : least.white_rad;
      floors[c.name] = std::max({floors[c.name], floor, c.quantum / std::sqrt(12.0)});
      slow[c.name] = c.unit == "K" ? least.slow_K : c.unit == "m" ? least.slow_m : least.slow_rad;
    }
  }
  std::map<std::string, NoiseModel> noise;
  for (const auto& [name, list] : series) {
    NoiseModel& n = noise[name] = estimate_noise(list, floors[name]);
    if (n.correlated < slow[name]) n = {n.white, slow[name], kSlow_s};
  }
  return noise;
}

}  // namespace driftwright::diagnosis
