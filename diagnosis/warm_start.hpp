#pragma once
// Records that begin with a machine still warm from before, while the scenario starts it at the ambient temperature.

#include "diagnosis/comparison.hpp"
#include "diagnosis/twin.hpp"

namespace driftwright::diagnosis {

/// Where thermometers read more than 4 K beside the twin at a record's start (two of them, or the only one), the
/// run gets a start of its own and a finding: of every region and node the most probable offset a of its start, and what it is not known to,
///
///     a = C H' (H C H' + R)^-1 r,   P = C - C H' (H C H' + R)^-1 H C,   C = s^2 (0.7 + 0.3 I)
///
/// r: first readings minus the twin's; H: their response to a body 1 K warmer; s: root mean square of r, R: (0.5 K)^2. Bodies of a machine
/// that cools are about as warm as their neighbours: 0.7.
/// Source: linear Gaussian estimation, e.g. Rasmussen & Williams, Gaussian Processes for Machine Learning (2006), eq. 2.25-2.26.
void find_warm_starts(std::vector<MeasuredRun>& runs, const Twin& twin);

/// What the starts' doubt does to the readings: for the Fitter, columns whose amplitudes have a standard deviation of 1.
[[nodiscard]] std::vector<Prediction> start_columns(const Twin& twin, const std::vector<MeasuredRun>& runs);

}  // namespace driftwright::diagnosis
