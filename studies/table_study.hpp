#pragma once
// What `run` does with a scenario's `table:`: the table's errors over the run, and every correction of them through the frame.

#include "compensation/frames/ambient_models.hpp"
#include "compensation/frames/table_shift.hpp"
#include "machine/simulated_run.hpp"
#include "scenarios/reader/read_table.hpp"

namespace driftwright::studies {

/// Errors of a simulated run over the table, and at its rings.
struct TableRun {
  Record record;
  solver::Trajectory trajectory;
  compensation::TableErrors table;
  std::vector<Eigen::Matrix3Xd> rings_m;                 ///< errors there, a column a ring
  std::vector<double> table_only_x_um, scale_only_x_um;  ///< growth of table and scale from end to end of what is judged
};

/// Factors on expansions, for a model that has them wrong.
struct ExpansionFactors {
  double table = 1.0, scale_x = 1.0, scale_y = 1.0;
};

/// Errors over the table from a record with the displacements of its points (scenarios::table_displacements()) and its scales'
/// thermometers, simulated or predicted; docs/how-to/table.md has the formula. @throws InputError  for a channel that does not exist
[[nodiscard]] TableRun table_run(const scenarios::Scenario& scenario, scenarios::SimulatedRun run,
                                 const ExpansionFactors& factor = {});

/// A correction over the judged time, repeated with other noise and another wrong model.
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
  TableRun run;
  std::size_t n_judged = 0;               ///< times of the run that are judged, from the first on
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
