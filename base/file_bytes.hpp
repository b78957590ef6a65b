#pragma once
// Reads and writes whole files, and computes a hash of their content.

#include <filesystem>
#include <string>
#include <string_view>

namespace driftwright {

/// @throws InputError  naming the file, when it cannot be read
[[nodiscard]] std::string read_bytes(const std::filesystem::path& path);
/// @throws InputError  naming the file, when it cannot be written to the end
void write_bytes(const std::filesystem::path& path, const std::string& bytes);

/// XXH3 of 128 bits (xxHash), as 32 hexadecimal digits. It detects damage and different contents, but not forgery.
[[nodiscard]] std::string content_hash(std::string_view bytes);

}  // namespace driftwright
