#pragma once
// The heat balance of a machine in its own terms (regions, surfaces, joints, lumped nodes), before any mesh or matrix.
// Effects write it; the solver turns each entry into a matrix or a load.

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/cyclogram.hpp"
#include "effects/expression.hpp"
#include "effects/surface_field.hpp"

namespace driftwright::effects {

enum class BodyKind { kRegion, kSurface, kNode, kJoint };

/// A part of the machine that heat enters, leaves or crosses, or whose temperature is used. A joint has no temperature of
/// its own.
struct Body {
  BodyKind kind = BodyKind::kRegion;
  std::string name;
  bool operator==(const Body&) const = default;
};
[[nodiscard]] inline Body region(std::string name) {
  return {BodyKind::kRegion, std::move(name)};
}
[[nodiscard]] inline Body surface(std::string name) {
  return {BodyKind::kSurface, std::move(name)};
}
/// A lumped node; "ambient" is the ambient air.
[[nodiscard]] inline Body node(std::string name) {
  return {BodyKind::kNode, std::move(name)};
}
[[nodiscard]] inline Body joint(std::string name) {
  return {BodyKind::kJoint, std::move(name)};
}
inline constexpr const char* kAmbientName = "ambient";
[[nodiscard]] inline Body ambient_node() {
  return node(kAmbientName);
}

/// The quantities that a law may depend on.
struct Inputs {
  Drive drive;
  double ambient_K = 0.0;            ///< ambient temperature minus the reference temperature
  double time_s = 0.0;               ///< within the current stretch of time; see HeatBalance::change_times_s
  std::vector<double> probe_K = {};  ///< absolute temperatures [K] of the law's probes, in their order
  std::string_view run = {};         ///< name of the simulated cyclogram; "" if it has none
};

/// A coefficient or a power that follows the drive and, if it has probes, mean temperatures of the machine.
struct Law {
  std::function<double(const Inputs&)> value;
  std::vector<Body> probes;  ///< the bodies whose mean temperatures the law uses
  std::string thermostat;    ///< the law is zero while this thermostat is off; "" for none
  /// The same as a formula, for programs that cannot call `value`; names as law_names() (law_steps.hpp). Empty: none is
  /// known. Who replaces `value` must replace or clear it.
  std::function<std::vector<Expression::Step>()> steps;

  Law() = default;
  template <class F>
  requires(!std::is_same_v<std::remove_cvref_t<F>, Law> && std::is_invocable_r_v<double, F, const Inputs&>)
      Law(F function, std::vector<Body> looks_at = {}, std::string switched_by = {})  // NOLINT: a lambda is a law
      : value(std::move(function)), probes(std::move(looks_at)), thermostat(std::move(switched_by)) {}
  double operator()(const Inputs& u) const { return value(u); }
};

/// Heat released evenly over the volume of a region, the area of a surface, or in a node. power_W > 0 heats.
struct HeatInput {
  std::string name;
  Body body;
  Law power_W;
};

/// What the coefficient of an exchange refers to.
enum class Per {
  kArea,   ///< [W/(m^2 K)], at every point of a surface or joint
  kTotal,  ///< [W/K], spread evenly over a body
};

/// Heat that flows between a body and one other temperature, or between the sides of a joint: a film, a link, a contact, or
/// radiation approximated by a film. The flow out of the body is q = coefficient (T - T_other), T local; at a joint it flows
/// from side a to side b, whose temperature is T_other.
struct Exchange {
  std::string name;
  Body body;  ///< a surface, region or node; or the joint
  Law coefficient;
  Per per = Per::kArea;
  std::string surrounding = kAmbientName;  ///< the other temperature: the ambient or a lumped node; unused for a joint
  std::optional<double> medium_K = {};     ///< replaces the surrounding: a medium of this absolute temperature
  /// Of a film that differs from place to place: its pattern, which the coefficient multiplies. With medium_K, the medium's
  /// temperature is that of the field, and medium_K its mean.
  FieldPart part = {};

  [[nodiscard]] bool is_same_place(const Exchange& other) const {
    const bool same_end = body.kind == BodyKind::kJoint ||
                          (surrounding == other.surrounding && medium_K.has_value() == other.medium_K.has_value());
    return body == other.body && per == other.per && same_end && part.id == other.part.id;
  }
};

[[nodiscard]] inline Exchange make_film(std::string name, std::string on, Law htc_W_m2K,
                                        std::string surrounding = kAmbientName) {
  return {.name = std::move(name),
          .body = surface(std::move(on)),
          .coefficient = std::move(htc_W_m2K),
          .surrounding = std::move(surrounding)};
}
[[nodiscard]] inline Exchange make_link(std::string name, Body body, Law conductance_W_K,
                                        std::string surrounding = kAmbientName) {
  return {.name = std::move(name),
          .body = std::move(body),
          .coefficient = std::move(conductance_W_K),
          .per = Per::kTotal,
          .surrounding = std::move(surrounding)};
}
[[nodiscard]] inline Exchange make_contact(std::string name, std::string across, Law conductance_W_m2K) {
  return {.name = std::move(name), .body = joint(std::move(across)), .coefficient = std::move(conductance_W_m2K)};
}

/// Grey radiation to surroundings that enclose the body: q = emissivity σ (T^4 - T_surrounding^4) per area, T local.
struct Radiation {
  std::string name;
  std::string surface;
  double emissivity = 0.0;
  std::string surrounding = kAmbientName;
};

/// A body with one temperature, such as the air near the nose, an oil tank or a rotor.
struct LumpedNode {
  std::string name;
  double capacity_J_K = 0.0;
};

/// A surface or a node with a prescribed temperature. Where two surfaces share nodes, the first in the list applies.
struct FixedTemperature {
  std::string name;
  Body body;
  TimeSeries temperature_K;      ///< absolute; a single knot for a constant
  bool follows_ambient = false;  ///< then temperature_K is ignored
};

/// Ambient air whose temperature changes with height: T(z) = T_ambient + gradient (z - level), for every film and radiation
/// to the ambient.
struct Stratification {
  double gradient_K_m = 0.0;
  double level_m = 0.0;  ///< height of the ambient thermometer; Z points up
};

/// A switch with hysteresis: on when the probe rises above on_above_K, off when it falls below off_below_K.
struct Thermostat {
  std::string name;
  Body probe;
  double on_above_K = 0.0;   ///< absolute
  double off_below_K = 0.0;  ///< < on_above_K; initially off unless the probe starts above on_above_K
};

/// All heats, exchanges and conditions of a machine.
struct HeatBalance {
  std::vector<HeatInput> heats;
  std::vector<Exchange> exchanges;  ///< sorted: first per area, then totals, then joints
  std::vector<Radiation> radiations;
  std::vector<LumpedNode> nodes;
  std::vector<FixedTemperature> fixed;
  std::vector<Stratification> stratifications;
  std::vector<Thermostat> thermostats;
  /// Times [s] at which laws may jump without a change of the drive (a draught begins). Between two of them a law does not
  /// depend on time.
  std::vector<double> change_times_s;

  /// Appends another balance; change times need not be sorted.
  void append(HeatBalance other);
  /// Calls work(name, law) for each heat and each exchange.
  template <class Work>
  void for_each_law(Work work) {
    for (HeatInput& h : heats) work(h.name, h.power_W);
    for (Exchange& e : exchanges) work(e.name, e.coefficient);
  }
  template <class Work>
  void for_each_law(Work work) const {
    for (const HeatInput& h : heats) work(h.name, h.power_W);
    for (const Exchange& e : exchanges) work(e.name, e.coefficient);
  }
};

/// Replaces each radiation by a film whose coefficient follows the mean temperatures of both sides, emissivity σ (T² + T_s²)
/// (T + T_s), because a reduced model can contain only films.
[[nodiscard]] HeatBalance with_radiation_as_films(HeatBalance balance);

}  // namespace driftwright::effects
