#pragma once
// State observer: the reduced model, corrected by the available thermometers. It combines physics and sensors: readings
// reveal the errors of the model, and the model describes what no sensor measures.

#include <span>

#include "compensation/predictors/predictor.hpp"
#include "effects/effect.hpp"
#include "solver/model_factors.hpp"

namespace driftwright::compensation {

/// Assumed uncertainties, as standard deviations.
struct ObserverSettings {
  double reading_K = 0.1;  ///< of a thermometer: noise and rounding
  double model_K = 0.1;    ///< error of the model in a reading even with the right factors
  double drift_um = 1.0;   ///< of the measured drift in learn(): white noise, without the offset of the indicator's zero
  double model_um = 0.5;   ///< error of the model in the drift
  double model_holds_s = 1800.0;  ///< time for which this error stays the same; rows in between add no information
  double factor = 0.15;           ///< of the logarithm of each heat source, film, joint and link, before learning
  double factor_walk = 0.02;      ///< change of a factor in an hour
  double scale = 0.05;            ///< of the scale of each displacement
  double longest_step_s = 60.0;   ///< of the filter between readings
  /// Interval that readings are assumed to have at the start of a run; learn() takes the median of its runs.
  double period_s = 60.0;
  /// Factor on the distance between sensors and model above which trust decreases; 1 is the distance that chance exceeds in
  /// one of a thousand rows.
  double most_apart = 1.0;
};

/// The observer's result for a whole run.
struct Observation {
  std::vector<double> drift_um;      ///< per row of the readings: actual - commanded since the start of the run
  std::vector<double> deviation_um;  ///< its standard deviation by the filter
  Eigen::MatrixXd outputs;           ///< all outputs of the model in the estimated state, n_outputs x n_rows, in K, m, rad
  std::vector<std::string> distrusted;  ///< sensors that were dropped, and when
};

/// An observer during a run: gives the filter's estimate after each row.
class ObserverFollower : public Follower {
 public:
  /// All outputs of the model in the estimated state, in K, m, rad.
  [[nodiscard]] virtual Eigen::VectorXd outputs() const = 0;
  /// Reading minus its expected value, for each sensor [K]; NaN without a reading. At most six deviations, so that single
  /// wrong readings count little.
  [[nodiscard]] virtual const std::vector<double>& innovation_K() const = 0;
  /// The same without that limit.
  [[nodiscard]] virtual const std::vector<double>& deviation_K() const = 0;
};

/// Extended Kalman filter for the reduced state z and the uncertain factors on its heat flows
/// (compensation/control/observer_filter.h) with reading_i = l_i'z + ambient share, drift = (1 + g) l_d'(z - z_start) +
/// ambient share. Which readings it uses, when it drops a sensor, what it does while the ambient jumps and how far it is
/// trusted: compensation/control/state_observer.h. Both are C that a functional mock-up unit compiles, too.
class Observer final : public Predictor {
 public:
  /// @param system   linear, M = 1; copied
  /// @param start  its state at the start of every run at the ambient temperature `start_ambient_K`; for a run that starts
  ///                 in another ambient it is raised everywhere by the difference
  /// @param sensors  outputs in K that it reads; none: the model alone
  /// @param drift    output in m
  /// @param laws     effects of the machine that the system was made of; those that do not act on heat are left out
  /// @throws std::logic_error  for a system that is not linear; @throws InputError  for an output that the system lacks
  Observer(solver::ReducedSystem system, Eigen::VectorXd start, double start_ambient_K, std::vector<std::string> sensors,
           std::string drift, ObserverSettings settings = {}, std::vector<effects::Effect> laws = {});

  /// Follows runs with measured drift; keeps what it learns about the factors.
  void learn(std::span<const MachineRun> runs);
  /// Follows a whole run with its sensors alone; the observer itself is unchanged.
  [[nodiscard]] Observation observe(const MachineRun& run) const;

  /// Its sensors, in degC.
  [[nodiscard]] std::vector<Input> inputs() const override;
  [[nodiscard]] bool is_driven() const override { return true; }
  [[nodiscard]] double reference_K() const override { return system_.reference_K; }
  [[nodiscard]] std::vector<effects::Effect> laws() const override { return laws_; }
  [[nodiscard]] double period_s() const override { return settings_.period_s; }  ///< between the rows that it learned from
  [[nodiscard]] bool looks_after_inputs() const override { return true; }
  /// Kind `observer`: matrices of the reduced model, the effects whose laws drive it, and what it has learned of its
  /// factors.
  [[nodiscard]] std::optional<Written> written() const override;
  [[nodiscard]] const Observer* observer() const override { return this; }
  /// Gives row by row the same as observe() for the whole run.
  [[nodiscard]] std::unique_ptr<Follower> follow() const override;
  /// A follower that never drops a sensor and shows its innovations, in which a wrong sensor is visible. The observer must
  /// outlive it.
  [[nodiscard]] std::unique_ptr<ObserverFollower> watch() const;

  /// A copy with most_apart set to twice the distance that its sensors had from the model in these runs.
  [[nodiscard]] Observer calibrated(std::span<const MachineRun> runs) const;
  /// A copy that keeps what it has learned and reads other sensors.
  [[nodiscard]] Observer with_sensors(std::vector<std::string> sensors) const;

  /// Factors on the model's heat flows (solver::flow_names()), then on the drift, with their standard deviations.
  struct Factor {
    std::string name;
    double value = 1.0, deviation = 0.0;
  };
  [[nodiscard]] std::vector<Factor> factors() const;
  [[nodiscard]] const std::vector<std::string>& sensors() const { return sensors_; }

  /// An estimate with a normal distribution.
  struct Belief {
    Eigen::VectorXd mean;
    Eigen::MatrixXd covariance;
  };
  /// All data of an observer, for storing it in a file.
  struct State {
    solver::ReducedSystem system;
    Eigen::VectorXd start;
    double start_ambient_K = 0.0;
    std::vector<std::string> sensors;
    std::string drift;
    ObserverSettings settings;
    Belief factors;                     ///< of flow_names() minus 1, then of the drift minus 1
    std::vector<effects::Effect> laws;  ///< effects whose laws are in the system
  };
  [[nodiscard]] State state() const;
  /// The observer with that state. @throws std::logic_error, InputError as the constructor, and for a wrong number of
  /// factors
  [[nodiscard]] static Observer of_state(State state);

 private:
  class Run;  // in observer_run.cpp, with all that follows a run

  solver::ReducedSystem system_;
  Eigen::VectorXd start_;
  double start_ambient_K_ = 0.0;
  std::vector<std::string> sensors_;
  std::string drift_;
  ObserverSettings settings_;
  std::vector<Eigen::Index> sensor_output_;
  Eigen::Index drift_output_ = 0;
  Belief factors_;  // w, v, g
  std::vector<effects::Effect> laws_;
};

}  // namespace driftwright::compensation
