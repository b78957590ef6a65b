#pragma once
// One thermal system, two sizes. The finite-element model (sparse) and its reduced model (dense) are both
//
//     M dθ/dt = -K(u) θ + f(u) - r(θ),   y = L'θ + l_ambient θ_ambient
//     K(u) = K0 + Σ_e c_e(u) G_e,  f(u) = Σ_s P_s(u) b_s + Σ_e c_e(u) (θ_ambient g_e + o_e),   g_e = G_e 1
//
// θ: temperature minus the reference temperature [K]. u: effects::Inputs. Everything that may change (films, joints, links)
// is an Exchange with a fixed matrix and a coefficient that is a number: nothing is assembled twice. Coefficients may depend
// on mean temperatures (probes) of the state. r(θ) exists in the full model only; it contains everything that a coefficient
// cannot express.

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "effects/heat_balance.hpp"
#include "solver/nonlinear_term.hpp"
#include "solver/sparse.hpp"
#include "solver/variable_material.hpp"

namespace driftwright::solver {

/// A law whose probes and thermostat are indices into the system's lists.
struct BoundLaw {
  effects::Law law;
  std::vector<int> probes;
  int thermostat = -1;
  std::vector<double> frozen_K = {};  ///< temperatures given to a law in place of its probes (freeze_laws())
  /// Of linearise(): the law is evaluated at frozen_K + spread_K and at frozen_K - spread_K; empty: at frozen_K alone.
  std::vector<double> spread_K = {};
  /// 0: the value is the mean of both. Otherwise it is their difference, the lower minus the upper, over this change of
  /// temperature [K]: the conductance that a power has because it falls with temperature.
  double slope_over_K = 0.0;

  BoundLaw() = default;
  BoundLaw(effects::Law free_law) : law(std::move(free_law)) {}  // NOLINT: a law without probes is bound as it is
  template <class F>
  requires(std::is_invocable_r_v<double, F, const effects::Inputs&> && !std::is_same_v<std::remove_cvref_t<F>, BoundLaw> &&
           !std::is_same_v<std::remove_cvref_t<F>, effects::Law>) BoundLaw(F function)
      : law(std::move(function)) {}  // NOLINT
  [[nodiscard]] bool looks_at_state() const { return !probes.empty(); }
  /// The value of a law without probes. @throws std::logic_error  for one that has them
  double operator()(const effects::Inputs& u) const;
};

/// Heat P(u) [W] distributed over the unknowns by b (sums to one in the finite-element model).
struct HeatSource {
  std::string name;
  effects::Body body = {};
  Eigen::VectorXd load;
  BoundLaw power_W;
};

/// The place of an exchange, in terms of the machine.
struct ExchangePlace {
  effects::Body body;
  std::string surrounding;  ///< ambient or lumped node; "" for a joint and for a medium with its own temperature
  effects::Per per = effects::Per::kArea;
  std::string part = {};  ///< pattern of a film that differs from place to place (FieldPart::id); "": an even film
  bool operator==(const ExchangePlace&) const = default;
};
[[nodiscard]] ExchangePlace place_of(const effects::Exchange& exchange);

/// Heat flow c(u) G θ between unknowns, or from them to the ambient where G 1 != 0.
template <class Matrix>
struct Exchange {
  std::string name;
  ExchangePlace place = {};
  Matrix matrix;               ///< G, symmetric, in [m^2] for films and joints and [1] for links
  Eigen::VectorXd to_ambient;  ///< g = G 1 of the finite-element model (projected in a reduced one)
  double ambient_sum = 0.0;    ///< 1'G 1: surface exposed to the ambient [m^2]
  BoundLaw coefficient;        ///< c(u) [W/(m^2 K)], or [W/K] for links
  /// The exchanged heat is c (flow'θ - ambient_sum θ_ambient - 1'o): out of the surface or body, or from side a to side b.
  Eigen::VectorXd flow = {};
  Eigen::VectorXd offset = {};  ///< o: ∫ N_i (T_air(z) - T_ambient) dA where the ambient is stratified, else empty [m^2 K]
  double offset_sum = 0.0;      ///< 1'o of the finite-element model
  /// Of an exchange with a medium: G 1; o is this times the medium's temperature, or of a pattern ∫ N_i h (T_air - T_ref)
  /// dA.
  /// Else empty.
  Eigen::VectorXd medium = {};
  double medium_sum = 0.0;  ///< 1'G 1
  bool prescribes = false;  ///< it replaces a prescribed temperature (hold_by_exchanges())
  int slope_of = -1;        ///< index of the source whose power over temperature it contains (linearise()); -1: none

  [[nodiscard]] bool reaches_ambient() const { return ambient_sum != 0.0; }
  /// True for an exchange with the ambient or with a medium of fixed temperature.
  [[nodiscard]] bool leaves_machine() const { return ambient_sum != 0.0 || medium_sum != 0.0; }
  /// Sets the temperature of a medium above the reference [K]; for an exchange with a medium.
  void hold_medium(double theta_K) {
    offset = theta_K * medium;
    offset_sum = theta_K * medium_sum;
  }
};

/// A mean temperature that laws and thermostats use: weights'θ + ambient_share θ_ambient + offset + the reference
/// temperature.
struct Probe {
  effects::Body body = {};
  std::string before = {};  ///< in stratified air: the surface whose air it measures; else ""
  Eigen::VectorXd weights;
  double ambient_share = 0.0;
  double offset_K = 0.0;  ///< mean excess of stratified air before a surface over the ambient thermometer
  [[nodiscard]] double theta_K(const Eigen::VectorXd& theta, double ambient_K) const {
    return weights.dot(theta) + ambient_share * ambient_K + offset_K;
  }
};

struct Thermostat {
  std::string name;
  int probe = -1;
  double on_above_K = 0.0, off_below_K = 0.0;  ///< absolute
};

/// Unknowns with a prescribed temperature.
struct FixedUnknowns {
  std::string name;
  std::vector<int> unknowns;
  TimeSeries theta;  ///< minus the reference temperature [K]
  bool follows_ambient = false;
};

/// The contribution of one region or lumped node to the system: M and K0 are sums over them. To change a material, factors f
/// on conductivity and g on heat capacity give K0 + (f - 1) conduction and M + (g - 1) mass.
template <class Matrix>
struct BodyPart {
  std::string body;
  Matrix conduction, mass;
  Eigen::MatrixXd outputs;  ///< contribution of its expansion to the outputs, n_unknowns x n_outputs
};

/// The outputs of a state: sensor temperatures, displacements, tilts. Column j of `state` is output j.
struct Outputs {
  std::vector<std::string> name;
  std::vector<std::string> unit;  ///< "K", "m" or "rad"
  Eigen::MatrixXd state;          ///< n_unknowns x n_outputs
  Eigen::VectorXd ambient;        ///< n_outputs; share of the ambient temperature
};

class Share;

/// The whole system, full or reduced.
template <class Matrix>
struct ThermalSystem {
  double reference_K = 293.15;
  Matrix mass;        ///< M [J/K]
  Matrix conduction;  ///< K0 [W/K]
  std::vector<HeatSource> sources;
  std::vector<Exchange<Matrix>> exchanges;
  std::vector<Probe> probes;
  std::vector<Thermostat> thermostats;
  std::vector<double> change_times_s;  ///< times at which laws may jump
  // The next three exist in the full model only; a reduced model is made from a system without them. Terms are shared,
  // because systems are often copied and terms never change.
  std::vector<std::shared_ptr<const NonlinearTerm>> nonlinear;
  std::shared_ptr<const VariableCapacity> capacity;  ///< addition to M where heat capacity varies; may be null
  std::vector<FixedUnknowns> fixed;
  Outputs outputs;
  std::vector<BodyPart<Matrix>> parts;  ///< empty unless requested
  Eigen::VectorXd ones;  ///< the state "1 K everywhere" (projected in a reduced system), for the energy balance
  /// Of a machine that several processes compute: this system is the part of this process. Its matrices and vectors are
  /// additive (share.hpp), except `ones`, which is of the whole machine as all states outside of the solver. Else null.
  std::shared_ptr<const Share> share = nullptr;

  [[nodiscard]] int size() const { return static_cast<int>(mass.rows()); }

  /// True if all coefficients depend on drive and time alone and no unknown is prescribed: f(u) and K(u) then describe the
  /// system completely.
  [[nodiscard]] bool is_linear() const {
    return nonlinear.empty() && !capacity && fixed.empty() && thermostats.empty() && !looks_at_state();
  }

  /// True if some law depends on the state.
  [[nodiscard]] bool looks_at_state() const {
    for (const HeatSource& s : sources) {
      if (s.power_W.looks_at_state()) return true;
    }
    for (const auto& e : exchanges) {
      if (e.coefficient.looks_at_state()) return true;
    }
    return false;
  }
  /// True if the ambient air has a gradient.
  [[nodiscard]] bool is_stratified() const {
    for (const auto& e : exchanges) {
      if (e.offset.size() > 0) return true;
    }
    return false;
  }

  /// f(u) [W] of a linear system.
  [[nodiscard]] Eigen::VectorXd load(const effects::Inputs& u) const {
    Eigen::VectorXd f = Eigen::VectorXd::Zero(size());
    for (const HeatSource& s : sources) f += s.power_W(u) * s.load;
    for (const auto& e : exchanges) {
      if (e.reaches_ambient()) f += e.coefficient(u) * u.ambient_K * e.to_ambient;
      if (e.offset.size() > 0) f += e.coefficient(u) * e.offset;
    }
    return f;
  }
  /// Outputs of a state.
  [[nodiscard]] Eigen::VectorXd observe(const Eigen::VectorXd& state, double ambient_K) const {
    return outputs.state.transpose() * state + ambient_K * outputs.ambient;
  }
};

using FullSystem = ThermalSystem<SparseRow>;
using ReducedSystem = ThermalSystem<Eigen::MatrixXd>;

/// Kind of a heat flow.
enum class FlowKind {
  kSource,       ///< > 0 heats the machine
  kSurrounding,  ///< film, link or radiation to the ambient; > 0 heats the machine
  kPrescribed,   ///< through unknowns of prescribed temperature; > 0 heats the machine
  kInternal,     ///< within the machine: out of a surface into a lumped node, or from side a of a joint to side b
};
struct HeatFlow {
  std::string name;
  FlowKind kind = FlowKind::kSource;
  bool continues = false;  ///< a further pattern of the film before it, which differs from place to place: one flow in parts
};

/// A violation of the bounds that conduction obeys: an undershoot of the consistent mass matrix beside a jump.
struct Overshoot {
  double jump_s = 0.0;    ///< time of the jump that caused it
  double time_s = 0.0;    ///< time of its maximum
  double amount_K = 0.0;  ///< beyond the bound, > 0
  int unknown = -1;
};

/// A simulated run: outputs at the requested times, and the heat that flowed.
struct Trajectory {
  std::vector<double> time_s;
  Eigen::MatrixXd outputs;  ///< n_outputs x n_times, in K, m, rad
  std::vector<HeatFlow> flows;
  Eigen::MatrixXd heat_J;             ///< heat since the start state [J], n_flows x n_times; zero at t = 0
  Eigen::VectorXd stored_J;           ///< change of the stored heat since the start state, per time
  std::vector<Overshoot> overshoots;  ///< one per jump that caused one

  int n_steps = 0, n_solves = 0, n_iterations = 0;

  /// |heat in - stored| at the last time over half the sum of the magnitudes of all flows across the boundary [-].
  [[nodiscard]] double energy_gap() const;
};

}  // namespace driftwright::solver
