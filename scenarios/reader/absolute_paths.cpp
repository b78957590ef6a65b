#include "scenarios/reader/absolute_paths.hpp"

namespace driftwright::scenarios {
namespace {

void give(YamlText& yaml, const ConfigNode& node, const std::filesystem::path& folder,
          std::vector<const ConfigNode*>& left) {
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const ConfigNode& item = *node.items[i];
    if (!node.is_map() || !item.is_scalar() || !is_path_key(node.keys[i].text)) {
      give(yaml, item, folder, left);
    } else if (!std::filesystem::path(item.text).is_absolute() &&
               !yaml.replace(item, absolute_path_text(item.text, folder))) {
      left.push_back(&item);
    }
  }
}

}  // namespace

bool is_path_key(const std::string& key) {
  return key == "csv" || key == "nc_program" || key == "mesh" || key == "file";
}

std::string absolute_path_text(const std::string& path, const std::filesystem::path& folder_of_scenario) {
  std::string text(1, '"');
  for (char c : (folder_of_scenario / path).lexically_normal().string()) {  // an absolute path is unchanged
    if (c == '"' || c == '\\') text += '\\';
    text += c;
  }
  text += '"';
  return text;
}

std::vector<const ConfigNode*> give_absolute_paths(YamlText& yaml, const std::filesystem::path& folder_of_scenario) {
  std::vector<const ConfigNode*> left;
  give(yaml, yaml.root(), folder_of_scenario, left);
  return left;
}

}  // namespace driftwright::scenarios
