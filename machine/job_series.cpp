#include "machine/job_series.hpp"

#include "machine/machine.hpp"
#include "machine/run_record.hpp"

namespace driftwright::scenarios {
namespace {

/// Appends stretches of time one after the other.
class SeriesWriter {
 public:
  SeriesWriter(JobSeries& series, double interval_s) : series_(series), interval_s_(interval_s) {}

  /// @returns its rows
  PartRows add(const std::vector<Cyclogram::Section>& sections) {
    const double start_s = end_s_;
    const std::vector<double> local_s = output_times_s({.name = "", .sections = sections}, interval_s_);
    for (const Cyclogram::Section& section : sections) {
      series_.cyclogram.sections.push_back(section);
      // The same sum as of the cyclogram itself, so that the last row is its end to the last bit.
      end_s_ += section.duration_s;
    }
    std::vector<double>& time_s = series_.time_s;
    if (time_s.empty()) time_s.push_back(start_s);
    PartRows rows{.first = time_s.size() - 1};
    for (std::size_t i = 1; i + 1 < local_s.size(); ++i) {
      if (start_s + local_s[i] > time_s.back() && start_s + local_s[i] < end_s_) time_s.push_back(start_s + local_s[i]);
    }
    time_s.push_back(end_s_);
    rows.last = time_s.size() - 1;
    return rows;
  }

  void add_rest(double duration_s) {
    if (duration_s > 0.0) (void)add({{duration_s, Drive{}}});
  }

 private:
  JobSeries& series_;
  double interval_s_;
  double end_s_ = 0.0;
};

TimeSeries continued(const TimeSeries& run, double end_s, const TimeSeries& scenario) {
  TimeSeries ambient;
  for (std::size_t i = 0; i < run.time_s.size() && run.time_s[i] < end_s; ++i) {
    ambient.time_s.push_back(run.time_s[i]);
    ambient.value.push_back(run.value[i]);
  }
  const double offset_K = run.at(end_s) - scenario.at(end_s);
  ambient.time_s.push_back(end_s);
  ambient.value.push_back(run.at(end_s));
  for (std::size_t i = 0; i < scenario.time_s.size(); ++i) {
    if (!(scenario.time_s[i] > end_s)) continue;
    ambient.time_s.push_back(scenario.time_s[i]);
    ambient.value.push_back(scenario.value[i] + offset_K);
  }
  return ambient;
}

}  // namespace

JobSeries job_series(const Cyclogram& job, const JobOrder& order, const TimeSeries& scenario_ambient, double interval_s) {
  JobSeries series{.cyclogram = {.name = job.name, .sections = {}}, .ambient = scenario_ambient, .time_s = {}, .parts = {}};
  SeriesWriter writer(series, interval_s);
  if (order.start) {
    (void)writer.add(order.start->cyclogram.sections);
    if (order.start->has_recorded_ambient())
      series.ambient = continued(order.start->ambient, series.time_s.back(), scenario_ambient);
  }
  writer.add_rest(order.pause_s);
  for (int part = 0; part < order.n_parts; ++part) {
    if (part > 0) writer.add_rest(order.between_s);
    series.parts.push_back(writer.add(job.sections));
  }
  return series;
}

}  // namespace driftwright::scenarios
