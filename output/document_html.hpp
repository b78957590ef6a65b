#pragma once
// Renders a document as one HTML page, with its pictures.

#include <string>
#include <vector>

#include "output/document.hpp"
#include "output/html_report.hpp"

namespace driftwright::output {

/// A section as blocks of a page. @throws std::logic_error  when a table's row is not as long as its columns
[[nodiscard]] std::vector<html::ReportBlock> page_blocks(const Section& section);

/// The page, and its figures as files.
/// @throws std::logic_error  when a table's row is not as long as its columns, or a plot is ill-formed
[[nodiscard]] html::Rendered document_html(const Document& document);

}  // namespace driftwright::output
