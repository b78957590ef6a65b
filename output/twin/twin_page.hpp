#pragma once
// A machine as one HTML page in which it runs: the small system, its surface or network, cyclograms, a correction, what `predict` said.

#include <optional>
#include <string>
#include <vector>

#include "base/record.hpp"
#include "compensation/predictors/regression.hpp"
#include "output/machine_picture.hpp"
#include "output/provenance.hpp"
#include "output/twin/twin_model.hpp"
#include "output/twin/twin_surface.hpp"

namespace driftwright::output {

/// Lumped nodes and who exchanges heat with whom; the ambient is the last node.
struct TwinNetwork {
  std::vector<std::string> node = {};
  std::vector<std::pair<int, int>> link = {};
  Eigen::MatrixXd temperature = {};  ///< of all nodes but the ambient in each state, over the reference [K]
};

/// What corrects the drift in the page.
struct TwinCorrection {
  std::string name = {}, words = {};                    ///< a few words; a sentence
  std::vector<compensation::Regression> formulas = {};  ///< by displacement; none: the model itself, one row late
  double resolution_K = 0.0, period_um = 0.0;           ///< of thermometers; of the encoder, 0: no steps
};

struct TwinPage {
  std::string name = {}, subtitle = {};
  TwinModel model = {};
  std::vector<Cyclogram> cyclograms = {};
  std::string first = {};     ///< that the page begins with
  double interval_s = 60.0;   ///< of rows
  Record check = {};          ///< what `predict` says of `first`, at those rows
  std::string check_by = {};  ///< in words
  std::optional<TwinSurface> surface = {};
  std::vector<PictureMark> marks = {};
  TwinNetwork network = {};  ///< of a machine without a surface
  TwinCorrection correction = {};
  std::string target = {};    ///< displacement that is shown first; "": the first
  double tolerance_um = 0.0;  ///< 0: none
};

/// The text of the HTML file. It loads nothing; names of the scenario are text and never markup. The same page gives the same bytes.
/// @throws std::logic_error  for a check without the channel of an output
[[nodiscard]] std::string twin_html(const TwinPage& page, const Provenance& made_by);

}  // namespace driftwright::output
