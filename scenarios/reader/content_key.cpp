#include "scenarios/reader/content_key.hpp"

#include <fmt/format.h>

#include <fstream>

namespace driftwright::scenarios {
namespace {

/// FNV-1a over bytes: short, and good enough to distinguish the user's own files.
void add_to_hash(std::uint64_t& hash, std::string_view bytes) {
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ull;
  hash = (hash ^ 0xffu) * 1099511628211ull;  // so that "ab", "c" and "a", "bc" differ
}

void add_file_to_hash(std::uint64_t& hash, const std::filesystem::path& path) {
  std::error_code ignored;  // most values are no paths
  if (!std::filesystem::is_regular_file(path, ignored)) return;
  std::ifstream file(path, std::ios::binary);
  add_to_hash(hash, std::string(std::istreambuf_iterator<char>(file), {}));
}

void add_tree_to_hash(std::uint64_t& hash, const ConfigNode& node, const std::filesystem::path& folder) {
  for (const ConfigNodePtr& item : node.items) add_tree_to_hash(hash, *item, folder);
  if (node.is_scalar() && !node.text.empty()) add_file_to_hash(hash, folder / node.text);
}

}  // namespace

std::string content_key(const std::vector<ConfigNodePtr>& roots, const std::filesystem::path& folder,
                        const std::vector<std::string>& words) {
  std::uint64_t hash = 14695981039346656037ull;
  for (const std::string& word : words) {
    add_to_hash(hash, word);
    if (!word.empty()) add_file_to_hash(hash, word);
  }
  for (const ConfigNodePtr& root : roots) {
    for (const std::string& line : root->source->lines) add_to_hash(hash, line);
    add_tree_to_hash(hash, *root, folder);
  }
  return fmt::format("{:016x}", hash);
}

}  // namespace driftwright::scenarios
