#pragma once
// The key `programme`: tests at fixed speeds that predictors of drift learn from, and cyclograms that they are judged on.

#include "base/config_map.hpp"
#include "base/cyclogram.hpp"

namespace driftwright::scenarios {

struct Programme {
  std::vector<double> test_rpm;  ///< increasing, at least three; each test heats from the start, then rests
  double heating_s = 0.0, cooling_s = 0.0;
  double temperature_noise_K = 0.0, displacement_noise_um = 0.0;  ///< white, on the tests' readings; for tilts per 100 mm
  int seed = 1;
  std::vector<Cyclogram> cyclograms;
  struct Random {
    int count = 0, sections = 7;
    double duration_s = 0.0;
  } random;
  int most_modes = 4;          ///< most modes that may be identified from tests
  double model_scatter = 0.0;  ///< standard deviation of the logarithm of each power and coefficient of a hybrid's model
  double tolerance_um = 10.0;  ///< of scheduled corrections
  bool extrapolate = false;    ///< cyclograms may run outside the tested speeds
  Where where;
};

/// The schema of the key `programme`, with the keys that read_random() reads.
[[nodiscard]] schema::Map programme_schema();
[[nodiscard]] std::vector<schema::Key> random_keys();
/// Reads the keys count, sections and duration. @throws InputError  file, line, key
[[nodiscard]] Programme::Random read_random(const ConfigMap& in);
/// @throws InputError  file, line, key
[[nodiscard]] Programme read_programme(const ConfigMap& in);

/// `count` cyclograms as `random` says, at given speeds: "random_01" and so on.
[[nodiscard]] std::vector<Cyclogram> random_cyclograms(const Programme::Random& random,
                                                       const std::vector<double>& speeds_rpm, int seed);
/// Cyclograms with sections of random length at the tests' speeds, no speed twice in a row, with occasional stops. The
/// same seed gives the same cyclograms.
[[nodiscard]] std::vector<Cyclogram> random_cyclograms(const Programme& programme);
/// The tests as cyclograms: "test_800" and so on.
[[nodiscard]] std::vector<Cyclogram> test_cyclograms(const Programme& programme);

}  // namespace driftwright::scenarios
