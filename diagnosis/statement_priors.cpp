// Priors of statements: of records, and of quantities, places, courses and laws.

#include <cmath>
#include <set>

#include "diagnosis/statement_evidence.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr std::size_t kFewRecords = 5;  // with more records, unordered choices are left out

}  // namespace

/// All records, one alone, the first ones or the last ones; with few records also any others.
void StatementEvidence::set_records() {
  const std::size_t n = space_.rows.size();
  if (n == 1) {
    records_.push_back({{1}, 0.0});
    return;
  }
  std::vector<std::vector<char>> near, far;
  if (n <= kFewRecords) {
    for (unsigned mask = 1; mask + 1 < (1u << n); ++mask) {
      std::vector<char> in;
      std::size_t changes = 0, count = 0;
      for (std::size_t r = 0; r < n; ++r) {
        in.push_back((mask >> r & 1u) != 0);
        count += in.back();
        if (r > 0 && in[r] != in[r - 1]) ++changes;
      }
      (count == 1 || changes == 1 ? near : far).push_back(std::move(in));
    }
  } else {
    for (std::size_t r = 0; r < n; ++r) {
      near.emplace_back(n, 0);
      near.back()[r] = 1;
      if (r < 1 || r + 1 >= n) continue;
      near.emplace_back(n, 0);
      std::fill(near.back().begin() + static_cast<std::ptrdiff_t>(r), near.back().end(), 1);
      near.emplace_back(n, 1);
      std::fill(near.back().begin() + static_cast<std::ptrdiff_t>(r), near.back().end(), 0);
    }
  }
  records_.push_back({std::vector<char>(n, 1), std::log(options_.all_records)});
  const double some = 1.0 - options_.all_records, rare = far.empty() ? 0.0 : options_.rare_records;
  for (auto& in : near)
    records_.push_back({std::move(in), std::log(some * (1.0 - rare) / static_cast<double>(near.size()))});
  for (auto& in : far) records_.push_back({std::move(in), std::log(some * rare / static_cast<double>(far.size()))});
}

/// Uniform on each level: quantity, place, course, shape, records.
void StatementEvidence::set_priors() {
  std::map<StatedQuantity, std::map<std::vector<std::string>, std::map<std::string, std::set<std::string>>>> tree;
  for (const StatementColumn& c : space_.columns) tree[c.says.quantity][c.says.place][c.says.follows].insert(c.says.law);
  for (const StatementCells& c : space_.cells) {
    tree[c.says.quantity][c.says.place]["window"].insert(c.says.law);
    if (!c.lasts) tree[c.says.quantity][c.says.place]["unknown"].insert(c.says.law);
  }
  const auto price = [&](const Statement& s, const std::string& follows) {
    const auto& places = tree.at(s.quantity);
    const auto& all = places.at(s.place);
    return -std::log(static_cast<double>(tree.size())) - std::log(static_cast<double>(places.size())) -
           std::log(static_cast<double>(all.size())) - std::log(static_cast<double>(all.at(follows).size()));
  };
  for (const StatementColumn& c : space_.columns) prior_.push_back(price(c.says, c.says.follows));
  for (const StatementCells& c : space_.cells)
    prior_cells_.push_back({price(c.says, "window"), c.lasts ? 0.0 : price(c.says, "unknown")});
}

}  // namespace driftwright::diagnosis
