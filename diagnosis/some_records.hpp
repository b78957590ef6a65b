#pragma once
// In which records a cause acts: of laws that hold in all of them, those that hold in some alone.

#include "diagnosis/signatures.hpp"

namespace driftwright::diagnosis {

/// A record is a run of its own: what a law does in it, it does whether or not it holds in the others, but for a start at rest, in which only what holds in all
/// records takes part. For each law that can be said of some records alone the best choice of them is looked for by linear theory on the parts of its signature,
/// by one record more or fewer at a time, from all and from the best single one. It pays log 2 for each record in which the law can be seen. Where it brings
/// evidence, and more than the law of all records does, it becomes a law of its own.
/// @param candidates  the laws found are added to
/// @param columns     signatures of theirs
/// @param projection  of the readings on what is claimed so far
/// @returns  the laws added, whose signatures are still to be taken
[[nodiscard]] std::vector<Law> add_of_chosen_records(const Fitter& fitter, std::vector<Candidate>& candidates,
                                                     const std::vector<Signature>& columns, const Projection& projection);

}  // namespace driftwright::diagnosis
