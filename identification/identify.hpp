#pragma once
// Which network predicts: laws of its heat, how many bodies, how smooth, decided by rows that were kept out.

#include "base/listener.hpp"
#include "base/mean_error.hpp"
#include "identification/foster_network.hpp"
#include "identification/ledger.hpp"

namespace driftwright::identification {

/// Kept-out rows of one kind, all channels in turn.
struct KeptOutKind {
  std::string kind;         ///< as compensation::Fold has it
  std::vector<double> rms;  ///< a channel each; mean of the logarithms over the folds of the kind; NaN where none judges
};

struct IdentifiedBody {
  NetworkBody body;
  std::string name;   ///< what heats it and its time constant: "speed_25min", "ambient_4h"
  double gain = 0.0;  ///< by how much more kept-out rows are missed without it: 0.1 is a tenth
};

struct IdentifiedChannel {
  std::string name, unit;  ///< degC, K (a rise over the reference) or um
  ChannelFit fit;
  double swing = 0.0;       ///< standard deviation of the readings
  double missed_own = 0.0;  ///< root mean square of the rows that were fitted to
  double missed_simulated =
      0.0;  ///< the same rows as the written scenario is simulated, in balance at the start of each record
  double missed_kept_out = 0.0;  ///< geometric mean over kinds of kept-out rows
  Eigen::VectorXd predicted;     ///< all rows, with what is true of records alone
  Eigen::VectorXd misses;        ///< of these; NaN where there is no reading
  std::vector<Driver> ledger;    ///< the largest share first
  // Where a scenario is extended:
  bool is_extended = false;        ///< else the scenario is kept as it is
  double scenario_simulated = 0.0;  ///< what the scenario as it is leaves of the same rows, as missed_simulated
  double scenario_kept_out = 0.0;  ///< of kept-out rows, as missed_kept_out
  MeanError
      missed_more_without;  ///< logarithm of what the scenario as it is misses over what it misses extended, kept-out folds
};

struct Identified {
  RecordRoles roles;
  Structure structure;
  double reference_degC = 20.0;
  std::vector<IdentifiedBody> bodies;       ///< in the order of bodies_of()
  std::vector<IdentifiedChannel> channels;  ///< thermometers, then displacements
  std::vector<KeptOutKind> kinds;
  std::vector<std::size_t> blocks;  ///< of each record, so many rows are one in what is kept of rows
  bool is_extension = false;        ///< of a scenario; bodies then are what is missing beside it
};

/// Laws that are tried: of the speed, on while it turns, a power of it (5/3, viscous friction of bearings, unless kept-out rows speak for another), or both; of other drives, in
/// proportion. Time constants lie in even steps of their logarithm between three rows, or 0.3 % of the longest record, and a third of that. Of all, the network with the fewest bodies whose kept-out
/// misses are within a standard error of the least; then bodies go that kept-out rows do not miss.
/// @throws InputError  as record_roles()
/// Source of the exponent: Palmgren's friction torque M ~ (nu n)^(2/3): Harris & Kotzalas, Essential Concepts of Bearing Technology, 5th ed. (2006), ch. 10.
[[nodiscard]] Identified identify(std::span<const Record> records, const RoleHints& hints, const Listener& listener = {});

/// What a scenario misses, learned beside it: how much of its simulation is kept, and bodies that it does not have, chosen and judged in the same way. Nothing is learned where
/// kept-out rows do not speak for it: all channels together must be missed by more without, with 95 % over the folds (Student), and so must each channel that is extended.
/// @param simulated  the same rows as the scenario gives them, a record each, with all thermometers and displacements of the roles
[[nodiscard]] Identified extend(std::span<const Record> records, const RecordRoles& roles, std::span<const Record> simulated,
                                const Listener& listener = {});

}  // namespace driftwright::identification
