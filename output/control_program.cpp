#include "output/control_program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "base/errors.hpp"
#include "output/control_dialect.hpp"

namespace driftwright::output {
namespace {

using compensation::DriftModel;
using compensation::FailSafe;

constexpr double kNarrowest = 1e-9;  // width of a validity range; a narrower one would divide by zero

/// @throws InputError  for what a program without time cannot hold
void require_static(const DriftModel& model, const std::string& control) {
  for (const DriftModel::Term& t : model.terms) {
    const bool is_speed = compensation::is_drive(t.unit);
    if (!is_speed && t.lag_s == 0.0) continue;
    throw InputError(fmt::format(
        "the formula has {} of '{}', and a program that {} runs once a part knows no time; take a formula of thermometers "
        "without lags, or let a PLC or PC compute this one (--as st, --as c)",
        is_speed ? "the speed" : "a lag", t.input, control));
  }
}

/// A formula among those of a program.
struct FormulaPart {
  const DriftModel& model;
  const FailSafe& safe;
  std::vector<std::size_t> readings;  ///< of the program, one for each guard
  std::string own;                    ///< before the names of what it keeps: "", or "p0_"
};

/// Readings as drift_repair() leaves them while it doubts none, in x0, x1, ..., and the trust that they deserve.
void write_readings(Dialect& to, const FormulaPart& part) {
  const FailSafe& safe = part.safe;
  const std::string deserved = to.variable("deserved"), out = to.variable("out"), room = to.variable("room");
  to.set(deserved, to.number(1.0));
  for (std::size_t k = 0; k < safe.guards.size(); ++k) {
    const FailSafe::Guard& g = safe.guards[k];
    const std::string x = to.variable(fmt::format("x{}", k)), low = to.number(g.low), high = to.number(g.high);
    to.set(x, to.reading(part.readings[k]));
    if (safe.from_start && !compensation::is_drive(g.unit)) {
      const std::string base = to.kept(fmt::format("{}base{}", part.own, k));
      to.set_if(to.kept("started"), Dialect::Compare::kEqual, to.number(0.0), base, x);
      to.set(x, fmt::format("{} - {}", x, base));
    }
    to.set(out, fmt::format("{} - {}", low, x));
    to.set(room, fmt::format("{} - {}", x, high));
    to.at_least(out, room);
    to.at_least(out, to.number(0.0));
    to.set(room, fmt::format("{} - {} / {}", to.number(1.0), out, to.number(std::max(kNarrowest, g.high - g.low))));
    to.at_least(room, to.number(0.0));
    to.at_most(deserved, room);
    to.at_least(x, low);
    to.at_most(x, high);
  }
}

/// Less trust after a start unlike those of the training runs, as in drift_repair().
void write_start(Dialect& to, const FormulaPart& part) {
  const FailSafe& safe = part.safe;
  if (to.is_called() || !std::isfinite(safe.most_start)) return;
  const std::string warmth = to.variable("sum"), off = to.variable("out"), minus = to.variable("room"),
                    unknown = to.kept(part.own + "unknown"), started = to.kept("started");
  to.set(warmth, to.number(0.0));
  for (std::size_t k = 0; k < safe.guards.size(); ++k) {
    const FailSafe::Guard& g = safe.guards[k];
    if (g.start_weight == 0.0) continue;  // the sum of the weights is 0: what all readings have in common has no part
    to.set(warmth, fmt::format("{} + {} * ( {} - {} )", warmth, to.number(g.start_weight), to.reading(part.readings[k]),
                               to.number(g.start_offset)));
  }
  to.set(minus, fmt::format("{} - {}", to.number(0.0), warmth));
  to.at_least(warmth, minus);
  to.set(off, to.number(0.0));
  to.set_if(warmth, Dialect::Compare::kGreater, to.number(safe.most_start), off, to.number(1.0));
  to.set_if(started, Dialect::Compare::kEqual, to.number(0.0), unknown, off);
  to.set(minus, fmt::format("{} - {}", to.number(1.0), unknown));
  to.at_most(to.variable("deserved"), minus);
  if (std::isfinite(safe.start_s))
    to.set(unknown, fmt::format("{} * {}", unknown, to.number(std::exp(-safe.period_s / safe.start_s))));
}

/// The formula of these readings, in `sum`.
void write_formula(Dialect& to, const FormulaPart& part) {
  const DriftModel& model = part.model;
  const FailSafe& safe = part.safe;
  const std::string sum = to.variable("sum"), value = to.variable("value"), started = to.kept("started");
  const auto if_first = [&](const std::string& target, const std::string& v) {
    to.set_if(started, Dialect::Compare::kEqual, to.number(0.0), target, v);
  };
  to.set(sum, to.number(model.intercept));
  for (std::size_t j = 0; j < model.terms.size(); ++j) {
    const DriftModel::Term& t = model.terms[j];
    const auto guard =
        std::find_if(safe.guards.begin(), safe.guards.end(), [&](const FailSafe::Guard& g) { return g.input == t.input; });
    if (guard == safe.guards.end()) throw std::logic_error("a term of a model has no guard");
    const bool holds = compensation::is_drive(t.unit);
    const double first = model.from_start && !holds ? std::clamp(0.0, guard->low, guard->high) : 0.0;
    const std::string x = to.variable(fmt::format("x{}", guard - safe.guards.begin()));
    const std::string z = first == 0.0 ? x : fmt::format("( {} - {} )", x, to.number(first));
    if (t.is_running) {
      to.set(value, to.number(1.0));
      to.set_if(x, Dialect::Compare::kEqual, to.number(first), value, to.number(0.0));
    } else {
      std::string product = z;
      for (int p = 1; p < t.power; ++p) product += " * " + z;
      to.set(value, product);
    }
    if (t.lag_s > 0.0) {
      const std::string lag = to.kept(fmt::format("{}lag{}", part.own, j)),
                        before = to.kept(fmt::format("{}before{}", part.own, j));
      const std::string share = to.number(1.0 - std::exp(-safe.period_s / t.lag_s));
      if_first(lag, holds ? to.number(0.0) : value);
      if_first(before, holds ? to.number(0.0) : value);
      const std::string towards = holds ? before : fmt::format("{} * ( {} + {} )", to.number(0.5), before, value);
      to.set(lag, fmt::format("{0} + {1} * ( {2} - {0} )", lag, share, towards));
      to.set(before, value);
      to.set(value, lag);
    }
    to.set(sum, fmt::format("{} + {} * {}", sum, to.number(t.coefficient), value));
  }
}

/// What may go to the axis. @return the variable with it
std::string write_guard(Dialect& to, const FormulaPart& part) {
  const FailSafe& safe = part.safe;
  const std::string deserved = to.variable("deserved"), sum = to.variable("sum"), wanted = to.variable("wanted");
  const std::string started = to.kept("started"), correction = to.kept(part.own + "correction");
  const auto if_first = [&](const std::string& target, const std::string& v) {
    to.set_if(started, Dialect::Compare::kEqual, to.number(0.0), target, v);
  };
  if (to.is_called()) {
    to.set(wanted, fmt::format("{} * {}", deserved, sum));
  } else {
    const std::string trust = to.kept(part.own + "trust");
    if_first(trust, deserved);
    to.set(trust, fmt::format("{0} + {1} * ( {2} - {0} )", trust, to.number(1.0 - std::exp(-safe.period_s / safe.fade_s)),
                              deserved));
    to.set(wanted, fmt::format("{} * {}", trust, sum));
  }
  to.at_least(wanted, to.number(safe.lowest_um));
  to.at_most(wanted, to.number(safe.highest_um));
  if (to.is_called()) {
    to.set(correction, wanted);
  } else {
    const double most_um = safe.most_rate_um_s * safe.period_s;
    if_first(correction, wanted);
    to.set(wanted, fmt::format("{} - {}", wanted, correction));
    to.at_least(wanted, to.number(-most_um));
    to.at_most(wanted, to.number(most_um));
    to.set(correction, fmt::format("{} + {}", correction, wanted));
  }
  return correction;
}

/// Whether the readings of two formulas are the same, with the same ranges.
bool read_alike(const FormulaPart& a, const FormulaPart& b) {
  const auto is_same = [](const FailSafe::Guard& x, const FailSafe::Guard& y) {
    return x.input == y.input && x.unit == y.unit && x.low == y.low && x.high == y.high &&
           x.start_offset == y.start_offset && x.start_weight == y.start_weight;
  };
  return a.safe.start_s == b.safe.start_s && a.safe.most_start == b.safe.most_start &&
         std::equal(a.safe.guards.begin(), a.safe.guards.end(), b.safe.guards.begin(), b.safe.guards.end(), is_same);
}

/// The formulas one after the other. @return the variables with their corrections
std::vector<std::string> write_parts(Dialect& to, const std::vector<FormulaPart>& parts) {
  std::vector<std::string> corrections;
  for (const FormulaPart& part : parts) {
    if (&part == &parts.front() || !read_alike(part, *(&part - 1))) {
      write_readings(to, part);
      write_start(to, part);
    }
    write_formula(to, part);
    corrections.push_back(write_guard(to, part));
  }
  to.set(to.kept("started"), to.number(1.0));
  return corrections;
}

/// @param of      what is corrected, by which formula: a line each
/// @param guards  of the readings, in the program's order
std::vector<std::string> remarks_of(const std::vector<std::string>& of, const FailSafe& safe,
                                    const std::vector<FailSafe::Guard>& guards, Dialect& to, const std::string& made_by,
                                    double error_um) {
  const auto plain = [](std::string text) {  // safe in a comment of any of these languages
    std::replace_if(
        text.begin(), text.end(), [](char ch) { return ch < ' ' || ch > '~' || ch == '*'; }, '_');
    return text;
  };
  std::vector<std::string> list = {plain(made_by)};
  for (const std::string& line : of) list.push_back(plain(line));
  for (std::size_t k = 0; k < guards.size(); ++k) {
    const FailSafe::Guard& g = guards[k];
    list.push_back(
        plain(fmt::format("{}: {} in {}, valid from {:.5g} to {:.5g}{}", to.reading(k), g.input, g.unit, g.low, g.high,
                          safe.from_start && !compensation::is_drive(g.unit) ? " above the first reading" : "")));
  }
  if (!to.is_called()) {
    list.push_back(fmt::format("One row every {:g} s", safe.period_s));
    list.push_back(fmt::format("Where a run begins (the machine starts cold) set {} = 0", to.kept("started")));
  }
  list.push_back(fmt::format("Equal to what was judged within {:.1g} um while every reading is right", error_um));
  list.push_back(
      "It knows no broken thermometer but one out of range: a wire that breaks must stop the correction, by the PLC");
  return list;
}

/// Each constant is rounded by half a unit of its last digit, each product of them by a few: by so much the sum may differ.
double rounding_um(const DeployedModel& d, const NumberFormat& digits) {
  double size_um = std::abs(d.model.intercept), values = 1.0;
  for (const DriftModel::Term& t : d.model.terms) {
    double most = 1.0;
    for (const FailSafe::Guard& g : d.safe.guards) {
      if (g.input == t.input && !t.is_running) most = std::pow(std::max(std::abs(g.low), std::abs(g.high)), t.power);
    }
    size_um += (1.0 + t.power) * std::abs(t.coefficient) * most;
    values += most;
  }
  return std::max(1e-9, std::pow(10.0, 1 - digits.significant) * size_um + std::pow(10.0, -digits.decimals) * values);
}

/// A program of a language that runs in a cycle, or that is called, without lines yet.
std::unique_ptr<Dialect> dialect(ControlLanguage language, const std::string& name,
                                 const std::vector<FailSafe::Guard>& guards, double period_s, const ControlAxis& axis) {
  switch (language) {
    case ControlLanguage::kStructuredText:
      return structured_text(name, guards);
    case ControlLanguage::kSiemens:
      return siemens(name, axis, period_s);
    case ControlLanguage::kHeidenhain:
      return heidenhain(name, axis, guards.size());
    case ControlLanguage::kFanuc:
      return fanuc(name, axis, guards.size());
  }
  throw std::logic_error("a control's language without a dialect");
}

void require_one_start(const DeployedModel& d) {
  if (d.safe.from_start != d.model.from_start) throw std::logic_error("formula and fail-safe count from different rows");
}

}  // namespace

ControlProgram control_program(const DeployedModel& d, ControlLanguage language, const std::string& name,
                               const ControlAxis& axis, const std::string& made_by) {
  require_one_start(d);
  if (language == ControlLanguage::kHeidenhain) require_static(d.model, "Heidenhain's control");
  if (language == ControlLanguage::kFanuc) require_static(d.model, "Fanuc's control");
  const std::unique_ptr<Dialect> to = dialect(language, name, d.safe.guards, d.safe.period_s, axis);
  const double error_um = rounding_um(d, to->digits());
  const std::vector<std::string> remarks =
      remarks_of({fmt::format("Correction of {} by {}: the axis moves by its negative", d.model.target, d.model.kind)},
                 d.safe, d.safe.guards, *to, made_by, error_um);
  std::vector<std::size_t> readings;
  for (std::size_t k = 0; k < d.safe.guards.size(); ++k) readings.push_back(k);
  ControlProgram program = to->program(remarks, write_parts(*to, {FormulaPart{d.model, d.safe, readings, ""}}).front());
  program.error_um = error_um;
  return program;
}

ControlProgram control_program_over_travel(std::span<const PlacedModel> places, ControlLanguage language,
                                           const std::string& name, const ControlAxis& axis, const std::string& made_by) {
  if (language == ControlLanguage::kHeidenhain || language == ControlLanguage::kFanuc)
    throw InputError(fmt::format(
        "a program that {} calls sets one shift for the whole travel, so it cannot follow the position of the axis; take "
        "--as siemens, linuxcnc, st or c, or one --model of the place where the parts are",
        language == ControlLanguage::kFanuc ? "Fanuc's control" : "Heidenhain's control"));
  require_of_one_run(places);
  const FailSafe& first = places.front().model.safe;
  std::vector<FailSafe::Guard> guards;
  std::vector<FormulaPart> parts;
  std::vector<std::string> of = {
      "One correction over the travel, straight between these places, held beyond: the axis moves by "
      "its negative"};
  std::vector<double> at_mm;
  for (const PlacedModel& p : places) {
    const FailSafe& safe = p.model.safe;
    require_one_start(p.model);
    FormulaPart part{p.model.model, safe, {}, fmt::format("p{}_", parts.size())};
    for (const FailSafe::Guard& g : safe.guards) part.readings.push_back(reading_among(guards, g));
    parts.push_back(std::move(part));
    at_mm.push_back(p.at_mm);
    of.push_back(fmt::format("At {:g} mm {} by {}", p.at_mm, p.model.model.target, p.model.model.kind));
  }
  const std::unique_ptr<Dialect> to = dialect(language, name, guards, first.period_s, axis);
  double error_um = 0.0;
  for (const PlacedModel& p : places) error_um = std::max(error_um, rounding_um(p.model, to->digits()));
  const std::vector<std::string> remarks = remarks_of(of, first, guards, *to, made_by, error_um);
  const std::vector<std::string> corrections = write_parts(*to, parts);
  ControlProgram program = to->program(remarks, to->over_travel(at_mm, corrections));
  program.error_um = error_um;
  return program;
}

}  // namespace driftwright::output
