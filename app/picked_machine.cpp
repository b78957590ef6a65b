#include "app/picked_machine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/delimited_text.hpp"
#include "findings/machine_section.hpp"
#include "mesh/unnamed_geometry.hpp"
#include "scenarios/reader/geometry.hpp"
#include "studies/machine_draft_text.hpp"

namespace driftwright::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kToClick = "Click a face, and paste the text into a scenario.";

/// Kinds of effects that bring heat to a surface or take it away, by surface.
std::map<std::string, std::vector<std::string>> carried_by(const std::vector<effects::Effect>& effects) {
  std::map<std::string, std::vector<std::string>> carried;
  for (const effects::Effect& effect : effects) {
    if (!effect.kind->contribute) continue;
    const effects::HeatBalance balance = effects::heat_balance({effect});
    const auto add = [&](const effects::Body& body) {
      if (body.kind != effects::BodyKind::kSurface) return;
      std::vector<std::string>& kinds = carried[body.name];
      if (std::find(kinds.begin(), kinds.end(), effect.kind->key) == kinds.end()) kinds.push_back(effect.kind->key);
    };
    for (const effects::HeatInput& heat : balance.heats) add(heat.body);
    for (const effects::Exchange& exchange : balance.exchanges) add(exchange.body);
    for (const effects::Radiation& radiation : balance.radiations) add(effects::surface(radiation.surface));
    for (const effects::FixedTemperature& fixed : balance.fixed) add(fixed.body);
  }
  return carried;
}

}  // namespace

PickedMachine scenario_to_pick(const std::string& path) {
  scenarios::Geometry geometry = scenarios::read_geometry(path, true);
  const scenarios::MachineModel& machine = geometry.machine;
  if (std::holds_alternative<scenarios::LumpedMachine>(machine.mesh))
    throw InputError(machine.where, "a machine of lumped nodes has no faces to pick");
  PickedMachine picked{.recipe = machine.mesh};
  output::PickPage& page = picked.page;
  page.name = geometry.name;
  page.subtitle = kToClick;
  if (!std::holds_alternative<mesh::ImportedMesh>(machine.mesh))
    page.no_names = "This machine is drawn by a generator, which has named its surfaces; a scenario cannot add others.";
  page.carried = carried_by(machine.effects);
  for (const scenarios::Sensor& sensor : machine.sensors) page.channels.push_back(sensor.name);
  for (const scenarios::DisplacementOutput& displacement : machine.displacements) page.channels.push_back(displacement.name);
  for (const scenarios::TiltOutput& tilt : machine.tilts) page.channels.push_back(tilt.name);
  page.marks = findings::marks_of(machine);
  return picked;
}

PickedMachine file_to_pick(const std::string& path, const std::string& units) {
  mesh::UnnamedGeometry geometry = mesh::read_unnamed_geometry(path, units);
  studies::MachineDraft draft = studies::draft_of(geometry);
  PickedMachine picked;
  output::PickPage& page = picked.page;
  page.subtitle = kToClick;
  if (geometry.unit_is_a_guess)
    page.notes.push_back(
        fmt::format("Lengths are taken to be in {}, by the size of the machine; --units says another unit.", geometry.unit));
  if (std::any_of(draft.joints.begin(), draft.joints.end(), [](const auto& joint) { return !joint.a.empty(); }))
    page.notes.emplace_back(
        "Parts of this mesh touch and share no nodes. They need `joints`; `driftwright init` finds them.");
  draft.planes.clear();
  draft.remaining.clear();
  draft.joints.clear();
  page.beginning =
      fmt::format("name: {}\n\n{}  surfaces:\n", studies::plain_name(clean_name(fs::path(path).stem().string())),
                  studies::machine_text(draft, geometry, fs::absolute(path).string()));
  picked.mesh = std::move(geometry.mesh);
  return picked;
}

}  // namespace driftwright::app
