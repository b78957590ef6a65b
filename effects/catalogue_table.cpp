#include "effects/catalogue_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "base/quantity.hpp"
#include "effects/formula.hpp"

namespace driftwright::effects {
namespace {

std::string places_of(const EffectKind& kind) {
  std::vector<std::string> names;
  for (const Place p : kind.places) names.emplace_back(place_key(p));
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string described(const Parameter& p) {
  const std::string unit = p.unit == "1" ? "" : " [" + p.unit + "]";
  if (!p.fallback) return fmt::format("**{}**{}: {}", p.name, unit, p.meaning);
  if (std::isnan(*p.fallback)) return fmt::format("{}{}: {}", p.name, unit, p.meaning);
  const double shown = p.unit == "degC" ? *p.fallback - kZeroCelsius_K : *p.fallback;
  return fmt::format("{}{} = {:g}: {}", p.name, unit, shown, p.meaning);
}

/// All keys except type and place; compulsory ones in bold.
std::string keys_of(const EffectKind& kind) {
  std::vector<std::string> keys;
  for (const Parameter& p : kind.parameters) keys.push_back(described(p));
  const auto named = [&](const auto& list, const auto& is_compulsory) {
    for (const auto& k : list)
      keys.push_back(fmt::format(fmt::runtime(is_compulsory(k) ? "**{}**: {}" : "{}: {}"), k.name, k.meaning));
  };
  named(kind.references, [](const Reference& r) { return !r.fallback; });
  for (const Choice& c : kind.choices)
    keys.push_back(fmt::format("{} ({}): {}", c.name, fmt::join(c.options, ", "), c.meaning));
  named(kind.tables, [](const Table& t) { return t.compulsory; });
  named(kind.mentions, [](const Mention& m) { return m.compulsory; });
  if (kind.timing == Timing::kInTime) keys.emplace_back("from, until, in");
  if (kind.timing == Timing::kInRecord) keys.emplace_back("in");
  return fmt::format("{}", fmt::join(keys, "; "));
}

}  // namespace

std::string catalogue_table() {
  std::string text =
      "| type | what it is | place | keys: compulsory ones in bold, others with what holds when they are left out | law | "
      "looked for by "
      "`diagnose` |\n|---|---|---|---|---|---|\n";
  for (const EffectKind& kind : catalogue()) {
    std::string law = kind.law;
    for (std::size_t at = 0; (at = law.find('|', at)) != std::string::npos; at += 2) law.replace(at, 1, "\\|");
    text += fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", kind.key, kind.title, places_of(kind), keys_of(kind), law,
                        kind.doubts                      ? "yes"
                        : !kind.exchange_finding.empty() ? "as another size"
                        : has_formula(kind)              ? "as other numbers"
                                                         : "");
  }
  return text;
}

}  // namespace driftwright::effects
