#pragma once
// A law of the catalogue as a table that C can look up: whatever its formula, over each variable of the drive on its own.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/cyclogram.hpp"

namespace driftwright::output {

/// Variables of the drive, in the units that an importer sees.
enum class DriveVariable { kSpeed, kFeedX, kFeedY, kFeedZ, kCuttingPower };
inline constexpr int kDriveVariables = 5;
/// rpm, mm/min, W. And the drive with one more of it.
[[nodiscard]] double value_of(DriveVariable variable, const Drive& drive);
void set_value(DriveVariable variable, Drive& drive, double value);

/// What the law is beyond its value at rest, over one variable x: a polynomial of log x in Chebyshev's form in each piece; below the first piece
/// what it is at its beginning.
struct LawTerm {
  int variable = 0;                       ///< index in the list that the law was tabulated over
  std::vector<double> log_x = {};         ///< ends of the pieces
  std::vector<double> coefficients = {};  ///< kLawDegree + 1 of each piece
};
inline constexpr int kLawDegree = 15;

struct DriveLaw {
  double at_rest = 0.0;
  std::vector<LawTerm> terms = {};  ///< none: a constant
  /// With x as the list that it was tabulated over.
  [[nodiscard]] double at(const std::vector<double>& x) const;
};

/// A variable of the drive and the largest value that it is asked for, > 0.
struct DriveRange {
  DriveVariable variable = DriveVariable::kSpeed;
  double most = 0.0;
};

/// Tabulates a law that is a sum of functions of one variable each. Pieces are halved until the polynomial keeps to the law within 1e-13 of what the
/// law is at most in the piece or at rest, or are 1e-9 wide in log x: around a kink or a jump, where the law is what it is at the piece's end. The first begins at 1e-6 of the largest value.
/// @param law   finite for drives up to the largest values
/// @returns nothing where two variables act together, or the law is too rough for some two thousand pieces
[[nodiscard]] std::optional<DriveLaw> tabulated(const std::function<double(const Drive&)>& law,
                                                const std::vector<DriveRange>& ranges);

}  // namespace driftwright::output
