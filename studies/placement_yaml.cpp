#include "studies/placement_yaml.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>

#include "base/yaml_text.hpp"

namespace driftwright::studies {
namespace {

void give_absolute_paths(YamlText& yaml, const ConfigNode& node, const std::filesystem::path& folder) {
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const ConfigNode& item = *node.items[i];
    const bool is_path =
        node.is_map() && item.is_scalar() && (node.keys[i].text == "csv" || node.keys[i].text == "nc_program" || node.keys[i].text == "mesh");
    if (!is_path) {
      give_absolute_paths(yaml, item, folder);
      continue;
    }
    const std::filesystem::path path(item.text);
    if (!path.is_absolute() && !yaml.replace(item, fmt::format("\"{}\"", (folder / path).lexically_normal().string())))
      throw InputError(fmt::format("the path '{}' cannot be edited where it stands; give it as an absolute one", item.text));
  }
}

}  // namespace

std::string sensor_entry(const std::string& name, const Spot& spot) {
  if (spot.node < 0) return fmt::format("{{name: {}, node: {}}}", name, spot.region);
  const Eigen::Vector3d mm = 1e3 * spot.at_m;
  return fmt::format("{{name: {}, region: {}, at: [{:.1f} mm, {:.1f} mm, {:.1f} mm]}}", name, spot.region, mm.x(), mm.y(), mm.z());
}

std::string with_sensors(const std::string& scenario_path, const std::vector<std::string>& entries, const std::vector<std::string>& head) {
  YamlText yaml(scenario_path);
  give_absolute_paths(yaml, yaml.root(), std::filesystem::absolute(scenario_path).parent_path());
  const ConfigNode* sensors = yaml.root().find("sensors");
  bool is_written = true;
  if (!sensors) {
    is_written = yaml.add_pair(yaml.root(), "sensors", fmt::format("[{}]", fmt::join(entries, ", ")));
  } else {
    for (const std::string& entry : entries) is_written = is_written && yaml.append(*sensors, entry, "placed");
  }
  if (!is_written) throw InputError(fmt::format("{}: its key `sensors` cannot be edited where it stands; sensors.yaml holds what to paste", scenario_path));
  return yaml.text(head);
}

}  // namespace driftwright::studies
