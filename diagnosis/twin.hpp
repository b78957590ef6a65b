#pragma once
// A reduced machine that is valid for any possible fault: one basis for all of them.

#include <memory>

#include "diagnosis/knob.hpp"
#include "diagnosis/measured_run.hpp"
#include "machine/reduced_machine.hpp"
#include "solver/added_places.hpp"
#include "solver/model_factors.hpp"
#include "solver/propagator.hpp"

namespace driftwright::diagnosis {

/// The scenario's machine with all places at which a diagnosis may add something: heat in each region, node and surface,
/// films where there are none, a medium along each body, a path from each node to the ambient, stratified air. Its
/// reduced model is valid for laws at all of them. Further bodies and paths between them are added to the reduced system
/// when a state has them (solver/added_places.hpp).
struct AugmentedModel {
  scenarios::MachineModel model;
  scenarios::ReductionPlan plan;
  std::size_t n_own_effects = 0;  ///< the scenario's, first in the list
  /// The air in the assembled reduced machine: level_K minus its gradient times the height over z = 0.
  struct Air {
    double gradient_K_m = 0.0, level_K = 0.0;
  } air = {};
};
/// @param mesh  the machine's, for the names of its regions and surfaces
[[nodiscard]] AugmentedModel augment(const scenarios::Scenario& scenario, const mesh::Mesh& mesh,
                                     const std::vector<MeasuredRun>& runs);
/// The machine without further places: for other numbers of its own effects and materials alone. Its reduced model is the
/// one of predictions; conductivity, capacity and expansion can change if that was made with parts (ReductionPlan).
[[nodiscard]] AugmentedModel without_further_places(const scenarios::MachineModel& model);

/// Predicts readings. Const and shared by threads; each thread needs a Workspace.
class Twin {
 public:
  Twin(const AugmentedModel& augmented, const scenarios::ReducedMachine& machine, solver::TransientOptions tolerances);

  /// Systems and decompositions of one thread.
  class Workspace {
   public:
    explicit Workspace(const Twin& twin);

   private:
    friend class Twin;
    solver::Propagator& propagator() {
      if (!propagator_) propagator_ = std::make_unique<solver::Propagator>(system_);
      return *propagator_;
    }
    solver::ReducedSystem system_;
    solver::ModelFactors factors_;  ///< factors on conductivities and capacities in system_
    std::vector<double> offsets_;   ///< of its exchanges, for air and media
    solver::AddedPlaces added_;     ///< the places that it has beyond the machine's
    std::unique_ptr<solver::Propagator> propagator_;
  };

  /// The scenario as written.
  [[nodiscard]] const TwinState& as_written() const { return as_written_; }
  [[nodiscard]] std::size_t n_own_effects() const { return as_written_.size(); }
  /// Reduced states of the machine at a run's grid, size x n_grid.
  /// @throws SolveError  if a state has no solution
  [[nodiscard]] Eigen::MatrixXd states(const TwinState& state, const MeasuredRun& run, Workspace& workspace,
                                       const solver::KeptStates* near = nullptr) const;
  /// Outputs of the machine at a run's grid, n_outputs x n_grid [K over the reference, m, rad]: the model's own, then the
  /// mean temperatures of its regions and nodes.
  /// @param near  unless null, kept_run() of a close state, whose accuracy is then sufficient
  /// @throws SolveError  if a state has no solution
  [[nodiscard]] Eigen::MatrixXd respond(const TwinState& state, const MeasuredRun& run, Workspace& workspace,
                                        const solver::KeptStates* near = nullptr) const;
  /// respond() if the reduced states are known, size (or more, with places that the state adds) x n_grid.
  [[nodiscard]] Eigen::MatrixXd outputs_of(const TwinState& state, const MeasuredRun& run,
                                           const Eigen::Ref<const Eigen::MatrixXd>& states) const;
  /// Data from which states near this one are computed; null if that is not possible.
  /// @param for_slopes  first-order accuracy is sufficient
  [[nodiscard]] std::shared_ptr<const solver::KeptStates> kept_run(const TwinState& state, const MeasuredRun& run,
                                                                   Workspace& workspace, bool for_slopes = true) const;
  /// The readings of these outputs at the run's rows, n_outputs x n_times, with the instruments' effects.
  [[nodiscard]] Eigen::MatrixXd read(const TwinState& state, const MeasuredRun& run, Eigen::MatrixXd outputs) const;
  /// The readings of a state: read() of what respond() gives.
  [[nodiscard]] Eigen::MatrixXd readings(const TwinState& state, const MeasuredRun& run, Workspace& workspace) const {
    return read(state, run, respond(state, run, workspace));
  }

  /// The machine of a state in a run with its laws bound, for the effect of a little more heat.
  struct Bound {
    const solver::ReducedSystem& system;  ///< the workspace's; valid until its next use
    Cyclogram cyclogram;                  ///< the true one
    TimeSeries ambient;
    Eigen::MatrixXd outputs;  ///< rows of outputs() on the reduced state, size x n_outputs, with this state's expansion
    Eigen::VectorXd start;    ///< reduced state at the run's beginning, followed by places that this state adds
  };
  [[nodiscard]] Bound bound(const TwinState& state, const MeasuredRun& run, Workspace& workspace) const;

  [[nodiscard]] const solver::Outputs& outputs() const { return outputs_; }
  [[nodiscard]] double reference_K() const { return machine_.system.reference_K; }
  [[nodiscard]] const scenarios::ReducedMachine& machine() const { return machine_; }
  [[nodiscard]] const AugmentedModel& augmented() const { return augmented_; }
  /// States with each part of the machine 1 K warmer than the rest, size x n_parts; in a reduced model as close as its
  /// basis allows.
  [[nodiscard]] Eigen::MatrixXd warmer_bodies() const;
  /// A state's heat balance, with radiation as films.
  [[nodiscard]] effects::HeatBalance balance(const TwinState& state) const;
  /// The kind of body that a part of the machine is.
  [[nodiscard]] effects::Body body_of(const std::string& part) const;
  /// Names of the bodies at a surface, or joined by a joint; its own name if the mesh does not say.
  [[nodiscard]] std::vector<std::string> bodies_at(const std::string& surface_or_joint) const;

 private:
  /// Factors of a state relative to the scenario, on conductivity and heat capacity of each part; the capacities of nodes
  /// are among them.
  [[nodiscard]] solver::ModelFactors material_factors(const TwinState& state) const;
  /// The same on each part's contribution to the model's own outputs by expansion; 0 x 0 if all are one.
  [[nodiscard]] Eigen::MatrixXd expansion_factors(const TwinState& state) const;
  void set_places(const effects::HeatBalance& balance, Workspace& workspace) const;
  void set_matrices(const TwinState& state, Workspace& workspace) const;
  void set_laws(effects::HeatBalance balance, Workspace& workspace) const;
  void set_air(const effects::HeatBalance& balance, solver::ReducedSystem& system) const;
  /// The drive of a state in a run; its system is in the workspace.
  struct Driven {
    Cyclogram cyclogram;
    TimeSeries ambient;
    Eigen::VectorXd start;
  };
  [[nodiscard]] Driven drive(const TwinState& state, const MeasuredRun& run, Workspace& workspace) const;
  [[nodiscard]] Eigen::VectorXd start(const TimeSeries& ambient, const Workspace& workspace) const;
  /// The state after the drive before a run, in a constant ambient.
  [[nodiscard]] Eigen::VectorXd after(const Cyclogram& before, double ambient_K, const Eigen::VectorXd& start,
                                      Workspace& workspace) const;
  [[nodiscard]] Eigen::MatrixXd all_states(const TwinState& state, const MeasuredRun& run, Workspace& workspace,
                                           const solver::KeptStates* near) const;

  const AugmentedModel& augmented_;
  const scenarios::ReducedMachine& machine_;
  solver::TransientOptions tolerances_;
  TwinState as_written_;
  solver::Outputs outputs_;  ///< the model's own, then the mean temperature of each part with mass
};

}  // namespace driftwright::diagnosis
