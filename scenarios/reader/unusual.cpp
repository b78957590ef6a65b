#include "scenarios/reader/unusual.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/delimited_text.hpp"
#include "base/quantity.hpp"
#include "base/usual_ranges.hpp"
#include "scenarios/reader/felt_run.hpp"
#include "scenarios/reader/recorded_run.hpp"

namespace driftwright::scenarios {
namespace {

std::string at_line(const Where& where, const std::string& sentence) {
  const std::string key = where.key.empty() ? "" : fmt::format(" [{}]", where.key);
  if (where.line == 0) return sentence + key;
  return fmt::format("{}:{}: {}{}", clean_name(where.file), where.line, sentence, key);
}

/// The largest value of a law, and where it occurs.
struct Largest {
  double value = 0.0;
  double speed_rpm = 0.0;
  std::string cyclogram = {};
};

struct NamedDrive {
  Drive drive;
  std::string cyclogram;
};

/// Each different drive once.
std::vector<NamedDrive> drives_of(const Scenario& scenario) {
  std::vector<NamedDrive> drives;
  for (const Cyclogram& cyclogram : scenario.cyclograms) {
    const std::size_t first = drives.size();
    for (const Cyclogram::Section& section : felt_run_as_far_as_known(*scenario.machine, cyclogram).cyclogram.sections) {
      const bool is_known = std::any_of(drives.begin() + static_cast<std::ptrdiff_t>(first), drives.end(),
                                        [&](const NamedDrive& d) { return d.drive == section.drive; });
      if (!is_known) drives.push_back({section.drive, cyclogram.name});
    }
  }
  return drives;
}

Largest largest_of(const effects::Law& law, const effects::Effect& effect, const std::vector<NamedDrive>& drives,
                   const MachineModel& machine) {
  Largest largest;
  for (const NamedDrive& d : drives) {
    if (!effect.acts_in(d.cyclogram)) continue;
    effects::Inputs at{.drive = d.drive, .time_s = effect.from_s};
    at.run = d.cyclogram;
    at.probe_K.assign(law.probes.size(), machine.reference_K);
    try {
      const double value = law(at);
      if (!(std::abs(value) <= std::abs(largest.value))) largest = {value, d.drive.speed_rpm, d.cyclogram};
    } catch (const RangeError&) {  // outside the valid range of its formula; a run reports it
    }
  }
  return largest;
}

/// Films of a file: the largest value, and speeds or times beyond those of the file.
void add_film_of_file(const effects::Effect& effect, const std::vector<NamedDrive>& drives, const Scenario& scenario,
                      std::vector<std::string>& found) {
  if (!effect.field) return;
  const double largest_W_m2K = effect["factor"] * effect.field->film_W_m2K.maxCoeff();
  if (const auto what = beyond_usual(Usual::kFilm, largest_W_m2K, " in its file"))
    found.push_back(
        at_line(effect.where, fmt::format("{}: the {} is {}", effect.name(), usual_range(Usual::kFilm).what, *what)));
  const std::vector<double>& at = effect.field->states.at;
  if (effect.field->states.over == effects::FieldOver::kSpeed) {
    const NamedDrive* farthest = nullptr;
    double beyond_rpm = 0.0;
    for (const NamedDrive& d : drives) {
      if (!effect.acts_in(d.cyclogram)) continue;
      const double beyond = std::max(at.front() - d.drive.speed_rpm, d.drive.speed_rpm - at.back());
      if (beyond > beyond_rpm) beyond_rpm = beyond, farthest = &d;
    }
    if (farthest)
      found.push_back(at_line(
          effect.where, fmt::format("{}: the file has films from {:g} to {:g} rpm; at {:g} rpm in cyclogram "
                                    "'{}' that at {:g} rpm counts",
                                    effect.name(), at.front(), at.back(), farthest->drive.speed_rpm, farthest->cyclogram,
                                    farthest->drive.speed_rpm < at.front() ? at.front() : at.back())));
  } else if (effect.field->states.over == effects::FieldOver::kTime) {
    for (const Cyclogram& c : scenario.cyclograms) {
      if (!effect.acts_in(c.name) || (c.duration_s() <= at.back() && at.front() <= 0.0)) continue;
      found.push_back(at_line(
          effect.where, fmt::format("{}: the file has films from {:g} to {:g} min; cyclogram '{}' lasts {:g} "
                                    "min, and beyond the ends that of the end counts",
                                    effect.name(), at.front() / 60.0, at.back() / 60.0, c.name, c.duration_s() / 60.0)));
    }
  }
}

void add_effects(const Scenario& scenario, std::vector<std::string>& found) {
  const std::vector<NamedDrive> drives = drives_of(scenario);
  for (const effects::Effect& effect : scenario.machine->effects) {
    if (!effect.kind->contribute) continue;
    effects::HeatBalance balance;
    effect.kind->contribute(effect, balance);
    add_film_of_file(effect, drives, scenario, found);
    const auto judge = [&](const std::string& name, const effects::Law& law, Usual kind) {
      const Largest largest = largest_of(law, effect, drives, *scenario.machine);
      const std::string when = fmt::format(" at {:g} rpm in cyclogram '{}'", largest.speed_rpm, largest.cyclogram);
      if (const auto what = beyond_usual(kind, largest.value, when))
        found.push_back(at_line(effect.where, fmt::format("{}: the {} is {}", name, usual_range(kind).what, *what)));
    };
    for (const effects::HeatInput& heat : balance.heats) judge(heat.name, heat.power_W, Usual::kHeat);
    for (const effects::Exchange& e : balance.exchanges) {
      if (!e.part.is_even()) continue;  // a number without a unit: add_film_of_file()
      const Usual kind = e.per == effects::Per::kTotal              ? Usual::kLink
                         : e.body.kind == effects::BodyKind::kJoint ? Usual::kContact
                                                                    : Usual::kFilm;
      judge(e.name, e.coefficient, kind);
    }
    for (const effects::LumpedNode& node : balance.nodes) {
      if (const auto what = beyond_usual(Usual::kCapacity, node.capacity_J_K))
        found.push_back(at_line(effect.where, fmt::format("heat capacity of {} is {}", node.name, *what)));
    }
  }
}

void add_materials(const MachineModel& machine, std::vector<std::string>& found) {
  for (const MaterialEntry& entry : machine.materials) {
    const solver::Material& m = entry.material;
    const auto judge = [&](Usual kind, double value) {
      if (const auto what = beyond_usual(kind, value))
        found.push_back(at_line(entry.where, fmt::format("{} of {} is {}", usual_range(kind).what, entry.region, *what)));
    };
    judge(Usual::kDensity, m.density_kg_m3);
    judge(Usual::kConductivity, m.conductivity_W_mK);
    judge(Usual::kHeatCapacity, m.heat_capacity_J_kgK);
    judge(Usual::kYoungsModulus, m.youngs_modulus_Pa);
    judge(Usual::kExpansion, std::max({m.expansion_1_K.x, m.expansion_1_K.y, m.expansion_1_K.z}));
    judge(Usual::kExpansion, std::min({m.expansion_1_K.x, m.expansion_1_K.y, m.expansion_1_K.z}));
  }
}

void add_sensitivities(const MachineModel& machine, std::vector<std::string>& found) {
  for (const DisplacementOutput& d : machine.displacements) {
    if (!d.by_sensitivity) continue;
    for (const BySensitivity::Term& term : d.by_sensitivity->terms) {
      if (const auto what = beyond_usual(Usual::kSensitivity, term.sensitivity_m_K))
        found.push_back(
            at_line(d.by_sensitivity->where, fmt::format("sensitivity of {} to {} is {}", d.name, term.body.name, *what)));
    }
  }
}

void add_surroundings(const Scenario& scenario, std::vector<std::string>& found) {
  const MachineModel& machine = *scenario.machine;
  const double reference_C = machine.reference_K - kZeroCelsius_K;
  const auto judge = [&](double temperature_C) {
    const auto what = beyond_usual(Usual::kAmbient, temperature_C);
    if (what) found.push_back(fmt::format("the ambient temperature is {} [ambient]", *what));
    return what.has_value();
  };
  if (!machine.ambient.value.empty()) {
    const auto [low, high] = std::minmax_element(machine.ambient.value.begin(), machine.ambient.value.end());
    if (!judge(reference_C + *high)) judge(reference_C + *low);
  }
  for (const Cyclogram& cyclogram : scenario.cyclograms) {
    double fastest_m_s = 0.0;
    for (const Cyclogram::Section& section : cyclogram.sections)
      fastest_m_s = std::max(fastest_m_s, *std::max_element(section.drive.feed_m_s.begin(), section.drive.feed_m_s.end()));
    if (const auto what = beyond_usual(Usual::kFeed, fastest_m_s))
      found.push_back(fmt::format("velocity of an axis in cyclogram '{}' is {}", cyclogram.name, *what));
  }
}

}  // namespace

std::vector<std::string> unusual_numbers(const Scenario& scenario) {
  std::vector<std::string> found;
  if (!scenario.machine) return found;
  add_effects(scenario, found);
  add_materials(*scenario.machine, found);
  add_sensitivities(*scenario.machine, found);
  add_surroundings(scenario, found);
  found.erase(std::unique(found.begin(), found.end()), found.end());  // one number in several films of an effect
  return found;
}

std::vector<std::string> unusual_values(const Record& record, bool with_temperatures) {
  struct Farthest {
    Usual kind;
    const char* unit;
    double unit_SI;
    double value = 0.0, outside = 0.0, at_s = 0.0;
    std::string channel = {};
    int n_channels = 0;
  };
  Farthest kinds[] = {{Usual::kTemperature, "degC", 1.0},
                      {Usual::kDrift, "um", 1e-6},
                      {Usual::kDrift, "mm", 1e-3},
                      {Usual::kTilt, "urad", 1e-6}};
  for (const Channel& channel : record.channels) {
    if (channel.unit == "mm" && is_of_column(channel.name, channel.unit)) continue;  // the place of an axis is no drift
    for (Farthest& f : kinds) {
      if (channel.unit != f.unit || (f.kind == Usual::kTemperature && !with_temperatures)) continue;
      const UsualRange& range = usual_range(f.kind);
      bool is_outside = false;
      for (std::size_t i = 0; i < channel.values.size(); ++i) {
        const double value = f.unit_SI * channel.values[i] / range.unit_SI;
        const double outside = std::max(range.low - value, value - range.high);
        if (!(outside > 0.0)) continue;  // NaN for a missing value
        is_outside = true;
        if (outside > f.outside) f.outside = outside, f.value = value, f.at_s = record.time_s[i], f.channel = channel.name;
      }
      f.n_channels += is_outside ? 1 : 0;
    }
  }
  std::vector<std::string> found;
  for (const Farthest& f : kinds) {
    if (f.n_channels == 0) continue;
    const UsualRange& range = usual_range(f.kind);
    const std::string when = fmt::format(" at {:.4g} min in '{}'", f.at_s / 60.0, record.source);
    found.push_back(fmt::format("{} reaches {}{}", f.channel, *beyond_usual(f.kind, f.value * range.unit_SI, when),
                                f.n_channels > 1 ? fmt::format(" (channels outside of it: {})", f.n_channels) : ""));
  }
  return found;
}

}  // namespace driftwright::scenarios
