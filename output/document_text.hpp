#pragma once
// A document for the terminal: plain text, columns aligned, no pictures.

#include <string>

#include "output/document.hpp"

namespace driftwright::output {

struct TextOptions {
  bool details = false;  ///< also what is marked as a detail, and explanations of tables
};

/// A section alone, indented by two.
[[nodiscard]] std::string section_text(const Section& section, const TextOptions& options = {});

/// The title and subtitle in a line each, then the sections, indented by two. A section of which nothing is shown has no heading.
[[nodiscard]] std::string document_text(const Document& document, const TextOptions& options = {});

}  // namespace driftwright::output
