#include "diagnosis/interval.hpp"

#include <algorithm>
#include <cmath>

#include "base/normal.hpp"
#include "base/parallel.hpp"
#include "diagnosis/no_solution.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kRise = 1.92;       // of Φ: half the 95 % quantile of χ² with one degree of freedom
constexpr double kNearBound = 0.15;  // accepted distance of the rise of Φ from kRise
constexpr int kMostTries = 7;        // on each side
constexpr int kMostRows = 15;
constexpr double kHopelessStep = 8.0;  // of Φ

}  // namespace

Interval profile_interval(const Fitter& fitter, const Hypothesis& hypothesis, const Fit& best, std::size_t claim,
                          std::size_t which) {
  Eigen::Index at = fitter.n_nuisance() + static_cast<Eigen::Index>(which);
  for (std::size_t c = 0; c < claim; ++c) at += static_cast<Eigen::Index>(hypothesis[c].knobs.size());
  const Knob& knob = hypothesis[claim].knobs[which];
  const double middle = best.x[at];
  const double low = knob.scale == Knob::Scale::kLinear ? knob.low - knob.nominal : -1e300,
               high = knob.scale == Knob::Scale::kLinear ? knob.high - knob.nominal : 1e300;
  const bool is_jump = knob.is_jump();
  const double row_s = std::min(60.0, shortest_row_s(fitter.runs()));
  const double variance = best.covariance(at, at);
  const double sd = is_jump ? row_s : std::sqrt(std::max(0.0, variance));
  if (!(sd > 0.0)) return {middle, middle};

  // The rise of Φ at a distance; the other numbers start where the best fit's covariance predicts them.
  const auto rise = [&](double distance, Twin::Workspace& workspace) {
    Eigen::VectorXd start = best.x;
    if (is_jump || !(variance > 0.0)) {
      start[at] = middle + distance;
    } else {
      start += best.covariance.col(at) * (distance / variance);
    }
    double misfit = 1e300;  // no solution at this distance
    (void)has_solution([&] { misfit = fitter.fit_others(hypothesis, start, at, workspace).misfit - best.misfit; });
    return misfit;
  };
  const auto room = [&](double sign) { return std::max(0.0, sign > 0.0 ? high - middle : middle - low); };
  // A jump between two rows may be anywhere between them; beyond a worse row there may be a better one.
  const auto last_row = [&](double sign, Twin::Workspace& workspace) {
    double last = 0.0;
    for (int i = 1; i <= kMostRows && i * row_s < room(sign); ++i) {
      const double r = rise(sign * i * row_s, workspace);
      if (r < kRise) last = i * row_s;
      if (r > kHopelessStep) break;
    }
    return middle + sign * std::min(room(sign), last + row_s);
  };
  const auto end = [&](double sign, Twin::Workspace& workspace) {
    double inside = 0.0, rise_inside = 0.0, outside = 0.0, rise_outside = 0.0;
    double distance = std::min(room(sign), kNormal95 * sd);
    if (!(distance > 0.0)) return middle;
    for (int i = 0; i < kMostTries; ++i) {
      const double r = rise(sign * distance, workspace);
      if (std::abs(r - kRise) < kNearBound) return middle + sign * distance;
      if (r < kRise) {
        inside = distance, rise_inside = std::max(0.0, r);
        if (inside >= room(sign)) return middle + sign * inside;
      } else {
        outside = distance, rise_outside = r;
      }
      if (outside > 0.0) {  // Φ is about a parabola: root between the two
        const double share = rise_outside < 1e200 ? (std::sqrt(kRise) - std::sqrt(rise_inside)) /
                                                        (std::sqrt(rise_outside) - std::sqrt(rise_inside))
                                                  : 0.5;
        distance = inside + std::clamp(share, 0.1, 0.9) * (outside - inside);
      } else {
        distance = std::min(room(sign), std::clamp(std::sqrt(kRise / std::max(1e-3, rise_inside)), 1.2, 3.0) * inside);
      }
    }
    // The threshold was never crossed: the data allow the knob's whole range.
    return middle + sign * (outside > 0.0 ? 0.5 * (inside + outside) : std::min(room(sign), 8.0 * knob.prior_sd));
  };
  double ends[2] = {};
  for_each_index(
      2, [&] { return Twin::Workspace(fitter.twin()); },
      [&](std::size_t i, Twin::Workspace& workspace) {
        const double sign = i == 0 ? -1.0 : 1.0;
        ends[i] = is_jump ? last_row(sign, workspace) : end(sign, workspace);
      });
  return {ends[0], ends[1]};
}

}  // namespace driftwright::diagnosis
