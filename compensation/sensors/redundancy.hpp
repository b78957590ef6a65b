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

/// A thermometer departs from its prediction if the difference exceeds this multiple of its usual size on records left
/// out, ...
inline constexpr double kDeparts = 6.0;
/// ... for this long [s]. Shorter ones are chips, coolant or a disturbed reading.
inline constexpr double kDepartsFor_s = 600.0;

/// A thermometer that departs from what the others say of it.
struct DoubtedThermometer {
  std::string name, record;
  double from_s = 0.0;   ///< time in that record at which it begins
  double off_K = 0.0;    ///< largest difference that lasts kDepartsFor_s
  double usual_K = 0.0;  ///< standard deviation of the difference on records left out
};

/// The thermometers that depart in some records, the worst first. Each record in turn (eighth of a single record) is predicted
/// by a relation that is fitted to the others; the usual difference is the median of all of these times 1.4826, which half of
/// the rows cannot move, and at least `reading_K`. The worst is taken out, and the rest is judged again without it.
///
/// At most a third of the thermometers can be told apart from the rest. If more depart, the machine was in a state that the
/// relations do not hold in, and none is doubted. A thermometer that is wrong from the first row of the records to the last
/// is not noticed, and one that is wrong in half of the rows may not be.
/// None is doubted either if no row has all readings.
/// @param thermometers  channels of one unit
/// @param beside        channels that help to predict them and are not judged: drive, ambient
/// @param reading_K     standard deviation of a thermometer
/// Source: fault detection by residuals of a redundant set: Isermann, Fault-Diagnosis Systems (2006), ch. 10; the robust scale:
/// Rousseeuw & Croux, J. Am. Stat. Assoc. 88 (1993) 1273.
[[nodiscard]] std::vector<DoubtedThermometer> doubted_thermometers(std::span<const Record> records,
                                                                   std::vector<std::string> thermometers,
                                                                   const std::vector<std::string>& beside, double reading_K);

}  // namespace driftwright::compensation
