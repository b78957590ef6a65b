#pragma once
// Windows of time that an effect is there in: a table of [begin, end], once or again and again.

#include "effects/doubt.hpp"

namespace driftwright::effects {

inline constexpr const char* kWindows = "windows";
inline constexpr const char* kLid = "a lid or door that opens for a while";  ///< an exchange's law in words

/// The table, and the parameters `every` and `until_time` by which it repeats.
[[nodiscard]] Table windows_table(bool compulsory = true);
[[nodiscard]] std::vector<Parameter> repeating(std::vector<Parameter> parameters);

/// Beginnings and ends [s], repeated where they repeat.
[[nodiscard]] std::vector<std::pair<double, double>> windows_of(const Effect& e);
/// A law that is zero outside them.
[[nodiscard]] std::function<double(const Inputs&)> within(std::vector<std::pair<double, double>> windows, double value);
/// When laws within windows jump.
void add_change_times(const std::vector<std::pair<double, double>>& windows, HeatBalance& balance);
/// Fails where windows overlap or end before they begin, or repeat too soon or too often.
void check_windows(const Effect& e, const ConfigMap& in);

/// One window in a run, anywhere in it: its size, begin and length. @param window  of a kind with windows, at a place
[[nodiscard]] Doubt one_window(const DoubtScene::Run& run, Effect window, DoubtedNumber size, double trial,
                               const std::string& law);

}  // namespace driftwright::effects
