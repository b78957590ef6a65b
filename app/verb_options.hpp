#pragma once
// The verbs of the command line: each function adds one to the parser, with its options and what it calls. The options must
// outlive the parser. The order of calls is that of the help.

#include "app/follow.hpp"
#include "app/verbs.hpp"

namespace CLI {
class App;
}

namespace driftwright::app {

// scenario_verbs.cpp, record_verbs.cpp, machine_verbs.cpp
void add_run(CLI::App& cli, CommonOptions& options);
void add_check(CLI::App& cli, CommonOptions& options);
void add_mesh(CLI::App& cli, MeshOptions& options);
void add_init(CLI::App& cli, InitOptions& options);
void add_simulate(CLI::App& cli, SimulateOptions& options);
void add_predict(CLI::App& cli, PredictOptions& options);
void add_warmup(CLI::App& cli, WarmUpVerbOptions& options);
void add_place(CLI::App& cli, PlaceOptions& options);
void add_plan_test(CLI::App& cli, PlanTestOptions& options);
void add_probe_plan(CLI::App& cli, ProbePlanOptions& options);
void add_schedule(CLI::App& cli, ScheduleVerbOptions& options);
void add_sweep(CLI::App& cli, SweepOptions& options);
void add_select(CLI::App& cli, RecordOptions& options);
void add_validate(CLI::App& cli, RecordOptions& options);
void add_compensate(CLI::App& cli, CompensateOptions& options);
void add_calibrate(CLI::App& cli, CalibrateOptions& options);
void add_diagnose(CLI::App& cli, DiagnoseOptions& options);
void add_compare(CLI::App& cli, CompareOptions& options);
void add_import(CLI::App& cli, ImportOptions& options);
void add_identify(CLI::App& cli, IdentifyOptions& options);
void add_inject(CLI::App& cli, InjectOptions& options);
void add_follow(CLI::App& cli, FollowVerbOptions& options);
void add_export(CLI::App& cli, ExportOptions& options);
void add_view(CLI::App& cli, ViewOptions& options);

}  // namespace driftwright::app
