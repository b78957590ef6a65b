#include "diagnosis/experiment.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace driftwright::diagnosis {
namespace {

constexpr double kRows_s = 60.0;

/// Cyclograms that ask different questions of a machine.
std::vector<Cyclogram> family(double top_rpm) {
  const auto section = [](double minutes, double rpm) { return Cyclogram::Section{60.0 * minutes, {.speed_rpm = rpm}}; };
  std::vector<Cyclogram> list;
  list.push_back({"steady", {section(360, top_rpm)}});
  list.push_back({"heat_and_cool", {section(150, top_rpm), section(210, 0.0)}});
  list.push_back(
      {"levels", {section(90, 0.3 * top_rpm), section(90, 0.6 * top_rpm), section(90, top_rpm), section(90, 0.0)}});
  Cyclogram alternating{"alternating", {}};
  for (int i = 0; i < 9; ++i) {
    alternating.sections.push_back(section(20, top_rpm));
    alternating.sections.push_back(section(20, i % 2 ? 0.4 * top_rpm : 0.0));
  }
  list.push_back(alternating);
  list.push_back({"standstill", {section(360, 0.0)}});
  return list;
}

Eigen::VectorXd without_linear(const Eigen::VectorXd& x, Eigen::Index n_scatter, Eigen::Index n_nuisance) {
  Eigen::VectorXd kept(x.size() - (n_nuisance - n_scatter));
  kept << x.head(n_scatter), x.tail(x.size() - n_nuisance);
  return kept;
}

}  // namespace

std::optional<Experiment> propose_experiment(const Fitter& fitter, const SearchResult& result, const Finding& finding) {
  if (finding.alternatives.empty()) return std::nullopt;
  const Finding::Alternative& other = finding.alternatives.front();
  Hypothesis alternative;
  for (const Claim& c : result.hypothesis) {
    if (c.candidate != finding.claim.candidate) alternative.push_back(c);
  }
  alternative.push_back(other.claim);
  const auto n_scatter = static_cast<Eigen::Index>(fitter.scatter().size());
  const Eigen::VectorXd x_a = without_linear(result.fit.x, n_scatter, fitter.n_nuisance()),
                        x_b = without_linear(other.fit.x, n_scatter, fitter.n_nuisance());
  double top_rpm = 0.0;
  std::map<std::string, NoiseModel> noise;
  MeasuredRun pattern = fitter.runs().front();
  for (const MeasuredRun& run : fitter.runs()) {
    for (const auto& s : run.cyclogram.sections) top_rpm = std::max(top_rpm, s.drive.speed_rpm);
  }
  if (top_rpm <= 0.0) top_rpm = 1000.0;
  for (const MeasuredChannel& c : pattern.channels) noise[c.name] = {c.unit == "K" ? 0.05 : 3e-7, 0.0, 0.0};

  Eigen::MatrixXd precision = result.fit.covariance.topLeftCorner(n_scatter, n_scatter).inverse();
  std::optional<Experiment> best;
  for (const Cyclogram& cyclogram : family(top_rpm)) {
    MeasuredRun run = pattern;
    run.name = cyclogram.name;
    run.cyclogram = cyclogram;
    run.hall = {{0.0}, {pattern.hall.at(0.0)}};
    run.time_s.clear();
    for (double t_s = 0.0; t_s <= cyclogram.duration_s() + 1e-6; t_s += kRows_s) run.time_s.push_back(t_s);
    set_grid(run);
    for (MeasuredChannel& c : run.channels) c.value = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(run.time_s.size()));
    const std::vector<MeasuredRun> runs = {run};
    Fitter ahead(fitter.twin(), runs, fitter.scatter(), {});
    ahead.set_noise(noise);
    Twin::Workspace workspace(fitter.twin());
    Eigen::VectorXd difference;
    try {
      difference = ahead.comparison().whitened(ahead.predict(result.hypothesis, x_a, workspace)) -
                   ahead.comparison().whitened(ahead.predict(alternative, x_b, workspace));
    } catch (const std::exception&) {  // one of them has no solution there
      continue;
    }
    const Eigen::MatrixXd& j = ahead.nuisance_slopes();
    const Eigen::MatrixXd hessian = j.transpose() * j + precision;
    const Eigen::VectorXd jd = j.transpose() * difference;
    const double square = difference.squaredNorm() - jd.dot(hessian.llt().solve(jd));
    const double discrimination = std::sqrt(std::max(0.0, square));
    if (best && discrimination <= best->discrimination) continue;
    best = Experiment{"", cyclogram, discrimination, std::nullopt};
  }
  if (!best) return std::nullopt;
  const auto words = [](const Claim& c) { return fmt::format("{} at {}", c.knobs.front().effect, c.knobs.front().where); };
  best->why = best->discrimination > 3.0
                  ? fmt::format("{} and {} then differ by {:.0f} times the noise, scatter taken off", words(finding.claim),
                                words(other.claim), best->discrimination)
                  : fmt::format("no cyclogram of the family tells {} from {} (at best {:.1f} times the noise)",
                                words(finding.claim), words(other.claim), best->discrimination);
  // Where would one more thermometer see it, on the runs at hand?
  const auto& names = fitter.twin().outputs().name;
  for (std::size_t o = 0; o < names.size(); ++o) {
    if (!names[o].starts_with("mean of ")) continue;
    double most_K = 0.0;
    for (std::size_t r = 0; r < fitter.runs().size(); ++r) {
      most_K = std::max(most_K, (result.fit.prediction[r].row(static_cast<Eigen::Index>(o)) -
                                 other.fit.prediction[r].row(static_cast<Eigen::Index>(o)))
                                    .cwiseAbs()
                                    .maxCoeff());
    }
    if (!best->extra_sensor || most_K > best->extra_sensor->difference_K)
      best->extra_sensor = Experiment::Sensor{names[o].substr(8), most_K};
  }
  return best;
}

}  // namespace driftwright::diagnosis
