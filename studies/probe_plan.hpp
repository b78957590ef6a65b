#pragma once
// The fewest probings of an axis that keep what its correction leaves within a tolerance during a job, and the places of the
// job where they are.
//
// What a correction leaves is an Ornstein-Uhlenbeck process (compensation/predictors/residual_process.hpp) with deviation s
// and time constant T. Without a probing its variance grows as
//
//     v(t + h) = s² + (v(t) - s²) exp(-2 h / T),
//
// and a probing with noise r changes it to f(v) = v r² / (v + r²), as the Kalman filter of `follow` does. So the half width
// of the 95 % interval, factor √v, only grows between two probings. The time of a probing counts as lost, and not as growth.
//
// Fewest probings: each one at the latest place that is reached within the tolerance, which is the place of the probing
// before it if no later one is (noise is then averaged). No plan has fewer. Proof by induction over the number k of
// probings: the k-th probing of this plan is at least as late as that of any other plan, and after it the variance is at
// most that of the other plan with k probings. The step: let v be the other plan's variance at its place and v' = a² v + (1
// - a²) s² >= v at this plan's later one. With f(v) = v - g(v), g(v) = v² / (v + r²),
//
//     f(v') - a² f(v) = (1 - a²) s² - [g(v') - a² g(v)] <= (1 - a²) s²,
//
// because g grows with v and a² <= 1. So the later probing leaves at most what the earlier one leaves, aged.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compensation/frames/axis_programs.hpp"
#include "compensation/predictors/deployed_predictor.hpp"
#include "studies/probe_points.hpp"

namespace driftwright::studies {

/// A place of a job where the axis may be probed.
struct ProbePlace {
  double time_s = 0.0;     ///< in the job without probings
  std::string where = {};  ///< "tool change", "M0", "before part 3"
  int part = 1;            ///< from one
  int line = 0;            ///< of the NC program, from one: the probing comes before it; 0: none
};

/// Work during which the tolerance must be kept.
struct WorkStretch {
  double from_s = 0.0, until_s = 0.0;
};

/// What probings are planned for.
struct ProbeJob {
  std::string name = {};
  std::vector<WorkStretch> work = {};   ///< rising, apart, at least one; the first begins at 0 or later
  std::vector<ProbePlace> places = {};  ///< rising times, before the end of the work
};

/// What is unknown of the axis, and the probe.
struct ProbedAxis {
  compensation::ResidualProcess process = {};
  compensation::Probe probe = {};
  bool is_known_at_start = false;  ///< the drift counts from the start of the job, so the residual is 0 there
  double factor = 1.96;            ///< half width of the 95 % interval over the standard deviation
  double probing_s = 120.0;        ///< time that a probing takes; it is at least the probe's lag
};

/// The axis of a predictor's file. The factor is that of `follow`: interval over deviation of the process, at least 1.96.
/// @param probe  of the machine @throws std::logic_error  for a predictor without a process
[[nodiscard]] ProbedAxis probed_axis(const compensation::DeployedPredictor& predictor, const compensation::Probe& probe,
                                     double probing_s);

/// Variance [um²] after a time without probing, by the formula above.
[[nodiscard]] double grown_um2(const compensation::ResidualProcess& process, double um2, double time_s);

/// A probing in a plan.
struct PlannedProbing {
  std::size_t place = 0;   ///< index into ProbeJob::places
  double before_um = 0.0;  ///< half width of the 95 % interval at the end of the work before it; without work, at the place
  double after_um = 0.0;   ///< half width when the work goes on
  double lost_s = 0.0;     ///< time of the probing beyond the rest before its place, which may begin with the job
};

/// Half width of the interval at a time of the job.
struct WidthAt {
  double time_s = 0.0, um = 0.0;
};

/// Probings of one place at most: their mean has 0.22 of the noise of one. Beyond it errors that all of them share (the
/// ball, the ring) are larger.
inline constexpr int kMostAtAPlace = 20;

/// Some probings, judged.
struct ProbeSequence {
  std::vector<PlannedProbing> probings = {};
  double worst_um = 0.0;  ///< largest half width of the 95 % interval during work
  double worst_s = 0.0;   ///< the time of the job at which it is reached
  double rms_um = 0.0;    ///< expected root mean square of what is left, over the time of work
  double lost_s = 0.0;
};

/// @param places  indices into the job's places, none less than the one before it
[[nodiscard]] ProbeSequence judged_probings(const ProbeJob& job, const ProbedAxis& axis,
                                            std::span<const std::size_t> places);

/// The fewest probings with which the half width stays within a tolerance: each at the latest place. A place has at most
/// kMostAtAPlace of them. Before the first work nothing has to be kept.
/// @return none where these are not enough
[[nodiscard]] std::optional<ProbeSequence> fewest_probings(const ProbeJob& job, const ProbedAxis& axis, double tolerance_um);

/// Of all plans with at most n probings the one with the smallest largest half width, by bisection of the tolerance of
/// fewest_probings() to 1e-6 of itself.
[[nodiscard]] ProbeSequence best_probings(const ProbeJob& job, const ProbedAxis& axis, std::size_t n);

/// n probings at equal intervals, each at the nearest of the places with the fewest of them. The first interval begins with
/// the job; for an axis that is not known at the start the first probing is there.
/// @param n  0 for a job without places
[[nodiscard]] ProbeSequence equal_probings(const ProbeJob& job, const ProbedAxis& axis, std::size_t n);

/// The half width over time, with two values at a probing, for plots.
[[nodiscard]] std::vector<WidthAt> widths_of(const ProbeJob& job, const ProbedAxis& axis, const ProbeSequence& sequence);

/// One number of probings.
struct ProbeCurveRow {
  std::size_t n = 0;
  ProbeSequence best;  ///< with at most n: fewer where more would not help
  ProbeSequence equal;
};

struct ProbePlan {
  ProbeJob job;
  ProbedAxis axis;
  std::string predictor = {}, target = {};  ///< of the file
  double tolerance_um = 0.0;                ///< of the job
  double kept_free = 0.0;                   ///< share of it for all that is not thermal
  /// The fewest that keep the tolerance, and of those the ones that leave the smallest largest interval; none: no number of
  /// probings is enough.
  std::optional<ProbeSequence> best = {};
  /// Without `best`: the fewest that leave at most 1.01 times the least half width that any number of probings leaves.
  std::optional<ProbeSequence> nearest = {};
  /// For 0, 1, 2 ... probings, as far as more help, and without `best` up to `nearest`; every so many for more than 40.
  std::vector<ProbeCurveRow> curve = {};
  std::optional<compensation::AxisProgram> touch = {};  ///< the touch cycle that was written for controls
  std::optional<PointChoice> points = {};               ///< what to probe, where records with errors of points were given

  [[nodiscard]] double allowed_um() const { return tolerance_um * (1.0 - kept_free); }
  /// `best`, or `nearest` without it.
  [[nodiscard]] const ProbeSequence& shown() const { return best ? *best : nearest.value(); }
  /// Probings at equal intervals, as many as in `best`; null without it.
  [[nodiscard]] const ProbeSequence* equal() const;
};

/// How far a touch may be from the offset in force, for a program that holds the last probing.
struct TouchBounds {
  double first_um = 0.0;  ///< where none is in force
  double step_um = 0.0;   ///< later
};

/// PROBE_REFUSED deviations, as `follow` has it. Deviation s of the process (widened as the plan's interval is), noise r:
/// the first touch is sqrt(s² + r²) from 0. Two touches h apart differ by sqrt(2 r² + 2 s² (1 - exp(-h / T))); h is the
/// longest time of the plan from one probing to the next or to the end of the work, with the time of a probing.
[[nodiscard]] TouchBounds touch_bounds(const ProbePlan& plan);

/// @param tolerance_um  > 0 @param kept_free  0 to below 1
[[nodiscard]] ProbePlan plan_probings(ProbeJob job, const ProbedAxis& axis, double tolerance_um, double kept_free);

}  // namespace driftwright::studies
