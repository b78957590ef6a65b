#include "scenarios/reader/sweep_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "base/designs.hpp"
#include "base/normal.hpp"
#include "base/quantity.hpp"
#include "scenarios/reader/content_key.hpp"

namespace driftwright::scenarios {

const std::vector<std::pair<std::string, Scalar>>& scalar_names() {
  static const std::vector<std::pair<std::string, Scalar>> table = {{"peak", Scalar::kPeak},
                                                                    {"time_of_peak", Scalar::kTimeOfPeak},
                                                                    {"end", Scalar::kEnd},
                                                                    {"min", Scalar::kMin},
                                                                    {"max", Scalar::kMax}};
  return table;
}

std::string number_label(double number) {
  return fmt::format("{:.12g}", number);  // the table shows exactly the number that is simulated
}

SweepValue Variation::value_of(double number) const {
  const std::string text = number_label(number);
  return {scalar_at(*written_at, unit.empty() ? text : text + " " + unit), text, std::strtod(text.c_str(), nullptr)};
}

double Spread::at(double u) const {
  switch (kind) {
    case Kind::kUniform:
      return first + (second - first) * u;
    case Kind::kLogUniform:
      return first * std::pow(second / first, u);
    case Kind::kNormal:
      return first + second * normal_quantile(u);
  }
  throw std::logic_error("Spread: no such kind");
}

std::string Variation::header() const {
  return is_number ? fmt::format("{}_{}", name, unit_in_name(unit)) : name;
}

std::string CollectedScalar::header() const {
  const auto named =
      std::find_if(scalar_names().begin(), scalar_names().end(), [&](const auto& s) { return s.second == scalar; });
  return fmt::format("{}_{}_{}_{}", cyclogram, channel, named->first, scalar == Scalar::kTimeOfPeak ? "s" : unit);
}

SweepValue SweepPlan::value(std::size_t member, std::size_t variation) const {
  const Variation& v = variations[variation];
  if (design == Design::kList) return v.values[member];
  if (design == Design::kGrid) {
    std::vector<std::size_t> sizes;
    for (const Variation& each : variations) sizes.push_back(each.values.size());
    return v.values[grid_point(member, sizes)[variation]];
  }
  const double u = samples(static_cast<Eigen::Index>(member), static_cast<Eigen::Index>(variation));
  if (v.spread) return v.value_of(v.spread->at(u));
  return v.values[static_cast<std::size_t>(u * static_cast<double>(v.values.size()))];
}

namespace {

ConfigNodePtr tree_of(const SweepPlan& plan, std::size_t member) {
  ConfigNodePtr tree = plan.scenario;
  for (std::size_t i = 0; i < plan.variations.size(); ++i) {
    const SweepValue chosen = plan.value(member, i);
    for (const ConfigSteps& place : plan.variations[i].places) tree = replaced(tree, place, chosen.node);
  }
  return tree;
}

}  // namespace

ConfigMap SweepPlan::scenario_of(std::size_t member) const {
  return ConfigMap::of_tree(tree_of(*this, member));
}

std::string SweepPlan::table_header() const {
  std::string header = "member";
  for (const Variation& v : variations) header += fmt::format(",{}", v.header());
  for (const CollectedScalar& c : collect) header += fmt::format(",{}", c.header());
  return header + ",status";
}

namespace {

/// The effects of a member that change thermal expansion, on which influence vectors depend, as written.
std::string expansion_factors(const SweepPlan& plan, std::size_t member) {
  const ConfigNodePtr tree = tree_of(plan, member);
  const ConfigNode* effects = tree->find("effects");
  std::string text;
  if (!effects || !effects->is_list()) return text;
  for (const ConfigNodePtr& effect : effects->items) {
    const ConfigNode* type = effect->is_map() ? effect->find("type") : nullptr;
    if (type && type->text == "expansion") text += written(*effect) + "\n";
  }
  return text;
}

}  // namespace

std::string sharing_key(const SweepPlan& plan, std::size_t member, Shared what) {
  static const std::set<std::string> of_run = {"cyclograms", "ambient", "solver", "start"};
  static const std::set<std::string> of_structure = {"machine", "materials", "supports", "joints", "axes", "displacements", "tilts"};
  std::string key;
  for (std::size_t i = 0; i < plan.variations.size(); ++i) {
    const std::vector<std::string>& tops = plan.variations[i].tops;
    const bool decides = std::any_of(tops.begin(), tops.end(), [&](const std::string& top) {
      return what == Shared::kStructure ? of_structure.contains(top) : !of_run.contains(top);
    });
    if (decides) key += plan.value(member, i).label + "\n";
  }
  if (what == Shared::kStructure) key += expansion_factors(plan, member);
  return key;
}

std::vector<std::size_t> members_of_part(const SweepPlan& plan, std::size_t part, std::size_t n_parts) {
  std::map<std::string, std::size_t> structures, machines;  // by their first member
  std::vector<std::array<std::size_t, 3>> order;            // structure, machine, member
  for (std::size_t m = 0; m < plan.n_members; ++m) {
    const std::size_t structure = structures.try_emplace(sharing_key(plan, m, Shared::kStructure), m).first->second;
    const std::size_t machine = machines.try_emplace(sharing_key(plan, m, Shared::kMachine), m).first->second;
    order.push_back({structure, machine, m});
  }
  std::sort(order.begin(), order.end());
  std::vector<std::size_t> members;
  for (std::size_t i = part * plan.n_members / n_parts; i < (part + 1) * plan.n_members / n_parts; ++i)
    members.push_back(order[i][2]);
  return members;
}

std::string content_key(const SweepPlan& plan, const std::string& version) {
  return content_key({plan.study, plan.scenario}, std::filesystem::path(plan.scenario->source->path).parent_path(),
                     {version});
}

}  // namespace driftwright::scenarios
