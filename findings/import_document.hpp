#pragma once
// The result of `import`: how a logger's file was understood, as a document.

#include "output/document.hpp"
#include "studies/logger_import.hpp"

namespace driftwright::findings {

[[nodiscard]] output::Document document_of(const studies::LoggerImport& import, const output::Provenance& made_by);

}  // namespace driftwright::findings
