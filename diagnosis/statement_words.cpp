#include <fmt/format.h>
#include <fmt/ranges.h>

#include "diagnosis/statement.hpp"

namespace driftwright::diagnosis {

std::string subject_words(const Statement& s) {
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

std::string course_words(const Statement& s) {
  if (s.follows == "expansion") return "";
  if (s.quantity == StatedQuantity::kClock && s.follows == "constant") return "";  // the size is enough
  if (s.follows == "lagged") return s.law;
  if (s.follows == "running") return "while the spindle turns";
  if (s.follows == "since start" || s.follows == "since stop") return fmt::format("after each {}", s.follows.substr(6));
  if (s.follows == "exchanged") return "exchanged for one another";
  if (s.follows == "unknown") return "of a course that follows nothing recorded";
  if (s.follows == "constant" && s.law != "constant") return s.law;
  if (s.follows == "late" || s.follows == "height" || s.follows == "ramp" || s.follows == "window" ||
      s.follows == "itself" || s.follows == "itself before")
    return s.law;
  if (s.follows.starts_with("power of ")) return "with " + s.law;
  if (s.follows.starts_with("own heat")) return s.law;
  if (s.follows.starts_with("temperature of ") && s.quantity == StatedQuantity::kDisplacement)
    return fmt::format("with the {}, {}", s.follows, s.law);
  return s.law.empty() || s.law == s.follows ? s.follows : s.law;
}

std::string words(const Statement& s) {
  const std::string course = course_words(s);
  return subject_words(s) + (course.empty() ? "" : ", " + course);
}

std::string records_text(const Statement& s) {
  std::vector<std::string> in;
  for (std::size_t r = 0; r < s.in_run.size(); ++r) {
    if (s.in_run[r]) in.push_back(s.record[r]);
  }
  return in.size() == s.in_run.size() ? "all" : fmt::format("{}", fmt::join(in, " and "));
}

}  // namespace driftwright::diagnosis
