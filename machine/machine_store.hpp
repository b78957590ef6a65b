#pragma once
// Stores reduced machines on disk, by content: a known machine with a new cyclogram needs no finite elements.
//
// A machine's folder is named after a hash of its key, a text that contains everything that determines the result. The
// folder also contains the key itself, and loading compares it, so two machines are never confused. Nothing depends on
// earlier runs.

#include <filesystem>
#include <optional>

#include "machine/reduced_machine.hpp"

namespace driftwright::scenarios {

/// $XDG_CACHE_HOME/driftwright, or ~/.cache/driftwright; empty if the environment defines neither: then nothing is stored.
[[nodiscard]] std::filesystem::path machine_store();

/// The machine of this key with the laws of this balance, or none. A folder with a changed file counts as none: hashes.json
/// contains the hash of each file.
/// @param balance  of the scenario, as effects::heat_balance() gives it
/// @param damage   if given, receives what is wrong with a folder that exists but was not used
[[nodiscard]] std::optional<ReducedMachine> load_machine(const std::filesystem::path& store, const std::string& key,
                                                         const effects::HeatBalance& balance, std::string* damage = nullptr);

/// Stores a machine. Other processes see it complete or not at all. @throws InputError  when it cannot be written
void save_machine(const std::filesystem::path& store, const std::string& key, const ReducedMachine& machine);

}  // namespace driftwright::scenarios
