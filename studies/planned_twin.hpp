#pragma once
// A scenario's twin before anything is measured, for runs that are still to be made.

#include "studies/measured_twin.hpp"

namespace driftwright::studies {

/// Noise of one reading, white.
struct InstrumentNoise {
  double temperature_K = 0.05;
  double displacement_um = 0.5;
  double tilt_urad = 0.5;
};

struct PlannedTwin {
  mesh::Mesh mesh;
  std::unique_ptr<TwinParts> parts;         ///< what the twin refers to
  std::unique_ptr<diagnosis::Focus> focus;  ///< what it runs on
  std::optional<diagnosis::Twin> twin;
  std::vector<diagnosis::MeasuredChannel>
      channels;  ///< the scenario's sensors but those on the ambient, displacements and tilts
  std::vector<diagnosis::MeasuredChannel> further;  ///< mean temperatures of regions and nodes that no sensor of these is on
  std::map<std::string, diagnosis::NoiseModel> noise;  ///< of both, and no less than the twin's own errors
  TimeSeries ambient;                                  ///< minus the reference [K]
};

/// Meshes and reduces for cyclograms like these. The ambient is recorded beside them, as the scenario has it.
/// @param like  at least one; all of one length
/// @throws InputError  for a machine without sensors and displacements, or with effects that a recorded column drives
[[nodiscard]] PlannedTwin open_planned_twin(const scenarios::Scenario& scenario, const std::string& verb,
                                            const std::vector<Cyclogram>& like, double interval_s,
                                            const InstrumentNoise& noise, const Listener& listener);

}  // namespace driftwright::studies
