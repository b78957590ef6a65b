#pragma once
// The catalogue as a table for people. docs/reference/effects.md and `driftwright list` use it.

#include <string>

namespace driftwright::effects {

/// Markdown: one row per effect with its YAML type, what it is, its places, its numbers with units and ranges, its law, and
/// whether a diagnosis looks for it.
[[nodiscard]] std::string catalogue_table();

}  // namespace driftwright::effects
