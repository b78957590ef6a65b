#include "solver/stiffness_factor.hpp"

#include <cholmod.h>
#include <fmt/format.h>

#include <algorithm>

#include "base/c_random.hpp"
#include "base/errors.hpp"
#include "solver/one_thread.hpp"

namespace driftwright::solver {
namespace {

using Index = SuiteSparse_long;

/// Allocates a symmetric matrix stored by its lower triangle.
cholmod_sparse* lower_triangle(std::size_t n, std::size_t n_entries, int kind, cholmod_common& common) {
  cholmod_sparse* a = cholmod_l_allocate_sparse(n, n, n_entries, 1, 1, -1, kind, &common);
  if (!a) throw SolveError(fmt::format("not enough memory for {} elastic unknowns; take a coarser mesh", n));
  return a;
}

}  // namespace

struct StiffnessFactor::Parts {
  cholmod_common common;
  cholmod_sparse* k = nullptr;
  cholmod_factor* factor = nullptr;

  Parts() {
    cholmod_l_start(&common);
    common.print = 0;
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.final_ll = 1;
  }
  Parts(const Parts&) = delete;
  ~Parts() {
    cholmod_l_free_sparse(&k, &common);
    cholmod_l_free_factor(&factor, &common);
    cholmod_l_finish(&common);
  }

  /// Lower triangle of a pattern.
  cholmod_sparse* graph_of(const BlockPattern& nodes) {
    cholmod_sparse* graph = lower_triangle(nodes.n_rows, nodes.column.size() / 2 + nodes.n_rows, CHOLMOD_PATTERN, common);
    auto* start = static_cast<Index*>(graph->p);
    auto* row = static_cast<Index*>(graph->i);
    Index slot = 0;
    for (int i = 0; i < nodes.n_rows; ++i) {
      start[i] = slot;
      for (int at = nodes.start[i]; at < nodes.start[i + 1]; ++at) {
        if (nodes.column[at] >= i) row[slot++] = nodes.column[at];
      }
    }
    start[nodes.n_rows] = slot;
    return graph;
  }

  /// METIS's order of the nodes.
  std::vector<Index> order_of_nodes(const BlockPattern& nodes) {
    cholmod_sparse* graph = graph_of(nodes);
    std::vector<Index> order(nodes.n_rows);
    const bool ordered = [&] {
      const auto alone = alone_with_c_random();
      return cholmod_l_metis(graph, nullptr, 0, 1, order.data(), &common) != 0;
    }();
    cholmod_l_free_sparse(&graph, &common);
    if (!ordered) throw SolveError("METIS found no order for the elastic stiffness: not enough memory; take a coarser mesh");
    return order;
  }
};

FactorSize factor_size(const BlockPattern& nodes, int n_unknowns) {
  StiffnessFactor::Parts p;
  std::vector<Index> order = p.order_of_nodes(nodes);
  cholmod_sparse* graph = p.graph_of(nodes);
  p.common.nmethods = 1;
  p.common.method[0].ordering = CHOLMOD_GIVEN;
  p.common.postorder = 1;
  for (std::size_t& columns : p.common.nrelax)
    columns = std::max<std::size_t>(1, columns / static_cast<std::size_t>(n_unknowns));
  p.factor = cholmod_l_analyze_p(graph, order.data(), nullptr, 0, &p.common);
  cholmod_l_free_sparse(&graph, &p.common);
  if (!p.factor) throw SolveError(fmt::format("not enough memory for {} nodes; take a coarser mesh", nodes.n_rows));
  const double u = n_unknowns;
  const auto count = [](std::size_t n) { return static_cast<double>(n); };
  return {8.0 * (u * u * count(p.factor->xsize) + u * count(p.factor->ssize)), 8.0 * u * u * count(p.factor->maxcsize),
          u * u * u * p.common.fl};
}

StiffnessFactor::StiffnessFactor(const NodeMatrix& a) : parts_(std::make_unique<Parts>()) {
  Parts& p = *parts_;
  const std::vector<Index> of_nodes = p.order_of_nodes(a);
  std::vector<Index> order(3 * of_nodes.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = 3 * of_nodes[i / 3] + static_cast<Index>(i % 3);

  p.k = lower_triangle(order.size(), a.value.size() / 2 + 3 * order.size(), CHOLMOD_REAL, p.common);
  auto* start = static_cast<Index*>(p.k->p);
  auto* row = static_cast<Index*>(p.k->i);
  auto* value = static_cast<double*>(p.k->x);
  Index slot = 0;
  for (int i = 0; i < a.n_rows; ++i) {
    for (int c = 0; c < 3; ++c) {
      const Index column = 3 * static_cast<Index>(i) + c;
      start[column] = slot;
      for (int k = a.start[i]; k < a.start[i + 1]; ++k) {
        for (int r = 0; r < 3; ++r) {
          const Index at = 3 * static_cast<Index>(a.column[k]) + r;
          const double entry = a.block(k)(c, r);  // that of (at, column) by symmetry
          if (at < column || entry == 0.0) continue;
          row[slot] = at;
          value[slot++] = entry;
        }
      }
    }
  }
  start[order.size()] = slot;
  p.common.nmethods = 1;
  p.common.method[0].ordering = CHOLMOD_GIVEN;
  p.common.postorder = 1;
  p.factor = cholmod_l_analyze_p(p.k, order.data(), nullptr, 0, &p.common);
  if (!p.factor)
    throw SolveError(fmt::format("not enough memory for {} elastic unknowns; take a coarser mesh", order.size()));
}
StiffnessFactor::~StiffnessFactor() = default;

double StiffnessFactor::predicted_bytes() const {
  return 8.0 * static_cast<double>(parts_->factor->xsize + parts_->factor->ssize + parts_->factor->maxcsize);
}

void StiffnessFactor::factorise() {
  Parts& p = *parts_;
  const OneThread serial;
  const bool done = cholmod_l_factorize(p.k, p.factor, &p.common) != 0;
  if (p.common.status == CHOLMOD_OUT_OF_MEMORY || p.common.status == CHOLMOD_TOO_LARGE) {
    throw SolveError(fmt::format("not enough memory to factorise {} elastic unknowns; take a coarser mesh", p.k->nrow));
  }
  if (!done || p.common.status == CHOLMOD_NOT_POSDEF) {
    throw SolveError(
        "the elastic stiffness has no Cholesky factor: springs or materials of too different stiffness, or cells without "
        "volume");
  }
  cholmod_l_free_sparse(&p.k, &p.common);
}

Eigen::VectorXd StiffnessFactor::solve(const Eigen::VectorXd& force) const {
  Parts& p = *parts_;
  Eigen::VectorXd copy = force;  // CHOLMOD does not accept a pointer to const
  const auto n = static_cast<std::size_t>(copy.size());
  cholmod_dense b{n, 1, n, n, copy.data(), nullptr, CHOLMOD_REAL, CHOLMOD_DOUBLE};
  const OneThread serial;
  cholmod_dense* u = cholmod_l_solve(CHOLMOD_A, p.factor, &b, &p.common);
  if (!u) throw SolveError("not enough memory for an elastic solve");
  const Eigen::VectorXd result = Eigen::Map<const Eigen::VectorXd>(static_cast<const double*>(u->x), copy.size());
  cholmod_l_free_dense(&u, &p.common);
  return result;
}

}  // namespace driftwright::solver
