#include "app/follow.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <limits>
#include <optional>
#include <thread>

#include "app/end_request.hpp"
#include "app/followed_page.hpp"
#include "app/progress.hpp"
#include "base/config_map.hpp"
#include "base/errors.hpp"
#include "base/file_bytes.hpp"
#include "base/option_quantity.hpp"
#include "base/version.hpp"
#include "follow/agent_rows.hpp"
#include "follow/broker_rows.hpp"
#include "follow/followed_machine.hpp"
#include "follow/line_source.hpp"
#include "follow/record_file.hpp"
#include "follow/row_text.hpp"
#include "follow/sparkplug_rows.hpp"
#include "follow/state_file.hpp"
#include "follow/watch_json.hpp"
#include "follow/watch_trial.hpp"
#include "output/predictor_file.hpp"

namespace driftwright::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kSaveEvery_s = 1.0;
constexpr double kLongestPoll_s = 0.25;  // longest wait for a row: a request to end is noticed within this time
constexpr double kStale_s = 60.0;        // least time without a message after which a channel is missing
constexpr double kFirstSilence_s = 5.0;  // least time without a row after which a line is written without one

std::optional<double> quantity(const char* option, const std::string& text, const std::string& unit) {
  if (text.empty()) return std::nullopt;
  const double value = option_quantity(option, text, unit);
  if (value > 0.0 && std::isfinite(value)) return value;
  throw InputError(fmt::format("{} '{}' must be above 0", option, text));
}

double seconds_since(Clock::time_point then) {
  return std::chrono::duration<double>(Clock::now() - then).count();
}

std::vector<follow::Session::Model> models_of(const FollowVerbOptions& options, const Listener& listener) {
  follow::FollowOptions how{.most_rate_um_s = quantity("--slew", options.slew, "um/s"),
                            .hold_s = quantity("--hold", options.hold, "s"),
                            .fade_s = quantity("--fade", options.fade, "s"),
                            .for_picture = options.serve.has_value(),
                            .watch = options.watch,
                            .no_watch = options.no_watch,
                            .despite_verdict = options.despite_verdict,
                            .probe_noise_um = quantity("--probe-noise", options.probe_noise, "um"),
                            .probe_lag_s = quantity("--probe-lag", options.probe_lag, "s"),
                            .tolerance_um = quantity("--tolerance", options.tolerance, "um")};
  std::vector<follow::Session::Model> models;
  for (const std::string& path : options.models) {
    const bool is_scenario = path.ends_with(".yaml") || path.ends_with(".yml");
    std::unique_ptr<follow::Followed> followed;
    if (is_scenario) {
      const scenarios::Scenario scenario = scenarios::read_scenario(path);
      (void)scenarios::require_machine(scenario, "follow");
      followed = follow::followed_machine(scenario, how, listener);
    } else {
      followed = follow::followed_predictor(path, how);
    }
    models.push_back({path, content_hash(read_bytes(path)), std::move(followed)});
  }
  return models;
}

std::optional<ColumnMap> columns_of(const std::string& path) {
  if (path.empty()) return std::nullopt;
  const scenarios::Scenario scenario = scenarios::read_scenario(path);
  if (!scenario.columns && scenario.topics.empty())
    throw InputError(
        fmt::format("--columns {}: it has neither a key `columns` (docs/reference/record.md), which says what the columns "
                    "are, nor `topics`",
                    path));
  return scenario.columns;
}

/// The topics of the options; else of the scenario that describes the rows, or of the first followed scenario that has
/// some.
std::vector<follow::ChannelOrigin> origins_of(const FollowVerbOptions& options) {
  if (!options.topics.empty() || !options.from.empty()) return follow::read_origins(options.topics);
  std::vector<std::string> paths = options.models;
  if (!options.columns.empty()) paths.insert(paths.begin(), options.columns);
  for (const std::string& path : paths) {
    if (!path.ends_with(".yaml") && !path.ends_with(".yml")) continue;
    std::vector<follow::ChannelOrigin> origins;
    for (const auto& [channel, from] : scenarios::read_scenario(path).topics) origins.push_back({channel, from});
    if (!origins.empty()) return origins;
  }
  return {};
}

/// One run of the verb.
class Following {
 public:
  explicit Following(const FollowVerbOptions& options)
      : options_(options),
        source_name_(options.replay.empty() ? "standard input" : options.replay),
        text_(columns_of(options.columns), source_name_),
        session_(models_of(options, progress_.listener())) {
    progress_.end();
    (void)session_.wanted();
    std::signal(SIGPIPE, SIG_IGN);  // a failed write reports it
    end_request_.emplace();         // before anybody is told that it runs
    if (!options.serve) return;
    page_ = std::make_unique<follow::PageServer>(page_address(options), followed_page(options, session_));
    fmt::print(stderr, "follow: the page is at {}{}\n", page_->url(), options.token.empty() ? "" : "?token=...");
  }

  void run() {
    if (options_.replay.empty())
      follow_source();
    else
      replay();
    if (session_.has_channels()) save();
    tell();
  }

 private:
  void follow_source() {
    const std::unique_ptr<follow::RowSource> source = open_source();
    std::string line;
    Clock::time_point last = Clock::now();  // of the last row taken, or line written without one
    while (is_read_ && !EndRequest::is_made()) {
      const auto got = source->next(line, kLongestPoll_s);
      if (got == follow::RowSource::Got::kEnd) break;
      if (got == follow::RowSource::Got::kLine && take(line)) {
        last = Clock::now();
        is_silent_ = false;
      }
      tell_silence(last);
      if (session_.has_channels() && seconds_since(saved_) > kSaveEvery_s) save();
    }
  }

  std::unique_ptr<follow::RowSource> open_source() {
    const double every_s = *quantity("--every", options_.every, "s"), stale_s = std::max(kStale_s, 5.0 * every_s);
    std::vector<follow::ChannelOrigin> origins = origins_of(options_);
    const bool makes_rows = !origins.empty();
    if (!options_.mtconnect.empty()) {
      if (!makes_rows)
        throw InputError(
            "--mtconnect requires --topic CHANNEL=ITEM for each channel, with a data item's id or name, or `topics` in the "
            "scenario");
      std::vector<std::string> headers = {"time_s"};
      for (const follow::ChannelOrigin& o : origins) headers.push_back(o.header);
      const std::vector<follow::ColumnUnit> units = follow::column_units(headers, columns_of(options_.columns));
      for (std::size_t k = 0; k < origins.size(); ++k) origins[k].numbers = units[k + 1];
      const auto say = [where = options_.mtconnect](const std::string& words) {
        (void)std::fputs(fmt::format("{}: {}\n", where, words).c_str(), stderr);
      };
      if (options_.sample)
        return std::make_unique<follow::SampleRows>(
            options_.mtconnect, follow::HeardValues(std::move(origins), std::numeric_limits<double>::infinity()), every_s,
            say);
      return std::make_unique<follow::CurrentRows>(options_.mtconnect, follow::HeardValues(std::move(origins), stale_s),
                                                   every_s, say);
    }
    if (options_.mqtt.empty()) return std::make_unique<follow::LineSource>(STDIN_FILENO, "standard input");
    std::optional<follow::SparkplugNode> node;
    if (!options_.sparkplug.empty()) node.emplace(follow::read_sparkplug_address(options_.sparkplug));
    if (node ? !makes_rows : makes_rows != options_.from.empty())
      throw InputError(
          "--mqtt requires --from TOPIC, whose messages are rows, or --topic CHANNEL=TOPIC for each channel, or --sparkplug "
          "GROUP/NODE with --topic CHANNEL=METRIC for each channel; a scenario's key `topics` says the same");
    std::vector<std::string> topics;
    for (const follow::ChannelOrigin& o : origins) topics.push_back(o.from);
    for (const follow::ChannelOrigin& o : origins) {
      if (node && o.header.starts_with(follow::kProbePrefix) && o.header.ends_with("_um"))
        throw InputError(fmt::format(
            "--topic {}={}: a metric of Sparkplug does not say when it was measured, and a probing is of one moment; send "
            "probings with --from or with topics of MQTT",
            o.header, o.from));
    }
    constexpr const char* kWill = R"({"state":"off","why":"follow has ended without a word","axes":{}})";
    link_ = std::make_unique<follow::MqttLink>(follow::read_mqtt_address(options_.mqtt),
                                               node         ? node->topics()
                                               : makes_rows ? topics
                                                            : std::vector{options_.from},
                                               options_.to, kWill);
    if (node)
      return std::make_unique<follow::SparkplugRows>(
          *link_, *std::move(node), follow::HeardValues(std::move(origins), stale_s), every_s,
          [](const std::string& words) { (void)std::fputs(fmt::format("Sparkplug: {}\n", words).c_str(), stderr); });
    if (makes_rows)
      return std::make_unique<follow::TopicRows>(*link_, follow::HeardValues(std::move(origins), stale_s), every_s);
    return std::make_unique<follow::MessageRows>(*link_);
  }

  /// Writes a line without a row after a long silence. @param last  time of the last row taken or such line written
  void tell_silence(Clock::time_point& last) {
    if (page_) page_->feed().hand_on();
    if (!session_.has_channels()) return;
    const double silent_s = seconds_since(last);
    if (silent_s < (is_silent_ ? 1.0 : std::max(kFirstSilence_s, 3.0 * session_.usual_step_s()))) return;
    write(session_.wait(silent_s));
    last = Clock::now();
    is_silent_ = true;
  }

  void replay() {
    const std::string name = fmt::format("--replay {}", options_.replay);
    struct Open {
      int file;
      ~Open() { (void)::close(file); }
    } open{::open(options_.replay.c_str(), O_RDONLY | O_CLOEXEC)};
    if (open.file < 0) throw InputError(fmt::format("{}: {}", name, std::strerror(errno)));
    follow::LineSource source(open.file, name);
    std::string line;
    while (is_read_ && !EndRequest::is_made()) {
      const follow::LineSource::Got got = source.next(line, kLongestPoll_s);
      if (got == follow::LineSource::Got::kEnd) break;
      if (got == follow::LineSource::Got::kLine) take(line);
      if (session_.has_channels() && seconds_since(saved_) > kSaveEvery_s) save();
    }
  }

  /// Waits until a row of a replay is due.
  void keep_pace(double time_s) {
    if (!(options_.pace > 0.0) || options_.replay.empty() || !std::isfinite(time_s)) return;
    if (!first_s_) {
      first_s_ = time_s;
      began_ = Clock::now();
    }
    const auto due = began_ + std::chrono::duration_cast<Clock::duration>(
                                  std::chrono::duration<double>((time_s - *first_s_) / options_.pace));
    while (Clock::now() < due && !EndRequest::is_made())
      std::this_thread::sleep_for(std::min<Clock::duration>(due - Clock::now(), std::chrono::milliseconds(250)));
  }

  /// @return whether a row was taken
  bool take(const std::string& line) {
    std::optional<follow::StreamRow> row;
    std::string why;
    try {
      row = text_.take(line);
    } catch (const RangeError& e) {
      why = e.what();
    }
    if (!session_.has_channels() && !text_.channels().empty()) begin();
    if (!session_.has_channels()) {
      if (!why.empty() && !link_)
        throw InputError(fmt::format("{}: {}; a header or a JSON row comes first", source_name_, why));
      if (!why.empty()) {  // anybody may write to the topic, and the real source may still come
        (void)std::fputs(fmt::format("{}: {}; `follow` waits for a header or a JSON row\n", options_.from, why).c_str(),
                         stderr);
        ++n_before_header_;
      }
      return false;
    }
    if (!row && why.empty()) return false;
    if (row) keep_pace(row->time_s);
    ++n_rows_;
    const follow::FollowLine said = row ? session_.take(std::move(*row)) : session_.pass_over(why);
    if (said.run_s) {
      ++n_taken_;
      if (record_) record_->add(session_.taken());
    }
    write(said);
    return said.run_s.has_value();
  }

  void begin() {
    require_probings();
    session_.begin(text_.channels());
    if (page_) page_->begin(text_.channels());
    const bool goes_on = !options_.state.empty() && follow::resume_from(options_.state, session_);
    if (goes_on) (void)std::fputs(fmt::format("follow: goes on from {}\n", options_.state).c_str(), stderr);
    if (!options_.record.empty())
      record_.emplace(options_.record, text_.channels(), fmt::format("driftwright {} follow", kVersion), goes_on);
    saved_ = Clock::now();
  }

  void require_probings() const {
    const bool has_options = !options_.probe_noise.empty() || !options_.probe_lag.empty() || !options_.tolerance.empty();
    if (!has_options || std::any_of(text_.channels().begin(), text_.channels().end(), follow::is_probing)) return;
    throw InputError(
        "--probe-noise, --probe-lag and --tolerance require a column of probings, probe_AXIS_um or probe_left_AXIS_um, "
        "which "
        "the stream does not have (docs/how-to/probing.md)");
  }

  void write(const follow::FollowLine& said) {
    if (page_) page_->feed().offer(page_row(session_, said));
    const std::string text = follow::line_text(said) + "\n";
    is_read_ = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
    if (!is_read_ && errno != EPIPE) throw InputError("standard output: not all could be written; is the disk full?");
    std::clearerr(stdout);
    if (link_ && !options_.to.empty() && !link_->publish(options_.to, text.substr(0, text.size() - 1))) ++n_unheard_;
  }

  void save() {
    if (!options_.state.empty()) follow::write_state(options_.state, session_);
    if (record_) record_->flush();
    saved_ = Clock::now();
  }

  void tell() const {
    std::vector<std::string> faults;
    for (std::size_t f = 0; f < session_.faults().size(); ++f) {
      if (session_.faults()[f] > 0)
        faults.push_back(fmt::format("{} {}", follow::fault_words(static_cast<follow::Fault>(f)), session_.faults()[f]));
    }
    (void)std::fputs(fmt::format("follow: {} rows, {} taken{}{}\n", n_rows_, n_taken_, faults.empty() ? "" : "; ",
                                 fmt::join(faults, ", "))
                         .c_str(),
                     stderr);
    if (n_before_header_ > 0)
      (void)std::fputs(fmt::format("follow: {} lines before the header could not be read\n", n_before_header_).c_str(),
                       stderr);
    if (n_unheard_ > 0)
      (void)std::fputs(
          fmt::format("follow: {} lines could not be sent, because no broker was connected\n", n_unheard_).c_str(), stderr);
    if (link_ && link_->n_lost() > 0)
      (void)std::fputs(
          fmt::format("follow: {} messages came faster than they could be processed\n", link_->n_lost()).c_str(), stderr);
  }

  const FollowVerbOptions& options_;
  Progress progress_;
  std::string source_name_;
  follow::RowText text_;
  follow::Session session_;
  std::optional<EndRequest> end_request_;
  std::optional<follow::RecordFile> record_;
  Clock::time_point saved_ = Clock::now(), began_;
  std::optional<double> first_s_;
  std::int64_t n_rows_ = 0, n_taken_ = 0;
  bool is_read_ = true;  // false once nothing reads standard output
  bool is_silent_ = false;
  std::int64_t n_unheard_ = 0, n_before_header_ = 0;
  std::unique_ptr<follow::MqttLink> link_;
  std::unique_ptr<follow::PageServer> page_;
};

}  // namespace

namespace {

/// Writes the limits for the watch of an observer.
void calibrate_watch(const FollowVerbOptions& options) {
  const std::optional<double> top_rpm = quantity("--top-speed", options.top_speed, "rpm");
  if (!top_rpm)
    throw InputError("--calibrate-watch requires --top-speed, such as '2500 rpm': the speeds that the machine works at");
  if (options.models.size() != 1) throw InputError("--calibrate-watch: limits are those of one observer; name one file");
  const std::string& path = options.models.front();
  const output::PredictorFile file = output::read_predictor(path);
  const compensation::Observer* observer = file.predictor.predictor->observer();
  if (!observer)
    throw InputError(fmt::format(
        "{}: '{}' is no observer, and only an observer has residuals that physics explains; the fail-safe of a formula "
        "says which thermometers are in doubt",
        path, file.predictor.name));
  const std::vector<std::string> sensors = follow::watchable_sensors(*observer, {});
  Progress progress;
  const follow::WatchLimits limits = follow::simulated_limits(
      *observer, sensors, {.top_rpm = *top_rpm}, follow::kTrialMachines, follow::kTrialDays, progress.listener());
  progress.end();
  write_bytes(options.calibrate_watch, follow::watch_json(limits, content_hash(read_bytes(path))).dump(1) + "\n");
  fmt::print("{}: {} thermometers ({}), {} machines, {:.0f} machine-days, {} daily maxima above their thresholds\n",
             options.calibrate_watch, sensors.size(), fmt::join(sensors, ", "), follow::kTrialMachines, limits.machine_days,
             limits.n_alarms);
}

}  // namespace

void follow_stream(const FollowVerbOptions& options) {
  if (!options.topics.empty() && options.mqtt.empty() && options.mtconnect.empty())
    throw InputError("--topic names where a channel's numbers come from, which requires --mqtt HOST or --mtconnect ADDRESS");
  if (!options.calibrate_watch.empty()) return calibrate_watch(options);
  if (options.pace < 0.0) throw InputError("--pace must be 0 (as fast as it goes) or more");
  if (options.pace > 0.0 && options.replay.empty()) throw InputError("--pace requires --replay FILE");
  if (options.serve) (void)page_address(options);  // checks the address before the slow meshing
  Following(options).run();
}

}  // namespace driftwright::app
