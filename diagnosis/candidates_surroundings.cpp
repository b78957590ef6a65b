#include <algorithm>

#include "diagnosis/candidate_scene.hpp"

namespace driftwright::diagnosis {

void add_hall(const Scene& s, std::vector<Candidate>& list) {
  Candidate c{"ambient", "hall", {}};
  const auto error = [](double effects::DriveChange::HallError::*member, std::string in) {
    return [member, in](TwinState& t, double value) {
      effects::DriveChange::HallError e{};
      e.*member = value;
      e.in = in;
      t.drive.hall.push_back(e);
    };
  };
  using E = effects::DriveChange::HallError;
  c.variants.push_back({"offset", {knob("offset", "K", 2.0, 0.3, error(&E::offset_K, ""))}, 0.5});
  c.variants.push_back({"ramp",
                        {knob("ramp", "K/h", 0.7, 0.1,
                              [in = std::string()](TwinState& t, double value) {
                                E e{};
                                e.ramp_K_s = value / kHour_s;
                                t.drive.hall.push_back(e);
                              })},
                        0.2});
  for (const MeasuredRun& run : s.runs) {
    c.variants.push_back(
        {"step, in " + run.name,
         {knob("step", "K", 2.0, 0.3, error(&E::offset_K, run.name)),
          time_knob("time", length_s(run), [](TwinState& t, double value) { t.drive.hall.back().from_s = value; })},
         0.5,
         time_grid(length_s(run), 10)});
    if (s.runs.size() > 1) {
      c.variants.push_back({"offset, in " + run.name, {knob("offset", "K", 2.0, 0.3, error(&E::offset_K, run.name))}, 0.5});
      c.variants.push_back({"ramp, in " + run.name,
                            {knob("ramp", "K/h", 0.7, 0.1,
                                  [in = run.name](TwinState& t, double value) {
                                    E e{};
                                    e.ramp_K_s = value / kHour_s;
                                    e.in = in;
                                    t.drive.hall.push_back(e);
                                  })},
                            0.2});
    }
  }
  list.push_back(c);
  const bool has_air = std::any_of(s.twin.machine().system.exchanges.begin(), s.twin.machine().system.exchanges.end(),
                                   [](const auto& e) { return e.offset.size() > 0; });
  if (!s.twin.augmented().has_own_gradient && has_air) {
    Knob gradient = knob("gradient", "K/m", 1.0, 0.2, [](TwinState& t, double value) { t.gradient_K_m += value; });
    Knob level = knob("level", "m", 0.6, 0.1, [](TwinState& t, double value) { t.level_m = value; });
    level.nominal = 1.0;  // about where one hangs a thermometer
    list.push_back({"stratification",
                    "hall",
                    {{"warmer above; the hall's thermometer hangs at a level", {gradient, level}, 0.5, {{-0.6}, {0.2}}}}});
  }
}

void add_drive(const Scene& s, std::vector<Candidate>& list) {
  list.push_back({"clock_offset",
                  "clock",
                  {{"readings late or early",
                    {on_readings(knob("offset", "min", 5.0, 0.5,
                                      [](TwinState& t, double value) { t.readings.clock_offset_s += kMinute_s * value; }))},
                    1.0}}});
  Knob speed = factor([](TwinState& t, double value) { t.drive.speed_factor *= value; });
  speed.prior_sd = 0.3;
  list.push_back({"speed_override", "spindle", {{"true speed over the recorded one", {speed}, 0.1}}});
  Candidate stop{"missing_stop", "spindle", {}};
  for (const MeasuredRun& run : s.runs) {
    Knob length = knob("length", "min", 15.0, 1.0, [in = run.name](TwinState& t, double value) {
      t.drive.stops.push_back({0.0, kMinute_s * value, in});
    });
    length.low = 0.0;
    stop.variants.push_back({"in " + run.name,
                             {length, time_knob("start", length_s(run),
                                                [](TwinState& t, double value) { t.drive.stops.back().start_s = value; })},
                             10.0,
                             time_grid(length_s(run), 16)});
  }
  list.push_back(stop);
}

}  // namespace driftwright::diagnosis
