#include "solver/multigrid.hpp"

#include <Eigen/SparseCholesky>

#include "base/errors.hpp"
#include "solver/multigrid_level.hpp"

namespace driftwright::solver {
namespace {

constexpr int kCoarsestUnknowns = 600;  // factorising these costs less than a cycle on the finest level
constexpr double kStrong = 0.08;        // Vanek, Mandel & Brezina 1996; halved on each coarser level

template <class T, class From, int B>
BlockRows<T, B, B> in_precision(const BlockRows<From, B, B>& a) {
  BlockRows<T, B, B> copy;
  static_cast<BlockPattern&>(copy) = a;
  copy.value.resize(a.value.size());
#pragma omp parallel for schedule(static)
  for (std::size_t k = 0; k < a.value.size(); ++k) copy.value[k] = static_cast<T>(a.value[k]);
  return copy;
}

/// The data that the smoother of a level needs of its matrix.
template <class T, int B, int N>
DoubleBlocks<B> set_smoother(Level<T, B, N>& level, BlockRows<double, B, B>& a) {
  DoubleBlocks<B> inverse = invert_diagonal(a);
  level.inverse_diagonal.resize(inverse.size());
  for (std::size_t i = 0; i < inverse.size(); ++i) level.inverse_diagonal[i] = inverse[i].template cast<T>();
  level.largest_eigenvalue = largest_eigenvalue(a, inverse, level.cluster);
  return inverse;
}

template <class T, int B, int N>
BlockRows<double, N, N> galerkin(const BlockRows<double, B, B>& a, const Level<T, B, N>& level) {
  BlockRows<double, B, N> ap;
  ap.take(product_pattern(a, level.prolongator));
  multiply_into(a, level.prolongator, ap, false);
  BlockRows<double, N, N> coarse;
  coarse.take(product_pattern(level.restrictor, ap));
  multiply_into(level.restrictor, ap, coarse, true);
  return coarse;
}

template <class T, int B>
std::vector<char> without_neighbours(const BlockRows<T, B, B>& a) {
  std::vector<char> idle(a.n_rows, 1);
#pragma omp parallel for schedule(static)
  for (int i = 0; i < a.n_rows; ++i) {
    for (int k = a.start[i]; k < a.start[i + 1] && idle[i]; ++k) {
      if (a.column[k] != i && !a.block(k).isZero(0)) idle[i] = 0;
    }
  }
  return idle;
}

/// The transfer from a level to the next: aggregates, prolongator, near-null vectors of the next level.
/// @return  false when aggregation no longer makes the problem smaller
template <class T, int B, int N>
bool set_transfer(Level<T, B, N>& level, const BlockRows<double, B, B>& a, const DoubleBlocks<B>& inverse_diagonal,
                  const NearNull<B, N>& near_null, double threshold, NearNull<N, N>& coarse_near_null) {
  const BlockPattern strong = strong_pairs(a, squared_norms(a), threshold);
  const Aggregates aggregates = aggregate(strong, without_neighbours(a));
  if (aggregates.n == 0 || static_cast<long>(aggregates.n) * N > 0.7 * a.n_rows * B) return false;
  Tentative<B, N> tentative = tentative_prolongator(aggregates, near_null);
  level.prolongator =
      smoothed_prolongator(a, strong, aggregates, tentative, inverse_diagonal, 4.0 / 3.0 / level.largest_eigenvalue);
  level.restrictor = transposed(level.prolongator);
  coarse_near_null = std::move(tentative.coarse);
  return true;
}

template <int B, int N>
class Hierarchy {
 public:
  Hierarchy(BlockRows<double, B, B> a, const NearNull<B, N>& near_null, Cluster cluster) {
    fine_.cluster = std::move(cluster);
    DoubleBlocks<B> inverse = set_smoother(fine_, a);
    NearNull<N, N> coarse_near_null;
    if (!fits(a) && set_transfer(fine_, a, inverse, near_null, kStrong, coarse_near_null)) {
      BlockRows<double, N, N> next = galerkin(a, fine_);
      fine_.a = in_precision<float>(a);
      a = {};
      build_coarse(std::move(next), std::move(coarse_near_null));
    } else {
      fine_.a = in_precision<float>(a);
      factorise(a);
    }
  }

  void refresh(BlockRows<double, B, B> a) {
    set_smoother(fine_, a);
    fine_.a = in_precision<float>(a);
    if (fine_.prolongator.n_rows == 0) return factorise(a);
    BlockRows<double, N, N> next = galerkin(a, fine_);
    a = {};
    for (Level<double, N, N>& level : coarse_) {
      set_smoother(level, next);
      level.a = std::move(next);
      if (level.prolongator.n_rows == 0) {
        factorise(level.a);
      } else {
        next = galerkin(level.a, level);
      }
    }
  }

  void cycle(const double* r, double* z) const {
    const int n = fine_.a.n_rows * B;
    fine_.resize_vectors();
    for (const auto& level : coarse_) level.resize_vectors();
    for_each_index(n, n > kWorthThreadsRows, [&](int i) { fine_.b[i] = static_cast<float>(r[i]); });
    if (coarse_.empty()) {
      solve_coarsest(fine_);
    } else {
      descend(fine_, coarse_.front());
      coarse_cycle(0);
      ascend(fine_, coarse_.front());
    }
    for_each_index(n, n > kWorthThreadsRows, [&](int i) { z[i] = fine_.x[i]; });
  }

  [[nodiscard]] double operator_complexity() const {
    double sum = static_cast<double>(fine_.a.value.size());
    for (const auto& level : coarse_) sum += static_cast<double>(level.a.value.size());
    return sum / static_cast<double>(fine_.a.value.size());
  }

 private:
  template <int M>
  static bool fits(const BlockRows<double, M, M>& a) {
    return a.n_rows * M <= kCoarsestUnknowns;
  }

  void build_coarse(BlockRows<double, N, N> a, NearNull<N, N> near_null) {
    double threshold = kStrong;
    while (true) {
      threshold *= 0.5;
      coarse_.emplace_back();
      Level<double, N, N>& level = coarse_.back();
      const DoubleBlocks<N> inverse = set_smoother(level, a);
      level.a = std::move(a);
      NearNull<N, N> coarse_near_null;
      if (fits(level.a) || !set_transfer(level, level.a, inverse, near_null, threshold, coarse_near_null)) break;
      a = galerkin(level.a, level);
      near_null = std::move(coarse_near_null);
    }
    factorise(coarse_.back().a);
  }

  template <int M>
  void factorise(const BlockRows<double, M, M>& a) {
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < a.n_rows; ++i) {
      for (int k = a.start[i]; k < a.start[i + 1]; ++k) {
        for (int e = 0; e < M * M; ++e)
          entries.emplace_back(M * i + e % M, M * a.column[k] + e / M, a.block(k)(e % M, e / M));
      }
    }
    Eigen::SparseMatrix<double> sparse(a.n_rows * M, a.n_rows * M);
    sparse.setFromTriplets(entries.begin(), entries.end());
    factor_.compute(sparse);
    if (factor_.info() != Eigen::Success) throw SolveError("multigrid: the coarsest matrix is not positive definite");
  }

  template <class T, int B1, int N1>
  void solve_coarsest(const Level<T, B1, N1>& level) const {
    using Vector = Eigen::Matrix<T, Eigen::Dynamic, 1>;
    const Eigen::VectorXd b =
        Eigen::Map<const Vector>(level.b.data(), static_cast<Eigen::Index>(level.b.size())).template cast<double>();
    const Eigen::VectorXd x = factor_.solve(b);
    Eigen::Map<Vector>(level.x.data(), x.size()) = x.template cast<T>();
  }

  template <class T, int B1>
  void descend(const Level<T, B1, N>& level, const Level<double, N, N>& next) const {
    level.r = level.b;
    std::fill(level.x.begin(), level.x.end(), T{});
    smooth(level);
    set_residual(level);
    transfer<T>(level.restrictor, level.r.data(), next.b.data());
  }

  template <class T, int B1>
  void ascend(const Level<T, B1, N>& level, const Level<double, N, N>& next) const {
    transfer<T>(level.prolongator, next.x.data(), level.d.data());
    const int n = static_cast<int>(level.x.size());
    for_each_index(n, n > kWorthThreadsRows, [&](int i) { level.x[i] += level.d[i]; });
    set_residual(level);
    smooth(level);
  }

  void coarse_cycle(std::size_t l) const {
    if (l + 1 == coarse_.size()) return solve_coarsest(coarse_[l]);
    descend(coarse_[l], coarse_[l + 1]);
    coarse_cycle(l + 1);
    ascend(coarse_[l], coarse_[l + 1]);
  }

  Level<float, B, N> fine_;
  std::vector<Level<double, N, N>> coarse_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
};

BlockRows<double, 1, 1> nodes_of(const SparseRow& a) {
  BlockRows<double, 1, 1> nodes;
  const auto n = static_cast<int>(a.rows());
  nodes.take({n, n, {a.outerIndexPtr(), a.outerIndexPtr() + n + 1}, {a.innerIndexPtr(), a.innerIndexPtr() + a.nonZeros()}});
  std::copy(a.valuePtr(), a.valuePtr() + a.nonZeros(), nodes.value.begin());
  return nodes;
}

/// Translations along and rotations about x, y and z, without the fixed unknowns.
NearNull<3, 6> rigid_motions(const NodeMatrix& a, const Eigen::Matrix3Xd& coords) {
  const Eigen::Vector3d low = coords.rowwise().minCoeff(), high = coords.rowwise().maxCoeff();
  NearNull<3, 6> motions(a.n_rows);
#pragma omp parallel for schedule(static)
  for (int i = 0; i < a.n_rows; ++i) {
    const Eigen::Vector3d p = (coords.col(i) - 0.5 * (low + high)) / (high - low).norm();
    motions[i] << 1, 0, 0, 0, p[2], -p[1], 0, 1, 0, -p[2], 0, p[0], 0, 0, 1, p[1], -p[0], 0;
    Eigen::Vector3d coupling = Eigen::Vector3d::Zero();
    for (int k = a.start[i]; k < a.start[i + 1]; ++k) {
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) coupling[r] += a.column[k] == i && r == c ? 0.0 : std::abs(a.block(k)(r, c));
      }
    }
    for (int r = 0; r < 3; ++r) {
      if (coupling[r] == 0.0) motions[i].row(r).setZero();
    }
  }
  return motions;
}

Cluster cluster_of(const NodeMatrix& a, const std::vector<int>& nodes) {
  if (nodes.empty()) return {};
  std::vector<int> position(a.n_rows, -1);
  for (std::size_t k = 0; k < nodes.size(); ++k) position[nodes[k]] = static_cast<int>(k);
  const auto n = static_cast<int>(nodes.size());
  BlockPattern pattern{n, n, {0}, {}};
  std::vector<int> source;
  for (int node : nodes) {
    for (int k = a.start[node]; k < a.start[node + 1]; ++k) {
      if (position[a.column[k]] < 0) continue;
      pattern.column.push_back(position[a.column[k]]);
      source.push_back(k);
    }
    pattern.start.push_back(static_cast<int>(source.size()));
  }
  NodeMatrix between;
  between.take(std::move(pattern));
  for (int k = 0; k < static_cast<int>(source.size()); ++k) between.block(k) = a.block(source[k]);
  Cluster cluster{nodes, std::make_unique<StiffnessFactor>(between)};
  cluster.factor->factorise();
  return cluster;
}

}  // namespace

struct Multigrid::Parts {
  std::unique_ptr<Hierarchy<1, 1>> heat;
  std::unique_ptr<Hierarchy<3, 6>> elastic;
};

Multigrid::Multigrid(const SparseRow& a) : parts_(std::make_unique<Parts>()) {
  const NearNull<1, 1> constant(a.rows(), Eigen::Matrix<double, 1, 1>::Ones());
  parts_->heat = std::make_unique<Hierarchy<1, 1>>(nodes_of(a), constant, Cluster{});
}
Multigrid::Multigrid(const NodeMatrix& a, const Eigen::Matrix3Xd& coords, const std::vector<int>& stiff)
    : parts_(std::make_unique<Parts>()) {
  parts_->elastic = std::make_unique<Hierarchy<3, 6>>(a, rigid_motions(a, coords), cluster_of(a, stiff));
}
Multigrid::~Multigrid() = default;
Multigrid::Multigrid(Multigrid&&) noexcept = default;
Multigrid& Multigrid::operator=(Multigrid&&) noexcept = default;

void Multigrid::refresh(const SparseRow& a) {
  parts_->heat->refresh(nodes_of(a));
}

void Multigrid::precondition(const double* r, double* z) const {
  if (parts_->heat) {
    parts_->heat->cycle(r, z);
  } else {
    parts_->elastic->cycle(r, z);
  }
}

double Multigrid::operator_complexity() const {
  return parts_->heat ? parts_->heat->operator_complexity() : parts_->elastic->operator_complexity();
}

}  // namespace driftwright::solver
