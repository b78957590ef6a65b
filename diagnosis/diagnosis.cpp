#include "diagnosis/diagnosis.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <memory>

#include "diagnosis/gain.hpp"
#include "diagnosis/interval.hpp"
#include "diagnosis/latent_heat.hpp"
#include "diagnosis/leftover.hpp"
#include "diagnosis/missing_data.hpp"
#include "diagnosis/no_solution.hpp"
#include "diagnosis/scatter.hpp"
#include "diagnosis/warm_start.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr int kFewestReadings = 150;  // of all channels together: below, a verdict would be guessing
constexpr double kStandsOut = 7.0;    // sigmas of one channel's leftover
constexpr double kStandsOutTogether = 6.0;
constexpr double kJump =
    27.0;  // squares that one step somewhere may take off by chance: exp(-13.5) times some thousand rows
constexpr double kRough = 3.0;                // leftover over noise: a model that no effect mends
constexpr double kModelErrorTime_s = 1200.0;  // for which it misses alike
constexpr double kNoiseCanBeWider = 1.5;      // than high frequencies say
constexpr double kUnnamed = 3.0;              // nats by which one cause without a name must be better than those with one
constexpr double kBeyondBelief = 2.0;         // mean square of how far the scenario's numbers moved, in their sigmas
constexpr double kWorthNaming = 0.35;         // of the noise: less is no use to anybody
constexpr double kSureCause = 20.0;           // nats: no smaller rest hides it
constexpr double kRestOfCause = 0.35;         // of what the causes explain: more left, and they are not what is wrong
constexpr double kMostWork = 1.5e8;           // about a minute
constexpr double kSmallMachine = 15.0;        // unknowns, below which a prediction costs the same
constexpr double kNotLinear = 6.0;            // of what one of a linear machine costs
constexpr double kHallFault_K = 2.0;          // 1 sigma of a hall that was recorded wrongly
constexpr double kTooFar = 3.5;               // sigmas of its prior: a number beyond is a cause

/// Index of a claim's first knob in x.
Eigen::Index first_of(const Hypothesis& hypothesis, std::size_t claim, Eigen::Index n_nuisance) {
  for (std::size_t c = 0; c < claim; ++c) n_nuisance += static_cast<Eigen::Index>(hypothesis[c].knobs.size());
  return n_nuisance;
}

/// A claim of a hypothesis in numbers.
Cause cause_of(const std::vector<Candidate>& list, const Fitter& fitter, const Hypothesis& hypothesis, std::size_t claim,
               const Fit& fit, double gain, Twin::Workspace& workspace) {
  const Claim& of = hypothesis[claim];
  const Variant& variant = list[of.candidate].variants[of.variant];
  Cause c{list[of.candidate].effect, list[of.candidate].where, variant.law, {}, gain, {}};
  const Eigen::Index first = first_of(hypothesis, claim, fitter.n_nuisance());
  for (std::size_t k = 0; k < of.knobs.size() && !of.all_or_nothing; ++k) {
    const Knob& knob = of.knobs[k];
    const Interval x = profile_interval(fitter, hypothesis, fit, claim, k, workspace);
    const double scale = knob.is_time ? 60.0 : 1.0;
    c.parameters.push_back({knob.name, knob.is_time ? "min" : knob.unit,
                            knob.value(fit.x[first + static_cast<Eigen::Index>(k)]) / scale, knob.value(x.low) / scale,
                            knob.value(x.high) / scale});
  }
  if (variant.at_speed_rpm > 0.0) {
    c.parameters.push_back({"at_speed", "rpm", variant.at_speed_rpm, variant.at_speed_rpm, variant.at_speed_rpm});
  }
  return c;
}

/// What a warm start and another mesh change (one column a channel): the amplitude of each is unknown.
std::vector<Prediction> unknown_columns(const Twin& twin, const Twin* coarse, double share,
                                        const std::vector<MeasuredRun>& runs, const TwinState& state) {
  std::vector<Prediction> columns = start_columns(twin, runs);
  if (!coarse) return columns;
  Twin::Workspace fine_space(twin), coarse_space(*coarse);
  Prediction difference;
  for (const MeasuredRun& run : runs) {
    difference.push_back(share * (coarse->read(state, run, coarse->respond(state, run, coarse_space)) -
                                  twin.read(state, run, twin.respond(state, run, fine_space))));
  }
  std::vector<int> outputs;
  for (const MeasuredRun& run : runs) {
    for (const MeasuredChannel& c : run.channels) {
      if (std::find(outputs.begin(), outputs.end(), c.output) == outputs.end()) outputs.push_back(c.output);
    }
  }
  for (int o : outputs) {
    Prediction column;
    for (const Eigen::MatrixXd& d : difference) {
      column.push_back(Eigen::MatrixXd::Zero(d.rows(), d.cols()));
      column.back().row(o) = d.row(o);
    }
    columns.push_back(std::move(column));
  }
  return columns;
}

std::string words(const Cause& c) {
  std::vector<std::string> numbers;
  for (const Estimate& p : c.parameters) {
    if (p.name == "at_speed") continue;  // the law says it
    numbers.push_back(
        fmt::format("{} {:.3g}{} ({:.3g} to {:.3g})", p.name, p.value, p.unit == "1" ? "" : " " + p.unit, p.low, p.high));
  }
  return fmt::format("{} at {} ({}){}{}", c.effect, c.where, c.law, numbers.empty() ? "" : ": ", fmt::join(numbers, ", "));
}

/// One cause without a name, in words.
std::string words(const Unnamed& u) {
  const char* what = u.quantity == Unnamed::Quantity::kHeat   ? "heat in"
                     : u.quantity == Unnamed::Quantity::kHall ? "another temperature of the"
                                                              : "an error of the reading";
  const char* course = u.follows == "nothing" ? "constant" : "following";
  return fmt::format("One cause that the catalogue has no name for explains it better ({:.0f} nats) than {}: {} {}, {}{}",
                     u.log_evidence_gain,
                     u.instead_of.size() > 1 ? fmt::format("{} named ones", u.instead_of.size()) : "a named one", what,
                     u.where, course, u.follows == "nothing" ? "" : " " + u.follows);
}

/// What is left beside the causes, in a sentence.
std::string rest_words(const Unexplained& u) {
  return fmt::format("Beside it {:.2g} {} RMS that is not noise is left at {}", u.channels.front().rms,
                     u.channels.front().unit, u.channels.front().name);
}

/// Machines without fault per one at which chance offers as much.
std::string odds_words(const Diagnosis& d, const Cause& c) {
  const double share = d.search.chance.share_above(c.log_evidence_gain);
  return share < 1e-6 ? "" : fmt::format(", chance offers as much at one faultless machine in {:.0f}", 1.0 / share);
}

std::string reason_of(const Diagnosis& d) {
  std::vector<std::string> parts;
  for (const Cause& c : d.causes) {
    std::string text = words(c);
    if (c.standing == Standing::kSuspected)
      text = fmt::format("suspected{}{}: {}", c.doubt.empty() ? "" : ", since " + c.doubt, odds_words(d, c), text);
    if (!c.alternatives.empty()) {
      std::vector<std::string> others;
      for (const Cause& a : c.alternatives) others.push_back(fmt::format("{} at {}", a.effect, a.where));
      text += fmt::format("; the data cannot tell it from {}", fmt::join(others, " or "));
    }
    parts.push_back(text);
  }
  std::string text = fmt::format("{}", fmt::join(parts, "; and "));
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  switch (d.verdict) {
    case Verdict::kConsistent:
      return fmt::format(
          "The scenario's numbers, within what is known of them, explain the measurement; none of {} candidates is wanted.",
          d.n_candidates);
    case Verdict::kUnexplained:
      if (d.causes.empty()) {
        return fmt::format(
            "The measurement holds more than scatter and noise, and none of {} candidates explains it{}.", d.n_candidates,
            d.unexplained && !d.unexplained->channels.empty() ? ", most of all in " + d.unexplained->channels.front().name
                                                              : "");
      }
      if (d.unexplained && d.unexplained->fails_held_out) {
        return fmt::format("What fits best predicts kept-out data worse than no cause does, most of all {}: {}.",
                           d.unexplained->channels.front().name, text);
      }
      if (d.unexplained && d.unexplained->one_cause) {
        return fmt::format("{}. The best of the catalogue: {}.", words(*d.unexplained->one_cause), text);
      }
      return fmt::format("Something is left that no candidate explains, {:.2g} {} RMS at {}; the best so far: {}.",
                         d.unexplained->channels.front().rms, d.unexplained->channels.front().unit,
                         d.unexplained->channels.front().name, text);
    default:
      return text + "." + (d.unexplained ? " " + rest_words(*d.unexplained) + "." : "");
  }
}

/// Noise without the benefit of smooth curves: what an AR(1) of some minutes could explain is not called unexplained.
std::map<std::string, NoiseModel> widest_noise(const Fitter& fitter, const Fit& fit,
                                               const std::map<std::string, NoiseModel>& noise) {
  std::map<std::string, std::vector<NoiseSeries>> series;
  for (std::size_t r = 0; r < fitter.runs().size(); ++r) {
    const MeasuredRun& run = fitter.runs()[r];
    for (const MeasuredChannel& c : run.channels) {
      const auto n = static_cast<Eigen::Index>(run.time_s.size());
      series[c.name].push_back(
          {run.time_s, c.value - fit.prediction[r].row(c.output).transpose(), Eigen::MatrixXd::Ones(n, 1)});
    }
  }
  std::map<std::string, NoiseModel> widest;
  for (const auto& [name, list] : series) {
    const NoiseModel wide = estimate_noise(list, noise.at(name).white);
    widest[name] = wide.total() < kNoiseCanBeWider * noise.at(name).total() ? wide : noise.at(name);
  }
  return widest;
}

/// Noise with what the model misses as a slow part of it, where that is far more than the noise: readings of a model so wrong weigh no more.
std::optional<std::map<std::string, NoiseModel>> models_own_error(const Fitter& fitter, const SearchResult& result,
                                                                  const std::map<std::string, NoiseModel>& noise) {
  std::map<std::string, NoiseModel> rough = noise;
  bool is_rough = false;
  for (const Leftover& l : leftovers(fitter.runs(), result.fit.prediction, noise)) {
    if (l.rms < kRough * noise.at(l.channel).total()) continue;
    rough[l.channel].correlated = std::hypot(noise.at(l.channel).correlated, l.rms);
    rough[l.channel].time_s = kModelErrorTime_s;
    is_rough = true;
  }
  if (!is_rough) return std::nullopt;
  return rough;
}

std::optional<Unexplained> unexplained_of(const Fitter& fitter, const SearchResult& result,
                                          const std::map<std::string, NoiseModel>& noise) {
  const std::vector<Leftover> list =
      leftovers(fitter.runs(), result.fit.prediction, widest_noise(fitter, result.fit, noise));
  const double together = sigmas(list);
  Unexplained u;
  for (const Leftover& l : list) {
    const bool stands_out = l.sigmas() > kStandsOut || (together > kStandsOutTogether && l.sigmas() > 3.0);
    const double worth_naming = kWorthNaming * noise.at(l.channel).total();
    const bool jumps = l.jump_squares >= kJump && l.jump >= worth_naming;
    if (!(stands_out && l.rms >= worth_naming) && !jumps) continue;
    u.nats += 0.5 * std::max(l.squares - l.n_curves, jumps ? l.jump_squares : 0.0);
    u.channels.push_back({l.channel,
                          l.unit == "K"   ? "K"
                          : l.unit == "m" ? "um"
                                          : "urad",
                          (l.unit == "K" ? 1.0 : 1e6) * l.rms, l.sigmas()});
  }
  if (u.channels.empty()) return std::nullopt;
  const bool only_displacements =
      std::none_of(u.channels.begin(), u.channels.end(), [](const auto& c) { return c.unit == "K"; });
  if (!only_displacements) {
    if (const auto latent = latent_heat(fitter, result.hypothesis, result.fit); latent && latent->explained > 0.3) {
      u.heat_would_sit_in = latent->body;
      u.time_s = latent->time_s;
      u.heat_W = latent->heat_W;
      u.correlates_with = latent->correlates_with;
      u.correlation = latent->correlation;
      return u;
    }
  }
  const MeasuredRun& run = fitter.runs().front();
  if (const MeasuredChannel* c = run.find(u.channels.front().name)) {
    Eigen::VectorXd r = c->value - result.fit.prediction[0].row(c->output).transpose();
    for (Eigen::Index i = 0; i < r.size(); ++i) {
      if (std::isnan(r[i])) r[i] = 0.0;
    }
    std::tie(u.correlates_with, u.correlation) = resembles(run, r);
  }
  return u;
}

/// Where the claims act that one cause without a name explains better, and what that cause looks like.
Unexplained explained_better(const Fitter& fitter, const SearchResult& result, const Unnamed& unnamed,
                             const std::map<std::string, NoiseModel>& noise) {
  const Remainder rest = without_claims(result.hypothesis, unnamed.instead_of, fitter.n_nuisance());
  Twin::Workspace workspace(fitter.twin());
  const Prediction without = fitter.predict(rest.hypothesis, result.fit.x(rest.x), workspace);
  std::map<std::string, std::pair<double, double>> squares;  // of what the claims do; rows
  for (std::size_t r = 0; r < fitter.runs().size(); ++r) {
    for (const MeasuredChannel& c : fitter.runs()[r].channels) {
      auto& [sum, rows] = squares[c.name];
      sum += (result.fit.prediction[r].row(c.output) - without[r].row(c.output)).squaredNorm();
      rows += static_cast<double>(without[r].cols());
    }
  }
  Unexplained u;
  for (const auto& [name, square] : squares) {
    const std::string& unit = fitter.runs().front().find(name) ? fitter.runs().front().find(name)->unit : "K";
    const double rms = std::sqrt(square.first / square.second);
    u.channels.push_back({name,
                          unit == "K"   ? "K"
                          : unit == "m" ? "um"
                                        : "urad",
                          (unit == "K" ? 1.0 : 1e6) * rms,
                          square.first / std::pow(noise.at(name).total(), 2) / std::sqrt(2.0 * square.second)});
  }
  std::stable_sort(u.channels.begin(), u.channels.end(),
                   [](const auto& a, const auto& b) { return a.times_noise > b.times_noise; });
  u.channels.resize(1);
  Eigen::VectorXd course =
      Eigen::Map<const Eigen::VectorXd>(unnamed.value.data(), static_cast<Eigen::Index>(unnamed.value.size()));
  std::tie(u.correlates_with, u.correlation) = resembles(fitter.runs().front(), course);
  if (unnamed.quantity == Unnamed::Quantity::kHeat) {
    u.heat_would_sit_in = unnamed.where;
    u.time_s = unnamed.time_s;
    u.heat_W = unnamed.value;
  }
  return u;
}

/// Causes that fit all data and predict kept-out ones worse than no cause does.
Unexplained failed_held_out(const std::vector<ChannelGain>& gain) {
  const auto worst = std::max_element(gain.begin(), gain.end(), [](const ChannelGain& a, const ChannelGain& b) {
    return a.rmse_calibrated * b.noise_floor < b.rmse_calibrated * a.noise_floor;
  });
  Unexplained u;
  u.channels.push_back(
      {worst->name, worst->unit, worst->rmse_calibrated, worst->rmse_calibrated / std::max(1e-12, worst->noise_floor)});
  u.fails_held_out = true;
  return u;
}

/// Claims that kept-out rows are predicted better with, and all numbers fitted beside them alone.
Written written_of(const Fitter& fitter, const SearchResult& result, const HeldOut& held, Twin::Workspace& workspace) {
  Written w{.hypothesis = result.hypothesis, .causes = {}, .fit = result.fit, .keeps_numbers = held.keeps_numbers};
  std::vector<std::size_t> dropped;
  for (std::size_t c = 0; c < result.hypothesis.size(); ++c) (held.writes_claim[c] ? w.causes : dropped).push_back(c);
  if (dropped.empty()) return w;
  const Remainder rest = without_claims(result.hypothesis, dropped, fitter.n_nuisance());
  w.hypothesis = rest.hypothesis;
  w.fit = result.without;
  if (w.hypothesis.empty()) return w;
  const Eigen::VectorXd x = result.fit.x(rest.x);
  if (!has_solution([&] { w.fit = fitter.fit(w.hypothesis, x.tail(x.size() - fitter.n_nuisance()), workspace); })) {
    w.hypothesis.clear();
    w.causes.clear();
  }
  return w;
}

/// The scenario's own numbers as fitted. @param known_to  1 sigma of each
std::vector<Estimate> calibrated_numbers(const Fitter& fitter, const Fit& fit, const std::vector<double>& known_to) {
  std::vector<Estimate> numbers;
  const Twin& twin = fitter.twin();
  for (std::size_t i = 0; i < fitter.scatter().size(); ++i) {
    const Knob& k = fitter.scatter()[i];
    const auto at = static_cast<Eigen::Index>(i);
    const double x = fit.x[at], sd = std::sqrt(fit.covariance(at, at));
    TwinState turned = twin.as_written();
    k.set(turned, k.value(x));
    std::string of;  // one of several sensitivities of a body
    if (turned.size() > twin.n_own_effects() && turned.back().words.contains("displacement"))
      of = turned.back().words.at("displacement").empty() ? "" : " of " + turned.back().words.at("displacement");
    numbers.push_back({fmt::format("{} {} {}{}", k.effect, k.where, k.name, of), k.unit, k.value(x), k.value(x - 1.96 * sd),
                       k.value(x + 1.96 * sd), x / known_to[i], known_to[i], k.scale == Knob::Scale::kLog});
  }
  return numbers;
}

/// Numbers of the scenario that have gone so far that they are no calibration: causes by their own key, as fitted.
std::vector<Cause> moved_numbers(const Diagnosis& d) {
  std::vector<Cause> causes;
  const double price = std::log(std::max(1.0, static_cast<double>(d.n_candidates)));
  for (std::size_t i : d.moved) {
    const Estimate& e = d.calibrated[i];
    const Knob& k = d.scatter[i];
    const double fitted = k.scale == Knob::Scale::kLog ? std::log(e.value / k.nominal) : e.value - k.nominal;
    const double known_to = std::abs(e.deviation) > 0.0 ? std::abs(fitted / e.deviation) : k.prior_sd;
    // the density of its value under the wide prior of a fault over that under what is known of it
    const double gain =
        0.5 * e.deviation * e.deviation - 0.5 * std::pow(fitted / k.prior_sd, 2) - std::log(k.prior_sd / known_to) - price;
    Estimate number = e;
    number.name = k.name;
    Cause c{k.effect, k.where, fmt::format("another {}, {:+.1f} sigmas from what is known of it", k.name, e.deviation),
            {number}, gain,    {}};
    c.is_written = d.written.keeps_numbers;
    c.standing = gain >= d.search.chance.gain_at(SearchOptions{}.wrongly_named) ? Standing::kNamed : Standing::kSuspected;
    causes.push_back(std::move(c));
  }
  std::stable_sort(causes.begin(), causes.end(),
                   [](const Cause& a, const Cause& b) { return a.log_evidence_gain > b.log_evidence_gain; });
  return causes;
}

/// Laws times readings times records times what a prediction costs: how long searching once without each record would take.
double search_work(const Fitter& fitter, const std::vector<Candidate>& list) {
  const auto& system = fitter.twin().machine().system;
  const double size = std::max(1.0, system.size() / kSmallMachine) * (system.is_linear() ? 1.0 : kNotLinear);
  return static_cast<double>(laws_of(list).size()) * static_cast<double>(fitter.comparison().n()) *
         static_cast<double>(fitter.runs().size()) * size;
}

/// How surely each claim is a cause.
void give_standing(Diagnosis& d, const HeldOut& held) {
  for (std::size_t c = 0; c < d.search.findings.size(); ++c) {
    Cause& cause = d.causes[c];
    cause.is_written = held.writes_claim[c] && held.keeps_numbers;
    cause.n_searched = held.n_searched;
    if (held.n_searched > 0) cause.n_again = held.n_again[c];
    if (!d.search.findings[c].is_named) continue;
    if (!held.keeps_claim[c]) {
      cause.doubt = "rows that were kept out are predicted worse with it";
      continue;
    }
    cause.standing = cause.alternatives.empty() ? Standing::kNamed : Standing::kAmbiguous;
  }
}

/// Whether what is left is more than what the causes explain, so that none of them is what is wrong.
bool rest_rules(const Diagnosis& d) {
  if (!d.unexplained) return false;
  if (d.causes.empty() || d.unexplained->one_cause || d.unexplained->fails_held_out) return true;
  double explained = 0.0;
  for (const Cause& c : d.causes) explained = std::max(explained, c.log_evidence_gain);
  return explained < kSureCause || d.unexplained->nats > kRestOfCause * explained;
}

Verdict verdict_of(const Diagnosis& d) {
  if (rest_rules(d)) return Verdict::kUnexplained;
  const auto is_any = [&](Standing s) {
    return std::any_of(d.causes.begin(), d.causes.end(), [&](const Cause& c) { return c.standing == s; });
  };
  if (is_any(Standing::kAmbiguous)) return Verdict::kAmbiguous;
  if (is_any(Standing::kNamed)) return Verdict::kNamed;
  return d.causes.empty() ? Verdict::kConsistent : Verdict::kSuspected;
}

}  // namespace

const char* word(Verdict verdict) {
  switch (verdict) {
    case Verdict::kConsistent:
      return "consistent";
    case Verdict::kSuspected:
      return "suspected";
    case Verdict::kNamed:
      return "named";
    case Verdict::kAmbiguous:
      return "ambiguous";
    case Verdict::kUnexplained:
      return "unexplained";
    case Verdict::kInsufficientData:
      return "insufficient_data";
  }
  return "";
}

const char* word(Standing standing) {
  switch (standing) {
    case Standing::kSuspected:
      return "suspected";
    case Standing::kAmbiguous:
      return "ambiguous";
    case Standing::kNamed:
      return "named";
  }
  return "";
}

Diagnosis diagnose(const Twin& twin, const Twin* coarse, const std::vector<MeasuredRun>& runs,
                   const DiagnosisOptions& options, const std::function<void(const std::string&)>& say) {
  Diagnosis d;
  for (const MeasuredRun& run : runs) {
    for (const DataFinding& f : run.findings)
      d.data.push_back({f.channel, runs.size() > 1 ? run.name + ": " + f.what : f.what, f.leaves_out});
  }
  Eigen::Index n_readings = 0;
  for (const MeasuredRun& run : runs) {
    for (const MeasuredChannel& c : run.channels) n_readings += (c.value.array() == c.value.array()).count();
  }
  const std::vector<Candidate> standing = candidates(twin, runs, options.without);
  const SearchOptions how{.most_effects = options.most_effects, .without = options.without};

  d.scatter = scatter(twin);
  for (Knob& k : hall_scatter(runs)) d.scatter.push_back(std::move(k));
  say(fmt::format("slopes of {} uncertain numbers", d.scatter.size()));
  const auto fresh_fitter = [&] {
    return std::make_unique<Fitter>(twin, runs, d.scatter,
                                    unknown_columns(twin, coarse, options.mesh_error_share, runs, twin.as_written()));
  };
  auto own_fitter = fresh_fitter();
  Twin::Workspace workspace(twin);
  d.as_written = own_fitter->predict({}, Eigen::VectorXd::Zero(own_fitter->n_nuisance()), workspace);
  d.noise = estimate_noise(runs, d.as_written, options.floor);
  for (int pass = 0; pass < 2; ++pass) {
    own_fitter->set_noise(d.noise);
    d.search = search(*own_fitter, standing, how, say);
    const auto sharper = estimate_noise(runs, d.search.fit.prediction, options.floor);
    const bool is_sharper = std::any_of(sharper.begin(), sharper.end(),
                                        [&](const auto& s) { return s.second.total() < 0.9 * d.noise.at(s.first).total(); });
    if (!is_sharper || pass == 1) break;
    for (const auto& [name, noise] : sharper) {
      if (noise.total() < d.noise.at(name).total()) d.noise[name] = noise;
    }
  }
  say("looking at what is left");
  const auto what_is_left = [&]() -> std::optional<Unexplained> {
    const Fitter& f = *own_fitter;
    std::optional<Unexplained> left = unexplained_of(f, d.search, d.noise);
    if (!left || !coarse || d.search.hypothesis.empty()) return left;
    // the mesh's error is another one where the machine is another one
    Fitter again(
        twin, runs, d.scatter,
        unknown_columns(twin, coarse, options.mesh_error_share, runs, f.state(d.search.hypothesis, d.search.fit.x)));
    again.set_noise(d.noise);
    again.settle(d.search.hypothesis, d.search.fit);
    SearchResult same = d.search;
    same.fit = again.fit(d.search.hypothesis, d.search.fit.x.tail(d.search.fit.x.size() - f.n_nuisance()), workspace);
    return unexplained_of(again, same, d.noise);
  };
  d.unexplained = what_is_left();
  if (const auto rough = d.unexplained ? models_own_error(*own_fitter, d.search, d.noise) : std::nullopt) {
    say("weighing again by what the model misses");
    own_fitter = fresh_fitter();
    own_fitter->set_noise(*rough);
    d.search = search(*own_fitter, standing, how, say);
    d.weighed_by_model_error = true;
    if (auto left = unexplained_of(*own_fitter, d.search, d.noise)) d.unexplained = std::move(left);
  }
  const std::vector<Candidate>& list = d.search.candidates;
  d.n_candidates = static_cast<int>(list.size());
  // Numbers that have gone too far are faults: they get the prior of one, and all are fitted anew.
  std::vector<double> known_to;
  for (const Knob& k : d.scatter) known_to.push_back(k.prior_sd);
  for (std::size_t i = 0; i < d.scatter.size(); ++i) {
    if (!(std::abs(d.search.fit.x[static_cast<Eigen::Index>(i)]) > kTooFar * known_to[i])) continue;
    d.moved.push_back(i);
    d.scatter[i].prior_sd = d.scatter[i].scale == Knob::Scale::kLog ? effects::kFactorSd : kHallFault_K;
  }
  if (!d.moved.empty()) {
    const std::map<std::string, NoiseModel> noise = own_fitter->noise();
    own_fitter = fresh_fitter();
    own_fitter->set_noise(noise);
    own_fitter->settle(d.search.hypothesis, d.search.fit);
    const Eigen::Index n_n = own_fitter->n_nuisance();
    d.search.fit = own_fitter->fit(d.search.hypothesis, d.search.fit.x.tail(d.search.fit.x.size() - n_n), workspace);
    (void)has_solution([&] { d.search.without = own_fitter->fit({}, Eigen::VectorXd(0), workspace); });
  }
  const Fitter& fitter = *own_fitter;
  if (auto unnamed = best_unnamed(fitter, list, d.search.hypothesis, d.search.fit);
      unnamed && unnamed->log_evidence_gain > kUnnamed) {
    if (!d.unexplained) d.unexplained = explained_better(fitter, d.search, *unnamed, d.noise);
    d.unexplained->one_cause = std::move(unnamed);
  }
  d.scatter_alone = d.search.without.prediction;
  say("waveforms of what is missing");
  if (!d.scatter_alone.empty()) {
    // where a loud cause bent the numbers beyond belief, heats would be told of another machine
    const Eigen::VectorXd& x = d.search.without.x;
    const bool is_bent = x.cwiseQuotient(fitter.nuisance_sd()).squaredNorm() > kBeyondBelief * static_cast<double>(x.size());
    (void)has_solution([&] {
      d.waveforms = is_bent ? waveforms(twin, runs, twin.as_written(), d.as_written)
                            : waveforms(twin, runs, fitter.state({}, x), d.scatter_alone);
    });
  }

  for (std::size_t c = 0; c < d.search.findings.size(); ++c) {
    const Finding& f = d.search.findings[c];
    Cause cause = cause_of(list, fitter, d.search.hypothesis, c, d.search.fit, f.log_evidence_gain, workspace);
    for (const Finding::Alternative& a : f.alternatives) {
      Hypothesis other = d.search.hypothesis;
      other.erase(other.begin() + static_cast<std::ptrdiff_t>(c));
      other.push_back(a.claim);
      cause.alternatives.push_back(cause_of(list, fitter, other, other.size() - 1, a.fit, a.log_evidence_gain, workspace));
    }
    d.causes.push_back(std::move(cause));
  }
  say("measuring the gain");
  SearchAgain search_again;
  if (search_work(fitter, list) <= kMostWork) {
    search_again = [&](Fitter& without) {
      say("searching again without a record");
      return search(without, standing, how, [](const std::string&) {});
    };
  }
  const HeldOut held = held_out_gain(fitter, d.search, d.noise, search_again);
  d.written = written_of(fitter, d.search, held, workspace);
  d.extended = d.written.keeps_numbers ? d.written.fit.prediction : d.as_written;
  d.calibrated = calibrated_numbers(fitter, d.written.fit, known_to);
  for (Cause& c : moved_numbers(d)) d.causes.push_back(std::move(c));
  d.holdout = held.how;
  d.gain = held.channels;
  give_standing(d, held);
  const bool is_any_named =
      std::any_of(d.search.findings.begin(), d.search.findings.end(), [](const Finding& f) { return f.is_named; });
  if (is_any_named && held.fails) {
    if (!d.unexplained) d.unexplained = failed_held_out(d.gain);
    d.unexplained->fails_held_out = true;
  }
  d.verdict = n_readings < kFewestReadings ? Verdict::kInsufficientData : verdict_of(d);
  if (d.verdict == Verdict::kUnexplained) {
    for (Cause& c : d.causes) {
      if (c.standing != Standing::kSuspected && c.doubt.empty()) c.doubt = "more is left than it explains";
      c.standing = Standing::kSuspected;
    }
  }
  if (std::any_of(d.causes.begin(), d.causes.end(), [](const Cause& c) { return !c.alternatives.empty(); })) {
    say("choosing an experiment");
    d.experiment = propose_experiment(fitter, d.search);
  }
  d.reason = d.verdict == Verdict::kInsufficientData
                 ? what_is_missing(twin, runs, static_cast<int>(n_readings), kFewestReadings)
                 : reason_of(d);
  return d;
}

}  // namespace driftwright::diagnosis
