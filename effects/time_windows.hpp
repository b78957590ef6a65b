#pragma once
// Windows of time in which an effect acts: a table of [begin, end], once or repeated.

#include "effects/doubt.hpp"

namespace driftwright::effects {

inline constexpr const char* kWindows = "windows";
inline constexpr const char* kLid = "a lid or door that opens for a while";  ///< words for the law of such an exchange

/// The table, and the parameters `every` and `until_time` that repeat it.
[[nodiscard]] Table windows_table(bool compulsory = true);
[[nodiscard]] std::vector<Parameter> repeating(std::vector<Parameter> parameters);

/// Begin and end of each window [s], repetitions included.
[[nodiscard]] std::vector<std::pair<double, double>> windows_of(const Effect& e);
/// A law with this value inside the windows and zero outside.
[[nodiscard]] std::function<double(const Inputs&)> within(std::vector<std::pair<double, double>> windows, double value);
/// Adds the times at which laws within windows jump.
void add_change_times(const std::vector<std::pair<double, double>>& windows, HeatBalance& balance);
/// Fails if windows overlap or end before they begin, or repeat too soon or too often.
void check_windows(const Effect& e, const ConfigMap& in);

/// A doubt about one window at any time of a run: its size, begin and length. @param window effect of a kind with windows,
/// at a place
[[nodiscard]] Doubt one_window(const DoubtScene::Run& run, Effect window, DoubtedNumber size, double trial,
                               const std::string& law);

}  // namespace driftwright::effects
