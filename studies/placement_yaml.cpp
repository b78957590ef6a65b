#include "studies/placement_yaml.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.hpp"
#include "base/yaml_text.hpp"
#include "scenarios/reader/moved_paths.hpp"

namespace driftwright::studies {

std::string sensor_entry(const std::string& name, const Spot& spot) {
  if (spot.node < 0) return fmt::format("{{name: {}, node: {}}}", name, spot.region);
  const Eigen::Vector3d mm = 1e3 * spot.at_m;
  return fmt::format("{{name: {}, region: {}, at: [{:.1f} mm, {:.1f} mm, {:.1f} mm]}}", name, spot.region, mm.x(), mm.y(),
                     mm.z());
}

std::string with_sensors(const std::string& scenario_path, const std::vector<std::string>& entries,
                         const std::vector<std::string>& head, const std::filesystem::path& folder) {
  YamlText yaml(scenario_path);
  const auto left = scenarios::move_paths(yaml, std::filesystem::absolute(scenario_path).parent_path(), folder);
  if (!left.empty())
    throw InputError(
        left.front()->where(""),
        fmt::format("the path '{}' is an alias and cannot be edited; give it as an absolute one", left.front()->text));
  const ConfigNode* sensors = yaml.root().find("sensors");
  bool is_written = true;
  if (!sensors) {
    is_written = yaml.add_pair(yaml.root(), "sensors", fmt::format("[{}]", fmt::join(entries, ", ")));
  } else {
    for (const std::string& entry : entries) is_written = is_written && yaml.append(*sensors, entry, "placed");
  }
  if (!is_written)
    throw InputError((sensors ? *sensors : yaml.root()).where("sensors"),
                     "this list is an alias or shared with one, and no sensors can be added to it; write it out");
  return yaml.text(head);
}

}  // namespace driftwright::studies
