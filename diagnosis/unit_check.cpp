#include "diagnosis/unit_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "base/foreign_temperature.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kWithin = 5.0;         // factor around a thousand
constexpr double kFollowsTwin = 0.6;    // correlation of readings with the twin
constexpr double kTurned = 0.3;         // share of the readings that minus the twin leaves
constexpr double kLeastMoved_m = 1e-6;  // of the twin; below, nothing can be decided

struct Pairs {
  Eigen::ArrayXd read, model;  // of rows with a reading
};
Pairs pairs_of(const MeasuredChannel& channel, const Eigen::MatrixXd& prediction) {
  Pairs p;
  const Eigen::Index n = (channel.value.array() == channel.value.array()).count();
  p.read.resize(n);
  p.model.resize(n);
  Eigen::Index k = 0;
  for (Eigen::Index i = 0; i < channel.value.size(); ++i) {
    if (std::isnan(channel.value[i])) continue;
    p.read[k] = channel.value[i];
    p.model[k++] = prediction(channel.output, i);
  }
  return p;
}

double rms(const Eigen::ArrayXd& x) {
  return std::sqrt(x.square().mean());
}

std::optional<std::string> temperature_finding(const MeasuredChannel& c, const Pairs& p, double reference_C) {
  const Eigen::ArrayXd read_C = p.read + (c.recorded_unit == "degC" ? reference_C : 0.0);
  const Eigen::ArrayXd model_C = p.model + reference_C;
  // Kelvin counted from zero, under a header that means differences to the reference.
  const double as_read_K = rms(c.recorded_unit == "degC" ? read_C - model_C : p.read - p.model);
  for (const TemperatureScale& s : kForeignScales) {
    if (c.recorded_unit == "K" && s.per_K != 1.0) continue;  // rises may be large
    const Eigen::ArrayXd meant_C = (read_C - s.zero) / s.per_K;
    if (!(as_read_K > kFarBeside_K && kFarBetter * rms(meant_C - model_C) < as_read_K)) continue;
    return fmt::format(
        "{}_{} looks like {}: it reads {:.1f} to {:.1f} where the scenario has {:.1f} to {:.1f} degC, and in {} "
        "that is {:.1f} to {:.1f} degC; it is left out until its header or its numbers are mended",
        c.name, c.recorded_unit, s.unit, read_C.minCoeff(), read_C.maxCoeff(), model_C.minCoeff(), model_C.maxCoeff(),
        s.unit, meant_C.minCoeff(), meant_C.maxCoeff());
  }
  return std::nullopt;
}

/// Whether the temperatures follow the twin: a machine that was warm at the start cools while the twin warms, and its
/// displacements decrease with the correct sign.
/// being turned.
bool temperatures_follow(const MeasuredRun& run, const Eigen::MatrixXd& prediction) {
  int n_following = 0, n_other = 0;
  for (const MeasuredChannel& c : run.channels) {
    if (c.unit != "K") continue;
    const Pairs p = pairs_of(c, prediction);
    if (p.read.size() < 3) continue;
    const Eigen::ArrayXd read = p.read - p.read.mean(), model = p.model - p.model.mean();
    ++((read * model).mean() > kFollowsTwin * rms(read) * rms(model) ? n_following : n_other);
  }
  return n_following > n_other;
}

/// @param may_be_turned  whether a course opposite to the twin's can only mean a wrong sign
std::optional<std::string> displacement_finding(const MeasuredChannel& c, const Pairs& p, bool may_be_turned) {
  const Eigen::ArrayXd read = p.read - p.read.mean(), model = p.model - p.model.mean();
  const double read_m = rms(read), model_m = rms(model);
  if (!(model_m > kLeastMoved_m && read_m > 0.0)) return std::nullopt;
  if (!(std::abs((read * model).mean()) > kFollowsTwin * read_m * model_m)) return std::nullopt;
  if (may_be_turned && rms(read + model) < kTurned * read_m) {
    return fmt::format(
        "{}_{} seems to have the wrong sign: with the opposite sign its readings agree with the simulation to "
        "{:.0f} %; it is left out until its sign, or the scenario's, is mended",
        c.name, c.recorded_unit, 100.0 * rms(read + model) / read_m);
  }
  for (const auto& [times, meant] : {std::pair{1e-3, "um"}, std::pair{1e3, "mm"}}) {
    const double ratio = times * read_m / model_m;
    if (ratio > kWithin || ratio < 1.0 / kWithin) continue;
    const bool is_tilt = c.unit == "rad", is_mm = c.recorded_unit == "mm";
    const std::string unit = is_tilt                  ? (times > 1.0 ? "mrad" : "nrad")
                             : is_mm == (times > 1.0) ? (is_mm ? "m" : "nm")
                                                      : meant;
    const double scale = is_mm ? 1e3 : 1e6;
    return fmt::format(
        "{}_{} looks like {}: it reads {:.3g} to {:.3g} where the scenario has {:.3g} to {:.3g} {}; it is left "
        "out until its header or its numbers are mended",
        c.name, c.recorded_unit, unit, scale * p.read.minCoeff(), scale * p.read.maxCoeff(), scale * p.model.minCoeff(),
        scale * p.model.maxCoeff(), c.recorded_unit);
  }
  return std::nullopt;
}

}  // namespace

void leave_out_foreign_units(std::vector<MeasuredRun>& runs, const Twin& twin) {
  const double reference_C = twin.reference_K() - kZeroCelsius_K;
  Twin::Workspace workspace(twin);
  for (MeasuredRun& run : runs) {
    const Eigen::MatrixXd prediction = twin.readings(twin.as_written(), run, workspace);
    const bool may_be_turned = temperatures_follow(run, prediction);
    std::string why;
    std::erase_if(run.channels, [&](const MeasuredChannel& c) {
      const Pairs p = pairs_of(c, prediction);
      if (p.read.size() < 3) return false;
      const auto what = c.unit == "K" ? temperature_finding(c, p, reference_C) : displacement_finding(c, p, may_be_turned);
      if (!what) return false;
      run.findings.push_back({c.name, *what, true});
      why += "; " + *what;
      return true;
    });
    if (run.channels.empty()) throw InputError(fmt::format("{}: no channel to compare{}", run.path, why));
  }
}

}  // namespace driftwright::diagnosis
