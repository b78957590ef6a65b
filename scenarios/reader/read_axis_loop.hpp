#pragma once
// An axis with a pulse injector in its feedback: `axis_loop:` of a scenario (docs/how-to/injector.md).

#include <string>
#include <vector>

#include "base/config_map.hpp"
#include "compensation/injector/axis_loop.hpp"

namespace driftwright::scenarios {

struct AxisLoopSettings {
  std::string displacement;  ///< channel in um that is corrected
  compensation::AxisLoop loop;
  Where where;
};

/// What the keys of the block may refer to, and their defaults.
struct AxisLoopContext {
  std::vector<std::string> displacements = {};
  std::vector<std::string> sensors = {};
  std::string target = {};           ///< of the study
  double sensor_resolution_K = 0.0;  ///< of the study
  double encoder_period_um = 1.0;    ///< of the study
  double duration_s = 0.0;           ///< of the judged cyclogram
};

/// The schema of the key `axis_loop`.
[[nodiscard]] schema::Map axis_loop_schema();
/// @throws InputError  file, line and key; also for a run that is too long to simulate
[[nodiscard]] AxisLoopSettings read_axis_loop(const ConfigMap& in, const AxisLoopContext& context);

}  // namespace driftwright::scenarios
