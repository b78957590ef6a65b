#pragma once
// What files hold of predictors: a word for the kind, and data that this kind alone writes and reads.

#include <nlohmann/json.hpp>

#include "compensation/predictors/predictor.hpp"

namespace driftwright::compensation {

/// A predictor as a file holds it.
struct Written {
  std::string kind;                ///< key of its PredictorKind
  nlohmann::ordered_json content;  ///< all that its kind needs to make it again, with all digits
};

/// The drift that a predictor gives; it belongs to the file, not to the predictor's data.
struct DriftTarget {
  std::string name;         ///< displacement, in um
  bool from_start = false;  ///< counted from the first row of the run
};

/// A kind of predictor that files hold.
struct PredictorKind {
  std::string key;  ///< value of the key `predictor`, and name of the key that holds the data
  /// Makes the predictor whose written() gave this content.
  /// @throws InputError  naming the key, if the content is not a predictor of this kind
  std::shared_ptr<const Predictor> (*read)(const nlohmann::ordered_json& content, const DriftTarget& target) = nullptr;
};

/// Every kind there is. CMake makes the list from PREDICTOR_KINDS in compensation/predictors/CMakeLists.txt: NAME_kind() of
/// each name.
[[nodiscard]] const std::vector<PredictorKind>& predictor_kinds();

}  // namespace driftwright::compensation
