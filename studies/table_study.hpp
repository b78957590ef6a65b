#pragma once
// The study behind `run` of a scenario with `table`: the table's errors over the run, and each correction of them by the
// frame.

#include "compensation/frames/ambient_models.hpp"
#include "compensation/frames/table_shift.hpp"
#include "machine/simulated_run.hpp"
#include "scenarios/reader/read_table.hpp"

namespace driftwright::studies {

/// Errors over the table over time, and at its rings.
struct TableCourse {
  Record record;  ///< that they were computed from
  compensation::TableErrors table;
  std::vector<Eigen::Matrix3Xd> rings_m;                 ///< errors there, one column per ring
  std::vector<double> table_only_x_um, scale_only_x_um;  ///< growth of table and scale between the ends of the judged area
};

/// Factors on expansions, for a model with wrong expansions.
struct ExpansionFactors {
  double table = 1.0, scale_x = 1.0, scale_y = 1.0;
};

/// Errors over the table from a record with the displacements of its points (scenarios::table_displacements()) and its
/// scales' thermometers, simulated or predicted; docs/how-to/table.md has the formula. @throws InputError  for a channel
/// that does not exist
[[nodiscard]] TableCourse table_course(const scenarios::Scenario& scenario, Record record,
                                       const ExpansionFactors& factor = {});

/// A correction over the judged time, repeated with other noise and another scattered model.
struct TableStrategy {
  std::string name = {};
  compensation::PeakErrors peak = {};  ///< median of the repetitions
  compensation::PeakErrors worst = {};
  std::vector<double> course_um = {};  ///< largest position error on the table at each time, first repetition
};

struct IntervalRow {
  double every_s = 0.0;
  double rings_m = 0.0;    ///< largest position error, median
  double warmth_m = 0.0;   ///< the same with thermometers between measurements
  double carried_m = 0.0;  ///< the same with the model of the whole table between measurements
};

struct TableStudy {
  TableCourse course;
  std::size_t n_judged = 0;               ///< number of the course's times that are judged, from the first
  std::vector<TableStrategy> strategies;  ///< the first is none
  std::vector<IntervalRow> intervals;
  compensation::AxisTemperature control;
  compensation::TableFrame frame;  ///< of the last measurement of the judged time
  compensation::ProbeStudy probe;
  std::vector<compensation::AmbientModel> ambient_models;  ///< of the readings, in um
  double computed_rms_um = 0.0;                            ///< of the computed X against them
};

[[nodiscard]] TableStudy study_table(const scenarios::Scenario& scenario, const scenarios::Model& model,
                                     const Listener& listener, const scenarios::FieldSink& fields);

}  // namespace driftwright::studies
