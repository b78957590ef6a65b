#include "scenarios/reader/read_axis_loop.hpp"

#include <fmt/format.h>

#include <cmath>

namespace driftwright::scenarios {
namespace {

using namespace compensation;

void read_encoder(const ConfigMap& in, Encoder& encoder, double default_period_um) {
  encoder.period_um = default_period_um;
  if (in.has("lines") || in.has("pitch")) {
    if (in.has("signal_period")) in.fail("signal_period", "either `signal_period`, or `pitch` and `lines`, is wanted");
    encoder.period_um = in.quantity("pitch", "um", 1e-3, 1e9) / in.integer("lines", 1, 100'000'000);
  } else {
    encoder.period_um = in.quantity("signal_period", "um", 1e-4, 1e6, default_period_um);
  }
  encoder.jitter = in.quantity("jitter", "1", 0.0, 0.49, encoder.jitter);
}

InjectorSettings read_injector(const ConfigMap& in) {
  InjectorSettings s;
  const std::string insert = in.choice("insert", {"cycle", "half", "quarter"}, "cycle");
  s.rules.quarters = insert == "quarter" ? 1 : insert == "half" ? 2 : kQuartersPerPeriod;
  s.rules.anywhere = in.choice("window", {"both_low", "any"}, "both_low") == "any";
  const std::string counts = in.choice("counts", {"x4", "x2", "x1"}, "x4");
  s.counting = counts == "x1" ? Counting::kX1 : counts == "x2" ? Counting::kX2 : Counting::kX4;
  if (s.rules.quarters < quarters_per_count(s.counting))
    in.fail("insert", fmt::format("a {} is less than one count at {}; the control would not see each", insert, counts));
  s.least_separation_s = in.quantity("least_separation", "s", 1e-9, 1.0, s.least_separation_s);
  s.largest_count_rate_1_s = in.quantity("largest_count_rate", "1/s", 1.0, 1e9, s.largest_count_rate_1_s);
  s.largest_slew_um_s = in.quantity("largest_slew", "um/s", 1e-6, 1e6, s.largest_slew_um_s);
  return s;
}

Servo read_servo(const ConfigMap& in) {
  Servo s;
  s.period_s = in.quantity("period", "s", 1e-5, 0.1, s.period_s);
  s.position_gain_1_s = in.quantity("position_gain", "1/s", 1e-3, 1e4, s.position_gain_1_s);
  s.speed_gain_1_s = in.quantity("speed_gain", "1/s", 1e-2, 1e5, s.speed_gain_1_s);
  s.speed_reset_s = in.quantity("speed_reset", "s", 1e-4, 1e3, s.speed_reset_s);
  s.feed_forward = in.quantity("feed_forward", "1", 0.0, 2.0, s.feed_forward);
  s.largest_acceleration_um_s2 = in.quantity("largest_acceleration", "um/s^2", 1.0, 1e9, s.largest_acceleration_um_s2);
  // The speed loop of a sampled drive with a = gain (v_ref - v) is stable below 2 / period, the cascade below a quarter of the inner loop.
  if (!(s.speed_gain_1_s * s.period_s <= 1.0))
    in.fail("speed_gain", fmt::format("at most 1 / period = {:g} 1/s, or the speed rings", 1.0 / s.period_s));
  if (!(s.position_gain_1_s <= 0.25 * s.speed_gain_1_s))
    in.fail("position_gain", fmt::format("at most a quarter of speed_gain = {:g} 1/s", 0.25 * s.speed_gain_1_s));
  if (const double least_s = least_speed_reset_s(s); !(s.speed_reset_s > least_s))
    in.fail("speed_reset", fmt::format("{:g} s; more than {:.3g} s, or the sampled loop is unstable at these gains",
                                       s.speed_reset_s, least_s));
  in.reject_unknown_keys();
  return s;
}

AxisMotion read_motion(const ConfigMap& in) {
  AxisMotion m;
  m.stroke_um = in.quantity("stroke", "um", 1e-3, 1e8);
  m.feed_um_s = in.quantity("feed", "um/s", 1e-3, 1e7);
  m.every_s = in.quantity("every", "s", 1e-3, 1e9);
  if (!(m.stroke_um / m.feed_um_s <= 0.5 * m.every_s))
    in.fail("every",
            fmt::format("a pass takes {:g} s; at least twice that, or there is no rest in which errors are looked at",
                        m.stroke_um / m.feed_um_s));
  if (!(m.every_s > m.busy_s()))
    in.fail("every",
            fmt::format("{:g} s; more than {:g} s, the pass and the time to settle behind it, or the axis never rests",
                        m.every_s, m.busy_s()));
  in.reject_unknown_keys();
  return m;
}

}  // namespace

AxisLoopSettings read_axis_loop(const ConfigMap& in, const AxisLoopContext& context) {
  AxisLoopSettings s;
  s.where = in.where();
  AxisLoop& loop = s.loop;
  s.displacement = in.choice("displacement", context.displacements, context.target);
  loop.feedback = in.choice("feedback", {"motor", "scale"}, "motor") == "motor" ? Feedback::kMotor : Feedback::kScale;
  read_encoder(in, loop.encoder, context.encoder_period_um);
  loop.injector = read_injector(in);
  if (const auto servo = in.optional_map("servo")) loop.servo = read_servo(*servo);
  if (const auto motion = in.optional_map("motion")) loop.motion = read_motion(*motion);
  loop.sampling_s = in.quantity("sampling", "s", 1e-3, 1e6, loop.sampling_s);
  loop.thermometers.noise_K = in.quantity("temperature_noise", "K", 0.0, 100.0, 0.0);
  loop.thermometers.resolution_K = in.quantity("temperature_resolution", "K", 0.0, 100.0, context.sensor_resolution_K);
  loop.hysteresis_um = in.quantity("hysteresis", "um", 0.0, 1e6, 0.0);
  loop.seed = static_cast<std::uint64_t>(in.integer("seed", 0, 1'000'000'000, 1));
  loop.encoder.seed = loop.seed;
  if (const auto growth = in.optional_map("growth")) {
    loop.growing_part = growth->choice("of", {"screw", "scale"}) == "screw" ? GrowingPart::kScrew : GrowingPart::kScale;
    loop.growing_channel = growth->choice("sensor", context.sensors);
    loop.expansion_1_K = growth->quantity("expansion", "1/K", -1e-3, 1e-3);
    loop.at_um = growth->quantity("at", "um", -1e9, 1e9);
    growth->reject_unknown_keys();
  }
  constexpr double kMostSamples = 1e6, kMostEdges = 3e8;
  if (!(context.duration_s / loop.sampling_s <= kMostSamples))
    in.fail("sampling", fmt::format("{:.1e} samples of the judged cyclogram; at most {:.0e}",
                                    context.duration_s / loop.sampling_s, kMostSamples));
  const double n_edges = context.duration_s / loop.motion.every_s * loop.motion.stroke_um / loop.encoder.quarter_um();
  if (!(n_edges <= kMostEdges))
    in.fail("motion",
            fmt::format("{:.1e} edges in the judged cyclogram; at most {:.0e}: take a shorter stroke", n_edges, kMostEdges));
  in.reject_unknown_keys();
  return s;
}

}  // namespace driftwright::scenarios
