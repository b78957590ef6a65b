#pragma once
// Effects that act from one time until another: a draught, a lamp, an oven that is switched off.

#include "effects/effect.hpp"

namespace driftwright::effects {

inline constexpr double kStepsAPeriod = 16.0;  ///< of constant power that a wave is cut into: its amplitude is met to 0.6 %

/// A kind's parameters, and `from` and `until` behind them.
[[nodiscard]] std::vector<Parameter> with_window(std::vector<Parameter> own);

/// The law between the effect's `from` (inclusive) and `until` (exclusive; without end when left out), zero outside. Tells the
/// balance at which times it jumps, so that time integration stops there.
[[nodiscard]] Law in_window(const Effect& effect, Law law, HeatBalance& balance);

/// @throws InputError  unless `until` lies behind `from`
void check_window(const Effect& effect, const ConfigMap& in);

}  // namespace driftwright::effects
