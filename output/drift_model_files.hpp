#pragma once
// A formula for the drift and its fail-safe as text for people. (predictor_file writes it as JSON, drift_model_c as C.)

#include <span>
#include <string>

#include "compensation/predictors/deployed_predictor.hpp"
#include "compensation/predictors/drift_model.hpp"

namespace driftwright::output {

/// A formula together with its fail-safe.
struct DeployedModel {
  compensation::DriftModel model;
  compensation::FailSafe safe;
  double interval_um = 0.0;                                    ///< half width of its 95 % prediction interval; NaN: unknown
  std::optional<compensation::ResidualProcess> residual = {};  ///< what it leaves, for probings; none: unknown
  compensation::Probe probe = {};
  /// Of a mean whose weights move with probings: its formulas, and what each leaves; otherwise both are empty.
  std::vector<compensation::DriftModel> members = {};
  std::vector<compensation::MemberResidual> member_residuals = {};
};

/// A formula that corrects an axis at one place of its travel. Several of them, by rising position, are one correction for
/// the whole travel: straight between the places, and held beyond the outermost (compensation/control/axis_travel.h). They
/// take no probings, which are of one place.
struct PlacedModel {
  DeployedModel model;
  double at_mm = 0.0;  ///< position of the axis
};

/// Where a guard's reading is among those of several formulas: each input once. One that is not there is added.
[[nodiscard]] std::size_t reading_among(std::vector<compensation::FailSafe::Guard>& guards,
                                        const compensation::FailSafe::Guard& guard);

/// @throws InputError  for places whose models one program cannot run: their rows are not equally far apart, or not all of
///                     them count temperatures from the first row
void require_of_one_run(std::span<const PlacedModel> places);

/// What a control can run of a predictor: its formula with its fail-safe.
/// @throws std::logic_error  for a predictor that gives no formula, and for one without a fail-safe
[[nodiscard]] DeployedModel deployed_model(const compensation::DeployedPredictor& deployed);

/// A formula that can be typed into a control, with units and validity ranges.
[[nodiscard]] std::string formula_text(const DeployedModel& deployed);

}  // namespace driftwright::output
