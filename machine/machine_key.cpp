#include "machine/machine_key.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/file_bytes.hpp"
#include "machine/machine.hpp"
#include "scenarios/reader/felt_run.hpp"

namespace driftwright::scenarios {
namespace {

constexpr int kFormat = 4;  // version of the folders' format; a new one invalidates all others

std::string words(const effects::Body& body) {
  const char* kinds[] = {"region", "surface", "node", "joint"};
  return fmt::format("{} {}", kinds[static_cast<int>(body.kind)], body.name);
}

std::string words(const effects::Law& law) {
  std::vector<std::string> probes;
  for (const effects::Body& b : law.probes) probes.push_back(words(b));
  return fmt::format("looks at [{}] switched by '{}'", fmt::join(probes, ", "), law.thermostat);
}

/// The text of a balance without the numbers of its laws.
std::string structure(const effects::HeatBalance& balance) {
  std::string text;
  const auto add = [&](const char* what, const auto&... parts) {
    text += what;
    ((text += fmt::format(" | {}", parts)), ...);
    text += "\n";
  };
  for (const auto& h : balance.heats) add("heat", h.name, words(h.body), words(h.power_W));
  for (const auto& e : balance.exchanges) {
    add(e.per == effects::Per::kArea ? "per area" : "in total", e.name, words(e.body), e.surrounding, words(e.coefficient),
        e.medium_K.value_or(0.0));
    if (e.part.field) add("pattern", e.part.id, e.part.field->hash, e.part.reach_m, e.part.even_air_K);
  }
  for (const auto& r : balance.radiations) add("radiation", r.name, r.surface, r.surrounding);
  for (const auto& n : balance.nodes) add("node", n.name, n.capacity_J_K);
  for (const auto& f : balance.fixed) {
    add("fixed", f.name, words(f.body), f.follows_ambient, fmt::format("{}", fmt::join(f.temperature_K.value, ", ")));
  }
  for (const auto& s : balance.stratifications) add("stratification", s.gradient_K_m, s.level_m);
  for (const auto& t : balance.thermostats) add("thermostat", t.name, words(t.probe));
  return text;
}

bool looks_at_temperatures(const effects::HeatBalance& balance) {
  bool any = false;
  balance.for_each_law([&](const std::string&, const effects::Law& law) { any = any || !law.probes.empty(); });
  return any;
}

std::string numbers_of_laws(const MachineModel& model) {
  std::string text;
  for (const effects::Effect& e : model.effects) {
    if (!e.kind->acts_on_heat()) continue;
    text += e.name() + ":";
    for (std::size_t p = 0; p < e.values.size(); ++p) text += fmt::format(" {} {}", e.values[p], e.kind->parameters[p].unit);
    for (const auto& [name, word] : e.words) text += fmt::format(" {} {}", name, word);
    for (const auto& [name, table] : e.tables) {
      text += fmt::format(" {} {} {}", name, fmt::join(table.time_s, " "), fmt::join(table.value, " "));
    }
    text += fmt::format(" from {} until {} in '{}'\n", e.from_s, e.until_s, e.in);
  }
  return text;
}

/// Coefficients of a balance whose laws do not depend on temperatures.
std::vector<double> coefficients_at_standstill(const effects::HeatBalance& balance, double ambient_K) {
  const effects::Inputs standstill{.drive = {}, .ambient_K = ambient_K};
  std::vector<double> values;
  for (const auto& e : balance.exchanges) values.push_back(e.coefficient(standstill));
  return values;
}

bool has_curves(const MachineModel& model) {
  return std::any_of(model.materials.begin(), model.materials.end(), [](const MaterialEntry& entry) {
    return !entry.material.conductivity_curve.empty() || !entry.material.heat_capacity_curve.empty();
  });
}

}  // namespace

std::string machine_text(const MachineModel& model) {
  const effects::HeatBalance balance = effects::heat_balance(model.effects);
  std::string text = model.written + structure(balance);
  if (!model.axes.empty()) text += fmt::format("at {}\n", fmt::join(pose_of(model.axes), " "));
  for (const effects::MaterialFactor& f : effects::material_factors(model.effects)) {
    text += fmt::format("factors of {}: {} {} {} {}\n", words(f.body), f.conductivity, f.heat_capacity, f.expansion,
                        f.displacement);
  }
  if (const auto* imported = std::get_if<mesh::ImportedMesh>(&model.mesh)) {
    const std::string bytes = read_bytes(imported->path);
    text += fmt::format("mesh file of {} bytes, {}\n", bytes.size(), content_hash(bytes));
  }
  for (const effects::Effect& e : model.effects) {
    for (const effects::Mention& m : e.kind->mentions) {
      if (m.of == effects::Mention::Of::kPoints && !e.words.at(m.name).empty())
        text += fmt::format("{} cut along {}\n", e.name(), e.words.at(m.name));
    }
  }
  if (model.start == Start::kAmbient || model.start == Start::kSteady || !balance.fixed.empty()) {
    text += fmt::format("ambient at the start {} K\n", felt_ambient_at_start_K(model));
  }
  if (model.start == Start::kSteady) text += numbers_of_laws(model);
  for (const effects::Body& body : bodies_of_readings(model)) text += fmt::format("mean of {}\n", words(body));
  if (has_curves(model)) text += fmt::format("curves frozen at an ambient temperature of {} K\n", model.ambient.at(0.0));
  return text;
}

std::string machine_key(const MachineModel& model, const ReductionPlan& plan, const std::string& version) {
  const effects::HeatBalance balance = effects::with_radiation_as_films(effects::heat_balance(model.effects));
  std::string key = fmt::format("driftwright {} store {}\n{}\n", version, kFormat, machine_text(model));
  const bool makes_modes = plan.n_modes > 0 && balance.thermostats.empty();
  const bool freezes_laws = makes_modes && looks_at_temperatures(balance);
  if (freezes_laws) {  // modal predictors are frozen at the typical drive
    const Drive& t = plan.typical;
    key += fmt::format("typical {} {} {}\n", t.speed_rpm, fmt::join(t.feed_m_s, " "), t.cutting_power_W);
    for (const Signal& signal : t.signals) key += fmt::format("typical {} {}\n", signal.name, signal.value);
    key += numbers_of_laws(model);
  } else if (makes_modes) {  // or at standstill
    key += fmt::format("at standstill {}\n",
                       fmt::join(coefficients_at_standstill(balance, felt_ambient_at_start_K(model)), " "));
  }
  if (freezes_laws || has_curves(model))
    key += fmt::format("frozen at an ambient temperature of {} K\n", felt_ambient_at_start_K(model));
  const auto numbers = [](const Eigen::VectorXd& v) {
    return fmt::format("{}", fmt::join(v.data(), v.data() + v.size(), " "));
  };
  const solver::ReductionDemand& d = plan.demand;
  key += fmt::format("power {}\nlow {}\nhigh {}\nambient {} K, {} s, tolerance {} K, {} modes, fields {}, parts {}\n",
                     numbers(d.power_W), numbers(d.low), numbers(d.high), d.ambient_K, d.duration_s, plan.tolerance_K,
                     plan.n_modes, plan.with_fields, plan.with_parts);
  for (std::size_t i = 0; i < plan.moves.size(); ++i) {
    const MovingAxis& axis = model.axes[i];
    if (plan.moves[i]) key += fmt::format("over the travel of {} from {} to {}\n", axis.name, axis.low_SI, axis.high_SI);
  }
  return key;
}

}  // namespace driftwright::scenarios
