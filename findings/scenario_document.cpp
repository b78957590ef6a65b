#include "findings/scenario_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "findings/film_section.hpp"
#include "findings/machine_section.hpp"
#include "findings/named_value.hpp"
#include "mesh/quality.hpp"
#include "solver/joint.hpp"

namespace driftwright::findings {
namespace {

using output::Table;
using output::Value;

Table cyclograms_table(const std::vector<Cyclogram>& cyclograms) {
  Table table{.key = "cyclograms",
              .columns = {{.key = "name", .title = "cyclogram"},
                          {.key = "duration_min", .title = "duration", .unit = "min"},
                          {.key = "n_sections", .title = "sections"},
                          {.key = "highest_speed_rpm", .title = "up to", .unit = "rpm", .digits = output::decimals(0)},
                          {.key = "share_turning", .title = "turning", .digits = output::percent(0)}}};
  for (const Cyclogram& cyclogram : cyclograms) {
    double highest_rpm = 0.0, turning_s = 0.0;
    for (const Cyclogram::Section& section : cyclogram.sections) {
      highest_rpm = std::max(highest_rpm, section.drive.speed_rpm);
      if (section.drive.speed_rpm > 0.0) turning_s += section.duration_s;
    }
    table.rows.push_back({cyclogram.name, cyclogram.duration_s() / 60.0, cyclogram.sections.size(), highest_rpm,
                          turning_s / cyclogram.duration_s()});
  }
  return table;
}

void add_size(output::Section& section, const mesh::Mesh& mesh) {
  add(section, Value{.key = "nodes", .words = "nodes", .datum = mesh.n_nodes()});
  add(section, Value{.key = "cells", .words = "cells", .datum = mesh.cells.size()});
  add(section, Value{.key = "regions", .words = "regions", .datum = mesh.regions.size()});
  add(section, Value{.key = "joints", .words = "joints", .datum = mesh.joints.size()});
  add(section, named_value("worst_scaled_jacobian", "worst scaled Jacobian", mesh::worst_quality(mesh).min_scaled,
                           output::decimals(4)));
}

void add_demand(output::Section& section, const scenarios::MeshDemand& demand) {
  add(section, Value{.key = "solved_by", .words = "solved by", .datum = demand.method});
  add(section,
      named_value("memory_MB", "memory that it will take, about", 1e-6 * demand.memory_bytes, "MB", output::decimals(0)));
  add(section, named_value("time_s", "time of one processor, very roughly, while the machine is not known from disk",
                           demand.time_s, "s", output::decimals(0)));
}

/// Contact area of each joint, and the gap between its sides.
Table joints_table(const mesh::Mesh& m) {
  Table joints{
      .key = "contacts",
      .columns = {{.key = "joint", .title = "joint"},
                  {.key = "area_m2", .title = "in contact", .unit = "m2", .digits = output::decimals(4)},
                  {.key = "largest_gap_mm", .title = "sides apart by up to", .unit = "mm", .digits = output::decimals(3)}}};
  for (const mesh::Joint& joint : m.joints) {
    double area_m2 = 0.0, gap_m = 0.0;
    for (const solver::JointPoint& p : solver::joint_points(m, joint)) {
      area_m2 += p.area_m2;
      gap_m = std::max(gap_m, p.gap_m);
    }
    joints.rows.push_back({joint.name, area_m2, 1e3 * gap_m});
  }
  return joints;
}

/// Density of a region's material; NaN if it is not known yet.
double density_kg_m3(const scenarios::MachineModel& machine, const std::string& region) {
  for (const scenarios::MaterialEntry& entry : machine.materials) {
    if (entry.region == region) return entry.material.density_kg_m3;
  }
  return std::nan("");
}

std::string mm(double size_m) {
  return fmt::format("{:.4g} mm", 1e3 * size_m);
}

/// How the mesh sizes of a machine were chosen.
std::string size_words(const mesh::KneeMill& mill) {
  return fmt::format("given in the scenario: frame {}, spindle {}", mm(mill.coarse_m), mm(mill.fine_m));
}
std::string size_words(const mesh::GantryTable& table) {
  return "given in the scenario: " + mm(table.mesh_size_m);
}
std::string size_words(const mesh::ImportedMesh& import) {
  if (import.mesh_size_m == 0.0) return "fixed by the mesh file";
  std::string words = "given in the scenario: default " + mm(import.mesh_size_m);
  for (const auto& [region, size_m] : import.mesh_size_of_region_m) words += fmt::format(", {} {}", region, mm(size_m));
  return words;
}
std::string size_words(const scenarios::LumpedMachine&) {
  return "";
}

}  // namespace

output::Document scenario_document(const scenarios::Scenario& scenario, const scenarios::PlacedMachine* placed,
                                   const scenarios::MeshDemand* demand, const output::Provenance& made_by) {
  output::Document document{.made_by = made_by, .title = made_by.scenario + ": fine"};
  output::Section& body = document.body;
  add(body, Value{.key = "name", .datum = scenario.name});
  if (!placed) {
    document.subtitle = "a study of measured records";
    add(body, Value{.key = "target", .words = "target", .datum = scenario.study->target});
  } else {
    if (placed->mesh.n_nodes() > 0) {
      add_size(body, placed->mesh);
      add(body, named_value("mesh_size", "mesh size",
                            std::visit([](const auto& of_kind) { return size_words(of_kind); }, scenario.machine->mesh)));
      if (demand) add_demand(body, *demand);
    }
    add(body, Value{.key = "lumped_nodes", .words = "lumped nodes", .datum = placed->balance.nodes.size()});
    add(body, Value{.key = "effects", .words = "effects", .datum = scenario.machine->effects.size()});
    add(body, Value{.key = "sensors", .words = "sensors", .datum = scenario.machine->sensors.size()});
    add(body, cyclograms_table(scenario.cyclograms));
    add_films(body, placed->films, placed->mesh);
  }
  std::vector<std::string> notes;
  for (const Cyclogram& cyclogram : scenario.cyclograms) {
    for (const std::string& remark : cyclogram.remarks) notes.push_back(cyclogram.name + ": " + remark);
  }
  if (scenario.columns) {
    for (const std::string& line : words(*scenario.columns)) notes.push_back("records are read by `columns`: " + line);
  }
  if (placed) notes.insert(notes.end(), placed->mesh.notes.begin(), placed->mesh.notes.end());
  add(body, output::Notes{.key = "notes", .sort = "note", .lines = notes});
  return document;
}

output::Document mesh_document(const std::string& name, const scenarios::MachineModel& machine, const mesh::Mesh& m,
                               std::span<const scenarios::MappedFilm> films, const output::Provenance& made_by) {
  const mesh::Quality quality = mesh::worst_quality(m);
  output::Document document{.made_by = made_by, .title = name + ": mesh"};
  output::Section& body = document.body;
  add(body, surfaces_picture(machine, m));
  add_size(body, m);
  add(body, Value{.key = "worst_cell", .words = "worst cell", .datum = quality.worst_cell});
  add(body, Value{.key = "worst_cell_region", .words = "its region", .datum = m.regions[m.cells.group[quality.worst_cell]]});
  add(body, named_value("mean_scaled_jacobian", "mean scaled Jacobian", quality.mean_scaled, output::decimals(3)));
  Table regions{.key = "region_sizes",
                .columns = {{.key = "region", .title = "region"},
                            {.key = "volume_l", .title = "volume", .unit = "l", .digits = output::decimals(3)},
                            {.key = "mass_kg", .title = "mass", .unit = "kg"},
                            {.key = "cells", .title = "cells"}}};
  for (std::size_t r = 0; r < m.regions.size(); ++r) {
    const int region = static_cast<int>(r);
    const double volume_m3 = mesh::volume_m3(m, region);
    regions.rows.push_back(
        {m.regions[r], 1e3 * volume_m3, volume_m3 * density_kg_m3(machine, m.regions[r]), m.cells_in(region).size()});
  }
  Table surfaces{.key = "surfaces",
                 .columns = {{.key = "surface", .title = "surface"},
                             {.key = "area_m2", .title = "area", .unit = "m2", .digits = output::decimals(4)}}};
  for (std::size_t s = 0; s < m.surfaces.size(); ++s) {
    if (m.surfaces[s].find('@') == std::string::npos)
      surfaces.rows.push_back({m.surfaces[s], mesh::area_m2(m, static_cast<int>(s))});
  }
  Table joints = joints_table(m);
  for (Table* table : {&regions, &surfaces, &joints}) add(body, std::move(*table));
  add_films(body, films, m);
  add(body, output::Notes{.key = "notes", .sort = "note", .lines = m.notes});
  return document;
}

output::Document cyclograms_document(const scenarios::Scenario& scenario, const output::Provenance& made_by) {
  output::Document document{.made_by = made_by, .title = scenario.name + ": cyclograms"};
  add(document.body, cyclograms_table(scenario.cyclograms));
  return document;
}

output::Document joints_document(const std::string& name, const mesh::Mesh& mesh, const output::Provenance& made_by) {
  output::Document document{.made_by = made_by, .title = name + ": joints"};
  add(document.body, joints_table(mesh));
  return document;
}

}  // namespace driftwright::findings
