#include "solver/decays.hpp"

#include <algorithm>
#include <cmath>

namespace driftwright::solver {
namespace {

constexpr double kNegligible = 36.75;  // e^-36.75 < 2^-53
constexpr double kSameTime = 1e-9;     // of an interval
constexpr Eigen::Index kFewest = 4;    // times for which a table is worth its columns

}  // namespace

Eigen::VectorXd SumsOfDecays::at(double t_s, const Eigen::VectorXd& decay) const {
  Eigen::VectorXd y = factors.col(1) + t_s * (factors.col(2) + t_s * factors.col(0));
  y.noalias() += factors.rightCols(decay.size()) * decay;
  return y;
}

SumsOfDecays SumsOfDecays::from(double by_s, const Eigen::VectorXd& decay) const {
  SumsOfDecays moved;
  moved.factors.resize(factors.rows(), factors.cols());
  moved.curve() = factors.col(0);
  moved.constant() = factors.col(1) + by_s * (factors.col(2) + by_s * factors.col(0));
  moved.slope() = factors.col(2) + 2.0 * by_s * factors.col(0);
  moved.factors.rightCols(decay.size()) = factors.rightCols(decay.size()) * decay.asDiagonal();
  return moved;
}

Eigen::Index Decays::n_columns() const {
  Eigen::Index most = 0;
  for (const Table& t : tables_) most = std::max(most, t.values.cols());
  return most;
}

const Decays::Table& Decays::require(const Eigen::VectorXd& lambda_1_s, double step_s, Eigen::Index n_columns) {
  const auto known = std::find_if(tables_.begin(), tables_.end(), [&](const Table& t) { return t.step_s == step_s; });
  if (known != tables_.end()) {
    std::rotate(known, known + 1, tables_.end());
    const Eigen::Index n_known = tables_.back().values.cols();
    if (n_columns <= n_known) return tables_.back();
    n_columns = std::max(n_columns, std::min(2 * n_known, kMostTimes + 1));
  } else if (tables_.size() < kMostTables) {
    tables_.emplace_back();
  } else {
    std::rotate(tables_.begin(), tables_.begin() + 1, tables_.end());
  }
  Table& t = tables_.back();
  t.step_s = step_s;
  const Eigen::Index n = lambda_1_s.size();
  t.values.setZero(SumsOfDecays::kPowers + n, n_columns);
  t.n_used.resize(static_cast<std::size_t>(n_columns));
  for (Eigen::Index j = 0; j < n_columns; ++j) {
    const auto of_j = static_cast<double>(j);
    t.values.col(j).head<SumsOfDecays::kPowers>() << of_j * of_j, 1.0, of_j;
    const double* const end = std::upper_bound(lambda_1_s.data(), lambda_1_s.data() + n, kNegligible / (of_j * step_s));
    const Eigen::Index n_modes = j == 0 ? n : end - lambda_1_s.data();
    t.n_used[static_cast<std::size_t>(j)] = SumsOfDecays::kPowers + n_modes;
    auto decay = t.values.col(j).segment(SumsOfDecays::kPowers, n_modes).array();
    if (j == 0) {
      decay = 1.0;
    } else if (j == 1) {
      decay = (-step_s * lambda_1_s.head(n_modes).array()).exp();
    } else {  // rounding grows with log2(j) alone
      decay = t.values.col(j / 2).segment(SumsOfDecays::kPowers, n_modes).array() *
              t.values.col(j - j / 2).segment(SumsOfDecays::kPowers, n_modes).array();
    }
  }
  return t;
}

void Decays::values(const SumsOfDecays& sums, const Eigen::VectorXd& lambda_1_s, std::span<const double> times_s,
                    double start_s, Eigen::Ref<Eigen::MatrixXd> out) {
  const auto decay = [&](double t_s) -> Eigen::VectorXd { return (-t_s * lambda_1_s.array()).exp(); };
  const auto n_times = static_cast<Eigen::Index>(times_s.size());
  const auto at = [&](Eigen::Index k) { return times_s[static_cast<std::size_t>(k)] - start_s; };
  for (Eigen::Index done = 0, end = 0; done < n_times; done = end) {
    const double first_s = at(done), step_s = done + 1 < n_times ? at(done + 1) - first_s : 0.0,
                 rounding_s = kSameTime * step_s;
    for (end = done + 1; end < n_times && end - done < kMostTimes; ++end) {
      if (std::abs(at(end) - first_s - static_cast<double>(end - done) * step_s) > rounding_s) break;
    }
    if (end - done < kFewest) {
      for (Eigen::Index k = done; k < end; ++k) out.col(k) = sums.at(at(k), decay(at(k)));
      continue;
    }
    const bool begins_at_step = std::abs(first_s - step_s) <= rounding_s;
    const Eigen::Index column = begins_at_step ? 1 : 0;  // of the first time
    const Table& t = require(lambda_1_s, step_s, column + end - done);
    SumsOfDecays scaled = begins_at_step || std::abs(first_s) <= rounding_s ? sums : sums.from(first_s, decay(first_s));
    const Eigen::Index skipped = scaled.curve().isZero(0.0) ? 1 : 0;
    scaled.curve() *= step_s * step_s;
    scaled.slope() *= step_s;
    const auto n_used = [&](Eigen::Index k) { return t.n_used[static_cast<std::size_t>(column + k - done)] - skipped; };
    for (Eigen::Index from = done, until = 0; from < end; from = until) {
      const Eigen::Index n = n_used(from);
      for (until = from + 1; until < end && 4 * n_used(until) >= 3 * n;) ++until;
      out.middleCols(from, until - from).noalias() =
          scaled.factors.middleCols(skipped, n) * t.values.block(skipped, column + from - done, n, until - from);
    }
  }
}

}  // namespace driftwright::solver
