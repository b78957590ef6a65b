#include "compensation/judging/choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "compensation/judging/strategies.hpp"

namespace driftwright::compensation {
namespace {

constexpr double kNoError_um = 1e-6;  // smaller errors are rounding
constexpr double kTellsApart = 2.0;   // standard errors of a difference; chance exceeds it in one of twenty cases

/// Difference of the mean squares of two strategies in units of its standard error, fold by fold; both have the same folds.
double standard_errors_above(const DeployedPredictor& a, const DeployedPredictor& b) {
  const auto n = static_cast<double>(a.fold_errors.size());
  double sum = 0.0, squares = 0.0;
  for (std::size_t k = 0; k < a.fold_errors.size(); ++k) {
    const double more = std::pow(a.fold_errors[k].rms_um, 2) - std::pow(b.fold_errors[k].rms_um, 2);
    sum += more;
    squares += more * more;
  }
  const double error = n > 1.0 ? std::sqrt(std::max(squares - sum * sum / n, 0.0) * n / (n - 1.0)) : 0.0;  // of the sum
  return error > 0.0 ? sum / error : sum > 0.0 ? std::numeric_limits<double>::infinity() : 0.0;
}

/// The first of the strategies that count whose mean square is within one standard error of one of them.
const DeployedPredictor& simplest_near(std::span<const DeployedPredictor> list, const DeployedPredictor& best,
                                       const std::function<bool(const DeployedPredictor&)>& counts) {
  for (const DeployedPredictor& d : list) {
    if (&d == &best ||
        (counts(d) && d.fold_errors.size() == best.fold_errors.size() && standard_errors_above(d, best) <= 1.0))
      return d;
  }
  return best;
}

}  // namespace

double left_out_um(const DeployedPredictor& strategy) {
  std::map<std::string, std::pair<double, int>> squares_of;  // sum, and number of terms
  for (const FoldError& e : strategy.fold_errors) {
    squares_of[e.kind].first += e.rms_um * e.rms_um;
    ++squares_of[e.kind].second;
  }
  if (squares_of.empty()) return std::numeric_limits<double>::infinity();
  double logarithms = 0.0;
  for (const auto& [kind, squares] : squares_of)
    logarithms += 0.5 * std::log(std::max(squares.first / squares.second, kNoError_um * kNoError_um));
  return std::exp(logarithms / static_cast<double>(squares_of.size()));
}

namespace {

/// The choice among strategies, of which no correction is one like the others.
Choice chosen_of(std::span<const DeployedPredictor> strategies) {
  const DeployedPredictor *best = nullptr, *mean = nullptr;
  for (const DeployedPredictor& d : strategies) {
    if (d.fold_errors.empty()) continue;
    if (!best || left_out_um(d) < left_out_um(*best)) best = &d;
    if (d.name == kBlend) mean = &d;
  }
  if (!best) return {};
  const auto is_alike = [&](const DeployedPredictor& d) { return left_out_um(d) <= kAlike * left_out_um(*best); };
  const auto said = [](const DeployedPredictor& d) { return fmt::format("'{}' leaves {:.3g} µm", d.name, left_out_um(d)); };
  const auto because = [](const DeployedPredictor& d, const std::string& words) -> Choice {
    return {d.name, fmt::format("on the parts of the training runs that were left out it leaves {:.3g} µm, {}",
                                left_out_um(d), words)};
  };
  const auto rest = [&](const DeployedPredictor& d) {
    return &d == best ? std::string("the least of all") : said(*best) + ", with too small a difference to distinguish them";
  };
  const DeployedPredictor* model = nullptr;
  for (const DeployedPredictor& d : strategies) {
    if (!d.predictor || !d.predictor->is_driven() || d.fold_errors.empty() || !is_alike(d)) continue;
    if (!model || d.failed_um.value_or(0.0) < model->failed_um.value_or(0.0)) model = &d;
  }
  if (model)
    return because(*model,
                   rest(*model) + "; it was preferred because a model of the machine also holds outside the training runs" +
                       (model->failed_um
                            ? fmt::format(", and with a failed sensor it leaves at most {:.3g} µm on left-out parts of them",
                                          *model->failed_um)
                            : ""));
  if (mean && (is_alike(*mean) || standard_errors_above(*mean, *best) < kTellsApart)) return because(*mean, rest(*mean));
  const DeployedPredictor& simplest = simplest_near(strategies, *best, is_alike);
  return because(simplest, (&simplest == best ? "the least of all"
                                              : "the simplest within one standard error of the least; " + said(*best)) +
                               (mean ? "; " + said(*mean) : ""));
}

}  // namespace

Choice choose(std::span<const DeployedPredictor> strategies) {
  Choice choice = chosen_of(strategies);
  const auto named = [&](const std::string& name) {
    return std::find_if(strategies.begin(), strategies.end(), [&](const DeployedPredictor& d) { return d.name == name; });
  };
  const auto chosen = named(choice.name), none = named(kNoCorrection);
  if (chosen == strategies.end() || none == strategies.end() || chosen == none || none->fold_errors.empty()) return choice;
  const double left = left_out_um(*chosen), uncorrected = left_out_um(*none);
  if (left < uncorrected) return choice;
  return {"",
          fmt::format("On the parts of the training runs that were left out '{}' leaves {:.3g} µm, and no correction {:.3g} "
                      "µm: a correction must gain there",
                      chosen->name, left, uncorrected)};
}

}  // namespace driftwright::compensation
