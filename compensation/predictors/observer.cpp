#include "compensation/predictors/observer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/errors.hpp"

namespace driftwright::compensation {

Observer::Observer(solver::ReducedSystem system, Eigen::VectorXd start, double start_ambient_K,
                   std::vector<std::string> sensors, std::string drift, ObserverSettings settings,
                   std::vector<effects::Effect> laws)
    : system_(std::move(system)),
      start_(std::move(start)),
      start_ambient_K_(start_ambient_K),
      sensors_(std::move(sensors)),
      drift_(std::move(drift)),
      settings_(settings),
      laws_(std::move(laws)) {
  if (!system_.is_linear()) throw std::logic_error("an observer follows a linear reduced model");
  std::erase_if(laws_, [](const effects::Effect& e) { return !e.kind->acts_on_heat(); });
  const auto output = [&](const std::string& name) {
    const auto found = std::find(system_.outputs.name.begin(), system_.outputs.name.end(), name);
    if (found == system_.outputs.name.end()) throw InputError(fmt::format("the model has no output '{}'", name));
    return static_cast<Eigen::Index>(found - system_.outputs.name.begin());
  };
  for (const std::string& sensor : sensors_) sensor_output_.push_back(output(sensor));
  drift_output_ = output(drift_);
  const auto n = static_cast<Eigen::Index>(solver::flow_names(system_).size());
  factors_ = {Eigen::VectorXd::Zero(n + 1), Eigen::MatrixXd::Zero(n + 1, n + 1)};
  factors_.covariance.diagonal().head(n).setConstant(settings_.factor * settings_.factor);
  factors_.covariance(n, n) = settings_.scale * settings_.scale;
}

Observer Observer::with_sensors(std::vector<std::string> sensors) const {
  Observer other(system_, start_, start_ambient_K_, std::move(sensors), drift_, settings_, laws_);
  other.factors_ = factors_;
  return other;
}

std::vector<Input> Observer::inputs() const {
  std::vector<Input> inputs;
  for (const std::string& sensor : sensors_) inputs.push_back({sensor, "degC"});
  return inputs;
}

Observer::State Observer::state() const {
  return {system_, start_, start_ambient_K_, sensors_, drift_, settings_, factors_, laws_};
}

Observer Observer::of_state(State state) {
  Observer observer(std::move(state.system), std::move(state.start), state.start_ambient_K, std::move(state.sensors),
                    std::move(state.drift), state.settings, std::move(state.laws));
  if (state.factors.mean.size() != observer.factors_.mean.size() ||
      state.factors.covariance.rows() != observer.factors_.covariance.rows() ||
      state.factors.covariance.cols() != observer.factors_.covariance.cols())
    throw std::logic_error("an observer has a factor on each heat flow and one on the drift");
  observer.factors_ = std::move(state.factors);
  return observer;
}

std::vector<Observer::Factor> Observer::factors() const {
  std::vector<std::string> names = solver::flow_names(system_);
  names.push_back(drift_);
  std::vector<Factor> result;
  for (Eigen::Index i = 0; i < factors_.mean.size(); ++i) {
    const double deviation = std::sqrt(std::max(0.0, factors_.covariance(i, i)));
    result.push_back({std::move(names[static_cast<std::size_t>(i)]), 1.0 + factors_.mean(i), deviation});
  }
  return result;
}

}  // namespace driftwright::compensation
