#pragma once
// Grey relational analysis: ranks sensors by how similar their curves are to the drift. It uses no model.

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/record.hpp"

namespace driftwright::compensation {

/// How a series is made dimensionless. First used sample, mean and range are computed over all records
/// together.
enum class Image {
  kAutomatic,     ///< initial value where that is defined and does not depend on the unit, range otherwise
  kInitialValue,  ///< x' = x / x(1); all series start at 1
  kMeanValue,     ///< x' = x / mean(x)
  kRange          ///< x' = (x - min) / (max - min); all series fill [0, 1]
};

/// The quantity of a series that is ranked.
enum class Quantity {
  kAsRecorded,
  kRise  ///< minus its first value in each record: all series start at 0, and degC and K are the same
};

struct GreyOptions {
  double rho = 0.5;  ///< distinguishing coefficient [-], 0 < rho <= 1
  Image image = Image::kAutomatic;
  Quantity quantity = Quantity::kAsRecorded;
  /// A series that falls while the reference rises is as informative as one that rises. With `true`, the image of
  /// a candidate whose covariance with the reference is negative is mirrored: x' -> 1 - x' (range), x' -> 2 -
  /// x' (initial and mean value, whose images start at or scatter about 1). `false` is Deng's definition
  /// unchanged.
  bool reverse_falling = true;
};

struct RankedChannel {
  std::string name;
  std::optional<double> grade;     ///< Deng's grade [-] in (0, 1]; none where the channel has no image
  std::optional<double> absolute;  ///< absolute grade [-] of the same images
  std::optional<double> slope;     ///< slope grade [-] of the same images
  bool reversed = false;           ///< its image was mirrored
  std::string note;                ///< why there is no grade; else empty
};

struct Ranking {
  std::vector<RankedChannel> channels;  ///< by falling grade, equal ones in the given order, those without grade last
  Image image = Image::kRange;          ///< the one used, never kAutomatic
  std::string reason;                   ///< why that image, one sentence
  int n_samples = 0;                    ///< rows used
  int n_left_out = 0;                   ///< rows left out because a channel was missing in them
};

/// The dimensionless series that grades compare.
struct GreyImages {
  Eigen::MatrixXd reference;        ///< n_samples x 1
  Eigen::MatrixXd candidates;       ///< n_samples x n; zero where a candidate has no image
  std::vector<Eigen::Index> first;  ///< first row of each record, followed by n_samples
  std::vector<bool> reversed;
  std::vector<std::string> note;  ///< why a candidate has no image; else empty
  Image image = Image::kRange;
  std::string reason;
  int n_left_out = 0;
};
/// @throws  as rank_channels()
[[nodiscard]] GreyImages grey_images(std::span<const Record> records, const std::string& reference,
                                     const std::vector<std::string>& candidates, const GreyOptions& options = {});

/// Deng's grade of each column of `candidates` (n_samples x m) against `reference` (n_samples x 1); formula below.
[[nodiscard]] Eigen::VectorXd deng_grades(const Eigen::MatrixXd& reference, const Eigen::MatrixXd& candidates, double rho);

/// Absolute grade of grey incidence of each column: similarity of the areas under the series counted from their starts,
///
///     s = sum over records of the trapezoid sum of x'(k) - x'(1) over k, grade = (1 + |s0| + |si|) / (1 + |s0| + |si| + |si
///     - s0|)
///
/// The areas are divided by the number of samples, so that a record sampled twice as often has the same grade.
/// Source: Liu & Lin, Grey Systems: Theory and Applications (2010), section 5.3.
[[nodiscard]] Eigen::VectorXd absolute_grades(const GreyImages& images);

/// Slope grade of each column: similarity of the slopes D(k) = (n - 1) (x'(k+1) - x'(k)), per length of the series,
///
///     grade = mean_k (1 + |D0(k)|) / (1 + |D0(k)| + |D0(k) - Di(k)|)
///
/// Steps from one record to the next do not count. Readings in coarse steps have no meaningful slopes: their grades are
/// always low.
/// Source: Dang, Liu & Liu, Engineering Science 6 (2004) no. 3, 41-44.
[[nodiscard]] Eigen::VectorXd slope_grades(const GreyImages& images);

/// Grey relational grades of `candidates` against `reference` over the records laid end to end.
///
///     D_i(k)  = |x0'(k) - xi'(k)|
///     xi_i(k) = (min_i min_k D + rho max_i max_k D) / (D_i(k) + rho max_i max_k D)
///     grade_i = mean_k xi_i(k)
///
/// The two extremes run over all candidates that have an image, so a grade depends on the other candidates:
/// compare grades within one ranking only. If all images coincide (max D = 0) the grade is 1.
///
/// kAutomatic uses the initial-value image only if no series starts near 0 (|x(1)| < 5 % of its span:
/// division by almost nothing) and none is a temperature, in degC or in K. The zero of degC is arbitrary, so
/// the image would be different in K, and in K it is so flat (1.00 to 1.02) that the grade measures
/// nothing. The range image gives the same ranking in both units. In practice kAutomatic therefore means range wherever
/// temperatures are ranked.
///
/// A candidate that never changes has no grade. Neither has one whose first value or mean is 0 if the requested image
/// divides by it.
///
/// @param reference   channel name, such as the drift
/// @param candidates  channel names
/// @throws RangeError  when rho lies outside (0, 1]
/// @throws InputError  when there are no candidates, fewer than two complete rows, the reference never changes or has
///                     no image of the requested kind; and as complete_rows()
/// Source: Deng, J. Grey System 1 (1989) 1-24; used on thermal error by Chen & Wang (2013).
[[nodiscard]] Ranking rank_channels(std::span<const Record> records, const std::string& reference,
                                    const std::vector<std::string>& candidates, const GreyOptions& options = {});

/// Names of the n best channels that have a grade; fewer if fewer have one.
[[nodiscard]] std::vector<std::string> best(const Ranking& ranking, int n);

}  // namespace driftwright::compensation
