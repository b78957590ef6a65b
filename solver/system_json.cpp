#include "solver/system_json.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/errors.hpp"
#include "effects/former_words.hpp"
#include "solver/bind_laws.hpp"

namespace driftwright::solver {
namespace {

using Json = nlohmann::ordered_json;

/// Vectors as columns of a matrix; empty ones become zeros.
Eigen::MatrixXd side_by_side(Eigen::Index rows, const std::vector<Eigen::VectorXd>& columns) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(rows, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].size() > 0) matrix.col(static_cast<Eigen::Index>(i)) = columns[i];
  }
  return matrix;
}

Json law_json(const std::string& name, const BoundLaw& law) {
  Json json = {{"name", name}, {"probes", law.probes}, {"thermostat", law.thermostat}, {"frozen_K", law.frozen_K}};
  if (!law.spread_K.empty()) {
    json["spread_K"] = law.spread_K;
    json["slope_over_K"] = law.slope_over_K;
  }
  return json;
}

BoundLaw law_from(const Json& json) {
  BoundLaw law;
  law.probes = json.at("probes").get<std::vector<int>>();
  law.thermostat = json.at("thermostat");
  law.frozen_K = json.at("frozen_K").get<std::vector<double>>();
  if (json.contains("spread_K")) {
    law.spread_K = json.at("spread_K").get<std::vector<double>>();
    law.slope_over_K = json.at("slope_over_K");
    if (law.spread_K.size() != law.frozen_K.size())
      throw InputError(fmt::format("a law has {} temperatures in `frozen_K` and {} in `spread_K`; both must be equally many",
                                   law.frozen_K.size(), law.spread_K.size()));
  }
  return law;
}

Json body_json(const effects::Body& body) {
  return {{"kind", static_cast<int>(body.kind)}, {"name", body.name}};
}
effects::Body body_from(const Json& json) {
  const auto kind = static_cast<effects::BodyKind>(json.at("kind").get<int>());
  const std::string name = json.at("name");
  return {kind, kind == effects::BodyKind::kNode ? effects::name_in_present_words(name) : name};
}

}  // namespace

Json write_system(const ReducedSystem& system, const Eigen::VectorXd& start, const WriteArray& write) {
  const auto r = static_cast<Eigen::Index>(system.size());
  Json json = {{"size", system.size()}, {"reference_K", system.reference_K}};
  std::vector<Eigen::VectorXd> loads, to_ambient, flow, offset, medium, probes;
  Eigen::MatrixXd matrices(r * static_cast<Eigen::Index>(system.exchanges.size()), r);
  for (const auto& s : system.sources) {
    loads.push_back(s.load);
    json["sources"].push_back(law_json(s.name, s.power_W));
    json["sources"].back()["body"] = body_json(s.body);
  }
  for (std::size_t i = 0; i < system.exchanges.size(); ++i) {
    const auto& e = system.exchanges[i];
    matrices.middleRows(r * static_cast<Eigen::Index>(i), r) = e.matrix;
    to_ambient.push_back(e.to_ambient);
    flow.push_back(e.flow);
    offset.push_back(e.offset);
    medium.push_back(e.medium);
    Json entry = law_json(e.name, e.coefficient);
    entry["body"] = body_json(e.place.body);
    entry["surrounding"] = e.place.surrounding;
    entry["per"] = static_cast<int>(e.place.per);
    if (!e.place.part.empty()) entry["part"] = e.place.part;
    entry["medium_sum"] = e.medium_sum;
    entry["has_medium"] = e.medium.size() > 0;
    entry["hall_sum"] = e.ambient_sum;
    entry["offset_sum"] = e.offset_sum;
    entry["has_offset"] = e.offset.size() > 0;
    entry["prescribes"] = e.prescribes;
    if (e.slope_of >= 0) entry["slope_of"] = e.slope_of;
    json["exchanges"].push_back(std::move(entry));
  }
  for (const auto& p : system.probes) {
    probes.push_back(p.weights);
    json["probes"].push_back(
        {{"body", body_json(p.body)}, {"before", p.before}, {"hall_share", p.ambient_share}, {"offset_K", p.offset_K}});
  }
  if (!system.parts.empty()) {
    const auto n_parts = static_cast<Eigen::Index>(system.parts.size()), n_outputs = system.outputs.state.cols();
    Eigen::MatrixXd conduction(r * n_parts, r), mass(r * n_parts, r), outputs(r * n_parts, n_outputs);
    for (Eigen::Index i = 0; i < n_parts; ++i) {
      const auto& part = system.parts[static_cast<std::size_t>(i)];
      conduction.middleRows(r * i, r) = part.conduction;
      mass.middleRows(r * i, r) = part.mass;
      outputs.middleRows(r * i, r) = part.outputs;
      json["parts"].push_back(part.body);
    }
    write("parts_conduction", conduction);
    write("parts_mass", mass);
    write("parts_outputs", outputs);
  }
  json["outputs"] = {{"name", system.outputs.name}, {"unit", system.outputs.unit}};
  write("conduction", system.conduction);
  write("exchanges", matrices);
  write("to_hall", side_by_side(r, to_ambient));
  write("flow", side_by_side(r, flow));
  write("offset", side_by_side(r, offset));
  write("medium", side_by_side(r, medium));
  write("loads", side_by_side(r, loads));
  write("probes", side_by_side(r, probes));
  write("outputs", system.outputs.state);
  write("outputs_hall", system.outputs.ambient);
  write("ones", system.ones);
  write("start", start);
  return json;
}

ReducedSystem read_system(const Json& json, const effects::HeatBalance& balance, const ReadArray& read,
                          Eigen::VectorXd& start) {
  ReducedSystem system;
  const Eigen::Index r = json.at("size");
  const Json none = Json::array();
  const auto n_of = [&](const char* key) { return static_cast<Eigen::Index>(json.value(key, none).size()); };
  const auto sized = [&](const char* name, Eigen::Index rows, Eigen::Index columns) {
    Eigen::MatrixXd values = read(name);
    if (values.rows() != rows || values.cols() != columns)
      throw InputError(fmt::format("array '{}' is {} x {}, not {} x {}", name, values.rows(), values.cols(), rows, columns));
    return values;
  };
  const auto array = [&](const char* name, Eigen::Index columns) { return sized(name, r, columns); };
  system.reference_K = json.at("reference_K");
  system.conduction = array("conduction", r);
  system.mass = Eigen::MatrixXd::Identity(r, r);  // of the same size as the stored arrays
  const Eigen::Index n_exchanges = n_of("exchanges");
  const Eigen::MatrixXd matrices = sized("exchanges", r * n_exchanges, r), to_ambient = array("to_hall", n_exchanges),
                        flow = array("flow", n_exchanges), offset = array("offset", n_exchanges),
                        medium = array("medium", n_exchanges), loads = array("loads", n_of("sources")),
                        probes = array("probes", n_of("probes"));
  Eigen::Index i = 0;
  for (const Json& s : json.value("sources", none))
    system.sources.push_back({s.at("name"), body_from(s.at("body")), loads.col(i++), law_from(s)});
  i = 0;
  for (const Json& e : json.value("exchanges", none)) {
    system.exchanges.push_back(
        {.name = effects::name_in_present_words(e.at("name")),
         .place = {body_from(e.at("body")), effects::name_in_present_words(e.at("surrounding")),
                   static_cast<effects::Per>(e.at("per").get<int>()), e.value("part", std::string())},
         .matrix = matrices.middleRows(r * i, r),
         .to_ambient = to_ambient.col(i),
         .ambient_sum = e.at("hall_sum"),
         .coefficient = law_from(e),
         .flow = flow.col(i),
         .offset = e.at("has_offset").get<bool>() ? Eigen::VectorXd(offset.col(i)) : Eigen::VectorXd(),
         .offset_sum = e.at("offset_sum"),
         .medium = e.at("has_medium").get<bool>() ? Eigen::VectorXd(medium.col(i)) : Eigen::VectorXd(),
         .medium_sum = e.at("medium_sum"),
         .prescribes = e.at("prescribes"),
         .slope_of = e.value("slope_of", -1)});
    ++i;
  }
  i = 0;
  for (const Json& p : json.value("probes", none)) {
    system.probes.push_back(
        {body_from(p.at("body")), p.at("before"), probes.col(i++), p.at("hall_share"), p.at("offset_K")});
  }
  system.outputs.name = json.at("outputs").at("name").get<std::vector<std::string>>();
  system.outputs.unit = json.at("outputs").at("unit").get<std::vector<std::string>>();
  const auto n_outputs = static_cast<Eigen::Index>(system.outputs.name.size());
  system.outputs.state = array("outputs", n_outputs);
  system.outputs.ambient = sized("outputs_hall", n_outputs, 1);
  if (const Eigen::Index n_parts = n_of("parts"); n_parts > 0) {
    const auto parts_of = [&](const char* name, Eigen::Index columns) { return sized(name, r * n_parts, columns); };
    const Eigen::MatrixXd conduction = parts_of("parts_conduction", r), mass = parts_of("parts_mass", r),
                          outputs = parts_of("parts_outputs", n_outputs);
    for (Eigen::Index p = 0; p < n_parts; ++p) {
      system.parts.push_back({json.at("parts")[static_cast<std::size_t>(p)], conduction.middleRows(r * p, r),
                              mass.middleRows(r * p, r), outputs.middleRows(r * p, r)});
    }
  }
  system.ones = array("ones", 1);
  start = array("start", 1);
  bind_laws(system, effects::with_radiation_as_films(balance));
  return system;
}

}  // namespace driftwright::solver
