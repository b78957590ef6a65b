#include "app/diagnosis_files.hpp"

#include <algorithm>

#include "output/vtk_fields.hpp"

namespace driftwright::app {

void write_scenario(const std::string& stem, const studies::WrittenScenario& written, output::ResultsFolder& folder) {
  if (!written.is_readable()) return;
  folder.write_text(stem + ".yaml", written.extended.text);
  folder.write_text(stem + ".diff", written.difference);
}

bool write_missing_heat(const mesh::Mesh& mesh, const diagnosis::Posterior& statements, output::ResultsFolder& folder) {
  if (mesh.n_nodes() == 0) return false;
  std::vector<output::RegionField> fields = {{"missing_heat_probability", std::vector<double>(mesh.regions.size(), 0.0)},
                                             {"missing_heat_W", std::vector<double>(mesh.regions.size(), 0.0)}};
  for (const diagnosis::Stated& s : statements.stated) {
    if (s.says.quantity != diagnosis::StatedQuantity::kHeat) continue;
    const auto found = std::find(mesh.regions.begin(), mesh.regions.end(), s.says.place.front());
    if (found == mesh.regions.end()) continue;
    const auto r = static_cast<std::size_t>(found - mesh.regions.begin());
    fields[0].value[r] = s.probability;
    fields[1].value[r] = s.size;
  }
  output::write_region_fields(mesh, fields, folder.path("residual_source.vtu"));
  return true;
}

}  // namespace driftwright::app
