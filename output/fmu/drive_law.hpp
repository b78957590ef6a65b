#pragma once
// Tabulates a law of the catalogue, whatever its formula, over each variable of the drive, so that C code can look it up.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/cyclogram.hpp"

namespace driftwright::output {

/// Variables of the drive, in the units of an importer; after them the recorded places of axes (effects::kPlaceNames).
enum class DriveVariable { kSpeed, kFeedX, kFeedY, kFeedZ, kCuttingPower };
inline constexpr int kDriveVariables = 5;
[[nodiscard]] inline bool is_place(DriveVariable v) {
  return static_cast<int>(v) >= kDriveVariables;
}
/// Index of a place in effects::kPlaceNames. @param v  is_place()
[[nodiscard]] inline std::size_t place_of(DriveVariable v) {
  return static_cast<std::size_t>(v) - kDriveVariables;
}
/// Reads and sets one variable of a drive, in rpm, mm/min, W or mm.
[[nodiscard]] double value_of(DriveVariable variable, const Drive& drive);
void set_value(DriveVariable variable, Drive& drive, double value);

/// The law minus its value at rest, over one variable x: in each piece a polynomial of log x in Chebyshev form; below the
/// first piece its value at the start of that piece.
struct LawTerm {
  int variable = 0;                       ///< index in the list that the law was tabulated over
  std::vector<double> log_x = {};         ///< ends of the pieces
  std::vector<double> coefficients = {};  ///< kLawDegree + 1 of each piece
};
inline constexpr int kLawDegree = 15;

struct DriveLaw {
  double at_rest = 0.0;
  std::vector<LawTerm> terms = {};  ///< none: a constant
  /// With x as the values of the variables in the list that it was tabulated over.
  [[nodiscard]] double at(const std::vector<double>& x) const;
};

/// A variable of the drive and its largest value, > 0; of a place its smallest value, too.
struct DriveRange {
  DriveVariable variable = DriveVariable::kSpeed;
  double most = 0.0, least = 0.0;
};

/// The variables that are above 0 in any section, with their largest values.
[[nodiscard]] std::vector<DriveRange> largest_drives(const std::vector<Cyclogram>& cyclograms);

/// Tabulates a law that is a sum of functions of one variable each. Pieces are halved until the polynomial is within
/// 1e-13 of the law's largest value in the piece or at rest, or until they are 1e-9 wide in log x: around a kink or a
/// jump, where the table has the law's value at the piece's end. The first piece begins at 1e-6 of the largest value.
/// @param law   finite for drives up to the largest values
/// @returns nothing if two variables act together, if a place acts, or if the law needs more than about two thousand pieces
[[nodiscard]] std::optional<DriveLaw> tabulated(const std::function<double(const Drive&)>& law,
                                                const std::vector<DriveRange>& ranges);

}  // namespace driftwright::output
