#include "solver/model_factors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace driftwright::solver {
namespace {

double at(const std::vector<double>& factor, std::size_t i) {
  return factor.empty() ? 1.0 : factor[i];
}

bool are_ones(const std::vector<double>& factor) {
  return std::all_of(factor.begin(), factor.end(), [](double f) { return f == 1.0; });
}

void check_number(std::size_t n_factors, std::size_t n, const char* what) {
  if (n_factors != 0 && n_factors != n)
    throw std::logic_error(fmt::format("with_factors: {} factors for {} {}", n_factors, n, what));
}

template <class Matrix>
void check(const ThermalSystem<Matrix>& s, const ModelFactors& f) {
  check_number(f.source.size(), s.sources.size(), "heat sources");
  check_number(f.exchange.size(), s.exchanges.size(), "films, joints and links");
  check_number(f.conductivity.size(), s.parts.size(), "parts that conduct");
  check_number(f.heat_capacity.size(), s.parts.size(), "parts that store heat");
  check_number(f.output.size(), s.outputs.name.size(), "outputs");
  if (f.expansion.size() > 0) {
    check_number(static_cast<std::size_t>(f.expansion.rows()), s.parts.size(), "parts that expand");
    check_number(static_cast<std::size_t>(f.expansion.cols()), s.outputs.name.size(), "outputs of an expansion");
  }
  const bool varies = std::any_of(s.nonlinear.begin(), s.nonlinear.end(), [](const auto& term) { return !term->is_flow(); });
  if (varies && !(f.conduction == 1.0 && are_ones(f.conductivity)))
    throw std::logic_error("with_factors: a factor on conduction does not reach a conductivity that varies");
  if (s.capacity && !are_ones(f.heat_capacity))
    throw std::logic_error("with_factors: a factor on heat capacity does not reach one that varies");
  if (!s.nonlinear.empty() && f.rate != 1.0)
    throw std::logic_error("with_factors: a factor on all rates does not reach nonlinear terms");
}

template <class Matrix>
void scale(Exchange<Matrix>& exchange, double factor) {
  exchange.matrix *= factor;
  exchange.to_ambient *= factor;
  exchange.flow *= factor;
  exchange.offset *= factor;
  exchange.ambient_sum *= factor;
  exchange.offset_sum *= factor;
}

}  // namespace

template <class Matrix>
void scale_matrices(Matrix& conduction, Matrix& mass, const std::vector<BodyPart<Matrix>>& parts,
                    const std::vector<double>& conductivity, const std::vector<double>& heat_capacity) {
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const double k = at(conductivity, p), m = at(heat_capacity, p);
    if (k != 1.0) conduction += (k - 1.0) * parts[p].conduction;
    if (m != 1.0) mass += (m - 1.0) * parts[p].mass;
  }
}

template <class Matrix>
void scale_expansion(Eigen::MatrixXd& outputs, const std::vector<BodyPart<Matrix>>& parts,
                     const Eigen::MatrixXd& expansion) {
  if (expansion.size() == 0) return;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    for (Eigen::Index o = 0; o < parts[p].outputs.cols(); ++o) {
      const double x = expansion(static_cast<Eigen::Index>(p), o);
      if (x != 1.0) outputs.col(o) += (x - 1.0) * parts[p].outputs.col(o);
    }
  }
}

template <class Matrix>
ThermalSystem<Matrix> with_factors(ThermalSystem<Matrix> system, const ModelFactors& factors) {
  check(system, factors);
  // `rate` is applied last and separately, because fits print digits that depend on the last bit
  for (std::size_t s = 0; s < system.sources.size(); ++s) (system.sources[s].load *= at(factors.source, s)) *= factors.rate;
  for (std::size_t e = 0; e < system.exchanges.size(); ++e) {
    scale(system.exchanges[e], at(factors.exchange, e));
    scale(system.exchanges[e], factors.rate);
  }
  scale_matrices(system.conduction, system.mass, system.parts, factors.conductivity, factors.heat_capacity);
  scale_expansion(system.outputs.state, system.parts, factors.expansion);
  for (std::size_t p = 0; p < system.parts.size(); ++p) {  // they remain the terms of the sums
    BodyPart<Matrix>& part = system.parts[p];
    part.conduction *= at(factors.conductivity, p) * factors.conduction * factors.rate;
    part.mass *= at(factors.heat_capacity, p);
    for (Eigen::Index o = 0; o < part.outputs.cols(); ++o) {
      const double expansion = factors.expansion.size() > 0 ? factors.expansion(static_cast<Eigen::Index>(p), o) : 1.0;
      part.outputs.col(o) *= expansion * at(factors.output, static_cast<std::size_t>(o));
    }
  }
  (system.conduction *= factors.conduction) *= factors.rate;
  for (std::size_t o = 0; o < factors.output.size(); ++o) {
    system.outputs.state.col(static_cast<Eigen::Index>(o)) *= factors.output[o];
    system.outputs.ambient[static_cast<Eigen::Index>(o)] *= factors.output[o];
  }
  return system;
}

template <class Matrix>
std::vector<std::string> flow_names(const ThermalSystem<Matrix>& system) {
  std::vector<std::string> names;
  for (const HeatSource& s : system.sources) names.push_back(s.name);
  for (const auto& e : system.exchanges) names.push_back(e.name);
  return names;
}

template <class Matrix>
ModelFactors flow_factors(const ThermalSystem<Matrix>& system, std::span<const double> factor) {
  const std::size_t n_sources = system.sources.size(), n = n_sources + system.exchanges.size();
  if (factor.size() != n) throw std::logic_error(fmt::format("flow_factors: {} factors for {} flows", factor.size(), n));
  return {.source = {factor.begin(), factor.begin() + static_cast<std::ptrdiff_t>(n_sources)},
          .exchange = {factor.begin() + static_cast<std::ptrdiff_t>(n_sources), factor.end()}};
}

template void scale_matrices(SparseRow&, SparseRow&, const std::vector<BodyPart<SparseRow>>&, const std::vector<double>&,
                             const std::vector<double>&);
template void scale_matrices(Eigen::MatrixXd&, Eigen::MatrixXd&, const std::vector<BodyPart<Eigen::MatrixXd>>&,
                             const std::vector<double>&, const std::vector<double>&);
template void scale_expansion(Eigen::MatrixXd&, const std::vector<BodyPart<SparseRow>>&, const Eigen::MatrixXd&);
template void scale_expansion(Eigen::MatrixXd&, const std::vector<BodyPart<Eigen::MatrixXd>>&, const Eigen::MatrixXd&);
template FullSystem with_factors(FullSystem, const ModelFactors&);
template ReducedSystem with_factors(ReducedSystem, const ModelFactors&);
template std::vector<std::string> flow_names(const FullSystem&);
template std::vector<std::string> flow_names(const ReducedSystem&);
template ModelFactors flow_factors(const FullSystem&, std::span<const double>);
template ModelFactors flow_factors(const ReducedSystem&, std::span<const double>);

}  // namespace driftwright::solver
