#include "diagnosis/twin.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "effects/time_window.hpp"
#include "scenarios/as_recorded.hpp"
#include "solver/reduced_model.hpp"
#include "solver/reduced_transient.hpp"

namespace driftwright::diagnosis {
namespace {

using effects::Inputs;
using effects::Law;

constexpr double kExpectedHeat_W = 20.0;  // a missing source is about so strong: how finely the basis must know it
constexpr double kExpectedFilm_W_m2K = 10.0;
constexpr double kTolerance_K =
    0.1;                        // with everything that may be wrong stepping at once, which is ten times what a run does
constexpr double kWider = 2.0;  // coefficients and powers may be wrong by this and more

const effects::EffectKind& kind_of(const std::string& key) {
  for (const effects::EffectKind& k : effects::catalogue()) {
    if (k.key == key) return k;
  }
  throw std::logic_error("no effect " + key);
}

/// An effect of a kind with its fallback values, some of them given.
effects::Effect dormant(const std::string& key, effects::Place place_kind, const std::string& place,
                        const std::vector<std::pair<std::string, double>>& given) {
  effects::Effect e{.kind = &kind_of(key), .place_kind = place_kind, .place = place};
  for (const effects::Parameter& p : e.kind->parameters) {
    const auto found = std::find_if(given.begin(), given.end(), [&](const auto& g) { return g.first == p.name; });
    e.values.push_back(found != given.end() ? found->second : p.fallback.value_or(0.0));
  }
  for (const effects::Reference& r : e.kind->references) {
    if (r.fallback && !r.fallback->empty()) e.references[r.name] = {r.kinds.front(), *r.fallback};
  }
  for (const effects::Choice& c : e.kind->choices) {
    if (c.fallback) e.words[c.name] = *c.fallback;
  }
  return e;
}

bool is_outer(const std::string& surface) {
  return surface.find('@') == std::string::npos;
}

/// Laws of exchanges in the order of the reduced system.
std::vector<std::pair<std::string, Law*>> exchange_laws(effects::HeatBalance& balance) {
  std::vector<std::pair<std::string, Law*>> laws;
  for (effects::Film& f : balance.films) laws.emplace_back(f.name, &f.htc_W_m2K);
  for (effects::Link& l : balance.links) laws.emplace_back(l.name, &l.conductance_W_K);
  for (effects::Contact& c : balance.contacts) laws.emplace_back(c.name, &c.conductance_W_m2K);
  return laws;
}

double heat_of(const std::vector<effects::HeatInput>& own, const effects::Body& body, const Inputs& u) {
  double sum_W = 0.0;
  for (const effects::HeatInput& h : own) {
    if (h.body == body && h.power_W.probes.empty()) sum_W += h.power_W(u);
  }
  return sum_W;
}

Law added_law(const AddedHeat& heat, const std::vector<effects::HeatInput>& own) {
  switch (heat.shape) {
    case AddedHeat::Shape::kConstant:
      return [p = heat.power_W](const Inputs&) { return p; };
    case AddedHeat::Shape::kPower:
      return [heat](const Inputs& u) {
        return u.drive.speed_rpm > 0.0 ? heat.power_W * std::pow(u.drive.speed_rpm / heat.at_speed_rpm, heat.exponent) : 0.0;
      };
    case AddedHeat::Shape::kAsWritten: {
      const double at_W = heat_of(own, heat.body, {.drive = {.speed_rpm = heat.at_speed_rpm}});
      return [heat, own, at_W](const Inputs& u) { return heat.power_W * heat_of(own, heat.body, u) / at_W; };
    }
    case AddedHeat::Shape::kPeriodic:
      return [heat](const Inputs& u) {
        return heat.mean_W + heat.power_W * std::sin(2.0 * std::numbers::pi * (u.time_s - heat.delay_s) / heat.period_s);
      };
    case AddedHeat::Shape::kFeed:
      return [heat](const Inputs& u) {
        const auto& f = u.drive.feed_m_s;
        return heat.power_W * (f[0] + f[1] + f[2]) / heat.at_feed_m_s;
      };
  }
  throw std::logic_error("added_law: no such shape");
}

}  // namespace

AugmentedModel augment(const scenarios::Scenario& scenario, const mesh::Mesh& mesh, const std::vector<MeasuredRun>& runs) {
  AugmentedModel a{.model = *scenario.machine, .plan = {}, .n_own_effects = scenario.machine->effects.size()};
  std::vector<effects::Effect>& list = a.model.effects;
  const effects::HeatBalance own = scenarios::reducible(effects::heat_balance(list));
  a.has_own_gradient = !own.stratifications.empty();

  double top_rpm = 1.0;
  std::vector<const Cyclogram*> cyclograms;
  for (const Cyclogram& c : scenario.cyclograms) cyclograms.push_back(&c);
  for (const MeasuredRun& r : runs) cyclograms.push_back(&r.cyclogram);
  for (const Cyclogram* c : cyclograms) {
    for (const auto& s : c->sections) top_rpm = std::max(top_rpm, s.drive.speed_rpm);
  }
  double power_W = 0.0;
  for (const effects::HeatInput& h : own.heats) {
    if (h.power_W.probes.empty()) power_W += std::abs(h.power_W(Inputs{.drive = {.speed_rpm = top_rpm}}));
  }
  const double expected_W = power_W > 0.0 ? std::min(kExpectedHeat_W, 0.25 * power_W) : kExpectedHeat_W;

  std::vector<effects::Body> bodies;
  for (const std::string& r : mesh.regions) bodies.push_back(effects::region(r));
  for (const effects::LumpedNode& n : own.nodes) bodies.push_back(effects::node(n.name));
  for (const effects::Body& b : bodies) {
    const auto place = b.kind == effects::BodyKind::kNode ? effects::Place::kNode : effects::Place::kRegion;
    list.push_back(dormant("heat_source", place, b.name, {{"power", expected_W}}));
    const bool rubs = std::any_of(own.heats.begin(), own.heats.end(), [&](const auto& h) { return h.body == b; });
    if (rubs) list.push_back(dormant("friction_law", place, b.name, {{"power", 0.0}, {"decay", 0.01}}));
  }
  for (const std::string& s : mesh.surfaces) {
    if (!is_outer(s)) continue;
    list.push_back(dormant("heat_source", effects::Place::kSurface, s, {{"power", 0.5 * expected_W}}));
    const bool has_film = std::any_of(own.films.begin(), own.films.end(), [&](const auto& f) { return f.surface == s; });
    if (!has_film) list.push_back(dormant("convection", effects::Place::kSurface, s, {{"film", kExpectedFilm_W_m2K}}));
  }
  if (!a.has_own_gradient && mesh.n_nodes() > 0) {
    list.push_back(dormant("stratification", effects::Place::kHall, effects::kHallName, {{"gradient", 1.0}}));
  }

  // What the basis is asked for: the measured cyclograms, halls as warm as recorded, everything wrong by a factor.
  scenarios::Scenario asked = scenario;
  asked.machine = a.model;
  for (const MeasuredRun& r : runs) {
    for (double v : r.hall.value) asked.machine->hall.value.push_back(v);
    for (std::size_t i = 0; i < r.hall.value.size(); ++i)
      asked.machine->hall.time_s.push_back(asked.machine->hall.time_s.back() + 1.0);
  }
  a.plan = scenarios::reduction_plan(asked, cyclograms);
  a.plan.tolerance_K = std::max(a.plan.tolerance_K, kTolerance_K);
  a.plan.n_modes = 0;
  a.plan.with_fields = false;
  a.plan.with_parts = true;
  solver::ReductionDemand& d = a.plan.demand;
  const effects::HeatBalance all = scenarios::reducible(effects::heat_balance(list));
  for (std::size_t e = 0; e < static_cast<std::size_t>(d.low.size()); ++e) {
    const auto i = static_cast<Eigen::Index>(e);
    const bool is_own_film = e < own.films.size();
    d.low[i] = e < all.films.size() && !is_own_film ? 0.0 : d.low[i] / kWider;
    d.high[i] *= kWider;
  }
  return a;
}

Twin::Workspace::Workspace(const Twin& twin) : system_(twin.machine_.system) {}

Twin::Twin(const AugmentedModel& augmented, const scenarios::ReducedMachine& machine, solver::TransientOptions tolerances)
    : augmented_(augmented), machine_(machine), tolerances_(tolerances), outputs_(machine.system.outputs) {
  as_written_.effects = augmented.model.effects;
  for (const auto& part : machine.system.parts) {
    const Eigen::VectorXd heat = part.mass * machine.system.ones;  // ones: the state 1 K everywhere
    const double capacity_J_K = machine.system.ones.dot(heat);
    if (!(capacity_J_K > 0.0)) continue;
    outputs_.name.push_back("mean of " + part.body);
    outputs_.unit.emplace_back("K");
    outputs_.state.conservativeResize(Eigen::NoChange, outputs_.state.cols() + 1);
    outputs_.state.rightCols<1>() = heat / capacity_J_K;
    outputs_.hall.conservativeResize(outputs_.hall.size() + 1);
    outputs_.hall.tail<1>().setZero();
  }
}

effects::HeatBalance Twin::balance(const TwinState& state) const {
  const std::vector<effects::Effect> own(state.effects.begin(),
                                         state.effects.begin() + static_cast<std::ptrdiff_t>(augmented_.n_own_effects));
  return scenarios::reducible(effects::heat_balance(own));
}

Eigen::MatrixXd Twin::warmer_bodies() const {
  const auto& parts = machine_.system.parts;
  Eigen::MatrixXd heat(machine_.system.size(), static_cast<Eigen::Index>(parts.size()));
  for (std::size_t p = 0; p < parts.size(); ++p)
    heat.col(static_cast<Eigen::Index>(p)) = parts[p].mass * machine_.system.ones;  // ones: the state 1 K everywhere
  return machine_.system.mass.llt().solve(heat);
}

effects::DriveChange Twin::drive(const TwinState& state) const {
  effects::DriveChange both = effects::drive_change(state.effects);
  both.speed_factor *= state.drive.speed_factor;
  both.stops.insert(both.stops.end(), state.drive.stops.begin(), state.drive.stops.end());
  both.hall.insert(both.hall.end(), state.drive.hall.begin(), state.drive.hall.end());
  return both;
}

effects::ReadingChain Twin::chain(const TwinState& state) const {
  effects::ReadingChain both = effects::reading_chain(state.effects);
  const effects::ReadingChain& more = state.readings;
  const auto append = [](auto& list, const auto& further) { list.insert(list.end(), further.begin(), further.end()); };
  append(both.growths, more.growths);
  append(both.scales, more.scales);
  append(both.shifts, more.shifts);
  append(both.detachments, more.detachments);
  append(both.lags, more.lags);
  append(both.errors, more.errors);
  append(both.swaps, more.swaps);
  both.clock_offset_s += more.clock_offset_s;
  return both;
}

effects::HeatBalance Twin::laws(const TwinState& state, const MeasuredRun& run,
                                std::vector<std::vector<int>>& source_probes) const {
  effects::HeatBalance all = scenarios::reducible(effects::heat_balance(state.effects));
  const effects::HeatBalance scenario = balance(state);
  const std::size_t n_own_heats = scenario.heats.size(), n_own_films = scenario.films.size();
  const std::vector<effects::HeatInput> own(all.heats.begin(), all.heats.begin() + static_cast<std::ptrdiff_t>(n_own_heats));
  for (const auto& s : machine_.system.sources) source_probes.push_back(s.power_W.probes);
  for (std::size_t h = n_own_heats; h < all.heats.size(); ++h) {  // dormant ones sleep unless called
    Law law([](const Inputs&) { return 0.0; });
    std::vector<Law> added;
    if (source_probes[h].empty()) {
      for (const AddedHeat& a : state.heats) {
        if (!(a.body == all.heats[h].body) || (!a.in.empty() && a.in != run.name)) continue;
        const Law whole = added_law(a, own);
        added.push_back([whole, from_s = a.from_s, until_s = a.until_s](const Inputs& u) {
          return u.time_s >= from_s && u.time_s < until_s ? whole(u) : 0.0;
        });
        if (a.from_s > 0.0) all.change_times_s.push_back(a.from_s);
        if (a.until_s < kNever_s) all.change_times_s.push_back(a.until_s);
      }
    }
    if (!added.empty()) {
      law = [added](const Inputs& u) {
        double sum_W = 0.0;
        for (const Law& l : added) sum_W += l(u);
        return sum_W;
      };
    }
    all.heats[h].power_W = law;
  }
  for (const ChangedFriction& f : state.frictions) {
    std::vector<int> of_body;  // the probe of the body's own temperature
    for (std::size_t h = n_own_heats; h < all.heats.size(); ++h) {
      if (all.heats[h].body == f.body && machine_.system.sources[h].power_W.looks_at_state())
        of_body = machine_.system.sources[h].power_W.probes;
    }
    for (std::size_t h = 0; h < n_own_heats; ++h) {
      if (!(all.heats[h].body == f.body)) continue;
      const bool thins = f.decay_1_K != 0.0;
      if (thins) source_probes[h].insert(source_probes[h].end(), of_body.begin(), of_body.end());
      all.heats[h].power_W.value = [f, thins, inner = all.heats[h].power_W.value](const Inputs& u) {
        const double n = u.drive.speed_rpm / f.at_speed_rpm;
        const double factor =
            n > 0.0 && f.change_of_exponent != 0.0 ? f.factor * std::pow(n, f.change_of_exponent) : f.factor;
        if (!thins) return factor * inner(u);
        Inputs own_inputs = u;
        const double t_K = own_inputs.probe_K.back();
        own_inputs.probe_K.pop_back();
        return factor * inner(own_inputs) * std::exp(-f.decay_1_K * (t_K - f.at_K));
      };
    }
  }
  for (std::size_t h = n_own_heats; h < all.heats.size(); ++h) source_probes[h].clear();
  std::size_t index = 0;
  for (auto& [name, law] : exchange_laws(all)) {
    const bool sleeps = index >= n_own_films && index < all.films.size();
    if (sleeps) *law = Law([](const Inputs&) { return 0.0; });
    for (const ChangedExchange& c : state.exchanges) {
      if (c.name != name || (!c.in.empty() && c.in != run.name)) continue;
      if (c.from_s > 0.0) all.change_times_s.push_back(c.from_s);
      law->value = [c, inner = law->value](const Inputs& u) {
        const double value = inner(u);
        if (u.time_s < c.from_s) return value;
        const double growth = c.growth != 0.0 && u.drive.speed_rpm > 0.0
                                  ? c.growth * std::pow(u.drive.speed_rpm / c.at_speed_rpm, c.exponent)
                                  : 0.0;
        return std::max(0.0, c.factor * value + c.added + growth);
      };
    }
    ++index;
  }
  for (const AddedHeat& a : state.heats) {  // a period is cut into steps
    if (a.shape != AddedHeat::Shape::kPeriodic) continue;
    for (double t_s = 0.0; t_s < run.time_s.back(); t_s += a.period_s / effects::kStepsAPeriod)
      all.change_times_s.push_back(t_s);
  }
  std::sort(all.change_times_s.begin(), all.change_times_s.end());
  return all;
}

Eigen::MatrixXd Twin::states(const TwinState& state, const MeasuredRun& run, Workspace& workspace) const {
  // --- matrices
  solver::ReducedSystem& system = workspace.system_;
  const auto& parts = machine_.system.parts;
  std::vector<double> factors(2 * parts.size(), 1.0);
  for (const ChangedBody& b : state.bodies) {
    for (std::size_t p = 0; p < parts.size(); ++p) {
      if (parts[p].body != b.body) continue;
      factors[p] *= b.conductivity;
      factors[parts.size() + p] *= b.heat_capacity;
    }
  }
  Eigen::VectorXd start = machine_.start;
  const TimeSeries hall = effects::true_hall(drive(state), run.hall, run.cyclogram);
  const double hall_at_start_K = hall.at(0.0);
  if (augmented_.model.start == scenarios::Start::kHall) start = hall_at_start_K * machine_.system.ones;
  if (augmented_.model.start == scenarios::Start::kSteady) {  // a linear machine's steady state moves with its hall
    start += (hall_at_start_K - scenarios::felt_hall_at_start_K(augmented_.model)) * machine_.system.ones;
  }
  if (run.start_K.size() > 0) start += warmer_bodies() * run.start_K;
  const bool has_other_mass = std::any_of(factors.begin() + static_cast<std::ptrdiff_t>(parts.size()), factors.end(),
                                          [](double f) { return f != 1.0; });
  if (factors != workspace.factors_) {
    system.conduction = machine_.system.conduction;
    system.mass = machine_.system.mass;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      if (factors[p] != 1.0) system.conduction += (factors[p] - 1.0) * parts[p].conduction;
      if (factors[parts.size() + p] != 1.0) system.mass += (factors[parts.size() + p] - 1.0) * parts[p].mass;
    }
    workspace.factors_ = factors;
    workspace.propagator_.reset();
  }

  // --- laws
  std::vector<std::vector<int>> source_probes;
  scenarios::bind_laws(system, laws(state, run, source_probes));
  for (std::size_t s = 0; s < system.sources.size(); ++s) system.sources[s].power_W.probes = source_probes[s];
  if (!augmented_.has_own_gradient) {
    for (std::size_t e = 0; e < system.exchanges.size(); ++e) {
      const auto& unit = machine_.system.exchanges[e];
      if (unit.offset.size() == 0) continue;
      system.exchanges[e].offset = state.gradient_K_m * (unit.offset - state.level_m * unit.to_hall);
      system.exchanges[e].offset_sum = state.gradient_K_m * (unit.offset_sum - state.level_m * unit.hall_sum);
    }
  }

  // --- run
  const Cyclogram felt = effects::true_cyclogram(drive(state), run.cyclogram);
  Eigen::MatrixXd states;
  if (system.is_linear()) {
    if (!workspace.propagator_ || workspace.gradient_K_m_ != state.gradient_K_m || workspace.level_m_ != state.level_m) {
      workspace.propagator_ = std::make_unique<solver::Propagator>(system);
      workspace.gradient_K_m_ = state.gradient_K_m;
      workspace.level_m_ = state.level_m;
    }
    (void)workspace.propagator_->run(felt, hall, run.grid_s, start, false, &states);
  } else {
    const solver::ReducedSystem* small = &system;
    solver::ReducedSystem unit;
    if (has_other_mass) {
      unit = solver::with_unit_mass(system, start);
      small = &unit;
    }
    const auto n_times = static_cast<Eigen::Index>(run.grid_s.size());
    states.resize(system.size(), n_times);
    Eigen::Index k = 0;
    (void)solver::simulate(*small, felt, hall, run.grid_s, tolerances_, start,
                           [&](double, const Eigen::VectorXd& z) { states.col(k++) = z; });
    if (has_other_mass) {  // back from w = C'z
      const Eigen::LLT<Eigen::MatrixXd> factor(system.mass);
      factor.matrixU().solveInPlace(states);
    }
  }
  return states;
}

Eigen::MatrixXd Twin::respond(const TwinState& state, const MeasuredRun& run, Workspace& workspace) const {
  const Eigen::MatrixXd z = states(state, run, workspace);
  const TimeSeries hall = effects::true_hall(drive(state), run.hall, run.cyclogram);
  Eigen::MatrixXd weights = outputs_.state;
  for (const ChangedBody& b : state.bodies) {
    if (b.expansion == 1.0) continue;
    for (const auto& part : machine_.system.parts) {
      if (part.body != b.body) continue;
      for (Eigen::Index o = 0; o < part.outputs.cols(); ++o) {
        const bool is_meant = b.displacement.empty() || outputs_.name[static_cast<std::size_t>(o)] == b.displacement;
        if (is_meant) weights.col(o) += (b.expansion - 1.0) * part.outputs.col(o);
      }
    }
  }
  Eigen::MatrixXd outputs = weights.transpose() * z;
  for (std::size_t k = 0; k < run.grid_s.size(); ++k) {
    outputs.col(static_cast<Eigen::Index>(k)) += hall.at(run.grid_s[k]) * outputs_.hall;
  }
  return outputs;
}

Eigen::MatrixXd Twin::read(const TwinState& state, const MeasuredRun& run, Eigen::MatrixXd outputs) const {
  const effects::ReadingChain readings = chain(state);
  if (!readings.empty()) {
    Cyclogram felt = effects::true_cyclogram(drive(state), run.cyclogram);
    felt.name = run.name;
    const TimeSeries hall = effects::true_hall(drive(state), run.hall, run.cyclogram);
    outputs = effects::readings(readings, outputs_.name, outputs_.unit, run.grid_s, felt, hall, std::move(outputs));
  }
  Eigen::MatrixXd rows(outputs.rows(), static_cast<Eigen::Index>(run.row_in_grid.size()));
  for (Eigen::Index i = 0; i < rows.cols(); ++i) rows.col(i) = outputs.col(run.row_in_grid[static_cast<std::size_t>(i)]);
  return rows;
}

}  // namespace driftwright::diagnosis
