#pragma once
// The result of `compensate` with any actuator except the frame, as a document.

#include "output/document.hpp"
#include "studies/correction_study.hpp"

namespace driftwright::findings {

/// What the user asked for.
struct CorrectionAsked {
  std::string model = {};    ///< as the user named it
  std::string verdict = {};  ///< verdict in the predictor's file; "": it has not been judged
  std::string through = {};  ///< none, injector, schedule
};

[[nodiscard]] output::Document document_of(const studies::CorrectionStudy& study, const scenarios::Scenario& scenario,
                                           const CorrectionAsked& asked, const output::Provenance& made_by);

}  // namespace driftwright::findings
