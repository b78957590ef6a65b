#pragma once
// In which records a cause acts: of laws that hold in all of them, those that hold in some alone.

#include "diagnosis/signatures.hpp"

namespace driftwright::diagnosis {

/// A record is a run of its own, so that a law of some records does there what the law of all does, and nothing in the others: its signature is a part of the
/// other's. For each law the best choice of records, by one more or one fewer at a time from all and from the best single one; where it is better than the law of
/// all by linear theory, though it pays for the choice (as many nats times log 2 as there are records), it becomes a law of its own.
/// @param candidates  the laws found are added to
/// @param columns     signatures of theirs
/// @param projection  of the readings on what is claimed so far
/// @returns  signatures of the laws added
[[nodiscard]] std::vector<Signature> of_some_records(const Fitter& fitter, std::vector<Candidate>& candidates,
                                                     const std::vector<Signature>& columns, const Projection& projection);

}  // namespace driftwright::diagnosis
