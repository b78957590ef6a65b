#include "findings/plausibility.hpp"

#include "scenarios/reader/unusual.hpp"

namespace driftwright::findings {
namespace {

constexpr const char* kPlausibility = "plausibility";

}  // namespace

void add_plausibility(output::Section& body, const scenarios::Scenario& scenario, const std::vector<std::string>& found) {
  std::vector<std::string> lines = scenarios::unusual_numbers(scenario);
  lines.insert(lines.end(), found.begin(), found.end());
  add(body, output::Notes{.key = kPlausibility, .sort = "warning", .lines = lines});
}

std::vector<std::string> implausible(const output::Document& document) {
  for (const output::Block& block : document.body.blocks) {
    const auto* notes = std::get_if<output::Notes>(&block);
    if (notes && notes->key == kPlausibility) return notes->lines;
  }
  return {};
}

}  // namespace driftwright::findings
