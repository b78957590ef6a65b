#pragma once
// The times at which a system's run is cut: changes of drive, knots of the ambient temperature, and times at which laws
// jump.

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "base/cyclogram.hpp"
#include "solver/thermal_system.hpp"

namespace driftwright::solver {

/// The knots of the ambient and the change times of the laws.
template <class Matrix>
[[nodiscard]] std::vector<double> knots_of(const ThermalSystem<Matrix>& system, const TimeSeries& ambient) {
  std::vector<double> knots_s;  // merged from two sorted lists
  knots_s.reserve(ambient.time_s.size() + system.change_times_s.size());
  std::merge(ambient.time_s.begin(), ambient.time_s.end(), system.change_times_s.begin(), system.change_times_s.end(),
             std::back_inserter(knots_s));
  return knots_s;
}

/// Stretches of constant drive and linear ambient in which no law jumps.
template <class Matrix>
[[nodiscard]] std::vector<LinearStretch> stretches_of(const ThermalSystem<Matrix>& system, const Cyclogram& cyclogram,
                                                      const TimeSeries& ambient) {
  return linear_stretches(cyclogram, knots_of(system, ambient));
}

/// @throws std::logic_error  for an output after the last stretch: no drive is known there
inline void require_within(const std::vector<LinearStretch>& stretches, const std::vector<double>& output_s) {
  if (!output_s.empty() && (stretches.empty() || output_s.back() > stretches.back().end_s))
    throw std::logic_error("an output after the end of the cyclogram");
}

/// Call at() for each stretch of a run in order: true if a law that does not depend on the state may differ from the stretch
/// before.
class LawChanges {
 public:
  /// @param change_times_s  of the system, sorted; borrowed
  explicit LawChanges(const std::vector<double>& change_times_s) : times_s_(change_times_s) {}
  [[nodiscard]] bool at(const LinearStretch& stretch) {
    bool changed = is_first_ || stretch.drive_changed;
    is_first_ = false;
    for (; next_ < times_s_.size() && times_s_[next_] <= 0.5 * (stretch.start_s + stretch.end_s); ++next_) changed = true;
    return changed;
  }

 private:
  const std::vector<double>& times_s_;
  std::size_t next_ = 0;
  bool is_first_ = true;
};

}  // namespace driftwright::solver
