#pragma once
// What `compensate` found through any actuator but the frame, as a document.

#include "output/document.hpp"
#include "studies/correction_study.hpp"

namespace driftwright::findings {

struct CorrectionAsked {
  std::string model = {};    ///< as the user named it
  std::string verdict = {};  ///< that its file has; "": nobody has judged it
  std::string through = {};  ///< none, injector, schedule
};

[[nodiscard]] output::Document document_of(const studies::CorrectionStudy& study, const scenarios::Scenario& scenario,
                                           const CorrectionAsked& asked, const output::Provenance& made_by);

}  // namespace driftwright::findings
