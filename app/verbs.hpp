#pragma once
// The verbs of the command line, one file each. Every one throws InputError, SolveError or another exception; main() turns
// them into exit codes.

#include <optional>
#include <string>
#include <vector>

#include "studies/record_study.hpp"

namespace driftwright::app {

/// Options of all verbs.
struct CommonOptions {
  std::string scenario;
  std::string out;       ///< folder of results; empty: results/<name of the scenario>
  bool force = false;    ///< replace a folder that holds other files too
  bool json = false;     ///< print the JSON document in place of text
  bool quiet = false;    ///< print no results, show no progress
  bool details = false;  ///< print all tables
  bool strict = false;   ///< refuse numbers that no machine has (base/usual_ranges.hpp)
};

/// Options of verbs whose work several processes may share.
struct ShardOptions {
  std::string shard;   ///< "i/n", or empty for all
  bool merge = false;  ///< only merge what shards have computed
};

void run(const CommonOptions& options);
void check(const CommonOptions& options);

struct MeshOptions : CommonOptions {  ///< `scenario` may be a mesh or a drawing, too
  std::string units;                  ///< length unit of a mesh file: mm, cm, m, inch; empty: guessed from its size
  bool convergence = false;           ///< run a cyclogram on three meshes
  std::string cyclogram;              ///< with convergence: as in PredictOptions; empty: the first of the scenario
  int most_elements = 30000;          ///< with convergence: of a mesh that is finer than the scenario's
};
void mesh(const MeshOptions& options);

struct InitOptions {
  std::string folder;           ///< to create; its last part names the scenario
  std::string from = "lumped";  ///< or a mesh or drawing
  std::string units;            ///< as in MeshOptions
};
/// Writes a first scenario, with comments, that runs as it is.
void init(const InitOptions& options);

struct SimulateOptions : CommonOptions {
  std::vector<std::string> cyclograms;  ///< names, or record CSVs; empty: all of the scenario
  std::vector<std::string> pose;        ///< positions of axes, "x=200mm"; empty: those of the scenario
  bool distributed = false;             ///< the finite elements over the processes of mpirun
};
void simulate(const SimulateOptions& options);

struct PredictOptions : CommonOptions {
  std::string cyclogram;    ///< a name of the scenario, or a record CSV (scenarios/reader/read_cyclogram.hpp)
  std::string start;        ///< what the machine did before, a record CSV or a cyclogram of the scenario; empty: its start
  std::string after_pause;  ///< pause between `start` and the cyclogram, such as "30 min"; empty: none
  std::string model;        ///< reduced, full; empty: predicting_model() of studies/prediction.hpp
};
void predict(const PredictOptions& options);

struct WarmUpVerbOptions : CommonOptions {
  std::string then;                   ///< the job: a cyclogram of the scenario, a record CSV or an NC program
  std::string tolerance;              ///< such as "10 um"; empty: the study's, else 10 um
  std::string margin;                 ///< share of the tolerance that is kept free, such as "20 %"; empty: none
  std::string model_error;            ///< such as "20 %"; the margin then follows from it; empty: none
  std::string power_limit;            ///< limit of the heat that a speed causes, such as "150 W"; empty: none
  std::string speed_limit;            ///< such as "3000 rpm"; empty: the fastest of the scenario and the job
  std::string time_limit;             ///< such as "2 h"; empty: 4 h
  std::vector<std::string> channels;  ///< displacements; empty: all
  std::string start;                  ///< `start` to `model`: as in PredictOptions
  std::string after_pause;
  std::string model;
};
/// Finds the shortest warm-up after which a job stays within a tolerance.
void warmup(const WarmUpVerbOptions& options);

struct PlaceOptions : CommonOptions, ShardOptions {
  std::optional<int> count;              ///< thermometers to place; none: the study's, else 4
  std::optional<int> points;             ///< candidate points on a mesh; none: 400
  std::vector<std::string> regions;      ///< that may carry them; empty: all
  std::vector<std::string> excluded;     ///< regions that may not
  std::vector<std::string> mounted;      ///< sensors of the scenario that are there already
  std::vector<std::string> channels;     ///< displacements; empty: the study's target, else all
  std::vector<std::string> train, test;  ///< cyclograms to choose on and to judge by
  std::string placed_for = "both";       ///< or observer, regression
  bool none_fails = false;               ///< judge only the case in which all thermometers work
  std::string noise;                     ///< of a reading, such as "0.1 K"; empty: the scenario's, else 0.1 K
};
/// Finds the places where thermometers predict the drift best.
void place(const PlaceOptions& options);

struct PlanTestOptions : CommonOptions, ShardOptions {
  std::string time;         ///< such as "8 h", which is also the default for empty
  std::string speed_limit;  ///< such as "3000 rpm"; empty: the fastest of the scenario
  std::string interval;     ///< of rows, such as "30 s"; empty: the scenario's
  std::string noise_K;      ///< of a thermometer's reading; empty: "0.05 K"
  std::string noise_um;     ///< of a displacement's reading; empty: "0.5 um"
  int n_programmes = 0;     ///< 0: 10000, fewer for large machines
  unsigned seed = 1;
};
/// Plans the test programme after which a diagnosis would name most effects, before anything is measured.
void plan_test(const PlanTestOptions& options);

struct ProbePlanOptions : CommonOptions {
  std::string job;                               ///< a cyclogram of the scenario, a record CSV or an NC program
  std::string model;                             ///< a predictor's file of `validate`
  std::string tolerance;                         ///< such as "10 um"; empty: the study's, else 10 um
  std::string margin;                            ///< share of the tolerance that is kept free, such as "50 %"; empty: none
  std::string noise, lag;                        ///< of the probe; empty: the file's
  std::string probing_time;                      ///< time of a probing, such as "2 min", which is also the default for empty
  int parts = 1;                                 ///< number of times that the job is done
  std::string between;                           ///< rest between two of them, such as "2 min"; empty: none
  std::string gauge;                             ///< "100 mm, 50 mm, -20 mm", machine coordinates; empty: no touch cycle
  std::string touch = "z";                       ///< the axis that touches it: z, x+, x-, y+, y-
  int probe_tool = 0;                            ///< number of the probe in the tool table; required with `gauge`
  std::vector<std::string> points;               ///< record CSVs with errors of points; empty: no choice of points
  std::vector<std::string> may_probe, counting;  ///< displacements of these records; empty: all
};
/// Plans the fewest probings that keep what a correction leaves within a tolerance during a job.
void probe_plan(const ProbePlanOptions& options);

struct ScheduleVerbOptions : CommonOptions {
  std::string program;  ///< NC program
  std::string policy;   ///< empty: the scenario's
  std::string dialect;  ///< empty: the scenario's
  bool split = false;   ///< divide blocks that cannot keep the tolerance
  bool beyond = false;  ///< also plan beyond the limits of the machine, where corrections are then held
  std::string start;    ///< `start` to `model`: as in PredictOptions
  std::string after_pause;
  std::string model;
  int parts = 0;        ///< parts that the program makes one after another; 0: as many as the scenario says
  std::string between;  ///< pause between two parts, such as "2 min"; empty: the scenario's
};
void schedule(const ScheduleVerbOptions& options);

struct InjectOptions {
  std::string correction;        ///< table, FIFO or /dev/fd/N (compensation/injector/correction_input.hpp)
  std::string unit = "um";       ///< of numbers from a pipe: um or count
  std::string period;            ///< travel of one signal period, "4 um"; empty: corrections are in counts
  std::string limit;             ///< largest correction by size, "50 um"; empty: none
  std::string row_time;          ///< time of a row, "1 ms"; empty: corrections are by row
  std::string counts = "x4";     ///< how the control counts: x4, x2, x1
  std::string insert = "cycle";  ///< cycle, half, quarter
  bool anywhere = false;         ///< insert also while a line is high
  bool bypass = false;
  std::string column;                    ///< of a table with several columns, or axis of lines from `follow`
  std::string on_fault = "hold";         ///< for an invalid row or correction: hold, or bypass
  bool strict = false;                   ///< an invalid row or correction ends the run
  bool clocked = false;                  ///< one row out for each row in
  int separation = 1;                    ///< least rows between two edges, with `clocked`
  int interval = 1;                      ///< least rows between two insertions, with `clocked`
  std::string vcd, halstream, hal, log;  ///< files beside standard output
};
void inject(const InjectOptions& options);

/// `run` of a scenario with a table.
void run_table(const CommonOptions& options, const scenarios::Scenario& scenario);
/// `run` of a scenario with a volume.
void run_volume(const CommonOptions& options, const scenarios::Scenario& scenario);

struct RecordOptions : CommonOptions, studies::RecordPaths {
  std::string target;                  ///< displacement of the records; empty: that of the scenario's `study`
  std::string probe;                   ///< times between two probings, "60 min, 4 h"; empty: the axis is not probed
  std::string probe_noise = "1 um";    ///< of a probing, 1 sigma
  std::string probing_time = "2 min";  ///< that a probing takes
};
void select(const RecordOptions& options);
void validate(const RecordOptions& options);

struct CompensateOptions : CommonOptions {
  std::string model;        ///< a predictor's file of `validate`, or modes; through the frame modes, observer, regression
  std::string through;      ///< none, injector, schedule, frame
  std::string cyclogram;    ///< name; empty: the one that the study judges by
  std::string measured;     ///< a record CSV in place of a simulation; empty: simulate
  std::string after;        ///< with `measured`: the record that it continues; empty: none
  std::string probe;        ///< time between probings of the corrected axis; empty: not probed
  std::string probe_noise;  ///< of a probing, 1 sigma; empty: that of the model's file
};
void compensate(const CompensateOptions& options);

struct DiagnoseOptions : CommonOptions {
  std::vector<std::string> measured;  ///< record CSVs
  std::vector<std::string> without;   ///< catalogue keys that are not searched for
  bool causes_only = false;           ///< leave the scenario's own numbers in extended.yaml as they are
  bool as_recorded = false;           ///< go on with records that have a blunder
};
void diagnose(const DiagnoseOptions& options);

struct ListOptions {
  std::string what = "effects";  ///< materials, scenarios, joints, cyclograms
  std::string of;                ///< scenario, of joints and cyclograms; folder, of scenarios; empty: scenarios/
  bool markdown = false;         ///< effects with places, keys and laws, as docs/reference/effects.md has them
};
/// Prints the available choices.
void list(const ListOptions& options);

struct SchemaOptions {
  std::string what = "scenario";  ///< or "sweep", "diagnosis", "calibration"
  bool markdown =
      false;  ///< tables, as docs/reference/scenario.md, docs/reference/sweep.md and docs/reference/diagnosis.md have them
};
/// Prints what a file may hold, as JSON Schema.
void schema(const SchemaOptions& options);

struct CalibrateOptions : CommonOptions {
  std::vector<std::string> measured;  ///< record CSVs
  bool as_recorded = false;           ///< go on with records that have a blunder
};
void calibrate(const CalibrateOptions& options);

struct ImportOptions : CommonOptions {  ///< `scenario` is the logger's file
  std::string by;                       ///< YAML with the key `columns`; empty: guessed
  std::string zone, interval, every;    ///< hints for the guess (base/guess_columns.hpp)
  std::vector<std::string> units;       ///< "t1=degC"
};
/// Writes a logger's file as a record.
void import_file(const ImportOptions& options);

struct IdentifyOptions : CommonOptions {  ///< `scenario` is the first record
  std::vector<std::string> records;
  std::string ambient;              ///< channel; empty: guessed
  std::vector<std::string> drives;  ///< channels that drive the machine, in addition to those recognised by their unit
  std::vector<std::string> units;   ///< of columns of logger files, "t1=degC"
  std::string prior;                ///< scenario to extend; empty: none
  bool as_recorded = false;         ///< with `prior`: go on with records that have a blunder
};
/// Identifies a network from records alone, or fits what a scenario does not explain, beside it.
void identify(const IdentifyOptions& options);

struct CompareOptions : CommonOptions {
  std::string first, second;  ///< record CSVs, or folders of results that hold a record.csv
};
/// Compares two records.
void compare(const CompareOptions& options);

struct ExportOptions {
  std::string scenario;  ///< empty: a formula of `model` is exported
  std::string out;       ///< file; empty: results/<name of the scenario>.fmu. With `as` a folder
  bool fmu = false;
  std::string as;                    ///< for a control: text, c, linuxcnc, st, siemens, heidenhain, fanuc; empty: none
  std::string axis;                  ///< of siemens, heidenhain, fanuc: X, Y, Z, ...
  std::string axis_moves = "by_dk";  ///< siemens: or against_dk
  int fmi = 2;                       ///< version of the standard, 2 or 3
  std::string of = "machine";        ///< or observer
  std::string type = "both";         ///< interfaces: both, me (model exchange), cs (co-simulation)
  /// Files of predictors: an observer, with `of` = observer; or, without a scenario, a formula, or one for each of several
  /// places of an axis' travel.
  std::vector<std::string> models;
};
void export_model(const ExportOptions& options);

struct ViewOptions {
  std::string scenario;   ///< with `pick` it may be a mesh or a drawing, too
  std::string out;        ///< file; empty: results/<name of the scenario>.html, with `pick` <name>_pick.html
  std::string cyclogram;  ///< with which the page begins; empty: the one that the study judges by, else the first
  bool pick = false;      ///< write a page for picking faces and points
  std::string units;      ///< with `pick`: as in MeshOptions
};
/// Writes a page in which a machine runs, or one for picking.
void view(const ViewOptions& options);

struct SweepOptions : CommonOptions, ShardOptions {};  ///< `scenario` is the study
void sweep(const SweepOptions& options);

}  // namespace driftwright::app
