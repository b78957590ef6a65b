#pragma once
// Heat over time from readings: which power in one body of a linear machine makes what the readings have beside a prediction.
//
//     M z' = -K(t) z + b u(t),   y = C z + noise,   u: a Wiener process (its steps are independent), constant from row to row
//
// K may change from row to row. How fast u may change is chosen by likelihood, the size of the noise with it.
// Source: Kalman filter and fixed-interval smoother of Bryson & Frazier as in Bierman, IEEE Trans. Automatic Control 18 (1973) 529-532;
// likelihood as in Kristensen, Madsen & Jorgensen, Automatica 40 (2004) 225-237.

#include <Eigen/Core>
#include <vector>

namespace driftwright::diagnosis {

/// A linear machine from row to row, in the modes K V = M V Λ, V'M V = 1 of each stretch in which K is the same.
struct ModalCourse {
  struct Modes {
    Eigen::VectorXd rate_1_s;  ///< Λ, n
    Eigen::MatrixXd load;      ///< V'b of each body, n x n_bodies
    Eigen::MatrixXd observe;   ///< V'C' of each channel over its noise, n x n_channels
    Eigen::MatrixXd mean;      ///< what the mean temperature of each body has of a mode, n x n_bodies
    Eigen::MatrixXd from;      ///< V'M V_before: modes of the stretch before as these; empty for the first
    Eigen::MatrixXd start;     ///< square root of what is not known of the start, n x n_directions
  };
  std::vector<double> time_s;  ///< of the rows
  std::vector<Modes> modes;
  std::vector<std::size_t> of_interval;  ///< which modes hold from each row to the next, not decreasing; n_rows - 1
};

struct SmoothedHeat {
  Eigen::VectorXd heat_W, sd_W;      ///< from each row to the next, n_rows - 1
  Eigen::MatrixXd mean_K;            ///< what it does to the mean temperature of each body, n_rows x n_bodies
  Eigen::MatrixXd readings;          ///< and to each channel, over its noise, n_rows x n_channels
  double log_likelihood_gain = 0.0;  ///< over no heat
  double noise_scale = 1.0;          ///< noise that readings have over that assumed
};

/// @param residual  measured minus predicted over the noise of each channel, n_rows x n_channels; NaN where missing
/// @param body      column of Modes::load
/// @param carrier   what the process is times, from each row to the next: temperature differences [K] make a conductance [W/K] of it, and every
///                  W in the result W/K; n_rows - 1
/// @param typical_W a change of heat (or conductance) from row to row that would be no surprise: 1e-4 to 30 times this are tried
[[nodiscard]] SmoothedHeat smooth_heat(const ModalCourse& machine, const Eigen::MatrixXd& residual, Eigen::Index body,
                                       const Eigen::VectorXd& carrier, double typical_W);

}  // namespace driftwright::diagnosis
