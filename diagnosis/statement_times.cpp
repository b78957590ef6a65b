// When a statement holds: evidence of windows, of several of one size, and of courses of any shape, in cells of time.

#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/dense.hpp"
#include "diagnosis/statement_evidence.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr Eigen::Index kPieces = 12;  // steps of an unknown course in a record
constexpr int kMostWindows = 12;
constexpr Eigen::Index kEdgesTried = 16;  // trial rows of an edge, in its two cells

double log_mean(const Eigen::ArrayXd& terms) {
  const double most = terms.maxCoeff();
  return most + std::log((terms - most).exp().mean());
}

}  // namespace

Eigen::Index n_pieces_of(Eigen::Index n_cells) {
  return std::min(n_cells, kPieces);
}

Eigen::MatrixXd walk(Eigen::Index n_cells) {
  const Eigen::Index n = n_pieces_of(n_cells);
  Eigen::MatrixXd w = Eigen::MatrixXd::Zero(n_cells, n);
  for (Eigen::Index p = 0; p < n; ++p) w.col(p).tail(n_cells - p * n_cells / n).setOnes();
  return w;
}

StatementEvidence::OfWindows StatementEvidence::evaluated(const Windows& windows) const {
  const auto n = static_cast<Eigen::Index>(windows.squares.size());
  OfWindows of{.evidence = mixed(Eigen::Map<const Eigen::ArrayXd>(windows.squares.data(), n),
                                 Eigen::Map<const Eigen::ArrayXd>(windows.along.data(), n))};
  Eigen::Index best = 0;
  of.evidence.maxCoeff(&best);
  of.best = static_cast<std::size_t>(best);
  (void)mixed(windows.squares[of.best], windows.along[of.best], of.width);
  return of;
}

double StatementEvidence::of_rows(std::size_t k, const Sizes& on, Scored& scored) const {
  const auto& run = space_.cells[k].runs[scored.run];
  const Eigen::Index n_rows = run.edge.back() + 1, n_cells = static_cast<Eigen::Index>(run.edge.size()) - 1;
  const bool lasts = scored.end == n_cells;
  const auto rows_about = [&](Eigen::Index edge) {  // of the two cells that meet there
    const Eigen::Index from = run.edge[static_cast<std::size_t>(edge - 1)],
                       to = run.edge[static_cast<std::size_t>(std::min(edge + 1, n_cells))];
    const Eigen::Index step = std::max<Eigen::Index>(1, (to - from) / kEdgesTried);
    std::vector<Eigen::Index> rows;
    for (Eigen::Index row = from + 1; row < to; row += step) rows.push_back(row);
    return rows;
  };
  std::vector<Eigen::Index> edges = rows_about(scored.first);
  const std::size_t n_first = edges.size();
  if (!lasts) {
    for (Eigen::Index row : rows_about(scored.end)) edges.push_back(row);
  }
  const auto n = static_cast<Eigen::Index>(edges.size());
  const auto [first_row, n_of_run] = space_.rows[scored.run];
  const Eigen::Index n_acted = scored.when == When::kLastingOn ? residual_.x.rows() - first_row : n_of_run;
  Eigen::MatrixXd steps;  // one step from each row on; only rows of its record, and of later ones where it lasts
  Scored tried = scored;
  for (Eigen::Index i = 0; i < n; ++i) {
    tried.rows = StatedRows{scored.run, edges[static_cast<std::size_t>(i)], n_rows};
    if (i == 0)
      steps = item(tried).columns.x.middleRows(first_row, n_acted).replicate(1, n);  // equal in all other records
    else
      steps.col(i).head(n_of_run) = space_.condensed(scored.run, space_.readings({chosen(tried)})[scored.run]);
  }
  const Eigen::MatrixXd nuisance = q_.middleRows(first_row, n_acted).transpose() * steps,
                        shared = share_.asDiagonal() * nuisance;
  Eigen::MatrixXd g = steps.transpose() * steps;
  g.noalias() -= nuisance.transpose() * shared;
  Eigen::VectorXd along = steps.transpose() * residual_.x.col(0).segment(first_row, n_acted);
  along.noalias() -= shared.transpose() * residual_.nuisance.col(0);
  if (on.size.size() > 0) {
    Eigen::MatrixXd common = on.columns.x.middleRows(first_row, n_acted).transpose() * steps;
    common.noalias() -= on.columns.nuisance.transpose() * shared;
    g.noalias() -= common.transpose() * (on.covariance * common);
    along.noalias() -= common.transpose() * on.size;
  }
  Windows windows;
  const auto take = [&](double squares, double in, Eigen::Index first, Eigen::Index end) {
    if (squares > kNothingLeft) windows.add(squares, in, first, end);
  };
  for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(n_first); ++i) {
    const Eigen::Index first = edges[static_cast<std::size_t>(i)];
    if (lasts) take(g(i, i), along[i], first, n_rows);
    for (auto j = static_cast<Eigen::Index>(n_first); j < n; ++j) {
      const Eigen::Index end = edges[static_cast<std::size_t>(j)];
      if (end > first) take(g(i, i) + g(j, j) - 2.0 * g(i, j), along[i] - along[j], first, end);
    }
  }
  if (windows.edges.empty()) return -1e300;
  const OfWindows of = evaluated(windows);
  scored.width = of.width;
  scored.rows = StatedRows{scored.run, windows.edges[of.best].first, windows.edges[of.best].second};
  return log_mean(of.evidence);
}

void StatementEvidence::score_windows(std::size_t k, const Sizes& on, const Eigen::MatrixXd& g, const Eigen::VectorXd& along,
                                      std::vector<Scored>& list) const {
  const Cells& cells = cells_[k];
  const std::size_t n_runs = cells.first.size() - 1, of = space_.columns.size() + k;
  const auto& acts = space_.cells[k].acts;
  const bool is_sharp = std::none_of(acts.begin(), acts.end(), [](const Acting& a) { return a.loads; });
  for (std::size_t r = 0; r < n_runs; ++r) {
    const Eigen::Index at = cells.first[r], n = cells.first[r + 1] - at;
    const Eigen::Index after = cells.first[r + 1], n_after = g.cols() - after;
    const Eigen::VectorXd with_after = n_after > 0 ? Eigen::VectorXd(g.middleRows(at, n).rightCols(n_after).rowwise().sum())
                                                   : Eigen::VectorXd(Eigen::VectorXd::Zero(n));
    const double d_after = n_after > 0 ? g.bottomRightCorner(n_after, n_after).sum() : 0.0,
                 along_after = n_after > 0 ? along.tail(n_after).sum() : 0.0;
    Scored window{.of = of, .when = When::kWindow, .run = r}, lasting{.of = of, .when = When::kLasting, .run = r},
        later{.of = of, .when = When::kLastingOn, .run = r};
    Windows of_windows, of_lasting, of_on;
    for (Eigen::Index end = n; end > 1; --end) {
      double d = 0.0, b = 0.0;
      for (Eigen::Index first = end - 1; first > 0; --first) {
        d += g(at + first, at + first) + 2.0 * g.col(at + first).segment(at + first + 1, end - first - 1).sum();
        b += along[at + first];
        if (!(d > kNothingLeft)) continue;
        (end < n ? of_windows : of_lasting).add(d, b, first, end);
        if (end == n && n_after > 0)
          of_on.add(d + 2.0 * with_after.segment(first, n - first).sum() + d_after, b + along_after, first, end);
      }
    }
    const double runs = std::log(static_cast<double>(n_runs));
    const auto take = [&](Scored& s, const Windows& windows, double share) {
      if (windows.edges.empty()) return;
      OfWindows all = evaluated(windows);
      std::tie(s.first, s.end) = windows.edges[all.best];
      s.width = all.width;
      double& most = all.evidence[static_cast<Eigen::Index>(all.best)];
      if (is_sharp) most = std::max(most, of_rows(k, on, s));
      s.log_prior = prior_cells_[k].window + std::log(share) - runs;
      s.log_evidence = log_mean(all.evidence);
      list.push_back(s);
    };
    const bool lasts = space_.cells[k].lasts;
    const double of_all = lasts ? options_.lasting + options_.lasting_on : 1.0;
    if (!lasts) take(window, of_windows, options_.once);
    take(lasting, of_lasting, (options_.lasting + (n_after > 0 ? 0.0 : options_.lasting_on)) / of_all);
    take(later, of_on, options_.lasting_on / of_all);
  }
}

/// Windows of one size, one after the other: each at the place with the largest evidence given those before. The cost of
/// each choice is the ratio of the best place to the mean of all.
void StatementEvidence::score_several(std::size_t k, const Eigen::MatrixXd& g, const Eigen::VectorXd& along,
                                      std::vector<Scored>& list) const {
  const Cells& cells = cells_[k];
  const std::size_t n_runs = cells.first.size() - 1;
  Eigen::VectorXd in = Eigen::VectorXd::Zero(g.rows());
  Scored s{.of = space_.columns.size() + k, .when = When::kWindows};
  double paid = 0.0, best = -1e300;
  for (int windows = 1; windows <= kMostWindows; ++windows) {
    const Eigen::VectorXd beside = g * in;
    const double d_before = in.dot(beside), b_before = in.dot(along);
    Windows places;
    for (std::size_t r = 0; r < n_runs; ++r) {
      for (Eigen::Index from = cells.first[r]; from < cells.first[r + 1]; ++from) {
        double d = d_before, b = b_before;
        for (Eigen::Index last = from; last < cells.first[r + 1] && in[last] == 0.0; ++last) {
          d += 2.0 * beside[last] + g(last, last) + 2.0 * g.col(last).segment(from, last - from).sum();
          b += along[last];
          if (d > kNothingLeft) places.add(d, b, from, last + 1);
        }
      }
    }
    if (places.edges.empty()) break;
    const OfWindows of = evaluated(places);
    const auto [first, end] = places.edges[of.best];
    const double most = of.evidence[static_cast<Eigen::Index>(of.best)], stage = log_mean(of.evidence);
    const double whole = stage - paid - windows * std::log(2.0);
    in.segment(first, end - first).setOnes();
    paid += most - stage;
    if (windows == 1) continue;  // that is kWindow
    if (whole > best) {
      best = whole;
      s.cells.assign(in.data(), in.data() + in.size());
      s.width = of.width;
      s.n_windows = windows;
    } else if (windows > 3) {
      break;
    }
  }
  if (s.n_windows == 0) return;
  s.log_prior = prior_cells_[k].window + std::log(options_.several);
  s.log_evidence = best;
  list.push_back(s);
}

void StatementEvidence::score_unknown(std::size_t k, const Eigen::MatrixXd& g, const Eigen::VectorXd& along,
                                      std::vector<Scored>& list) const {
  const Cells& cells = cells_[k];
  const std::size_t n_runs = cells.first.size() - 1, of = space_.columns.size() + k;
  for (std::size_t r = 0; r <= n_runs; ++r) {
    if (r == n_runs && n_runs == 1) break;
    const std::size_t from = r == n_runs ? 0 : r, to = r == n_runs ? n_runs : r + 1;
    const Eigen::Index at = cells.first[from], n = cells.first[to] - at;
    Eigen::Index n_pieces = 0;
    for (std::size_t i = from; i < to; ++i) n_pieces += diagnosis::n_pieces_of(cells.first[i + 1] - cells.first[i]);
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n, n_pieces);
    Eigen::Index p = 0;
    for (std::size_t i = from; i < to; ++i) {
      const Eigen::MatrixXd w = walk(cells.first[i + 1] - cells.first[i]);
      sum.block(cells.first[i] - at, p, w.rows(), w.cols()) = w;
      p += w.cols();
    }
    const Eigen::MatrixXd walks = sum.transpose() * (g.block(at, at, n, n) * sum);
    const Eigen::VectorXd b = sum.transpose() * along.segment(at, n);
    const dense::SymmetricEigen eigen(walks);
    const Eigen::ArrayXd d = eigen.eigenvalues().cwiseMax(0.0).array();
    const Eigen::ArrayXd in = (eigen.eigenvectors().transpose() * b).array();
    Scored s{.of = of, .when = r == n_runs ? When::kUnknownInAll : When::kUnknown, .run = from};
    Eigen::ArrayXd terms(options_.widths.size());
    for (Eigen::Index i = 0; i < terms.size(); ++i) {
      const double w = options_.widths[static_cast<std::size_t>(i)];
      terms[i] = (-0.5 * (w * w * d).log1p() + 0.5 * in.square() / (d + 1.0 / (w * w))).sum();
    }
    Eigen::Index best = 0;
    terms.maxCoeff(&best);
    s.width = options_.widths[static_cast<std::size_t>(best)];
    s.log_prior =
        prior_cells_[k].unknown + (n_runs == 1   ? 0.0
                                   : r == n_runs ? std::log(options_.all_records)
                                                 : std::log((1.0 - options_.all_records) / static_cast<double>(n_runs)));
    s.log_evidence = log_mean(terms);
    list.push_back(s);
  }
}

}  // namespace driftwright::diagnosis
