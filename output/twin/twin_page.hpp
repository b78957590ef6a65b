#pragma once
// One HTML page in which a machine runs: the small system, its surface or network, cyclograms, a correction, and the
// result of `predict` for comparison.

#include <optional>
#include <string>
#include <vector>

#include "base/record_band.hpp"
#include "compensation/predictors/regression.hpp"
#include "output/provenance.hpp"
#include "output/twin/page_parts.hpp"
#include "output/twin/twin_model.hpp"

namespace driftwright::output {

/// The correction of the drift in the page.
struct TwinCorrection {
  std::string name = {}, words = {};                    ///< a few words; one sentence
  std::vector<compensation::Regression> formulas = {};  ///< one per displacement; none: the model itself, one row late
  double resolution_K = 0.0, period_um = 0.0;           ///< of thermometers; of the encoder (0: no steps)
};

struct TwinPage {
  std::string name = {}, subtitle = {};
  TwinModel model = {};
  std::vector<Cyclogram> cyclograms = {};
  std::string first = {};               ///< name of the cyclogram that the page begins with
  double interval_s = 60.0;             ///< of rows
  Record check = {};                    ///< result of `predict` for `first`, at those rows
  std::string check_by = {};            ///< who made it, in words
  std::optional<RecordBand> band = {};  ///< of it
  std::optional<TwinSurface> surface = {};
  std::vector<PictureMark> marks = {};
  TwinNetwork network = {};  ///< of a machine without a surface
  TwinCorrection correction = {};
  std::string target = {};    ///< displacement that is shown first; "": the first one
  double tolerance_um = 0.0;  ///< 0: none
};

/// The text of the HTML file. It loads nothing; names of the scenario are inserted as text, never as markup. The same
/// page gives the same bytes.
/// @throws std::logic_error  for a check without the channel of an output
[[nodiscard]] std::string twin_html(const TwinPage& page, const Provenance& made_by);

}  // namespace driftwright::output
