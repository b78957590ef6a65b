#include "diagnosis/foresight.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/scatter.hpp"

namespace driftwright::diagnosis {
namespace {

bool may_be_planned_for(const Variant& v) {
  return !v.happens && !v.all_or_nothing && v.in.empty() &&
         std::none_of(v.knobs.begin(), v.knobs.end(), [](const Knob& k) { return k.is_time; });
}

/// Equal weights for kinds, for the places of a kind, and for the laws of a place.
void weigh(Doubts& doubts) {
  std::map<std::string, std::set<std::size_t>> places;
  for (const Doubts::Shape& s : doubts.shapes) places[doubts.candidates[s.candidate].effect].insert(s.candidate);
  for (std::size_t i = 0; i < doubts.shapes.size(); ++i) {
    const Doubts::Shape& s = doubts.shapes[i];
    const Candidate& c = doubts.candidates[s.candidate];
    double n_of_place = 0.0;
    for (const Doubts::Shape& other : doubts.shapes) n_of_place += other.candidate == s.candidate ? 1.0 : 0.0;
    doubts.question.laws[i].weight =
        1.0 / (static_cast<double>(places.size()) * static_cast<double>(places.at(c.effect).size()) * n_of_place);
  }
}

}  // namespace

MeasuredRun planned_run(const Cyclogram& cyclogram, double interval_s, const TimeSeries& ambient, bool has_ambient,
                        std::vector<MeasuredChannel> channels) {
  MeasuredRun run;
  run.name = cyclogram.name;
  run.cyclogram = cyclogram;
  run.ambient = ambient;
  run.has_ambient = has_ambient;
  const auto n_intervals = static_cast<int>(std::floor(cyclogram.duration_s() / interval_s + 1e-9));
  for (int i = 0; i <= n_intervals; ++i) run.time_s.push_back(interval_s * i);
  set_grid(run);
  run.channels = std::move(channels);
  for (MeasuredChannel& c : run.channels) c.value = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(run.time_s.size()));
  return run;
}

Doubts doubts_before(const Twin& twin, const MeasuredRun& run, const std::set<std::string>& without) {
  Doubts doubts;
  doubts.numbers = scatter(twin);
  for (Knob& k : ambient_scatter({run})) doubts.numbers.push_back(std::move(k));
  doubts.candidates = candidates(twin, {run}, without);
  for (Candidate& c : doubts.candidates) std::erase_if(c.variants, [](const Variant& v) { return !may_be_planned_for(v); });
  std::erase_if(doubts.candidates, [](const Candidate& c) { return c.variants.empty(); });
  Question& q = doubts.question;
  q.number_sd.resize(static_cast<Eigen::Index>(doubts.numbers.size()));
  for (std::size_t i = 0; i < doubts.numbers.size(); ++i)
    q.number_sd[static_cast<Eigen::Index>(i)] = doubts.numbers[i].prior_sd;
  for (std::size_t c = 0; c < doubts.candidates.size(); ++c) {
    const Candidate& candidate = doubts.candidates[c];
    for (std::size_t v = 0; v < candidate.variants.size(); ++v) {
      const Variant& law = candidate.variants[v];
      const double n_others = static_cast<double>(doubts.candidates.size() * candidate.variants.size() * law.grid.size());
      for (const std::vector<double>& shape : law.grid) {
        Eigen::VectorXd x = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(law.knobs.size()));
        x[0] = law.trial_x;
        for (std::size_t k = 0; k < shape.size(); ++k) x[static_cast<Eigen::Index>(k + 1)] = shape[k];
        doubts.shapes.push_back({c, v, std::move(x)});
        q.laws.push_back({.effect = candidate.effect,
                          .where = candidate.where,
                          .law = law.law,
                          .size_sd = law.knobs.front().prior_sd,
                          .price_nats = law.price_nats + std::log(n_others)});
      }
    }
  }
  weigh(doubts);
  return doubts;
}

TwinState with_law(const Twin& twin, const Doubts& doubts, const Doubts::Shape& law) {
  TwinState state = twin.as_written();
  const std::vector<Knob>& knobs = doubts.variant(law).knobs;
  for (std::size_t k = 0; k < knobs.size(); ++k) knobs[k].set(state, knobs[k].value(law.x[static_cast<Eigen::Index>(k)]));
  return state;
}

TwinState with_number(const Twin& twin, const Knob& number) {
  TwinState state = twin.as_written();
  number.set(state, number.value(number.step));
  return state;
}

Doubts thinned(const Twin& twin, Doubts doubts, const MeasuredRun& run, std::size_t most_of_a_kind) {
  Twin::Workspace workspace(twin);
  const std::size_t n_times = twin.bound(twin.as_written(), run, workspace).system.change_times_s.size();
  std::vector<std::size_t> kept;
  std::map<std::string, std::size_t> n_of, passed;
  for (std::size_t i = 0; i < doubts.shapes.size(); ++i) {
    if (twin.bound(with_law(twin, doubts, doubts.shapes[i]), run, workspace).system.change_times_s.size() != n_times)
      continue;
    kept.push_back(i);
    ++n_of[doubts.question.laws[i].effect];
  }
  std::vector<Doubts::Shape> shapes;
  std::vector<DoubtedLaw> laws;
  for (std::size_t i : kept) {
    const DoubtedLaw& law = doubts.question.laws[i];
    const std::size_t n = n_of.at(law.effect), at = passed[law.effect]++;
    if (n > most_of_a_kind && at * most_of_a_kind / n == (at + 1) * most_of_a_kind / n) continue;
    shapes.push_back(doubts.shapes[i]);
    laws.push_back(law);
  }
  doubts.shapes = std::move(shapes);
  doubts.question.laws = std::move(laws);
  weigh(doubts);
  return doubts;
}

std::vector<Eigen::MatrixXd> information_by_channel(const Twin& twin, const Doubts& doubts, const MeasuredRun& run,
                                                    const std::map<std::string, NoiseModel>& noise) {
  const std::vector<MeasuredRun> runs = {run};
  Fitter fitter(twin, runs, doubts.numbers, {});
  fitter.set_noise(noise);
  Fit at;
  at.x = Eigen::VectorXd::Zero(fitter.n_nuisance());
  {
    Twin::Workspace workspace(twin);
    at.prediction = fitter.predict({}, at.x, workspace);
  }
  const Comparison& comparison = fitter.comparison();
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(comparison.n_condensed(), doubts.question.n());
  columns.leftCols(fitter.n_nuisance()) = comparison.condensed(fitter.nuisance_slopes());
  for (const Signature& s : signatures(fitter, doubts.candidates, laws_of(doubts.candidates), {}, at, Shapes::kOfGrid)) {
    const auto of = std::find_if(doubts.shapes.begin(), doubts.shapes.end(), [&](const Doubts::Shape& shape) {
      return shape.candidate == s.candidate && shape.variant == s.variant && shape.x == s.shape;
    });
    if (of != doubts.shapes.end()) columns.col(fitter.n_nuisance() + (of - doubts.shapes.begin())) = s.column;
  }
  std::vector<Eigen::MatrixXd> list;
  for (std::size_t b = 0; b < comparison.blocks().size(); ++b) {
    const auto [first, n] = comparison.condensed_block(b);
    Eigen::MatrixXd of_channel = Eigen::MatrixXd::Zero(columns.cols(), columns.cols());
    of_channel.selfadjointView<Eigen::Lower>().rankUpdate(columns.middleRows(first, n).transpose());
    of_channel.triangularView<Eigen::StrictlyUpper>() = of_channel.transpose();
    list.push_back(std::move(of_channel));
  }
  return list;
}

}  // namespace driftwright::diagnosis
