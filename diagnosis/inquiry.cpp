#include "diagnosis/inquiry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/ambient_doubt.hpp"
#include "diagnosis/missing_data.hpp"
#include "diagnosis/no_solution.hpp"
#include "diagnosis/scatter.hpp"
#include "diagnosis/signatures.hpp"
#include "diagnosis/unexplained.hpp"
#include "diagnosis/unseen_drive.hpp"
#include "diagnosis/warm_start.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kSharper =
    0.9;  // ratio of the noise without the explained part to that with it; below, the noise is estimated again
constexpr double kLessSlow = 0.5;        // the same for its slow part: repeated causes had been taken for correlated noise
constexpr double kSeenSlow = 0.2;        // share of the white part; a smaller slow part is ignored
constexpr double kAmbientFault_K = 2.0;  // 1 sigma of an ambient that was recorded wrongly

/// The part that the search leaves unexplained; the mesh's error is computed for the machine with the causes.
std::optional<Unexplained> what_is_left(const InquiryGround& ground, const std::vector<MeasuredRun>& runs, const Inquiry& of,
                                        Twin::Workspace& workspace) {
  const Fitter& fitter = *of.fitter;
  std::optional<Unexplained> left = unexplained_of(fitter, of.search, of.noise);
  if (!left || !ground.coarse || of.search.hypothesis.empty()) return left;
  Fitter again(ground.twin, runs, fitter.scatter(),
               unknown_columns(ground.twin, ground.coarse, ground.options.mesh_error_share, runs,
                               fitter.state(of.search.hypothesis, of.search.fit.x)));
  again.set_noise(of.noise);
  again.settle(of.search.hypothesis, of.search.fit);
  SearchResult same = of.search;
  same.fit = again.fit(of.search.hypothesis, of.search.fit.claim_x(fitter.n_nuisance()), workspace);
  return unexplained_of(again, same, of.noise);
}

/// Numbers that moved to their limit are faults: they get the prior of a fault. @returns  whether there are new ones
bool widen_moved(Inquiry& of) {
  Fitter& fitter = *of.fitter;
  bool any = false;
  for (std::size_t i = 0; i < fitter.scatter().size(); ++i) {
    const Knob& k = fitter.scatter()[i];
    // A number that a step has set to its limit may be below it by rounding.
    if (!(std::abs(of.search.fit.x[static_cast<Eigen::Index>(i)]) >= (1.0 - 1e-9) * kTooFar * k.prior_sd)) continue;
    if (std::find(of.moved.begin(), of.moved.end(), i) != of.moved.end()) continue;
    of.moved.push_back(i);
    fitter.set_prior_sd(i, k.scale == Knob::Scale::kLog ? effects::kFactorSd : kAmbientFault_K);
    any = true;
  }
  return any;
}

/// Searches; as long as further numbers turn out to be faults, searches once more with these numbers free.
void search_beside_moved(Inquiry& of, const std::vector<Candidate>& names, const SearchOptions& how,
                         const Listener& listener) {
  of.search = search(*of.fitter, names, how, &of.search, listener);
  while (widen_moved(of)) {  // each turn frees one number at least
    if (listener.wants_end()) return;
    of.search = search(*of.fitter, names, how, &of.search, listener);
  }
}

/// Searches again with the model's error as process noise (heat in its bodies) or as slow noise of its channels.
void weigh_by_model_error(const InquiryGround& ground, const std::vector<MeasuredRun>& runs,
                          const std::vector<Candidate>& names, const SearchOptions& how, Inquiry& of,
                          Twin::Workspace& workspace, const Listener& listener) {
  listener.begin("weighing again by what the model misses");
  std::map<std::string, NoiseModel> rough = of.noise;
  std::shared_ptr<const SharedNoise> shared;
  (void)has_solution([&] {
    const TwinState state = of.fitter->state(of.search.hypothesis, of.search.fit.x);
    of.wander = heat_wander(*of.fitter, state, of.search.fit.prediction, workspace);
    if (of.wander) shared = std::make_shared<const SharedNoise>(std::move(of.wander->readings));
  });
  const Prediction& best = of.wander ? of.wander->prediction : of.search.fit.prediction;
  if (const auto error = models_own_error(runs, best, of.noise)) rough = *error;
  of.fitter = std::make_unique<Fitter>(ground.fresh, runs);
  of.fitter->hold_within(kTooFar);
  of.moved.clear();
  of.fitter->set_noise(rough, shared);
  search_beside_moved(of, names, how, listener);
  of.weighed_by_model_error = true;
}

}  // namespace

std::vector<Prediction> unknown_columns(const Twin& twin, const Twin* coarse, double mesh_error_share,
                                        const std::vector<MeasuredRun>& runs, const TwinState& state) {
  std::vector<Prediction> columns = start_columns(twin, runs);
  for (Prediction& c : hole_columns(twin, runs)) columns.push_back(std::move(c));
  for (Prediction& c : ambient_columns(twin, runs)) columns.push_back(std::move(c));
  if (!coarse) return columns;
  Twin::Workspace fine_space(twin), coarse_space(*coarse);
  Prediction difference;
  for (const MeasuredRun& run : runs) {
    difference.push_back(mesh_error_share *
                         (coarse->readings(state, run, coarse_space) - twin.readings(state, run, fine_space)));
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

Fitter begun(Diagnosis& d, const Twin& twin, const Twin* coarse, const std::vector<MeasuredRun>& runs,
             const DiagnosisOptions& options, const Listener& listener) {
  d.data = data_findings(runs);
  d.scatter = scatter(twin);
  for (Knob& k : ambient_scatter(runs)) d.scatter.push_back(std::move(k));
  listener.begin(fmt::format("slopes of {} uncertain numbers", d.scatter.size()));
  Fitter fresh(twin, runs, d.scatter, unknown_columns(twin, coarse, options.mesh_error_share, runs, twin.as_written()),
               listener);
  Twin::Workspace workspace(twin);
  d.as_written = fresh.predict({}, Eigen::VectorXd::Zero(fresh.n_nuisance()), workspace);
  return fresh;
}

Inquiry inquire(const InquiryGround& ground, const std::vector<MeasuredRun>& runs, const Listener& listener) {
  const DiagnosisOptions& options = ground.options;
  Inquiry of;
  const std::vector<Candidate>& names = ground.candidates;
  const SearchOptions how{.most_effects = options.most_effects, .without = options.without};
  of.fitter = std::make_unique<Fitter>(ground.fresh, runs);
  of.fitter->hold_within(kTooFar);
  of.noise = estimate_noise(runs, ground.as_written, options.floor);
  of.fitter->set_noise(of.noise);
  (void)has_solution([&] {  // the part explained by the scenario's own numbers is no noise
    Twin::Workspace workspace(ground.twin);
    const Fit fit = of.fitter->fit({}, Eigen::VectorXd(0), workspace);
    for (const auto& [name, noise] : estimate_noise(runs, fit.prediction, options.floor)) {
      if (noise.total() < of.noise.at(name).total()) of.noise[name] = noise;
    }
  });
  for (int pass = 0; pass < 2; ++pass) {
    of.fitter->set_noise(of.noise);
    search_beside_moved(of, names, how, listener);
    const auto sharper = estimate_noise(runs, of.search.fit.prediction, options.floor);
    const bool is_sharper = std::any_of(sharper.begin(), sharper.end(), [&](const auto& s) {
      const NoiseModel& before = of.noise.at(s.first);
      if (s.second.total() < kSharper * before.total()) return true;
      return !of.search.hypothesis.empty() && s.second.total() < before.total() &&
             s.second.correlated < kLessSlow * before.correlated && before.correlated > kSeenSlow * before.white;
    });
    if (!is_sharper || pass == 1 || listener.wants_end()) break;
    for (const auto& [name, noise] : sharper) {
      if (noise.total() < of.noise.at(name).total()) of.noise[name] = noise;
    }
  }
  Twin::Workspace workspace(ground.twin);
  const bool is_rough = !listener.wants_end() && models_own_error(runs, of.search.fit.prediction, of.noise).has_value();
  listener.begin("looking at what is left");
  of.unexplained = what_is_left(ground, runs, of, workspace);
  if (of.unexplained && is_rough) {
    weigh_by_model_error(ground, runs, names, how, of, workspace, listener);
    if (auto left = unexplained_of(*of.fitter, of.search, of.noise)) of.unexplained = std::move(left);
  }
  if (!listener.wants_end()) weigh_findings(*of.fitter, how, of.search, listener);
  return of;
}

}  // namespace driftwright::diagnosis
