#pragma once
// What is missing over time, row by row: the heat in each body that would make what a prediction leaves of the readings, as heat or as a
// conductance to another temperature; and the growth that each displacement has beside it. And what these look like.

#include "diagnosis/fit.hpp"
#include "diagnosis/waveform_shape.hpp"

namespace driftwright::diagnosis {

struct Waveform {
  enum class Of { kHeat, kGrowth };
  Of of = Of::kHeat;
  std::string run = {};
  std::string unit = "W";           ///< of the value: "W", "m", "rad"
  std::string where = {};           ///< body that the heat is missing in, or displacement
  std::vector<double> time_s = {};  ///< of the run's rows, or every so many of them
  std::vector<double>
      value = {},
      sd = {};  ///< heat [W] from each row to the next, the last one repeated; or growth [m, rad], sd its noise
  /// Other end of a conductance, a body or the ambient, where that describes the readings better than a heat by itself; else empty, and so is the
  /// conductance.
  std::string to = {};
  std::vector<double> conductance_W_K = {};  ///< per row
  WaveShape shape = {};  ///< its size in W or W/K (over the unit of what it follows); of a growth in m or rad
  double explained =
      0.0;  ///< share of all readings' squared misses, in units of noise, that the heat takes away; of a growth: that of its shape
  double log_likelihood_gain = 0.0;  ///< over no heat at all [nats]
};

/// The heat that is missing in each body in turn, that which explains most first; then the growths. Noise is what readings scatter from row to row,
/// and at least the channel's step.
/// @param state       what the prediction is of; the machine is linear about it
/// @param prediction  readings of all runs
/// @param listener    once it wants an end, nothing comes of it
/// @throws SolveError  where the state has no solution
[[nodiscard]] std::vector<Waveform> waveforms(const Twin& twin, const std::vector<MeasuredRun>& runs, const TwinState& state,
                                              const Prediction& prediction, const Listener& listener = {});

/// What a record has beside readings, and its readings: one value a row, to the next one where it drives. @param n_rows  the first ones alone
[[nodiscard]] std::vector<NamedCourse> recorded_courses(const MeasuredRun& run);

}  // namespace driftwright::diagnosis
