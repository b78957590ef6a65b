#pragma once
// e^X, φ1(X) and φ2(X) of a full matrix by scaling: a series of X / 2^n, then
//
//     e^{2X} = e^X e^X,   φ1(2X) = (e^X + 1) φ1(X) / 2,   φ2(2X) = (φ1(X)² + 2 φ2(X)) / 4
//
// φ1(X) = ∫ e^{(1-s)X} ds and φ2(X) = ∫ e^{(1-s)X} s ds, s from 0 to 1. Source: Hochbruck & Ostermann, Acta Numerica 19
// (2010) 209-286; the series in powers of its fourth power: Paterson & Stockmeyer, SIAM J. Comput. 2 (1973) 60-66.

#include <Eigen/Core>
#include <vector>

namespace driftwright::solver {

struct Exponentials {
  Eigen::MatrixXd exp, phi1, phi2;
};

[[nodiscard]] Exponentials exponentials(const Eigen::MatrixXd& x);

/// Those of X, X/2, X/4 ... down to the one computed by the series.
[[nodiscard]] std::vector<Exponentials> exponentials_and_halves(const Eigen::MatrixXd& x);

/// Those of 2X, from those of X.
[[nodiscard]] Exponentials doubled(const Exponentials& of_x);

}  // namespace driftwright::solver
