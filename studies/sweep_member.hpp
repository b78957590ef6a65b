#pragma once
// One member of a sweep: from a scenario and its machine to the numbers of its row.

#include "base/record.hpp"
#include "machine/reduced_machine.hpp"
#include "scenarios/reader/sweep_plan.hpp"

namespace driftwright::studies {

/// A scalar of a channel. The peak is the value farthest from `neutral`, with its sign, the first of equals; its time is in s.
/// Looked for among the record's rows, one each `output_interval`.
[[nodiscard]] double scalar_of(const Record& record, const Channel& channel, scenarios::Scalar scalar, double neutral);

/// Simulates the cyclograms that `collect` names, on the calling thread alone where others work beside it.
/// @param scenario  gives drive, ambient, start and solver; its machine is `machine`
/// @returns one number for each of `collect`; peaks count from 0 um, 0 urad and the reference temperature
/// @throws SolveError, InputError, RangeError
[[nodiscard]] std::vector<double> simulate_member(const scenarios::Scenario& scenario, const scenarios::Machine& machine,
                                                  const std::vector<scenarios::CollectedScalar>& collect);
/// The same on a reduced machine that spans the scenario's laws, whatever laws it holds itself.
[[nodiscard]] std::vector<double> simulate_member(const scenarios::Scenario& scenario,
                                                  const scenarios::ReducedMachine& machine,
                                                  const std::vector<scenarios::CollectedScalar>& collect);

}  // namespace driftwright::studies
