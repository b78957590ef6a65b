#pragma once
// Names for a statement from the catalogue: effects of its quantity at its place, in its records and windows of time.

#include "diagnosis/candidates.hpp"
#include "diagnosis/posterior.hpp"

namespace driftwright::diagnosis {

/// The subject of a statement; each becomes one claim.
using StatedPlace = std::pair<StatedQuantity, std::vector<std::string>>;

/// Whether an effect at a place does what a statement says. For a key that is not part of the shipped catalogue only the
/// place is compared.
/// @param where  names of bodies, channels or the ambient, separated by commas
[[nodiscard]] bool says(const Statement& statement, const std::string& effect, const std::string& where);

/// What an effect changes: the first of the quantities that its key can mean; none for a key that is not part of the
/// shipped catalogue.
[[nodiscard]] std::optional<StatedQuantity> quantity_of(const std::string& effect);

/// The likeliest statement that an effect at a place can name; null if none has a probability of at least 0.01.
[[nodiscard]] const Stated* stated_as(const Posterior& posterior, const std::string& effect, const std::string& where);

/// The candidates that can name statements. For a statement about some records, laws limited to these records are added;
/// for one with windows, windows of the catalogue at their times, whose cost is that of the choice among all rows.
/// @param catalogue  every effect at every place
/// @param without    keys of effects that are excluded
[[nodiscard]] std::vector<Candidate> named_by(const Posterior& posterior, std::vector<Candidate> catalogue, const Twin& twin,
                                              const std::vector<MeasuredRun>& runs, const std::set<std::string>& without);

}  // namespace driftwright::diagnosis
