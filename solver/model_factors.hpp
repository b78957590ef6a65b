#pragma once
// Factors on what a thermal system is made of. All who ask what a machine with another film, material or sensitivity would do form it
// here, so that the same factor means the same machine to all of them.

#include <span>
#include <string>
#include <vector>

#include "solver/thermal_system.hpp"

namespace driftwright::solver {

/// What each thing is multiplied by [-]. An empty list means ones.
struct ModelFactors {
  std::vector<double> source = {};         ///< per heat source
  std::vector<double> exchange = {};       ///< per film, joint and link, with the stratified air before it
  std::vector<double> conductivity = {};   ///< per part (ThermalSystem::parts)
  std::vector<double> heat_capacity = {};  ///< per part
  /// Per part (row) and output (column): a row of one factor is another coefficient of expansion, a single entry another sensitivity of
  /// one displacement. 0 x 0 means ones.
  Eigen::MatrixXd expansion = {};
  std::vector<double> output = {};  ///< per output, on what the state and the ambient give it; of thermometers usually 1
  double conduction = 1.0;          ///< on all conduction within bodies
  double rate = 1.0;                ///< on all rates of change: a machine of 1/rate of the capacity
};

/// The system with factors a on sources, c on exchanges, k, m and x on parts, y on outputs, κ on conduction and ρ on rates:
///
///     K0 -> ρ κ [K0 + Σ_p (k_p - 1) K_p],   b_s -> ρ a_s b_s,   G_e, g_e, o_e -> ρ c_e (G_e, g_e, o_e),   M -> M + Σ_p (m_p - 1) M_p
///     L_o -> y_o [L_o + Σ_p (x_po - 1) L_po],   l_ambient,o -> y_o l_ambient,o
///
/// The parts change alike and remain what M, K0 and outputs consist of: factors one after the other act as their product. ρ lets all flows
/// grow and leaves M alone, so that a model with M = 1 keeps it; the flows of heat that a run reports then are ρ times the machine's.
/// Factors m on capacities change M; with_unit_mass() makes it 1 again. Laws, probes and thermostats stay. Factors of 1 change no bit.
/// @param factors  any finite numbers; what is physical, such as heat_capacity > 0 and rate > 0, the caller knows
/// @throws std::logic_error  for lists of another length than what they are about; for what a matrix alone cannot say: `rate` where the
///                           system has nonlinear terms, conduction where conductivity varies, heat_capacity where that varies
template <class Matrix>
[[nodiscard]] ThermalSystem<Matrix> with_factors(ThermalSystem<Matrix> system, const ModelFactors& factors);

/// The part of it that is about materials, for those who keep what does not change: K0 += Σ_p (k_p - 1) K_p, M += Σ_p (m_p - 1) M_p.
/// @param conductivity, heat_capacity  per part; empty means ones
template <class Matrix>
void scale_matrices(Matrix& conduction, Matrix& mass, const std::vector<BodyPart<Matrix>>& parts,
                    const std::vector<double>& conductivity, const std::vector<double>& heat_capacity);
/// And about expansion: L_o += Σ_p (x_po - 1) L_po. @param outputs  n_unknowns x at least the outputs of the parts
template <class Matrix>
void scale_expansion(Eigen::MatrixXd& outputs, const std::vector<BodyPart<Matrix>>& parts, const Eigen::MatrixXd& expansion);

/// Names of a model's heat flows in the order in which studies count what it has wrong: heat sources, then films, joints and links.
template <class Matrix>
[[nodiscard]] std::vector<std::string> flow_names(const ThermalSystem<Matrix>& system);

/// Factors on these alone. @param factor  one each, in the order of flow_names()
/// @throws std::logic_error  for another number of them
template <class Matrix>
[[nodiscard]] ModelFactors flow_factors(const ThermalSystem<Matrix>& system, std::span<const double> factor);

}  // namespace driftwright::solver
