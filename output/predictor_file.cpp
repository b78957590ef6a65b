#include "output/predictor_file.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "base/bounded_json.hpp"
#include "base/file_bytes.hpp"
#include "base/hashed_json.hpp"
#include "compensation/predictors/drift_model.hpp"
#include "compensation/predictors/predictor_kind.hpp"
#include "output/fail_safe_json.hpp"
#include "output/json_value.hpp"

namespace driftwright::output {
namespace {

using namespace compensation;

constexpr const char* kFormat = "driftwright predictor 1";

/// Requires that the predictor in the file is complete and unchanged since it was judged.
void require_whole(const Json& file) {
  if (!is_whole(file))
    throw InputError(
        "key `hash` does not fit what the file holds: it was damaged or changed, and is not what was judged; `validate` "
        "writes it anew");
}

/// The predictor that a file holds, whose content is under the name of its kind.
std::shared_ptr<const Predictor> predictor_of(const Json& file, const DriftTarget& target) {
  const auto word = value<std::string>(file, "predictor");
  std::vector<std::string> known;
  for (const PredictorKind& kind : predictor_kinds()) {
    if (kind.key == word) return kind.read(value<Json>(file, word.c_str()), target);
    known.push_back(kind.key);
  }
  throw InputError(fmt::format("key `predictor` is '{}'; {} are known", word, fmt::join(known, ", ")));
}

/// Requires that the fail-safe guards every input that the predictor does not look after.
void require_guards(const DeployedPredictor& d) {
  if (d.fail_safe && d.fail_safe->from_start != d.from_start)
    throw InputError("`from_start` of the predictor and of its `fail_safe` differ; they must say the same");
  if (const std::optional<Input> input = unguarded_input(d))
    throw InputError(fmt::format("input '{}' in {} has no guard in `fail_safe`", input->name, input->unit));
}

/// What the file holds of a predictor. @throws std::logic_error  for one that must not be deployed so
Written written_of(const DeployedPredictor& d) {
  if (const std::optional<Input> input = unguarded_input(d))
    throw std::logic_error(
        fmt::format("'{}' reads '{}' in {} without a guard; its fail-safe must guard each of guarded_inputs()", d.name,
                    input->name, input->unit));
  std::optional<Written> written = d.predictor->written();
  if (!written) throw std::logic_error(fmt::format("'{}' is not stored in files: its written() gives nothing", d.name));
  const std::vector<PredictorKind>& kinds = predictor_kinds();
  if (std::none_of(kinds.begin(), kinds.end(), [&](const PredictorKind& kind) { return kind.key == written->kind; }))
    throw std::logic_error(fmt::format(
        "no file with a predictor of the kind '{}' could be read; the list PREDICTOR_KINDS must name it", written->kind));
  return *std::move(written);
}

Json process_json(const ResidualProcess& process) {
  return {{"deviation_um", process.deviation_um},
          {"time_constant_s", process.time_constant_s},
          {"reading_um", process.reading_um}};
}

Json probing_json(const DeployedPredictor& d) {
  if (!d.residual) return nullptr;
  Json j = process_json(*d.residual);
  j["noise_um"] = d.probe.noise_um;
  j["lag_s"] = d.probe.lag_s;
  for (const MemberResidual& m : d.member_residuals) {
    Json member = {{"name", m.name}};
    member.update(process_json(m.process));
    j["members"].push_back(std::move(member));
  }
  return j;
}

ResidualProcess read_process(const Json& j) {
  const ResidualProcess process{positive(j, "deviation_um"), positive(j, "time_constant_s"), finite(j, "reading_um")};
  if (process.reading_um < 0.0)
    throw InputError(fmt::format("key `reading_um` is {}; it must be 0 or more", process.reading_um));
  return process;
}

/// What the members of a blend leave. Without it, its weights do not move.
void read_members(const Json& j, DeployedPredictor& d) {
  const Json members = list(j, "members");
  const std::size_t n = d.predictor->members() ? d.predictor->members()->size() : 0;
  if (members.size() != n)
    throw InputError(fmt::format("key `members` has {} entries, but the formula has {} `members`; each must have one",
                                 members.size(), n));
  for (const Json& member : members)
    d.member_residuals.push_back({value<std::string>(member, "name"), read_process(member)});
}

/// What probings need. Files of earlier versions have none.
void read_probing(const Json& file, DeployedPredictor& d) {
  if (!file.contains("probing") || file["probing"].is_null()) return;
  const auto j = value<Json>(file, "probing");
  if (!j.is_object()) throw InputError(fmt::format("key `probing` is {}; it must be a map, or null", j.dump()));
  try {
    d.residual = read_process(j);
    d.probe = {positive(j, "noise_um"), finite(j, "lag_s")};
    if (d.probe.lag_s < 0.0) throw InputError(fmt::format("key `lag_s` is {}; it must be 0 or more", d.probe.lag_s));
    if (j.contains("members")) read_members(j, d);
  } catch (const InputError& e) {
    throw InputError(fmt::format("key `probing`: {}", e.what()));
  }
}

PredictorFile file_of(const Json& j) {
  if (!j.is_object() || value<std::string>(j, "format") != kFormat)
    throw InputError(
        fmt::format("this file holds no predictor (key `format` must be \"{}\"); `validate` writes them", kFormat));
  PredictorFile file;
  DeployedPredictor& d = file.predictor;
  d.name = value<std::string>(j, "name");
  d.target = value<std::string>(j, "target");
  if (value<std::string>(j, "target_unit") != "um")
    throw InputError(fmt::format("key `target_unit` is {}; drift must be in um", j.at("target_unit").dump()));
  d.from_start = value<bool>(j, "from_start");
  d.is_baseline = value<bool>(j, "baseline");
  d.sensors = value<std::vector<std::string>>(j, "sensors");
  d.ambient = value<std::string>(j, "hall");
  d.reason = value<std::string>(j, "decided");
  if (const double half = number_or(j, "interval_95_um", NAN); std::isfinite(half)) d.interval_um = half;
  d.predictor = predictor_of(j, {.name = d.target, .from_start = d.from_start});
  read_probing(j, d);
  if (const auto safe = value<Json>(j, "fail_safe"); !safe.is_null()) d.fail_safe = fail_safe_of(safe);
  require_guards(d);
  if (!d.member_residuals.empty() && !d.fail_safe)
    throw InputError("key `fail_safe` is null; a formula whose `members` have probings must have one");
  file.judged = value<Json>(j, "judged");
  if (j.contains("watch")) file.watch = j["watch"];
  if (j.contains("covered") && !j["covered"].is_null()) {
    const Json& c = j["covered"];
    file.covered = {finite(c, "most_rpm"), finite(c, "low_degC"), finite(c, "high_degC")};
  }
  require_whole(j);
  return file;
}

}  // namespace

Json predictor_json(const PredictorFile& file, const Provenance& made_by) {
  const DeployedPredictor& d = file.predictor;
  Written written = written_of(d);
  Json j = {{"format", kFormat},
            {"program", "driftwright"},
            {"version", made_by.version},
            {"scenario", made_by.scenario},
            {"name", d.name},
            {"target", d.target},
            {"target_unit", "um"},
            {"from_start", d.from_start},
            {"baseline", d.is_baseline},
            {"sensors", d.sensors},
            {"hall", d.ambient},
            {"decided", d.reason},
            {"interval_95_um", d.interval_um ? Json(*d.interval_um) : Json(nullptr)},
            {"probing", probing_json(d)},
            {"judged", file.judged},
            {"watch", file.watch},
            {"covered", file.covered ? Json{{"most_rpm", file.covered->most_rpm},
                                            {"low_degC", file.covered->low_degC},
                                            {"high_degC", file.covered->high_degC}}
                                     : Json(nullptr)},
            {"fail_safe", d.fail_safe ? fail_safe_json(*d.fail_safe) : Json(nullptr)},
            {"predictor", written.kind}};
  j[written.kind] = std::move(written.content);
  return with_hash(std::move(j));
}

PredictorFile read_predictor(const std::string& path) {
  if (!std::filesystem::is_regular_file(path))
    throw InputError(fmt::format("{}: {}; it must be a predictor of `validate`, models/NAME.json", path,
                                 std::filesystem::is_directory(path) ? "this is a folder" : "there is no such file"));
  const std::string text = read_bytes(path);
  try {
    return file_of(parse_json(text));
  } catch (const nlohmann::json::exception& e) {
    throw InputError(fmt::format("{}: {}", path, e.what()));
  } catch (const InputError& e) {
    throw InputError(fmt::format("{}: {}", path, e.what()));
  }
}

}  // namespace driftwright::output
