#pragma once
// Whole files, and a number for what is in them.

#include <cstdint>
#include <filesystem>
#include <string>

namespace driftwright {

/// @throws InputError  naming the file, when it cannot be read
[[nodiscard]] std::string read_bytes(const std::filesystem::path& path);
/// @throws InputError  naming the file, when it cannot be written to the end
void write_bytes(const std::filesystem::path& path, const std::string& bytes);

/// FNV-1a, 64 bits.
[[nodiscard]] std::uint64_t fnv1a(const std::string& bytes);

}  // namespace driftwright
