#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <optional>
#include <system_error>
#include <utility>

#include "app/verbs.hpp"
#include "base/errors.hpp"
#include "base/option_quantity.hpp"
#include "base/version.hpp"
#include "compensation/injector/axis_loop.hpp"
#include "compensation/injector/correction_input.hpp"
#include "compensation/injector/row_pipe.hpp"
#include "output/signal_files.hpp"

namespace driftwright::app {
namespace {

using namespace compensation;

Counting counting_of(const std::string& name) {
  return name == "x1" ? Counting::kX1 : name == "x2" ? Counting::kX2 : Counting::kX4;
}

int quarters_of(const std::string& name) {
  return name == "quarter" ? 1 : name == "half" ? 2 : kQuartersPerPeriod;
}

double positive_quantity(const std::string& option, const std::string& text, const std::string& unit) {
  if (text.empty()) return 0.0;
  const double value = option_quantity(option, text, unit);
  if (value > 0.0) return value;
  throw InputError(fmt::format("{} '{}' must be above 0", option, text));
}

constexpr double kMostRowsBehind = 1e7;   // most rows that are added after the end of the input
constexpr std::int64_t kFaultsSaid = 10;  // of each sort that are printed to standard error; the log has all

/// The injector with rows as its unit of time, free or clocked.
class RowInjector {
 public:
  RowInjector(const InsertionRules& rules, bool clocked, std::int64_t separation, std::int64_t interval)
      : rows_(rules), separation_(separation), rows_per_insertion_(rules.quarters) {
    if (clocked) timed_.emplace(InsertionLimits{.rules = rules, .separation = separation, .insertion_interval = interval});
  }

  void set_target(std::int64_t quarters) {
    rows_.set_target(quarters);
    target_ = quarters;
  }
  /// Appends the rows that the control gets.
  void run(std::span<const Lines> rows, std::vector<Lines>& out) {
    if (!timed_) {
      const std::size_t before = out.size();
      out.resize(before + rows.size() * kMostRowsPerRow);
      out.resize(before + rows_.run(rows, out.data() + before));
      return;
    }
    for (Lines row : rows) {
      timed_->input({++n_rows_, row}, edges_);
      timed_->set_target(n_rows_, target_, edges_);
      timed_->advance(n_rows_, edges_);
      if (!edges_.empty()) last_ = edges_.back().lines;
      edges_.clear();
      out.push_back(last_);
    }
  }
  /// Appends the rows that complete what has begun when the input ends. @throws InputError  if that needs too many rows
  void finish(std::vector<Lines>& out) {
    if (!timed_) return;
    timed_->freeze();
    const double n_rows = std::abs(static_cast<double>(timed_->waiting())) * static_cast<double>(separation_);
    if (n_rows > kMostRowsBehind)
      throw InputError(
          fmt::format("--separation {}: {} edges still wait when the input ends, which would take {:.3g} rows more; at most "
                      "{:.0e} are written after the end. The rows hold edges that are closer than the separation allows",
                      separation_, std::abs(timed_->waiting()), n_rows, kMostRowsBehind));
    while (timed_->waiting() != 0 && edges_.empty()) {
      timed_->advance(++n_rows_, edges_);
      if (!edges_.empty()) last_ = edges_.back().lines;
      edges_.clear();
      out.push_back(last_);
    }
  }

  [[nodiscard]] const EncoderReader& encoder() const { return timed_ ? timed_->encoder() : rows_.encoder(); }
  [[nodiscard]] std::int64_t inserted() const { return timed_ ? timed_->inserted() - timed_->waiting() : rows_.inserted(); }
  [[nodiscard]] std::int64_t n_too_fast() const { return timed_ ? timed_->n_too_fast() : 0; }
  /// Rows between two edges of the encoder that an insertion needs; 0: it needs no time of its own.
  [[nodiscard]] std::int64_t room() const { return timed_ ? (rows_per_insertion_ + 1) * separation_ : 0; }

 private:
  PulseInjector rows_;
  std::int64_t separation_, rows_per_insertion_;
  std::optional<TimedInjector> timed_;
  std::int64_t target_ = 0, n_rows_ = 0;
  Lines last_ = 0;
  std::vector<Edge> edges_;
};

void require_together(const InjectOptions& options) {
  if (!options.clocked && (options.separation != 1 || options.interval != 1))
    throw InputError("--separation and --interval count rows of a signal sampled in time; add --clocked");
  if (quarters_of(options.insert) < quarters_per_count(counting_of(options.counts)))
    throw InputError(fmt::format(
        "--insert {} is less than one count at {}; the control would not see each: add --counts x4, or --insert cycle",
        options.insert, options.counts));
  if (!options.hal.empty() && options.halstream.empty())
    throw InputError("--hal plays the file of --halstream, which is not given");
  if (!options.hal.empty() && options.counts == "x2") throw InputError("--hal: LinuxCNC's encoder counts x4 or x1, not x2");
  if (!options.hal.empty() && options.halstream.find_first_of("'\"#$[ \t\n\r") != std::string::npos)
    throw InputError(
        fmt::format("--halstream '{}': a HAL file can name no file with a blank, a quote, #, $ or [", options.halstream));
}

/// Whether two names are one file. A device such as /dev/null may be named several times.
bool same_file(const std::string& a, const std::string& b) {
  struct stat of_a, of_b;
  const bool has_a = stat(a.c_str(), &of_a) == 0, has_b = stat(b.c_str(), &of_b) == 0;
  if (has_a && has_b) return !S_ISCHR(of_a.st_mode) && of_a.st_dev == of_b.st_dev && of_a.st_ino == of_b.st_ino;
  std::error_code error_a, error_b;
  const auto path_a = std::filesystem::weakly_canonical(std::filesystem::absolute(a), error_a),
             path_b = std::filesystem::weakly_canonical(std::filesystem::absolute(b), error_b);
  return !has_a && !has_b && !error_a && !error_b && path_a == path_b;
}

void require_own_files(const InjectOptions& options) {
  const std::array<std::pair<const char*, const std::string*>, 5> files = {{{"--correction", &options.correction},
                                                                            {"--vcd", &options.vcd},
                                                                            {"--halstream", &options.halstream},
                                                                            {"--hal", &options.hal},
                                                                            {"--log", &options.log}}};
  for (std::size_t i = 0; i < files.size(); ++i) {
    for (std::size_t j = i + 1; j < files.size(); ++j) {
      if (!files[i].second->empty() && !files[j].second->empty() && same_file(*files[i].second, *files[j].second))
        throw InputError(fmt::format("{} {} and {} {} are the same file; each requires a file of its own", files[i].first,
                                     *files[i].second, files[j].first, *files[j].second));
    }
  }
}

/// If a standard stream is closed, the next opened file would get its number and its bytes.
void require_standard_streams() {
  if (fcntl(STDIN_FILENO, F_GETFD) < 0) throw InputError("standard input is closed; rows are read from it");
  if (fcntl(STDOUT_FILENO, F_GETFD) < 0) throw InputError("standard output is closed; rows are written to it");
  if (fcntl(STDERR_FILENO, F_GETFD) < 0 && open("/dev/null", O_WRONLY) != STDERR_FILENO)
    throw InputError("standard error is closed");
}

/// Prints to standard error. A failed print is ignored: the rows matter more.
void tell(const std::string& words) {
  (void)std::fputs(words.c_str(), stderr);
}

/// The files that are written beside standard output.
struct SideFiles {
  std::optional<output::VcdFile> vcd;
  std::optional<output::HalStreamFile> hal;
  std::optional<std::ofstream> log;

  [[nodiscard]] bool any() const { return vcd || hal || log; }
};

/// One run of the verb.
class Filter {
 public:
  explicit Filter(const InjectOptions& options)
      : options_(options),
        rules_{.quarters = quarters_of(options.insert), .anywhere = options.anywhere, .bypass = options.bypass},
        counting_(counting_of(options.counts)),
        row_s_(positive_quantity("--row-time", options.row_time, "s")),
        correction_(options.correction, {.period_um = positive_quantity("--period", options.period, "um"),
                                         .counting = counting_,
                                         .row_s = row_s_,
                                         .unit = options.unit,
                                         .column = options.column,
                                         .is_strict = options.strict}),
        most_quarters_(most_quarters(options, rules_.quarters)),
        converter_(rules_.quarters),
        injector_(rules_, options.clocked, options.separation, options.interval) {}

  void run() {
    std::signal(SIGPIPE, SIG_IGN);  // write() reports a closed pipe
    compensation::RowReader reader(STDIN_FILENO, options_.strict);
    bool wanted = true;
    while (wanted) {
      const std::span<const Lines> rows = reader.next();
      if (!rows.empty() && n_rows_ == 0) begin(rows.front(), reader.has_index());
      take_faults(reader.faults(), n_bad_rows_);
      if (rows.empty()) break;
      const std::int64_t told_before = correction_.n_told();
      correction_.poll();
      if (correction_.n_told() > told_before) is_withdrawn_ = false;
      take_faults(correction_.take_faults(), n_bad_corrections_);
      pass_on(rows);
      wanted = rules_.bypass ? compensation::write_bytes(STDOUT_FILENO, reader.bytes())
                             : compensation::write_rows(STDOUT_FILENO, out_, has_index_);
    }
    if (n_rows_ == 0) begin(0, false);
    std::vector<Lines> rest;
    injector_.finish(rest);
    take(rest, last_in_);
    if (wanted) wanted = compensation::write_rows(STDOUT_FILENO, rest, has_index_);
    end();
  }

 private:
  static std::string made_by() { return fmt::format("driftwright {} inject", kVersion); }

  /// The largest correction in whole insertions [quarter steps].
  static double most_quarters(const InjectOptions& options, int quarters_per_insertion) {
    const double limit_um = positive_quantity("--limit", options.limit, "um");
    if (limit_um == 0.0) return std::numeric_limits<double>::infinity();
    const double period_um = positive_quantity("--period", options.period, "um");
    if (period_um == 0.0) throw InputError("--limit requires --period, the travel of one signal period");
    const double insertion_um = quarters_per_insertion * period_um / kQuartersPerPeriod;
    return quarters_per_insertion * std::floor(limit_um / insertion_um * (1.0 + 1e-9));
  }

  double within_limit(double quarters) {
    if (!(std::abs(quarters) > most_quarters_)) return quarters;
    if (!is_limited_)
      tell(fmt::format("inject: row {}: the correction is larger than --limit {}; it is held at this limit\n", n_rows_ + 1,
                       options_.limit));
    is_limited_ = true;
    return std::copysign(most_quarters_, quarters);
  }

  void begin(Lines first, bool has_index) {
    has_index_ = has_index;
    control_ = QuadratureCounter(first);
    counted_ = QuadratureCounter(first, counting_);
    if (!options_.vcd.empty()) files_.vcd.emplace(options_.vcd, row_s_ > 0.0 ? row_s_ : 1e-6, has_index, made_by());
    if (!options_.halstream.empty()) files_.hal.emplace(options_.halstream, has_index);
    if (!options_.log.empty()) {
      files_.log.emplace(options_.log, std::ios::binary);
      if (!*files_.log) throw InputError(fmt::format("{}: cannot be written", options_.log));
      *files_.log << "# " << made_by()
                  << "\n# counts are quarter steps (x4); a line for each change of wish, insertion or jumps\n"
                  << "row,output_row,encoder_count,wished_count,inserted_count,control_count,jumps\n";
    }
  }

  void pass_on(std::span<const Lines> rows) {
    const std::size_t block = files_.any() ? 1 : rows.size();  // the files need each row
    out_.clear();
    for (std::size_t i = 0; i < rows.size();) {
      const double told = correction_.quarters_at(n_rows_ + 1), wish = is_withdrawn_ ? 0.0 : within_limit(told);
      target_ = converter_.insertions(wish) * rules_.quarters;
      injector_.set_target(target_);
      const std::int64_t same = correction_.holds_until() - n_rows_;
      const auto n = static_cast<std::size_t>(
          std::min<std::int64_t>(same, static_cast<std::int64_t>(std::min(block, rows.size() - i))));
      const std::size_t before = out_.size();
      injector_.run(rows.subspan(i, n), out_);
      n_rows_ += static_cast<std::int64_t>(n);
      i += n;
      last_in_ = rows[i - 1];
      if (injector_.room() > 0) look_for_room(rows.subspan(i - n, n));
      take({out_.data() + before, out_.size() - before}, last_in_);
    }
  }

  /// Finds the longest stretch of rows in which an insertion fits.
  void look_for_room(std::span<const Lines> rows) {
    for (const Lines row : rows) {
      const bool same = (row & kLinesAB) == stretch_lines_;
      stretch_lines_ = row & kLinesAB;
      stretch_ = same ? stretch_ + 1 : 1;
      if (stretch_lines_ == 0 || rules_.anywhere) longest_ = std::max(longest_, stretch_);
    }
  }

  /// Reports corrections that were requested and not inserted.
  void tell_what_is_missing() {
    const std::int64_t missing = std::abs(target_ - injector_.inserted());
    if (rules_.bypass || missing < rules_.quarters) return;
    const char* where = rules_.anywhere ? "between two edges" : "with both lines low";
    const std::string how_much =
        injector_.inserted() == 0 ? "nothing was inserted" : fmt::format("{} of the counts wished are missing", missing);
    if (injector_.room() > 0 && longest_ < injector_.room()) {
      tell(fmt::format(
          "inject: {}: an insertion requires {} rows {}, but the longest stretch had {}; sample the encoder more "
          "often, drive more slowly, or lower "
          "--separation\n",
          how_much, injector_.room(), where, longest_));
    } else if (injector_.inserted() == 0) {
      tell(fmt::format("inject: {}: no row {} left room for an insertion before the input ended\n", how_much, where));
    }
  }

  /// Counts, logs and prints faults. With --on-fault bypass the correction is withdrawn until the pipe gives the next
  /// one.
  void take_faults(const std::vector<std::string>& faults, std::int64_t& n) {
    for (const std::string& what : faults) {
      if (n++ < kFaultsSaid) tell(fmt::format("inject: {}\n", what));
      if (files_.log) *files_.log << "# fault at row " << n_rows_ << ": " << what << "\n";
    }
    if (!faults.empty() && options_.on_fault == "bypass") is_withdrawn_ = true;
  }

  void take(std::span<const Lines> out, Lines in) {
    for (Lines row : out) {
      control_.step(row);
      counted_.step(row);
      if (files_.vcd) files_.vcd->row(n_out_, in, row);
      if (files_.hal) files_.hal->row(row);
      ++n_out_;
    }
    if (files_.log) log(false);
  }

  void log(bool at_end) {
    const std::array<std::int64_t, 3> now = {target_, injector_.inserted(), injector_.encoder().n_jumps()};
    if (now == logged_ && !at_end) return;
    logged_ = now;
    *files_.log << fmt::format("{},{},{},{},{},{},{}\n", n_rows_, n_out_, injector_.encoder().count(), now[0], now[1],
                               control_.count(), now[2]);
  }

  void end() {
    const EncoderReader& encoder = injector_.encoder();
    const bool wire =
        rules_.bypass && encoder.n_jumps() > 0;  // with --bypass faults pass unchanged, and the control miscounts them
    if (!wire && control_.count() != encoder.count() + injector_.inserted())
      throw std::logic_error("counts in + inserted are not counts out");
    if (files_.vcd) files_.vcd->finish();
    if (files_.hal) files_.hal->finish();
    if (files_.log) {
      log(true);
      files_.log->close();
      if (!*files_.log) throw InputError(fmt::format("{}: not all could be written; is the disk full?", options_.log));
    }
    if (!options_.hal.empty()) {
      std::ofstream hal(options_.hal, std::ios::binary);
      hal << output::hal_text(options_.halstream, *files_.hal, has_index_, counting_, made_by());
      hal.close();
      if (!hal) throw InputError(fmt::format("{}: cannot be written", options_.hal));
    }
    if (n_bad_rows_ > 0 || n_bad_corrections_ > 0)
      tell(fmt::format("inject: {} rows and {} corrections were invalid; {}\n", n_bad_rows_, n_bad_corrections_,
                       options_.on_fault == "bypass" ? "the correction was withdrawn until the next good one"
                                                     : "the value before them held"));
    if (encoder.n_jumps() > 0)
      tell(fmt::format("inject: {} jumps of both lines at once (lost edges or disturbances){}\n", encoder.n_jumps(),
                       rules_.bypass ? "" : "; the correction waited a period after each"));
    if (injector_.n_too_fast() > 0)
      tell(fmt::format("inject: {} edges of the encoder came closer than {} rows and were held back\n",
                       injector_.n_too_fast(), options_.separation));
    tell_what_is_missing();
    tell(fmt::format("inject: {} rows in, {} rows out; x4 counts: encoder {:+d}, inserted {:+d} of {:+d}, control {:+d}{}\n",
                     n_rows_, n_out_, encoder.count(), injector_.inserted(), target_, control_.count(),
                     counting_ == Counting::kX4 ? "" : fmt::format(" ({} {:+d})", options_.counts, counted_.count())));
  }

  const InjectOptions& options_;
  InsertionRules rules_;
  Counting counting_;
  double row_s_;
  compensation::CorrectionInput correction_;
  double most_quarters_;
  bool is_limited_ = false;  // it has been said
  CountConverter converter_;
  RowInjector injector_;
  SideFiles files_;
  QuadratureCounter control_, counted_;
  std::vector<Lines> out_;
  Lines last_in_ = 0;
  bool has_index_ = false;
  std::int64_t n_rows_ = 0, n_out_ = 0, target_ = 0, n_bad_rows_ = 0, n_bad_corrections_ = 0;
  bool is_withdrawn_ = false;
  std::array<std::int64_t, 3> logged_ = {-1, -1, -1};
  Lines stretch_lines_ = 0;
  std::int64_t stretch_ = 0,
               longest_ = 0;  // rows: stretch of equal lines at the input's end, longest for an insertion
};

}  // namespace

void inject(const InjectOptions& options) {
  require_standard_streams();
  require_together(options);
  require_own_files(options);
  Filter(options).run();
}

}  // namespace driftwright::app
