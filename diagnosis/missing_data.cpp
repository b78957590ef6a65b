#include "diagnosis/missing_data.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace driftwright::diagnosis {
namespace {

constexpr double kRow_min = 10.0;   // interval of rows: four of them in 40 min, where machine and noise differ
constexpr double kSettlings = 2.0;  // length of a record, in settling times
constexpr double kHour_s = 3600.0, kLongest_h = 400.0;

std::string plural(std::size_t n, const std::string& what) {
  return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
}

}  // namespace

Eigen::Index readings_of(const std::vector<MeasuredRun>& runs) {
  Eigen::Index n = 0;
  for (const MeasuredRun& run : runs) {
    for (const MeasuredChannel& c : run.channels) n += (c.value.array() == c.value.array()).count();
  }
  return n;
}

std::vector<DataFinding> data_findings(const std::vector<MeasuredRun>& runs) {
  std::vector<DataFinding> findings;
  for (const MeasuredRun& run : runs) {
    for (const DataFinding& f : run.findings)
      findings.push_back({f.channel, runs.size() > 1 ? run.name + ": " + f.what : f.what, f.leaves_out});
  }
  return findings;
}

double settling_time_s(const Twin& twin, const MeasuredRun& run) {
  MeasuredRun rest;
  rest.name = run.name;
  for (double t_h = 0.0; t_h <= kLongest_h; t_h = t_h * 1.1 + 0.02) rest.time_s.push_back(kHour_s * t_h);
  rest.cyclogram = {.name = run.name, .sections = {{rest.time_s.back(), {}}}};
  rest.grid_s = rest.time_s;
  for (std::size_t i = 0; i < rest.time_s.size(); ++i) rest.row_in_grid.push_back(static_cast<Eigen::Index>(i));
  rest.ambient = {{0.0}, {run.ambient.value.front()}};
  Twin::Workspace workspace(twin);
  const Eigen::MatrixXd cold = twin.respond(twin.as_written(), rest, workspace);
  rest.start_K = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(twin.machine().system.parts.size()));
  const Eigen::MatrixXd warm = twin.respond(twin.as_written(), rest, workspace);
  for (Eigen::Index k = 0; k < warm.cols(); ++k) {
    double farthest_K = 0.0;
    for (Eigen::Index o = 0; o < warm.rows(); ++o) {
      if (twin.outputs().unit[static_cast<std::size_t>(o)] == "K")
        farthest_K = std::max(farthest_K, std::abs(warm(o, k) - cold(o, k)));
    }
    if (farthest_K < std::exp(-1.0)) return rest.time_s[static_cast<std::size_t>(k)];
  }
  return rest.time_s.back();
}

std::string what_is_missing(const Twin& twin, const std::vector<MeasuredRun>& runs, int n_readings, int n_wanted) {
  std::set<std::string> recorded;
  std::set<double> speeds_rpm;
  std::vector<std::string> without_ambient;
  double row_min = 0.0;
  bool has_temperature = false;
  for (const MeasuredRun& run : runs) {
    for (const MeasuredChannel& c : run.channels) {
      recorded.insert(c.name);
      has_temperature = has_temperature || c.unit == "K";
    }
    for (const auto& s : run.cyclogram.sections) speeds_rpm.insert(s.drive.speed_rpm);
    if (!run.has_ambient) without_ambient.push_back(run.name);
    row_min = std::max(row_min, run.time_s.back() / 60.0 / static_cast<double>(run.time_s.size() - 1));
  }
  std::string text =
      fmt::format("{} of {} are too few to distinguish an effect from scatter; at least {} are required.",
                  plural(static_cast<std::size_t>(n_readings), "reading"), plural(recorded.size(), "channel"), n_wanted);
  const auto& model = twin.augmented().model;
  const std::size_t n_own = model.sensors.size() + model.displacements.size();
  std::vector<std::string> absent;
  for (std::size_t o = 0; o < std::min(n_own, twin.outputs().name.size()); ++o) {
    const bool is_ambient = twin.outputs().ambient[static_cast<Eigen::Index>(o)] == 1.0;
    if (!is_ambient && !recorded.contains(twin.outputs().name[o])) absent.push_back(twin.outputs().name[o]);
  }
  if (!absent.empty())
    text += fmt::format(" Of the scenario's channels the records do not hold {}.", fmt::join(absent, ", "));
  if (!has_temperature) {
    std::vector<std::string> bodies;
    for (const auto& part : twin.machine().system.parts) bodies.push_back(part.body);
    text += fmt::format(
        " No temperature of the machine is recorded: heat cannot be distinguished from expansion. Required: a thermometer "
        "on each of "
        "{} "
        "(under `sensors` in the scenario, a column NAME_degC in the record).",
        fmt::join(bodies, ", "));
  }
  if (!without_ambient.empty())
    text += fmt::format(" No ambient temperature (ambient_degC) in {}.", fmt::join(without_ambient, ", "));
  const bool is_heated = !twin.balance(twin.as_written()).heats.empty();
  if (is_heated && speeds_rpm.size() < 2) {
    text += fmt::format(
        " The spindle runs at {:g} rpm throughout: heat cannot be distinguished from what carries it off. Required: two "
        "speeds and a "
        "rest.",
        speeds_rpm.empty() ? 0.0 : *speeds_rpm.begin());
  }
  const double settles_h = settling_time_s(twin, runs.front()) / kHour_s;
  const std::size_t n_channels = std::max<std::size_t>(1, recorded.size() + absent.size());
  const double fills_h = n_wanted * kRow_min / 60.0 / static_cast<double>(n_channels);
  if (row_min > kRow_min)
    text += fmt::format(" A row comes every {:.0f} min; one every {:.0f} min is required.", row_min, kRow_min);
  text += fmt::format(" Required: {:.0f} h of it (the machine takes {:.2g} h to settle).",
                      std::ceil(std::max(fills_h, kSettlings * settles_h)), settles_h);
  return text;
}

}  // namespace driftwright::diagnosis
