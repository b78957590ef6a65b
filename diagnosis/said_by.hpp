#pragma once
// Which candidates of the catalogue are ways to write a statement: names for regions of the grammar.

#include "diagnosis/candidates.hpp"
#include "diagnosis/posterior.hpp"

namespace driftwright::diagnosis {

/// Whether an effect at a place says what a statement says, whatever it follows. @param where  as Candidate::where
[[nodiscard]] bool says(const Statement& statement, const std::string& effect, const std::string& where);

/// The statement that is likeliest to be meant; null: none of a hundredth and more is.
[[nodiscard]] const Stated* stated_as(const Posterior& posterior, const std::string& effect, const std::string& where);

}  // namespace driftwright::diagnosis
