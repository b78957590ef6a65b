#pragma once
// What `identify` found, with or without a scenario to begin with, as a document.

#include "identification/identify.hpp"
#include "output/document.hpp"

namespace driftwright::findings {

struct IdentificationFindings {
  std::string name;  ///< of the scenario
  const std::vector<Record>& records;
  const identification::Identified& network;
  std::vector<std::string> notes;  ///< of how records were read
  std::string difference = {};     ///< of a scenario that is extended, to the file
};

[[nodiscard]] output::Document document_of(const IdentificationFindings& found, const output::Provenance& made_by);

}  // namespace driftwright::findings
