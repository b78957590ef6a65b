#include "diagnosis/window_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "diagnosis/happening.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr Eigen::Index kFiner = 12;  // parts of two of them about an edge

/// Heat of the bodies from row to row by a unit of what acts at a place: 1 W, 1 W/K, or all that turning makes [W], n_bodies x n_rows - 1.
Eigen::MatrixXd heat_of_unit(const SeenRun& run, const WindowPlace& place, std::size_t n_bodies) {
  if (place.is_speed) return run.linear.turning_W;
  const Eigen::Index n = run.linear.decay.cols();
  const auto body = static_cast<Eigen::Index>(place.body);
  Eigen::MatrixXd heat_W = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(n_bodies), n);
  heat_W.row(body).setOnes();
  if (!place.other) return heat_W;
  const Eigen::MatrixXd& warm_K = run.linear.temperature_K;
  const bool is_ambient = *place.other == n_bodies;
  const auto other = static_cast<Eigen::Index>(*place.other);
  const auto at = [&](Eigen::Index row) {
    return (is_ambient ? run.linear.ambient_K[row] : warm_K(row, other)) - warm_K(row, body);
  };
  for (Eigen::Index k = 0; k < n; ++k) heat_W(body, k) = mean_difference(at(k), at(k + 1));
  if (!is_ambient) heat_W.row(other) = -heat_W.row(body);
  return heat_W;
}

/// Whitened readings, condensed, of a unit through a place in each cell of a run, n_rows x n_cells. @param edges  rows between the cells
Eigen::MatrixXd columns_of(const Comparison& comparison, const SeenRun& run, const WindowPlace& place, std::size_t n_bodies,
                           const std::vector<Eigen::Index>& edges) {
  const Eigen::MatrixXd gain = modal_gain(run.linear, heat_of_unit(run, place, n_bodies));
  const auto n_cells = static_cast<Eigen::Index>(edges.size()) - 1;
  Eigen::MatrixXd columns(run.n_rows, n_cells);
  Eigen::VectorXd whitened(comparison.n_of(run.number));
  for (Eigen::Index c = 0; c < n_cells; ++c) {
    const Eigen::Index from = edges[static_cast<std::size_t>(c)], to = edges[static_cast<std::size_t>(c + 1)];
    comparison.whiten(run.number, response(run.linear, gain, from, to), whitened);
    columns.col(c) = comparison.condensed(run.number, whitened);
  }
  return columns;
}

}  // namespace

SeenRun seen_run(const Fitter& fitter, const TwinState& state, std::size_t r, const std::vector<effects::Body>& bodies,
                 Twin::Workspace& workspace) {
  const MeasuredRun& run = fitter.runs()[r];
  std::vector<Eigen::Index> rows(run.time_s.size());
  std::iota(rows.begin(), rows.end(), 0);
  SeenRun s{.number = r,
            .linear = linear_run(fitter.twin(), run, state, bodies, rows,
                                 Eigen::VectorXd::Ones(static_cast<Eigen::Index>(run.channels.size())), workspace)};
  std::tie(s.first_row, s.n_rows) = fitter.comparison().condensed_rows(r);
  return s;
}

WindowEvidence evidence_of(const Fitter& fitter, const Projection& projection, const std::vector<SeenRun>& runs,
                           const WindowPlace& place, std::size_t n_bodies, const Edges& edges) {
  WindowEvidence e;
  Eigen::Index n_cells = 0;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    WindowEvidence::Run run{n_cells, {}, row_s(fitter.runs()[r])};
    for (Eigen::Index row : edges[r]) run.edge_s.push_back(fitter.runs()[r].time_s[static_cast<std::size_t>(row)]);
    e.runs.push_back(std::move(run));
    n_cells += static_cast<Eigen::Index>(edges[r].size()) - 1;
  }
  e.slope.resize(n_cells);
  e.curvature = Eigen::MatrixXd::Zero(n_cells, n_cells);
  Eigen::MatrixXd known(projection.slopes.cols(), n_cells);  // what the numbers known roughly have of each column
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const Eigen::MatrixXd columns = columns_of(fitter.comparison(), runs[r], place, n_bodies, edges[r]);
    const Eigen::Index first = e.runs[r].first, n = columns.cols();
    e.curvature.block(first, first, n, n).noalias() = columns.transpose() * columns;
    known.middleCols(first, n).noalias() =
        projection.slopes.middleRows(runs[r].first_row, runs[r].n_rows).transpose() * columns;
    e.slope.segment(first, n).noalias() = columns.transpose() * projection.rest.segment(runs[r].first_row, runs[r].n_rows);
  }
  e.curvature.noalias() -= known.transpose() * projection.factor.solve(known);
  return e;
}

Edges coarse_edges(const std::vector<MeasuredRun>& runs, Eigen::Index most_cells) {
  Edges edges;
  for (const MeasuredRun& run : runs) {
    const auto n_steps = static_cast<Eigen::Index>(run.time_s.size()) - 1;
    const Eigen::Index n_cells = std::min(n_steps, most_cells);
    std::vector<Eigen::Index>& of_run = edges.emplace_back();
    for (Eigen::Index c = 0; c <= n_cells; ++c) of_run.push_back(c * n_steps / n_cells);
  }
  return edges;
}

Edges finer_edges(const Edges& coarse, std::vector<FoundWindows::Window>& windows) {
  std::vector<std::set<Eigen::Index>> rows;
  for (const auto& of_run : coarse) rows.emplace_back(of_run.begin(), of_run.end());
  for (const FoundWindows::Window& w : windows) {
    const auto& of_run = coarse[w.run];
    for (const Eigen::Index edge : {w.first, w.last}) {
      const Eigen::Index from = of_run[static_cast<std::size_t>(std::max<Eigen::Index>(0, edge - 1))];
      const Eigen::Index to = of_run[std::min(of_run.size() - 1, static_cast<std::size_t>(edge + 1))];
      const Eigen::Index stride = std::max<Eigen::Index>(1, (to - from) / kFiner);
      for (Eigen::Index row = from; row < to; row += stride) rows[w.run].insert(row);
    }
  }
  Edges finer;
  for (const auto& of_run : rows) finer.emplace_back(of_run.begin(), of_run.end());
  for (FoundWindows::Window& w : windows) {
    const auto index = [&](Eigen::Index edge) {
      const auto& fine = finer[w.run];
      return std::lower_bound(fine.begin(), fine.end(), coarse[w.run][static_cast<std::size_t>(edge)]) - fine.begin();
    };
    w = {w.run, index(w.first), index(w.last)};
  }
  return finer;
}

}  // namespace driftwright::diagnosis
