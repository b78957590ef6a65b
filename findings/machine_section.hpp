#pragma once
// The machine as a picture at the head of a report: its named surfaces, or its temperature and how it bends when it bends most; sensors and indicators
// where they sit.

#include <optional>

#include "machine/simulated_run.hpp"
#include "output/document.hpp"
#include "output/machine_picture.hpp"
#include "scenarios/reader/scenario.hpp"

namespace driftwright::findings {

/// Its thermometers at points of it, and its indicators: few enough to be read.
[[nodiscard]] std::vector<output::PictureMark> marks_of(const scenarios::MachineModel& machine);

/// Its surfaces in colours of their own, with their names. @pre the mesh has cells
[[nodiscard]] output::Picture surfaces_picture(const scenarios::MachineModel& machine, const mesh::Mesh& mesh);
/// Its temperature, and its displacement magnified. @param fields  of the mesh, which has cells
[[nodiscard]] output::Picture fields_picture(const scenarios::MachineModel& machine, const mesh::Mesh& mesh,
                                             const std::string& cyclogram, const scenarios::WholeFields& fields);

/// Keeps, of all fields that it is given, those of the largest displacement of any node.
class WorstMoment {
 public:
  void take(const scenarios::WholeFields& fields);
  [[nodiscard]] const std::optional<scenarios::WholeFields>& fields() const { return worst_; }

 private:
  double largest_um_ = -1.0;
  std::optional<scenarios::WholeFields> worst_;
};

/// What a report of a run opens with: the fields at the worst moment; where no fields were asked for, the named surfaces if the mesh has them; nothing without a mesh.
void add_machine(output::Section& body, const scenarios::MachineModel& machine, const mesh::Mesh& mesh,
                 const std::string& cyclogram, const WorstMoment& worst);

}  // namespace driftwright::findings
