#include "solver/decomposition.hpp"

#include "base/dense.hpp"

namespace driftwright::solver {
namespace {

constexpr std::size_t kMostKept = 64;  // sections of a few usual cyclograms

}  // namespace

Decompositions::Decompositions(const ReducedSystem& system) : system_(system), unit_mass_(system.mass.isIdentity(1e-8)) {
  kept_.reserve(kMostKept);
  loads_.resize(system.size(), static_cast<Eigen::Index>(system.sources.size()));
  for (std::size_t s = 0; s < system.sources.size(); ++s) loads_.col(static_cast<Eigen::Index>(s)) = system.sources[s].load;
}

void Decompositions::add_flows(Decomposition& d) const {
  const Eigen::Index n_exchanges = d.coefficient.size();
  d.flows.resize(n_exchanges, system_.size());
  d.ambient_W_K.resize(n_exchanges);
  d.offset_W.resize(n_exchanges);
  for (Eigen::Index i = 0; i < n_exchanges; ++i) {
    const Exchange<Eigen::MatrixXd>& e = system_.exchanges[static_cast<std::size_t>(i)];
    d.flows.row(i) = d.coefficient[i] * e.flow.transpose();
    d.ambient_W_K[i] = d.coefficient[i] * e.ambient_sum;
    d.offset_W[i] = d.coefficient[i] * e.offset_sum;
  }
  d.flows = d.flows * d.vectors;
}

Decomposition& Decompositions::at(const Eigen::VectorXd& coefficient, bool with_flows) {
  for (Decomposition& d : kept_) {
    if (d.coefficient != coefficient) continue;
    if (with_flows && d.flows.size() == 0) add_flows(d);
    return d;
  }
  if (kept_.size() < kMostKept) {
    kept_.emplace_back();
    oldest_ = kept_.size() - 1;
  } else {
    oldest_ = (oldest_ + 1) % kMostKept;
  }
  Decomposition& d = kept_[oldest_];
  ++n_made_;
  d.coefficient = coefficient;
  d.decays = {};
  const auto n = static_cast<Eigen::Index>(system_.size()), n_exchanges = coefficient.size();
  Eigen::MatrixXd k = system_.conduction;
  Eigen::VectorXd to_ambient = Eigen::VectorXd::Zero(n), offset = to_ambient;
  d.flows.resize(0, 0);
  for (Eigen::Index i = 0; i < n_exchanges; ++i) {
    const Exchange<Eigen::MatrixXd>& e = system_.exchanges[static_cast<std::size_t>(i)];
    const double c = coefficient[i];
    if (c == 0.0) continue;
    k += c * e.matrix;
    to_ambient += c * e.to_ambient;
    if (e.offset.size() > 0) offset += c * e.offset;
  }
  if (unit_mass_) {
    const dense::SymmetricEigen eigen(k);
    d.lambda_1_s = eigen.eigenvalues();
    d.vectors = eigen.eigenvectors();
    d.to_modes = d.vectors.transpose();
  } else {
    const dense::GeneralizedSymmetricEigen eigen(k, system_.mass);
    d.lambda_1_s = eigen.eigenvalues();
    d.vectors = eigen.eigenvectors();
    d.to_modes.noalias() = d.vectors.transpose() * system_.mass;
  }
  d.outputs.noalias() = system_.outputs.state.transpose() * d.vectors;
  d.loads.noalias() = d.vectors.transpose() * loads_;
  d.to_ambient.noalias() = d.vectors.transpose() * to_ambient;
  d.offset.noalias() = d.vectors.transpose() * offset;
  if (with_flows) add_flows(d);
  d.stored_J_K.noalias() = system_.ones.transpose() * d.vectors;
  return d;
}

std::vector<HeatFlow> flows_of(const ReducedSystem& system) {
  std::vector<HeatFlow> flows;
  for (const HeatSource& s : system.sources) flows.push_back({s.name, FlowKind::kSource});
  for (const auto& e : system.exchanges) {
    flows.push_back({e.name, e.prescribes         ? FlowKind::kPrescribed
                             : e.leaves_machine() ? FlowKind::kSurrounding
                                                  : FlowKind::kInternal});
    flows.back().continues = !e.place.part.empty() && flows.size() > 1 && flows[flows.size() - 2].name == e.name;
  }
  return flows;
}

}  // namespace driftwright::solver
