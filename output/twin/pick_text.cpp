#include "output/twin/pick_text.hpp"

#include <fmt/format.h>

#include <cctype>

#include "base/characters.hpp"
#include "base/config_map.hpp"

namespace driftwright::output {
namespace {

std::string written_mm(double x_m) {
  return fmt::format("{:.11g} mm", 1e3 * x_m);
}
std::string point_mm(const Eigen::Vector3d& x_m) {
  return fmt::format("[{}, {}, {}]", written_mm(x_m[0]), written_mm(x_m[1]), written_mm(x_m[2]));
}
std::string direction_text(const Eigen::Vector3d& n) {
  return fmt::format("[{:.8g}, {:.8g}, {:.8g}]", n[0], n[1], n[2]);
}

}  // namespace

std::string yaml_word(const std::string& name) {
  const bool is_plain = is_name(name) && std::isalpha(static_cast<unsigned char>(name.front())) != 0;
  return is_plain ? name : double_quoted(name);
}

std::string pick_text(const std::string& region, const mesh::FacePick& pick) {
  if (const auto* plane = std::get_if<mesh::PlanePick>(&pick)) {
    return fmt::format("region: {}, plane: {{through: {}, normal: {}}}", yaml_word(region), point_mm(plane->through_m),
                       direction_text(plane->normal));
  }
  const auto& cylinder = std::get<mesh::CylinderPick>(pick);
  return fmt::format("region: {}, cylinder: {{through: {}, axis: {}, diameter: {}}}", yaml_word(region),
                     point_mm(cylinder.through_m), direction_text(cylinder.axis), written_mm(cylinder.diameter_m));
}

std::string pick_words(const mesh::FacePick& pick) {
  if (const auto* plane = std::get_if<mesh::PlanePick>(&pick))
    return fmt::format("plane, normal {}", direction_text(plane->normal));
  const auto& cylinder = std::get<mesh::CylinderPick>(pick);
  return fmt::format("cylinder, diameter {}, radius {}, axis {} through {}", written_mm(cylinder.diameter_m),
                     written_mm(0.5 * cylinder.diameter_m), direction_text(cylinder.axis), point_mm(cylinder.through_m));
}

}  // namespace driftwright::output
