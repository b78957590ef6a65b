#pragma once
// The effect of a little more heat on the readings of one run: the machine linearised from row to row at the states of a
// prediction.
//
//     z' = -K(t) z + b(t) in the modes K V = M V Λ of each stretch in which K is the same;
//                              a load is constant from row to row

#include "diagnosis/twin.hpp"

namespace driftwright::diagnosis {

/// Relative change of a coefficient below which modes are kept.
inline constexpr double kSameModes = 0.03;
/// A law's value at a state; zero while its thermostat is off.
[[nodiscard]] double law_value(const solver::BoundLaw& law, const solver::ReducedSystem& system, const effects::Inputs& u,
                               const Eigen::VectorXd& z);

class LinearOperator {
 public:
  /// @throws SolveError  where the state has no solution
  LinearOperator(const Twin& twin, const MeasuredRun& run, const TwinState& state, Twin::Workspace& workspace);

  /// Heat entering the machine from row to row, in its modes, n_modes x n_rows - 1. Its product with any course over the
  /// intervals is also a load.
  using Load = Eigen::MatrixXd;
  /// 1 W in a body. @return  empty if no heat can enter it
  [[nodiscard]] Load heat(const effects::Body& body) const;
  /// 1 W/K between two bodies, or a body and the ambient, at the temperatures of the prediction.
  [[nodiscard]] Load conductance(const effects::Body& a, const effects::Body& b) const;
  /// The heat of one of the system's own exchanges per 1 W/K or 1 W/(m² K).
  [[nodiscard]] Load exchange(std::size_t e) const;
  /// The additional heat [W] if the spindle stood still.
  [[nodiscard]] Load standing() const;
  /// The heat that a part of the machine conducts within itself, added once more.
  [[nodiscard]] Load conduction(std::size_t part) const;
  /// All of the machine's own heat, and all of its exchange with the ambient.
  [[nodiscard]] Load all_heat() const;
  [[nodiscard]] Load all_loss() const;
  /// 1 K more of the ambient, through the exchanges.
  [[nodiscard]] Load ambient() const;
  /// Heat that 1 J/K more in a body would store. @param lag_s  time constant of the heat's way to the body; 0: it is the
  /// body's own
  [[nodiscard]] Load capacity(const effects::Body& body, double lag_s) const;

  /// The effect of a load on the channels, also where a channel reads bodies at the recorded position of an axis. @param
  /// course  over the intervals. @param before  the course before the run, for a machine that starts at rest; 0: nothing
  /// @return n_channels x n_rows
  [[nodiscard]] Eigen::MatrixXd response(const Load& load, const Eigen::RowVectorXd& course, double before = 0.0) const;
  [[nodiscard]] Eigen::Index n_rows() const { return static_cast<Eigen::Index>(time_s_.size()); }
  [[nodiscard]] const std::vector<double>& time_s() const { return time_s_; }
  /// Mean temperature of a body at the rows over the reference [K]; empty if it has none.
  [[nodiscard]] Eigen::RowVectorXd temperature(const effects::Body& body) const;
  [[nodiscard]] const Eigen::RowVectorXd& ambient_K() const { return ambient_K_; }
  /// Heat of the machine's own laws in a body from row to row [W].
  [[nodiscard]] Eigen::RowVectorXd own_heat(const effects::Body& body) const;
  [[nodiscard]] const std::vector<Drive>& drive() const { return drive_; }  ///< of the intervals
  /// The model's readings of the channels, n_channels x n_rows.
  [[nodiscard]] const Eigen::MatrixXd& predicted() const { return predicted_; }
  /// The effect of 1 K more in each part on each channel, by the expansion of that part alone, n_channels x n_rows.
  [[nodiscard]] Eigen::MatrixXd expansion(std::size_t part) const;
  [[nodiscard]] double coefficient(std::size_t e) const;  ///< of an exchange, mean over the run

 private:
  struct Modes {
    Eigen::VectorXd rate_1_s;
    Eigen::MatrixXd vectors, observe, from;
  };
  /// Modal states of a load, each stretch in its own modes, n_modes x n_rows; calls of() for each stretch: modes, first
  /// row, number of rows.
  template <class Of>
  void run_modes(const Load& load, const Eigen::RowVectorXd& course, double before, Of of) const;
  /// What a channel reads of a body's mean temperature by an effect that follows positions (effects/feed_axis.hpp).
  struct AtPosition {
    Eigen::Index channel = 0, seen = 0;  ///< row of the channel, and of the body among what observe_ sees
    Eigen::RowVectorXd per_K;            ///< at the rows: slope of the reading
  };
  /// Adds these channels and bodies to observe_, and their part to predicted_. @param outputs  at the run's grid
  void read_at_positions(const TwinState& state, const Eigen::MatrixXd& outputs);
  [[nodiscard]] Load in_modes(const Eigen::MatrixXd& load) const;
  /// Courses of all sources [W], n_sources x n_rows - 1, as one load.
  [[nodiscard]] Load of_sources(const Eigen::MatrixXd& courses_W) const;
  [[nodiscard]] const Eigen::VectorXd* load_of(const effects::Body& body) const;

  const Twin& twin_;
  solver::ReducedSystem system_;
  const MeasuredRun& run_;
  std::vector<double> time_s_;
  std::vector<Drive> drive_;
  Eigen::MatrixXd z_, weights_, observe_, predicted_, coefficients_, middle_;  // observe_: of channels, then of bodies
  std::vector<AtPosition> at_position_;
  Eigen::RowVectorXd ambient_K_, ambient_middle_K_;
  Eigen::MatrixXd heats_, standing_;  // of each source, n_sources x n_rows - 1
  std::vector<Modes> modes_;
  std::vector<std::size_t> of_interval_;
};

}  // namespace driftwright::diagnosis
