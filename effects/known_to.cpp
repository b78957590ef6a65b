#include "effects/known_to.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace driftwright::effects {
namespace {

constexpr const char* kKey = "known_to";

double read_share(const ConfigMap& in, const std::string& key) {
  const std::string text = in.text(key);
  if (text == "fixed") return 0.0;
  if (text == "guess") return kGuess;
  if (text.empty() || !(text.front() >= '0' && text.front() <= '9'))
    in.fail(key, fmt::format("'{}' does not say how well a number is known; it must be a share such as 20 %, `guess` (a "
                             "factor of 2) or `fixed`",
                             text));
  return in.quantity(key);
}

std::string word(double share) {
  return share == 0.0 ? "fixed" : share == kGuess ? "guess" : fmt::format("{:.12g} %", 100.0 * share);
}

}  // namespace

schema::Key known_to_key(const std::vector<std::string>& names) {
  const schema::Ways share = {schema::choice({"fixed", "guess"}), schema::quantity("1", 1e-3, 2.0)};
  schema::Map by_name{
      .name = fmt::format("known_to ({})", names.empty() ? "by name" : fmt::format("{}", fmt::join(names, ", "))),
      .about = "How well single numbers are known: 1 sigma of their logarithms."};
  for (const std::string& name : names)
    by_name.keys.push_back(schema::optional(name, share, schema::Said{}, "as `known_to`"));
  if (names.empty()) by_name.others.push_back(schema::optional("name of a number", share, schema::Said{}, "as `known_to`"));
  schema::Ways ways = share;
  ways.push_back(schema::map(by_name));
  return schema::optional(kKey, ways, schema::Said{"10 %, exponents 3 %"},
                          "how well its numbers are known: 1 sigma of their logarithms, `guess` (a factor of 2), `fixed` "
                          "(as they are), or a map of these by number");
}

KnownTo read_known_to(const ConfigMap& in, const std::vector<std::string>& names) {
  if (names.empty() && in.description().find(kKey) && in.has(kKey))
    in.fail(kKey, "this entry has no number that a diagnosis calibrates");
  if (names.empty() || !in.has(kKey)) return {};
  if (!in.is_map(kKey)) return {{"", read_share(in, kKey)}};
  const ConfigMap by_name = in.map(kKey);
  KnownTo said;
  for (const std::string& name : by_name.keys()) {
    if (std::find(names.begin(), names.end(), name) == names.end())
      by_name.fail(name, fmt::format("this must be a number that a diagnosis calibrates: {}", fmt::join(names, ", ")));
    said[name] = read_share(by_name, name);
  }
  return said;
}

double known_to(const KnownTo& said, const std::string& name, double otherwise) {
  for (const std::string& key : {name, std::string()}) {
    if (const auto found = said.find(key); found != said.end()) return found->second;
  }
  return otherwise;
}

std::string yaml_of(const KnownTo& said) {
  if (said.size() == 1 && said.begin()->first.empty()) return word(said.begin()->second);
  std::string text;
  for (const auto& [name, share] : said) text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", name, word(share));
  return "{" + text + "}";
}

}  // namespace driftwright::effects
