#include "solver/distributed/mpi_share.hpp"

#include <fmt/format.h>
#include <nvector/nvector_parallel.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string_view>

#include "base/errors.hpp"

namespace driftwright::solver {
namespace {

/// A number of a mesh's bytes.
unsigned long hash_of(const mesh::Mesh& mesh) {
  const auto of = [](const auto* data, std::size_t n) {
    return std::hash<std::string_view>()({reinterpret_cast<const char*>(data), n * sizeof(*data)});
  };
  return of(mesh.coords.data(), static_cast<std::size_t>(mesh.coords.size())) ^
         3 * of(mesh.cells.node.data(), mesh.cells.node.size()) ^ 5 * of(mesh.facets.node.data(), mesh.facets.node.size());
}

void require_same_mesh(MPI_Comm comm, const mesh::Mesh& mesh) {
  unsigned long ends[2] = {hash_of(mesh), 0};
  ends[1] = ~ends[0];
  MPI_Allreduce(MPI_IN_PLACE, ends, 2, MPI_UNSIGNED_LONG, MPI_MAX, comm);
  if (ends[0] == ~ends[1]) return;
  throw InputError("--distributed: the processes made different meshes; are files and libraries the same on all machines?");
}

}  // namespace

MpiShare::MpiShare(MPI_Comm comm, const mesh::Mesh& whole, const effects::HeatBalance& balance) : comm_(comm) {
  MPI_Comm_rank(comm, &rank_);
  MPI_Comm_size(comm, &size_);
  require_same_mesh(comm, whole);
  common_ = take_part(whole, divide(whole, balance, size_), rank_, size_, static_cast<int>(balance.nodes.size()), *this);
  std::vector<char> is_copied(static_cast<std::size_t>(n_unknowns()), 0);
  for (const CommonUnknowns& c : common_) {
    for (int i : c.unknown) is_copied[static_cast<std::size_t>(i)] = 1;
  }
  for (int i = 0; i < n_unknowns(); ++i) {
    if (!is_copied[static_cast<std::size_t>(i)]) continue;
    copied_.push_back(i);
    if (i < mesh.n_nodes()) ++n_copied_nodes_;
  }
  first_row_.assign(static_cast<std::size_t>(size_) + 1, 0);
  for (int part : holder) ++first_row_[static_cast<std::size_t>(part) + 1];
  std::partial_sum(first_row_.begin(), first_row_.end(), first_row_.begin());
  std::vector<int> next(first_row_.begin(), first_row_.end() - 1);
  node_of_row_.resize(holder.size());
  for (std::size_t node = 0; node < holder.size(); ++node) {
    row_of_node_.push_back(next[static_cast<std::size_t>(holder[node])]++);
    node_of_row_[static_cast<std::size_t>(row_of_node_.back())] = static_cast<int>(node);
  }
}

int MpiShare::row_of_unknown(int unknown) const {
  if (unknown >= mesh.n_nodes()) return first_row_[1] + unknown - mesh.n_nodes();
  const auto node = static_cast<std::size_t>(whole_node[static_cast<std::size_t>(unknown)]);
  return row_of_node_[node] + (holder[node] > 0 ? n_lumped : 0);
}

// Each process adds in the same order, so that all have the same bits and take the same decisions.
void MpiShare::sum(double* values, int n) const {
  std::vector<double> of_all(static_cast<std::size_t>(n * size_));
  MPI_Allgather(values, n, MPI_DOUBLE, of_all.data(), n, MPI_DOUBLE, comm_);
  for (int i = 0; i < n; ++i) {
    values[i] = 0.0;
    for (int r = 0; r < size_; ++r) values[i] += of_all[static_cast<std::size_t>(r * n + i)];
  }
}

double MpiShare::largest(double value) const {
  return sum_and_largest(0.0, value).second;
}

std::pair<double, double> MpiShare::sum_and_largest(double summed, double value) const {
  const double own[2] = {summed, std::isnan(value) ? std::numeric_limits<double>::infinity() : value};
  std::vector<double> of_all(2 * static_cast<std::size_t>(size_));
  MPI_Allgather(own, 2, MPI_DOUBLE, of_all.data(), 2, MPI_DOUBLE, comm_);
  std::pair<double, double> all = {0.0, own[1]};
  for (std::size_t r = 0; r < of_all.size(); r += 2) {
    all.first += of_all[r];
    all.second = std::max(all.second, of_all[r + 1]);
  }
  return all;
}

void MpiShare::add_copies(double* x, int width) const {
  const bool only_nodes = width > 1;
  const auto n_of = [&](const CommonUnknowns& c) { return only_nodes ? c.n_nodes : static_cast<int>(c.unknown.size()); };
  const int n_copied = only_nodes ? n_copied_nodes_ : static_cast<int>(copied_.size());
  std::size_t n_all = 0;
  for (const CommonUnknowns& c : common_) n_all += static_cast<std::size_t>(n_of(c) * width);
  sent_.resize(n_all);
  received_.resize(n_all);
  own_.resize(static_cast<std::size_t>(n_copied * width));
  std::vector<MPI_Request> requests(2 * common_.size());
  std::size_t at = 0;
  for (std::size_t k = 0; k < common_.size(); ++k) {
    const CommonUnknowns& c = common_[k];
    const int n = n_of(c) * width;
    for (int i = 0; i < n; ++i)
      sent_[at + static_cast<std::size_t>(i)] = x[c.unknown[static_cast<std::size_t>(i / width)] * width + i % width];
    MPI_Irecv(&received_[at], n, MPI_DOUBLE, c.part, 0, comm_, &requests[2 * k]);
    MPI_Isend(&sent_[at], n, MPI_DOUBLE, c.part, 0, comm_, &requests[2 * k + 1]);
    at += static_cast<std::size_t>(n);
  }
  for (int i = 0; i < n_copied * width; ++i) {
    double& value = x[copied_[static_cast<std::size_t>(i / width)] * width + i % width];
    own_[static_cast<std::size_t>(i)] = value;
    value = 0.0;
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  const auto add_own = [&] {
    for (int i = 0; i < n_copied * width; ++i)
      x[copied_[static_cast<std::size_t>(i / width)] * width + i % width] += own_[static_cast<std::size_t>(i)];
  };
  // In the order of the processes, on each of them: all copies are the same to the last bit.
  at = 0;
  bool is_added = false;
  for (const CommonUnknowns& c : common_) {
    if (!is_added && c.part > rank_) {
      add_own();
      is_added = true;
    }
    for (int i = 0; i < n_of(c) * width; ++i)
      x[c.unknown[static_cast<std::size_t>(i / width)] * width + i % width] += received_[at++];
  }
  if (!is_added) add_own();
}

void MpiShare::spread(double* x, int width) const {
  const int n = width > 1 ? mesh.n_nodes() : n_unknowns(), n_known = width > 1 ? n_held_nodes() : n_held;
  std::fill(x + static_cast<std::ptrdiff_t>(n_known) * width, x + static_cast<std::ptrdiff_t>(n) * width, 0.0);
  add_copies(x, width);
}

Eigen::VectorXd MpiShare::whole(const double* x, int width) const {
  const int n_after = width > 1 ? 0 : n_lumped;  // after the nodes of process 0
  std::vector<int> count(static_cast<std::size_t>(size_)), offset(count.size());
  for (std::size_t r = 0; r < count.size(); ++r) {
    count[r] = width * (first_row_[r + 1] - first_row_[r] + (r == 0 ? n_after : 0));
    offset[r] = width * (first_row_[r] + (r == 0 ? 0 : n_after));
  }
  const int n_all = n_whole_nodes + n_after;
  std::vector<double> rows(static_cast<std::size_t>(n_all * width));
  MPI_Allgatherv(x, count[static_cast<std::size_t>(rank_)], MPI_DOUBLE, rows.data(), count.data(), offset.data(), MPI_DOUBLE,
                 comm_);
  Eigen::VectorXd all(n_all * width);
  for (int node = 0; node < n_whole_nodes; ++node) {
    const int row = row_of_node(node) + (holder[static_cast<std::size_t>(node)] > 0 ? n_after : 0);
    for (int i = 0; i < width; ++i) all[node * width + i] = rows[static_cast<std::size_t>(row * width + i)];
  }
  for (int i = 0; i < n_after; ++i) all[n_whole_nodes + i] = rows[static_cast<std::size_t>(first_row_[1] + i)];
  return all;
}

_generic_N_Vector* MpiShare::new_vector(int length, _SUNContext* context) const {
  sunindextype all = length;
  MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_SUNINDEXTYPE, MPI_SUM, comm_);
  N_Vector v = N_VNew_Parallel(comm_, length, all, context);
  if (!v) throw std::bad_alloc();
  // What norms divide by: copies have no weight, so norms and steps are those of one process.
  NV_GLOBLENGTH_P(v) = n_whole_unknowns() + length - n_unknowns();
  return v;
}

}  // namespace driftwright::solver
