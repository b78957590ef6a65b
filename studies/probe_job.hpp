#pragma once
// The work of a job and the places where its program lets an axis be probed.

#include "base/cyclogram.hpp"
#include "nc/program.hpp"
#include "studies/probe_plan.hpp"

namespace driftwright::studies {

/// How often a job is done.
struct ProbeJobOrder {
  int n_parts = 1;         ///< >= 1
  double between_s = 0.0;  ///< at rest between two parts, >= 0
};

/// Work: the whole program. Places: before the job, before each tool change and at each halt (M0, M1, M60, STOP), and before
/// each further part, after the rest. @throws InputError  for a program that takes no time
[[nodiscard]] ProbeJob probe_job_of(const NcProgram& program, const std::string& name, const ProbeJobOrder& order);

/// Work: the sections in which something is driven. Places: before the job, at the end of each rest, and before each further
/// part. @throws InputError  for a cyclogram in which nothing is driven
[[nodiscard]] ProbeJob probe_job_of(const Cyclogram& job, const ProbeJobOrder& order);

}  // namespace driftwright::studies
