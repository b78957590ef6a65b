#pragma once
// The key `validation`: what strategies of correction are judged on: families of cyclograms, seasons of the ambient,
// instruments and failing sensors.

#include "base/config_map.hpp"
#include "base/cyclogram.hpp"

namespace driftwright::scenarios {

struct Validation {
  std::vector<Cyclogram> train;  ///< to fit on, in the scenario's ambient
  struct Family {
    std::string name;
    std::vector<Cyclogram> cyclograms;
  };
  std::vector<Family> families;
  struct Season {
    std::string name;
    double offset_K = 0.0;  ///< of the ambient over the scenario's
    double swing_K = 0.0;   ///< amplitude of a sine with a period of 24 h that begins with each cyclogram
  };
  std::vector<Season> seasons;  ///< the first is the scenario's ambient, "as trained"
  double noise_K = 0.0;         ///< of thermometers, white, standard deviation
  double resolution_K = 0.0;
  double drift_noise_um = 0.0;  ///< of the indicator in the training runs
  double model_scatter =
      0.1;  ///< standard deviation of the logarithm of each power and exchange of the model given to strategies
  double fails_at = 0.5;  ///< share of a cyclogram after which a sensor fails
  double tolerance_um = 10.0;
  int seed = 1;
  Where where;
};

/// The schema of the key `validation`.
[[nodiscard]] schema::Map validation_schema();
/// @param known      cyclograms that the block may name
/// @param tolerance  for a block without its own
/// @throws InputError  file, line, key
[[nodiscard]] Validation read_validation(const ConfigMap& in, const std::vector<const Cyclogram*>& known,
                                         double tolerance_um);

/// What is judged on where a scenario has no key `validation`: strategies are fitted on all cyclograms but the last and
/// judged on that one, where there are three, and on random ones at the speeds of the others; in the scenario's ambient, and
/// in one that is 5 K cooler or warmer. Instruments are as usual on machines: 0.1 K, 1 um.
/// @throws InputError  where fewer than two different cyclograms turn the spindle
[[nodiscard]] Validation default_validation(const std::vector<Cyclogram>& cyclograms, double tolerance_um);

/// True if two cyclograms drive the machine alike: the same sections, and the same columns, such as positions of axes.
[[nodiscard]] bool drive_alike(const Cyclogram& a, const Cyclogram& b);

/// The ambient of a season [K, as the series given], over a cyclogram.
[[nodiscard]] TimeSeries ambient_in(const Validation::Season& season, const TimeSeries& ambient, double duration_s);

}  // namespace driftwright::scenarios
