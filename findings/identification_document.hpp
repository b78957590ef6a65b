#pragma once
// The result of `identify`, with or without an initial scenario, as a document.

#include "identification/identify.hpp"
#include "output/document.hpp"

namespace driftwright::findings {

/// The contents of such a document.
struct IdentificationFindings {
  std::string name;  ///< of the scenario
  const std::vector<Record>& records;
  const identification::Identified& network;
  std::vector<std::string> notes;  ///< on how the records were read
  std::string difference = {};     ///< from an extended scenario to the new file
};

[[nodiscard]] output::Document document_of(const IdentificationFindings& found, const output::Provenance& made_by);

}  // namespace driftwright::findings
