#include "machine/job_series.hpp"

#include "machine/machine.hpp"
#include "machine/run_record.hpp"

namespace driftwright::scenarios {
namespace {

void add_row(TimeSeries& rows, double time_s, double value) {
  rows.time_s.push_back(time_s);
  rows.value.push_back(value);
}

/// Appends stretches of time one after the other.
class SeriesWriter {
 public:
  SeriesWriter(JobSeries& series, double interval_s) : series_(series), interval_s_(interval_s) {}

  /// @param stretch  has at least the columns of the series
  /// @returns its rows
  PartRows add(const Cyclogram& stretch) {
    const double start_s = end_s_;
    for (Cyclogram::Column& column : series_.cyclogram.columns) {
      const Cyclogram::Column& of_stretch = *stretch.column(column.name);
      add_row(column.rows, start_s, of_stretch.at(0.0));
      const TimeSeries& rows = of_stretch.rows;
      for (std::size_t i = 0; i < rows.time_s.size(); ++i) {
        if (rows.time_s[i] > 0.0 && rows.time_s[i] < stretch.duration_s())
          add_row(column.rows, start_s + rows.time_s[i], rows.value[i]);
      }
    }
    return add_sections(stretch.sections);
  }

  /// The axes stay where they are; all else that drives the machine is 0.
  void add_rest(double duration_s) {
    if (!(duration_s > 0.0)) return;
    for (Cyclogram::Column& column : series_.cyclogram.columns) {
      const double last = column.rows.value.empty() ? 0.0 : column.rows.value.back();
      add_row(column.rows, end_s_, column.unit == "mm" || column.unit == "deg" ? last : 0.0);
    }
    (void)add_sections({{duration_s, Drive{}}});
  }

 private:
  PartRows add_sections(const std::vector<Cyclogram::Section>& sections) {
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
  for (const Cyclogram::Column& column : job.columns) {
    if (!order.start || order.start->cyclogram.column(column.name))
      series.cyclogram.columns.push_back({column.name, column.unit, {}});
  }
  SeriesWriter writer(series, interval_s);
  if (order.start) {
    (void)writer.add(order.start->cyclogram);
    if (order.start->has_recorded_ambient())
      series.ambient = continued(order.start->ambient, series.time_s.back(), scenario_ambient);
  }
  writer.add_rest(order.pause_s);
  for (int part = 0; part < order.n_parts; ++part) {
    if (part > 0) writer.add_rest(order.between_s);
    series.parts.push_back(writer.add(job));
  }
  return series;
}

}  // namespace driftwright::scenarios
