#pragma once
// State observer: the reduced model, corrected by the thermometers there are. It uses physics and sensors: what the model has
// wrong shows in the readings, and what the sensors do not see is the model's.

#include <map>
#include <span>

#include "compensation/predictors/predictor.hpp"
#include "solver/model_factors.hpp"

namespace driftwright::compensation {

/// How much is taken for granted. Standard deviations.
struct ObserverSettings {
  double reading_K = 0.1;         ///< of a thermometer: noise and rounding
  double model_K = 0.1;           ///< by which the model may miss a reading though its factors are right
  double drift_um = 1.0;          ///< of the drift while it learns: white, beside what the zero of the indicator is off by
  double model_um = 0.5;          ///< and the drift
  double model_holds_s = 1800.0;  ///< for so long it misses in the same way: the rows in between tell nothing new
  double factor = 0.15;  ///< of the logarithm of each heat source and each film, joint and link, before anything is known
  double factor_walk = 0.02;     ///< by which a factor may wander in an hour
  double scale = 0.05;           ///< of each displacement
  double longest_step_s = 60.0;  ///< of the filter between readings
  double period_s = 60.0;        ///< that the first readings of a run stand for; learn() takes it from its first run
  /// How far sensors may keep away from the model before it is trusted less, over what chance has in one of a thousand rows; at least 1.
  double most_apart = 1.0;
};

struct Observation {
  std::vector<double> drift_um;         ///< per row of the readings: actual - commanded since the start of the run
  std::vector<double> deviation_um;     ///< that the filter gives it, 1 sigma
  Eigen::MatrixXd outputs;              ///< all outputs of the model in the state believed, n_outputs x n_rows, in K, m, rad
  std::vector<std::string> distrusted;  ///< sensors that were dropped, and when
};

/// An observer on its way through a run: after each row what its filter says of that row.
class ObserverFollower : public Follower {
 public:
  /// All outputs of the model in the state believed, in K, m, rad.
  [[nodiscard]] virtual Eigen::VectorXd outputs() const = 0;
  /// Reading minus what was expected of it, of each sensor [K]; NaN where it has none.
  [[nodiscard]] virtual const std::vector<double>& innovation_K() const = 0;
};

/// Extended Kalman filter over the reduced state z and factors on everything uncertain:
///
///     dz/dt = -K(u) z + sum_s (1 + w_s) P_s(u) b_s + f_ambient(u) + sum_e v_e c_e(u) (ambient g_e + o_e - G_e z),   w, v: random walks
///     reading_i = l_i'z + ambient share,   drift = (1 + g) l_d'(z - z_start) + ambient share
///
/// K(u) enters by its exponential, exact for any step; factors on exchanges act as heat over a step. Where readings keep away from what the
/// rest expects (their mean over about ten rows by more than five deviations), the sensor is dropped for the rest of the run and the filter
/// goes back to before it began. Where others stay away without that sensor, too, it is the model that is wrong: the sensor counts again, and the trust
/// that the model deserves is 1 over how far their means are beyond what chance in a thousand rows, or the training runs, had (`most_apart`). An ambient that jumps by more than 3 K from row to row (of rows more than 10 min apart: in 10 min) is held where it was until it is back. Source: Kalman, J. Basic Eng. 82 (1960) 35; Jazwinski, Stochastic Processes and Filtering Theory (1970), ch. 8.
class Observer final : public Predictor {
 public:
  /// @param system   linear, M = 1; copied
  /// @param start    its state at the start of every run at the ambient temperature `start_ambient_K`; a run that starts in another ambient starts
  ///                 as many kelvins higher everywhere
  /// @param sensors  outputs in K that it reads; none: the model alone
  /// @param drift    output in m
  /// @throws std::logic_error  for a system that is not linear; @throws InputError  for an output that the system has not
  Observer(solver::ReducedSystem system, Eigen::VectorXd start, double start_ambient_K, std::vector<std::string> sensors,
           std::string drift, ObserverSettings settings = {});

  /// Follows runs in which the drift was measured too; what it learns of the factors stays.
  void learn(std::span<const ObservedRun> runs);
  /// Follows a whole run by its sensors alone; afterwards the observer is what it was.
  [[nodiscard]] Observation observe(const ObservedRun& run) const;

  /// Its sensors, in degC.
  [[nodiscard]] std::vector<Input> inputs() const override;
  [[nodiscard]] bool is_driven() const override { return true; }
  [[nodiscard]] double reference_K() const override { return system_.reference_K; }
  [[nodiscard]] bool looks_after_inputs() const override { return true; }
  /// Row by row what observe() gives of the whole run.
  [[nodiscard]] std::unique_ptr<Follower> follow() const override;
  /// A follower that gives up no sensor and tells what it sees on its way: one that is wrong shows in its innovations. It outlives no observer.
  [[nodiscard]] std::unique_ptr<ObserverFollower> watch() const;

  /// The same, that trusts its model as far as twice what its sensors kept away from it in these runs.
  [[nodiscard]] Observer calibrated(std::span<const ObservedRun> runs) const;
  /// The same, with what it has learned, reading other sensors.
  [[nodiscard]] Observer with_sensors(std::vector<std::string> sensors) const;

  /// Factors on the model's heat flows (solver::flow_names()), then on the drift, with their standard deviations.
  struct Factor {
    std::string name;
    double value = 1.0, deviation = 0.0;
  };
  [[nodiscard]] std::vector<Factor> factors() const;
  /// Their values as factors on the model: solver::with_factors() makes the machine that the filter believes in.
  [[nodiscard]] solver::ModelFactors model_factors() const;
  [[nodiscard]] const std::vector<std::string>& sensors() const { return sensors_; }

  /// What is believed: normally distributed.
  struct Belief {
    Eigen::VectorXd mean;
    Eigen::MatrixXd covariance;
  };
  /// All that makes an observer, such as goes into a file.
  struct State {
    solver::ReducedSystem system;
    Eigen::VectorXd start;
    double start_ambient_K = 0.0;
    std::vector<std::string> sensors;
    std::string drift;
    ObserverSettings settings;
    Belief factors;  ///< of flow_names() minus 1, then of the drift minus 1
  };
  [[nodiscard]] State state() const;
  /// The observer of that state. @throws std::logic_error, InputError  as the constructor, and for factors of another number
  [[nodiscard]] static Observer of_state(State state);

 private:
  struct Step;  // what one drive does to the state over one step
  class Run;

  solver::ReducedSystem system_;
  Eigen::VectorXd start_;
  double start_ambient_K_ = 0.0;
  std::vector<std::string> sensors_;
  std::string drift_;
  ObserverSettings settings_;
  std::vector<Eigen::Index> sensor_output_;
  Eigen::Index drift_output_ = 0;
  Belief factors_;  // w, v, g
};

}  // namespace driftwright::compensation
