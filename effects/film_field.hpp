#pragma once
// The states of an effect `film_field`: from its file once that is read, else as an entry holds them.

#include "effects/effect.hpp"

namespace driftwright::effects {

/// The operating points or times of the field and its means. Without a file (a model's file that is read elsewhere) they are
/// those of the tables `over_speed` and `over_time`; with neither, one state.
[[nodiscard]] FieldStates film_field_states(const Effect& effect);

/// The effect with its states as numbers in the entry, so that its laws can be evaluated where its file is missing. Effects
/// of other kinds are returned unchanged.
[[nodiscard]] Effect without_its_file(Effect effect);

}  // namespace driftwright::effects
