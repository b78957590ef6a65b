#pragma once
// Order of convergence, extrapolated value and estimated error of a number that was computed on three meshes.

#include <array>

namespace driftwright::studies {

enum class Convergence {
  kMonotone,     ///< changes have one sign and shrink: the order is positive
  kOscillating,  ///< the two changes have opposite signs
  kGrowing,      ///< changes have one sign and do not shrink: the meshes are too coarse for an order
  kUnresolved,   ///< all three values are equal within the error of the model itself
};

/// What three meshes say of one number. Index 0: coarsest, 2: finest.
struct GridConvergence {
  Convergence kind = Convergence::kUnresolved;
  double order = 0.0;         ///< observed order p [-]; NaN if there is none, for example of an oscillation
  double used_order = 0.0;    ///< p within its limits; NaN without `order`, except for kGrowing: the lower limit
  double extrapolated = 0.0;  ///< estimate for an element size of zero; NaN except for kMonotone
  std::array<double, 3> error =
      {};  ///< estimated error of each value, >= 0; that of the finest is the GCI times its value if p is within its limits
};

inline constexpr double kSafetyFactor = 1.25;  ///< of an error estimated from three meshes (Roache 1994)
inline constexpr double kLeastOrder = 0.5;     ///< a smaller observed order counts as this one (Oberkampf & Roy 2010)

/// Extrapolates to an element size of zero (Richardson). With h1 < h2 < h3, f = f0 + c h^p and r21 = h2 / h1, r32 = h3 / h2:
///
///     (f3 - f2) / (f2 - f1) = r21^p (r32^p - 1) / (r21^p - 1)      gives p, uniquely: the right side grows with p
///     f0 = f1 - (f2 - f1) / (r21^p - 1)                           with p limited to 0.5 ... theoretical order
///     error of f_k = 1.25 |c| h_k^p                               for k = 1 this is GCI |f1|
///
/// Both changes give the same |c| if p is within its limits. Otherwise the larger one counts: an order above the theoretical
/// one means that the two finer meshes agree by chance, and their change alone would promise too much.
/// The error of an oscillation is 1.25 times the range of the three values: the limit is expected within it, and each value
/// may be at an end of it. Changes that grow give no f0; their error is that of the order 0.5.
/// @param values          on the meshes from coarse to fine
/// @param sizes           element sizes, strictly decreasing, > 0, in any unit
/// @param highest_order   order in theory of this number for these elements, > 0.5
/// @param resolution      error of the model itself >= 0, in the unit of the values; a smaller range says nothing of the
///                        mesh
/// @throws std::logic_error  for sizes that do not decrease
/// Source: Roache, J. Fluids Eng. 116 (1994) 405-413; procedure: Celik et al., J. Fluids Eng. 130 (2008) 078001; limits of
/// p: Oberkampf & Roy, Verification and Validation in Scientific Computing, Cambridge 2010, section 8.7.
[[nodiscard]] GridConvergence grid_convergence(const std::array<double, 3>& values, const std::array<double, 3>& sizes,
                                               double highest_order, double resolution);

}  // namespace driftwright::studies
