#pragma once
// Factors on the parts of a thermal system. All code that needs a machine with another film, material or sensitivity forms
// it here, so that the same factor always means the same machine.

#include <span>
#include <string>
#include <vector>

#include "solver/thermal_system.hpp"

namespace driftwright::solver {

/// The factor on each part of a system [-]. An empty list means ones.
struct ModelFactors {
  std::vector<double> source = {};         ///< per heat source
  std::vector<double> exchange = {};       ///< per film, joint and link, including their stratified air
  std::vector<double> conductivity = {};   ///< per part (ThermalSystem::parts)
  std::vector<double> heat_capacity = {};  ///< per part
  /// Per part (row) and output (column): equal factors in a row mean another coefficient of expansion, a single entry means
  /// another sensitivity of one displacement. 0 x 0 means ones.
  Eigen::MatrixXd expansion = {};
  std::vector<double> output = {};  ///< per output, on the part from the state and the ambient; of thermometers usually 1
  double conduction = 1.0;          ///< on all conduction within bodies
  double rate = 1.0;                ///< on all rates of change: as a machine with 1/rate of the capacity
};

/// The system with factors a on sources, c on exchanges, k, m and x on parts, y on outputs, κ on conduction and ρ on rates:
///
///     K0 -> ρ κ [K0 + Σ_p (k_p - 1) K_p], b_s -> ρ a_s b_s, G_e, g_e, o_e -> ρ c_e (G_e, g_e, o_e), M -> M + Σ_p (m_p - 1)
///     M_p L_o -> y_o [L_o + Σ_p (x_po - 1) L_po], l_ambient,o -> y_o l_ambient,o
///
/// The parts are changed in the same way and remain the parts of M, K0 and the outputs, so successive factors act as their
/// product. ρ increases all flows and leaves M unchanged, so that a model with M = 1 keeps it; the heat flows that a run
/// reports are then ρ times the machine's. Factors m on capacities change M; with_unit_mass() makes it 1 again. Laws, probes
/// and thermostats stay. Factors of 1 change no bit.
/// @param factors  any finite numbers; the caller must ensure physical values, such as heat_capacity > 0 and rate > 0
/// @throws std::logic_error  for lists of a wrong length, and for factors that do not act on a matrix alone: `rate` if the
///                           system has nonlinear terms, conduction if conductivity varies, heat_capacity if that varies
template <class Matrix>
[[nodiscard]] ThermalSystem<Matrix> with_factors(ThermalSystem<Matrix> system, const ModelFactors& factors);

/// The material part of with_factors(), for code that keeps the rest: K0 += Σ_p (k_p - 1) K_p, M += Σ_p (m_p - 1) M_p.
/// @param conductivity, heat_capacity  per part; empty means ones
template <class Matrix>
void scale_matrices(Matrix& conduction, Matrix& mass, const std::vector<BodyPart<Matrix>>& parts,
                    const std::vector<double>& conductivity, const std::vector<double>& heat_capacity);
/// The expansion part: L_o += Σ_p (x_po - 1) L_po. @param outputs  n_unknowns x at least the outputs of the parts
template <class Matrix>
void scale_expansion(Eigen::MatrixXd& outputs, const std::vector<BodyPart<Matrix>>& parts, const Eigen::MatrixXd& expansion);

/// Names of a model's heat flows, in the order that studies use for their errors: heat sources, then films, joints and
/// links.
template <class Matrix>
[[nodiscard]] std::vector<std::string> flow_names(const ThermalSystem<Matrix>& system);

/// Factors on these flows alone. @param factor  one per flow, in the order of flow_names()
/// @throws std::logic_error  for a wrong number of factors
template <class Matrix>
[[nodiscard]] ModelFactors flow_factors(const ThermalSystem<Matrix>& system, std::span<const double> factor);

}  // namespace driftwright::solver
