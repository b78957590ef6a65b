#include "diagnosis/statement_evidence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "base/dense.hpp"
#include "base/parallel.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kNothingLeft = 1e-9;  // share of a column's squares, below which roughly known numbers can fully replace it
constexpr double kSeen = 1e-6;         // squares of a direction of the nuisance above noise
constexpr Eigen::Index kPieces = 12;   // steps of an unknown course in a record
constexpr int kMostWindows = 12;
constexpr Eigen::Index kEdgesTried = 16;  // trial rows of an edge, in its two cells

double log_mean(const Eigen::ArrayXd& terms) {
  const double most = terms.maxCoeff();
  return most + std::log((terms - most).exp().mean());
}

Eigen::Index n_pieces_of(Eigen::Index n_cells) {
  return std::min(n_cells, kPieces);
}

/// Maps steps that last, a random walk, to cells: n_cells x n_pieces.
Eigen::MatrixXd walk(Eigen::Index n_cells) {
  const Eigen::Index n = n_pieces_of(n_cells);
  Eigen::MatrixXd w = Eigen::MatrixXd::Zero(n_cells, n);
  for (Eigen::Index p = 0; p < n; ++p) w.col(p).tail(n_cells - p * n_cells / n).setOnes();
  return w;
}

}  // namespace

StatementEvidence::StatementEvidence(const StatementSpace& space, const StatementOptions& options,
                                     const Eigen::VectorXd& residual, const Eigen::MatrixXd& nuisance)
    : space_(space), options_(options) {
  const dense::SymmetricEigen eigen(nuisance.transpose() * nuisance);
  const Eigen::VectorXd squares = eigen.eigenvalues().cwiseMax(0.0);
  const auto n_kept = (squares.array() > kSeen).count();
  const Eigen::VectorXd kept = squares.tail(n_kept);
  q_ = nuisance * eigen.eigenvectors().rightCols(n_kept) * kept.cwiseSqrt().cwiseInverse().asDiagonal();
  share_ = kept.array() / (1.0 + kept.array());
  residual_ = {residual, q_.transpose() * residual};
  const auto n_columns = static_cast<Eigen::Index>(space.columns.size());
  for (std::size_t r = 0; r < space.rows.size(); ++r) {
    const auto& [first, n] = space.rows[r];
    OfRun of{.x = Eigen::MatrixXd(n, n_columns), .nuisance = {}, .squares = {}, .along = {}};
    for (Eigen::Index i = 0; i < n_columns; ++i) of.x.col(i) = space.columns[static_cast<std::size_t>(i)].of_run[r];
    of.nuisance = q_.middleRows(first, n).transpose() * of.x;
    of.squares = of.x.colwise().squaredNorm().transpose();
    of.along = of.x.transpose() * residual.segment(first, n);
    of_run_.push_back(std::move(of));
  }
  for (const StatementCells& c : space.cells) cells_.push_back(cells_of(c));
  set_records();
  set_priors();
}

StatementEvidence::Cells StatementEvidence::cells_of(const StatementCells& c) const {
  Cells cells;
  Eigen::Index n_cells = 0;
  for (const auto& run : c.runs) {
    cells.first.push_back(n_cells);
    n_cells += run.of_cell.cols();
  }
  cells.first.push_back(n_cells);
  cells.nuisance.resize(q_.cols(), n_cells);
  cells.squares = Eigen::MatrixXd::Zero(n_cells, n_cells);
  cells.along.resize(n_cells);
  for (std::size_t r = 0; r < c.runs.size(); ++r) {
    const auto& [first, n] = space_.rows[r];
    const Eigen::MatrixXd& of = c.runs[r].of_cell;
    cells.nuisance.middleCols(cells.first[r], of.cols()).noalias() = q_.middleRows(first, n).transpose() * of;
    cells.squares.block(cells.first[r], cells.first[r], of.cols(), of.cols()).noalias() = of.transpose() * of;
    cells.along.segment(cells.first[r], of.cols()).noalias() = of.transpose() * residual_.x.col(0).segment(first, n);
  }
  const Eigen::MatrixXd shared = share_.asDiagonal() * cells.nuisance;
  cells.squares.noalias() -= cells.nuisance.transpose() * shared;
  cells.along.noalias() -= shared.transpose() * residual_.nuisance;
  return cells;
}

Eigen::MatrixXd StatementEvidence::products(const TakenColumns& a, const TakenColumns& b) const {
  Eigen::MatrixXd p = a.x.transpose() * b.x;
  p.noalias() -= a.nuisance.transpose() * (share_.asDiagonal() * b.nuisance);
  return p;
}

StatementEvidence::Sizes StatementEvidence::sizes(const std::vector<Item>& set) const {
  Sizes s;
  s.columns.x.resize(residual_.x.rows(), 0);
  s.columns.nuisance.resize(q_.cols(), 0);
  Eigen::VectorXd width(0);
  const auto append = [](Eigen::MatrixXd& to, const Eigen::MatrixXd& of) {
    to.conservativeResize(Eigen::NoChange, to.cols() + of.cols());
    to.rightCols(of.cols()) = of;
  };
  for (const Item& i : set) {
    append(s.columns.x, i.columns.x);
    append(s.columns.nuisance, i.columns.nuisance);
    width.conservativeResize(width.size() + i.width.size());
    width.tail(i.width.size()) = i.width;
  }
  if (width.size() == 0) return s;
  Eigen::MatrixXd a = products(s.columns, s.columns);
  a.diagonal().array() += width.array().square().inverse();
  s.covariance = dense::solve_definite(a, Eigen::MatrixXd::Identity(a.rows(), a.cols()));
  s.size = s.covariance * products(s.columns, residual_);
  return s;
}

double StatementEvidence::left(const std::vector<Item>& set) const {
  const double whole = products(residual_, residual_)(0, 0);
  if (set.empty()) return whole;
  const Sizes s = sizes(set);
  return whole - products(s.columns, residual_).col(0).dot(s.size);
}

double StatementEvidence::mixed(double squares, double along, double& best_width) const {
  double best = -1e300, sum = 0.0;
  for (double w : options_.widths) {
    const double e = -0.5 * std::log1p(w * w * squares) + 0.5 * along * along / (squares + 1.0 / (w * w));
    if (e > best) {
      sum = sum * std::exp(best - e) + 1.0;
      best = e;
      best_width = w;
    } else {
      sum += std::exp(e - best);
    }
  }
  return best + std::log(sum / static_cast<double>(options_.widths.size()));
}

/// The sum over widths is that of exp(q - q of the widest) / sqrt(1 + w² squares), q = along² / (2 (squares + 1 / w²)), which
/// takes one logarithm in all.
Eigen::ArrayXd StatementEvidence::mixed(const Eigen::ArrayXd& squares, const Eigen::ArrayXd& along) const {
  const double widest = *std::max_element(options_.widths.begin(), options_.widths.end());
  const Eigen::ArrayXd half = 0.5 * along.square(), most = half / (squares + 1.0 / (widest * widest));
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(squares.size());
  for (double w : options_.widths) sum += (half / (squares + 1.0 / (w * w)) - most).exp() / (1.0 + w * w * squares).sqrt();
  return most + (sum / static_cast<double>(options_.widths.size())).log();
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

std::vector<Scored> StatementEvidence::scored(const std::vector<Item>& set) const {
  const Sizes on = sizes(set);
  std::vector<Scored> list;
  score_columns(on, list);
  std::vector<std::vector<Scored>> of_cells(cells_.size());
  for_each_index(
      cells_.size(), [] { return 0; },
      [&](std::size_t k, int) {
        Eigen::MatrixXd g = cells_[k].squares;
        Eigen::VectorXd along = cells_[k].along;
        if (!set.empty()) {
          Eigen::MatrixXd common = -on.columns.nuisance.transpose() * (share_.asDiagonal() * cells_[k].nuisance);
          for (std::size_t r = 0; r < space_.rows.size(); ++r) {
            const auto& [first, n] = space_.rows[r];
            const Eigen::MatrixXd& of = space_.cells[k].runs[r].of_cell;
            common.middleCols(cells_[k].first[r], of.cols()).noalias() += on.columns.x.middleRows(first, n).transpose() * of;
          }
          g.noalias() -= common.transpose() * (on.covariance * common);
          along.noalias() -= common.transpose() * on.size;
        }
        score_windows(k, on, g, along, of_cells[k]);
        if (space_.cells[k].lasts) return;
        score_several(k, g, along, of_cells[k]);
        score_unknown(k, g, along, of_cells[k]);
      });
  for (auto& l : of_cells) list.insert(list.end(), std::make_move_iterator(l.begin()), std::make_move_iterator(l.end()));
  return list;
}

void StatementEvidence::score_columns(const Sizes& on, std::vector<Scored>& list) const {
  const bool is_set = on.size.size() > 0;
  std::vector<Eigen::MatrixXd> c(of_run_.size());  // products of the set with each column of a run
  for (std::size_t r = 0; is_set && r < of_run_.size(); ++r)
    c[r] = on.columns.x.middleRows(space_.rows[r].first, space_.rows[r].n).transpose() * of_run_[r].x;
  const Eigen::MatrixXd set_nuisance = share_.asDiagonal() * on.columns.nuisance;
  const Eigen::VectorXd r_nuisance = share_.asDiagonal() * residual_.nuisance;
  const auto n_columns = static_cast<Eigen::Index>(space_.columns.size());
  for (std::size_t k = 0; k < records_.size(); ++k) {
    Eigen::MatrixXd p = Eigen::MatrixXd::Zero(q_.cols(), n_columns),
                    common = Eigen::MatrixXd::Zero(on.columns.x.cols(), n_columns);
    Eigen::VectorXd d = Eigen::VectorXd::Zero(n_columns), along = d;
    for (std::size_t r = 0; r < of_run_.size(); ++r) {
      if (!records_[k].in[r]) continue;
      p += of_run_[r].nuisance;
      d += of_run_[r].squares;
      along += of_run_[r].along;
      if (is_set) common += c[r];
    }
    const Eigen::VectorXd whole = d;
    d -= (share_.asDiagonal() * p.cwiseAbs2()).colwise().sum().transpose();
    along -= p.transpose() * r_nuisance;
    if (is_set) {
      common.noalias() -= set_nuisance.transpose() * p;
      d -= common.cwiseProduct(on.covariance * common).colwise().sum().transpose();
      along -= common.transpose() * on.size;
    }
    for (Eigen::Index j = 0; j < n_columns; ++j) {
      if (!(d[j] > kNothingLeft * whole[j]) || !(whole[j] > 0.0)) continue;
      Scored s{.of = static_cast<std::size_t>(j), .records = k};
      s.log_prior = prior_[static_cast<std::size_t>(j)] + records_[k].log_prior;
      s.log_evidence = mixed(d[j], along[j], s.width);
      list.push_back(s);
    }
  }
}

Item StatementEvidence::item(const Scored& s) const {
  Item i{.says = said(s), .chosen = chosen(s), .columns = {}, .width = {}};
  const Eigen::Index n_pieces = s.when == When::kUnknown || s.when == When::kUnknownInAll ? n_pieces_of(s) : 1;
  i.columns.x = Eigen::MatrixXd::Zero(residual_.x.rows(), n_pieces);
  Eigen::Index at = 0;
  for (std::size_t r = 0; r < space_.rows.size(); ++r) {
    const Eigen::VectorXd& amount = i.chosen.amount[r];
    if (amount.size() == 0) continue;
    const auto& [first, n] = space_.rows[r];
    if (!i.chosen.is_cells) {
      i.columns.x.col(0).segment(first, n) = of_run_[r].x.col(static_cast<Eigen::Index>(s.of));
    } else if (i.chosen.rows && i.chosen.rows->run == r) {
      i.columns.x.col(0).segment(first, n) = space_.condensed(r, space_.readings({i.chosen})[r]);
    } else if (n_pieces == 1) {
      i.columns.x.col(0).segment(first, n) = space_.cells[i.chosen.index].runs[r].of_cell * amount;
    } else {
      const Eigen::MatrixXd walks = space_.cells[i.chosen.index].runs[r].of_cell * walk(amount.size());
      i.columns.x.block(first, at, n, walks.cols()) = walks;
      at += walks.cols();
    }
  }
  i.columns.nuisance = q_.transpose() * i.columns.x;
  i.width = Eigen::VectorXd::Constant(n_pieces, s.width);
  return i;
}

std::optional<Scored> StatementEvidence::any_course(const Statement& says) const {
  for (std::size_t k = 0; k < cells_.size(); ++k) {
    const Statement& s = space_.cells[k].says;
    if (s.quantity != says.quantity || s.place != says.place || s.unit != says.unit || space_.cells[k].lasts) continue;
    std::vector<Scored> list;
    score_unknown(k, cells_[k].squares, cells_[k].along, list);
    return list.back();
  }
  return std::nullopt;
}

Chosen StatementEvidence::chosen(const Scored& s) const {
  Chosen c{.is_cells = s.when != When::kGiven, .index = s.of, .amount = std::vector<Eigen::VectorXd>(space_.rows.size())};
  if (!c.is_cells) {
    for (std::size_t r = 0; r < c.amount.size(); ++r) {
      if (records_[s.records].in[r]) c.amount[r] = Eigen::VectorXd::Ones(1);
    }
    return c;
  }
  c.index -= space_.columns.size();
  const auto& runs = space_.cells[c.index].runs;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const Eigen::Index n = runs[r].of_cell.cols();
    const bool is_it = r == s.run;
    if (s.when == When::kUnknownInAll || (s.when == When::kUnknown && is_it) || (s.when == When::kLastingOn && r > s.run))
      c.amount[r] = Eigen::VectorXd::Ones(n);
    else if (s.when == When::kWindows)
      c.amount[r] = Eigen::Map<const Eigen::VectorXd>(s.cells.data() + cells_[c.index].first[r], n);
    else if (is_it) {
      c.amount[r] = Eigen::VectorXd::Zero(n);
      c.amount[r].segment(s.first, s.end - s.first).setOnes();
    }
  }
  c.rows = s.rows;
  return c;
}

void StatementEvidence::scale(Chosen& c, const Scored& s, const Eigen::VectorXd& size) const {
  Eigen::Index at = 0;
  for (Eigen::VectorXd& amount : c.amount) {
    if (amount.size() == 0) continue;
    if (s.when == When::kUnknown || s.when == When::kUnknownInAll) {
      const Eigen::MatrixXd w = walk(amount.size());
      amount = w * size.segment(at, w.cols());
      at += w.cols();
    } else {
      amount *= size[0];
    }
  }
}

std::vector<StatedWindow> StatementEvidence::windows_of(const Chosen& chosen) const {
  std::vector<StatedWindow> windows;
  const auto& runs = space_.cells[chosen.index].runs;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const Eigen::VectorXd& amount = chosen.amount[r];
    const std::vector<double>& edge_s = runs[r].edge_s;
    for (Eigen::Index from = 0, end = 0; from < amount.size(); from = end + 1) {
      for (end = from; end < amount.size() && amount[end] != 0.0;) ++end;
      if (end == from) continue;
      const auto first = static_cast<std::size_t>(from), last = static_cast<std::size_t>(end);
      windows.push_back({r, edge_s[first], edge_s[last], edge_s[first + 1] - edge_s[first]});
      if (chosen.rows && chosen.rows->run == r) {
        const std::vector<double>& time_s = space_.time_s(r);
        windows.back().begin_s = time_s[static_cast<std::size_t>(chosen.rows->first)];
        windows.back().end_s = time_s[std::min(time_s.size() - 1, static_cast<std::size_t>(chosen.rows->end))];
      }
    }
  }
  return windows;
}

Statement StatementEvidence::said(const Scored& s) const {
  const Chosen c = chosen(s);
  Statement says = c.is_cells ? space_.cells[c.index].says : space_.columns[c.index].says;
  for (const Eigen::VectorXd& amount : c.amount)
    says.in_run.push_back(amount.size() > 0 && amount.cwiseAbs().maxCoeff() > 0.0);
  says.record = space_.record;
  if (!c.is_cells) return says;
  const std::string of = says.law.empty() ? "" : says.law + ", ";
  says.follows = "window";
  says.windows = windows_of(c);
  switch (s.when) {
    case When::kWindow:
      says.law =
          of + fmt::format("{:.4g} to {:.4g} min", says.windows.front().begin_s / 60.0, says.windows.front().end_s / 60.0);
      break;
    case When::kLasting:
    case When::kLastingOn:
      says.law = of + fmt::format("from {:.4g} min on", says.windows.front().begin_s / 60.0);
      break;
    case When::kWindows:
      says.law = of + fmt::format("{} windows", s.n_windows);
      break;
    default:
      says.windows.clear();
      says.follows = "unknown";
      says.law = of + "any course";
  }
  return says;
}

Eigen::Index StatementEvidence::n_pieces_of(const Scored& s) const {
  Eigen::Index n = 0;
  const auto& runs = space_.cells[s.of - space_.columns.size()].runs;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    if (s.when == When::kUnknownInAll || r == s.run) n += diagnosis::n_pieces_of(runs[r].of_cell.cols());
  }
  return n;
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
