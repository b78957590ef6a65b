#include "effects/drive_change.hpp"

#include <algorithm>
#include <cmath>

namespace driftwright::effects {
namespace {

constexpr double kRounding = 1e-9;  // of the time: a stop at the end of a section cuts nothing off
constexpr double kStep_s = 1e-3;    // that a jump of the hall takes

bool happens(const std::string& in, const Cyclogram& cyclogram) {
  return in.empty() || in == cyclogram.name;
}

/// Adds offset + ramp (t - from) from a time on.
TimeSeries with_error(const TimeSeries& hall, const DriveChange::HallError& error, double end_s) {
  std::vector<double> knots = hall.time_s;
  knots.push_back(end_s);  // where a ramp ends and the hall's own knots may have ended before
  const bool steps = error.from_s > 0.0;
  const double reached_s = steps ? error.from_s + kStep_s : 0.0;
  if (steps) knots.push_back(error.from_s);
  knots.push_back(reached_s);
  std::sort(knots.begin(), knots.end());
  knots.erase(std::unique(knots.begin(), knots.end()), knots.end());
  TimeSeries changed;
  for (double t_s : knots) {
    double error_K = 0.0;
    if (t_s >= reached_s) {
      error_K = error.offset_K + error.ramp_K_s * (t_s - error.from_s);
    } else if (t_s > error.from_s) {  // a knot of the hall within the step
      error_K = (error.offset_K + error.ramp_K_s * kStep_s) * (t_s - error.from_s) / kStep_s;
    }
    changed.time_s.push_back(t_s);
    changed.value.push_back(hall.at(t_s) + error_K);
  }
  return changed;
}

/// A cut on a grid of four times the rounding of the section's end: so durations of its pieces add up to that end to the last bit,
/// and both cyclograms end at the same time.
double on_grid_s(double cut_s, double end_s) {
  const double grid_s = 4.0 * (std::nextafter(end_s, 2.0 * end_s) - end_s);
  return grid_s * std::round(cut_s / grid_s);
}

}  // namespace

Cyclogram true_cyclogram(const DriveChange& change, const Cyclogram& recorded) {
  std::vector<DriveChange::Stop> stops;
  for (const DriveChange::Stop& stop : change.stops) {
    if (happens(stop.in, recorded)) stops.push_back(stop);
  }
  Cyclogram felt = recorded;
  felt.sections.clear();
  double start_s = 0.0;
  for (const Cyclogram::Section& section : recorded.sections) {
    const double end_s = start_s + section.duration_s, rounding_s = kRounding * end_s;
    std::vector<double> cuts = {start_s};
    for (const DriveChange::Stop& stop : stops) {
      for (double cut_s : {stop.start_s, stop.start_s + stop.length_s}) {
        if (cut_s > start_s + rounding_s && cut_s < end_s - rounding_s) cuts.push_back(on_grid_s(cut_s, end_s));
      }
    }
    std::sort(cuts.begin(), cuts.end());
    cuts.push_back(end_s);
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      const double middle_s = 0.5 * (cuts[i] + cuts[i + 1]);
      const bool stands = std::any_of(stops.begin(), stops.end(), [&](const DriveChange::Stop& stop) {
        return middle_s >= stop.start_s && middle_s < stop.start_s + stop.length_s;
      });
      Cyclogram::Section piece = section;
      if (cuts.size() > 2) piece.duration_s = cuts[i + 1] - cuts[i];
      piece.drive.speed_rpm = stands ? 0.0 : change.speed_factor * section.drive.speed_rpm;
      if (piece.duration_s > 0.0) felt.sections.push_back(piece);
    }
    start_s = end_s;
  }
  return felt;
}

TimeSeries true_hall(const DriveChange& change, const TimeSeries& hall, const Cyclogram& cyclogram) {
  TimeSeries felt = hall;
  for (const DriveChange::HallError& error : change.hall) {
    if (happens(error.in, cyclogram)) felt = with_error(felt, error, cyclogram.duration_s());
  }
  return felt;
}

}  // namespace driftwright::effects
