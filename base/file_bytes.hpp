#pragma once
// Whole files, and a number for what is in them.

#include <filesystem>
#include <string>
#include <string_view>

namespace driftwright {

/// @throws InputError  naming the file, when it cannot be read
[[nodiscard]] std::string read_bytes(const std::filesystem::path& path);
/// @throws InputError  naming the file, when it cannot be written to the end
void write_bytes(const std::filesystem::path& path, const std::string& bytes);

/// XXH3 of 128 bits (xxHash), as 32 hexadecimal digits: tells damage, and contents that differ, but not forgery.
[[nodiscard]] std::string content_hash(std::string_view bytes);

}  // namespace driftwright
