#pragma once
// Chooses the network with the best predictions: the laws of its heat, the number of bodies, the smoothness, judged on
// kept-out rows.

#include <cmath>

#include "base/listener.hpp"
#include "base/mean_error.hpp"
#include "identification/foster_network.hpp"
#include "identification/ledger.hpp"

namespace driftwright::identification {

/// Errors on kept-out rows of one kind, for all channels.
struct KeptOutKind {
  std::string kind;         ///< same as compensation::Fold::kind
  std::vector<double> rms;  ///< per channel; geometric mean over the folds of the kind; NaN without a judged row
};

/// Geometric mean of errors over the folds of a kind; NaN without a judged row. @param rms  one per fold
[[nodiscard]] double missed(const Eigen::VectorXd& rms, std::span<const HiddenRows> folds, const std::string& kind);
/// The same over the kinds.
[[nodiscard]] double missed(const Eigen::VectorXd& rms, std::span<const HiddenRows> folds);

/// A body of the chosen network.
struct IdentifiedBody {
  NetworkBody body;
  std::string name;   ///< law and time constant: "speed_25min", "ambient_4h"
  double gain = 0.0;  ///< relative increase of the error on kept-out rows without it: 0.1 means a tenth
};

/// A channel with its fit and errors.
struct IdentifiedChannel {
  std::string name, unit;  ///< degC, K (a rise above the reference) or um
  ChannelFit fit;
  double swing = 0.0;       ///< standard deviation of the readings
  double missed_own = 0.0;  ///< root mean square over the fitted rows
  /// The same rows as the written scenario simulates them, in balance at the start of each record.
  double missed_simulated = 0.0;
  double missed_kept_out = 0.0;  ///< geometric mean over kinds of kept-out rows
  MeanError square_kept_out;     ///< mean over the folds of the mean square error of their kept-out rows
  Eigen::VectorXd predicted;     ///< all rows, with the terms of single records
  Eigen::VectorXd misses;        ///< residuals of all rows; NaN without a reading
  std::vector<Driver> ledger;    ///< the driver with the largest share first
  // If a scenario is extended:
  bool is_extended = false;                   ///< false: the scenario is unchanged for this channel
  double scenario_simulated = 0.0;            ///< error of the unchanged scenario on the same rows, as missed_simulated
  double scenario_kept_out = 0.0;             ///< the same on kept-out rows, as missed_kept_out
  double regression_kept_out = std::nan("");  ///< error of a plain regression on the kept-out rows, fitted without them
  double noise = std::nan("");                ///< of the readings
  std::vector<Driver> missing;                ///< ledger_of_missing()
  MeanError missed_more_without;  ///< logarithm of the ratio of errors, unchanged over extended scenario, on kept-out folds
};

/// The identified network.
struct Identified {
  RecordRoles roles;
  Structure structure;
  double reference_degC = 20.0;
  std::vector<IdentifiedBody> bodies;       ///< in the order of bodies_of()
  std::vector<IdentifiedChannel> channels;  ///< thermometers, then displacements
  std::vector<KeptOutKind> kinds;
  std::vector<HiddenRows> folds;    ///< over stored rows
  std::vector<std::size_t> blocks;  ///< for each record, this many rows are averaged into one in stored rows
  bool is_extension = false;        ///< it extends a scenario; the bodies are those that the scenario lacks
};

/// Laws that are tried. For the speed: on while it turns, a power of it, or both; the power is 5/3 (viscous friction of
/// bearings) unless kept-out rows support another one. For other drives: in proportion. Time constants are spaced evenly in
/// their logarithm, from three rows or 0.3 % of the longest record to a third of that record. The result is the network with
/// the fewest bodies whose error on kept-out rows is within a standard error of the smallest; then bodies without benefit
/// for kept-out rows are removed.
/// @throws InputError  as record_roles()
/// Source of the exponent: Palmgren's friction torque M ~ (nu n)^(2/3): Harris & Kotzalas, Essential Concepts of Bearing
/// Technology, 5th ed. (2006), ch. 10.
[[nodiscard]] Identified identify(std::span<const Record> records, const RoleHints& hints, const Listener& listener = {});

/// Learns what a scenario lacks: the share of its simulation that is kept, and additional bodies, chosen and judged in the
/// same way; each channel is the mean of up to three fits (Jury::judged()). Nothing is learned without support by kept-out
/// rows: the error of all channels together must be larger without it, with 95 % confidence over the folds (Student), and so
/// must the error of each extended channel.
/// @param simulated  the scenario's simulation of the same rows, one record each, with all thermometers and displacements of
///                   the roles
[[nodiscard]] Identified extend(std::span<const Record> records, const RecordRoles& roles, std::span<const Record> simulated,
                                const Listener& listener = {});

}  // namespace driftwright::identification
