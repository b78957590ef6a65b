#include "base/file_bytes.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <fstream>
#include <sstream>

#include "base/errors.hpp"

namespace driftwright {
namespace {

constexpr std::streamsize kMostOfDevice = 1 << 20;  // more than anyone types at a terminal

/// Reads from a device, which may be endless, such as /dev/zero.
std::string read_device(std::istream& device, const std::filesystem::path& path) {
  std::string bytes(static_cast<std::size_t>(kMostOfDevice), '\0');
  device.read(bytes.data(), kMostOfDevice);
  if (device.gcount() == kMostOfDevice)
    throw InputError(fmt::format("{}: this is a device that gives bytes without end; it must be a file", path.string()));
  bytes.resize(static_cast<std::size_t>(device.gcount()));
  return bytes;
}

}  // namespace

std::string read_bytes(const std::filesystem::path& path) {
  std::error_code unknown;
  if (std::filesystem::is_directory(path, unknown))
    throw InputError(fmt::format("{}: this is a folder; it must be a file", path.string()));
  std::ifstream file(path, std::ios::binary);
  if (file && (std::filesystem::is_character_file(path, unknown) || std::filesystem::is_block_file(path, unknown)))
    return read_device(file, path);
  std::ostringstream bytes;
  if (file && file.peek() != std::ifstream::traits_type::eof()) bytes << file.rdbuf();
  file.clear(file.rdstate() & ~(std::ios::eofbit));  // an empty file is valid
  if (!file) throw InputError(fmt::format("{}: the file cannot be opened or read; is the path right?", path.string()));
  return bytes.str();
}

void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream file(path, std::ios::binary);
  file << bytes;
  file.close();
  if (!file) throw InputError(fmt::format("{}: cannot be written; is the disk full?", path.string()));
}

std::string content_hash(std::string_view bytes) {
  const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

}  // namespace driftwright
