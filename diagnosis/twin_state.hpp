#pragma once
// Everything about a machine that a diagnosis may doubt, as plain data.

#include <limits>
#include <string>
#include <vector>

#include "effects/effect.hpp"

namespace driftwright::diagnosis {

inline constexpr double kNever_s = std::numeric_limits<double>::infinity();

/// Heat that no effect of the scenario brings.
struct AddedHeat {
  effects::Body body;
  double power_W = 0.0;  ///< at the stated speed, or at all times
  enum class Shape {
    kConstant,   ///< also at standstill
    kPower,      ///< power_W (n / at_speed)^exponent
    kAsWritten,  ///< power_W times the body's own heat over that at the stated speed
    kPeriodic,   ///< mean_W + power_W sin(2π (t - delay) / period)
    kFeed,       ///< power_W at at_feed of all axes together, in proportion
  } shape = Shape::kConstant;
  double at_speed_rpm = 1000.0, exponent = 1.0, at_feed_m_s = 0.1;
  double mean_W = 0.0, period_s = 3600.0, delay_s = 0.0;
  double from_s = 0.0, until_s = kNever_s;
  std::string in = {};  ///< name of the only run it happens in; "": in each
};

/// Another law of what a body's own heat does: P' = factor P (n / at_speed)^change_of_exponent exp(-decay (T - at_K)).
struct ChangedFriction {
  effects::Body body;
  double factor = 1.0, change_of_exponent = 0.0, at_speed_rpm = 1000.0, decay_1_K = 0.0, at_K = 293.15;
};

/// A coefficient c of a film, link or joint: c' = factor c + added + growth (n / at_speed)^exponent.
struct ChangedExchange {
  std::string name;  ///< of the exchange in the heat balance
  double factor = 1.0, added = 0.0;
  double growth = 0.0, at_speed_rpm = 1000.0, exponent = 2.0 / 3.0;
  double from_s = 0.0;
  std::string in = {};  ///< name of the only run it happens in; "": in each
};

/// Factors on what a region is made of, or a lumped node.
struct ChangedBody {
  std::string body;
  double conductivity = 1.0, heat_capacity = 1.0, expansion = 1.0;
  std::string displacement = {};  ///< the only output that the expansion is about, where it is a sensitivity; "": all
};

struct TwinState {
  std::vector<effects::Effect> effects;  ///< of the machine the twin was made of; numbers may change, nothing else
  std::vector<AddedHeat> heats;
  std::vector<ChangedFriction> frictions;
  std::vector<ChangedExchange> exchanges;
  std::vector<ChangedBody> bodies;
  double gradient_K_m = 0.0;  ///< of the hall's air, where the scenario has none
  double level_m = 0.0;       ///< where the hall's thermometer hangs in it
  effects::DriveChange drive;
  effects::ReadingChain readings;
};

}  // namespace driftwright::diagnosis
