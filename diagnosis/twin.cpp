// One class in one file: what a state of the twin changes in the reduced machine, which all its methods share.
#include "diagnosis/twin.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <stdexcept>

#include "base/errors.hpp"
#include "base/series_in_order.hpp"
#include "scenarios/reader/felt_run.hpp"
#include "solver/bind_laws.hpp"
#include "solver/exponential_run.hpp"
#include "solver/reduced_model.hpp"

namespace driftwright::diagnosis {
namespace {

using effects::make_effect;
using effects::Place;

constexpr double kExpectedHeat_W = 20.0;  // typical missing source; it sets the accuracy of the basis
constexpr double kExpectedFilm_W_m2K = 10.0;
constexpr double kTolerance_K = 0.1;     // with steps of everything that may be wrong at once, ten times the error of a run
constexpr double kWider = 2.0;           // factor on coefficients and powers that the basis covers
constexpr double kNoWayOut_1_s = 1e-14;  // lets an isolated node have a steady state

bool is_outer(const std::string& surface) {
  return surface.find('@') == std::string::npos;
}

/// Effects without action, one per place, that only tell the basis what to expect.
std::vector<effects::Effect> places(const mesh::Mesh& mesh, const effects::HeatBalance& own, double expected_W) {
  std::vector<effects::Effect> list;
  std::vector<effects::Body> bodies;
  for (const std::string& r : mesh.regions) bodies.push_back(effects::region(r));
  for (const effects::LumpedNode& n : own.nodes) bodies.push_back(effects::node(n.name));
  const auto has_exchange = [&](const effects::Effect& e) {
    const effects::Exchange asked = effects::heat_balance({e}).exchanges.front();
    return std::any_of(own.exchanges.begin(), own.exchanges.end(), [&](const auto& x) { return x.is_same_place(asked); });
  };
  for (const effects::Body& b : bodies) {
    list.push_back(make_effect("heat_source", b, {{"power", expected_W}}));
    const effects::Effect medium = make_effect("coolant", b, {{"flow", 1.0}, {"set_point", 293.15}});
    if (!has_exchange(medium)) list.push_back(medium);
    if (b.kind != effects::BodyKind::kNode) continue;
    effects::Effect link = make_effect("link", b);
    link.references["to"] = effects::ambient_node();
    if (!has_exchange(link)) list.push_back(link);
  }
  for (const std::string& s : mesh.surfaces) {
    if (!is_outer(s)) continue;
    list.push_back(make_effect("heat_source", Place::kSurface, s, {{"power", 0.5 * expected_W}}));
    if (effects::has_even_film(own, s)) continue;
    list.push_back(make_effect("convection", Place::kSurface, s, {{"film", kExpectedFilm_W_m2K}}));
    for (const effects::Exchange& x : own.exchanges) {  // a film from a file: what is added to it leads where it leads
      if (x.body == effects::surface(s) && x.per == effects::Per::kArea)
        list.back().references["surrounding"] = effects::node(x.surrounding);
    }
  }
  if (own.stratifications.empty() && mesh.n_nodes() > 0)
    list.push_back(make_effect("stratification", Place::kAmbient, effects::kAmbientName, {{"gradient", 1.0}}));
  return list;
}

AugmentedModel::Air air_of(const effects::HeatBalance& balance) {
  AugmentedModel::Air air;
  for (const effects::Stratification& s : balance.stratifications) {
    air.gradient_K_m += s.gradient_K_m;
    air.level_K += s.gradient_K_m * s.level_m;
  }
  return air;
}

double factor_of(const std::vector<effects::MaterialFactor>& factors, const effects::Body& body,
                 double effects::MaterialFactor::*member) {
  double product = 1.0;
  for (const effects::MaterialFactor& f : factors) {
    if (f.body == body) product *= f.*member;
  }
  return product;
}

}  // namespace

AugmentedModel augment(const scenarios::Scenario& scenario, const mesh::Mesh& mesh, const std::vector<MeasuredRun>& runs) {
  AugmentedModel a{.model = *scenario.machine, .plan = {}, .n_own_effects = scenario.machine->effects.size()};
  std::vector<effects::Effect>& list = a.model.effects;
  const effects::HeatBalance own = effects::with_radiation_as_films(effects::heat_balance(list));

  double top_rpm = 1.0;
  std::vector<const Cyclogram*> cyclograms;
  for (const Cyclogram& c : scenario.cyclograms) cyclograms.push_back(&c);
  for (const MeasuredRun& r : runs) cyclograms.push_back(&r.cyclogram);
  for (const Cyclogram* c : cyclograms) {
    for (const auto& s : c->sections) top_rpm = std::max(top_rpm, s.drive.speed_rpm);
  }
  double power_W = 0.0;
  for (const effects::HeatInput& h : own.heats) {
    if (h.power_W.probes.empty()) power_W += std::abs(h.power_W(effects::Inputs{.drive = {.speed_rpm = top_rpm}}));
  }
  const double expected_W = power_W > 0.0 ? std::min(kExpectedHeat_W, 0.25 * power_W) : kExpectedHeat_W;
  for (effects::Effect& e : places(mesh, own, expected_W)) list.push_back(std::move(e));

  // The conditions that the basis must cover: the measured cyclograms, the recorded ambients, and everything wrong by a
  // factor.
  scenarios::Scenario asked = scenario;
  asked.machine = a.model;
  for (const MeasuredRun& r : runs) {
    for (double v : r.ambient.value) asked.machine->ambient.value.push_back(v);
    for (std::size_t i = 0; i < r.ambient.value.size(); ++i)
      asked.machine->ambient.time_s.push_back(asked.machine->ambient.time_s.back() + 1.0);
  }
  a.plan = scenarios::reduction_plan(asked, cyclograms);
  a.plan.tolerance_K = std::max(a.plan.tolerance_K, kTolerance_K);
  a.plan.n_modes = 0;
  a.plan.with_fields = false;
  a.plan.with_parts = true;
  solver::ReductionDemand& d = a.plan.demand;
  const effects::HeatBalance all = effects::with_radiation_as_films(effects::heat_balance(list));
  a.air = air_of(all);
  for (std::size_t e = 0; e < all.exchanges.size(); ++e) {
    const auto i = static_cast<Eigen::Index>(e);
    const bool is_own = std::any_of(own.exchanges.begin(), own.exchanges.end(),
                                    [&](const auto& x) { return x.is_same_place(all.exchanges[e]); });
    d.low[i] = is_own ? d.low[i] / kWider : 0.0;
    d.high[i] *= kWider;
  }
  return a;
}

AugmentedModel without_further_places(const scenarios::MachineModel& model) {
  return {.model = model,
          .plan = {},
          .n_own_effects = model.effects.size(),
          .air = air_of(effects::heat_balance(model.effects))};
}

Twin::Workspace::Workspace(const Twin& twin) : system_(twin.machine_.system) {}

Twin::Twin(const AugmentedModel& augmented, const scenarios::ReducedMachine& machine, solver::TransientOptions tolerances)
    : augmented_(augmented), machine_(machine), tolerances_(tolerances), outputs_(machine.system.outputs) {
  const auto& all = augmented.model.effects;
  as_written_.assign(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(augmented.n_own_effects));
  for (const auto& part : machine.system.parts) {
    const Eigen::VectorXd heat = part.mass * machine.system.ones;  // ones: the state 1 K everywhere
    const double capacity_J_K = machine.system.ones.dot(heat);
    if (!(capacity_J_K > 0.0)) continue;
    const std::string name = effects::mean_output(part.body);
    if (std::find(outputs_.name.begin(), outputs_.name.end(), name) != outputs_.name.end())
      continue;  // only if an effect requires it
    outputs_.name.push_back(name);
    outputs_.unit.emplace_back("K");
    outputs_.state.conservativeResize(Eigen::NoChange, outputs_.state.cols() + 1);
    outputs_.state.rightCols<1>() = heat / capacity_J_K;
    outputs_.ambient.conservativeResize(outputs_.ambient.size() + 1);
    outputs_.ambient.tail<1>().setZero();
  }
}

effects::HeatBalance Twin::balance(const TwinState& state) const {
  return effects::with_radiation_as_films(effects::heat_balance(state));
}

effects::Body Twin::body_of(const std::string& part) const {
  const auto& regions = machine_.mesh.regions;
  if (std::find(regions.begin(), regions.end(), part) != regions.end()) return effects::region(part);
  for (const auto& source : machine_.system.sources) {
    if (source.body == effects::node(part)) return source.body;
  }
  return effects::surface(part);
}

std::vector<std::string> Twin::bodies_at(const std::string& surface_or_joint) const {
  const mesh::Mesh& mesh = machine_.mesh;
  if (const mesh::Joint* joint = mesh.joint(surface_or_joint)) {
    std::vector<std::string> bodies = bodies_at(joint->side_a);
    for (std::string& body : bodies_at(joint->side_b)) bodies.push_back(std::move(body));
    return bodies;
  }
  const int surface = mesh.surface(surface_or_joint);
  const std::vector<int> facets = surface < 0 ? std::vector<int>{} : mesh.facets_on(surface);
  if (facets.empty()) return {surface_or_joint};
  const auto facet = mesh.facets.nodes(facets.front());
  for (int cell = 0; cell < mesh.cells.size(); ++cell) {
    const auto nodes = mesh.cells.nodes(cell);
    const bool is_behind = std::all_of(facet.begin(), facet.end(),
                                       [&](int node) { return std::find(nodes.begin(), nodes.end(), node) != nodes.end(); });
    if (is_behind) return {mesh.regions[static_cast<std::size_t>(mesh.cells.group[static_cast<std::size_t>(cell)])]};
  }
  return {surface_or_joint};
}

Eigen::MatrixXd Twin::warmer_bodies() const {
  const auto& parts = machine_.system.parts;
  Eigen::MatrixXd heat(machine_.system.size(), static_cast<Eigen::Index>(parts.size()));
  for (std::size_t p = 0; p < parts.size(); ++p)
    heat.col(static_cast<Eigen::Index>(p)) = parts[p].mass * machine_.system.ones;  // ones: the state 1 K everywhere
  return machine_.system.mass.llt().solve(heat);
}

namespace {

/// The capacity that a list of effects gives a lumped node; 1 for another body.
double capacity_of_node(const TwinState& state, const std::string& body) {
  static const effects::EffectKind* const node = &effects::kind_of("node");
  const auto found =
      std::find_if(state.begin(), state.end(), [&](const effects::Effect& e) { return e.kind == node && e.place == body; });
  return found == state.end() ? 1.0 : (*found)["capacity"];
}

}  // namespace

solver::ModelFactors Twin::material_factors(const TwinState& state) const {
  const auto now = effects::material_factors(state), written = effects::material_factors(as_written_);
  solver::ModelFactors factors;
  for (const auto& part : machine_.system.parts) {
    const effects::Body body = now.empty() ? effects::Body{} : body_of(part.body);
    const auto of = [&](double effects::MaterialFactor::*member) {
      return factor_of(now, body, member) / factor_of(written, body, member);
    };
    factors.conductivity.push_back(of(&effects::MaterialFactor::conductivity));
    factors.heat_capacity.push_back(of(&effects::MaterialFactor::heat_capacity));
    factors.heat_capacity.back() *= capacity_of_node(state, part.body) / capacity_of_node(as_written_, part.body);
  }
  return factors;
}

Eigen::MatrixXd Twin::expansion_factors(const TwinState& state) const {
  const auto now = effects::material_factors(state), written = effects::material_factors(as_written_);
  if (now.empty()) return {};
  const auto& parts = machine_.system.parts;
  Eigen::MatrixXd factors =
      Eigen::MatrixXd::Ones(static_cast<Eigen::Index>(parts.size()), machine_.system.outputs.state.cols());
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const effects::Body body = body_of(parts[p].body);
    for (Eigen::Index o = 0; o < factors.cols(); ++o) {
      const std::string& name = outputs_.name[static_cast<std::size_t>(o)];
      factors(static_cast<Eigen::Index>(p), o) =
          effects::sensitivity_factor(now, body, name) / effects::sensitivity_factor(written, body, name);
    }
  }
  return factors;
}

void Twin::set_places(const effects::HeatBalance& balance, Workspace& workspace) const {
  solver::AddedPlaces added = solver::places_lacking(machine_.system, balance);
  if (added == workspace.added_) return;
  workspace.system_ = solver::with_places(machine_.system, added);
  workspace.added_ = std::move(added);
  workspace.factors_ = {};
  workspace.offsets_.clear();
  workspace.propagator_.reset();
}

void Twin::set_matrices(const TwinState& state, Workspace& workspace) const {
  solver::ModelFactors factors = material_factors(state);
  if (factors.conductivity == workspace.factors_.conductivity && factors.heat_capacity == workspace.factors_.heat_capacity)
    return;
  solver::ReducedSystem& system = workspace.system_;
  Eigen::MatrixXd conduction = machine_.system.conduction, mass = machine_.system.mass;
  solver::scale_matrices(conduction, mass, machine_.system.parts, factors.conductivity, factors.heat_capacity);
  system.conduction.topLeftCorner(conduction.rows(), conduction.cols()) = conduction;
  system.mass.topLeftCorner(mass.rows(), mass.cols()) = mass;
  workspace.factors_ = std::move(factors);
  workspace.propagator_.reset();
}

void Twin::set_air(const effects::HeatBalance& balance, solver::ReducedSystem& system) const {
  const AugmentedModel::Air& assembled = augmented_.air;
  if (assembled.gradient_K_m == 0.0) return;
  const AugmentedModel::Air now = air_of(balance);
  const double share =
      now.gradient_K_m / assembled.gradient_K_m;  // assembled + level: heats air to the recorded temperature at z = 0
  for (std::size_t e = 0; e < machine_.system.exchanges.size(); ++e) {
    const auto& of = machine_.system.exchanges[e];
    if (of.offset.size() == 0 || of.medium.size() > 0) continue;
    Eigen::VectorXd& offset = system.exchanges[e].offset;
    offset.setZero();
    offset.head(of.offset.size()) = share * (of.offset + assembled.level_K * of.to_ambient) - now.level_K * of.to_ambient;
    system.exchanges[e].offset_sum =
        share * (of.offset_sum + assembled.level_K * of.ambient_sum) - now.level_K * of.ambient_sum;
  }
  for (std::size_t p = 0; p < machine_.system.probes.size(); ++p) {
    const solver::Probe& of = machine_.system.probes[p];
    if (!of.before.empty()) system.probes[p].offset_K = share * (of.offset_K + assembled.level_K) - now.level_K;
  }
}

void Twin::set_laws(effects::HeatBalance balance, Workspace& workspace) const {
  solver::ReducedSystem& system = workspace.system_;
  std::sort(balance.change_times_s.begin(), balance.change_times_s.end());
  solver::bind_laws(system, balance);
  set_air(balance, system);
  std::vector<double> offsets;
  for (const auto& e : system.exchanges) offsets.push_back(e.offset_sum);
  if (offsets == workspace.offsets_) return;
  workspace.offsets_ = std::move(offsets);
  workspace.propagator_.reset();
}

namespace {

constexpr int kMostSteps = 100;     // to a steady state with laws of temperatures
constexpr double kAtRest_K = 1e-7;  // a smaller step is converged

/// Sets a law to its constant value at a state.
void hold(solver::BoundLaw& law, const solver::ReducedSystem& system, const Eigen::VectorXd& z, double ambient_K) {
  if (!law.looks_at_state()) return;
  law.frozen_K.clear();
  for (int p : law.probes)
    law.frozen_K.push_back(system.reference_K + system.probes[static_cast<std::size_t>(p)].theta_K(z, ambient_K));
  law.probes.clear();
}

/// The state at standstill in an ambient. Laws of temperatures are held at the result of the last step, until they no
/// longer change.
/// @param guess  start value, if there are such laws. @throws SolveError  if the steps do not converge
Eigen::VectorXd at_rest(const solver::ReducedSystem& system, const effects::Inputs& standstill, Eigen::Index n_added,
                        const Eigen::VectorXd& guess) {
  Eigen::VectorXd z = guess;
  for (int step = 0; step < kMostSteps; ++step) {
    solver::ReducedSystem held = system;
    for (auto& s : held.sources) hold(s.power_W, system, z, standstill.ambient_K);
    for (auto& e : held.exchanges) hold(e.coefficient, system, z, standstill.ambient_K);
    Eigen::MatrixXd k = held.conduction;
    for (const auto& e : held.exchanges) k += e.coefficient(standstill) * e.matrix;
    k.diagonal().tail(n_added).array() += kNoWayOut_1_s;
    const Eigen::VectorXd next = k.llt().solve(held.load(standstill));
    const double moved_K = (next - z).cwiseAbs().maxCoeff();
    if (!std::isfinite(moved_K)) break;
    z = step < kMostSteps / 4 ? next : Eigen::VectorXd(0.5 * (z + next));  // half the step, against oscillation
    if (moved_K < kAtRest_K || !system.looks_at_state()) return z;
  }
  throw SolveError("the machine has no state of rest to start from");
}

}  // namespace

Eigen::VectorXd Twin::start(const TimeSeries& ambient, const Workspace& workspace) const {
  const solver::ReducedSystem& system = workspace.system_;
  Eigen::VectorXd start = machine_.start;
  const double ambient_at_start_K = ambient.at(0.0);
  const bool is_steady = augmented_.model.start == scenarios::Start::kSteady && system.thermostats.empty();
  if (augmented_.model.start == scenarios::Start::kAmbient) start = ambient_at_start_K * machine_.system.ones;
  if (augmented_.model.start == scenarios::Start::kSteady)  // with thermostats as written, shifted with the ambient
    start += (ambient_at_start_K - scenarios::felt_ambient_at_start_K(augmented_.model)) * machine_.system.ones;
  if (!is_steady) return solver::with_places(start, machine_.system, workspace.added_);
  const effects::Inputs standstill{.drive = {},
                                   .ambient_K = ambient_at_start_K};  // before the run: its events do not act yet
  return at_rest(system, standstill, static_cast<Eigen::Index>(workspace.added_.nodes.size()),
                 solver::with_places(start, machine_.system, workspace.added_));
}

Twin::Driven Twin::drive(const TwinState& state, const MeasuredRun& run, Workspace& workspace) const {
  const auto acts = [&](const effects::Effect& e) { return e.acts_in(run.name); };
  TwinState some;
  const bool all_act = std::all_of(state.begin(), state.end(), acts);
  if (!all_act) std::copy_if(state.begin(), state.end(), std::back_inserter(some), acts);
  effects::HeatBalance now = balance(all_act ? state : some);
  set_places(now, workspace);
  set_matrices(state, workspace);
  set_laws(std::move(now), workspace);
  const effects::DriveChange change = effects::drive_change(state, run.name);
  Driven d{.cyclogram = effects::true_cyclogram(change, run.cyclogram), .ambient = {}, .start = {}};
  d.ambient = effects::true_ambient(change, run.ambient, d.cyclogram);
  d.cyclogram.name = run.name;
  d.start = start(d.ambient, workspace);
  if (const Cyclogram before = effects::driven_before(change, d.cyclogram); !before.sections.empty())
    d.start = after(before, d.ambient.at(0.0), d.start, workspace);
  if (run.start_K.size() > 0)  // the first readings hold for t = 0
    d.start += solver::with_places(warmer_bodies() * run.start_K, machine_.system, workspace.added_);
  return d;
}

Eigen::VectorXd Twin::after(const Cyclogram& before, double ambient_K, const Eigen::VectorXd& start,
                            Workspace& workspace) const {
  const TimeSeries ambient{{0.0}, {ambient_K}};
  const std::vector<double> end_s = {before.duration_s()};
  Eigen::MatrixXd states;
  if (workspace.system_.is_linear())
    (void)workspace.propagator().run(before, ambient, end_s, start, false, &states);
  else
    states = solver::states_of_run(workspace.system_, before, ambient, end_s, tolerances_, start);
  return states.rightCols<1>();
}

Twin::Bound Twin::bound(const TwinState& state, const MeasuredRun& run, Workspace& workspace) const {
  Driven d = drive(state, run, workspace);
  Eigen::MatrixXd weights = outputs_.state;
  solver::scale_expansion(weights, machine_.system.parts, expansion_factors(state));
  return {workspace.system_, std::move(d.cyclogram), std::move(d.ambient), std::move(weights), std::move(d.start)};
}

std::shared_ptr<const solver::KeptStates> Twin::kept_run(const TwinState& state, const MeasuredRun& run,
                                                         Workspace& workspace, bool for_slopes) const {
  const auto shared = [](auto kept) -> std::shared_ptr<const solver::KeptStates> {
    using Kept = typename decltype(kept)::value_type;
    return kept ? std::make_shared<const Kept>(*std::move(kept)) : nullptr;
  };
  const Driven d = drive(state, run, workspace);
  if (workspace.system_.is_linear())
    return for_slopes ? shared(workspace.propagator().course(d.cyclogram, d.ambient, run.grid_s, d.start)) : nullptr;
  return shared(solver::KeptSteps::of(workspace.system_, d.cyclogram, d.ambient, run.grid_s, tolerances_, d.start));
}

Eigen::MatrixXd Twin::states(const TwinState& state, const MeasuredRun& run, Workspace& workspace,
                             const solver::KeptStates* near) const {
  return all_states(state, run, workspace, near).topRows(machine_.system.size());
}

Eigen::MatrixXd Twin::all_states(const TwinState& state, const MeasuredRun& run, Workspace& workspace,
                                 const solver::KeptStates* near) const {
  auto [felt, ambient, from] = drive(state, run, workspace);
  solver::ReducedSystem& system = workspace.system_;
  if (near && near->states().rows() == system.size()) {
    if (auto close = near->states_of(system, felt, ambient, from)) return *std::move(close);
  }
  Eigen::MatrixXd states;
  if (system.is_linear()) {
    (void)workspace.propagator().run(felt, ambient, run.grid_s, from, false, &states);
    return states;
  }
  return solver::states_of_run(system, felt, ambient, run.grid_s, tolerances_, from);
}

Eigen::MatrixXd Twin::respond(const TwinState& state, const MeasuredRun& run, Workspace& workspace,
                              const solver::KeptStates* near) const {
  return outputs_of(state, run, states(state, run, workspace, near));
}

Eigen::MatrixXd Twin::outputs_of(const TwinState& state, const MeasuredRun& run,
                                 const Eigen::Ref<const Eigen::MatrixXd>& states) const {
  Eigen::MatrixXd weights = outputs_.state;
  solver::scale_expansion(weights, machine_.system.parts, expansion_factors(state));
  Eigen::MatrixXd outputs = weights.transpose() * states.topRows(machine_.system.size());
  if ((outputs_.ambient.array() == 0.0).all()) return outputs;
  const effects::DriveChange change = effects::drive_change(state, run.name);
  const TimeSeries ambient = effects::true_ambient(change, run.ambient, effects::true_cyclogram(change, run.cyclogram));
  SeriesInOrder ambient_K(ambient);
  for (std::size_t k = 0; k < run.grid_s.size(); ++k) {
    outputs.col(static_cast<Eigen::Index>(k)) += ambient_K.at(run.grid_s[k]) * outputs_.ambient;
  }
  return outputs;
}

Eigen::MatrixXd Twin::read(const TwinState& state, const MeasuredRun& run, Eigen::MatrixXd outputs) const {
  const effects::ReadingChain chain = effects::reading_chain(state, run.name);
  if (!chain.empty()) {
    const effects::DriveChange change = effects::drive_change(state, run.name);
    const Cyclogram felt = effects::true_cyclogram(change, run.cyclogram);
    const TimeSeries ambient = effects::true_ambient(change, run.ambient, felt);
    outputs = chain.apply(outputs_.name, outputs_.unit, run.grid_s, felt, ambient, std::move(outputs));
  }
  Eigen::MatrixXd rows(outputs.rows(), static_cast<Eigen::Index>(run.row_in_grid.size()));
  for (Eigen::Index i = 0; i < rows.cols(); ++i) rows.col(i) = outputs.col(run.row_in_grid[static_cast<std::size_t>(i)]);
  return rows;
}

}  // namespace driftwright::diagnosis
