#pragma once
// Heat that nobody knows of: where it would sit and how it would run over time, from what a fit leaves over.

#include "diagnosis/fit.hpp"

namespace driftwright::diagnosis {

struct LatentHeat {
  std::string body;            ///< that explains most
  double explained = 0.0;      ///< share of the leftover's squares, scatter taken off
  std::vector<double> time_s;  ///< of the first run's rows
  std::vector<double> heat_W;
  std::string correlates_with;
  double correlation = 0.0;
};

/// Regularised deconvolution: a heat of constant pieces of 20 min in each region in turn, its changes kept small.
[[nodiscard]] std::optional<LatentHeat> latent_heat(const Fitter& fitter, const Hypothesis& hypothesis, const Fit& fit);

/// The drive or ambient quantity that a series follows most, and how closely [-1, 1].
[[nodiscard]] std::pair<std::string, double> resembles(const MeasuredRun& run, const Eigen::VectorXd& series);

}  // namespace driftwright::diagnosis
