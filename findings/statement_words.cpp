#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "findings/diagnosis_words.hpp"

namespace driftwright::findings {
namespace {

using diagnosis::StatedQuantity;

std::string what_and_where(const diagnosis::Statement& s) {
  const std::string place = fmt::format("{}", fmt::join(s.place, " and "));
  const bool all = s.place.front() == "all";
  switch (s.quantity) {
    case StatedQuantity::kHeat:
      return all ? "all heat of the machine" : "heat in " + place;
    case StatedQuantity::kExchange:
      return all ? "all exchange with the ambient" : s.place.size() == 1 ? "exchange at " + place : "exchange of " + place;
    case StatedQuantity::kCapacity:
      return (s.follows == "lagged" ? "a body beside " : "heat capacity of ") + place;
    case StatedQuantity::kReading:
      return (s.place.size() > 1 ? "thermometers " : "thermometer ") + place;
    case StatedQuantity::kDisplacement:
      return s.follows == "expansion" ? "expansion of " + place
                                      : (s.place.size() > 1 ? "displacements " : "displacement ") + place;
    case StatedQuantity::kAmbient:
      return "temperature of the ambient";
    case StatedQuantity::kSpeed:
      return "speed of the spindle";
    case StatedQuantity::kClock:
      return "clock of the readings";
  }
  return place;
}

/// What it follows; empty where that is said already.
std::string follows(const diagnosis::Statement& s) {
  if (s.follows == "expansion" || s.quantity == StatedQuantity::kClock) return "";
  if (s.follows == "lagged") return s.law;
  if (s.follows == "running") return "while the spindle turns";
  if (s.follows == "since start" || s.follows == "since stop") return fmt::format("after each {}", s.follows.substr(6));
  if (s.follows == "exchanged") return "exchanged for one another";
  if (s.follows == "unknown") return "of a course that follows nothing recorded";
  if (s.follows == "constant" && s.law != "constant") return s.law;
  if (s.follows == "ramp" || s.follows == "window" || s.follows == "itself" || s.follows == "itself before") return s.law;
  if (s.follows.starts_with("power of ")) return "with " + s.law;
  if (s.follows.starts_with("own heat")) return s.law;
  if (s.follows.starts_with("temperature of ") && s.quantity == StatedQuantity::kDisplacement)
    return fmt::format("with the {}, {}", s.follows, s.law);
  return s.law.empty() || s.law == s.follows ? s.follows : s.law;
}

}  // namespace

Compared compared_of(const std::vector<diagnosis::MeasuredRun>& runs) {
  std::map<std::string, std::string> left_out;
  std::set<std::string> names;
  for (const diagnosis::MeasuredRun& run : runs) {
    for (const auto& [name, why] : run.left_out) left_out[name] = why;
    for (const diagnosis::MeasuredChannel& c : run.channels) names.insert(c.name);
  }
  Compared compared{.n = static_cast<int>(names.size()), .of = 0, .left_out = {}};
  for (auto& [name, why] : left_out) {
    if (!names.contains(name)) compared.left_out.emplace_back(name, why);
  }
  compared.of = compared.n + static_cast<int>(compared.left_out.size());
  return compared;
}

std::string compared_text(const Compared& compared) {
  if (compared.left_out.empty()) return "";
  std::vector<std::string> names;
  for (const auto& [name, why] : compared.left_out) names.push_back(name);
  return fmt::format(
      "{} of {} channels of the records {} compared; left out: {}. A channel is compared where the scenario has a sensor or "
      "displacement of its name; "
      "`columns` renames.",
      compared.n, compared.of, compared.n == 1 ? "is" : "are", fmt::join(names, ", "));
}

std::pair<std::string, double> shown_unit(const diagnosis::Stated& stated) {
  std::string unit = stated.says.unit;
  double scale = 1.0;
  if (unit.starts_with("m") && (unit.size() == 1 || unit[1] == '/')) unit = "um" + unit.substr(1), scale = 1e6;
  if (unit.starts_with("rad")) unit = "urad" + unit.substr(3), scale = 1e6;
  if (unit == "s") return {"min", 1.0 / 60.0};
  return {unit, scale};
}

std::string statement_text(const diagnosis::Statement& s) {
  const std::string course = follows(s);
  return what_and_where(s) + (course.empty() ? "" : ", " + course);
}

std::string size_text(const diagnosis::Stated& stated) {
  if (stated.says.follows == "exchanged") return "";
  const auto [unit, scale] = shown_unit(stated);
  const std::string of = unit == "1" ? "" : " " + unit;
  if (stated.low == stated.high) return fmt::format("about {:.2g}{}", scale * stated.size, of);
  return fmt::format("{:.3g}{} ({:.3g} to {:.3g})", scale * stated.size, of, scale * stated.low, scale * stated.high);
}

std::string records_text(const diagnosis::Statement& s) {
  std::vector<std::string> in;
  for (std::size_t r = 0; r < s.in_run.size(); ++r) {
    if (s.in_run[r]) in.push_back(s.record[r]);
  }
  return in.size() == s.in_run.size() ? "all" : fmt::format("{}", fmt::join(in, " and "));
}

}  // namespace driftwright::findings
