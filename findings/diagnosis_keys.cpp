#include "findings/diagnosis_keys.hpp"

#include "diagnosis/diagnosis.hpp"

namespace driftwright::findings {
namespace {

using output::ResultKey;
using ResultKind = ResultKey::Kind;

ResultKey text(const char* path, const char* meaning) {
  return {.path = path, .kind = ResultKind::kText, .meaning = meaning};
}
ResultKey words(const char* path, std::vector<std::string> all, const char* meaning) {
  return {.path = path, .kind = ResultKind::kText, .meaning = meaning, .words = std::move(all)};
}
ResultKey number(const char* path, const char* meaning) {
  return {.path = path, .kind = ResultKind::kNumber, .meaning = meaning};
}
ResultKey count(const char* path, const char* meaning) {
  return {.path = path, .kind = ResultKind::kCount, .meaning = meaning};
}
ResultKey flag(const char* path, const char* meaning) {
  return {.path = path, .kind = ResultKind::kFlag, .meaning = meaning};
}
ResultKey object(const char* path, const char* meaning = "") {
  return {.path = path, .kind = ResultKind::kObject, .meaning = meaning};
}
ResultKey sometimes(ResultKey key) {
  key.is_always = false;
  return key;
}
ResultKey or_null(ResultKey key) {
  key.or_null = true;
  return key;
}

void add_causes(std::vector<ResultKey>& keys) {
  using diagnosis::Standing;
  const std::vector<std::string> standings = {diagnosis::word(Standing::kSuspected), diagnosis::word(Standing::kAmbiguous),
                                              diagnosis::word(Standing::kNamed)};
  keys.insert(keys.end(),
              {object("causes[]", "what the simulation gets wrong, surest first"),
               text("causes[].effect", "key of the catalogue of effects"),
               words("causes[].standing", standings, "how surely it is a cause"),
               text("causes[].where", "where it acts; of several places \"a,b\"; `hall` is the ambient"),
               sometimes(text("causes[].own", "the scenario's own effects that it changes, each with its line in the file")),
               text("causes[].law", "its law in a sentence; empty where the effect has one law alone"),
               object("causes[].parameters[]", "its numbers"),
               text("causes[].parameters[].name", "key in the scenario"),
               number("causes[].parameters[].value", "in `unit`"),
               text("causes[].parameters[].unit", "\"1\" or empty: none"),
               number("causes[].parameters[].ci95[]", "interval of 95 %, from and to"),
               sometimes(text("causes[].doubt", "why it is only suspected")),
               flag("causes[].written", "whether the extended scenario holds it"),
               sometimes(text("causes[].why_not_written", "why it does not")),
               or_null(number("causes[].kept_out_nats",
                              "how much likelier rows kept out of the fit are with it than without it [nats]")),
               number("causes[].probability", "of the statement that it is a name of; of a number that has gone too far 0"),
               object("causes[].odds", "how the evidence shares what was fitted in its place"),
               number("causes[].odds.share", "its own"),
               number("causes[].odds.kind", "of its effect, wherever it sits"),
               number("causes[].odds.place", "of its place, within its kind"),
               number("causes[].log_evidence_gain",
                      "logarithm of how much more probable the data are with it, after its price [nats]"),
               ResultKey{.path = "causes[].alternatives",
                         .kind = ResultKind::kLike,
                         .meaning = "what the data cannot distinguish from it",
                         .like = "causes[]"}});
}

void add_statements(std::vector<ResultKey>& keys) {
  keys.insert(
      keys.end(),
      {or_null(
           number("probability_nothing_wrong", "that the scenario with its numbers as they are known explains the records")),
       object("statements[]",
              "what is missing, quantity by quantity and place by place, likeliest first; those of a hundredth and more"),
       words("statements[].quantity",
             {"heat", "exchange", "capacity", "reading", "displacement", "ambient", "speed", "clock"}, "what is wrong"),
       text("statements[].place[]",
            "body, surface, joint, thermometer or displacement; of an exchange both ends; \"all\": of the whole machine"),
       sometimes(text("statements[].at", "the surface of that body, or the joint of these")),
       text("statements[].follows",
            "constant, running, power of NAME, temperature of NAME, difference to NAME, since start, since stop, window, "
            "unknown ..."),
       text("statements[].law", "the same in full, with exponent, lag or times; empty: `follows` says all"),
       text("statements[].records[]", "the records in which it holds"),
       number("statements[].size", "in `unit`; of an unknown course its root mean square"),
       text("statements[].unit", "\"1\": a factor's logarithm, or a share"),
       number("statements[].ci95[]", "interval of 95 % by linear theory, from and to"),
       number("statements[].probability", "that this quantity is wrong at this place"),
       number("statements[].p_quantity", "that this quantity is wrong, wherever"),
       number("statements[].p_place", "that the place is this one, if the quantity is wrong"),
       number("statements[].p_follows", "that it follows this, if quantity and place are right"),
       number("statements[].log_evidence", "of the best set that it is in, over nothing [nats]"),
       object("statements[].course[]",
              "what the records ask for there over time, whatever it follows, if it alone is wrong"),
       text("statements[].course[].record", "file of the record"),
       number("statements[].course[].edge_min[]", "beginnings of the steps, and the end of the last one [min]"),
       number("statements[].course[].value[]", "of each step, in `unit`")});
}

void add_experiment(std::vector<ResultKey>& keys) {
  keys.insert(
      keys.end(),
      {or_null(object("discriminating_experiment", "what would distinguish the first cause from its alternatives")),
       text("discriminating_experiment.why", "what it is to distinguish"),
       words("discriminating_experiment.proposes", {"cyclogram", "extra_sensor"}, "the better of the two"),
       number("discriminating_experiment.decides",
              "share of what is uncertain of quantity, place and course that the record is expected to remove, 0 to 1"),
       object("discriminating_experiment.simulated"),
       count("discriminating_experiment.simulated.records", "simulated records of the experiment"),
       count("discriminating_experiment.simulated.told", "of these, after how many the true claim has a probability of 0.9"),
       sometimes(object("discriminating_experiment.extra_sensor", "a thermometer more")),
       text("discriminating_experiment.extra_sensor.region", "where it would sit"),
       number("discriminating_experiment.extra_sensor.difference_K", "how far the claims differ there [K]"),
       number("discriminating_experiment.extra_sensor.decides", "the same share with it"),
       object("discriminating_experiment.cyclogram", "another run"), text("discriminating_experiment.cyclogram.name", ""),
       object("discriminating_experiment.cyclogram.sections[]"),
       number("discriminating_experiment.cyclogram.sections[].duration_min", "[min]"),
       number("discriminating_experiment.cyclogram.sections[].speed_rpm", "[rpm]"),
       sometimes(number("discriminating_experiment.cyclogram.sections[].feed_x_mm_min", "[mm/min]; so of y and z")),
       sometimes(number("discriminating_experiment.cyclogram.sections[].feed_y_mm_min", "[mm/min]")),
       sometimes(number("discriminating_experiment.cyclogram.sections[].feed_z_mm_min", "[mm/min]"))});
}

void add_unexplained(std::vector<ResultKey>& keys) {
  keys.insert(
      keys.end(),
      {or_null(object("unexplained", "what no candidate explains, more than noise")),
       number("unexplained.rms", "of the channel where it is greatest, in `unit`"),
       text("unexplained.unit", "K, um or urad"), text("unexplained.where", "that channel"),
       object("unexplained.channels[]", "all in which it is visible, greatest first"),
       text("unexplained.channels[].name", ""), number("unexplained.channels[].rms", "in `unit`"),
       text("unexplained.channels[].unit", "K, um or urad"),
       number("unexplained.channels[].sigmas", "beyond what noise would have, in standard deviations of that"),
       sometimes(
           flag("unexplained.fails_held_out", "true where the causes predict kept-out rows clearly worse than none does")),
       sometimes(count("unexplained.statement", "of `statements`, counted from 0: that the catalogue has no name for")),
       sometimes(text("unexplained.statement_in_words", "the same")),
       or_null(object("process_noise", "where the model errs more than three times the noise")),
       number("process_noise.stays_alike_min", "time for which the heat stays alike [min]"),
       sometimes(flag("process_noise.at_most", "true where that time is the shortest of those tried")),
       sometimes(flag("process_noise.at_least", "true where it is the longest of them")),
       object("process_noise.bodies[]"),
       text("process_noise.bodies[].where", "body"),
       number("process_noise.bodies[].standard_deviation_W", "of heat that comes and goes [W]"),
       number("process_noise.bodies[].share", "of what all of it does to the readings")});
}

void add_gain(std::vector<ResultKey>& keys) {
  keys.insert(
      keys.end(),
      {object("data[]", "what is wrong with the records themselves"),
       text("data[].channel", ""),
       text("data[].what", "in words"),
       flag("data[].left_out", "whether these readings take no part"),
       object("gain", "measured minus simulated, before and after"),
       text("gain.holdout", "how rows were kept out of search and fit"),
       object("gain.channels[]"),
       text("gain.channels[].name", ""),
       text("gain.channels[].unit", "K, um or urad, of all below"),
       or_null(number("gain.channels[].rmse_before", "of the scenario as written, on rows kept out")),
       or_null(number("gain.channels[].rmse_calibrated", "with its own numbers fitted")),
       or_null(number("gain.channels[].rmse_named", "with the named causes and numbers fitted beside them")),
       or_null(number("gain.channels[].rmse_after", "of what is written")),
       or_null(number("gain.channels[].rmse_regression_drive", "of a regression on speed, ambient and recorded drives")),
       or_null(number("gain.channels[].rmse_regression_readings", "of one on thermometers besides")),
       number("gain.channels[].noise_floor", "the scatter of the readings alone"),
       or_null(number("gain.channels[].peak_before", "on rows kept out")),
       or_null(number("gain.channels[].peak_after", "on rows kept out")),
       or_null(number("gain.channels[].rmse_all_before", "of the scenario as written, over the whole of all records")),
       or_null(number("gain.channels[].rmse_written", "of the file written, over the whole of all records")),
       sometimes(object("gain.over_noise", "all channels together, over their noise")),
       or_null(number("gain.over_noise.as_written", "")),
       or_null(number("gain.over_noise.calibrated", "")),
       or_null(number("gain.over_noise.named", "")),
       or_null(number("gain.over_noise.extended", "")),
       sometimes(object("gain.remainder[]", "what could be learned beside the file written, on rows kept out of that")),
       text("gain.remainder[].name", ""),
       text("gain.remainder[].unit", "K, um or urad, of all below"),
       or_null(number("gain.remainder[].rmse_file", "of the file written")),
       or_null(number("gain.remainder[].rmse_with_remainder", "with what is learned beside it")),
       or_null(number("gain.remainder[].rmse_regression", "of a regression on speed, ambient and recorded drives")),
       number("gain.remainder[].noise_floor", "the scatter of the readings alone"),
       text("gain.remainder[].learned", "yes, or no: the file stays as it is"),
       sometimes(text("gain.taken_up", "causes left out, of which the fitted numbers may hold a part")),
       object("iso_230_3[]", "figures of ISO 230-3, one a record"),
       text("iso_230_3[].run", "file of the record"),
       sometimes(text("iso_230_3[].not_available", "why there are none")),
       sometimes(text("iso_230_3[].test", "rotating_spindle, linear_axes or environment")),
       sometimes(text("iso_230_3[].axes", "that move, of linear_axes")),
       sometimes(number("iso_230_3[].spindle_running_period_min", "[min]")),
       sometimes(number("iso_230_3[].axis_running_period_min", "[min], of linear_axes")),
       sometimes(number("iso_230_3[].duration_min", "[min], of environment")),
       sometimes(object("iso_230_3[].channels[]")),
       text("iso_230_3[].channels[].name", ""),
       text("iso_230_3[].channels[].unit", "um or urad, of all below"),
       or_null(number("iso_230_3[].channels[].range_first_60_min", "d(X),60")),
       or_null(number("iso_230_3[].channels[].range_running_period", "d(X),t")),
       or_null(number("iso_230_3[].channels[].at_end_of_running_period", "X at t")),
       or_null(number("iso_230_3[].channels[].range_whole_record", ""))});
}

void add_search(std::vector<ResultKey>& keys) {
  keys.insert(
      keys.end(),
      {flag("complete", "false: it was ended early, and holds what was known by then"),
       flag("weighed_by_model_error", "whether what the model misses counts as noise"),
       count("n_candidates", "causes that were weighed"), object("calibrated[]", "the scenario's own numbers as fitted"),
       text("calibrated[].name", "as the scenario calls it"), number("calibrated[].value", "in `unit`"),
       text("calibrated[].unit", ""),
       number("calibrated[].sigmas_of_prior", "how far it moved, in standard deviations of what is known of it"),
       number("calibrated[].ci95[]", "interval of 95 %, from and to"),
       number("calibrated[].known_to", "one standard deviation of what is known of it, in `known_to_unit`"),
       text("calibrated[].known_to_unit", "% of the number, or a unit"),
       sometimes(flag("calibrated[].written", "whether the scenario written holds it"))});
}

void add_compared(std::vector<ResultKey>& keys) {
  keys.insert(keys.end(), {object("compared", "channels of the records that the scenario has"),
                           count("compared.channels", "that were compared"), count("compared.of", "with those left out"),
                           object("compared.left_out[]", "columns that are neither compared nor a drive"),
                           text("compared.left_out[].name", ""), text("compared.left_out[].why", "in words")});
}

std::vector<ResultKey> common_keys(const std::string& scenario) {
  using diagnosis::Verdict;
  std::vector<std::string> verdicts;
  for (const Verdict v : {Verdict::kConsistent, Verdict::kSuspected, Verdict::kNamed, Verdict::kAmbiguous,
                          Verdict::kUnexplained, Verdict::kInsufficientData})
    verdicts.emplace_back(diagnosis::word(v));
  std::vector<ResultKey> keys = {text("program", "driftwright"), text("version", "of the program"),
                                 text("scenario", "its file"), words("verdict", verdicts, "what it comes to"),
                                 text("reason", "in a sentence")};
  add_compared(keys);
  add_causes(keys);
  add_experiment(keys);
  add_unexplained(keys);
  add_gain(keys);
  add_search(keys);
  keys.push_back(object(scenario.c_str(), "the scenario that is written"));
  keys.push_back(text((scenario + ".not_written[]").c_str(), "what it could not take, in sentences"));
  keys.push_back(text((scenario + ".written[]").c_str(), "what was changed, in sentences"));
  return keys;
}

}  // namespace

std::vector<ResultKey> diagnosis_keys() {
  std::vector<ResultKey> keys = common_keys("extended");
  add_statements(keys);
  return keys;
}

std::vector<ResultKey> calibration_keys() {
  std::vector<ResultKey> keys = common_keys("calibrated_scenario");
  keys.push_back(text("warning", "why the numbers alone do not explain the measurement; empty: they do"));
  return keys;
}

}  // namespace driftwright::findings
