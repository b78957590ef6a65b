#include "diagnosis/discrepancy.hpp"

#include <cmath>
#include <set>

#include "effects/reading_chain.hpp"
#include "effects/recorded_column.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr int kPoles = 4;
constexpr double kRowsOfShortest = 3.0, kShortest = 0.003, kLongest = 1.0 / 3.0;  // as in identification
constexpr double kExponent = 5.0 / 3.0;

std::vector<double> poles_s(const std::vector<MeasuredRun>& runs) {
  double longest_s = 0.0;
  for (const MeasuredRun& r : runs) longest_s = std::max(longest_s, r.time_s.back());
  const double from = std::log(std::max(kRowsOfShortest * shortest_row_s(runs), kShortest * longest_s)),
               to = std::log(kLongest * longest_s);
  std::vector<double> tau_s;
  for (int k = 0; k < kPoles; ++k) tau_s.push_back(std::exp(from + (k + 0.5) / kPoles * (to - from)));
  return tau_s;
}

using Course = std::vector<Eigen::RowVectorXd>;  ///< one row per run

}  // namespace

std::vector<Prediction> discrepancy_columns(const std::vector<MeasuredRun>& runs, Eigen::Index n_outputs,
                                            const std::map<std::string, OutputError>& errors) {
  std::vector<Course> courses;
  const auto add = [&](Course course) {
    double squares = 0.0, n = 0.0;
    for (const auto& row : course) {
      squares += row.squaredNorm();
      n += static_cast<double>(row.size());
    }
    const double rms = std::sqrt(squares / n);
    if (!(rms > 0.0)) return;
    for (auto& row : course) row /= rms;
    courses.push_back(std::move(course));
  };
  std::set<std::string> columns;
  for (const MeasuredRun& run : runs) {
    for (const Cyclogram::Column& c : run.cyclogram.columns) columns.insert(c.name);
  }
  for (double tau_s : poles_s(runs)) {
    const auto of_drive = [&](const std::string& column, const std::function<double(const Drive&)>& u) {
      Course course;
      for (const MeasuredRun& run : runs)
        course.push_back(effects::driven(
            run.time_s, column.empty() ? run.cyclogram : effects::with_signal(run.cyclogram, column, 0.0), u, tau_s));
      add(std::move(course));
    };
    of_drive("", [](const Drive& d) { return d.speed_rpm > 0.0 ? 1.0 : 0.0; });
    of_drive("", [](const Drive& d) { return std::pow(d.speed_rpm, kExponent); });
    of_drive("", [](const Drive& d) { return d.cutting_power_W; });
    for (const std::string& column : columns)
      of_drive(column, [signal = effects::signal_of(column, 0.0)](const Drive& d) { return signal(d).value_or(0.0); });
    Course ambient;
    for (const MeasuredRun& run : runs) {
      Eigen::RowVectorXd row(static_cast<Eigen::Index>(run.time_s.size()));
      for (Eigen::Index i = 0; i < row.size(); ++i)
        row[i] = run.ambient.at(run.time_s[static_cast<std::size_t>(i)]) - run.ambient.at(0.0);
      effects::lag_behind(row, run.time_s, tau_s);
      ambient.push_back(std::move(row));
    }
    add(std::move(ambient));
    for (std::size_t r = 0; r < runs.size(); ++r) {  // the temperature at a record's start
      Course start;
      for (const MeasuredRun& run : runs)
        start.push_back(Eigen::RowVectorXd::Zero(static_cast<Eigen::Index>(run.time_s.size())));
      for (Eigen::Index i = 0; i < start[r].size(); ++i)
        start[r][i] = std::exp(-runs[r].time_s[static_cast<std::size_t>(i)] / tau_s);
      add(std::move(start));
    }
  }
  std::map<int, double> sizes;  // by output
  for (const MeasuredRun& run : runs) {
    for (const MeasuredChannel& c : run.channels) {
      if (errors.contains(c.name)) sizes[c.output] = errors.at(c.name).rms;
    }
  }
  std::vector<Prediction> list;
  for (const auto& [output, size] : sizes) {
    for (const Course& course : courses) {
      Prediction column;
      for (const auto& row : course) {
        column.push_back(Eigen::MatrixXd::Zero(n_outputs, row.size()));
        column.back().row(output) = size * row;
      }
      list.push_back(std::move(column));
    }
  }
  return list;
}

}  // namespace driftwright::diagnosis
