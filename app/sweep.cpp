#include <fmt/format.h>

#include <algorithm>

#include "app/results.hpp"
#include "base/pieces.hpp"
#include "base/version.hpp"
#include "findings/sweep_document.hpp"
#include "output/rows_under_way.hpp"
#include "studies/sweep_run.hpp"

namespace driftwright::app {
namespace {

namespace fs = std::filesystem;
using output::NumberedRows;
using scenarios::SweepPlan;

std::string file_of(const Shard& shard) {
  return shard.is_all() ? "sweep.csv" : fmt::format("sweep.{}of{}.csv", shard.number, shard.of);
}

/// Simulates the missing members of `members` and adds them to `rows`.
void simulate_missing(const SweepPlan& plan, const std::vector<std::size_t>& members, output::RowsUnderWay& file,
                      NumberedRows& rows, Progress& progress) {
  constexpr std::size_t kMostTold = 10;
  std::vector<std::size_t> missing;
  std::copy_if(members.begin(), members.end(), std::back_inserter(missing),
               [&](std::size_t m) { return !rows.contains(m + 1); });
  const std::string work = fmt::format(
      "simulating {} members{}", missing.size(),
      missing.size() == members.size() ? "" : fmt::format(", {} are there already", members.size() - missing.size()));
  progress.begin(work);
  std::size_t n_done = 0, n_failed = 0;
  studies::run_members(plan, missing, [&](const studies::MemberOutcome& outcome) {
    const std::string row = studies::table_row(plan, outcome);
    file.append(row);
    rows.emplace(outcome.member + 1, row);
    if (!outcome.failure.empty() && n_failed++ < kMostTold) {
      progress.end();
      fmt::print(stderr, "member {} failed: {}\n{}", outcome.member + 1, outcome.failure,
                 n_failed == kMostTold ? "further failures: see the column `status`\n" : "");
      progress.begin(work);
    }
    progress.update(static_cast<double>(++n_done) / static_cast<double>(missing.size()));
  });
  progress.end();
}

NumberedRows rows_of(const std::vector<std::size_t>& members, const NumberedRows& all) {
  NumberedRows rows;
  for (const std::size_t m : members) {
    if (const auto found = all.find(m + 1); found != all.end()) rows.insert(*found);
  }
  return rows;
}

/// Writes the folder of results from all rows.
void write_table(const SweepOptions& options, const SweepPlan& plan, const NumberedRows& rows, Progress& progress) {
  output::ResultsFolder folder = open_results(options, plan.name);
  std::string csv;
  for (const std::string& line : provenance_lines(folder.made_by(), "sweep " + plan.name)) csv += "# " + line + "\n";
  csv += plan.table_header() + "\n";
  for (const auto& [number, row] : rows) csv += row + "\n";
  folder.write_text("sweep.csv", csv);
  finish(findings::sweep_document(plan, rows, folder.made_by()), folder, progress, options);
}

NumberedRows found_rows(const fs::path& parts, const output::RowsIdentity& identity) {
  std::size_t n_damaged = 0;
  NumberedRows rows = output::find_rows(parts, identity, &n_damaged);
  if (n_damaged > 0)
    fmt::print(stderr, "note: {} row{} in {} {} damaged and dropped\n", n_damaged, n_damaged == 1 ? "" : "s",
               shown_path(parts), n_damaged == 1 ? "is" : "are");
  return rows;
}

/// Ends with an error if members failed, so that a script notices. @throws SolveError
void fail_where_members_failed(const NumberedRows& rows, const fs::path& table) {
  const auto n_failed =
      std::count_if(rows.begin(), rows.end(), [](const auto& row) { return !studies::is_done(row.second); });
  if (n_failed == 0) return;
  throw SolveError(
      fmt::format("{} of {} members failed; the column `status` of {} says why", n_failed, rows.size(), shown_path(table)));
}

[[noreturn]] void refuse_to_merge(const SweepPlan& plan, const NumberedRows& rows, const fs::path& parts) {
  std::size_t first = 1;
  while (rows.contains(first)) ++first;
  throw InputError(
      fmt::format("{}: {} of {} members have no row in {} yet (the first is {}); let every shard end, run those that were "
                  "cut short again, or "
                  "leave out --merge to simulate what is missing here",
                  plan.path, plan.n_members - rows.size(), plan.n_members, shown_path(parts), first));
}

}  // namespace

void sweep(const SweepOptions& options) {
  const Shard part = read_shard(options.shard);
  if (options.merge && !options.shard.empty())
    throw InputError("--merge joins what all shards have written; leave out --shard");
  const SweepPlan plan = scenarios::read_sweep_plan(options.scenario);
  const fs::path target = checked_results(options, plan.name);
  const fs::path parts = target.string() + ".parts";
  const output::RowsIdentity identity{scenarios::content_key(plan, kVersion), plan.table_header()};
  Progress progress(options.quiet);
  if (options.merge) {
    const NumberedRows rows = found_rows(parts, identity);
    if (rows.size() < plan.n_members) refuse_to_merge(plan, rows, parts);
    write_table(options, plan, rows, progress);
    output::remove_rows(parts);
    fail_where_members_failed(rows, target / "sweep.csv");
    return;
  }
  const std::vector<std::size_t> members = scenarios::members_of_part(plan, part.number - 1, part.of);
  std::optional<output::RowsUnderWay> file(std::in_place, parts, file_of(part), identity);
  if (file->dropped_stale())
    fmt::print(stderr, "note: rows of an earlier version of this study or its scenario are dropped\n");
  NumberedRows rows = rows_of(members, found_rows(parts, identity));
  simulate_missing(plan, members, *file, rows, progress);
  if (!options.shard.empty()) {
    file->finish(rows);
    if (!options.quiet && !options.json)
      fmt::print("{}: shard {} of {}, {} members in {}; when all shards are done: driftwright sweep {} --merge\n", plan.name,
                 part.number, part.of, rows.size(), shown_path(parts / file_of(part)), options.scenario);
    fail_where_members_failed(rows, parts / file_of(part));
    return;
  }
  write_table(options, plan, rows, progress);
  file.reset();
  output::remove_rows(parts);
  fail_where_members_failed(rows, target / "sweep.csv");
}

}  // namespace driftwright::app
