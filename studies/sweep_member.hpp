#pragma once
// Computes one member of a sweep: from a scenario and its machine to the numbers of its row.

#include "base/record.hpp"
#include "machine/reduced_machine.hpp"
#include "scenarios/reader/sweep_plan.hpp"

namespace driftwright::studies {

/// A scalar of a channel, from the record's rows, one per `output_interval`. The peak is the value furthest from
/// `neutral`, with its sign; of equal values the first. Its time is in s.
[[nodiscard]] double scalar_of(const Record& record, const Channel& channel, scenarios::Scalar scalar, double neutral);

/// Simulates the cyclograms that `collect` names, on the calling thread only if others work in parallel.
/// @param scenario  gives drive, ambient, start and solver; its machine is `machine`
/// @returns one number for each entry of `collect`; peaks are relative to 0 um, 0 urad and the reference temperature
/// @throws SolveError, InputError, RangeError
[[nodiscard]] std::vector<double> simulate_member(const scenarios::Scenario& scenario, const scenarios::Machine& machine,
                                                  const std::vector<scenarios::CollectedScalar>& collect);
/// The same on a reduced machine that spans the scenario's laws, whichever laws it contains itself.
[[nodiscard]] std::vector<double> simulate_member(const scenarios::Scenario& scenario,
                                                  const scenarios::ReducedMachine& machine,
                                                  const std::vector<scenarios::CollectedScalar>& collect);

}  // namespace driftwright::studies
