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
  exchange.to_hall *= factor;
  exchange.flow *= factor;
  exchange.offset *= factor;
  exchange.hall_sum *= factor;
  exchange.offset_sum *= factor;
}

}  // namespace

template <class Matrix>
ThermalSystem<Matrix> with_factors(ThermalSystem<Matrix> system, const ModelFactors& factors) {
  check(system, factors);
  // `rate` comes last and by itself: fits print digits that hang on the last bit
  for (std::size_t s = 0; s < system.sources.size(); ++s) (system.sources[s].load *= at(factors.source, s)) *= factors.rate;
  for (std::size_t e = 0; e < system.exchanges.size(); ++e) {
    scale(system.exchanges[e], at(factors.exchange, e));
    scale(system.exchanges[e], factors.rate);
  }
  for (std::size_t p = 0; p < system.parts.size(); ++p) {
    BodyPart<Matrix>& part = system.parts[p];
    const double conductivity = at(factors.conductivity, p), heat_capacity = at(factors.heat_capacity, p);
    if (conductivity != 1.0) system.conduction += (conductivity - 1.0) * part.conduction;
    if (heat_capacity != 1.0) system.mass += (heat_capacity - 1.0) * part.mass;
    part.conduction *= conductivity * factors.conduction * factors.rate;
    part.mass *= heat_capacity;
    for (Eigen::Index o = 0; o < part.outputs.cols(); ++o) {
      const double expansion = factors.expansion.size() > 0 ? factors.expansion(static_cast<Eigen::Index>(p), o) : 1.0;
      if (expansion != 1.0) system.outputs.state.col(o) += (expansion - 1.0) * part.outputs.col(o);
      part.outputs.col(o) *= expansion * at(factors.output, static_cast<std::size_t>(o));
    }
  }
  (system.conduction *= factors.conduction) *= factors.rate;
  for (std::size_t o = 0; o < factors.output.size(); ++o) {
    system.outputs.state.col(static_cast<Eigen::Index>(o)) *= factors.output[o];
    system.outputs.hall[static_cast<Eigen::Index>(o)] *= factors.output[o];
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

template FullSystem with_factors(FullSystem, const ModelFactors&);
template ReducedSystem with_factors(ReducedSystem, const ModelFactors&);
template std::vector<std::string> flow_names(const FullSystem&);
template std::vector<std::string> flow_names(const ReducedSystem&);
template ModelFactors flow_factors(const FullSystem&, std::span<const double>);
template ModelFactors flow_factors(const ReducedSystem&, std::span<const double>);

}  // namespace driftwright::solver
