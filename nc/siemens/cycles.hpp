#pragma once
// The drilling cycles CYCLE81 to CYCLE85 of Siemens' language.

#include <optional>
#include <string>
#include <vector>

#include "nc/execution.hpp"

namespace driftwright {

/// A call of a cycle.
struct SiemensCycle {
  int code = 81;                         ///< 81 ... 85
  std::vector<std::optional<double>> p;  ///< its arguments in their order, in the unit of the program
};

/// The code of the cycle of that name, such as 81 of "CYCLE81"; none of another name.
[[nodiscard]] std::optional<int> siemens_cycle_code(const std::string& name);

/// The drill moves down along the axis normal to the plane, from its present position.
/// @throws InputError  for an argument that is missing, for planes in another order, without a feed
/// Source: Siemens, SINUMERIK 840D sl / 828D, Programming Manual Fundamentals (6FC5398-1BP40), drilling cycles.
void run_siemens_cycle(NcExecution& run, const SiemensCycle& cycle);

}  // namespace driftwright
