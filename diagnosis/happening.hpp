#pragma once
// Windows of one size, wherever they are, and the doubt that they make: heat in a body, an exchange with another one, or another speed of the spindle.

#include <optional>

#include "diagnosis/twin.hpp"
#include "effects/doubt.hpp"

namespace driftwright::diagnosis {

/// Windows as one cause of the catalogue.
struct Event {
  effects::Doubt
      doubt;  ///< windows of heat, of an exchange or of another speed; its numbers: the size, and how much longer, or when they come again
  double price_nats = 0.0;  ///< of their times, which were read off the data
  struct Window {
    std::string in;  ///< run
    double begin_s = 0.0, end_s = 0.0;
  };
  std::optional<Window> once = {};  ///< where there is one window in all
};

/// Keys of effects that events may have.
inline constexpr const char* kEventKeys[] = {"exchange_window", "heat_window", "speed_override", "hidden_body"};

using Times = std::vector<std::pair<double, double>>;  ///< beginnings and ends [s]

/// Windows of one size, wherever they are.
struct Happening {
  effects::Body body;
  std::optional<effects::Body> other = {};  ///< an exchange with it; else heat
  bool is_speed = false;  ///< of the spindle, whatever the body: the size is what heat of turning grows by, over itself
  std::vector<std::pair<const MeasuredRun*, Times>> in =
      {};  ///< each run that has some; no run: all of them, one window in each turn
  /// How much of the record would do as well as each beginning and end [s], in the order of all windows; empty: not known.
  Times wide_s = {};
  double every_s = 0.0;  ///< of windows that repeat
  double size = 0.0;     ///< W, W/K or 1
  double price_nats = 0.0;
};

/// 1 sigma of a conductance that nobody knows of, per W of heat that nobody knows of [W/K].
inline constexpr double kUnknownExchange = 0.2;
/// 1 sigma of what the heat of turning grows by, over itself, where another speed is doubted.
inline constexpr double kUnknownSpeed = 0.7;

/// The window of an exchange between two bodies, either end of which may be the one that stands first. None between two regions, or where the twin has no
/// place for it.
[[nodiscard]] std::optional<effects::Effect> exchange_window(const Twin& twin, const effects::Body& a,
                                                             const effects::Body& b);

/// Whether half of the windows' time or more lies in holes of their records, where nobody saw what went on. What repeats in each turn was seen in others.
[[nodiscard]] bool is_unseen(const Happening& happening);

/// Share of the time of its records that windows take; of what repeats, of a turn.
[[nodiscard]] double share_of_time(const Happening& happening);

/// From row to row [s], on average.
[[nodiscard]] double row_s(const MeasuredRun& run);

/// @returns  nothing where there is no window, or none of a size that is allowed
[[nodiscard]] std::optional<Event> event_of(const Twin& twin, const effects::DoubtScene& scene, const Happening& happening);

}  // namespace driftwright::diagnosis
