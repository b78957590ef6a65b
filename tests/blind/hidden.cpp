#include "blind/hidden.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace driftwright::blind {
namespace {

using effects::HeatBalance, effects::Inputs, effects::Law;

template <class List>
auto& named(List& list, const std::string& name) {
  const auto found = std::find_if(list.begin(), list.end(), [&](const auto& item) { return item.name == name; });
  if (found == list.end()) throw std::logic_error("blind: no " + name + " in the heat balance");
  return *found;
}

void multiply(Law& law, double factor) {
  law.value = [inner = law.value, factor](const Inputs& u) { return factor * inner(u); };
}

/// The law's value without probes of its own, times what a factor says of the last probe.
void multiply_by_temperature(Law& law, const effects::Body& body, double decay_1_K, double reference_K) {
  law.probes.push_back(body);
  law.value = [inner = law.value, decay_1_K, reference_K](const Inputs& u) {
    Inputs own = u;
    own.probe_K.pop_back();
    return inner(own) * std::exp(-decay_1_K * (u.probe_K.back() - reference_K));
  };
}

std::string link_name(const std::string& where) {
  const auto comma = where.find(',');
  return "link " + where.substr(0, comma) + " - " + where.substr(comma + 1);
}

std::size_t index_of(const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  return static_cast<std::size_t>(found - names.begin());
}

/// Speeds that change, and when.
std::vector<std::pair<double, double>> changes(const Cyclogram& drive) {
  std::vector<std::pair<double, double>> list;
  double t_s = 0.0, before_rpm = 0.0;
  for (const auto& section : drive.sections) {
    if (section.drive.speed_rpm != before_rpm) list.emplace_back(t_s, std::abs(section.drive.speed_rpm - before_rpm));
    before_rpm = section.drive.speed_rpm;
    t_s += section.duration_s;
  }
  return list;
}

}  // namespace

std::string key_of(Hide what) {
  switch (what) {
    case Hide::kHeatConstant:
    case Hide::kHeatOfSpeed:
      return "heat_source";
    case Hide::kFrictionExponent:
    case Hide::kFrictionDecay:
      return "friction_law";
    case Hide::kFilmFactor:
    case Hide::kDraught:
      return "convection";
    case Hide::kForcedFactor:
    case Hide::kForcedNew:
      return "forced_convection";
    case Hide::kContactFactor:
    case Hide::kContactLater:
      return "contact";
    case Hide::kAmbientOffset:
    case Hide::kAmbientRamp:
    case Hide::kAmbientStep:
      return "ambient";
    case Hide::kStratification:
      return "stratification";
    case Hide::kRadiation:
      return "radiation";
    case Hide::kCoolant:
      return "coolant";
    case Hide::kConductivity:
      return "conductivity";
    case Hide::kHeatCapacity:
      return "heat_capacity";
    case Hide::kExpansion:
      return "expansion";
    case Hide::kSpindleGrowth:
      return "spindle_growth";
    case Hide::kCentrifugal:
      return "centrifugal";
    case Hide::kMountShift:
      return "mount_shift";
    case Hide::kSensorBias:
      return "sensor_bias";
    case Hide::kSensorLag:
      return "sensor_lag";
    case Hide::kSensorDrift:
      return "sensor_drift";
    case Hide::kSensorDetached:
      return "sensor_detached";
    case Hide::kSensorSwap:
      return "sensor_swap";
    case Hide::kClockOffset:
      return "clock_offset";
    case Hide::kSpeedOverride:
      return "speed_override";
    case Hide::kMissingStop:
      return "missing_stop";
    case Hide::kOscillatingHeat:
    case Hide::kTravelCreep:
    case Hide::kAcceleratingHeat:
      return "";
    case Hide::kProbeLag:
      return "probe_lag";
    case Hide::kCoolantHeld:
      return "coolant";
    case Hide::kDoorOpen:
      return "exchange_window";
  }
  throw std::logic_error("key_of: no such kind");
}

const char* law_name(Hide what) {
  constexpr std::array kNames = {
      "constant heat",   "heat of speed",     "friction exponent", "friction decay", "film factor",   "draught",
      "growth factor",   "growth new",        "contact factor",    "ambient offset", "ambient ramp",  "ambient step",
      "stratification",  "radiation",         "coolant",           "conductivity",   "heat capacity", "expansion",
      "spindle growth",  "centrifugal",       "mount shift",       "sensor bias",    "sensor lag",    "sensor drift",
      "sensor detached", "sensor swap",       "clock offset",      "speed override", "missing stop",  "oscillating heat",
      "travel creep",    "accelerating heat", "contact later",     "probe lag",      "coolant held",  "door open"};
  return kNames.at(static_cast<std::size_t>(what));
}

bool is_factor(Hide what) {
  return what == Hide::kFilmFactor || what == Hide::kForcedFactor || what == Hide::kContactFactor ||
         what == Hide::kConductivity || what == Hide::kHeatCapacity || what == Hide::kExpansion;
}

bool has_size(Hide what) {
  return what != Hide::kSensorSwap;
}

std::vector<TruthParameter> parameters_of(const Hidden& h) {
  if (is_factor(h.what)) return {{"factor", "1", std::exp(h.size)}};
  const TruthParameter speed{"at_speed", "rpm", h.at_speed_rpm}, time{"time", "min", h.time_s / 60.0};
  switch (h.what) {
    case Hide::kHeatConstant:
      return {{"power", "W", h.size}, {"exponent", "1", 0.0}};
    case Hide::kHeatOfSpeed:
      return {{"power", "W", h.size}, speed, {"exponent", "1", h.exponent}};
    case Hide::kFrictionExponent:
      return {{"exponent_change", "1", h.size}, speed};
    case Hide::kFrictionDecay:
      return {{"decay", "1/K", h.size}};
    case Hide::kDraught:
      return {{"film", "W/m^2K", h.size}, time};
    case Hide::kForcedNew:
      return {{"growth", "W/m^2K", h.size}, speed, {"exponent", "1", h.exponent}};
    case Hide::kContactLater:
      return {{"factor", "1", std::exp(h.size)}, time};
    case Hide::kAmbientOffset:
      return {{"offset", "K", h.size}};
    case Hide::kAmbientRamp:
      return {{"ramp", "K/h", h.size}};
    case Hide::kAmbientStep:
      return {{"step", "K", h.size}, time};
    case Hide::kStratification:
      return {{"gradient", "K/m", h.size}};
    case Hide::kRadiation:
    case Hide::kCoolant:
      return {{"power", "W", h.size}};
    case Hide::kSpindleGrowth:
      return {{"growth", "um", h.size}, speed, {"lag", "min", h.lag_s / 60.0}};
    case Hide::kCentrifugal:
      return {{"growth", "um", h.size}, speed};
    case Hide::kMountShift:
      return {{"shift", "um", h.size}, time};
    case Hide::kSensorBias:
      return {{"bias", "K", h.size}};
    case Hide::kSensorLag:
      return {{"lag", "min", h.size / 60.0}};
    case Hide::kSensorDrift:
      return {{"drift", "K/h", h.size}};
    case Hide::kSensorDetached:
      return {{"share", "1", h.size}, time};
    case Hide::kClockOffset:
      return {{"offset", "min", h.size / 60.0}};
    case Hide::kSpeedOverride:
      return {{"factor", "1", 1.0 + h.size}};
    case Hide::kMissingStop:
      return {{"start", "min", h.time_s / 60.0}, {"length", "min", h.size / 60.0}};
    case Hide::kOscillatingHeat:
      return {{"power", "W", h.size}, {"period", "min", h.lag_s / 60.0}};
    case Hide::kTravelCreep:
      return {{"creep", "um/h", h.size}};
    case Hide::kAcceleratingHeat:
      return {{"energy", "J/rpm", h.size}};
    case Hide::kProbeLag:
      return {{"shift", "um", h.size}};
    case Hide::kCoolantHeld:
      return {{"passage_conductance", "W/K", h.size}, {"below_reference", "K", h.lag_s}};
    case Hide::kDoorOpen:
      return {{"conductance", "W/K", h.size}, {"begin", "min", h.time_s / 60.0}, {"length", "min", h.lag_s / 60.0}};
    default:
      return {};
  }
}

void hide_in_values(const Hidden& h, const Subject& s, Values& v) {
  const auto& regions = s.placed.mesh.regions;
  const double factor = std::exp(h.size);
  const std::size_t region = index_of(regions, h.where);
  if (h.what == Hide::kConductivity) v.conductivity.at(region) *= factor;
  if (h.what == Hide::kExpansion) v.expansion.at(region) *= factor;
  if (h.what == Hide::kHeatCapacity) {
    (region < regions.size() ? v.heat_capacity[region] : v.node_capacity.at(index_of(s.nodes, h.where))) *= factor;
  }
}

void hide_in_heat(const Hidden& h, const Subject& s, const Cyclogram& drive, HeatBalance& balance) {
  const double size = h.size, n0 = h.at_speed_rpm, e = h.exponent, from_s = h.time_s, period_s = h.lag_s;
  switch (h.what) {
    case Hide::kHeatConstant:
    case Hide::kRadiation:
      named(balance.heats, "spare " + h.where).power_W = Law([=](const Inputs&) { return size; });
      return;
    case Hide::kCoolant:
      named(balance.heats, "spare " + h.where).power_W = Law([=](const Inputs&) { return -size; });
      return;
    case Hide::kHeatOfSpeed:
      named(balance.heats, "spare " + h.where).power_W =
          Law([=](const Inputs& u) { return size * std::pow(u.drive.speed_rpm / n0, e); });
      return;
    case Hide::kOscillatingHeat:
      named(balance.heats, "spare " + h.where).power_W =
          Law([=](const Inputs& u) { return size * std::sin(2.0 * std::numbers::pi * u.time_s / period_s); });
      return;
    case Hide::kAcceleratingHeat:
      named(balance.heats, "spare " + h.where).power_W = Law([list = changes(drive), size](const Inputs& u) {
        constexpr double kOver_s = 60.0;
        double power_W = 0.0;
        for (const auto& [t_s, by_rpm] : list) {
          // Half open at the front: a stage lies at the end of its step, never at its start.
          if (u.time_s > t_s && u.time_s <= t_s + kOver_s) power_W += size * by_rpm / kOver_s;
        }
        return power_W;
      });
      return;
    case Hide::kFrictionExponent: {
      Law& law = named(balance.heats, "bearing_friction " + h.where).power_W;
      law.value = [inner = law.value, size, n0](const Inputs& u) {
        return u.drive.speed_rpm > 0.0 ? inner(u) * std::pow(u.drive.speed_rpm / n0, size) : 0.0;
      };
      return;
    }
    case Hide::kFrictionDecay: {
      auto& heat = named(balance.heats, "bearing_friction " + h.where);
      multiply_by_temperature(heat.power_W, heat.body, size, s.model.reference_K);
      return;
    }
    case Hide::kFilmFactor:
      multiply(named(balance.exchanges, "convection " + h.where).coefficient, std::exp(size));
      return;
    case Hide::kForcedFactor:
      multiply(named(balance.exchanges, "forced_convection " + h.where).coefficient, std::exp(size));
      return;
    case Hide::kDraught:
      named(balance.exchanges, "spare " + h.where).coefficient =
          Law([=](const Inputs& u) { return u.time_s >= from_s ? size : 0.0; });
      return;
    case Hide::kForcedNew:
      named(balance.exchanges, "spare " + h.where).coefficient =
          Law([=](const Inputs& u) { return size * std::pow(u.drive.speed_rpm / n0, e); });
      return;
    case Hide::kContactFactor:
      if (h.where.find(',') == std::string::npos) {
        multiply(named(balance.exchanges, "contact " + h.where).coefficient, std::exp(size));
      } else {
        multiply(named(balance.exchanges, link_name(h.where)).coefficient, std::exp(size));
      }
      return;
    case Hide::kContactLater: {
      Law& law = named(balance.exchanges, link_name(h.where)).coefficient;
      law.value = [inner = law.value, size, from_s](const Inputs& u) {
        return u.time_s >= from_s ? std::exp(size) * inner(u) : inner(u);
      };
      return;
    }
    case Hide::kCoolantHeld: {
      auto& heat = named(balance.heats, "spare " + h.where);
      heat.power_W =
          Law([size, medium_K = s.model.reference_K - h.lag_s](const Inputs& u) { return size * (medium_K - u.probe_K[0]); },
              {heat.body});
      return;
    }
    case Hide::kDoorOpen: {
      auto& heat = named(balance.heats, "spare " + h.where);
      heat.power_W = Law(
          [=, reference_K = s.model.reference_K](const Inputs& u) {
            const bool open = u.time_s >= from_s && u.time_s < from_s + period_s;
            return open ? size * (reference_K + u.ambient_K - u.probe_K[0]) : 0.0;
          },
          {heat.body});
      return;
    }
    case Hide::kStratification:
      balance.stratifications.push_back({size, 1.2});
      return;
    default:
      return;
  }
}

Cyclogram true_drive(const Hidden& h, const Cyclogram& drive) {
  Cyclogram felt = drive;
  if (h.what == Hide::kSpeedOverride) {
    for (auto& section : felt.sections) section.drive.speed_rpm *= 1.0 + h.size;
  }
  if (h.what == Hide::kMissingStop) {
    felt.sections.clear();
    const double stop_s = h.time_s, go_s = h.time_s + h.size;
    double start_s = 0.0;
    const auto add = [&](double from_s, double until_s, const Drive& how) {
      if (until_s - from_s > 1e-6) felt.sections.push_back({until_s - from_s, how});
    };
    for (const auto& section : drive.sections) {
      const double end_s = start_s + section.duration_s;
      Drive still = section.drive;
      still.speed_rpm = 0.0;
      add(start_s, std::min(end_s, std::max(start_s, stop_s)), section.drive);
      add(std::max(start_s, stop_s), std::min(end_s, go_s), still);
      add(std::min(end_s, std::max(start_s, go_s)), end_s, section.drive);
      start_s = end_s;
    }
  }
  return felt;
}

double ambient_error_K(const Hidden& h, double time_s) {
  if (h.what == Hide::kAmbientOffset) return h.size;
  if (h.what == Hide::kAmbientRamp) return h.size * time_s / 3600.0;
  if (h.what == Hide::kAmbientStep) return time_s >= h.time_s ? h.size : 0.0;
  return 0.0;
}

int reading_order(Hide what) {
  switch (what) {
    case Hide::kSensorDetached:
      return 1;
    case Hide::kSensorLag:
      return 2;
    case Hide::kSensorBias:
    case Hide::kSensorDrift:
      return 3;
    case Hide::kSensorSwap:
      return 4;
    case Hide::kClockOffset:
      return 5;
    default:
      return 0;
  }
}

void hide_in_readings(const Hidden& h, const Cyclogram& drive, double top_speed_rpm, Readings& r) {
  const Eigen::Index n = r.value.cols();
  const auto at_from = [&](const auto& change) {
    for (Eigen::Index k = 0; k < n; ++k) {
      if (r.time_s(k) >= h.time_s - 1e-6) change(k);
    }
  };
  switch (h.what) {
    case Hide::kSpindleGrowth: {
      Eigen::RowVectorXd d = of_speed(r, drive, 1e-6 * h.size, h.at_speed_rpm, 1.0);
      // Speed is constant between two samples, not linear: the lag is that of steps.
      const double kept = std::exp(-r.step_s / h.lag_s);
      double y = 0.0;
      for (Eigen::Index k = 1; k < n; ++k) {
        y = d[k] + (y - d[k]) * kept;
        r.value(r.row(h.where), k) += y;
      }
      return;
    }
    case Hide::kCentrifugal:
      r.value.row(r.row(h.where)) += of_speed(r, drive, 1e-6 * h.size, h.at_speed_rpm, 2.0);
      return;
    case Hide::kTravelCreep: {
      const Eigen::RowVectorXd rate = of_speed(r, drive, 1e-6 * h.size / 3600.0, top_speed_rpm, 1.0);
      double travelled = 0.0;
      for (Eigen::Index k = 1; k < n; ++k) r.value(r.row(h.where), k) += (travelled += rate[k] * r.step_s);
      return;
    }
    case Hide::kProbeLag:
      r.value.row(r.row(h.where)).array() += 1e-6 * h.size;
      return;
    case Hide::kMountShift:
      at_from([&](Eigen::Index k) { r.value(r.row(h.where), k) += 1e-6 * h.size; });
      return;
    case Hide::kSensorDetached:
      at_from([&](Eigen::Index k) {
        double& reading = r.value(r.row(h.where), k);
        reading = h.size * r.ambient_K[k] + (1.0 - h.size) * reading;
      });
      return;
    case Hide::kSensorLag: {
      Eigen::RowVectorXd row = r.value.row(r.row(h.where));
      lag(row, r.step_s, h.size, row[0]);
      r.value.row(r.row(h.where)) = row;
      return;
    }
    case Hide::kSensorBias:
      r.value.row(r.row(h.where)).array() += h.size;
      return;
    case Hide::kSensorDrift:
      for (Eigen::Index k = 0; k < n; ++k) r.value(r.row(h.where), k) += h.size * r.time_s(k) / 3600.0;
      return;
    case Hide::kSensorSwap: {
      const auto comma = h.where.find(',');
      const Eigen::Index a = r.row(h.where.substr(0, comma)), b = r.row(h.where.substr(comma + 1));
      const Eigen::RowVectorXd was = r.value.row(a);
      r.value.row(a) = r.value.row(b);
      r.value.row(b) = was;
      return;
    }
    case Hide::kClockOffset:
      shift_clock(r, h.size);
      return;
    default:
      return;
  }
}

bool stands_on(const Hidden& h, const ScatterParameter& p) {
  using Of = ScatterParameter::Of;
  switch (h.what) {
    case Hide::kConductivity:
      return p.of == Of::kConductivity && p.place == h.where;
    case Hide::kExpansion:
      return p.of == Of::kExpansion && p.place == h.where;
    case Hide::kHeatCapacity:
      return (p.of == Of::kHeatCapacity && p.place == h.where) || p.name == "node " + h.where + " capacity" ||
             p.name == "air_node " + h.where + " capacity";
    case Hide::kFilmFactor:
      return p.place == "convection " + h.where;
    case Hide::kForcedFactor:
      return p.name == "forced_convection " + h.where + " growth";
    case Hide::
        kContactFactor:  // links of one node differ by their other end, which a scatter's name does not tell: all of them
      return p.place == "contact " + h.where ||
             (h.where.find(',') != std::string::npos && p.place == "link " + h.where.substr(0, h.where.find(',')));
    default:
      return false;
  }
}

}  // namespace driftwright::blind
