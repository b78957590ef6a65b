#pragma once
// A scenario's twin before any measurement, for planned runs.

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
  std::unique_ptr<TwinParts> parts;         ///< objects that the twin refers to
  std::unique_ptr<diagnosis::Focus> focus;  ///< the machine that it runs on
  std::optional<diagnosis::Twin> twin;
  std::vector<diagnosis::MeasuredChannel>
      channels;  ///< the scenario's sensors except those on the ambient, displacements and tilts
  std::vector<diagnosis::MeasuredChannel> further;  ///< mean temperatures of regions and nodes without any of these sensors
  std::map<std::string, diagnosis::NoiseModel> noise;  ///< of both lists, at least the twin's own errors
  TimeSeries ambient;                                  ///< minus the reference [K]
};

/// Meshes and reduces the machine for cyclograms like these. The ambient of the scenario is recorded with them.
/// @param like  at least one; all of the same length
/// @throws InputError  for a machine without sensors and displacements, or with effects that depend on a recorded column
[[nodiscard]] PlannedTwin open_planned_twin(const scenarios::Scenario& scenario, const std::string& verb,
                                            const std::vector<Cyclogram>& like, double interval_s,
                                            const InstrumentNoise& noise, const Listener& listener);

}  // namespace driftwright::studies
