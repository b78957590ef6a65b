#pragma once
// The record: time series with named channels that carry units. The simulator makes it, and a measured CSV is read into it.
// Code that uses a record does not know which of the two it was. A record is an outer format of the program: its values are
// in the unit that their channel names (degC, um, rpm), not in SI.

#include <span>
#include <string>
#include <vector>

#include "driftwright/api.hpp"

namespace driftwright {

/// One time series. A missing value is NaN.
struct Channel {
  std::string name;  ///< without the unit, such as "drift_y"
  std::string unit;  ///< one of known_units(), such as "um"
  std::vector<double> values;

  /// Name as a CSV header writes it: "<name>_<unit>".
  [[nodiscard]] std::string header() const { return name + "_" + unit; }
};

/// Rows of samples. All channels are as long as time_s, and time_s strictly increases.
struct DRIFTWRIGHT_API Record {
  std::string source;  ///< the file, or the cyclogram it was simulated on; for messages and legends
  std::vector<double> time_s;
  std::vector<Channel> channels;

  [[nodiscard]] std::size_t n_samples() const { return time_s.size(); }
  /// The channel of that name (with or without its unit), or nullptr.
  [[nodiscard]] const Channel* find(const std::string& name) const;
  /// The channel of that name. @throws InputError  if it does not exist; the message lists the existing channels
  [[nodiscard]] const Channel& at(const std::string& name) const;
  /// Names of the channels with that unit, in their order.
  [[nodiscard]] std::vector<std::string> names_with_unit(const std::string& unit) const;
};

/// Units that a record's header may name, longest first.
[[nodiscard]] DRIFTWRIGHT_API std::span<const std::string> known_units();

/// Reads a record CSV (format: docs/reference/record.md).
/// @throws InputError  file, line and column, for a missing file, fewer than two rows, a header without unit, a cell
///                     that is no number, NaN or infinity written out, time that does not increase, ragged rows
[[nodiscard]] DRIFTWRIGHT_API Record read_record_csv(const std::string& path);

/// The text of a record CSV. `comments` become '#' lines before the header. Values carry 7 significant digits.
[[nodiscard]] DRIFTWRIGHT_API std::string record_csv(const Record& record, const std::vector<std::string>& comments = {});

}  // namespace driftwright
