#include "studies/probe_job.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/errors.hpp"

namespace driftwright::studies {
namespace {

/// One part: its places without the one at its start.
struct ProbedPart {
  double duration_s = 0.0;
  std::vector<WorkStretch> work = {};
  std::vector<ProbePlace> places = {};
};

ProbeJob series_of(const ProbedPart& part, const std::string& name, const ProbeJobOrder& order) {
  ProbeJob job{.name = name};
  double start_s = 0.0;
  for (int n = 1; n <= order.n_parts; ++n) {
    if (!job.places.empty() && job.places.back().time_s == start_s) job.places.pop_back();  // a rest ends the part before
    job.places.push_back(
        {.time_s = start_s, .where = n == 1 ? "before the job" : fmt::format("before part {}", n), .part = n});
    for (const WorkStretch& w : part.work) {
      const WorkStretch moved{start_s + w.from_s, start_s + w.until_s};
      if (!job.work.empty() && job.work.back().until_s == moved.from_s) {
        job.work.back().until_s = moved.until_s;
      } else {
        job.work.push_back(moved);
      }
    }
    for (ProbePlace place : part.places) {
      place.time_s += start_s;
      place.part = n;
      if (place.time_s > job.places.back().time_s) job.places.push_back(std::move(place));  // else it is the same place
    }
    start_s += part.duration_s + order.between_s;
  }
  std::erase_if(job.places, [&](const ProbePlace& p) { return p.time_s >= job.work.back().until_s; });
  return job;
}

}  // namespace

ProbeJob probe_job_of(const NcProgram& program, const std::string& name, const ProbeJobOrder& order) {
  ProbedPart part{.duration_s = program.duration_s()};
  if (!(part.duration_s > 0.0)) throw InputError(fmt::format("{}: the program takes no time; nothing drifts in it", name));
  part.work = {{0.0, part.duration_s}};
  for (const NcStep& step : program.steps) {
    if (!step.tool_change && !step.halts) continue;
    part.places.push_back(
        {.time_s = step.start_s, .where = step.tool_change ? "tool change" : "halt", .line = step.where.line});
  }
  return series_of(part, name, order);
}

ProbeJob probe_job_of(const Cyclogram& cyclogram, const ProbeJobOrder& order) {
  ProbedPart part{.duration_s = cyclogram.duration_s()};
  double start_s = 0.0;
  for (const Cyclogram::Section& section : cyclogram.sections) {
    const double end_s = start_s + section.duration_s;
    if (section.drive == Drive{}) {
      part.places.push_back({.time_s = end_s, .where = "after a rest"});
    } else if (!part.work.empty() && part.work.back().until_s == start_s) {
      part.work.back().until_s = end_s;
    } else {
      part.work.push_back({start_s, end_s});
    }
    start_s = end_s;
  }
  if (part.work.empty())
    throw InputError(fmt::format("cyclogram '{}': nothing is driven in it, so no tolerance must be kept", cyclogram.name));
  return series_of(part, cyclogram.name, order);
}

}  // namespace driftwright::studies
