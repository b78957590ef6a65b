#include "follow/followed_predictor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/file_bytes.hpp"
#include "base/quantity.hpp"
#include "compensation/predictors/deployed_follower.hpp"
#include "compensation/predictors/observer.hpp"
#include "effects/effect.hpp"
#include "effects/recorded_column.hpp"
#include "follow/axis_probing.hpp"
#include "follow/state_json.hpp"
#include "follow/watch_json.hpp"
#include "output/predictor_file.hpp"

namespace driftwright::follow {
namespace {

using namespace compensation;

constexpr double kRoom = 0.2, kLeastRoom_K = 3.0;  // beyond what was judged, as the fail-safe allows beyond training

/// Why a law cannot be followed on a stream; "" if it can.
std::string why_not(const effects::Effect& e) {
  for (const effects::Mention& mention : e.kind->mentions) {
    if (mention.of != effects::Mention::Of::kColumn) continue;
    if (const auto word = e.words.find(mention.name);
        word != e.words.end() && !word->second.empty() && !effects::is_drive_channel(word->second))
      return fmt::format("its law '{}' follows the recorded column '{}', which `follow` does not hand on yet", e.name(),
                         word->second);
  }
  if (!e.in.empty()) return fmt::format("its law '{}' holds in the cyclogram '{}' alone", e.name(), e.in);
  if (e.from_s > 0.0 || e.until_s < effects::kNever_s)
    return fmt::format("its law '{}' holds for a part of a run, and a stream has no end or beginning that would say which",
                       e.name());
  return "";
}

/// @throws InputError  for a predictor with laws that a stream cannot provide
void require_laws_of_streams(const Predictor& predictor, const std::string& path) {
  for (const effects::Effect& law : predictor.laws()) {
    if (const std::string why = why_not(law); !why.empty())
      throw InputError(fmt::format("{}: cannot be followed: {}", path, why));
  }
}

OutputSettings settings_of(const DeployedPredictor& d, const FollowOptions& o) {
  OutputSettings s;
  if (d.fail_safe) s = {d.fail_safe->most_rate_um_s, d.fail_safe->stale_s, d.fail_safe->fade_s};
  s.most_rate_um_s = o.most_rate_um_s.value_or(s.most_rate_um_s);
  s.hold_s = o.hold_s.value_or(s.hold_s);
  s.fade_s = o.fade_s.value_or(s.fade_s);
  return s;
}

Probe probe_of(const DeployedPredictor& d, const FollowOptions& o) {
  return {o.probe_noise_um.value_or(d.probe.noise_um), o.probe_lag_s.value_or(d.probe.lag_s)};
}

class FollowedPredictor final : public Followed {
 public:
  FollowedPredictor(const std::string& path, const FollowOptions& options)
      : path_(path),
        file_(output::read_predictor(path)),
        follower_(file_.predictor),
        stage_(settings_of(file_.predictor, options)),
        probe_(probe_of(file_.predictor, options)),
        tolerance_um_(options.tolerance_um) {
    require_laws_of_streams(*d().predictor, path);
    if (d().predictor->is_driven() && d().ambient.empty())
      throw InputError(
          fmt::format("{}: cannot be followed: '{}' takes the ambient from its scenario, and a stream has none; a "
                      "thermometer of the ambient (`node: ambient`) or `ambient` in the records it is fitted on is required",
                      path, d().name));
    if (file_.judged.is_object() && file_.judged.contains("verdict") && file_.judged["verdict"].is_string())
      axis_.verdict = file_.judged["verdict"].get<std::string>();
    if (!options.despite_verdict) refuse_unsafe();
    const Observer* observer = d().predictor->observer();
    if (!options.watch.empty()) {
      if (!observer) throw InputError(fmt::format("--watch: {} holds no observer, whose residuals could be watched", path));
      watch_.emplace(*observer, read_watch(options.watch, content_hash(read_bytes(path))));
    } else if (observer && !options.no_watch && !file_.watch.is_null()) {
      try {
        watch_.emplace(*observer, limits_of(file_.watch));
      } catch (const std::exception& e) {
        throw InputError(fmt::format("{}: key `watch`: {}", path, e.what()));
      }
    }
    axis_.name = d().target;
  }

  [[nodiscard]] std::vector<WantedChannel> wanted() const override {
    std::vector<WantedChannel> list;
    const auto want = [&](const std::string& name, const std::string& unit) {
      if (std::none_of(list.begin(), list.end(), [&](const WantedChannel& w) { return w.name == name; }))
        list.push_back({name, unit, path_});
    };
    for (const Input& input : d().predictor->inputs()) want(input.name, input.unit);
    if (d().fail_safe) {
      for (const FailSafe::Guard& g : d().fail_safe->guards) want(g.input, g.unit);
    }
    if (d().predictor->is_driven()) {
      want(d().ambient, "degC");
      want("speed", "rpm");
    }
    if (watch_) {
      for (const std::string& name : watch_->limits().sensors) want(name, "degC");
    }
    return list;
  }

  [[nodiscard]] std::vector<std::string> probings(const std::vector<Channel>& channels) const override {
    std::vector<std::string> columns = AxisProbing::columns_of(d().target, channels);
    if (!columns.empty() && !d().residual)
      throw InputError(fmt::format(
          "the stream has the column '{}_um', but {} does not say what '{}' leaves (key `probing` is null or missing); "
          "`validate` writes it where parts of the training runs could be left out. Leave the column out, or follow "
          "another strategy",
          columns.front(), path_, d().name));
    return columns;
  }

  void begin(const std::vector<Channel>& channels) override {
    if (!probings(channels).empty()) {
      std::vector<std::string> names = {d().name};
      for (const MemberResidual& m : d().member_residuals) names.push_back(m.name);
      probing_.emplace(d().target, std::move(names), probe_processes_of(d(), probe_), channels);
      predicted_um_.assign(1 + d().member_residuals.size(), 0.0);
    }
    const bool is_driven = d().predictor->is_driven();
    for (std::size_t k = 0; k < channels.size(); ++k) {
      if (channels[k].name == "speed" && channels[k].unit == "rpm") speed_ = k;
    }
    run_.emplace(channels, is_driven ? d().ambient : "", d().predictor->reference_K(), is_driven);
  }

  bool take(double run_s, const std::vector<double>& as_read, double step_s) override {
    const std::vector<double> values = without_impossible_drive(as_read);
    if (is_too_soon(run_s, step_s)) {
      run_->between(run_s, values);
      probe(step_s, values);
      stage_.take(wanted_um(), step_s, run_->drive_age_s());
      return true;
    }
    if (!run_->add(run_s, values)) {
      if (probing_) probing_->hear(values);  // too early: it is refused
      return false;
    }
    const FollowedCorrection c = follower_.next(run_->run());
    if (watch_) (void)watch_->next(run_->run());
    const double covered = share_covered();
    trust_ = c.trust * covered;
    axis_.interval_um = c.interval_um;
    half_width_um_ = c.half_width_um;
    axis_.predicted_um = c.correction_um * covered;
    predicted_um_ = {axis_.predicted_um};
    for (double member_um : c.members_um) predicted_um_.push_back(member_um * covered);
    probe(step_s, values);
    stage_.take(wanted_um(), step_s, run_->drive_age_s());
    return true;
  }
  void wait(double step_s) override {
    if (has_begun() && probing_) probing_->wait(predicted_um_, stage_.state().correction_um, step_s);
    stage_.wait(step_s);
  }
  [[nodiscard]] bool has_begun() const override { return run_ && run_->n_rows() > 0; }

  [[nodiscard]] std::vector<AxisCorrection> axes() const override {
    AxisCorrection axis = axis_;
    axis.correction_um = stage_.state().correction_um;
    axis.trust = trust_ * stage_.state().authority;
    if (!has_begun()) axis.trust = 0.0;
    if (!(axis.trust > 0.0)) axis.interval_um.reset();
    if (probing_) set_probing(axis);
    const double residual_um = probing_ ? probing_->residual_um() : 0.0;
    if (axis.interval_um) *axis.interval_um += std::abs(axis.predicted_um + residual_um - axis.correction_um);
    axis.doubted = follower_.doubted();
    if (has_begun() && share_covered() < 1.0) axis.doubted.emplace_back("speed or ambient: beyond those it was judged on");
    if (has_begun()) {
      for (std::string& name : run_->older_than(stage_.most_age_s())) axis.doubted.push_back(std::move(name));
    }
    if (has_begun()) axis.deviation_um = follower_.follower().deviation_um();
    if (watch_ && has_begun()) {
      axis.watch_level = watch_->level();
      if (const auto& alarm = watch_->alarm())
        axis.alarm = fmt::format("since {:.0f} min: {}", alarm->since_s / 60.0, alarm->words);
    }
    return {axis};
  }

  [[nodiscard]] Json state() const override {
    if (!has_begun()) return {{"run", nullptr}, {"stage", state_json(stage_.state())}};
    return {{"run", state_json(run_->state())},
            {"memory", numbers_json(follower_.memory())},
            {"trust", trust_},
            {"predicted_um", axis_.predicted_um},
            {"watch", watch_ ? numbers_json(watch_->memory()) : Json(nullptr)},
            {"probing", probing_ ? numbers_json(probing_->memory()) : Json(nullptr)},
            {"stage", state_json(stage_.state())}};
  }
  void recall(const Json& j) override {
    stage_.recall(output_stage_of(output::value<Json>(j, "stage")));
    const auto run = output::value<Json>(j, "run");
    if (run.is_null()) return;
    run_->recall(live_run_of(run));
    follower_.recall(numbers_of(j, "memory"));
    if (watch_) {
      if (output::value<Json>(j, "watch").is_null())
        throw InputError("it was saved without a watch; add --no-watch, or begin a new state");
      watch_->recall(numbers_of(j, "watch"));
    }
    if (probing_) {  // a state of the same columns has it
      const std::vector<double> memory = numbers_of(j, "probing");
      if (memory.size() != probing_->memory().size())
        throw InputError("its probings were saved by another version of the program");
      probing_->recall(memory);
    }
    trust_ = output::finite(j, "trust");
    axis_.predicted_um = output::finite(j, "predicted_um");
    if (probing_) predicted_um_ = probing_->predicted_um();
    if (predicted_um_.size() == 1) predicted_um_ = {axis_.predicted_um};
  }

 private:
  /// A correction by what left more than none where it was judged is no protection.
  void refuse_unsafe() const {
    if (axis_.verdict != "unsafe") return;
    const bool has_why = file_.judged.contains("why") && file_.judged["why"].is_string();
    const std::string why = has_why ? file_.judged["why"].get<std::string>() : std::string();
    throw InputError(
        fmt::format("{}: `validate` judged '{}' unsafe{}. Follow a strategy that its report calls safe, or add "
                    "--despite-verdict where nothing is cut",
                    path_, d().name, why.empty() ? "" : " (" + why + ")"));
  }

  /// Whether a row comes sooner than the predictor takes rows. An observer takes them as far apart as those it was fitted
  /// on, because its memory and its doubts count in rows.
  [[nodiscard]] bool is_too_soon(double run_s, double step_s) const {
    return has_begun() && run_->since_row_s(run_s) + 0.5 * step_s < d().predictor->period_s();
  }

  /// How far a value is within a range: 1 in it and a fifth of its width beyond, 0 another width further; as the fail-safe
  /// has it.
  [[nodiscard]] static double share_within(double value, double low, double high, double least_room) {
    const double width = std::max(high - low, least_room), room = std::max(kRoom * width, least_room);
    const double beyond = std::max({low - room - value, value - high - room, 0.0});
    return std::max(0.0, 1.0 - beyond / width);
  }
  [[nodiscard]] double speed_covered(double rpm) const { return share_within(rpm, 0.0, file_.covered->most_rpm, 1.0); }
  /// Trust that speed and ambient of the last row justify.
  [[nodiscard]] double share_covered() const {
    if (!file_.covered) return 1.0;
    const double ambient_degC = run_->ambient_K() + d().predictor->reference_K() - kZeroCelsius_K;
    return speed_covered(run_->drive().speed_rpm) *
           share_within(ambient_degC, file_.covered->low_degC, file_.covered->high_degC, kLeastRoom_K);
  }
  /// A speed so far beyond those it was judged on that nothing is known there is no reading: laws have no value there.
  [[nodiscard]] std::vector<double> without_impossible_drive(std::vector<double> values) const {
    if (!file_.covered || !speed_ || !(values[*speed_] >= 0.0) || speed_covered(values[*speed_]) > 0.0) return values;
    values[*speed_] = std::numeric_limits<double>::quiet_NaN();
    return values;
  }

  /// A row for the probings, with the prediction that it has led to.
  void probe(double step_s, const std::vector<double>& values) {
    if (!probing_) return;
    probing_->wait(predicted_um_, stage_.state().correction_um, step_s);
    probing_->hear(values);
  }
  /// The predictor's value with what probings have found, within the clamp of the fail-safe.
  [[nodiscard]] double wanted_um() const {
    if (!probing_) return axis_.predicted_um;
    const double um = axis_.predicted_um + probing_->residual_um();
    return d().fail_safe ? std::clamp(um, d().fail_safe->lowest_um, d().fail_safe->highest_um) : um;
  }
  void set_probing(AxisCorrection& axis) const {
    axis.probing = probing_->state(axis.interval_um ? half_width_um_ : std::nullopt);
    if (!axis.interval_um || !half_width_um_) return;
    *axis.interval_um += probing_->interval_um(*half_width_um_) - *half_width_um_;
    if (tolerance_um_ && *axis.interval_um > 0.5 * *tolerance_um_)  // a way that the axis still has to go needs no probing
      axis.probing->probe_now = fmt::format("probe now: the interval of {:.1f} um passes half of the tolerance of {:g} um",
                                            *axis.interval_um, *tolerance_um_);
  }

  [[nodiscard]] const DeployedPredictor& d() const { return file_.predictor; }

  std::string path_;
  output::PredictorFile file_;
  DeployedFollower follower_;
  OutputStage stage_;
  std::optional<LiveRows> run_;
  std::optional<Watch> watch_;
  Probe probe_;
  std::optional<double> tolerance_um_;
  std::optional<AxisProbing> probing_;   // with a column of probings
  std::optional<double> half_width_um_;  // of the interval about the prediction, in the last row
  std::vector<double> predicted_um_;     // of the axis, then of each member of a blend whose weights move
  AxisCorrection axis_;
  std::optional<std::size_t> speed_;  // channel
  double trust_ = 0.0;
};

}  // namespace

std::unique_ptr<Followed> followed_predictor(const std::string& path, const FollowOptions& options) {
  return std::make_unique<FollowedPredictor>(path, options);
}

}  // namespace driftwright::follow
