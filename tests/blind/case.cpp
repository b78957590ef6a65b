#include "blind/case.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/quantity.hpp"
#include "effects/where_in_files.hpp"

namespace driftwright::blind {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kMostDraws = 12;

/// How loud the effects of a case shall be. Odd seeds and even ones belong to other machines: a share needs its own draw.
double wanted_d_prime(Random& random) {
  const double share = random.uniform();
  if (share < 0.05) return random.log_uniform(1.5, 5.0);
  if (share < 0.15) return random.log_uniform(5.0, 10.0);
  return random.log_uniform(12.0, 60.0);
}

/// Laws that cannot be made quiet (a factor within the prior is calibration, a swap has no size, a stop lasts some
/// minutes) may be louder than required.
bool fits(const Hidden& h, double d, double wanted) {
  constexpr double kLoudest = 200.0;
  const bool may_be_louder = wanted >= 12.0 && (is_factor(h.what) || !has_size(h.what) || h.what == Hide::kMissingStop);
  return d > wanted / 1.6 && d < (may_be_louder ? kLoudest : 1.6 * wanted);
}

Hidden draw_tuned(const Subject& s, const CasePlan& plan, const Loudness& loudness, Random& random, double wanted,
                  bool foreign) {
  Hidden best;
  double best_gap = std::numeric_limits<double>::infinity();
  for (int draw = 0; draw < kMostDraws; ++draw) {
    Hidden h = foreign ? draw_foreign(s, random) : draw_hidden(s, plan, random);
    const double d = tune(loudness, h, wanted);
    if (fits(h, d, wanted)) return h;
    const double gap = std::abs(std::log(std::max(1e-9, d) / wanted));
    if (gap < best_gap) {
      best = h;
      best_gap = gap;
    }
  }
  return best;
}

std::vector<Hidden> draw_effects(const Subject& s, Case& c, const Loudness& loudness, Random& random) {
  const double wanted = wanted_d_prime(random);
  switch (c.plan.of) {
    case CaseClass::kNone:
    case CaseClass::kConfounded:
      return {};
    case CaseClass::kOne:
      return {draw_tuned(s, c.plan, loudness, random, wanted, false)};
    case CaseClass::kOutside: {
      const bool foreign = random.chance(0.5);
      const Hidden h = draw_tuned(s, c.plan, loudness, random, wanted, foreign);
      if (!foreign) c.without = key_of(h.what);
      return {h};
    }
    case CaseClass::kTwo:
      break;
  }
  const Hidden first = draw_tuned(s, c.plan, loudness, random, wanted, false);
  const Eigen::VectorXd a = loudness.signature({first});
  const double aa = loudness.product(a, a);
  const double second_wanted = wanted_d_prime(random);
  Hidden second;
  for (int draw = 0; draw < kMostDraws; ++draw) {
    second = draw_tuned(s, c.plan, loudness, random, second_wanted, false);
    if (key_of(second.what) == key_of(first.what)) continue;
    const Eigen::VectorXd b = loudness.signature({second});
    const double bb = loudness.product(b, b), ab = loudness.product(a, b);
    if (fits(second, std::sqrt(bb), second_wanted) && ab * ab < 0.5 * aa * bb) break;
  }
  return {first, second};
}

void add_loudness(const Loudness& loudness, const std::vector<Hidden>& effects, std::vector<HiddenTruth>& list) {
  std::vector<Eigen::VectorXd> s;
  for (const Hidden& h : effects) s.push_back(loudness.signature({h}));
  for (std::size_t i = 0; i < effects.size(); ++i) {
    double own = loudness.product(s[i], s[i]);
    HiddenTruth truth{effects[i], std::sqrt(std::max(0.0, own)), 0.0};
    if (effects.size() == 2) {
      const double other = loudness.product(s[1 - i], s[1 - i]), both = loudness.product(s[0], s[1]);
      if (other > 0.0) own -= both * both / other;
    }
    truth.d_prime_beside_others = std::sqrt(std::max(0.0, own));
    list.push_back(truth);
  }
}

void write_text(const std::filesystem::path& path, const std::string& text) {
  const std::filesystem::path part = path.string() + ".part";
  {
    std::ofstream out(part, std::ios::binary);
    out << text;
    if (!out) throw InputError("blind_cases: cannot write " + path.string());
  }
  std::filesystem::rename(part, path);
}

Json read_json(const std::filesystem::path& path) {
  std::ifstream in(path);
  if (!in) throw InputError("blind_cases: cannot read " + path.string());
  try {
    return Json::parse(in);
  } catch (const Json::parse_error& e) {
    throw InputError("blind_cases: " + path.string() + ": " + e.what());
  }
}

Json truth_json(const Subject& s, const Case& c) {
  Json truth = {{"seed", c.plan.seed}, {"class", class_name(c.plan.of)}, {"machine", s.name}};
  truth["without"] = c.without.empty() ? Json(nullptr) : Json(c.without);
  truth["effects"] = Json::array();
  for (const HiddenTruth& t : c.hidden) {
    Json parameters = Json::array();
    for (const TruthParameter& p : parameters_of(t.hidden)) {
      parameters.push_back({{"name", p.name}, {"unit", p.unit}, {"value", p.value}});
    }
    const std::string key = key_of(t.hidden.what);
    const Json record =
        t.hidden.record < 0 ? Json(nullptr) : Json(c.plan.records[static_cast<std::size_t>(t.hidden.record)].name);
    truth["effects"].push_back({{"effect", key.empty() ? Json(nullptr) : Json(key)},
                                {"law", law_name(t.hidden.what)},
                                {"where", effects::where_in_files(t.hidden.where)},
                                {"parameters", parameters},
                                {"record", record},
                                {"d_prime", t.d_prime},
                                {"d_prime_beside_others", t.d_prime_beside_others}});
  }
  if (c.plan.of == CaseClass::kConfounded) {
    truth["confusion"] = c.plan.confusion;
    truth["confusable"] = c.plan.confusable;
  }
  truth["channels"] = Json::array();
  for (std::size_t i = 0; i < s.n_outputs(); ++i) {
    if (i < s.n_sensors() && c.plan.displacements_only) continue;
    const Noise& n = c.plan.noise[i];
    truth["channels"].push_back({{"name", s.output_name(i)},
                                 {"unit", i < s.n_sensors() ? "degC" : "um"},
                                 {"white", n.white},
                                 {"slow", n.slow},
                                 {"slow_min", n.slow_s / 60.0},
                                 {"quantum", n.quantum},
                                 {"noise", n.total()}});
  }
  truth["ambient_noise_K"] = c.plan.ambient_noise_K;
  Json scatter = Json::object();
  for (std::size_t p = 0; p < s.scatter.size(); ++p) scatter[fmt::format("{} #{}", s.scatter[p].name, p)] = c.scatter_z[p];
  truth["scatter_z"] = scatter;
  return truth;
}

}  // namespace

double truth_step_s(const Subject& s) {
  return s.is_lumped() ? 5.0 : 30.0;
}

Case make_case(const Subject& s, std::uint64_t seed) {
  Case c{.plan = draw_plan(s, seed), .values = nominal_values(s), .scatter_z = {}, .hidden = {}, .without = {}};
  Random effects(seed, 3), scatters(seed, 4);
  std::vector<Hidden> hidden;
  if (c.plan.of == CaseClass::kConfounded) {
    constexpr double kLoudEnough = 8.0;
    for (int draw = 0; draw < kMostDraws; ++draw) {  // each changes the records, which decide how loud it is
      c.plan = draw_plan(s, seed);
      hidden = draw_confounded(s, c.plan, effects);
      const Loudness loudness(s, c.plan);
      if (hidden.size() == 1) (void)tune(loudness, hidden.front(), effects.log_uniform(12.0, 60.0));
      c.hidden.clear();
      add_loudness(loudness, hidden, c.hidden);
      const Eigen::VectorXd all = loudness.signature(hidden);
      if (loudness.product(all, all) > kLoudEnough * kLoudEnough) break;
    }
  } else if (c.plan.of != CaseClass::kNone) {
    const Loudness loudness(s, c.plan);
    hidden = draw_effects(s, c, loudness, effects);
    add_loudness(loudness, hidden, c.hidden);
  }
  for (const ScatterParameter& p : s.scatter) {
    double z = scatters.normal();
    for (const Hidden& h : hidden) {
      if (stands_on(h, p)) z = 0.0;  // so that the factor is the hidden one alone
    }
    c.scatter_z.push_back(z);
    scale(c.values, p, std::exp(p.sigma * z));
  }
  return c;
}

Record measured(const Subject& s, const Case& c, std::size_t record) {
  const RecordPlan& planned = c.plan.records[record];
  std::vector<Hidden> hidden;
  for (const HiddenTruth& t : c.hidden) hidden.push_back(t.hidden);
  const double step_s = truth_step_s(s);
  const Readings r = readings_of(s, c.values, hidden, c.plan, record, step_s, !s.is_lumped());
  const auto n = static_cast<std::size_t>(std::llround(planned.drive.duration_s() / kRow_s)) + 1;
  const double reference_degC = s.model.reference_K - kZeroCelsius_K;
  Record out{.source = planned.name, .time_s = {}, .channels = {}};
  Channel speed{"speed", "rpm", {}}, ambient{"ambient", "degC", {}};
  Random air(c.plan.seed, 1000 + record);
  for (std::size_t k = 0; k < n; ++k) {
    const double t_s = static_cast<double>(k) * kRow_s;
    out.time_s.push_back(t_s);
    speed.values.push_back(planned.drive.speed_rpm(t_s));
    ambient.values.push_back(reference_degC + planned.ambient.at(t_s) + c.plan.ambient_noise_K * air.normal());
  }
  out.channels = {speed, ambient};
  for (std::size_t i = 0; i < s.n_outputs(); ++i) {
    const bool is_temperature = i < s.n_sensors();
    if (is_temperature && c.plan.displacements_only) continue;
    const Noise& noise = c.plan.noise[i];
    Random random(c.plan.seed, 2000 + 100 * record + i);
    Channel channel{s.output_name(i), is_temperature ? "degC" : "um", {}};
    const double kept = std::exp(-kRow_s / noise.slow_s), fresh = std::sqrt(1.0 - kept * kept);
    double slow = random.normal();
    for (std::size_t k = 0; k < n; ++k) {
      const auto column = static_cast<Eigen::Index>(std::llround(out.time_s[k] / step_s));
      double reading = r.value(static_cast<Eigen::Index>(i), column) * (is_temperature ? 1.0 : 1e6) +
                       (is_temperature ? reference_degC : 0.0);
      reading += noise.white * random.normal() + noise.slow * slow;
      slow = kept * slow + fresh * random.normal();
      if (noise.quantum > 0.0) reading = noise.quantum * std::round(reading / noise.quantum);
      channel.values.push_back(reading);
    }
    out.channels.push_back(std::move(channel));
  }
  return out;
}

void write_case(const Subject& s, const Case& c, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  if (!s.drawing.empty()) {
    const std::filesystem::path parts = folder.parent_path() / "parts", drawing = s.drawing;
    std::filesystem::create_directories(parts);
    if (!std::filesystem::exists(parts / drawing.filename()))
      std::filesystem::copy_file(drawing, parts / drawing.filename());
  }
  write_text(folder / "scenario.yaml", s.yaml);
  for (std::size_t i = 0; i < c.plan.records.size(); ++i) {
    write_text(folder / (c.plan.records[i].name + ".csv"), record_csv(measured(s, c, i)));
  }
  write_text(folder / "truth.json", truth_json(s, c).dump(2) + "\n");
}

Record further_record(const Subject& s, Case of, Cyclogram cyclogram, std::uint64_t further) {
  Random ambient(of.plan.seed, 5000 + further);
  const double duration_s = cyclogram.duration_s();
  of.plan.records.resize(of.plan.records.size() + further);  // seeds of noise go by the number of the record
  of.plan.records.push_back({"further", std::move(cyclogram), draw_ambient(duration_s, ambient)});
  return measured(s, of, of.plan.records.size() - 1);
}

const Subject& CaseMaker::subject(std::size_t which) {
  std::unique_ptr<Subject>& subject = subjects_[which];
  if (!subject) subject = std::make_unique<Subject>(make_subject(machines_, subject_names()[which], mesh_share_));
  return *subject;
}

bool CaseMaker::make(std::uint64_t seed, const std::filesystem::path& out) {
  const std::filesystem::path folder = out / fmt::format("case_{:04d}", seed);
  if (std::filesystem::exists(folder / "truth.json")) return false;
  const Subject& of = subject(subject_of(seed));
  write_case(of, make_case(of, seed), folder);
  return true;
}

std::optional<Record> CaseMaker::proposed(const std::filesystem::path& folder, const std::filesystem::path& diagnosis_json) {
  const Json truth = read_json(folder / "truth.json"), diagnosis = read_json(diagnosis_json);
  if (!truth.contains("seed")) throw InputError("blind_cases: " + folder.string() + ": truth.json without a seed");
  if (diagnosis.value("verdict", "") != "ambiguous" || !diagnosis["discriminating_experiment"].is_object())
    return std::nullopt;
  const Json& experiment = diagnosis["discriminating_experiment"];
  if (experiment.value("proposes", "cyclogram") != "cyclogram") return std::nullopt;
  Cyclogram cyclogram{.name = "further", .sections = {}};
  for (const Json& section : experiment.at("cyclogram").at("sections"))
    cyclogram.sections.push_back({60.0 * section.at("duration_min").get<double>(), {.speed_rpm = section.at("speed_rpm")}});
  const auto seed = truth["seed"].get<std::uint64_t>();
  const Subject& of = subject(subject_of(seed));
  return further_record(of, make_case(of, seed), cyclogram, 0);
}

}  // namespace driftwright::blind
