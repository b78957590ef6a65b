#pragma once
// The drift of a cyclogram ahead of its run, by the machine's thermal modes: what `predict` shows and `schedule` corrects.

#include "app/results.hpp"

namespace driftwright::app {

struct Prediction {
  Record record;
  std::size_t n_modes = 0;
  bool is_linear = true;  ///< false: laws of temperature stay as in the steady state of the mean drive
};

/// @param verb  for messages
/// @throws InputError  without a machine, for a cyclogram that it cannot run, and as modal_predictors()
[[nodiscard]] Prediction predict_drift(const scenarios::Scenario& scenario, const Cyclogram& cyclogram, Progress& progress,
                                       const std::string& verb);

/// For the terminal: what the prediction leaves out; "" for none.
[[nodiscard]] std::string prediction_note(const Prediction& prediction);

}  // namespace driftwright::app
