#pragma once
// Writes chosen places as sensors of a scenario.

#include <filesystem>

#include "studies/placement.hpp"

namespace driftwright::studies {

/// An entry of the key `sensors`: {name: p1, region: headstock, at: [170.0 mm, 180.0 mm, 1320.0 mm]}, {name: p1, node:
/// housing}.
[[nodiscard]] std::string sensor_entry(const std::string& name, const Spot& spot);

/// The scenario's text with these entries at the end of its key `sensors`; comments are kept.
/// @param head    comment lines for the top
/// @param folder  where it will be written, which its paths become relative to; empty: they become absolute
/// @throws InputError  if the file cannot be edited in place: a list or path that is an alias
[[nodiscard]] std::string with_sensors(const std::string& scenario_path, const std::vector<std::string>& entries,
                                       const std::vector<std::string>& head, const std::filesystem::path& folder = {});

}  // namespace driftwright::studies
