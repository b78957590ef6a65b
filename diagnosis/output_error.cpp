#include "diagnosis/output_error.hpp"

#include <algorithm>
#include <cmath>

namespace driftwright::diagnosis {

std::map<std::string, OutputError> output_errors(const std::vector<MeasuredRun>& runs, const Prediction& prediction) {
  std::map<std::string, std::vector<Eigen::VectorXd>> residuals;
  std::map<std::string, std::string> units;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    for (const MeasuredChannel& c : runs[r].channels) {
      units[c.name] = c.unit;
      residuals[c.name].emplace_back(c.value - prediction[r].row(c.output).transpose());
    }
  }
  std::map<std::string, OutputError> errors;
  for (const auto& [name, series] : residuals) {
    Eigen::Index longest = 0;
    for (const Eigen::VectorXd& e : series) longest = std::max(longest, e.size());
    // Mean product of pairs so many rows apart, over the mean square; a mean that is off is a part of the error.
    const auto product = [&](Eigen::Index apart, Eigen::Index* n_pairs) {
      double sum = 0.0;
      for (const Eigen::VectorXd& e : series) {
        for (Eigen::Index i = 0; i + apart < e.size(); ++i) {
          const double p = e[i] * e[i + apart];
          if (std::isnan(p)) continue;
          sum += p;
          ++*n_pairs;
        }
      }
      return sum;
    };
    OutputError error{.unit = units.at(name)};
    const double square = product(0, &error.n);
    if (error.n == 0) continue;
    error.rms = std::sqrt(square / static_cast<double>(error.n));
    if (!(square > 0.0)) {
      errors[name] = error;
      continue;
    }
    double sum = 0.0;
    for (Eigen::Index k = 1; k + 1 < longest; k += 2) {  // pairs of correlations are positive where the sum still tells
      Eigen::Index none = 0;
      const double pair = (product(k, &none) + product(k + 1, &none)) / square;
      if (!(pair > 0.0)) break;
      sum += pair;
    }
    error.rows_as_one = std::clamp(1.0 + 2.0 * sum, 1.0, static_cast<double>(error.n));
    errors[name] = error;
  }
  return errors;
}

std::map<std::string, NoiseModel> working_noise(const std::map<std::string, OutputError>& errors,
                                                const std::map<std::string, NoiseModel>& least, double tempered) {
  std::map<std::string, NoiseModel> noise = least;
  for (const auto& [name, error] : errors)
    noise[name] = {.white = std::max(error.rms, least.at(name).total()) * std::pow(error.rows_as_one, 0.5 * tempered)};
  return noise;
}

}  // namespace driftwright::diagnosis
