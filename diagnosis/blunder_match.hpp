#pragma once
// How well the readings of a channel agree with a course of the simulation, by a measure that allows for a scenario that is
// wrong: the evidence by which a blunder (blunders.hpp) is told from a fault of the machine.
//
// The readings are y = a (g m + o) + b + e, with the simulated course m. The blunder says a and b: 1 and 0 without one, 1.8
// and so on for degF under degC, -1 for a sign. Gain g and offset o are what a fault of the machine may do to a course:
// ln g is normal with the standard deviation of an unknown factor (effects::kFactorSd), o with a third of 25 K, by which
// no thermometer is ever off (kFarBeside_K); the zero of a displacement is arbitrary. The rest e has an unknown size, and
// counts as n/tau independent readings, tau being the number of rows that carry as much as one (base/rows_as_one.hpp):
//
//     nats = -n/(2 tau) ln(mean e² + floor²) - (ln g)² / (2 s_g²) - o² / (2 s_o²)
//
// at the most probable g and o. Everything is in the space of the readings, so nats of two blunders can be compared.

#include <Eigen/Core>

namespace driftwright::diagnosis {

/// A scenario's numbers are known to 10 to 30 % (effects/, `known_to`), and so are the courses that it simulates: a course
/// is met if its gain and its rest are within twice, or once, this share.
inline constexpr double kOwnScatter = 0.3;

/// Readings of a channel and the course that they are compared with, without rows that miss a reading.
struct ReadBeside {
  Eigen::ArrayXd read, model;
  bool is_temperature = true;  ///< else its zero is arbitrary
};

/// What is read where the model is m: scale m + shift, in the unit of the readings.
struct Showing {
  double scale = 1.0, shift = 0.0;
};

struct Match {
  double nats = 0.0;       ///< up to a constant of the readings
  double gain_nats = 0.0;  ///< the price of its gain, which `nats` contains
  double gain = 1.0;       ///< g
  double offset = 0.0;     ///< o, in the unit of the readings; 0 for displacements
  double rest = 0.0;       ///< root mean square of e
  /// The largest of gain, offset and rest, each over what the scenario's own scatter explains.
  double beyond_scatter = 0.0;
  [[nodiscard]] bool is_met() const { return beyond_scatter <= 1.0; }
};

/// Standard deviation of white noise of readings, by second differences; at least a thousandth of their course.
[[nodiscard]] double reading_noise(const Eigen::ArrayXd& read);

/// Number of independent readings in what gain and offset, chosen freely, leave. At least 1.
[[nodiscard]] double independent_readings(const ReadBeside& r);

/// The most probable gain and offset. @param n_independent  at least 1
/// @param priced_gain  false: any gain costs nothing
[[nodiscard]] Match match(const ReadBeside& r, const Showing& shown, double n_independent, bool priced_gain = true);

/// Match::beyond_scatter, with the rest judged by a course of at least this size: of a channel that hardly moves, beside one
/// that does. @param read  the readings that were matched
[[nodiscard]] double beyond_scatter(const Match& m, const Eigen::ArrayXd& read, double least_course = 0.0);

/// Standard deviation of readings about their mean.
[[nodiscard]] double course_of(const Eigen::ArrayXd& read);

/// Evidence that readings follow nothing that the scenario simulates, as of an instrument that has come off or is not
/// connected. A thermometer then reads the air or another part, which is off by the offset o, like one in its place.
[[nodiscard]] double nats_of_unrelated(const ReadBeside& r, double n_independent);

}  // namespace driftwright::diagnosis
