#include "scenarios/reader/moved_paths.hpp"

namespace driftwright::scenarios {
namespace {

namespace fs = std::filesystem;

void move_below(YamlText& yaml, const ConfigNode& node, const fs::path& from, const fs::path& to,
                std::vector<const ConfigNode*>& left) {
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const ConfigNode& item = *node.items[i];
    if (!node.is_map() || !item.is_scalar() || !is_path_key(node.keys[i].text)) {
      move_below(yaml, item, from, to, left);
    } else if (!fs::path(item.text).is_absolute()) {
      const std::string moved = moved_path(item.text, from, to);
      if (moved != item.text && !yaml.replace(item, path_text(moved))) left.push_back(&item);
    }
  }
}

}  // namespace

bool is_path_key(const std::string& key) {
  return key == "csv" || key == "nc_program" || key == "mesh" || key == "file";
}

std::string moved_path(const std::string& path, const fs::path& from, const fs::path& to) {
  const fs::path file = (fs::absolute(from) / path).lexically_normal();  // an absolute path is unchanged
  if (to.empty()) return file.string();
  const fs::path folder = fs::weakly_canonical(fs::absolute(to));
  const fs::path plain = file.lexically_relative(folder);
  if (!plain.empty() && fs::weakly_canonical(folder / plain) == fs::weakly_canonical(fs::absolute(from) / path))
    return plain.string();
  const fs::path of_links = (fs::weakly_canonical((fs::absolute(from) / path).parent_path()) / file.filename());
  const fs::path relative = of_links.lexically_relative(folder);
  return relative.empty() ? of_links.string() : relative.string();
}

std::string path_text(const std::string& path) {
  std::string text(1, '"');
  for (char c : path) {
    if (c == '"' || c == '\\') text += '\\';
    text += c;
  }
  text += '"';
  return text;
}

std::vector<const ConfigNode*> move_paths(YamlText& yaml, const fs::path& from, const fs::path& to) {
  std::vector<const ConfigNode*> left;
  move_below(yaml, yaml.root(), from, to, left);
  return left;
}

ConfigNodePtr with_absolute_paths(const ConfigNodePtr& tree, const fs::path& folder) {
  const auto next = std::make_shared<ConfigNode>(*tree);
  for (std::size_t i = 0; i < tree->items.size(); ++i) {
    const ConfigNodePtr& item = tree->items[i];
    if (!tree->is_map() || !item->is_scalar() || !is_path_key(tree->keys[i].text))
      next->items[i] = with_absolute_paths(item, folder);
    else
      next->items[i] = scalar_at(*item, fs::weakly_canonical(fs::absolute(folder) / item->text).string());
  }
  return next;
}

}  // namespace driftwright::scenarios
