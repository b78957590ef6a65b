#include "output/twin/twin_law.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace driftwright::output {
namespace {

using AnyLaw = std::function<double(const Drive&, const std::vector<double>&)>;

constexpr double kSame = 1e-9;  // relative; smaller differences count as no interaction
constexpr int kTrials = 24;
constexpr double kNode_K = 1.0;      // spacing of nodes of a single temperature
constexpr double kWideNode_K = 4.0;  // spacing of nodes of a temperature beside a difference
constexpr int kDifferences = 80;  // nodes on either side of zero, spaced by their cube: dense where free convection begins

/// Drives and temperatures at which interactions are tested.
struct Trial {
  Drive drive;
  std::vector<double> probe_K;
};
std::vector<Trial> trials_of(int n_probes, const std::vector<DriveRange>& ranges, const TemperatureRange& range) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(0.05, 1.0), temperature(range.low_K, range.high_K);
  std::vector<Trial> trials(kTrials);
  for (Trial& t : trials) {
    for (const DriveRange& r : ranges) set_value(r.variable, t.drive, share(random) * r.most);
    for (int p = 0; p < n_probes; ++p) t.probe_K.push_back(temperature(random));
  }
  return trials;
}

/// The temperatures of some probes, with the usual temperature for the others.
std::vector<double> only(const std::vector<double>& probe_K, std::initializer_list<int> probes, double usual_K) {
  std::vector<double> t_K(probe_K.size(), usual_K);
  for (int p : probes) t_K[static_cast<std::size_t>(p)] = probe_K[static_cast<std::size_t>(p)];
  return t_K;
}

bool is_same(double a, double b, double scale) {
  return std::abs(a - b) <= kSame * (std::abs(scale) + std::abs(a) + std::abs(b));
}

/// Whether two probes interact: their joint effect differs from the sum of their single effects.
bool act_together(const AnyLaw& law, int p, int q, const std::vector<Trial>& trials, double usual_K) {
  return std::any_of(trials.begin(), trials.end(), [&](const Trial& t) {
    const auto at = [&](std::initializer_list<int> probes) { return law(t.drive, only(t.probe_K, probes, usual_K)); };
    const double none = at({}), both = at({p, q});
    return !is_same(both - none, at({p}) - none + (at({q}) - none), both);
  });
}

/// Whether the law depends on a probe at all.
bool counts(const AnyLaw& law, int p, const std::vector<Trial>& trials, double usual_K) {
  return std::any_of(trials.begin(), trials.end(), [&](const Trial& t) {
    return law(t.drive, only(t.probe_K, {p}, usual_K)) != law(t.drive, only(t.probe_K, {}, usual_K));
  });
}

/// Whether the law depends only on the difference of two probes.
bool is_of_difference(const AnyLaw& law, int p, int q, const std::vector<Trial>& trials, double usual_K) {
  return std::all_of(trials.begin(), trials.end(), [&](const Trial& t) {
    std::vector<double> here = only(t.probe_K, {p, q}, usual_K), there = here;
    const double shift_K = usual_K - here[static_cast<std::size_t>(q)];
    there[static_cast<std::size_t>(p)] += shift_K;
    there[static_cast<std::size_t>(q)] += shift_K;
    return is_same(law(t.drive, here), law(t.drive, there), 0.0);
  });
}

std::vector<double> even_nodes(double low, double high, double width) {
  const int n = std::max(2, static_cast<int>(std::ceil((high - low) / width)) + 1);
  std::vector<double> nodes;
  for (int i = 0; i < n; ++i) nodes.push_back(low + (high - low) * i / (n - 1));
  return nodes;
}
std::vector<double> difference_nodes(double most_K) {
  std::vector<double> nodes;
  for (int i = -kDifferences; i <= kDifferences; ++i) {
    const double s = static_cast<double>(i) / kDifferences;
    nodes.push_back(most_K * s * s * s);
  }
  return nodes;
}

/// Fills the table with the law at each node, other probes at their usual temperature. @returns false if twin_law() must
/// give up
bool fill(TwinTable& table, const AnyLaw& law, int n_probes, const std::vector<DriveRange>& ranges, double usual_K) {
  const std::size_t n_last = table.axes.back().nodes_K.size(),
                    n = n_last * (table.axes.size() == 2 ? table.axes.front().nodes_K.size() : 1);
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<double> t_K(static_cast<std::size_t>(n_probes), usual_K);
    const auto place = [&](const TwinAxis& axis, double node_K) {
      if (axis.minus < 0) {
        t_K[static_cast<std::size_t>(axis.probe)] = node_K;
      } else {  // the first probe keeps its temperature; the other one follows from the difference
        t_K[static_cast<std::size_t>(axis.minus)] = t_K[static_cast<std::size_t>(axis.probe)] - node_K;
      }
    };
    if (table.axes.size() == 2) place(table.axes.front(), table.axes.front().nodes_K[i / n_last]);
    place(table.axes.back(), table.axes.back().nodes_K[i % n_last]);
    std::optional<DriveLaw> over_drive = tabulated([&](const Drive& drive) { return law(drive, t_K); }, ranges);
    if (!over_drive || !std::isfinite(over_drive->at_rest)) return false;
    table.at.push_back(std::move(*over_drive));
  }
  return true;
}

}  // namespace

std::optional<TwinLaw> twin_law(const AnyLaw& law, int n_probes, const std::vector<DriveRange>& ranges,
                                const TemperatureRange& range) {
  const std::vector<double> usual(static_cast<std::size_t>(n_probes), range.usual_K);
  std::optional<DriveLaw> drive = tabulated([&](const Drive& d) { return law(d, usual); }, ranges);
  if (!drive) return std::nullopt;
  TwinLaw result{.drive = std::move(*drive)};
  const std::vector<Trial> trials = trials_of(n_probes, ranges, range);
  std::vector<int> partner(static_cast<std::size_t>(n_probes), -1);
  for (int p = 0; p < n_probes; ++p) {
    for (int q = p + 1; q < n_probes; ++q) {
      if (!act_together(law, p, q, trials, range.usual_K)) continue;
      if (partner[static_cast<std::size_t>(p)] >= 0 || partner[static_cast<std::size_t>(q)] >= 0) return std::nullopt;
      partner[static_cast<std::size_t>(p)] = q;
      partner[static_cast<std::size_t>(q)] = p;
    }
  }
  for (int p = 0; p < n_probes; ++p) {
    const int q = partner[static_cast<std::size_t>(p)];
    if ((q >= 0 && q < p) || !counts(law, p, trials, range.usual_K)) continue;
    TwinTable table;
    if (q < 0) {
      table.axes = {{p, -1, even_nodes(range.low_K, range.high_K, kNode_K)}};
    } else {
      if (!is_of_difference(law, p, q, trials, range.usual_K))
        table.axes.push_back({p, -1, even_nodes(range.low_K, range.high_K, kWideNode_K)});
      table.axes.push_back({p, q, difference_nodes(range.high_K - range.low_K)});
    }
    if (!fill(table, law, n_probes, ranges, range.usual_K)) return std::nullopt;
    result.tables.push_back(std::move(table));
  }
  return result;
}

}  // namespace driftwright::output
