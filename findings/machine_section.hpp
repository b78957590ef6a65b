#pragma once
// A picture of the machine at the top of a report: its named surfaces, or its temperature and deformation at the time of the
// largest displacement; with the positions of sensors and indicators.

#include <optional>

#include "machine/simulated_run.hpp"
#include "output/document.hpp"
#include "output/machine_picture.hpp"
#include "scenarios/reader/scenario.hpp"

namespace driftwright::findings {

/// Marks at its point thermometers and indicators: few enough to be readable.
[[nodiscard]] std::vector<output::PictureMark> marks_of(const scenarios::MachineModel& machine);

/// Its surfaces in different colours, with their names. @pre the mesh has cells
[[nodiscard]] output::Picture surfaces_picture(const scenarios::MachineModel& machine, const mesh::Mesh& mesh);
/// Its temperature, and its displacement magnified. @param fields  of the mesh, which must have cells
[[nodiscard]] output::Picture fields_picture(const scenarios::MachineModel& machine, const mesh::Mesh& mesh,
                                             const std::string& cyclogram, const scenarios::WholeFields& fields);

/// Keeps, of all fields that it receives, those with the largest displacement of any node.
class WorstMoment {
 public:
  void take(const scenarios::WholeFields& fields);
  [[nodiscard]] const std::optional<scenarios::WholeFields>& fields() const { return worst_; }

 private:
  double largest_um_ = -1.0;
  std::optional<scenarios::WholeFields> worst_;
};

/// Adds the first picture of a run's report: the fields at the worst time; without fields, the named surfaces if the mesh
/// has any; nothing without a mesh.
void add_machine(output::Section& body, const scenarios::MachineModel& machine, const mesh::Mesh& mesh,
                 const std::string& cyclogram, const WorstMoment& worst);

}  // namespace driftwright::findings
