#include "findings/machine_section.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace driftwright::findings {

std::vector<output::PictureMark> marks_of(const scenarios::MachineModel& machine) {
  std::vector<output::PictureMark> marks;
  for (const scenarios::Sensor& sensor : machine.sensors) {
    if (const auto* point = std::get_if<scenarios::PointOnRegion>(&sensor.place))
      marks.push_back({sensor.name, scenarios::motion_of(machine.axes, point->region)(point->at_m)});
  }
  // Indicators of several directions at one point share a mark.
  std::vector<output::PictureMark> indicators;
  for (const scenarios::DisplacementOutput& output : machine.displacements) {
    if (!output.points) continue;
    const scenarios::PointOnRegion& tool = output.points->tool;
    const Eigen::Vector3d at_m = scenarios::motion_of(machine.axes, tool.region)(tool.at_m);
    const auto same = std::find_if(indicators.begin(), indicators.end(),
                                   [&](const output::PictureMark& mark) { return mark.at_m == at_m; });
    if (same == indicators.end())
      indicators.push_back({output.name, at_m, true});
    else
      same->name += ", " + output.name;
  }
  constexpr std::size_t kMostNames = 3;  // a gantry's table has dozens of points
  if (indicators.size() <= 8) {
    for (output::PictureMark& mark : indicators) {
      if (static_cast<std::size_t>(std::count(mark.name.begin(), mark.name.end(), ',')) >= kMostNames)
        mark.name = mark.name.substr(0, mark.name.find(',')) + " and others";
      marks.push_back(std::move(mark));
    }
  }
  return marks;
}

output::Picture surfaces_picture(const scenarios::MachineModel& machine, const mesh::Mesh& mesh) {
  return {.title = "Named surfaces, thermometers (dots) and indicators (rings); grey names lie behind",
          .svg = output::draw_machine({.mesh = &mesh, .marks = marks_of(machine)})};
}

output::Picture fields_picture(const scenarios::MachineModel& machine, const mesh::Mesh& mesh, const std::string& cyclogram,
                               const scenarios::WholeFields& fields) {
  const double um = fields.displacement_um.colwise().norm().maxCoeff();
  constexpr double kStill_um = 0.5;
  const std::string when =
      um < kStill_um
          ? fmt::format("'{}': the machine stays as it is, within {:.2f} µm", cyclogram, um)
          : fmt::format("'{}' after {:.0f} min, when of all stored fields the machine is bent most: up to {:.1f} µm",
                        cyclogram, fields.time_s / 60.0, um);
  return {.title = when,
          .svg = output::draw_machine({.mesh = &mesh,
                                       .field = output::PictureField{"temperature [°C]", fields.temperature_degC},
                                       .displacement_m = 1e-6 * fields.displacement_um,
                                       .marks = marks_of(machine)})};
}

void add_machine(output::Section& body, const scenarios::MachineModel& machine, const mesh::Mesh& mesh,
                 const std::string& cyclogram, const WorstMoment& worst) {
  if (mesh.cells.size() == 0) return;
  if (worst.fields()) {
    add(body, fields_picture(machine, mesh, cyclogram, *worst.fields()));
  } else if (mesh.facets.size() > 0) {  // stored machines have none
    add(body, surfaces_picture(machine, mesh));
  }
}

void WorstMoment::take(const scenarios::WholeFields& fields) {
  const double um = fields.displacement_um.colwise().norm().maxCoeff();
  if (!(um > largest_um_)) return;
  largest_um_ = um;
  worst_ = fields;
}

}  // namespace driftwright::findings
