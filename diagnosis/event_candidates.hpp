#pragma once
// Events that come again and again, as one cause: windows of one size, in one run or in several.

#include <optional>

#include "base/listener.hpp"
#include "diagnosis/fit.hpp"
#include "diagnosis/projection.hpp"
#include "effects/doubt.hpp"

namespace driftwright::diagnosis {

struct Event {
  effects::Doubt
      doubt;  ///< windows of heat, of an exchange or of another speed; its numbers: the size, and how much longer, or when they come again
  double price_nats = 0.0;        ///< of their times, which were read off the data
  bool takes_any_course = false;  ///< so many windows that a course of any shape would do as well
  struct Window {
    std::string in;  ///< run
    double begin_s = 0.0, end_s = 0.0;
  };
  std::optional<Window> once = {};  ///< where there is one window in all
};

/// Keys of effects that events may have.
inline constexpr const char* kEventKeys[] = {"exchange_window", "heat_window", "speed_override", "hidden_body"};

/// Where the waveform of a body, missing in the twin as written, has windows, in all runs together; each of their times at the price of all rows that it could
/// have been at.
[[nodiscard]] std::vector<Event> events_seen(const Twin& twin, const std::vector<MeasuredRun>& runs,
                                             const Listener& listener = {});

/// Those that the whitened readings ask for beside a fit, by linear theory, in any body, between any two and of the spindle's speed, what is known roughly taken
/// off first (window_search.hpp).
/// @param projection  of the fit, its readings condensed
/// @throws SolveError  where the fit's state has no solution
[[nodiscard]] std::vector<Event> events_beside(const Fitter& fitter, const Hypothesis& hypothesis, const Fit& fit,
                                               const Projection& projection, const Listener& listener = {});

}  // namespace driftwright::diagnosis
