#pragma once
// What the C of a correction (drift_model_c) and its component for LinuxCNC (linuxcnc_component) share: names, numbers and
// the calls of the filter of probings.

#include <span>
#include <string>
#include <vector>

#include "output/drift_model_files.hpp"

namespace driftwright::output {

/// The target's name in C. `drift` would make a drift_state of its own beside that of drift_correction.h.
[[nodiscard]] std::string target_name(const std::string& target);

/// HAL's names have at most 47 characters; "doubt-" and the name of the loaded component take part of them.
inline constexpr std::size_t kLongestPin = 28;

/// The names of the readings, in the order of the guards; none is a name that the component has for something else.
[[nodiscard]] std::vector<std::string> reading_names(const std::vector<compensation::FailSafe::Guard>& guards,
                                                     std::size_t longest = std::string::npos);

/// A number as C reads it back exactly.
[[nodiscard]] std::string c_number(double x);

/// Text that is safe in a C comment or in a string of a component.
[[nodiscard]] std::string quoted_in_c(std::string text);

/// How C calls the filter of probings: of one model (probe_feedback.h), or of a blend whose weights move (probe_members.h).
struct ProbeCalls {
  std::string prefix;                 ///< of the functions
  std::string arguments;              ///< settings and state
  std::string prediction, corrected;  ///< their next arguments in ..._row() and ..._corrected_um()
  std::string said;                   ///< before what is said of the last probing
  std::string refused;                ///< number of refused ones
};
[[nodiscard]] ProbeCalls probe_calls(const DeployedModel& d, const std::string& settings, const std::string& state,
                                     const std::string& prediction);

/// The settings of the filters, for both files. @param noise_um, lag_s  as C has them
[[nodiscard]] std::string processes_text(const DeployedModel& d, const std::string& noise_um, const std::string& lag_s);

/// The readings of all places, each once.
struct PlacedReadings {
  std::vector<compensation::FailSafe::Guard> guards;
  std::vector<std::string> names;                  ///< in C
  std::vector<std::vector<std::size_t>> of_place;  ///< of each place, in the order of its guards
};
[[nodiscard]] PlacedReadings readings_of(std::span<const PlacedModel> places, std::size_t longest = std::string::npos);

}  // namespace driftwright::output
