#include "studies/sweep_run.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <atomic>
#include <exception>
#include <map>
#include <mutex>

#include "base/csv_row.hpp"
#include "machine/machine_key.hpp"
#include "machine/model.hpp"
#include "scenarios/reader/felt_run.hpp"
#include "studies/sweep_member.hpp"

namespace driftwright::studies {
namespace {

using scenarios::Machine, scenarios::Scenario, scenarios::Shared, scenarios::SweepPlan;

/// Calls `work`; stores a failure of the member in its outcome, and passes all other exceptions on.
template <class Work>
void catching(MemberOutcome& outcome, const Work& work) {
  try {
    work();
  } catch (const InputError& e) {
    outcome.failure = e.what();
    outcome.is_refused = true;
  } catch (const RangeError& e) {
    outcome.failure = e.what();
    outcome.is_refused = true;
  } catch (const SolveError& e) {
    outcome.failure = e.what();
  }
}

/// The data that the members of a group share.
struct Structure {
  mesh::Mesh mesh;
  Eigen::MatrixXd influence;
  std::unique_ptr<const Machine> machine;  ///< if they share all of it
};

/// The factor of an elastic stiffness may take half of the memory (solver/elasticity.cpp), so only one may exist at a
/// time.
std::mutex& large_factor() {
  static std::mutex one_at_a_time;
  return one_at_a_time;
}

/// Reduced machines, made when the first member needs one. Each spans the laws of all members of the plan, whichever
/// members run here, so that shards and resumed sweeps give the same numbers.
class ReducedMachines {
 public:
  explicit ReducedMachines(const SweepPlan& plan) {
    for (std::size_t member = 0; member < plan.n_members; ++member) {
      MemberOutcome passed_over;  // it will report its error when it runs
      catching(passed_over, [&] { ask(scenarios::read_scenario(plan.scenario_of(member))); });
    }
  }
  /// Whether some member runs on finite elements.
  [[nodiscard]] bool some_are_full() const { return some_are_full_; }

  /// The machine of a member. If no common basis is possible (one member cannot lose its heat), each member gets its own.
  std::shared_ptr<const scenarios::ReducedMachine> of(const Scenario& scenario) {
    const std::lock_guard lock(mutex_);  // also for its own basis: members of one machine keep it in one folder
    Asked& asked = by_machine_.at(scenarios::machine_text(*scenario.machine));
    const std::lock_guard large(large_factor());
    const Listener quiet;
    if (!asked.machine && !asked.failed) {
      try {
        asked.machine =
            std::make_shared<const scenarios::ReducedMachine>(scenarios::open_reduced(asked.model, asked.plan, quiet));
      } catch (const std::exception&) {  // the faulty member will report it
        asked.failed = true;
      }
    }
    if (asked.machine) return asked.machine;
    return std::make_shared<const scenarios::ReducedMachine>(
        scenarios::open_reduced(*scenario.machine, plan_of(scenario), quiet));
  }

 private:
  struct Asked {
    scenarios::MachineModel model;
    scenarios::ReductionPlan plan;
    std::shared_ptr<const scenarios::ReducedMachine> machine = {};
    bool failed = false;
  };
  static scenarios::ReductionPlan plan_of(const Scenario& scenario) {
    std::vector<const Cyclogram*> cyclograms;
    for (const Cyclogram& c : scenario.cyclograms) cyclograms.push_back(&c);
    scenarios::ReductionPlan plan = scenarios::reduction_plan(scenario, cyclograms);
    plan.n_modes = 0;
    plan.with_fields = false;
    return plan;
  }
  void ask(const Scenario& scenario) {
    if (scenario.solver.model != scenarios::ModelKind::kReduced) {
      some_are_full_ = true;
      return;
    }
    const scenarios::ReductionPlan plan = plan_of(scenario);
    const auto [found, is_new] =
        by_machine_.try_emplace(scenarios::machine_text(*scenario.machine), Asked{*scenario.machine, plan});
    if (is_new) return;
    found->second.plan.demand.include(plan.demand);
    found->second.plan.tolerance_K = std::min(found->second.plan.tolerance_K, plan.tolerance_K);
  }

  std::map<std::string, Asked> by_machine_;  ///< by machine_text()
  bool some_are_full_ = false;
  std::mutex mutex_;
};

/// Made from the first member that can be read and placed; if none can, each member reports its own error.
Structure build_structure(const SweepPlan& plan, ReducedMachines& reduced, std::span<const std::size_t> members,
                          bool with_machine) {
  Structure shared;
  if (!reduced.some_are_full()) return shared;
  bool is_meshed = false;
  for (const std::size_t member : members) {
    std::optional<Scenario> scenario;
    MemberOutcome passed_over;
    catching(passed_over, [&] { scenario = scenarios::read_scenario(plan.scenario_of(member)); });
    if (!scenario) continue;
    const scenarios::MachineModel& model = *scenario->machine;
    if (scenario->solver.model == scenarios::ModelKind::kReduced) continue;
    if (!is_meshed) shared.mesh = scenarios::build_mesh(model.mesh);
    is_meshed = true;
    std::optional<scenarios::PlacedMachine> placed;
    catching(passed_over, [&] { placed = scenarios::place(model, shared.mesh); });
    if (!placed) continue;
    {
      const std::lock_guard large(large_factor());
      shared.influence = scenarios::influences(model, *placed);
    }
    if (with_machine)
      shared.machine =
          std::make_unique<const Machine>(scenarios::build_with_influences(model, std::move(*placed), shared.influence));
    break;
  }
  return shared;
}

/// The machine that a thread built last.
struct LastMachine {
  std::string key;
  std::optional<Machine> machine;
};

std::vector<double> run_member(const SweepPlan& plan, std::size_t member, ReducedMachines& reduced, const Structure& shared,
                               LastMachine& last) {
  const Scenario scenario = scenarios::read_scenario(plan.scenario_of(member));
  scenarios::require_nothing_before(*scenario.machine, "sweep");
  if (scenario.solver.model == scenarios::ModelKind::kReduced) {
    return simulate_member(scenario, *reduced.of(scenario), plan.collect);
  }
  if (shared.machine) return simulate_member(scenario, *shared.machine, plan.collect);
  const std::string key = scenarios::sharing_key(plan, member, Shared::kMachine);
  if (!last.machine || last.key != key) {
    last.machine.reset();
    last.machine.emplace(scenarios::build_with_influences(
        *scenario.machine, scenarios::place(*scenario.machine, shared.mesh), shared.influence));
    last.key = key;
  }
  return simulate_member(scenario, *last.machine, plan.collect);
}

/// Reports outcomes one at a time; keeps the first exception that belongs to no member, after which no more work starts.
class Collector {
 public:
  explicit Collector(const std::function<void(const MemberOutcome&)>& done) : done_(done) {}

  [[nodiscard]] bool has_stopped() const { return stopped_; }
  void report(const MemberOutcome& outcome) {
    const std::lock_guard lock(mutex_);
    if (!stopped_) done_(outcome);
  }
  void stop(std::exception_ptr why) {
    const std::lock_guard lock(mutex_);
    if (!stopped_) why_ = std::move(why);
    stopped_ = true;
  }
  void rethrow() const {
    if (why_) std::rethrow_exception(why_);
  }

 private:
  const std::function<void(const MemberOutcome&)>& done_;
  std::mutex mutex_;
  std::atomic<bool> stopped_ = false;
  std::exception_ptr why_;
};

/// Runs the members of one structure, in parallel unless several groups already run in parallel.
void run_group(const SweepPlan& plan, ReducedMachines& reduced, std::span<const std::size_t> members, Collector& collector) {
  const std::string first_key = scenarios::sharing_key(plan, members.front(), Shared::kMachine);
  const bool one_machine = std::all_of(members.begin(), members.end(), [&](std::size_t m) {
    return scenarios::sharing_key(plan, m, Shared::kMachine) == first_key;
  });
  Structure shared;
  MemberOutcome of_all;
  catching(of_all, [&] { shared = build_structure(plan, reduced, members, one_machine); });
#pragma omp parallel if (members.size() > 1)
  {
    LastMachine last;
#pragma omp for schedule(dynamic, 1)
    for (std::size_t i = 0; i < members.size(); ++i) {
      if (collector.has_stopped()) continue;
      try {
        MemberOutcome outcome = of_all;
        outcome.member = members[i];
        if (outcome.failure.empty())
          catching(outcome, [&] { outcome.results = run_member(plan, members[i], reduced, shared, last); });
        collector.report(outcome);
      } catch (...) {
        collector.stop(std::current_exception());  // no exception may leave the parallel loop
      }
    }
  }
}

}  // namespace

std::string table_row(const SweepPlan& plan, const MemberOutcome& outcome) {
  std::string row = std::to_string(outcome.member + 1);
  for (std::size_t i = 0; i < plan.variations.size(); ++i)
    row += fmt::format(",{}", csv_cell(plan.value(outcome.member, i).label));
  for (std::size_t i = 0; i < plan.collect.size(); ++i)
    row += outcome.failure.empty() ? fmt::format(",{:.7g}", outcome.results[i]) : ",";
  if (outcome.failure.empty()) return row + ",done";
  const std::string message = outcome.failure.substr(0, outcome.failure.find('\n'));  // without the quoted line of the file
  return fmt::format("{},{}", row, csv_cell((outcome.is_refused ? "refused: " : "gave up: ") + message));
}

bool is_done(const std::string& row) {
  return row.ends_with(",done");
}

void run_members(const SweepPlan& plan, const std::vector<std::size_t>& members,
                 const std::function<void(const MemberOutcome&)>& done) {
  std::vector<std::span<const std::size_t>> groups;
  std::string last_key;
  for (std::size_t i = 0, begin = 0; i < members.size(); ++i) {
    std::string key = scenarios::sharing_key(plan, members[i], Shared::kStructure);
    if (i > 0 && key == last_key) {
      groups.back() = std::span(members).subspan(begin, i + 1 - begin);
    } else {
      begin = i;
      groups.push_back(std::span(members).subspan(i, 1));
    }
    last_key = std::move(key);
  }
  ReducedMachines reduced(plan);
  Collector collector(done);
  // Either groups run in parallel, or the members of one group. Within a member all loops then stay on its core, since
  // OpenMP opens no team inside a team.
#pragma omp parallel for schedule(dynamic, 1) if (groups.size() >= static_cast <std::size_t>(omp_get_max_threads()))
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (collector.has_stopped()) continue;
    try {
      run_group(plan, reduced, groups[g], collector);
    } catch (...) {
      collector.stop(std::current_exception());
    }
  }
  collector.rethrow();
}

}  // namespace driftwright::studies
