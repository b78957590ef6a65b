#include "compensation/judging/strategy_verdict.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace driftwright::compensation {
namespace {

/// True if more remains than without correction, by RMS or by peak.
bool is_worse_than_nothing(const Case& c) {
  return c.after.rmse > c.before.rmse || c.after.peak_abs > c.before.peak_abs;
}

/// The case in which correction is worst compared with no correction, among those that count; null if it is never worse.
const Case* worst_beside_nothing(const JudgedStrategy& s, const std::function<bool(const Case&)>& counts) {
  const auto excess_um = [](const Case& c) {
    return std::max(c.after.peak_abs - c.before.peak_abs, c.after.rmse - c.before.rmse);
  };
  const Case* worst = nullptr;
  for (const Case& c : s.cases) {
    if (counts(c) && is_worse_than_nothing(c) && (!worst || excess_um(c) > excess_um(*worst))) worst = &c;
  }
  return worst;
}

std::string where_of(const StrategyMatrix& m, const Case& c) {
  const JudgedRunOfMachine& run = m.runs[c.run];
  return fmt::format("on '{}'{}{}", run.name, run.season.empty() ? "" : fmt::format(" ({})", run.season),
                     c.failed.empty() ? "" : fmt::format(" with {}", c.failed));
}

constexpr std::size_t kMostNotKept = 3;  // runs, and failures, that a sentence names

KeptCells kept_cells(const StrategyMatrix& m, const JudgedStrategy& s) {
  KeptCells cells;
  std::vector<std::string> runs, failures;
  for (const Case& c : s.cases) {
    const bool is_intact = c.failed.empty(), keeps = c.after.peak_abs <= m.settings.tolerance_um;
    ++(is_intact ? cells.n_intact : cells.n_failed);
    if (keeps) {
      ++(is_intact ? cells.n_kept_intact : cells.n_kept_failed);
      continue;
    }
    std::vector<std::string>& list = is_intact ? runs : failures;
    std::string where = is_intact ? where_of(m, c) : "with " + c.failed;
    if (std::find(list.begin(), list.end(), where) == list.end()) list.push_back(std::move(where));
  }
  cells.n_not_kept = static_cast<int>(runs.size() + failures.size());
  for (std::vector<std::string>* list : {&runs, &failures}) {
    list->resize(std::min(list->size(), kMostNotKept));
    cells.not_kept.insert(cells.not_kept.end(), list->begin(), list->end());
  }
  return cells;
}

}  // namespace

std::string words_of(const KeptCells& cells, double tolerance_um) {
  std::string words = fmt::format("keeps {:g} µm in {} of {} cells", tolerance_um, cells.n_kept(), cells.n());
  if (cells.n_failed > 0) words += fmt::format(" ({} of {} with all sensors intact)", cells.n_kept_intact, cells.n_intact);
  if (cells.not_kept.empty()) return words;
  words += fmt::format(": not {}", fmt::join(cells.not_kept, ", "));
  const int n_more = cells.n_not_kept - static_cast<int>(cells.not_kept.size());
  return n_more > 0 ? fmt::format("{} and {} other{}", words, n_more, n_more == 1 ? "" : "s") : words;
}

void give_verdict(const StrategyMatrix& m, JudgedStrategy& s) {
  const double tolerance = m.settings.tolerance_um;
  const Worst all = worst_of(s, [](const Case&) { return true; });
  if (!all.peak) return;
  s.cells = kept_cells(m, s);
  const auto keeps = [&](const Case& c) { return c.after.peak_abs <= tolerance; };
  // a small increase while the drift passes through 0 does not count as harm
  const auto harms = [&](const Case& c) { return c.after.peak_abs > tolerance && c.harm_um > tolerance; };
  const Case* worse = worst_beside_nothing(s, [](const Case&) { return true; });
  s.is_worse_than_nothing = worse != nullptr;
  const Case* worse_beyond = worst_beside_nothing(s, [&](const Case& c) { return !keeps(c); });
  const auto beside_nothing = [&](const Case& c) {
    return fmt::format(
        "more is left than without any correction, RMS {:.1f} instead of {:.1f} µm and peak {:.1f} instead of {:.1f} µm {}",
        c.after.rmse, c.before.rmse, c.after.peak_abs, c.before.peak_abs, where_of(m, c));
  };
  if (std::all_of(s.cases.begin(), s.cases.end(), keeps)) {
    s.safety = Safety::kSafe;
    s.why = fmt::format("{}it leaves at most {:.1f} µm of the drift, {}{}",
                        worse ? fmt::format("{}, inside the tolerance, though: ", beside_nothing(*worse)) : "",
                        all.peak->after.peak_abs, where_of(m, *all.peak),
                        m.runs.size() > 2
                            ? ""
                            : fmt::format("; only {} run{} tried", m.runs.size(), m.runs.size() == 1 ? " was" : "s were"));
    return;
  }
  if (worse_beyond) {
    s.safety = Safety::kUnsafe;
    s.why = beside_nothing(*worse_beyond);
    return;
  }
  const auto harm = std::max_element(s.cases.begin(), s.cases.end(), [&](const Case& a, const Case& b) {
    return (harms(a) ? a.harm_um : 0.0) < (harms(b) ? b.harm_um : 0.0);
  });
  if (harms(*harm)) {
    s.safety = Safety::kUnsafe;
    s.why = fmt::format("it makes things worse, by up to {:.1f} µm at one moment ({:.1f} µm left of a peak of {:.1f} µm) {}",
                        harm->harm_um, harm->after.peak_abs, harm->before.peak_abs, where_of(m, *harm));
    return;
  }
  const std::vector<std::string> seasons = seasons_of(m);
  for (const std::string& family : families_of(m)) {
    std::vector<std::string> kept;
    for (const std::string& season : seasons) {
      if (std::all_of(s.cases.begin(), s.cases.end(), [&](const Case& c) {
            return !c.failed.empty() || m.runs[c.run].family != family || m.runs[c.run].season != season || keeps(c);
          }))
        kept.push_back(season);
    }
    if (kept.size() == seasons.size()) s.limits.push_back(family);
    if (!kept.empty() && kept.size() < seasons.size())
      s.limits.push_back(fmt::format("{} ({})", family, fmt::join(kept, ", ")));
  }
  if (!s.limits.empty() &&
      !std::all_of(s.cases.begin(), s.cases.end(), [&](const Case& c) { return c.failed.empty() || keeps(c); }))
    s.limits.emplace_back("all with sensors intact");
  const std::string worst = fmt::format("{:.1f} µm of {:.1f} µm are left {}", all.peak->after.peak_abs,
                                        all.peak->before.peak_abs, where_of(m, *all.peak));
  s.safety = s.limits.empty() ? Safety::kUnsafe : Safety::kWithinLimits;
  s.why = s.limits.empty() ? "nowhere does it keep the tolerance: " + worst
                           : fmt::format("it {}; {}", words_of(s.cells, tolerance), worst);
  if (worse) s.why = fmt::format("{}, inside the tolerance, though; {}", beside_nothing(*worse), s.why);
}

}  // namespace driftwright::compensation
