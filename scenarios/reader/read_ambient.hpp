#pragma once
// Reads the ambient temperature over time: rows, or a channel of a record CSV (docs/how-to/cyclograms.md).

#include "base/config_map.hpp"
#include "base/cyclogram.hpp"

namespace driftwright::scenarios {

/// The key `ambient`.
[[nodiscard]] schema::Key ambient_key();
/// The key `ambient` of `in`: rows of [time, temperature], or a map {csv, channel} with a path relative to the scenario's
/// folder and a channel in degC. Values are minus reference_K [K].
/// @throws InputError  for times that do not increase, temperatures outside 200 K to 400 K, missing values and channels
[[nodiscard]] TimeSeries read_ambient(const ConfigMap& in, double reference_K);

}  // namespace driftwright::scenarios
