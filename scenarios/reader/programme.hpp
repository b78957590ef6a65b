#pragma once
// What predictors of drift are judged on: tests at fixed speeds to learn from, cyclograms to predict.

#include "base/config_map.hpp"
#include "base/cyclogram.hpp"

namespace driftwright::scenarios {

struct Programme {
  std::vector<double> test_rpm;  ///< increasing, three at least; each test heats from the start and then stands
  double heating_s = 0.0, cooling_s = 0.0;
  double temperature_noise_K = 0.0, displacement_noise_um = 0.0;  ///< white, on the tests' readings; tilts: per 100 mm
  int seed = 1;
  std::vector<Cyclogram> cyclograms;
  struct Random {
    int count = 0, sections = 7;
    double duration_s = 0.0;
  } random;
  int most_modes = 4;          ///< that may be identified from tests
  double model_scatter = 0.0;  ///< 1 sigma of the logarithm by which a hybrid's model is wrong in each power and coefficient
  double tolerance_um = 10.0;  ///< of scheduled corrections
  bool extrapolate = false;    ///< cyclograms may run outside the tested speeds
  Where where;
};

/// What the key `programme` may hold; the keys that read_random() reads.
[[nodiscard]] schema::Map programme_schema();
[[nodiscard]] std::vector<schema::Key> random_keys();
/// The keys count, sections, duration. @throws InputError  file, line, key
[[nodiscard]] Programme::Random read_random(const ConfigMap& in);
/// @throws InputError  file, line, key
[[nodiscard]] Programme read_programme(const ConfigMap& in);

/// Cyclograms of `count` as `random` has it, at some speeds: "random_01" and so on.
[[nodiscard]] std::vector<Cyclogram> random_cyclograms(const Programme::Random& random,
                                                       const std::vector<double>& speeds_rpm, int seed);
/// Cyclograms of sections of random length at the tests' speeds, no speed twice in a row, now and then a stop. The same seed gives the same.
[[nodiscard]] std::vector<Cyclogram> random_cyclograms(const Programme& programme);
/// The tests as cyclograms: "test_800" and so on.
[[nodiscard]] std::vector<Cyclogram> test_cyclograms(const Programme& programme);

}  // namespace driftwright::scenarios
