#include "diagnosis/comparison.hpp"

#include <algorithm>
#include <cmath>

#include "base/dense.hpp"
#include "diagnosis/residual_structure.hpp"
#include "effects/reading_chain.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kSlow_s = 1200.0;           // time constant of the slow errors of instruments and integrators
constexpr double kNoMatter = 1e-3;           // least variance of shared noise along a direction, over the channels' own
constexpr Eigen::Index kFewestForNoise = 4;  // least readings of a channel in a record
constexpr std::size_t kRowsForColumns = 60;  // with fewer, noise and columns cannot be distinguished

}  // namespace

Comparison::Comparison(const std::vector<MeasuredRun>& runs, const std::map<std::string, NoiseModel>& noise,
                       const SharedNoise& shared) {
  for (std::size_t r = 0; r < runs.size(); ++r) {
    runs_.push_back({.first_block = blocks_.size(), .n_blocks = runs[r].channels.size(), .first = n_, .q = {}, .taken = {}});
    for (const MeasuredChannel& c : runs[r].channels) {
      whiteners_.emplace_back(noise.at(c.name), runs[r].time_s, present(c.value));
      blocks_.push_back({r, c.name, c.output, n_, whiteners_.back().n()});
      const Eigen::Index n = whiteners_.back().n(), together = std::max<Eigen::Index>(1, n / kEnough);
      condensed_.push_back({n_condensed(), (n + together - 1) / together, together});
      n_ += n;
    }
    runs_.back().n = n_ - runs_.back().first;
    if (!shared.empty() && shared[r].cols() > 0) take_shared(runs_.back(), shared[r]);
  }
  measured_.resize(n_);
  for (std::size_t r = 0; r < runs.size(); ++r) {
    if (runs[r].channels.empty()) continue;
    Eigen::MatrixXd readings(runs[r].channels.size(), runs[r].time_s.size());
    for (std::size_t c = 0; c < runs[r].channels.size(); ++c)
      readings.row(static_cast<Eigen::Index>(c)) = runs[r].channels[c].value.transpose();
    whiten(r, readings, measured_.segment(runs_[r].first, runs_[r].n));
  }
}

/// (I + U U')^-1/2 = I - Q diag(1 - 1/sqrt(1 + s^2)) Q' with U = Q diag(s) V', U the root once each channel's own noise
/// is white.
void Comparison::take_shared(Run& run, const Eigen::MatrixXd& root) {
  const Eigen::Index n_times = root.rows() / static_cast<Eigen::Index>(run.n_blocks);
  Eigen::MatrixXd u(run.n, root.cols());
  for (std::size_t c = 0; c < run.n_blocks; ++c) {
    const Block& block = blocks_[run.first_block + c];
    const auto rows = root.middleRows(static_cast<Eigen::Index>(c) * n_times, n_times);
    for (Eigen::Index k = 0; k < u.cols(); ++k)
      whiteners_[run.first_block + c].apply(rows.col(k), u.col(k).segment(block.first - run.first, block.n));
  }
  const dense::SymmetricEigen eigen(u.transpose() * u);
  const Eigen::VectorXd squares = eigen.eigenvalues().cwiseMax(0.0);
  const auto n_kept = (squares.array() > kNoMatter).count();
  const Eigen::VectorXd kept = squares.tail(n_kept);
  run.q = u * eigen.eigenvectors().rightCols(n_kept) * kept.cwiseSqrt().cwiseInverse().asDiagonal();
  run.taken = 1.0 - (1.0 + kept.array()).rsqrt();
}

void Comparison::without_shared(const Run& run, Eigen::Ref<Eigen::VectorXd> whitened) const {
  if (run.taken.size() == 0) return;
  const Eigen::VectorXd along = run.taken.cwiseProduct(run.q.transpose() * whitened);
  whitened.noalias() -= run.q * along;
}

void Comparison::whiten(std::size_t r, const Eigen::Ref<const Eigen::MatrixXd>& readings,
                        Eigen::Ref<Eigen::VectorXd> whitened) const {
  const Run& run = runs_[r];
  for (std::size_t c = 0; c < run.n_blocks; ++c) {
    const Block& block = blocks_[run.first_block + c];
    const auto of_channel = readings.row(static_cast<Eigen::Index>(c));
    auto to = whitened.segment(block.first - run.first, block.n);
    if (of_channel.isZero(0.0))  // usual of a statement about an instrument
      to.setZero();
    else
      whiteners_[run.first_block + c].apply(of_channel.transpose(), to);
  }
  without_shared(run, whitened);
}

Eigen::VectorXd Comparison::whitened(const Prediction& prediction) const {
  Eigen::VectorXd w(n_);
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const Eigen::VectorXd series = prediction[blocks_[b].run].row(blocks_[b].output).transpose();
    whiteners_[b].apply(series, w.segment(blocks_[b].first, blocks_[b].n));
  }
  for (const Run& run : runs_) without_shared(run, w.segment(run.first, run.n));
  return w;
}

void Comparison::condense(std::size_t first_block, std::size_t n_blocks, const Eigen::Ref<const Eigen::MatrixXd>& whitened,
                          Eigen::Ref<Eigen::MatrixXd> few) const {
  const Eigen::Index at = blocks_[first_block].first, to = condensed_[first_block].first;
  for (std::size_t b = first_block; b < first_block + n_blocks; ++b) {
    const Condensed& c = condensed_[b];
    gather(whitened.middleRows(blocks_[b].first - at, blocks_[b].n), c.together, few.middleRows(c.first - to, c.n));
  }
}

Eigen::MatrixXd Comparison::condensed(const Eigen::Ref<const Eigen::MatrixXd>& whitened) const {
  Eigen::MatrixXd few(n_condensed(), whitened.cols());
  if (!blocks_.empty()) condense(0, blocks_.size(), whitened, few);
  return few;
}

Eigen::VectorXd Comparison::condensed(std::size_t run, const Eigen::Ref<const Eigen::VectorXd>& whitened) const {
  Eigen::MatrixXd few(condensed_rows(run).second, 1);
  if (runs_[run].n_blocks > 0) condense(runs_[run].first_block, runs_[run].n_blocks, whitened, few);
  return few;
}

std::pair<Eigen::Index, Eigen::Index> Comparison::condensed_rows(std::size_t run) const {
  const Run& of = runs_[run];
  if (of.n_blocks == 0) return {0, 0};
  const Condensed& last = condensed_[of.first_block + of.n_blocks - 1];
  const Eigen::Index first = condensed_[of.first_block].first;
  return {first, last.first + last.n - first};
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
      std::vector<NoiseSeries>& of_channel = series[c.name];
      if (n_readings >= kFewestForNoise)
        of_channel.push_back(
            {runs[r].time_s, c.value - prediction[r].row(c.output).transpose(), telling(curves, n_readings)});
      const double floor = c.unit == "K" ? least.white_K : c.unit == "m" ? least.white_m : least.white_rad;
      floors[c.name] = std::max({floors[c.name], floor, c.quantum / std::sqrt(12.0)});
      slow[c.name] = c.unit == "K" ? least.slow_K : c.unit == "m" ? least.slow_m : least.slow_rad;
    }
  }
  std::map<std::string, NoiseModel> noise;
  for (const auto& [name, list] : series) {
    NoiseModel& n = noise[name] = list.empty() ? NoiseModel{.white = floors[name]} : estimate_noise(list, floors[name]);
    if (n.correlated < slow[name]) n = {n.white, slow[name], kSlow_s};
  }
  return noise;
}

}  // namespace driftwright::diagnosis
