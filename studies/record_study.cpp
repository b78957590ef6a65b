#include "studies/record_study.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <tuple>

#include "base/errors.hpp"
#include "base/mapped_record.hpp"
#include "base/median.hpp"
#include "compensation/judging/run_up.hpp"
#include "compensation/predictors/regression_quality.hpp"
#include "compensation/predictors/scored_rows.hpp"
#include "compensation/sensors/product_sums.hpp"
#include "scenarios/reader/felt_run.hpp"
#include "scenarios/reader/record_part.hpp"
#include "scenarios/reader/record_runs.hpp"
#include "scenarios/reader/recorded_run.hpp"

namespace driftwright::studies {
namespace {

constexpr std::size_t kMostPairs = 5;    // most pairs of near-duplicates that are named
constexpr double kCommonScatter = 0.03;  // least assumed scatter of a sensor's share from run to run
constexpr double kWorthAWord = 0.01;     // share of missing rows above which a sensor is mentioned

/// Sizes of the sensors' movements in each record, relative to the mean there: n_records x n_sensors, logarithms.
Eigen::MatrixXd shares(const std::vector<Record>& records, const std::vector<std::string>& sensors) {
  Eigen::MatrixXd share(static_cast<Eigen::Index>(records.size()), static_cast<Eigen::Index>(sensors.size()));
  for (Eigen::Index r = 0; r < share.rows(); ++r) {
    for (Eigen::Index s = 0; s < share.cols(); ++s) {
      const std::vector<double>& x = records[static_cast<std::size_t>(r)].at(sensors[static_cast<std::size_t>(s)]).values;
      double sum = 0.0, squares = 0.0, n = 0.0;
      for (double v : x) {
        if (std::isnan(v)) continue;
        sum += v;
        squares += v * v;
        ++n;
      }
      share(r, s) = std::log(std::max(1e-3, std::sqrt(std::max(0.0, squares / n - sum * sum / (n * n)))));
    }
    share.row(r).array() -= share.row(r).mean();
  }
  return share;
}

/// Pairs of sensors that seem exchanged in one record: exchanging them makes that record agree with the others, and it
/// disagrees by far more than sensors usually vary from run to run.
std::vector<std::tuple<std::string, std::string, std::string>> exchanged(const std::vector<Record>& records,
                                                                         const std::vector<std::string>& sensors) {
  std::vector<std::tuple<std::string, std::string, std::string>> found;
  if (records.size() < 2 || sensors.size() < 4) return found;
  const Eigen::MatrixXd share = shares(records, sensors);
  for (Eigen::Index r = 0; r < share.rows(); ++r) {
    const Eigen::RowVectorXd others = (share.colwise().sum() - share.row(r)) / static_cast<double>(share.rows() - 1);
    Eigen::RowVectorXd off = (share.row(r) - others).cwiseAbs();
    const double common = std::max(kCommonScatter, upper_median({off.begin(), off.end()}));
    for (Eigen::Index a = 0; a < share.cols(); ++a) {
      for (Eigen::Index b = a + 1; b < share.cols(); ++b) {
        const double as_is = std::min(off(a), off(b)),
                     as_other = std::max(std::abs(share(r, a) - others(b)), std::abs(share(r, b) - others(a)));
        if (as_is > 4.0 * common && as_other < 2.0 * common)
          found.emplace_back(sensors[static_cast<std::size_t>(a)], sensors[static_cast<std::size_t>(b)],
                             records[static_cast<std::size_t>(r)].source);
      }
    }
  }
  if (records.size() == 2 && found.size() == 2) found.pop_back();  // with two records, it is unknown which of them is wrong
  return found;
}

using scenarios::is_same_file, scenarios::RecordPart, scenarios::RunRows;

/// A file, read once, whichever parts of it are requested.
struct ReadFile {
  std::string path;
  MachineRun recorded = {};
  MachineRun felt = {};      ///< drive and ambient after the changes by the scenario's effects
  std::size_t n_before = 0;  ///< rows of the preceding record at the front
};

Record read_with_target(const std::string& path, const scenarios::Scenario& scenario, std::vector<std::string>& notes) {
  ReadRecord read = read_record(path, scenario.columns);
  for (const std::string& note : read.notes) {  // of files with the same format only the first gives notes
    const std::string what = note.starts_with(path) ? note.substr(path.size()) : note;
    if (std::none_of(notes.begin(), notes.end(), [&](const std::string& n) { return n.ends_with(what); }))
      notes.push_back(note);
  }
  const std::string& name = scenario.study->target;
  const Channel& target = read.record.at(name);
  if (target.unit != "um")
    throw InputError(fmt::format(
        "{}: the target '{}' is in {}; strategies, tolerances and corrections are in um: name and scale the column so", path,
        name, target.unit));
  return std::move(read.record);
}

/// The files of the parts, each once.
std::vector<ReadFile> read_files(const std::vector<RecordPart>& parts, const scenarios::Scenario& scenario,
                                 const std::string* ambient, StudyRecords& into) {
  const std::string& target = scenario.study->target;
  std::vector<ReadFile> files;
  std::vector<Record> as_read;
  for (const RecordPart& part : parts) {
    if (std::any_of(files.begin(), files.end(), [&](const ReadFile& f) { return is_same_file(f.path, part.file); }))
      continue;
    ReadFile file{.path = part.file};
    Record record = read_with_target(part.file, scenario, into.notes);
    for (std::size_t k = 0; k < files.size(); ++k) {
      if (as_read[k].time_s == record.time_s && as_read[k].at(target).values == record.at(target).values)
        throw InputError(fmt::format("{} and {} contain the same run; one run can be trained on or judged by, once",
                                     files[k].path, file.path));
    }
    if (!scenario.study->count_from_start && part.is_whole()) {
      compensation::RunUp run_up = compensation::with_run_up(record, as_read, target);
      if (!run_up.follows.empty())
        into.findings.push_back(
            fmt::format("{} follows {}, whose rows of up to 12 h before are known to strategies, but for {}", part.file,
                        run_up.follows, target));
      as_read.push_back(std::move(record));
      record = std::move(run_up.record);
      file.n_before = record.n_samples() - as_read.back().n_samples();
    } else {
      as_read.push_back(record);
    }
    file.recorded = scenarios::run_of(std::move(record), scenario.machine ? &*scenario.machine : nullptr,
                                      ambient_sensors(scenario), scenarios::Reading::kLenient);
    for (const DataFinding& f : file.recorded.findings) {
      if (std::find(into.findings.begin(), into.findings.end(), f.what) == into.findings.end())
        into.findings.push_back(f.what);
    }
    files.push_back(std::move(file));
  }
  // The ambient is an input if every record has it in the same channel.
  into.ambient = files.front().recorded.ambient_channel;
  const bool is_same =
      std::all_of(files.begin(), files.end(), [&](const ReadFile& f) { return f.recorded.ambient_channel == into.ambient; });
  const bool has_ambient = is_same && (!ambient || (!ambient->empty() && *ambient == into.ambient));
  if (!has_ambient) into.ambient.clear();
  if (!is_same) {
    into.findings.emplace_back("not every record has the ambient temperature in the same channel; it is used from none");
  }
  for (ReadFile& file : files) {
    file.felt = {.cyclogram = file.recorded.cyclogram, .ambient = file.recorded.ambient};
    if (!scenario.machine) continue;
    scenarios::MachineModel there = *scenario.machine;
    if (has_ambient) there.ambient = file.recorded.ambient;
    file.felt = scenarios::felt_run(there, file.recorded.cyclogram);
    file.felt.cyclogram.name = file.recorded.cyclogram.name;
  }
  return files;
}

double hours(const ReadFile& file, std::size_t row) {
  return file.recorded.readings.time_s[row] / 3600.0;
}

MachineRun observed(const ReadFile& file, const RunRows& rows, const std::string& name) {
  MachineRun run{.cyclogram = file.felt.cyclogram,
                 .ambient = file.felt.ambient,
                 .readings = file.recorded.readings,
                 .n_before = rows.first - rows.history,
                 .history = fmt::format("{} from row {}", file.path, rows.history)};
  run.readings.source = name;
  const std::vector<double>& t = run.readings.time_s;
  run.rows = {.file = std::filesystem::absolute(file.path).lexically_normal().string(),
              .first_s = t[rows.first] - t[file.n_before],
              .last_s = t[rows.last - 1] - t[file.n_before]};
  if (rows.history == 0 && rows.last == t.size()) return run;
  run.cyclogram = scenarios::part_of(run.cyclogram, t[rows.history], t[rows.last - 1]);
  run.ambient = scenarios::part_of(run.ambient, t[rows.history], t[rows.last - 1]);
  for (Channel& c : run.readings.channels) c.values.resize(rows.last);
  run.readings.time_s.resize(rows.last);
  run.readings = compensation::own_rows(std::move(run.readings), rows.history);
  return run;
}

/// Says where a single record was split, or why it was not.
std::string words_of_cut(const RecordPart& part, const ReadFile& file, const std::vector<RunRows>& runs) {
  if (file.recorded.cyclogram.sections.empty())
    return fmt::format("{} does not say what drove the machine, so that it is not cut into runs at rests", part.words);
  if (runs.size() == 1)
    return fmt::format(
        "{} has no rest of 10 min or more between two stretches of work and stays one run. Parts, --train FILE:0h..10h "
        "--train FILE:10h..20h, divide it by time",
        part.words);
  std::vector<std::string> at, going_on;
  for (std::size_t r = 1; r < runs.size(); ++r) {
    at.push_back(fmt::format("{:.2f} h", hours(file, runs[r].first)));
    if (runs[r].history < runs[r].first) going_on.push_back(at.back());
  }
  return fmt::format("{} is cut into {} runs where the drive starts anew after a rest, at {}{}", part.words, runs.size(),
                     fmt::join(at, ", "),
                     going_on.empty()
                         ? ""
                         : fmt::format("; at {} the machine is still warm, so the later run continues the earlier one",
                                       fmt::join(going_on, ", ")));
}

}  // namespace

StudyRecords read_records(const scenarios::Scenario& scenario, const RecordPaths& paths, const std::string* ambient) {
  std::vector<RecordPart> parts;
  for (const std::vector<std::string>* list : {&paths.train, &paths.test}) {
    for (const std::string& argument : *list) {
      parts.push_back(scenarios::read_record_part(argument));
      for (std::size_t other = 0; other + 1 < parts.size(); ++other) scenarios::refuse_overlap(parts[other], parts.back());
    }
  }
  StudyRecords records;
  const std::vector<ReadFile> files = read_files(parts, scenario, ambient, records);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const RecordPart& part = parts[p];
    const ReadFile& file =
        *std::find_if(files.begin(), files.end(), [&](const ReadFile& f) { return is_same_file(f.path, part.file); });
    auto [first, last] = scenarios::rows_of(part, file.recorded.readings);
    first += file.n_before;
    if (paths.train.size() == 1 && p == 0) {
      const std::vector<RunRows> runs = scenarios::runs_between_rests(file.recorded, first, last);
      records.notes.push_back(words_of_cut(part, file, runs));
      for (const RunRows& rows : runs) {
        const std::string name = runs.size() == 1 ? part.words
                                                  : fmt::format("{} from {:.2f} h to {:.2f} h", part.file,
                                                                hours(file, rows.first), hours(file, rows.last - 1));
        records.train.push_back(observed(file, rows, name));
      }
    } else {
      (p < paths.train.size() ? records.train : records.test)
          .push_back(observed(file, scenarios::whole_run(file.recorded, first, last), part.words));
    }
  }
  return records;
}

std::vector<Record> own_records(std::span<const MachineRun> runs) {
  std::vector<Record> records;
  for (const MachineRun& run : runs) records.push_back(compensation::own_rows(run.readings, run.n_before));
  return records;
}

std::vector<Record> whole_records(std::span<const MachineRun> runs, const std::string& target) {
  std::vector<Record> records;
  for (MachineRun& run : compensation::joined_histories(runs, target)) records.push_back(std::move(run.readings));
  return records;
}

std::vector<std::string> ambient_sensors(const scenarios::Scenario& scenario) {
  std::vector<std::string> names;
  for (const scenarios::Sensor& s : scenario.machine ? scenario.machine->sensors : std::vector<scenarios::Sensor>{}) {
    if (scenarios::is_on_ambient(s)) names.push_back(s.name);
  }
  return names;
}

std::vector<std::string> sensor_warnings(const std::vector<Record>& records, const std::vector<std::string>& candidates) {
  std::vector<std::string> lines;
  std::vector<std::string> moving;
  for (const std::string& name : candidates) {
    std::size_t n = 0, n_missing = 0;
    double low = INFINITY, high = -INFINITY;
    for (const Record& record : records) {
      for (double v : record.at(name).values) {
        ++n;
        if (std::isnan(v)) {
          ++n_missing;
          continue;
        }
        low = std::min(low, v);
        high = std::max(high, v);
      }
    }
    const double missing = static_cast<double>(n_missing) / static_cast<double>(n);
    if (missing > kWorthAWord)
      lines.push_back(fmt::format("{} has no value in {:.0f} % of the rows; no fit that uses it sees these rows", name,
                                  100.0 * missing));
    if (n_missing < n && !(high > low)) {
      lines.push_back(
          fmt::format("{} reads {:.4g} in every row: flat, broken or not connected; it is not chosen", name, low));
    } else if (n_missing < n) {
      moving.push_back(name);
    }
  }
  for (const auto& [a, b, source] : exchanged(records, moving))
    lines.push_back(fmt::format(
        "{} and {} look exchanged in {}: each rises there as the other does elsewhere; look at the wiring", a, b, source));
  if (moving.size() < 2) return lines;
  const std::vector<compensation::NearDuplicate> pairs = compensation::near_duplicates(records, moving);
  for (std::size_t i = 0; i < std::min(pairs.size(), kMostPairs); ++i) {
    lines.push_back(fmt::format(
        "{} and {} move as one (correlation {:.4f}); a regression on both shares the effect between them arbitrarily",
        pairs[i].first, pairs[i].second, pairs[i].correlation));
  }
  if (pairs.size() > kMostPairs) lines.push_back(fmt::format("so do {} more pairs", pairs.size() - kMostPairs));
  return lines;
}

}  // namespace driftwright::studies
