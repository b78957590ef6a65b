#include "mesh/step_unit.hpp"

#include <fmt/format.h>

#include <cctype>
#include <map>
#include <set>

#include "base/errors.hpp"
#include "base/file_bytes.hpp"
#include "base/pattern.hpp"

namespace driftwright::mesh {
namespace {

/// The instances of the exchange structure (ISO 10303-21) that concern units, by their names such as "#36", without blanks.
std::map<std::string, std::string> unit_instances(const std::string& text) {
  std::map<std::string, std::string> instances;
  for (std::size_t begin = 0, end = 0; (end = text.find(';', begin)) != std::string::npos; begin = end + 1) {
    std::string instance;
    for (std::size_t i = begin; i < end; ++i) {
      if (std::isspace(static_cast<unsigned char>(text[i])) == 0) instance += text[i];
    }
    const std::size_t equals = instance.find('=');
    if (equals == std::string::npos || instance.front() != '#' || instance.find("UNIT") == std::string::npos) continue;
    instances[instance.substr(0, equals)] = instance.substr(equals + 1);
  }
  return instances;
}

/// The length of a unit of length; 0 if the unit is unknown.
double metres_of(const std::string& instance) {
  static const std::map<std::string, double> prefixes = {{"$", 1.0},        {".KILO.", 1e3},   {".DECI.", 1e-1},
                                                         {".CENTI.", 1e-2}, {".MILLI.", 1e-3}, {".MICRO.", 1e-6}};
  static const std::map<std::string, double> named = {{"INCH", 0.0254}, {"FOOT", 0.3048}};
  static const Pattern conversion("CONVERSION_BASED_UNIT\\('([^']*)'"), si("SI_UNIT\\(([^,]*),\\.METRE\\.\\)");
  if (const auto parts = conversion.find(instance)) {
    const auto known = named.find(parts->at(1));
    return known == named.end() ? 0.0 : known->second;
  }
  const auto parts = si.find(instance);
  if (!parts) return 0.0;
  const auto known = prefixes.find(parts->at(1));
  return known == prefixes.end() ? 0.0 : known->second;
}

}  // namespace

double unit_of_step_m(const std::string& path) {
  const std::map<std::string, std::string> instances = unit_instances(read_bytes(path));
  static const Pattern assigned("GLOBAL_UNIT_ASSIGNED_CONTEXT\\(\\(([^)]*)\\)\\)"), reference("#[0-9]+");
  std::set<double> units_m;
  for (const auto& [name, context] : instances) {
    const auto list = assigned.find(context);
    if (!list) continue;
    std::string references = list->at(1);
    while (const auto one = reference.find(references)) {
      references.erase(0, references.find(one->front()) + one->front().size());
      const auto unit = instances.find(one->front());
      if (unit != instances.end() && unit->second.find("LENGTH_UNIT") != std::string::npos)
        units_m.insert(metres_of(unit->second));
    }
  }
  if (units_m.size() != 1 || *units_m.begin() == 0.0)
    throw InputError(fmt::format(
        "{}: the unit of length that the file says is not made out, so that its numbers cannot be taken in another one; "
        "write the drawing anew in mm",
        path));
  return *units_m.begin();
}

}  // namespace driftwright::mesh
