#include "studies/known_band.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "base/designs.hpp"
#include "base/normal.hpp"
#include "diagnosis/scatter.hpp"
#include "effects/learned.hpp"
#include "studies/band_limits.hpp"
#include "studies/drawn_machines.hpp"
#include "studies/prediction.hpp"

namespace driftwright::studies {
namespace {

using diagnosis::Knob, diagnosis::Twin;

constexpr std::size_t kMostBandRows = 250;  // of a longer record the band is linear between this many of its rows
constexpr std::uint64_t kBandSeed = 1;
constexpr double kSameValue = 3e-6;  // seven digits of the number, of a factor beside it, and of its copy err by 1.5e-6
constexpr Eigen::Index kFewStates = 60;
constexpr int kFewestDraws = 80;

/// Number of machines that are drawn: as many as `predict` takes at most twice its time for (0.3 to 0.4 s of processor
/// time). A machine whose laws depend on the drive alone takes 0.05 ms (two bodies) to 1.4 ms (49 states) a draw, so
/// kBandDraws of them fit; the time grows with the cube of the states. Laws of temperatures need steps in time, 3 ms a draw
/// for six bodies with a thermostat. Then 80 draws, and four for each number, leave limits of bent functions 2 to 4 % of the
/// half width wrong (band_limits.hpp); half of them may have no solution.
int n_draws_of(const solver::ReducedSystem& system, std::size_t n_knobs) {
  const bool is_quick = system.is_linear() && system.size() <= kFewStates;
  return std::max(4 * (static_cast<int>(n_knobs) + 1), is_quick ? kBandDraws : kFewestDraws);
}

/// Rows of the record at which the band is computed.
std::vector<std::size_t> band_rows(std::size_t n_rows) {
  const std::size_t n = std::min(n_rows, kMostBandRows);
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < n; ++i) rows.push_back(n == 1 ? 0 : i * (n_rows - 1) / (n - 1));
  return rows;
}

/// The run as the twin takes it, at some rows of the record.
diagnosis::MeasuredRun banded_run_of(const BandedRun& run, const std::vector<std::size_t>& rows) {
  diagnosis::MeasuredRun asked;
  asked.name = run.cyclogram.name;
  asked.cyclogram = run.cyclogram;
  asked.ambient = run.ambient;
  for (const std::size_t row : rows) {
    asked.row_in_grid.push_back(static_cast<Eigen::Index>(asked.grid_s.size()));
    asked.grid_s.push_back(run.first_row_s + run.record.time_s[row]);
  }
  asked.time_s = asked.grid_s;
  return asked;
}

/// The reduced model that the draws are run on.
scenarios::ReducedMachine reduced_of(const scenarios::Scenario& scenario, const BandedRun& run, const Listener& listener) {
  scenarios::ReductionPlan plan = scenarios::reduction_plan(scenario, {&run.cyclogram});
  plan.n_modes = 0;
  plan.with_fields = false;
  if (const scenarios::Machine* full = run.model.full(); full && run.model.mesh().n_nodes() == 0)
    return scenarios::reduce(*scenario.machine, *full, plan);
  return scenarios::open_reduced(*scenario.machine, plan, listener);
}

/// "10 to 30 %", "a factor of 2": one sigma of the numbers.
std::string known_words(const std::vector<Knob>& knobs) {
  const auto [least, most] =
      std::minmax_element(knobs.begin(), knobs.end(), [](const Knob& a, const Knob& b) { return a.prior_sd < b.prior_sd; });
  const auto word = [](double sd) { return sd == effects::kGuess ? "a factor of 2" : fmt::format("{:.3g} %", 100.0 * sd); };
  if (least->prior_sd == most->prior_sd) return word(least->prior_sd);
  if (most->prior_sd == effects::kGuess) return word(least->prior_sd) + " to " + word(most->prior_sd);
  return fmt::format("{:.3g} to {}", 100.0 * least->prior_sd, word(most->prior_sd));
}

/// What the effects `learned` of a channel still miss at these times of a run, within their hull (`misses`) and beyond it:
/// one sigma, in the unit of the channel; 0 where they do not say. Of several `misses` the last one counts, which was
/// learned beside the others.
Eigen::VectorXd remaining_of(const scenarios::MachineModel& machine, const Cyclogram& run, const Channel& channel,
                             const std::vector<double>& time_s) {
  double misses = 0.0;
  for (const effects::Effect& e : machine.effects) {
    if (e.kind->key == "learned" && e.place == channel.name && e.acts_in(run.name) && e.has("misses")) misses = e["misses"];
  }
  const bool is_length = channel.unit == "um" || channel.unit == "urad";
  const effects::Place kind = is_length ? effects::Place::kDisplacement : effects::Place::kSensor;
  const Eigen::VectorXd beyond =
      (is_length ? 1e6 : 1.0) * effects::learned_sd_beyond(machine.effects, kind, channel.name, time_s, run).transpose();
  return (beyond.array().square() + misses * misses).sqrt();
}

/// 95 % limits of what uncertain numbers change, at some rows of the record.
struct NumbersBand {
  std::map<std::string, BandLimits> limits;  ///< by channel, in its unit; not of one that they do not change
  std::vector<Knob> numbers;                 ///< that are uncertain; none: there are no limits
  bool are_fitted = false;                   ///< some of them together (`known_together`)
  std::size_t n_draws = 0, n_left_out = 0;
};

std::string words_of_band(const NumbersBand& drawn, std::size_t n_learned) {
  std::string words, without = "nor what the model itself lacks";
  if (!drawn.numbers.empty())
    words = fmt::format(
        "The bands hold 95 % of the machines that the scenario allows: {} number{} known to {} ({}, one sigma). ",
        drawn.numbers.size(), drawn.numbers.size() == 1 ? "" : "s", known_words(drawn.numbers),
        drawn.are_fitted ? "`known_together` and `known_to`" : "`known_to`");
  if (n_learned > 0) {
    words += fmt::format(
        "The bands of {} channel{} contain what the effects `learned` still miss (`misses`, one sigma), more beyond the "
        "drives they were learned from. ",
        n_learned, n_learned == 1 ? "" : "s");
    without = "nor what the model lacks in other channels";
  }
  words += fmt::format("They do not contain numbers without `known_to`, {}.", without);
  if (drawn.n_left_out > 0)
    words += fmt::format(" {} of {} drawn machines have no solution and are left out.", drawn.n_left_out, drawn.n_draws);
  return words;
}

RecordBand no_band(const std::string& why) {
  return {.limits = {}, .words = fmt::format("There are no bands: {}", why.substr(0, why.find('\n')))};
}

/// The numbers that are uncertain and how: independent scores times the transposed factor are their deviations. A number of
/// `known_together` deviates as its fit says, others with a `known_to` each by itself.
/// @throws SolveError  if `known_together` names a number that the machine does not have, or has with another value
struct UncertainNumbers {
  std::vector<Knob> knobs;
  Eigen::MatrixXd factor;
};
UncertainNumbers uncertain_numbers(const Twin& twin, const scenarios::KnownTogether& together) {
  UncertainNumbers uncertain;
  std::vector<Knob> all = diagnosis::scatter(twin);
  const std::vector<std::string> names = diagnosis::number_names(twin, all);
  for (std::size_t i = 0; i < together.numbers.size(); ++i) {
    const std::string& name = together.numbers[i];
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end())
      throw SolveError(
          fmt::format("`known_together` names '{}', which the scenario does not have or has as `fixed`. Calibrate it "
                      "again, or delete `known_together`.",
                      name));
    Knob& knob = all[static_cast<std::size_t>(at - names.begin())];
    const double value = diagnosis::written_value(twin, knob), fitted = together.values[i];
    if (std::abs(value - fitted) > kSameValue * std::abs(fitted))
      throw SolveError(
          fmt::format("'{}' is {:.7g} in SI units, and {:.7g} in `known_together`, so it has been changed since its fit. "
                      "Calibrate the scenario again, or delete `known_together`.",
                      name, value, fitted));
    knob.is_said = false;  // it is taken as fitted
    uncertain.knobs.push_back(knob);
  }
  const auto n_together = together.factor.rows();
  std::copy_if(all.begin(), all.end(), std::back_inserter(uncertain.knobs), [](const Knob& k) { return k.is_said; });
  const auto n = static_cast<Eigen::Index>(uncertain.knobs.size());
  uncertain.factor.setZero(n, n);
  uncertain.factor.topLeftCorner(n_together, n_together) = together.factor;
  for (Eigen::Index k = 0; k < n; ++k) {
    double& sd = uncertain.knobs[static_cast<std::size_t>(k)].prior_sd;
    if (k < n_together)
      sd = together.factor.row(k).norm();
    else
      uncertain.factor(k, k) = sd;
  }
  return uncertain;
}

/// Differences at some rows, linearly at all of them, added to the values.
std::vector<double> with_differences(const Channel& channel, const std::vector<double>& time_s,
                                     const std::vector<std::size_t>& rows, const Eigen::VectorXd& difference) {
  std::vector<double> values = channel.values;
  for (std::size_t i = 0, after = 0; i < values.size(); ++i) {
    while (rows[after] < i) ++after;
    const std::size_t before = rows[after] == i ? after : after - 1;
    const double from_s = time_s[rows[before]], to_s = time_s[rows[after]];
    const double share = before == after ? 1.0 : (time_s[i] - from_s) / (to_s - from_s);
    values[i] +=
        (1.0 - share) * difference[static_cast<Eigen::Index>(before)] + share * difference[static_cast<Eigen::Index>(after)];
  }
  return values;
}

/// Limits with a further normal difference, independent of the others: on each side of the machine as written the half
/// widths add as roots of squares, which is exact for a linear machine.
void widen(BandLimits& limits, const Eigen::VectorXd& half) {
  for (Eigen::Index i = 0; i < limits.low.size(); ++i) {
    const double from = std::min(std::max(0.0, limits.low[i]), limits.high[i]);
    limits.low[i] = from - std::hypot(from - limits.low[i], half[i]);
    limits.high[i] = from + std::hypot(limits.high[i] - from, half[i]);
  }
}

/// Of a machine that some reduced model follows. @throws SolveError  if most drawn machines have no solution
NumbersBand numbers_band(const scenarios::Scenario& scenario, const BandedRun& run, const std::vector<std::size_t>& rows,
                         const Listener& listener) {
  const scenarios::MachineModel& machine = *scenario.machine;
  std::optional<scenarios::ReducedMachine> made;
  if (!run.model.reduced()) made.emplace(reduced_of(scenario, run, listener));
  const diagnosis::AugmentedModel augmented = diagnosis::without_further_places(machine);
  solver::TransientOptions tolerances = scenario.solver.transient;  // far below the width of any band
  tolerances.relative_tolerance = std::max(tolerances.relative_tolerance, 1e-4);
  tolerances.absolute_tolerance_K = std::max(tolerances.absolute_tolerance_K, 2e-3);
  const Twin twin(augmented, made ? *made : *run.model.reduced(), tolerances);
  UncertainNumbers uncertain = uncertain_numbers(twin, machine.known_together);
  NumbersBand band{
      .limits = {}, .numbers = std::move(uncertain.knobs), .are_fitted = !machine.known_together.numbers.empty()};
  const std::vector<Knob>& knobs = band.numbers;
  if (knobs.empty()) return band;
  listener.begin(fmt::format("computing the band of {} numbers", knobs.size()));

  const int n_draws = n_draws_of(twin.machine().system, knobs.size());
  Eigen::MatrixXd scores = latin_hypercube(n_draws, static_cast<int>(knobs.size()), kBandSeed);
  for (double& u : scores.reshaped()) u = normal_quantile(u);
  const std::vector<std::optional<Eigen::MatrixXd>> drawn =
      drawn_differences(twin, knobs, scores * uncertain.factor.transpose(), banded_run_of(run, rows), tolerances, listener)
          .of;
  std::vector<Eigen::Index> kept;
  for (std::size_t d = 0; d < drawn.size(); ++d) {
    if (drawn[d]) kept.push_back(static_cast<Eigen::Index>(d));
  }
  band.n_draws = drawn.size();
  band.n_left_out = drawn.size() - kept.size();
  if (2 * band.n_left_out > drawn.size() ||
      static_cast<Eigen::Index>(kept.size()) < fewest_draws(static_cast<Eigen::Index>(knobs.size())))
    throw SolveError(fmt::format("{} of {} drawn machines have no solution.", band.n_left_out, drawn.size()));
  const Eigen::MatrixXd kept_scores = scores(kept, Eigen::all);

  const solver::Outputs& outputs = twin.machine().system.outputs;
  for (std::size_t o = 0; o < outputs.name.size(); ++o) {
    if (!run.record.find(outputs.name[o])) continue;
    const double scale = outputs.unit[o] == "K" ? 1.0 : 1e6;  // channels are in um and urad
    Eigen::MatrixXd values(kept_scores.rows(), static_cast<Eigen::Index>(rows.size()));
    for (std::size_t k = 0; k < kept.size(); ++k)
      values.row(static_cast<Eigen::Index>(k)) =
          scale * drawn[static_cast<std::size_t>(kept[k])]->row(static_cast<Eigen::Index>(o));
    if (!values.isZero(0.0)) band.limits.emplace(outputs.name[o], band_limits_over_time(kept_scores, values));
  }
  return band;
}

}  // namespace

std::optional<RecordBand> known_band(const scenarios::Scenario& scenario, const BandedRun& run, const Listener& listener) {
  const scenarios::MachineModel& machine = *scenario.machine;
  const std::vector<std::size_t> rows = band_rows(run.record.n_samples());
  NumbersBand drawn;
  if (scenarios::says_known_to(machine)) {
    if (const scenarios::Machine* full = run.model.full(); full && full->system.share)
      return no_band("they need a reduced model, which --distributed does not make.");
    if (!can_be_reduced(machine)) return no_band("a temperature is prescribed over time, which no reduced model follows.");
    try {
      drawn = numbers_band(scenario, run, rows, listener);
    } catch (const SolveError& e) {  // the curve itself may be the full model's
      return no_band(e.what());
    }
  }
  RecordBand band{.limits = {.source = run.record.source, .time_s = run.record.time_s, .channels = {}}, .words = {}};
  std::vector<double> times_s;
  for (const std::size_t row : rows) times_s.push_back(run.first_row_s + run.record.time_s[row] - run.record.time_s.front());
  std::size_t n_learned = 0;
  for (const Channel& channel : run.record.channels) {
    const Eigen::VectorXd remaining = remaining_of(machine, run.cyclogram, channel, times_s);
    const auto found = drawn.limits.find(channel.name);
    if (found == drawn.limits.end() && remaining.isZero(0.0)) continue;
    const auto n = static_cast<Eigen::Index>(rows.size());
    BandLimits limits =
        found != drawn.limits.end() ? found->second : BandLimits{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)};
    if (!remaining.isZero(0.0)) {
      ++n_learned;
      widen(limits, kNormal95 * remaining);
    }
    for (const auto& [end, difference] : {std::pair("_low", &limits.low), std::pair("_high", &limits.high)})
      band.limits.channels.push_back(
          {channel.name + end, channel.unit, with_differences(channel, run.record.time_s, rows, *difference)});
  }
  if (drawn.numbers.empty() && n_learned == 0) return std::nullopt;
  band.words = words_of_band(drawn, n_learned);
  return band;
}

}  // namespace driftwright::studies
