#pragma once
// Simulates members of a sweep side by side on all cores.

#include <functional>

#include "scenarios/reader/sweep_plan.hpp"

namespace driftwright::studies {

/// The result of a member.
struct MemberOutcome {
  std::size_t member = 0;       ///< from 0
  std::vector<double> results;  ///< in the order of plan.collect; empty if it failed
  std::string failure;          ///< the whole message; empty if it succeeded
  bool is_refused = false;      ///< it failed because its values are no valid scenario, not in the numerics
};

/// The member's row of the table, without line break: number from 1, values, results, status.
[[nodiscard]] std::string table_row(const scenarios::SweepPlan& plan, const MemberOutcome& outcome);
/// Whether the status of such a row says that it succeeded.
[[nodiscard]] bool is_done(const std::string& row);

/// Runs members, given in the order of members_of_part(). Members that share a mesh mesh it once, and those that share a
/// machine build it once. A failed member does not affect the others.
/// @param done  called for each, in any order, by one thread at a time; an exception from it ends the run
void run_members(const scenarios::SweepPlan& plan, const std::vector<std::size_t>& members,
                 const std::function<void(const MemberOutcome&)>& done);

}  // namespace driftwright::studies
