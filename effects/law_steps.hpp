#pragma once
// A law of a heat balance as steps of a formula, beside the function that the program calls: for units, which hold laws
// as data.

#include <iterator>
#include <string>
#include <vector>

#include "effects/heat_balance.hpp"

namespace driftwright::effects {

/// Names of a law's formula, in the order of Expression::Step::name: n [rpm], v_x, v_y, v_z [m/s], P_cut [W], then the
/// law's probes T0, T1, ... [K].
[[nodiscard]] std::vector<std::string> law_names(std::size_t n_probes);
inline constexpr std::size_t kDriveNames = 5;

/// Recorded columns of places [mm]: those that cyclograms may have. Names of a law from kFirstPlace on; absent: 0.
inline constexpr const char* kPlaceNames[] = {"position_x", "position_y", "position_z", "stroke_x", "stroke_y", "stroke_z"};
inline constexpr std::size_t kPlaces = std::size(kPlaceNames), kFirstPlace = 1000;
/// Index of the place that a column is, with or without its unit; kPlaces for another one.
[[nodiscard]] std::size_t place_index(const std::string& column);
[[nodiscard]] double place_mm(const Drive& drive, std::size_t place);
void set_place(Drive& drive, std::size_t place, double value_mm);

/// A number as a formula has it, exact, and with brackets if it is negative.
[[nodiscard]] std::string written(double number);

/// The text in steps. @throws FormulaError
[[nodiscard]] std::vector<Expression::Step> law_steps(const std::string& text, std::size_t n_probes);

/// The sum of laws whose probes follow each other; empty if one of them has no steps.
[[nodiscard]] std::function<std::vector<Expression::Step>()> sum_of_steps(const std::vector<const Law*>& laws);

/// The value of steps as the law has it.
[[nodiscard]] double value_of_law_steps(const std::vector<Expression::Step>& steps, const Inputs& u);

}  // namespace driftwright::effects
