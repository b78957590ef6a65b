#include "follow/state_json.hpp"

#include <cmath>

namespace driftwright::follow {

using output::finite, output::value;

namespace {

/// A number that states of earlier versions lack; it is 0 then.
double added(const Json& j, const char* key) {
  return j.contains(key) ? finite(j, key) : 0.0;
}

}  // namespace

Json numbers_json(const std::vector<double>& numbers) {
  Json list = Json::array();
  for (double x : numbers) list.push_back(output::number(x));
  return list;
}

std::vector<double> numbers_of(const Json& j, const char* key) {
  std::vector<double> numbers;
  for (const Json& x : output::list(j, key)) numbers.push_back(x.is_number() ? x.get<double>() : NAN);
  return numbers;
}

Json state_json(const LiveRows::State& s) {
  Json j = {{"start_s", s.start_s},
            {"rows", s.n_rows},
            {"time_s", s.time_s},
            {"hall_K", s.ambient_K},
            {"top_rpm", s.top_rpm},
            {"speed_age_s", s.speed_age_s},
            {"ambient_age_s", s.ambient_age_s},
            {"values", numbers_json(s.values)},
            {"speed_rpm", s.drive.speed_rpm},
            {"feed_m_s", s.drive.feed_m_s},
            {"cutting_power_W", s.drive.cutting_power_W}};
  if (s.followed.empty()) return j;
  j["followed"] = numbers_json(s.followed);
  j["followed_age_s"] = numbers_json(s.followed_age_s);
  return j;
}

LiveRows::State live_run_of(const Json& j) {
  return {.start_s = finite(j, "start_s"),
          .n_rows = value<std::size_t>(j, "rows"),
          .time_s = finite(j, "time_s"),
          .ambient_K = finite(j, "hall_K"),
          .top_rpm = finite(j, "top_rpm"),
          .speed_age_s = added(j, "speed_age_s"),
          .ambient_age_s = added(j, "ambient_age_s"),
          .values = numbers_of(j, "values"),
          .drive = {.speed_rpm = finite(j, "speed_rpm"),
                    .feed_m_s = value<std::array<double, 3>>(j, "feed_m_s"),
                    .cutting_power_W = finite(j, "cutting_power_W")},
          .followed = j.contains("followed") ? numbers_of(j, "followed") : std::vector<double>{},
          .followed_age_s = j.contains("followed") ? numbers_of(j, "followed_age_s") : std::vector<double>{}};
}

Json state_json(const OutputStage::State& s) {
  return {{"correction_um", s.correction_um},
          {"wanted_um", s.wanted_um},
          {"authority", s.authority},
          {"silent_s", s.silent_s},
          {"step_s", s.step_s}};
}

OutputStage::State output_stage_of(const Json& j) {
  return {.correction_um = finite(j, "correction_um"),
          .wanted_um = finite(j, "wanted_um"),
          .authority = finite(j, "authority"),
          .silent_s = finite(j, "silent_s"),
          .step_s = added(j, "step_s")};
}

Json state_json(const RowGuard::State& s) {
  Json counts = Json::object();
  for (std::size_t f = 0; f < s.counts.size(); ++f) counts[fault_words(static_cast<Fault>(f))] = s.counts[f];
  return {{"has_row", s.has_row},
          {"stamp_s", s.stamp_s},
          {"run_s", s.run_s},
          {"usual_s", s.usual_s},
          {"has_candidate", s.has_candidate},
          {"candidate_s", s.candidate_s},
          {"counts", std::move(counts)}};
}

RowGuard::State row_guard_of(const Json& j) {
  RowGuard::State s{.has_row = value<bool>(j, "has_row"),
                    .stamp_s = finite(j, "stamp_s"),
                    .run_s = finite(j, "run_s"),
                    .usual_s = finite(j, "usual_s"),
                    .has_candidate = value<bool>(j, "has_candidate"),
                    .candidate_s = finite(j, "candidate_s")};
  const auto counts = value<Json>(j, "counts");
  for (std::size_t f = 0; f < s.counts.size(); ++f)
    s.counts[f] = value<std::int64_t>(counts, fault_words(static_cast<Fault>(f)));
  return s;
}

}  // namespace driftwright::follow
