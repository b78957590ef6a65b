#pragma once
// Windows of time with one size, and the doubt made from them: heat in a body, an exchange with another body, or another
// spindle speed.

#include <optional>

#include "diagnosis/twin.hpp"
#include "effects/doubt.hpp"

namespace driftwright::diagnosis {

/// Windows as one cause of the catalogue.
struct Event {
  effects::Doubt
      doubt;  ///< windows of heat, exchange or another speed; its numbers: the size, and when they are, or how much longer
  double price_nats = 0.0;  ///< cost of their times, which were chosen by the data
  struct Window {
    std::string in;  ///< run
    double begin_s = 0.0, end_s = 0.0;
  };
  std::optional<Window> once = {};  ///< if there is only one window
};

/// Keys of effects that events may have.
inline constexpr const char* kEventKeys[] = {"exchange_window", "heat_window", "speed_override", "hidden_body"};

using Times = std::vector<std::pair<double, double>>;  ///< begin and end of each [s]

/// Windows with one size, at any times.
struct Happening {
  effects::Body body;
  std::optional<effects::Body> other = {};  ///< an exchange with this body; none: heat
  bool is_speed = false;  ///< of the spindle, with any body: the size is the relative increase of the heat of turning
  std::vector<std::pair<const MeasuredRun*, Times>> in = {};  ///< each run with windows
  /// Uncertainty of each begin and end [s], in the order of all windows: range that fits as well; empty: unknown.
  Times wide_s = {};
  double size = 0.0;  ///< W, W/K or 1
  double price_nats = 0.0;
};

/// Prior standard deviation of an unknown conductance per W of the prior of an unknown heat [W/K].
inline constexpr double kUnknownExchange = 0.2;
/// Prior standard deviation of the relative increase of the heat of turning when another speed is suspected.
inline constexpr double kUnknownSpeed = 0.7;

/// The window of an exchange between two bodies, in the order that the catalogue allows. None between two regions, or if
/// the twin has no place for it.
[[nodiscard]] std::optional<effects::Effect> exchange_window(const Twin& twin, const effects::Body& a,
                                                             const effects::Body& b);

/// Whether at least half of the windows' time lies in holes of their records, so that it was not observed.
[[nodiscard]] bool is_unseen(const Happening& happening);

/// Share of the records' time that the windows take.
[[nodiscard]] double share_of_time(const Happening& happening);

/// @returns  nothing if there is no window, or none with an allowed size
[[nodiscard]] std::optional<Event> event_of(const Twin& twin, const effects::DoubtScene& scene, const Happening& happening);

}  // namespace driftwright::diagnosis
