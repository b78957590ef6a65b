// Evidence of a statement beside a set, and what was chosen with it. Statements in cells of time: statement_times.cpp.
#include "diagnosis/statement_evidence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/dense.hpp"
#include "base/parallel.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kSeen = 1e-6;  // squares of a direction of the nuisance above noise

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

/// The sum over widths is that of exp(q - q of the widest) / sqrt(1 + w² squares), q = along² / (2 (squares + 1 / w²)),
/// which takes one logarithm in all.
Eigen::ArrayXd StatementEvidence::mixed(const Eigen::ArrayXd& squares, const Eigen::ArrayXd& along) const {
  const double widest = *std::max_element(options_.widths.begin(), options_.widths.end());
  const Eigen::ArrayXd half = 0.5 * along.square(), most = half / (squares + 1.0 / (widest * widest));
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(squares.size());
  for (double w : options_.widths) sum += (half / (squares + 1.0 / (w * w)) - most).exp() / (1.0 + w * w * squares).sqrt();
  return most + (sum / static_cast<double>(options_.widths.size())).log();
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

}  // namespace driftwright::diagnosis
