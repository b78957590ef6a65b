#include "diagnosis/output_error.hpp"

#include <algorithm>
#include <cmath>

#include "base/rows_as_one.hpp"

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
    OutputError error{.unit = units.at(name)};
    double squares = 0.0;
    for (const Eigen::VectorXd& e : series) {
      for (double v : e) {
        if (std::isnan(v)) continue;
        squares += v * v;
        ++error.n;
      }
    }
    if (error.n == 0) continue;
    error.rms = std::sqrt(squares / static_cast<double>(error.n));
    error.rows_as_one = rows_as_one(series);
    errors[name] = error;
  }
  return errors;
}

std::map<std::string, NoiseModel> working_noise(const std::map<std::string, OutputError>& errors,
                                                const std::map<std::string, NoiseModel>& least) {
  std::map<std::string, NoiseModel> noise = least;
  for (const auto& [name, error] : errors)
    noise[name] = {.white = std::max(error.rms, least.at(name).total()) * std::sqrt(error.rows_as_one)};
  return noise;
}

}  // namespace driftwright::diagnosis
