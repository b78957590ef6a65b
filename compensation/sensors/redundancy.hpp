#pragma once
// Analytical redundancy: each thermometer is predicted by the others and by the drive. One that departs from its prediction
// is broken, has come off, or measures something else.

#include <span>
#include <string>
#include <vector>

#include "base/record.hpp"

namespace driftwright::compensation {

/// A linear relation of a channel to others.
struct Relation {
  double intercept = 0.0;
  std::vector<double> coefficient;  ///< of the others

  /// The channel as the others predict it, per row; NaN where one of them is missing.
  [[nodiscard]] std::vector<double> predict(const Record& record, const std::vector<std::string>& others) const;
};

/// Ridge regression over all rows, because the common part of similar thermometers also holds in another ambient, and their
/// small differences do not.
/// @throws InputError  as product_sums()
[[nodiscard]] Relation relation(std::span<const Record> records, const std::string& input,
                                const std::vector<std::string>& others);

/// A thermometer departs from its prediction if the difference exceeds this multiple of its usual size, ...
inline constexpr double kDeparts = 6.0;
/// ... for this long [s]. Shorter ones are chips, coolant or a disturbed reading.
inline constexpr double kDepartsFor_s = 600.0;

/// A thermometer that departs from what the others say of it.
struct DoubtedThermometer {
  std::string name, record;
  double from_s = 0.0;  ///< time in that record at which it begins
  /// Largest difference that lasts kDepartsFor_s; reduced where the relations scatter by more than usual_K.
  double off_K = 0.0;
  double usual_K = 0.0;  ///< standard deviation of the difference
  /// No other thermometer departs in that record. If several do, they have one cause: a state of the machine that the
  /// relations do not describe, or a plug or an amplifier that they share.
  bool is_alone = true;
};

/// The thermometers that depart in some records, the worst first. Relations are fitted to each record alone (eighth of a
/// single record), and a row of another record is predicted by the median of all of these: records in which the thermometer,
/// or another one, is broken are outvoted as long as they are fewer than half. The usual difference is the median over all
/// rows times 1.4826, at least `reading_K`, and in a row the scatter of the predictions by the relations if that is larger:
/// so a row far from all records counts less. The worst is taken out, and the rest is judged again without it.
///
/// If more than a third of the thermometers depart, nothing distinguishes them from the rest, and none is returned. None is
/// either of two or three records, whose relations cannot outvote each other, and none that has no row in common with the
/// others. A thermometer that is wrong in all records is not noticed.
/// @param thermometers  channels of one unit
/// @param beside        channels that help to predict them and are not judged: drive, ambient
/// @param reading_K     standard deviation of a thermometer
/// Source: fault detection by residuals of a redundant set: Isermann, Fault-Diagnosis Systems (2006), ch. 10; median and its
/// robust scale: Rousseeuw & Croux, J. Am. Stat. Assoc. 88 (1993) 1273.
[[nodiscard]] std::vector<DoubtedThermometer> doubted_thermometers(std::span<const Record> records,
                                                                   std::vector<std::string> thermometers,
                                                                   const std::vector<std::string>& beside, double reading_K);

}  // namespace driftwright::compensation
