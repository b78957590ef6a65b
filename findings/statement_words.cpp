#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "findings/diagnosis_words.hpp"

namespace driftwright::findings {
namespace {

std::vector<std::string> names_left_out(const Compared& compared) {
  std::vector<std::string> names;
  for (const auto* list : {&compared.doubted, &compared.left_out}) {
    for (const auto& [name, why] : *list) names.push_back(name);
  }
  return names;
}

}  // namespace

Compared compared_of(const std::vector<diagnosis::MeasuredRun>& runs) {
  std::map<std::string, std::string> left_out, doubted;
  std::set<std::string> names;
  for (const diagnosis::MeasuredRun& run : runs) {
    for (const auto& [name, why] : run.left_out) left_out[name] = why;
    for (const diagnosis::MeasuredChannel& c : run.channels) names.insert(c.name);
    for (const DataFinding& f : run.findings) {
      if (f.leaves_out) doubted.try_emplace(f.channel, f.what);
    }
  }
  Compared compared{.n = static_cast<int>(names.size()), .of = 0, .left_out = {}};
  for (const auto& [name, why] : left_out) {
    if (!names.contains(name) && !doubted.contains(name)) compared.left_out.emplace_back(name, why);
  }
  for (const auto& [name, why] : doubted) {
    if (!names.contains(name)) compared.doubted.emplace_back(name, why);
  }
  compared.of = compared.n + static_cast<int>(compared.left_out.size() + compared.doubted.size());
  return compared;
}

std::string compared_clause(const Compared& compared) {
  if (compared.n == compared.of)
    return compared.n == 1 ? "its one channel is compared" : fmt::format("all of {} channels are compared", compared.n);
  return fmt::format("{} of {} channels {} compared; left out: {}", compared.n, compared.of, compared.n == 1 ? "is" : "are",
                     fmt::join(names_left_out(compared), ", "));
}

std::string compared_text(const Compared& compared) {
  if (compared.n == compared.of) return "";
  std::string text = fmt::format("{} of {} channels of the records {} compared; left out: {}.", compared.n, compared.of,
                                 compared.n == 1 ? "is" : "are", fmt::join(names_left_out(compared), ", "));
  if (!compared.doubted.empty())
    text += fmt::format(" \"The data themselves\" says what is wrong with {}.",
                        compared.doubted.size() == 1 ? compared.doubted.front().first : "those that the scenario has");
  if (!compared.left_out.empty())
    text +=
        " A channel is compared where the scenario has a sensor or displacement of its name; "
        "`columns` renames.";
  return text;
}

std::pair<std::string, double> shown_unit(const diagnosis::Stated& stated) {
  std::string unit = stated.says.unit;
  double scale = 1.0;
  if (unit.starts_with("m") && (unit.size() == 1 || unit[1] == '/')) unit = "um" + unit.substr(1), scale = 1e6;
  if (unit.starts_with("rad")) unit = "urad" + unit.substr(3), scale = 1e6;
  if (unit == "s") return {"min", 1.0 / 60.0};
  return {unit, scale};
}

std::string size_text(const diagnosis::Stated& stated) {
  if (stated.says.follows == "exchanged") return "";
  const auto [unit, scale] = shown_unit(stated);
  const std::string of = unit == "1" ? "" : " " + unit;
  if (stated.low == stated.high) return fmt::format("about {:.2g}{}", scale * stated.size, of);
  return fmt::format("{:.3g}{} ({:.3g} to {:.3g})", scale * stated.size, of, scale * stated.low, scale * stated.high);
}

}  // namespace driftwright::findings
