#include "diagnosis/latent_heat.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "diagnosis/no_solution.hpp"
#include "diagnosis/residual_structure.hpp"
#include "diagnosis/scene.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kPiece_s = 1200.0;
constexpr double kTypical_W = 30.0;  // of a change from piece to piece

double resemblance(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  const Eigen::VectorXd x = a.array() - a.mean(), y = b.array() - b.mean();
  const double norms = x.norm() * y.norm();
  return norms > 0.0 ? x.dot(y) / norms : 0.0;
}

}  // namespace

std::pair<std::string, double> resembles(const MeasuredRun& run, const Eigen::VectorXd& series) {
  const auto n = static_cast<Eigen::Index>(run.time_s.size());
  Eigen::VectorXd speed(n), time(n), ambient(n), feed(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double t_s = run.time_s[static_cast<std::size_t>(i)];
    const Drive d = run.cyclogram.drive(t_s);
    speed[i] = d.speed_rpm;
    feed[i] = d.feed_m_s[0] + d.feed_m_s[1] + d.feed_m_s[2];
    time[i] = t_s;
    ambient[i] = run.ambient.at(t_s);
  }
  Eigen::VectorXd change = Eigen::VectorXd::Zero(n), ambient_rate = Eigen::VectorXd::Zero(n),
                  travelled = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 1; i < n; ++i) {
    change[i] = std::abs(speed[i] - speed[i - 1]);
    ambient_rate[i] = ambient[i] - ambient[i - 1];
    travelled[i] = travelled[i - 1] + speed[i - 1] * (time[i] - time[i - 1]);
  }
  std::pair<std::string, double> best{"nothing recorded", 0.0};
  std::vector<std::pair<std::string, Eigen::VectorXd>> quantities = {
      {"speed", speed}, {"the square of speed", speed.cwiseAbs2()}, {"changes of speed", change}, {"turns made", travelled},
      {"feeds", feed},  {"ambient temperature", ambient},           {"its rate", ambient_rate},   {"time", time}};
  for (auto& [name, values] : beside_drive(run, 0.0)) quantities.emplace_back(name, std::move(values));
  for (const auto& [name, values] : quantities) {
    const double c = resemblance(values, series);
    if (std::abs(c) > std::abs(best.second) + 0.01) best = {name, c};
  }
  if (std::abs(best.second) < 0.4) best.first = "nothing recorded";
  return best;
}

std::optional<LatentHeat> latent_heat(const Fitter& fitter, const Hypothesis& hypothesis, const Fit& fit) {
  const Twin& twin = fitter.twin();
  const std::vector<effects::Body> bodies = scene_of(twin, fitter.runs()).bodies;
  struct Piece {
    std::size_t run;
    double from_s, until_s;
  };
  std::vector<Piece> pieces;
  for (std::size_t r = 0; r < fitter.runs().size(); ++r) {
    for (double t_s = 0.0; t_s < fitter.runs()[r].time_s.back() - 1.0; t_s += kPiece_s) {
      pieces.push_back({r, t_s, std::min(t_s + kPiece_s, fitter.runs()[r].time_s.back() + 1.0)});
    }
  }
  const auto n_pieces = static_cast<Eigen::Index>(pieces.size()), n = fitter.comparison().n();
  const Eigen::VectorXd base = fitter.comparison().whitened(fit.prediction);
  const Eigen::MatrixXd& j = fitter.nuisance_slopes();
  Eigen::MatrixXd hessian = j.transpose() * j;
  hessian.diagonal() += fitter.nuisance_sd().cwiseAbs2().cwiseInverse();
  const Eigen::LLT<Eigen::MatrixXd> scatter(hessian);
  const auto without_scatter = [&](const Eigen::MatrixXd& a) -> Eigen::MatrixXd {
    return a - j * scatter.solve(j.transpose() * a);
  };
  const Eigen::VectorXd rest = without_scatter(fit.residual);

  std::vector<double> explained(bodies.size(), 0.0);
  std::vector<Eigen::VectorXd> heat(bodies.size());
  for_each_index(
      bodies.size(), [&] { return Twin::Workspace(twin); },
      [&](std::size_t b, Twin::Workspace& workspace) {
        Eigen::MatrixXd signatures(n, n_pieces);
        const bool is_solved = has_solution([&] {
          for (Eigen::Index p = 0; p < n_pieces; ++p) {
            const Piece& piece = pieces[static_cast<std::size_t>(p)];
            const MeasuredRun& run = fitter.runs()[piece.run];
            TwinState state = fitter.state(hypothesis, fit.x);
            state.push_back(effects::make_effect("heat_source", bodies[b], {{"power", kTypical_W}}));
            state.back().from_s = piece.from_s;
            state.back().until_s = piece.until_s;
            state.back().in = run.name;
            Prediction prediction = fit.prediction;
            prediction[piece.run] = twin.read(state, run, twin.respond(state, run, workspace));
            signatures.col(p) = (fitter.comparison().whitened(prediction) - base) / kTypical_W;
          }
        });
        if (!is_solved) return;  // too hot for some law
        const Eigen::MatrixXd s = without_scatter(signatures);
        Eigen::MatrixXd normal = signatures.transpose() * s;
        for (Eigen::Index p = 0; p < n_pieces; ++p) {
          normal(p, p) += 0.05 / (kTypical_W * kTypical_W);
          if (p == 0 || pieces[static_cast<std::size_t>(p)].run != pieces[static_cast<std::size_t>(p - 1)].run) continue;
          const double weight = 1.0 / (kTypical_W * kTypical_W);
          normal(p, p) += weight;
          normal(p - 1, p - 1) += weight;
          normal(p, p - 1) -= weight;
          normal(p - 1, p) -= weight;
        }
        const Eigen::VectorXd projected = signatures.transpose() * rest;
        heat[b] = normal.ldlt().solve(projected);
        const double before = fit.residual.dot(rest),
                     after = before - 2.0 * heat[b].dot(projected) + heat[b].dot(signatures.transpose() * (s * heat[b]));
        explained[b] = (before - after) / std::max(1.0, before - static_cast<double>(n));
      });
  const auto best = static_cast<std::size_t>(std::max_element(explained.begin(), explained.end()) - explained.begin());
  if (bodies.empty() || heat[best].size() == 0) return std::nullopt;
  LatentHeat latent;
  latent.body = bodies[best].name;
  latent.explained = std::min(1.0, explained[best]);
  latent.time_s = fitter.runs()[0].time_s;
  Eigen::VectorXd series(static_cast<Eigen::Index>(latent.time_s.size()));
  for (std::size_t i = 0; i < latent.time_s.size(); ++i) {
    double value_W = 0.0;
    for (Eigen::Index p = 0; p < n_pieces; ++p) {
      const Piece& piece = pieces[static_cast<std::size_t>(p)];
      if (piece.run == 0 && latent.time_s[i] >= piece.from_s && latent.time_s[i] < piece.until_s) value_W = heat[best][p];
    }
    latent.heat_W.push_back(value_W);
    series[static_cast<Eigen::Index>(i)] = value_W;
  }
  std::tie(latent.correlates_with, latent.correlation) = resembles(fitter.runs()[0], series);
  return latent;
}

}  // namespace driftwright::diagnosis
