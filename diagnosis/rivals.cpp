#include "diagnosis/rivals.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace driftwright::diagnosis {
namespace {

bool is_of_kind(const Rival& rival, const Rival& claim) {
  return rival.says_the_same || rival.effect == claim.effect;
}

}  // namespace

std::vector<double> shares_of(const std::vector<Rival>& rivals) {
  double most = rivals.front().log_evidence, sum = 0.0;
  for (const Rival& r : rivals) most = std::max(most, r.log_evidence);
  std::vector<double> shares;
  for (const Rival& r : rivals) shares.push_back(std::exp(r.log_evidence - most));
  for (double s : shares) sum += s;
  for (double& s : shares) s /= sum;
  return shares;
}

Odds odds_of(const std::vector<Rival>& rivals) {
  const std::vector<double> shares = shares_of(rivals);
  const Rival& claim = rivals.front();
  double kind = 0.0, place = 0.0;
  for (std::size_t i = 0; i < rivals.size(); ++i) {
    if (!is_of_kind(rivals[i], claim)) continue;
    kind += shares[i];
    if (rivals[i].says_the_same || rivals[i].where == claim.where) place += shares[i];
  }
  return {kind, place / kind};
}

std::vector<std::size_t> open_rivals(const std::vector<Rival>& rivals) {
  const Odds odds = odds_of(rivals);
  const bool is_kind_open = odds.kind < kSure;
  if (!is_kind_open && odds.place >= kSure) return {};
  const std::vector<double> shares = shares_of(rivals);
  std::vector<std::size_t> order;
  double told = 0.0;  // share of the claim and of claims with the same meaning
  for (std::size_t i = 0; i < rivals.size(); ++i) {
    if (i == 0 || rivals[i].says_the_same) {
      told += shares[i];
    } else if (is_kind_open || is_of_kind(rivals[i], rivals.front())) {
      order.push_back(i);
    }
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return shares[a] > shares[b]; });
  const double all = is_kind_open ? 1.0 : odds.kind;
  std::vector<std::size_t> open;
  for (std::size_t i : order) {
    if (told >= kSure * all) break;
    open.push_back(i);
    told += shares[i];
  }
  return open;
}

}  // namespace driftwright::diagnosis
