#include "solver/conduction_factor.hpp"

#include <fmt/format.h>

#include <Eigen/CholmodSupport>
#include <cmath>

#include "base/c_random.hpp"
#include "base/errors.hpp"
#include "solver/one_thread.hpp"

namespace driftwright::solver {

using ColumnMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, SuiteSparse_long>;

namespace {

/// A symmetric matrix stored by rows equals the same matrix stored by columns.
ColumnMatrix in_columns(const SparseRow& k) {
  return ColumnMatrix(Eigen::SparseMatrix<double, Eigen::ColMajor, int>(k.transpose()));
}

}  // namespace

void require_way_out(const SparseRow& k, const std::vector<char>& held) {
  // A factorisation alone does not show this: rounding makes the pivot of a set without a way out positive as often as not.
  const int n = static_cast<int>(k.rows());
  Cliques neighbours;
  for (int row = 0; row < n; ++row) {
    for (SparseRow::InnerIterator entry(k, row); entry; ++entry) {
      if (entry.col() > row && entry.value() != 0.0) neighbours.add(std::vector<int>{row, static_cast<int>(entry.col())});
    }
  }
  const std::vector<int> set_of = connected_sets(n, neighbours);
  constexpr double kRounding = 1e-11;  // of the diagonal; a film of 1e-6 W/(m^2 K) on steel is larger
  const Eigen::VectorXd sums = k * Eigen::VectorXd::Ones(n), diagonal = k.diagonal();
  std::vector<char> has_way_out(n, 0);
  for (int i = 0; i < n; ++i) {
    if (std::abs(sums[i]) > kRounding * diagonal[i] || (!held.empty() && held[i])) has_way_out[set_of[i]] = 1;
  }
  for (int i = 0; i < n; ++i) {
    if (!has_way_out[set_of[i]]) {
      throw SolveError(
          fmt::format("the heat conduction matrix is singular: the part with unknown {} has no film, joint or link through "
                      "which heat leaves",
                      i));
    }
  }
}

struct ConductionFactor::Parts {
  Eigen::CholmodSupernodalLLT<ColumnMatrix, Eigen::Lower> llt;
};

ConductionFactor::ConductionFactor(const SparseRow& k) : parts_(std::make_unique<Parts>()) {
  cholmod_common& settings = parts_->llt.cholmod();
  settings.print = 0;
  settings.nmethods = 1;
  settings.method[0].ordering = CHOLMOD_METIS;
  {
    const auto alone = alone_with_c_random();  // METIS
    parts_->llt.analyzePattern(in_columns(k));
  }
  refactor(k);
}

void ConductionFactor::refactor(const SparseRow& k) {
  const OneThread serial;
  parts_->llt.factorize(in_columns(k));
  if (parts_->llt.info() != Eigen::Success) {
    throw SolveError(
        "the heat conduction matrix cannot be factorised: some part has no film, joint or link through which heat leaves, "
        "temperatures fell below 0 K on the way, or memory ran out");
  }
}
ConductionFactor::~ConductionFactor() = default;

Eigen::MatrixXd ConductionFactor::solve(const Eigen::MatrixXd& b) const {
  const OneThread serial;
  return parts_->llt.solve(b);
}

}  // namespace driftwright::solver
