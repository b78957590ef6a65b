#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "app/results.hpp"
#include "app/verbs.hpp"
#include "base/delimited_text.hpp"
#include "base/errors.hpp"
#include "base/usual_ranges.hpp"
#include "base/version.hpp"
#include "effects/catalogue_table.hpp"
#include "effects/effect.hpp"
#include "findings/scenario_document.hpp"
#include "output/document_text.hpp"
#include "scenarios/reader/geometry.hpp"
#include "solver/material.hpp"

namespace driftwright::app {
namespace {

namespace fs = std::filesystem;

void list_materials() {
  fmt::print("{:<24} {:>8} {:>10} {:>10} {:>10} {:>10} {:>8}\n", "material", "kg/m^3", "J/(kg K)", "W/(m K)", "µm/(m K)",
             "GPa", "Poisson");
  for (const auto& [name, m] : solver::material_library()) {
    fmt::print("{:<24} {:>8.0f} {:>10.0f} {:>10.4g} {:>10.4g} {:>10.4g} {:>8.2f}\n", name, m.density_kg_m3,
               m.heat_capacity_J_kgK, m.conductivity_W_mK, 1e6 * m.expansion_1_K.x, 1e-9 * m.youngs_modulus_Pa,
               m.poisson_ratio);
  }
}

void list_effects() {
  std::size_t width = 0;
  for (const effects::EffectKind& kind : effects::catalogue()) width = std::max(width, kind.key.size());
  for (const effects::EffectKind& kind : effects::catalogue()) fmt::print("{:<{}}  {}\n", kind.key, width, kind.title);
}

void list_ranges(bool markdown) {
  if (markdown) fmt::print("| what | usual | source |\n|---|---|---|\n");
  for (const UsualRange& r : usual_ranges()) {
    const std::string usual = fmt::format("{:g} to {:g} {}", r.low, r.high, r.unit);
    fmt::print("{}", markdown ? fmt::format("| {} | {} | {} |\n", r.what, usual, r.source)
                              : fmt::format("{:<50} {:<28} {}\n", r.what, usual, r.source));
  }
}

/// The opening of a scenario: its first comment, up to the end of the sentence or the line.
std::string opening(const std::string& text) {
  if (!text.starts_with("# ")) return "";
  const std::string line = text.substr(2, text.find('\n') - 2);
  const std::size_t stop = line.find(". ");
  return stop == std::string::npos ? line : line.substr(0, stop + 1);
}

/// Lists all .yaml files below a folder, each with the opening of its first comment.
void list_scenarios(const std::string& folder) {
  if (!fs::is_directory(folder))
    throw InputError(fmt::format("there is no folder '{}'; name one: driftwright list scenarios FOLDER", folder));
  std::vector<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder, fs::directory_options::skip_permission_denied)) {
    if (entry.is_regular_file() && entry.path().extension() == ".yaml") files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  std::size_t width = 0;
  for (const std::string& file : files) width = std::max(width, file.size());
  for (const std::string& file : files) fmt::print("{:<{}}  {}\n", file, width, opening(read_text_file(file)));
}

}  // namespace

void list(const ListOptions& options) {
  if (options.markdown && options.what != "effects" && options.what != "ranges")
    throw InputError("--markdown is allowed only for effects and ranges; the others are plain text");
  const bool of_a_scenario = options.what == "joints" || options.what == "cyclograms";
  if (of_a_scenario && options.of.empty())
    throw InputError(fmt::format("a scenario is required: driftwright list {} SCENARIO", options.what));
  if (!options.of.empty() && !of_a_scenario && options.what != "scenarios")
    throw InputError(fmt::format("'{}' is not looked at: {} are the same for all scenarios", options.of, options.what));
  const output::Provenance made_by{kVersion, options.of};
  if (options.what == "materials") return list_materials();
  if (options.what == "ranges") return list_ranges(options.markdown);
  if (options.what == "scenarios") return list_scenarios(options.of.empty() ? "scenarios" : options.of);
  if (options.what == "cyclograms") {
    fmt::print("{}",
               output::document_text(findings::cyclograms_document(scenarios::read_scenario(options.of), made_by), {}));
    return;
  }
  if (options.what == "joints") {
    const scenarios::Geometry geometry = scenarios::read_geometry(options.of);
    const mesh::Mesh mesh = scenarios::build_mesh(geometry.machine.mesh);
    fmt::print("{}", output::document_text(findings::joints_document(geometry.name, mesh, made_by), {}));
    return;
  }
  if (options.markdown) {
    fmt::print("{}", effects::catalogue_table());
  } else {
    list_effects();
  }
}

}  // namespace driftwright::app
