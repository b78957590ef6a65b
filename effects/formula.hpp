#pragma once
// An entry with a formula declares a kind of its own: the numbers that its formula uses are the kind's parameters, the
// bodies its references. Everything that reads, calibrates, doubts and writes effects then treats them like those of any
// kind.

#include <optional>
#include <string>
#include <vector>

#include "effects/effect.hpp"

namespace driftwright::effects {

/// True for a kind whose entries hold a formula and name what it uses.
[[nodiscard]] bool has_formula(const EffectKind& kind);

/// The kind of an entry: `kind` itself, or, if it has a formula, the kind that this entry declares. Entries that declare the
/// same get the same kind; it lives as long as the program. Thread-safe.
/// @param nodes  of the machine and ambient, if they are known: other texts are then no bodies
/// @throws InputError  for a formula that cannot be read or whose units do not fit, with the position in it; for a name that
///                     the formula does not use or that has a meaning already; for one that is neither a quantity nor a
///                     body; for a quantity at a place that has none
[[nodiscard]] const EffectKind& declared_kind(const EffectKind& kind, const ConfigMap& entry,
                                              const std::optional<std::vector<std::string>>& nodes);

}  // namespace driftwright::effects
