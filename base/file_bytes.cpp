#include "base/file_bytes.hpp"

#include <fmt/format.h>

#include <fstream>
#include <sstream>

#include "base/errors.hpp"

namespace driftwright {

std::string read_bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << file.rdbuf();
  if (!file) throw InputError(fmt::format("{}: the file cannot be read", path.string()));
  return bytes.str();
}

void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream file(path, std::ios::binary);
  file << bytes;
  file.close();
  if (!file) throw InputError(fmt::format("{}: cannot be written; is the disk full?", path.string()));
}

std::uint64_t fnv1a(const std::string& bytes) {
  std::uint64_t h = 14695981039346656037ull;
  for (unsigned char c : bytes) h = (h ^ c) * 1099511628211ull;
  return h;
}

}  // namespace driftwright
