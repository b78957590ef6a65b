#pragma once
// What `import` has understood of a logger's file.

#include "output/document.hpp"
#include "studies/logger_import.hpp"

namespace driftwright::findings {

[[nodiscard]] output::Document document_of(const studies::LoggerImport& import, const output::Provenance& made_by);

}  // namespace driftwright::findings
