#include <fmt/format.h>
#include <fmt/ranges.h>

#include "effects/doubt.hpp"

namespace driftwright::effects {
namespace {

constexpr std::size_t kFewRuns = 5;  // of which every choice is tried

bool is_meant(const Effect& e, const Exchange& x) {
  return e.words.at("of") == "exchange" && x.body.kind != BodyKind::kJoint && x.surrounding == kAmbientName && !x.medium_K;
}

void change_laws(const Effect& e, HeatBalance& balance) {
  const auto change = [&](Law& law) {
    law.value = [value = law.value, factor = e["factor"], in = e.in](const Inputs& u) {
      return (in.empty() || u.run == in ? factor : 1.0) * value(u);
    };
  };
  for (HeatInput& h : balance.heats) {
    if (e.words.at("of") == "heat") change(h.power_W);
  }
  for (Exchange& x : balance.exchanges) {
    if (is_meant(e, x)) change(x.coefficient);
  }
}

void check(const Effect& e, const ConfigMap& in) {
  if (e.in.empty()) in.fail("in", "the cyclogram is wanted that ran in this state");
}

/// Runs that may have had a state of their own: of a few, every choice of some of them; of many, each alone and each split in order.
std::vector<std::vector<std::size_t>> choices_of(std::size_t n_runs) {
  std::vector<std::vector<std::size_t>> list;
  if (n_runs > kFewRuns) {
    for (std::size_t r = 0; r < n_runs; ++r) list.push_back({r});
    for (std::size_t first = 1; first + 1 < n_runs; ++first) {
      list.emplace_back();
      for (std::size_t r = first; r < n_runs; ++r) list.back().push_back(r);
    }
    return list;
  }
  for (unsigned chosen = 1; chosen + 1 < 1U << n_runs; ++chosen) {
    std::vector<std::size_t> runs;
    for (std::size_t r = 0; r < n_runs; ++r) {
      if (chosen >> r & 1U) runs.push_back(r);
    }
    list.push_back(std::move(runs));
  }
  return list;
}

std::vector<Doubt> doubts(const DoubtScene& s) {
  std::vector<Doubt> list;
  if (s.runs.size() < 2) return list;
  Effect films = make_effect("run_state", Place::kSpindle, place_key(Place::kSpindle));
  films.words["of"] = "exchange";
  const bool has_films =
      std::any_of(s.balance.exchanges.begin(), s.balance.exchanges.end(), [&](const auto& x) { return is_meant(films, x); });
  for (const char* of : {"heat", "exchange"}) {
    const bool is_heat = std::string(of) == "heat";
    if (is_heat ? s.balance.heats.empty() : !has_films) continue;
    for (const std::vector<std::size_t>& runs : choices_of(s.runs.size())) {
      Doubt d{.finding = "run_state", .where = "record", .law = {}, .added = {}, .numbers = {doubted_factor()}};
      std::vector<std::string> names;
      for (std::size_t r : runs) {
        names.push_back(s.runs[r].name);
        d.added.push_back(films);
        d.added.back().words["of"] = of;
        d.added.back().in = s.runs[r].name;
      }
      d.law = fmt::format("another state of running, all {} in {}", is_heat ? "heat" : "exchange with the ambient",
                          fmt::join(names, ", "));
      list.push_back(std::move(d));
    }
  }
  return list;
}

}  // namespace

EffectKind run_state() {
  return {.key = "run_state",
          .title = "a record in which the machine ran in another state: another oil, cover or preload, that nobody noted",
          .law = "P' = factor P of every heat, or c' = factor c of every exchange with the ambient, in one record",
          .places = {Place::kSpindle},
          .parameters = {{"factor", "1", 0.0, 1e4, 1.0, "on all of them"}},
          .timing = Timing::kInRecord,
          .change_laws = change_laws,
          .choices = {{"of", {"heat", "exchange"}, "heat", "what is another: all heat, or all exchange with the ambient"}},
          .check = check,
          .doubts = doubts};
}

}  // namespace driftwright::effects
