#pragma once
// A reduced machine that answers for any state of doubt: one basis for all of them.

#include <memory>

#include "diagnosis/knob.hpp"
#include "diagnosis/measured_run.hpp"
#include "machine/reduced_machine.hpp"
#include "solver/added_places.hpp"
#include "solver/model_factors.hpp"
#include "solver/propagator.hpp"

namespace driftwright::diagnosis {

/// The scenario's machine with the places that a diagnosis may add something at: heat in each region, node and surface, films where there are
/// none, a medium along each body, a way from each node to the ambient, stratified air. Its reduced model holds for laws at all of them. Bodies and
/// paths between them that a state has beside these are added to the reduced system as they come (solver/added_places.hpp).
struct AugmentedModel {
  scenarios::MachineModel model;
  scenarios::ReductionPlan plan;
  std::size_t n_own_effects = 0;  ///< the scenario's, first in the list
  /// Air of the ambient as the reduced machine was assembled with it: level_K less than its gradient times the height over z = 0.
  struct Air {
    double gradient_K_m = 0.0, level_K = 0.0;
  } air = {};
};
/// @param mesh  the machine's, for the names of its regions and surfaces
[[nodiscard]] AugmentedModel augment(const scenarios::Scenario& scenario, const mesh::Mesh& mesh,
                                     const std::vector<MeasuredRun>& runs);

/// Predicts readings. Const and shared by threads; each brings a Workspace.
class Twin {
 public:
  Twin(const AugmentedModel& augmented, const scenarios::ReducedMachine& machine, solver::TransientOptions tolerances);

  /// Systems and decompositions that one thread changes and keeps.
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
    solver::ModelFactors factors_;  ///< of conductivities and capacities that system_ has
    std::vector<double> offsets_;   ///< of its exchanges: air and media
    solver::AddedPlaces added_;     ///< what it has beyond the machine's
    std::unique_ptr<solver::Propagator> propagator_;
  };

  /// The scenario as it stands.
  [[nodiscard]] const TwinState& as_written() const { return as_written_; }
  [[nodiscard]] std::size_t n_own_effects() const { return as_written_.size(); }
  /// Reduced states of the machine at a run's grid, size x n_grid.
  /// @throws SolveError  where a state has no solution
  [[nodiscard]] Eigen::MatrixXd states(const TwinState& state, const MeasuredRun& run, Workspace& workspace,
                                       const solver::KeptRun* near = nullptr) const;
  /// Outputs of the machine at a run's grid, n_outputs x n_grid [K over the reference, m, rad]: the model's own, then the mean temperatures
  /// of its regions and nodes.
  /// @param near  unless null, kept_run() of a state close by: what that answers is enough
  /// @throws SolveError  where a state has no solution
  [[nodiscard]] Eigen::MatrixXd respond(const TwinState& state, const MeasuredRun& run, Workspace& workspace,
                                        const solver::KeptRun* near = nullptr) const;
  /// What states near this one are answered from; null where there is nothing of that sort.
  /// @param for_slopes  what answers to first order will do
  [[nodiscard]] std::shared_ptr<const solver::KeptRun> kept_run(const TwinState& state, const MeasuredRun& run,
                                                                Workspace& workspace, bool for_slopes = true) const;
  /// What its instruments say of them at the run's rows, n_outputs x n_times.
  [[nodiscard]] Eigen::MatrixXd read(const TwinState& state, const MeasuredRun& run, Eigen::MatrixXd outputs) const;

  /// A state's machine in a run with its laws bound: what a little more heat would do to it.
  struct Bound {
    const solver::ReducedSystem& system;  ///< the workspace's, until that is used again
    Cyclogram cyclogram;                  ///< the true ones
    TimeSeries ambient;
    Eigen::MatrixXd outputs;  ///< what outputs() have of the reduced state, size x n_outputs, by this state's expansion
    Eigen::VectorXd start;    ///< reduced state at the run's beginning, places that this state adds behind it
  };
  [[nodiscard]] Bound bound(const TwinState& state, const MeasuredRun& run, Workspace& workspace) const;

  [[nodiscard]] const solver::Outputs& outputs() const { return outputs_; }
  [[nodiscard]] double reference_K() const { return machine_.system.reference_K; }
  [[nodiscard]] const scenarios::ReducedMachine& machine() const { return machine_; }
  [[nodiscard]] const AugmentedModel& augmented() const { return augmented_; }
  /// States of each part of the machine 1 K warmer than the rest, size x n_parts; in a reduced model as near as its basis comes.
  [[nodiscard]] Eigen::MatrixXd warmer_bodies() const;
  /// What a state does to heat, radiation as films.
  [[nodiscard]] effects::HeatBalance balance(const TwinState& state) const;
  /// What a part of the machine is.
  [[nodiscard]] effects::Body body_of(const std::string& part) const;
  /// Names of the bodies that a surface bounds, or that a joint joins; its own name where the mesh does not tell.
  [[nodiscard]] std::vector<std::string> bodies_at(const std::string& surface_or_joint) const;

 private:
  /// Factors of a state over those as written, on conductivity and heat capacity of each part.
  [[nodiscard]] solver::ModelFactors material_factors(const TwinState& state) const;
  /// And on what each part's expansion has of each of the model's own outputs; 0 x 0 for ones.
  [[nodiscard]] Eigen::MatrixXd expansion_factors(const TwinState& state) const;
  void set_places(const effects::HeatBalance& balance, Workspace& workspace) const;
  void set_matrices(const TwinState& state, Workspace& workspace) const;
  void set_laws(effects::HeatBalance balance, Workspace& workspace) const;
  void set_air(const effects::HeatBalance& balance, solver::ReducedSystem& system) const;
  /// What drives a state in a run: its system in the workspace, what it is told, where it starts.
  struct Driven {
    Cyclogram cyclogram;
    TimeSeries ambient;
    Eigen::VectorXd start;
  };
  [[nodiscard]] Driven drive(const TwinState& state, const MeasuredRun& run, Workspace& workspace) const;
  [[nodiscard]] Eigen::VectorXd start(const TimeSeries& ambient, const Workspace& workspace) const;
  /// The state at the end of what drove the machine before a run, in one ambient.
  [[nodiscard]] Eigen::VectorXd after(const Cyclogram& before, double ambient_K, const Eigen::VectorXd& start,
                                      Workspace& workspace) const;
  [[nodiscard]] Eigen::MatrixXd all_states(const TwinState& state, const MeasuredRun& run, Workspace& workspace,
                                           const solver::KeptRun* near) const;

  const AugmentedModel& augmented_;
  const scenarios::ReducedMachine& machine_;
  solver::TransientOptions tolerances_;
  TwinState as_written_;
  solver::Outputs outputs_;  ///< the model's own, then the mean temperature of each part with mass
};

}  // namespace driftwright::diagnosis
