#include "diagnosis/extended_scenario.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>

#include "base/errors.hpp"
#include "base/yaml_text.hpp"
#include "diagnosis/power_laws.hpp"

namespace driftwright::diagnosis {
namespace {

using effects::Effect;
using effects::HeatBalance;
using effects::Inputs;

constexpr double kSame = 1e-9;         // relative: two laws are the same one
constexpr double kCloseEnough = 0.01;  // relative: a power law for another one, told in the comment
constexpr double kMinute_s = 60.0, kHour_s = 3600.0;

/// Why a change has no YAML; caught per change.
struct CannotWrite {
  std::string why;
};

std::string number(double value) {
  return fmt::format("{:.5g}", value);
}

std::string body_key(const effects::Body& body) {
  const char* key = body.kind == effects::BodyKind::kNode      ? "node"
                    : body.kind == effects::BodyKind::kSurface ? "surface"
                                                               : "region";
  return fmt::format("{}: {}", key, body.name);
}

bool is_name(const std::string& text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; });
}

/// Drives at which two laws are compared.
std::vector<Inputs> trial_inputs(double top_rpm) {
  std::vector<Inputs> list;
  for (double share : {0.0, 0.05, 0.1, 0.2, 0.35, 0.5, 0.75, 1.0}) {
    Inputs u;
    u.drive.speed_rpm = share * top_rpm;
    u.drive.feed_m_s = {0.05 * (1.0 - share), 0.1 * share, 0.02};
    u.drive.cutting_power_W = 100.0;
    list.push_back(u);
  }
  return list;
}

class Writer {
 public:
  Writer(const scenarios::Scenario& scenario, const Twin& twin, const std::vector<MeasuredRun>& runs)
      : twin_(twin), runs_(runs), yaml_(scenario.path), folder_(std::filesystem::absolute(scenario.path).parent_path()) {
    effects_ = yaml_.root().find("effects");
    const std::size_t n = effects_ && effects_->is_list() ? effects_->items.size() : 0;
    if (n != twin.augmented().n_own_effects)
      throw InputError(fmt::format("{}: has changed while it was diagnosed", scenario.path));
    for (const Cyclogram& c : scenario.cyclograms) cyclograms_.push_back(c.name);
    for (const MeasuredRun& run : runs) {
      for (const auto& s : run.cyclogram.sections) {
        top_rpm_ = std::max(top_rpm_, s.drive.speed_rpm);
        if (s.drive.speed_rpm > 0.0) speeds_rpm_.push_back(s.drive.speed_rpm);
      }
    }
    give_absolute_paths(yaml_.root());
  }

  /// @returns what was done. @throws CannotWrite
  std::vector<std::string> write(const StatedChange& change) {
    const YamlText yaml = yaml_;
    const std::vector<std::string> cyclograms = cyclograms_;
    comment_ = change.comment;
    done_.clear();
    notes_.clear();
    try {
      edit(change.state);
      if (done_.empty()) throw CannotWrite{"nothing in it differs from the scenario"};
    } catch (const CannotWrite&) {  // all of a change or nothing
      yaml_ = yaml;
      cyclograms_ = cyclograms;
      throw;
    }
    for (const auto& [line, notes] : notes_)
      yaml_.comment(line, fmt::format("{}: {}; {}", change.by, fmt::join(notes, ", "), comment_));
    return done_;
  }

  [[nodiscard]] std::string text(const std::vector<std::string>& head) const { return yaml_.text(head); }
  [[nodiscard]] const std::vector<std::string>& paths_left() const { return paths_left_; }

 private:
  void edit(const TwinState& s) {
    for (std::size_t i = 0; i < twin_.augmented().n_own_effects; ++i) values(i, s.effects[i]);
    for (const AddedHeat& h : s.heats) heat(h);
    for (const ChangedFriction& f : s.frictions) friction(f);
    for (const ChangedExchange& e : s.exchanges) exchange(e);
    for (const ChangedBody& b : s.bodies) body(b);
    if (s.gradient_K_m != 0.0) {
      append(fmt::format("type: stratification, gradient: {} K/m{}", number(s.gradient_K_m),
                         s.level_m != 0.0 ? fmt::format(", level: {} m", number(s.level_m)) : ""));
    }
    drive(s.drive);
    readings(s.readings);
  }

  [[nodiscard]] const Effect& own(std::size_t i) const { return twin_.augmented().model.effects[i]; }
  [[nodiscard]] const ConfigNode& entry(std::size_t i) const { return *effects_->items[i]; }

  void append(const std::string& pairs) {
    if (!yaml_.append(*effects_, "{" + pairs + "}", comment_)) throw CannotWrite{"the list `effects` cannot be added to"};
    done_.push_back("added {" + pairs + "}");
  }

  /// Multiplies the number that a scalar begins with and keeps its unit.
  void scale(const ConfigNode& scalar, double factor, const std::string& what) {
    const std::string was = yaml_.current(scalar);
    char* unit = nullptr;
    const double value = std::strtod(was.c_str(), &unit);
    if (unit == was.c_str()) throw CannotWrite{fmt::format("'{}' of {} does not begin with a number", was, what)};
    const std::string now = number(factor * value) + unit;
    if (!yaml_.replace(scalar, now))
      throw CannotWrite{fmt::format("the text of {} in line {} cannot be edited safely", what, scalar.line)};
    notes_[scalar.line].push_back(fmt::format("{} was {}", what, was));
    done_.push_back(fmt::format("line {}: {} {} -> {}", scalar.line, what, was, now));
  }

  /// Multiplies a parameter of an effect, which may stand at its fallback.
  void scale_parameter(std::size_t i, std::size_t p, double factor) {
    const effects::Parameter& parameter = own(i).kind->parameters[p];
    const double value = factor * own(i).values[p];
    if (!(value >= parameter.low && value <= parameter.high)) {
      throw CannotWrite{fmt::format("{} of {} would be {:g} {}; {:g} to {:g} is allowed", parameter.name, own(i).name(),
                                    value, parameter.unit, parameter.low, parameter.high)};
    }
    if (const ConfigNode* scalar = entry(i).find(parameter.name)) {
      scale(*scalar, factor, parameter.name);
      return;
    }
    const std::string text = number(value) + (parameter.unit == "1" ? "" : " " + parameter.unit);
    set_pair(i, parameter.name, text);
  }
  void set_pair(std::size_t i, const std::string& key, const std::string& text) {
    if (!yaml_.add_pair(entry(i), key, text))
      throw CannotWrite{fmt::format("{} in line {} cannot be edited safely", own(i).name(), own(i).where.line)};
    notes_[entry(i).line].push_back(key + " is new");
    done_.push_back(fmt::format("line {}: {}: {} is new", entry(i).line, key, text));
  }

  void values(std::size_t i, const Effect& now) {
    for (std::size_t p = 0; p < now.values.size(); ++p) {
      const double was = own(i).values[p];
      if (std::isnan(was) || now.values[p] == was) continue;
      scale_parameter(i, p, now.values[p] / was);
    }
  }

  /// Multiplies what an effect contributes, by those of its parameters that do so. `laws` picks what is meant of a balance.
  template <class Laws>
  void scale_law(std::size_t i, double factor, const std::vector<std::vector<std::string>>& ways, const Laws& laws) {
    std::string refused;
    for (const std::vector<std::string>& way : ways) {
      Effect tried = own(i);
      std::vector<std::size_t> turned;
      for (std::size_t p = 0; p < tried.values.size(); ++p) {
        if (std::find(way.begin(), way.end(), tried.kind->parameters[p].name) == way.end()) continue;
        if (std::isnan(tried.values[p]) || tried.values[p] == 0.0) continue;
        tried.values[p] *= factor;
        turned.push_back(p);
      }
      if (turned.empty()) continue;
      const HeatBalance before = scenarios::reducible(effects::heat_balance({own(i)})),
                        after = scenarios::reducible(effects::heat_balance({tried}));
      const std::vector<effects::Law> was = laws(before), is = laws(after);
      bool same = was.size() == is.size() && !was.empty();
      for (std::size_t l = 0; same && l < was.size(); ++l) {
        for (Inputs u : trial_inputs(top_rpm_)) {
          u.probe_K.assign(was[l].probes.size(), 300.0);
          for (std::size_t k = 0; k < u.probe_K.size(); ++k) u.probe_K[k] += static_cast<double>(k);
          const double want = factor * was[l](u), have = is[l](u);
          same = same && std::abs(have - want) <= kSame * std::abs(want);
        }
      }
      if (!same) continue;
      for (std::size_t p : turned) {
        const effects::Parameter& parameter = tried.kind->parameters[p];
        if (!(tried.values[p] >= parameter.low && tried.values[p] <= parameter.high)) {
          refused = fmt::format("{} would be {:g}; {:g} to {:g} is allowed", parameter.name, tried.values[p], parameter.low,
                                parameter.high);
        }
      }
      if (!refused.empty()) continue;
      for (std::size_t p : turned) scale_parameter(i, p, factor);
      return;
    }
    throw CannotWrite{fmt::format("no number of {} multiplies it by {:.4g}{}", own(i).name(), factor,
                                  refused.empty() ? "" : ": " + refused)};
  }

  /// For effects whose kind has no `in`: fine where there is one run only.
  void only_everywhere(const std::string& in, const std::string& type) const {
    if (!in.empty() && runs_.size() > 1)
      throw CannotWrite{fmt::format("it happened in {} alone, and {} has no key `in`", in, type)};
  }
  /// ", in: name" after seeing to it that there is a cyclogram of that name.
  std::string in_run(const std::string& in) {
    if (in.empty()) return "";
    if (std::find(cyclograms_.begin(), cyclograms_.end(), in) == cyclograms_.end()) {
      const auto run = std::find_if(runs_.begin(), runs_.end(), [&](const MeasuredRun& r) { return r.name == in; });
      const ConfigNode* list = yaml_.root().find("cyclograms");
      if (run == runs_.end() || !list || !list->is_map() || !is_name(in))
        throw CannotWrite{fmt::format("the scenario has no cyclogram '{}' to name, and none can be added", in)};
      const std::string path = std::filesystem::absolute(run->path).lexically_normal().string();
      if (!yaml_.append(*list, fmt::format("{}: {{csv: \"{}\"}}", in, path), "diagnosis: the measured run"))
        throw CannotWrite{"the map `cyclograms` cannot be added to"};
      cyclograms_.push_back(in);
      done_.push_back(fmt::format("added the cyclogram {} from its record", in));
    }
    return ", in: " + in;
  }

  static std::string window(const AddedHeat& h) {
    std::string text;
    if (h.from_s > 0.0) text += fmt::format(", from: {} s", number(h.from_s));
    if (h.until_s < kNever_s) text += fmt::format(", until: {} s", number(h.until_s));
    return text;
  }

  void heat(const AddedHeat& h) {
    only_everywhere(h.in, "heat_source");
    const std::string place = body_key(h.body);
    switch (h.shape) {
      case AddedHeat::Shape::kConstant:
        append(fmt::format("type: heat_source, {}, power: {} W{}", place, number(h.power_W), window(h)));
        return;
      case AddedHeat::Shape::kPower:
        append(fmt::format("type: heat_source, {}, power: {} W, at_speed: {} rpm, exponent: {}{}", place, number(h.power_W),
                           number(h.at_speed_rpm), number(h.exponent), window(h)));
        return;
      case AddedHeat::Shape::kFeed:
        if (!window(h).empty()) throw CannotWrite{"servo_loss has no `from` and `until`"};
        for (const char* axis : {"x", "y", "z"}) {
          append(fmt::format("type: servo_loss, {}, axis: {}, power: {} W, at_feed: {} m/s, exponent: 1", place, axis,
                             number(h.power_W), number(h.at_feed_m_s)));
        }
        return;
      case AddedHeat::Shape::kAsWritten: {
        if (!window(h).empty()) throw CannotWrite{"a factor on a heat holds from the start to the end"};
        const Inputs u{.drive = {.speed_rpm = h.at_speed_rpm}};
        std::vector<std::size_t> whose;
        double written_W = 0.0;
        for (std::size_t i = 0; i < twin_.augmented().n_own_effects; ++i) {
          bool gives = false;
          for (const auto& input : effects::heat_balance({own(i)}).heats) {
            if (!(input.body == h.body) || !input.power_W.probes.empty()) continue;
            written_W += input.power_W(u);
            gives = true;
          }
          if (gives) whose.push_back(i);
        }
        if (whose.empty() || !(std::abs(written_W) > 0.0)) throw CannotWrite{"the body has no heat of its own to multiply"};
        for (std::size_t i : whose) {
          scale_law(
              i, 1.0 + h.power_W / written_W,
              {{"power", "idle"}, {"f0", "f1"}, {"friction", "viscous"}, {"torque", "thrust"}, {"pump_power"}, {"share"}},
              [&](const HeatBalance& b) {
                std::vector<effects::Law> laws;
                for (const auto& input : b.heats) {
                  if (input.body == h.body && input.power_W.probes.empty()) laws.push_back(input.power_W);
                }
                return laws;
              });
        }
        return;
      }
      case AddedHeat::Shape::kPeriodic: {
        double longest_s = 0.0;
        for (const MeasuredRun& run : runs_) longest_s = std::max(longest_s, run.time_s.back());
        append(fmt::format("type: heat_source, {}, power: {} W, period: {} s, delay: {} s, until: {} s", place,
                           number(h.power_W), number(h.period_s), number(h.delay_s), number(longest_s)));
        if (h.mean_W != 0.0) append(fmt::format("type: heat_source, {}, power: {} W", place, number(h.mean_W)));
        return;
      }
    }
  }

  void friction(const ChangedFriction& f) {
    std::vector<std::size_t> whose;
    for (std::size_t i = 0; i < twin_.augmented().n_own_effects; ++i) {
      const HeatBalance alone = effects::heat_balance({own(i)});
      const bool here = std::any_of(alone.heats.begin(), alone.heats.end(), [&](const auto& h) { return h.body == f.body; });
      if (!here) continue;
      const bool is_more = alone.heats.size() > 1 || !alone.nodes.empty() || !alone.links.empty() || !alone.films.empty();
      const effects::Law& law = alone.heats.front().power_W;
      if (is_more || !law.probes.empty() || !law.thermostat.empty())
        throw CannotWrite{fmt::format("the law of {} looks at temperatures or does more than heat its body", own(i).name())};
      if (law(Inputs{}) != 0.0)
        throw CannotWrite{fmt::format("{} heats at standstill, too; friction_law does not", own(i).name())};
      Inputs moving{.drive = {.speed_rpm = f.at_speed_rpm}};
      moving.drive.feed_m_s = {0.1, 0.1, 0.1};
      moving.drive.cutting_power_W = 1.0;
      if (law(moving) != law(Inputs{.drive = {.speed_rpm = f.at_speed_rpm}}))
        throw CannotWrite{fmt::format("{} follows feeds or cutting power; friction_law does not", own(i).name())};
      whose.push_back(i);
    }
    if (whose.empty()) throw CannotWrite{"the body has no heat of its own"};
    const std::string why = comment_;
    for (std::size_t i : whose) {
      const PowerLaws laws = power_laws(own(i), f.at_speed_rpm, speeds_rpm_);
      if (laws.terms.empty()) throw CannotWrite{fmt::format("{} follows no power of speed", own(i).name())};
      if (laws.deviation > kCloseEnough)
        comment_ = fmt::format("{}; a power law in place of {}, which it misses by up to {:.0f} %", why, own(i).name(),
                               100.0 * laws.deviation);
      for (const PowerLaw& p : laws.terms) {
        const double exponent = p.exponent + f.change_of_exponent;
        if (!(exponent >= 0.0 && exponent <= 4.0))
          throw CannotWrite{fmt::format("the exponent would be {:.3g}; 0 to 4 is allowed", exponent)};
        append(fmt::format("type: friction_law, {}, power: {} W, at_speed: {} rpm, exponent: {}{}", body_key(f.body),
                           number(f.factor * p.power_W), number(f.at_speed_rpm), number(exponent),
                           f.decay_1_K == 0.0 ? ""
                                              : fmt::format(", decay: {} 1/K, at_temperature: {:.2f} degC",
                                                            number(f.decay_1_K), f.at_K - 273.15)));
      }
      if (!yaml_.comment_out(*effects_, i)) throw CannotWrite{fmt::format("{} cannot be taken out safely", own(i).name())};
      notes_[entry(i).line].push_back("replaced by friction_law below");
      done_.push_back(fmt::format("line {}: {} is a comment now", entry(i).line, own(i).name()));
      comment_ = why;
    }
  }

  void exchange(const ChangedExchange& c) {
    if (c.factor == 1.0 && c.added == 0.0 && c.growth == 0.0) return;
    std::vector<std::size_t> whose;
    std::string surface, surrounding = effects::kHallName;
    for (std::size_t i = 0; i < twin_.augmented().model.effects.size(); ++i) {
      const HeatBalance alone = scenarios::reducible(effects::heat_balance({own(i)}));
      const auto is_it = [&](const auto& x) { return x.name == c.name; };
      const auto film = std::find_if(alone.films.begin(), alone.films.end(), is_it);
      if (film != alone.films.end()) {
        surface = film->surface;
        surrounding = film->surrounding;
      }
      const bool here = film != alone.films.end() || std::any_of(alone.links.begin(), alone.links.end(), is_it) ||
                        std::any_of(alone.contacts.begin(), alone.contacts.end(), is_it);
      if (here && i < twin_.augmented().n_own_effects) whose.push_back(i);
    }
    const bool is_late = c.from_s > 0.0;
    const std::string to = surrounding == effects::kHallName ? "" : ", surrounding: " + surrounding;
    if (c.growth != 0.0) {
      only_everywhere(c.in, "forced_convection");
      if (surface.empty() || is_late) throw CannotWrite{"only a film grows with speed, and from the start on"};
      append(fmt::format("type: forced_convection, surface: {}, growth: {} W/(m^2 K), at_speed: {} rpm, exponent: {}{}",
                         surface, number(c.growth), number(c.at_speed_rpm), number(c.exponent), to));
    }
    if (c.added != 0.0) {
      only_everywhere(c.in, "convection");
      if (surface.empty()) throw CannotWrite{"only a film can be added to"};
      append(fmt::format("type: convection, surface: {}, film: {} W/(m^2 K){}{}", surface, number(c.added), to,
                         is_late ? fmt::format(", from: {} s", number(c.from_s)) : ""));
    }
    if (c.factor == 1.0) return;
    only_everywhere(c.in, "convection");
    if (whose.empty()) throw CannotWrite{"the scenario has no such exchange"};
    for (std::size_t i : whose) {
      if (is_late) {
        late_exchange(i, c, to);
      } else if (own(i).tables.contains("conductance_over_pressure")) {
        const ConfigNode& rows = *entry(i).find("conductance_over_pressure");
        for (const ConfigNodePtr& row : rows.items) scale(*row->items.at(1), c.factor, "conductance");
      } else {
        scale_law(i, c.factor,
                  {{"film"}, {"growth"}, {"conductance"}, {"exchange"}, {"emissivity"}, {"passage_conductance"}},
                  [&](const HeatBalance& b) {
                    std::vector<effects::Law> laws;
                    for (const auto& x : b.films) {
                      if (x.name == c.name) laws.push_back(x.htc_W_m2K);
                    }
                    for (const auto& x : b.links) {
                      if (x.name == c.name) laws.push_back(x.conductance_W_K);
                    }
                    for (const auto& x : b.contacts) {
                      if (x.name == c.name) laws.push_back(x.conductance_W_m2K);
                    }
                    return laws;
                  });
      }
    }
  }

  /// A film, joint or link ends, and another one begins.
  void late_exchange(std::size_t i, const ChangedExchange& c, const std::string& to) {
    const std::string& kind = own(i).kind->key;
    if ((kind != "convection" && kind != "contact" && kind != "link") || own(i).tables.contains("conductance_over_pressure"))
      throw CannotWrite{
          fmt::format("{} cannot end at a time; `convection`, `contact` and `link` of a number can", own(i).name())};
    const double until_s = own(i).has("until") ? own(i)["until"] : kNever_s;
    if (!(c.from_s > own(i)["from"] && c.from_s < until_s)) throw CannotWrite{"it does not act at that time"};
    const std::string at = number(c.from_s) + " s";
    if (const ConfigNode* written = entry(i).find("until")) {
      if (!yaml_.replace(*written, at)) throw CannotWrite{"its `until` cannot be edited safely"};
      notes_[written->line].push_back("until was " + written->text);
    } else {
      set_pair(i, "until", at);
    }
    std::string what;
    if (kind == "convection") {
      what = fmt::format("surface: {}, film: {} W/(m^2 K){}", own(i).place, number(c.factor * own(i)["film"]), to);
    } else if (kind == "contact") {
      what = fmt::format("joint: {}, conductance: {} W/(m^2 K)", own(i).place, number(c.factor * own(i)["conductance"]));
    } else {
      what = fmt::format("{}, to: {}, conductance: {} W/K", body_key(own(i).body()), own(i).references.at("to").name,
                         number(c.factor * own(i)["conductance"]));
    }
    append(fmt::format("type: {}, {}, from: {}{}", kind, what, at,
                       until_s < kNever_s ? fmt::format(", until: {} s", number(until_s)) : ""));
  }

  void body(const ChangedBody& b) {
    const HeatBalance balance = twin_.balance(twin_.as_written());
    const bool is_node =
        std::any_of(balance.nodes.begin(), balance.nodes.end(), [&](const auto& n) { return n.name == b.body; });
    const std::string place = fmt::format("{}: {}", is_node ? "node" : "region", b.body);
    if (b.conductivity != 1.0) {
      if (is_node) throw CannotWrite{"a lumped node has no conductivity"};
      append(fmt::format("type: conductivity, {}, factor: {}", place, number(b.conductivity)));
    }
    if (b.heat_capacity != 1.0) append(fmt::format("type: heat_capacity, {}, factor: {}", place, number(b.heat_capacity)));
    if (b.expansion == 1.0) return;
    bool expands_itself = false, any = false;
    const auto& displacements = twin_.augmented().model.displacements;
    const ConfigNode* written = yaml_.root().find("displacements");
    for (std::size_t d = 0; d < displacements.size(); ++d) {
      const auto& sum = displacements[d].by_sensitivity;
      expands_itself = expands_itself || (displacements[d].points && b.displacement.empty());
      if (!sum || (!b.displacement.empty() && displacements[d].name != b.displacement)) continue;
      const ConfigNode* terms = nullptr;
      for (const ConfigNodePtr& item : written->items) {
        const ConfigNode* name = item->find("name");
        if (name && name->text == displacements[d].name) terms = item->find("sensitivities");
      }
      for (std::size_t t = 0; t < sum->terms.size(); ++t) {
        if (sum->terms[t].body.name != b.body) continue;
        const ConfigNode* scalar = terms && t < terms->items.size() ? terms->items[t]->find("sensitivity") : nullptr;
        if (!scalar)
          throw CannotWrite{fmt::format("the sensitivities of {} cannot be found in the file", displacements[d].name)};
        scale(*scalar, b.expansion, "sensitivity");
        any = true;
      }
    }
    if (expands_itself && !is_node && !displacements.empty()) {
      append(fmt::format("type: expansion, {}, factor: {}", place, number(b.expansion)));
    } else if (!any) {
      throw CannotWrite{"no displacement of the scenario has a sensitivity there"};
    }
  }

  void drive(const effects::DriveChange& d) {
    if (d.speed_factor != 1.0) append(fmt::format("type: speed_override, factor: {}", number(d.speed_factor)));
    for (const auto& stop : d.stops) {
      if (!(stop.length_s > 0.0)) throw CannotWrite{"a stop of no length"};
      append(fmt::format("type: missing_stop, start: {} min, length: {} min{}", number(stop.start_s / kMinute_s),
                         number(stop.length_s / kMinute_s), in_run(stop.in)));
    }
    for (const auto& h : d.hall) {
      only_everywhere(h.in, "ambient");
      std::string pairs = "type: ambient";
      if (h.offset_K != 0.0 || h.ramp_K_s == 0.0) pairs += fmt::format(", offset: {} K", number(h.offset_K));
      if (h.ramp_K_s != 0.0) pairs += fmt::format(", ramp: {} K/h", number(kHour_s * h.ramp_K_s));
      if (h.from_s > 0.0) pairs += fmt::format(", from: {} min", number(h.from_s / kMinute_s));
      append(pairs);
    }
  }

  /// "growth: 3 um", or "tilt: 3 urad" for a tilt.
  [[nodiscard]] std::string amount(const std::string& key, const std::string& displacement, double value) const {
    const auto& tilts = twin_.augmented().model.tilts;
    const bool is_tilt = std::any_of(tilts.begin(), tilts.end(), [&](const auto& t) { return t.name == displacement; });
    return is_tilt ? fmt::format("tilt: {} urad", number(1e6 * value)) : fmt::format("{}: {} um", key, number(1e6 * value));
  }

  void readings(const effects::ReadingChain& r) {
    for (const auto& g : r.growths) {
      const std::string amount_text = amount("growth", g.displacement, g.amount);
      if (g.lag_s > 0.0) {
        append(fmt::format("type: spindle_growth, displacement: {}, {}, at_speed: {} rpm, exponent: {}, lag: {} min",
                           g.displacement, amount_text, number(g.at_speed_rpm), number(g.exponent),
                           number(g.lag_s / kMinute_s)));
      } else if (g.exponent == 2.0) {
        append(fmt::format("type: centrifugal, displacement: {}, {}, at_speed: {} rpm", g.displacement, amount_text,
                           number(g.at_speed_rpm)));
      } else {
        throw CannotWrite{"a growth at once goes with the square of speed"};
      }
    }
    for (const auto& s : r.scales) {
      append(fmt::format("type: scale_expansion, displacement: {}, factor: {}{}", s.displacement, number(s.factor),
                         s.lag_s > 0.0 ? fmt::format(", lag: {} min", number(s.lag_s / kMinute_s)) : ""));
    }
    for (const auto& s : r.shifts) {
      append(fmt::format("type: mount_shift, displacement: {}, {}, time: {} min{}", s.displacement,
                         amount("shift", s.displacement, s.amount), number(s.time_s / kMinute_s), in_run(s.in)));
    }
    for (const auto& d : r.detachments) {
      append(fmt::format("type: sensor_detached, sensor: {}, share: {}, time: {} min{}", d.sensor, number(d.share),
                         number(d.time_s / kMinute_s), in_run(d.in)));
    }
    for (const auto& l : r.lags)
      append(fmt::format("type: sensor_lag, sensor: {}, lag: {} min", l.sensor, number(l.lag_s / kMinute_s)));
    for (const auto& e : r.errors) {
      if (e.bias_K != 0.0) append(fmt::format("type: sensor_bias, sensor: {}, bias: {} K", e.sensor, number(e.bias_K)));
      if (e.drift_K_s != 0.0)
        append(fmt::format("type: sensor_drift, sensor: {}, drift: {} K/h", e.sensor, number(kHour_s * e.drift_K_s)));
    }
    for (const auto& s : r.swaps) append(fmt::format("type: sensor_swap, sensor: {}, with: {}", s.a, s.b));
    if (r.clock_offset_s != 0.0)
      append(fmt::format("type: clock_offset, offset: {} min", number(r.clock_offset_s / kMinute_s)));
  }

  /// Files are looked for beside the scenario, and this one will stand elsewhere.
  void give_absolute_paths(const ConfigNode& node) {
    for (std::size_t i = 0; i < node.items.size(); ++i) {
      const ConfigNode& item = *node.items[i];
      const bool is_path = node.is_map() && item.is_scalar() &&
                           (node.keys[i].text == "csv" || node.keys[i].text == "nc_program" || node.keys[i].text == "mesh");
      if (!is_path) {
        give_absolute_paths(item);
        continue;
      }
      const std::filesystem::path path = item.text;
      if (path.is_absolute()) continue;
      if (!yaml_.replace(item, fmt::format("\"{}\"", (folder_ / path).lexically_normal().string())))
        paths_left_.push_back(item.text);
    }
  }

  const Twin& twin_;
  const std::vector<MeasuredRun>& runs_;
  YamlText yaml_;
  std::filesystem::path folder_;
  const ConfigNode* effects_ = nullptr;
  std::vector<std::string> cyclograms_, done_, paths_left_;
  std::string comment_;
  std::map<int, std::vector<std::string>> notes_;  ///< what changed, by line
  std::vector<double> speeds_rpm_;
  double top_rpm_ = 1.0;
};

}  // namespace

TwinState state_of(const Twin& twin, const Claim& claim, const Eigen::VectorXd& x) {
  TwinState state = twin.as_written();
  for (std::size_t k = 0; k < claim.knobs.size(); ++k) {
    claim.knobs[k].set(state, claim.knobs[k].value(x[static_cast<Eigen::Index>(k)]));
  }
  return state;
}

ExtendedScenario extended_scenario(const scenarios::Scenario& scenario, const Twin& twin,
                                   const std::vector<MeasuredRun>& runs, const std::vector<StatedChange>& changes,
                                   std::vector<std::string> head) {
  ExtendedScenario result;
  Writer writer(scenario, twin, runs);
  for (const StatedChange& change : changes) {
    try {
      const std::vector<std::string> done = writer.write(change);
      result.written.push_back(fmt::format("{}: {}", change.name, fmt::join(done, "; ")));
    } catch (const CannotWrite& failure) {
      result.not_written.push_back(fmt::format("{}: {}", change.name, failure.why));
    }
  }
  for (const std::string& path : writer.paths_left())
    result.not_written.push_back(fmt::format("the path {}: it is still relative to the folder of {}", path, scenario.path));
  for (const std::string& failure : result.not_written) head.push_back("NOT WRITTEN: " + failure);
  result.text = writer.text(head);
  return result;
}

}  // namespace driftwright::diagnosis
