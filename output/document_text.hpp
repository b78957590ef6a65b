#pragma once
// Renders a document for the terminal: plain text, columns aligned, no pictures.

#include <string>

#include "output/document.hpp"

namespace driftwright::output {

struct TextOptions {
  bool details = false;  ///< also show details, and explanations of tables
};

/// One section only, indented by two.
[[nodiscard]] std::string section_text(const Section& section, const TextOptions& options = {});

/// The title and subtitle in one line each, then the sections, indented by two. A section without shown content has no
/// heading.
[[nodiscard]] std::string document_text(const Document& document, const TextOptions& options = {});

}  // namespace driftwright::output
