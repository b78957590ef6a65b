#pragma once
// Records that begin with a machine that is still warm, while the scenario starts it at the ambient temperature.

#include "diagnosis/comparison.hpp"
#include "diagnosis/twin.hpp"

namespace driftwright::diagnosis {

/// If thermometers differ by more than 4 K from the twin at a record's start (two of them, or the only one), the run gets
/// its own start and a finding: the most probable offset a of the start of every region and node, and its uncertainty,
///
///     a = C H' (H C H' + R)^-1 r,   P = C - C H' (H C H' + R)^-1 H C,   C = s^2 (0.7 + 0.3 I)
///
/// r: first readings minus the twin's; H: their response to a body 1 K warmer; s: root mean square of r, R: (0.5 K)^2.
/// Correlation 0.7, since bodies of a cooling machine are about as warm as their neighbours.
/// Source: linear Gaussian estimation, e.g. Rasmussen & Williams, Gaussian Processes for Machine Learning (2006), eq.
/// 2.25-2.26.
void find_warm_starts(std::vector<MeasuredRun>& runs, const Twin& twin);

/// Effect of the starts' uncertainty on the readings: columns for the Fitter whose amplitudes have a standard deviation
/// of 1.
[[nodiscard]] std::vector<Prediction> start_columns(const Twin& twin, const std::vector<MeasuredRun>& runs);

}  // namespace driftwright::diagnosis
