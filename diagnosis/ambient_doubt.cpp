#include "diagnosis/ambient_doubt.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/parallel.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr int kStretches = 12;
constexpr double kNoMatter_K = 2e-3;  // smaller effects are ignored; equal to the floor of readings

/// The ambient plus a triangular hat: zero at `before_s` and `after_s`, linear between.
TimeSeries with_hat(const TimeSeries& ambient, double before_s, double at_s, double after_s, double height_K) {
  std::set<double> times(ambient.time_s.begin(), ambient.time_s.end());
  times.insert({before_s, at_s, after_s});
  TimeSeries other;
  for (double t_s : times) {
    const double up = t_s < at_s ? (t_s - before_s) / (at_s - before_s) : (after_s - t_s) / (after_s - at_s);
    other.time_s.push_back(t_s);
    other.value.push_back(ambient.at(t_s) + height_K * std::max(0.0, up));
  }
  return other;
}

}  // namespace

std::vector<Prediction> ambient_columns(const Twin& twin, const std::vector<MeasuredRun>& runs) {
  struct Doubt {
    std::size_t run = 0;
    TimeSeries ambient;
  };
  std::vector<Doubt> doubts;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const MeasuredRun& run = runs[r];
    if (!run.has_ambient) continue;
    const double last_s = run.time_s.back(), stretch_s = last_s / (kStretches - 1);
    const double steps_K = run.ambient_quantum_K / std::sqrt(12.0);
    const double n_rows = std::max(1.0, static_cast<double>(run.time_s.size()) / kStretches);
    const double slow_K = std::hypot(steps_K, run.ambient_noise_K / std::sqrt(n_rows));
    for (int k = 0; slow_K > kNoMatter_K && k < kStretches; ++k)
      doubts.push_back({r, with_hat(run.ambient, (k - 1) * stretch_s, k * stretch_s, (k + 1) * stretch_s, slow_K)});
    const double first_K = std::hypot(steps_K, run.ambient_noise_K), row_s = run.time_s[1];
    if (first_K > kNoMatter_K) doubts.push_back({r, with_hat(run.ambient, -row_s, 0.0, row_s, first_K)});
  }
  std::vector<Prediction> columns(doubts.size());
  Prediction base;
  {
    Twin::Workspace workspace(twin);
    for (const MeasuredRun& run : runs) base.push_back(twin.readings(twin.as_written(), run, workspace));
  }
  for_each_index(
      doubts.size(), [&] { return Twin::Workspace(twin); },
      [&](std::size_t i, Twin::Workspace& workspace) {
        for (const Eigen::MatrixXd& b : base) columns[i].push_back(Eigen::MatrixXd::Zero(b.rows(), b.cols()));
        MeasuredRun other = runs[doubts[i].run];
        other.ambient = doubts[i].ambient;
        columns[i][doubts[i].run] = twin.readings(twin.as_written(), other, workspace) - base[doubts[i].run];
      });
  return columns;
}

}  // namespace driftwright::diagnosis
