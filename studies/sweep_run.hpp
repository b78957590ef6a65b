#pragma once
// Simulates members of a sweep side by side on all cores.

#include <functional>

#include "scenarios/reader/sweep_plan.hpp"

namespace driftwright::studies {

/// What became of a member.
struct MemberOutcome {
  std::size_t member = 0;       ///< from 0
  std::vector<double> results;  ///< as plan.collect; empty where it failed
  std::string failure;          ///< the whole message, empty where it went well
  bool is_refused = false;      ///< failed because its values make no scenario, not in the numerics
};

/// The member's row of the table, without line break: number from 1, values, results, status.
[[nodiscard]] std::string table_row(const scenarios::SweepPlan& plan, const MemberOutcome& outcome);
/// True where the status of such a row says so.
[[nodiscard]] bool is_done(const std::string& row);

/// Runs members, given in the order of members_of_part(). Members that share a mesh mesh once, those that share a machine build it
/// once. A member that fails costs no other.
/// @param done  called for each, in any order, by one thread at a time; throwing ends the run
void run_members(const scenarios::SweepPlan& plan, const std::vector<std::size_t>& members,
                 const std::function<void(const MemberOutcome&)>& done);

}  // namespace driftwright::studies
