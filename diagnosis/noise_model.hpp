#pragma once
// The noise of a channel: a white part, and a part correlated over some minutes, AR(1). Estimated from changes faster
// than any machine's.

#include <Eigen/Core>
#include <vector>

namespace driftwright::diagnosis {

struct NoiseModel {
  double white = 1.0;       ///< standard deviation, including quantisation
  double correlated = 0.0;  ///< standard deviation of the AR(1) part
  double time_s = 0.0;      ///< its time constant
  [[nodiscard]] double total() const;
};

/// Marks the values of a series that are readings: those that are not NaN.
[[nodiscard]] std::vector<char> present(const Eigen::VectorXd& series);

/// The linear map that turns this noise, sampled at these times, into independent noise of variance 1: innovations of a
/// Kalman filter.
/// Source: Durbin & Koopman, Time Series Analysis by State Space Methods, 2nd ed. (2012), ch. 4.
class Whitener {
 public:
  /// @param is_there  marks the times with a reading
  Whitener(const NoiseModel& noise, const std::vector<double>& time_s, const std::vector<char>& is_there);
  [[nodiscard]] Eigen::Index n() const { return static_cast<Eigen::Index>(rows_.size()); }
  /// @param series  one value per time; those without a reading are ignored. @param out  n() values
  void apply(const Eigen::Ref<const Eigen::VectorXd>& series, Eigen::Ref<Eigen::VectorXd> out) const;
  [[nodiscard]] double log_determinant() const { return log_determinant_; }  ///< of the covariance
  /// The filter's numbers, n() each: estimate = carry estimate; innovation = reading - estimate; estimate += gain
  /// innovation; scale innovation is the whitened reading.
  [[nodiscard]] const std::vector<double>& carry() const { return carry_; }
  [[nodiscard]] const std::vector<double>& gain() const { return gain_; }
  [[nodiscard]] const std::vector<double>& scale() const { return scale_; }

 private:
  std::vector<Eigen::Index> rows_;
  std::vector<double> carry_, gain_, scale_;
  double log_determinant_ = 0.0;
};

/// One series of a channel in one record, and smooth curves that are not part of the noise.
struct NoiseSeries {
  std::vector<double> time_s;
  Eigen::VectorXd residual;  ///< measured - model; NaN where missing
  Eigen::MatrixXd smooth;    ///< one column per curve
};

/// Restricted maximum likelihood of one noise for several series with free amplitudes of their smooth curves.
/// @param floor  least standard deviation of the white part
/// Source: Patterson & Thompson, Biometrika 58 (1971) 545-554.
[[nodiscard]] NoiseModel estimate_noise(const std::vector<NoiseSeries>& series, double floor);

/// Curves that a machine can follow, but noise hardly does: cosines down to a period of 40 min, and the drive's values
/// after lags of 0, 3 and 12 min, each as it is and squared.
/// @param drive  per time, 0 to about 1
[[nodiscard]] Eigen::MatrixXd smooth_curves(const std::vector<double>& time_s, const Eigen::VectorXd& drive);

/// As many of these curves as the number of readings can separate from noise, the slowest first.
[[nodiscard]] Eigen::MatrixXd telling(const Eigen::MatrixXd& curves, Eigen::Index n_readings);

}  // namespace driftwright::diagnosis
