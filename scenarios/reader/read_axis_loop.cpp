#include "scenarios/reader/read_axis_loop.hpp"

#include <fmt/format.h>

#include <cmath>

namespace driftwright::scenarios {
namespace {

using compensation::AxisLoop, compensation::AxisMotion, compensation::Counting, compensation::Encoder;
using compensation::Feedback, compensation::GrowingPart, compensation::InjectorSettings, compensation::kQuartersPerPeriod,
    compensation::Servo;

void read_encoder(const ConfigMap& in, Encoder& encoder, double default_period_um) {
  encoder.period_um =
      in.has("pitch") ? in.quantity("pitch") / in.integer("lines") : in.quantity("signal_period", default_period_um);
  encoder.jitter = in.quantity("jitter");
}

InjectorSettings read_injector(const ConfigMap& in) {
  InjectorSettings s;
  const std::string insert = in.choice("insert");
  s.rules.quarters = insert == "quarter" ? 1 : insert == "half" ? 2 : kQuartersPerPeriod;
  s.rules.anywhere = in.choice("window") == "any";
  const std::string counts = in.choice("counts");
  s.counting = counts == "x1" ? Counting::kX1 : counts == "x2" ? Counting::kX2 : Counting::kX4;
  if (s.rules.quarters < quarters_per_count(s.counting))
    in.fail("insert", fmt::format("a {} is less than one count at {}; the control would not see each", insert, counts));
  s.least_separation_s = in.quantity("least_separation");
  s.largest_count_rate_1_s = in.quantity("largest_count_rate");
  s.largest_slew_um_s = in.quantity("largest_slew");
  return s;
}

Servo read_servo(const ConfigMap& in) {
  Servo s;
  s.period_s = in.quantity("period");
  s.position_gain_1_s = in.quantity("position_gain");
  s.speed_gain_1_s = in.quantity("speed_gain");
  s.speed_reset_s = in.quantity("speed_reset");
  s.feed_forward = in.quantity("feed_forward");
  s.largest_acceleration_um_s2 = in.quantity("largest_acceleration");
  // The speed loop of a sampled drive with a = gain (v_ref - v) is stable below 2 / period, the cascade below a quarter
  // of the inner loop's gain.
  if (!(s.speed_gain_1_s * s.period_s <= 1.0))
    in.fail("speed_gain",
            fmt::format("the value must be at most 1 / period = {:g} 1/s, or the speed rings", 1.0 / s.period_s));
  if (!(s.position_gain_1_s <= 0.25 * s.speed_gain_1_s))
    in.fail("position_gain",
            fmt::format("the value must be at most a quarter of speed_gain = {:g} 1/s", 0.25 * s.speed_gain_1_s));
  if (const double least_s = least_speed_reset_s(s); !(s.speed_reset_s > least_s))
    in.fail("speed_reset",
            fmt::format("{:g} s is too short; it must be more than {:.3g} s, or the sampled loop is unstable at these gains",
                        s.speed_reset_s, least_s));
  in.reject_unknown_keys();
  return s;
}

AxisMotion read_motion(const ConfigMap& in) {
  AxisMotion m;
  m.stroke_um = in.quantity("stroke");
  m.feed_um_s = in.quantity("feed");
  m.every_s = in.quantity("every");
  if (!(m.stroke_um / m.feed_um_s <= 0.5 * m.every_s))
    in.fail(
        "every",
        fmt::format(
            "a pass takes {:g} s; `every` must be at least twice that, or there is no rest in which errors are looked at",
            m.stroke_um / m.feed_um_s));
  if (!(m.every_s > m.busy_s()))
    in.fail("every", fmt::format("{:g} s is too short; it must be more than {:g} s, the pass and the time to settle after "
                                 "it, or the axis never rests",
                                 m.every_s, m.busy_s()));
  in.reject_unknown_keys();
  return m;
}

}  // namespace

schema::Map axis_loop_schema() {
  using namespace schema;
  const AxisLoop loop;
  const InjectorSettings injector;
  const Servo s;
  const schema::Map motion = {
      .name = "axis_loop, motion",
      .keys = {compulsory("stroke", quantity("um", 1e-3, 1e8), "of the axis, there and back in turn"),
               compulsory("feed", quantity("um/s", 1e-3, 1e7), "of the axis as it moves"),
               compulsory("every", quantity("s", 1e-3, 1e9), "from one pass to the next; it rests between")}};
  const schema::Map servo = {
      .name = "axis_loop, servo",
      .keys = {schema::optional("period", quantity("s", 1e-5, 0.1), s.period_s, "of the sampled loops"),
               schema::optional("position_gain", quantity("1/s", 1e-3, 1e4), s.position_gain_1_s,
                                "of the position loop; a quarter of speed_gain at most"),
               schema::optional("speed_gain", quantity("1/s", 1e-2, 1e5), s.speed_gain_1_s,
                                "of the speed loop; 1 / period at most"),
               schema::optional("speed_reset", quantity("s", 1e-4, 1e3), s.speed_reset_s, "reset time of the speed loop"),
               schema::optional("feed_forward", quantity("1", 0.0, 2.0), s.feed_forward, "share of the commanded speed"),
               schema::optional("largest_acceleration", quantity("um/s^2", 1.0, 1e9), s.largest_acceleration_um_s2,
                                "of the drive")}};
  const schema::Map growth = {.name = "axis_loop, growth",
                              .keys = {compulsory("of", choice({"screw", "scale"}), "what grows"),
                                       compulsory("sensor", text(), "whose temperature it has"),
                                       compulsory("expansion", quantity("1/K", -1e-3, 1e-3), "strain per kelvin"),
                                       compulsory("at", quantity("um", -1e9, 1e9), "distance from the fixed bearing")}};
  return {.name = "axis_loop",
          .keys = {schema::optional("displacement", text(), Said{"the target of `study`"}, "that is corrected"),
                   schema::optional("feedback", choice({"motor", "scale"}), "motor", "what the encoder sits on"),
                   schema::optional("signal_period", quantity("um", 1e-4, 1e6), Said{"the study's encoder_period"},
                                    "travel of one period of the encoder's signal"),
                   schema::optional("pitch", quantity("um", 1e-3, 1e9), "or: of the screw"),
                   schema::optional("lines", integer(1, 100'000'000), "and lines of the encoder a turn"),
                   schema::optional("jitter", quantity("1", 0.0, 0.49), loop.encoder.jitter,
                                    "of its edges, in quarters of a period"),
                   schema::optional("counts", choice({"x4", "x2", "x1"}), "x4", "how the control counts a period"),
                   schema::optional("insert", choice({"cycle", "half", "quarter"}), "cycle", "what is inserted at once"),
                   schema::optional("window", choice({"both_low", "any"}), "both_low", "when it may be inserted"),
                   schema::optional("least_separation", quantity("s", 1e-9, 1.0), injector.least_separation_s,
                                    "between two edges"),
                   schema::optional("largest_count_rate", quantity("1/s", 1.0, 1e9), injector.largest_count_rate_1_s,
                                    "that the control counts"),
                   schema::optional("largest_slew", quantity("um/s", 1e-6, 1e6), injector.largest_slew_um_s,
                                    "of the correction"),
                   schema::optional("servo", schema::map(servo), "drive and control"),
                   schema::optional("motion", schema::map(motion), Said{"at rest"}, "how the axis moves"),
                   schema::optional("sampling", quantity("s", 1e-3, 1e6), loop.sampling_s,
                                    "period of readings, predictions and corrections"),
                   schema::optional("temperature_noise", quantity("K", 0.0, 100.0), 0.0, "of thermometers, white, 1 sigma"),
                   schema::optional("temperature_resolution", quantity("K", 0.0, 100.0),
                                    Said{"the study's sensor_resolution"}, "step of their readings"),
                   schema::optional("hysteresis", quantity("um", 0.0, 1e6), loop.hysteresis_um,
                                    "a correction changes once it is this much more than half an insertion off"),
                   schema::optional("seed", integer(0, 1'000'000'000), static_cast<double>(loop.seed), "of the noise"),
                   schema::optional("growth", schema::map(growth), Said{"none"}, "of the screw or scale itself")},
          .groups = {{Group::Rule::kAllOrNone, {"pitch", "lines"}, "both are required"},
                     {Group::Rule::kAtMostOne,
                      {"pitch", "signal_period"},
                      "`signal_period` and `pitch` with `lines` exclude each other; write only one of them"}},
          .about = "The study's regression through a pulse injector, edge by edge (docs/how-to/injector.md)."};
}

AxisLoopSettings read_axis_loop(const ConfigMap& in, const AxisLoopContext& context) {
  AxisLoopSettings s;
  s.where = in.where();
  AxisLoop& loop = s.loop;
  s.displacement = in.choice("displacement", context.displacements, context.target);
  loop.feedback = in.choice("feedback") == "motor" ? Feedback::kMotor : Feedback::kScale;
  read_encoder(in, loop.encoder, context.encoder_period_um);
  loop.injector = read_injector(in);
  if (const auto servo = in.optional_map("servo")) loop.servo = read_servo(*servo);
  if (const auto motion = in.optional_map("motion")) loop.motion = read_motion(*motion);
  loop.sampling_s = in.quantity("sampling");
  loop.thermometers.noise_K = in.quantity("temperature_noise");
  loop.thermometers.resolution_K = in.quantity("temperature_resolution", context.sensor_resolution_K);
  loop.hysteresis_um = in.quantity("hysteresis");
  loop.seed = static_cast<std::uint64_t>(in.integer("seed"));
  loop.encoder.seed = loop.seed;
  if (const auto growth = in.optional_map("growth")) {
    loop.growing_part = growth->choice("of") == "screw" ? GrowingPart::kScrew : GrowingPart::kScale;
    loop.growing_channel = growth->choice("sensor", context.sensors);
    loop.expansion_1_K = growth->quantity("expansion");
    loop.at_um = growth->quantity("at");
    growth->reject_unknown_keys();
  }
  constexpr double kMostSamples = 1e6, kMostEdges = 3e8;
  if (!(context.duration_s / loop.sampling_s <= kMostSamples))
    in.fail("sampling", fmt::format("the judged cyclogram has {:.1e} samples; at most {:.0e} are allowed",
                                    context.duration_s / loop.sampling_s, kMostSamples));
  const double n_edges = context.duration_s / loop.motion.every_s * loop.motion.stroke_um / loop.encoder.quarter_um();
  if (!(n_edges <= kMostEdges))
    in.fail("motion", fmt::format("the judged cyclogram has {:.1e} edges; at most {:.0e} are allowed; take a shorter stroke",
                                  n_edges, kMostEdges));
  in.reject_unknown_keys();
  return s;
}

}  // namespace driftwright::scenarios
