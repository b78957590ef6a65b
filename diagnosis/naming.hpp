#pragma once
// What the catalogue calls a statement: effects of its quantity at its place, in the records where it holds, in its windows of time.

#include "diagnosis/candidates.hpp"
#include "diagnosis/posterior.hpp"

namespace driftwright::diagnosis {

/// What a statement is about; one claim is made of each.
using StatedPlace = std::pair<StatedQuantity, std::vector<std::string>>;

/// Whether an effect at a place does what a statement says. Of a key that is not shipped with the catalogue the place alone is asked.
/// @param where  names of bodies, channels or the ambient, commas between them
[[nodiscard]] bool says(const Statement& statement, const std::string& effect, const std::string& where);

/// The likeliest statement that an effect at a place is a name of; null: none of a hundredth or more.
[[nodiscard]] const Stated* stated_as(const Posterior& posterior, const std::string& effect, const std::string& where);

/// The names that statements may have. Of a statement that holds in some records, laws of these records are added; of one in windows, windows of the
/// catalogue at their times, which pay for having been chosen among all rows.
/// @param catalogue  every effect at every place
/// @param without    keys of effects that are not looked for
[[nodiscard]] std::vector<Candidate> named_by(const Posterior& posterior, std::vector<Candidate> catalogue, const Twin& twin,
                                              const std::vector<MeasuredRun>& runs, const std::set<std::string>& without);

}  // namespace driftwright::diagnosis
