#pragma once
// Reduced machines kept on disk, by content: a known machine with a new cyclogram needs no finite elements at all.
//
// A machine's folder is named after a hash of its key: everything that decides the result, as text. The key itself stands in the
// folder and is compared, so a machine is never taken for another. Nothing depends on what was run before.

#include <filesystem>
#include <optional>

#include "machine/reduced_machine.hpp"

namespace driftwright::scenarios {

/// $XDG_CACHE_HOME/driftwright, or ~/.cache/driftwright; empty where the environment names neither: then nothing is kept.
[[nodiscard]] std::filesystem::path machine_store();

/// The machine of this key with the laws of this balance, or none. A folder in which a file is not as it was written counts as none: each has
/// its hash in hashes.json.
/// @param balance  of the scenario, as effects::heat_balance() gives it
/// @param damage   where given: what is wrong with a folder that is there and was not taken
[[nodiscard]] std::optional<ReducedMachine> load_machine(const std::filesystem::path& store, const std::string& key,
                                                         const effects::HeatBalance& balance, std::string* damage = nullptr);

/// Keeps a machine. Other processes see it whole or not at all. @throws InputError  when it cannot be written
void save_machine(const std::filesystem::path& store, const std::string& key, const ReducedMachine& machine);

}  // namespace driftwright::scenarios
