#include "output/correction_in_c.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "base/characters.hpp"

namespace driftwright::output {
namespace {

using compensation::FailSafe;

/// Names that readings must not have: other arguments, and the component's pins, parameters and variables.
const std::vector<std::string> kTaken = {"s",
                                         "dt_s",
                                         "enable",
                                         "machine_is_on",
                                         "heartbeat",
                                         "restart",
                                         "period",
                                         "fperiod",
                                         "eoffset_counts",
                                         "eoffset_scale",
                                         "eoffset_enable",
                                         "correction_um",
                                         "axis_offset_um",
                                         "model_trust",
                                         "most_rate_um_s",
                                         "sign",
                                         "count_um",
                                         "machine_unit_um",
                                         "most_age_s",
                                         "step_s",
                                         "model",
                                         "axis",
                                         "position",
                                         "waited_s",
                                         "is_started",
                                         "heartbeat_is_late",
                                         "setting_is_wrong",
                                         "probed_um",
                                         "probe_um",
                                         "probe_strobe",
                                         "probe_residual_um",
                                         "probe_sigma_um",
                                         "probe_verdict",
                                         "probe_off_um",
                                         "refused_probings",
                                         "probe_noise_um",
                                         "probe_lag_s",
                                         "probing",
                                         "processes",
                                         "prediction_um",
                                         "probe_waited_s",
                                         "strobe_was_on"};

/// A name that C and HAL allow; HAL allows no two underscores in a row.
std::string c_name(const std::string& name) {
  std::string result = name.empty() || std::isdigit(static_cast<unsigned char>(name[0])) ? "x_" : "";
  for (char ch : name) {
    const char wanted = std::isalnum(static_cast<unsigned char>(ch)) ? ch : '_';
    if (wanted != '_' || result.empty() || result.back() != '_') result += wanted;
  }
  return result;
}

/// What each filter of probings knows: of the model, then of its members if their weights move.
std::vector<compensation::ResidualProcess> processes_of(const DeployedModel& d) {
  std::vector<compensation::ResidualProcess> processes = {*d.residual};
  for (const compensation::MemberResidual& m : d.member_residuals) processes.push_back(m.process);
  return processes;
}

/// `{deviation_um, time_constant_s, noise_um, lag_s, is_known_at_start}`.
std::string process_text(const compensation::ResidualProcess& p, const std::string& noise_um, const std::string& lag_s,
                         bool is_known) {
  return fmt::format("{{{}, {}, {}, {}, {}}}", c_number(p.deviation_um), c_number(p.time_constant_s), noise_um, lag_s,
                     is_known ? 1 : 0);
}

}  // namespace

std::string target_name(const std::string& target) {
  const std::string name = c_name(target);
  return name == "drift" || name == "probe" || name == "axis_offset" ? "x_" + name : name;
}

std::vector<std::string> reading_names(const std::vector<FailSafe::Guard>& guards, std::size_t longest) {
  std::vector<std::string> names, taken = kTaken;
  for (const FailSafe::Guard& g : guards) {
    const std::string plain = c_name(fmt::format("{}_{}", g.input, g.unit)).substr(0, longest);
    std::string name = plain;
    for (int k = 2; std::find(taken.begin(), taken.end(), name) != taken.end(); ++k)  // "a b" and "a-b" give the same name
      name = fmt::format("{}_{}", plain, k);
    names.push_back(name);
    taken.push_back(name);
  }
  return names;
}

std::string c_number(double x) {
  if (std::isinf(x)) return x > 0.0 ? "HUGE_VAL" : "-HUGE_VAL";
  const std::string text = fmt::format("{:.17g}", x);  // reads back exactly
  return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

std::string quoted_in_c(std::string text) {
  for (char& ch : text) {
    if (ch == '"' || ch == '\\') ch = '\'';
  }
  for (std::size_t at = 0; (at = text.find("*/")) != std::string::npos;) text.replace(at, 2, "* /");
  for (std::size_t at = 0; (at = text.find("/*")) != std::string::npos;) text.replace(at, 2, "/ *");
  return text;
}

ProbeCalls probe_calls(const DeployedModel& d, const std::string& settings, const std::string& state,
                       const std::string& prediction) {
  if (d.members.empty())
    return {.prefix = "probe",
            .arguments = fmt::format("&{}, &{}", settings, state),
            .prediction = prediction,
            .corrected = prediction + ", ",
            .said = state + ".",
            .refused = state + ".n_refused"};
  const std::size_t n = 1 + d.members.size();
  return {.prefix = "probe_members",
          .arguments = fmt::format("{}, {}.members, {}", settings, state, n),
          .prediction = state + ".predictions_um",
          .corrected = "",
          .said = fmt::format("probe_leading({}.members, {})->", state, n),
          .refused = state + ".members[0].n_refused"};
}

std::string processes_text(const DeployedModel& d, const std::string& noise_um, const std::string& lag_s) {
  std::vector<std::string> texts;
  for (const compensation::ResidualProcess& p : processes_of(d))
    texts.push_back(process_text(p, noise_um, lag_s, d.model.from_start));
  return d.members.empty() ? texts.front() : fmt::format("{{{}}}", fmt::join(texts, ", "));
}

PlacedReadings readings_of(std::span<const PlacedModel> places, std::size_t longest) {
  PlacedReadings r;
  for (const PlacedModel& p : places) {
    r.of_place.emplace_back();
    for (const FailSafe::Guard& g : p.model.safe.guards) r.of_place.back().push_back(reading_among(r.guards, g));
  }
  r.names = reading_names(r.guards, longest);
  return r;
}

}  // namespace driftwright::output
