#include "scenarios/machine_store.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "base/npy_file.hpp"

namespace driftwright::scenarios {
namespace {

using solver::BoundLaw;
using solver::ReducedSystem;
using Json = nlohmann::ordered_json;
using FileOf = std::function<std::filesystem::path(const std::string&)>;

constexpr int kFormat = 1;  // of the folders; a new one makes all others unknown

/// FNV-1a, 64 bits.
std::uint64_t hash(const std::string& bytes) {
  std::uint64_t h = 14695981039346656037ull;
  for (unsigned char c : bytes) h = (h ^ c) * 1099511628211ull;
  return h;
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << file.rdbuf();
  if (!file) throw InputError(fmt::format("{}: the file cannot be read", path.string()));
  return bytes.str();
}

std::string words(const effects::Body& body) {
  const char* kinds[] = {"region", "surface", "node"};
  return fmt::format("{} {}", kinds[static_cast<int>(body.kind)], body.name);
}

std::string words(const effects::Law& law) {
  std::vector<std::string> probes;
  for (const effects::Body& b : law.probes) probes.push_back(words(b));
  return fmt::format("looks at [{}] switched by '{}'", fmt::join(probes, ", "), law.thermostat);
}

/// Everything of a balance but its laws' numbers.
std::string structure(const effects::HeatBalance& balance) {
  std::string text;
  const auto add = [&](const char* what, const auto&... parts) {
    text += what;
    ((text += fmt::format(" | {}", parts)), ...);
    text += "\n";
  };
  for (const auto& h : balance.heats) add("heat", h.name, words(h.body), words(h.power_W));
  for (const auto& f : balance.films) add("film", f.name, f.surface, f.surrounding, words(f.htc_W_m2K));
  for (const auto& l : balance.links) add("link", l.name, words(l.body), l.surrounding, words(l.conductance_W_K));
  for (const auto& c : balance.contacts) add("contact", c.name, c.joint, words(c.conductance_W_m2K));
  for (const auto& r : balance.radiations) add("radiation", r.name, r.surface, r.surrounding);
  for (const auto& n : balance.nodes) add("node", n.name, n.capacity_J_K);
  for (const auto& f : balance.fixed) {
    add("fixed", f.name, words(f.body), f.follows_hall, fmt::format("{}", fmt::join(f.temperature_K.value, ", ")));
  }
  for (const auto& s : balance.stratifications) add("stratification", s.gradient_K_m, s.level_m);
  for (const auto& t : balance.thermostats) add("thermostat", t.name, words(t.probe));
  return text;
}

bool looks_at_temperatures(const effects::HeatBalance& balance) {
  const auto any = [](const auto& entries, auto law) {
    return std::any_of(entries.begin(), entries.end(), [&](const auto& e) { return !(e.*law).probes.empty(); });
  };
  return any(balance.heats, &effects::HeatInput::power_W) || any(balance.films, &effects::Film::htc_W_m2K) ||
         any(balance.links, &effects::Link::conductance_W_K) || any(balance.contacts, &effects::Contact::conductance_W_m2K);
}

std::string numbers_of_laws(const MachineModel& model) {
  std::string text;
  for (const effects::Effect& e : model.effects) {
    text += fmt::format("{}: {}", e.name(), fmt::join(e.values, " "));
    for (const auto& [name, word] : e.words) text += fmt::format(" {} {}", name, word);
    for (const auto& [name, table] : e.tables) {
      text += fmt::format(" {} {} {}", name, fmt::join(table.time_s, " "), fmt::join(table.value, " "));
    }
    text += "\n";
  }
  return text;
}

/// Of a balance whose laws do not look at temperatures.
std::vector<double> coefficients_at_standstill(const effects::HeatBalance& balance, double hall_K) {
  const effects::Inputs standstill{.drive = {}, .hall_K = hall_K};
  std::vector<double> values;
  for (const auto& f : balance.films) values.push_back(f.htc_W_m2K(standstill));
  for (const auto& l : balance.links) values.push_back(l.conductance_W_K(standstill));
  for (const auto& c : balance.contacts) values.push_back(c.conductance_W_m2K(standstill));
  return values;
}

bool has_curves(const MachineModel& model) {
  return std::any_of(model.materials.begin(), model.materials.end(), [](const MaterialEntry& entry) {
    return !entry.material.conductivity_curve.empty() || !entry.material.heat_capacity_curve.empty();
  });
}

/// Vectors side by side; empty ones as zeros.
Eigen::MatrixXd side_by_side(Eigen::Index rows, const std::vector<Eigen::VectorXd>& columns) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(rows, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].size() > 0) matrix.col(static_cast<Eigen::Index>(i)) = columns[i];
  }
  return matrix;
}

Json law_json(const std::string& name, const BoundLaw& law) {
  return {{"name", name}, {"probes", law.probes}, {"thermostat", law.thermostat}, {"frozen_K", law.frozen_K}};
}

BoundLaw law_from(const Json& json) {
  BoundLaw law;
  law.probes = json.at("probes").get<std::vector<int>>();
  law.thermostat = json.at("thermostat");
  law.frozen_K = json.at("frozen_K").get<std::vector<double>>();
  return law;
}

/// An array of known size. @throws InputError  as read_npy(), and for another size
template <class Scalar>
Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic> array_of(const std::filesystem::path& path, Eigen::Index rows,
                                                               Eigen::Index columns) {
  auto values = read_npy<Scalar>(path);
  if (values.rows() != rows || values.cols() != columns) {
    throw InputError(
        fmt::format("{}: {} x {} values, not {} x {}", path.string(), values.rows(), values.cols(), rows, columns));
  }
  return values;
}

/// Arrays of a reduced system as .npy files; returns the names and numbers beside them.
Json write_system(const ReducedSystem& system, const Eigen::VectorXd& start, const FileOf& file) {
  const auto r = static_cast<Eigen::Index>(system.size());
  Json json = {{"size", system.size()}, {"reference_K", system.reference_K}};
  std::vector<Eigen::VectorXd> loads, to_hall, flow, offset, probes;
  Eigen::MatrixXd matrices(r * static_cast<Eigen::Index>(system.exchanges.size()), r);
  for (const auto& s : system.sources) {
    loads.push_back(s.load);
    json["sources"].push_back(law_json(s.name, s.power_W));
  }
  for (std::size_t i = 0; i < system.exchanges.size(); ++i) {
    const auto& e = system.exchanges[i];
    matrices.middleRows(r * static_cast<Eigen::Index>(i), r) = e.matrix;
    to_hall.push_back(e.to_hall);
    flow.push_back(e.flow);
    offset.push_back(e.offset);
    Json entry = law_json(e.name, e.coefficient);
    entry["hall_sum"] = e.hall_sum;
    entry["offset_sum"] = e.offset_sum;
    entry["has_offset"] = e.offset.size() > 0;
    entry["prescribes"] = e.prescribes;
    json["exchanges"].push_back(std::move(entry));
  }
  for (const auto& p : system.probes) {
    probes.push_back(p.weights);
    json["probes"].push_back({{"hall_share", p.hall_share}, {"offset_K", p.offset_K}});
  }
  for (const auto& t : system.thermostats) json["thermostat_probes"].push_back(t.probe);
  json["outputs"] = {{"name", system.outputs.name}, {"unit", system.outputs.unit}};
  write_npy(file("conduction.npy"), system.conduction);
  write_npy(file("exchanges.npy"), matrices);
  write_npy(file("to_hall.npy"), side_by_side(r, to_hall));
  write_npy(file("flow.npy"), side_by_side(r, flow));
  write_npy(file("offset.npy"), side_by_side(r, offset));
  write_npy(file("loads.npy"), side_by_side(r, loads));
  write_npy(file("probes.npy"), side_by_side(r, probes));
  write_npy(file("outputs.npy"), system.outputs.state);
  write_npy(file("outputs_hall.npy"), system.outputs.hall);
  write_npy(file("ones.npy"), system.ones);
  write_npy(file("start.npy"), start);
  return json;
}

ReducedSystem read_system(const Json& json, const effects::HeatBalance& balance, const FileOf& file,
                          Eigen::VectorXd& start) {
  ReducedSystem system;
  const Eigen::Index r = json.at("size");
  const Json none = Json::array();
  const auto n_of = [&](const char* key) { return static_cast<Eigen::Index>(json.value(key, none).size()); };
  const auto array = [&](const char* name, Eigen::Index columns) { return array_of<double>(file(name), r, columns); };
  system.reference_K = json.at("reference_K");
  system.mass = Eigen::MatrixXd::Identity(r, r);
  system.conduction = array("conduction.npy", r);
  const Eigen::Index n_exchanges = n_of("exchanges");
  const Eigen::MatrixXd matrices = array_of<double>(file("exchanges.npy"), r * n_exchanges, r),
                        to_hall = array("to_hall.npy", n_exchanges), flow = array("flow.npy", n_exchanges),
                        offset = array("offset.npy", n_exchanges), loads = array("loads.npy", n_of("sources")),
                        probes = array("probes.npy", n_of("probes"));
  Eigen::Index i = 0;
  for (const Json& s : json.value("sources", none)) system.sources.push_back({s.at("name"), loads.col(i++), law_from(s)});
  i = 0;
  for (const Json& e : json.value("exchanges", none)) {
    system.exchanges.push_back(
        {.name = e.at("name"),
         .matrix = matrices.middleRows(r * i, r),
         .to_hall = to_hall.col(i),
         .hall_sum = e.at("hall_sum"),
         .coefficient = law_from(e),
         .flow = flow.col(i),
         .offset = e.at("has_offset").get<bool>() ? Eigen::VectorXd(offset.col(i)) : Eigen::VectorXd(),
         .offset_sum = e.at("offset_sum"),
         .prescribes = e.at("prescribes")});
    ++i;
  }
  i = 0;
  for (const Json& p : json.value("probes", none)) {
    system.probes.push_back({probes.col(i++), p.at("hall_share"), p.at("offset_K")});
  }
  for (const Json& probe : json.value("thermostat_probes", none)) {
    system.thermostats.push_back({.name = {}, .probe = probe});
  }
  system.outputs.name = json.at("outputs").at("name").get<std::vector<std::string>>();
  system.outputs.unit = json.at("outputs").at("unit").get<std::vector<std::string>>();
  const auto n_outputs = static_cast<Eigen::Index>(system.outputs.name.size());
  system.outputs.state = array("outputs.npy", n_outputs);
  system.outputs.hall = array_of<double>(file("outputs_hall.npy"), n_outputs, 1);
  system.ones = array("ones.npy", 1);
  start = array("start.npy", 1);
  bind_laws(system, reducible(balance));
  return system;
}

std::filesystem::path folder_of(const std::filesystem::path& store, const std::string& key) {
  return store / fmt::format("{:016x}", hash(key));
}

Eigen::MatrixXi as_column(const std::vector<int>& values) {
  return Eigen::Map<const Eigen::VectorXi>(values.data(), static_cast<Eigen::Index>(values.size()));
}
std::vector<int> as_vector(const Eigen::MatrixXi& column) {
  return {column.data(), column.data() + column.size()};
}

void write_mesh(const mesh::Mesh& mesh, const FileOf& file) {
  std::vector<int> shapes;
  for (mesh::CellShape s : mesh.cells.shape) shapes.push_back(static_cast<int>(s));
  write_npy(file("mesh_coords.npy"), Eigen::MatrixXd(mesh.coords));
  write_npy(file("mesh_shape.npy"), as_column(shapes));
  write_npy(file("mesh_offset.npy"), as_column(mesh.cells.offset));
  write_npy(file("mesh_node.npy"), as_column(mesh.cells.node));
  write_npy(file("mesh_group.npy"), as_column(mesh.cells.group));
}

mesh::Mesh read_mesh(const std::vector<std::string>& regions, const FileOf& file) {
  mesh::Mesh mesh;
  mesh.regions = regions;
  const Eigen::MatrixXd coords = read_npy<double>(file("mesh_coords.npy"));
  if (coords.rows() != 3) throw InputError(fmt::format("{}: no points", file("mesh_coords.npy").string()));
  mesh.coords = coords;
  for (int s : as_vector(read_npy<int>(file("mesh_shape.npy")))) mesh.cells.shape.push_back(static_cast<mesh::CellShape>(s));
  mesh.cells.offset = as_vector(read_npy<int>(file("mesh_offset.npy")));
  mesh.cells.node = as_vector(read_npy<int>(file("mesh_node.npy")));
  mesh.cells.group = as_vector(read_npy<int>(file("mesh_group.npy")));
  const std::size_t n_cells = mesh.cells.shape.size();
  const auto beyond = [](const std::vector<int>& indices, int n) {
    return std::any_of(indices.begin(), indices.end(), [n](int i) { return i < 0 || i >= n; });
  };
  if (beyond(mesh.cells.node, mesh.n_nodes()) || beyond(mesh.cells.group, static_cast<int>(regions.size())) ||
      mesh.cells.offset.size() != n_cells + 1 || mesh.cells.group.size() != n_cells ||
      mesh.cells.offset.back() != static_cast<int>(mesh.cells.node.size())) {
    throw InputError(fmt::format("{}: cells of another mesh", file("mesh_offset.npy").string()));
  }
  return mesh;
}

/// Files in a folder, their names beginning with a prefix.
FileOf in_folder(const std::filesystem::path& folder, const std::string& prefix = "") {
  return [folder, prefix](const std::string& name) { return folder / (prefix + name); };
}

void write_machine(const std::filesystem::path& work, const std::string& key, const ReducedMachine& machine) {
  Json json = {{"n_unknowns", machine.n_unknowns},
               {"has_fields", machine.displacement_m.size() > 0},
               {"regions", machine.mesh.regions},
               {"error_K", machine.error.temperature_K},
               {"error_m", machine.error.displacement_m},
               {"error_rad", machine.error.angle_rad},
               {"system", write_system(machine.system, machine.start, in_folder(work))}};
  if (machine.modal) {
    const auto write = [&](const char* name, const compensation::ModalPredictor& p) {
      json["modal"][name] = {{"time_constant_s", p.time_constant_s},
                             {"system", write_system(p.system, p.start, in_folder(work, fmt::format("modal_{}_", name)))}};
    };
    write("bare", machine.modal->bare);
    write("completed", machine.modal->completed);
  }
  write_mesh(machine.mesh, in_folder(work));
  write_npy(work / "temperature.npy", machine.temperature);
  write_npy(work / "displacement_m.npy", machine.displacement_m);
  const auto write_text = [&](const char* name, const std::string& text) {
    std::ofstream file(work / name, std::ios::binary);
    file << text;
    file.close();
    if (!file) throw InputError(fmt::format("{}: cannot be written; is the disk full?", (work / name).string()));
  };
  write_text("model.json", json.dump());
  write_text("key.txt", key);
}

constexpr const char* kReader =
    R"(# Reads the reduced model beside this file: dz/dt = -K(c) z + loads P + to_hall c T_hall + offset c,  y = outputs' z + outputs_hall T_hall.
# z(0) = start; temperatures in K over reference_K, displacements in m, tilts in rad. c and P at some drives: model.json, "drives".
import json, os, numpy as np
here = os.path.dirname(os.path.abspath(__file__))
model = json.load(open(os.path.join(here, "model.json")))
a = {n: np.load(os.path.join(here, n + ".npy")) for n in
     "conduction exchanges to_hall offset loads outputs outputs_hall start".split()}
r = model["size"]
G = a["exchanges"].reshape(-1, r, r)  # one symmetric matrix per exchange
def K(c): return a["conduction"] + np.tensordot(c, G, 1)
def ABC(drive):  # u = [P of each source, T_hall, 1]
    c, col = np.array(drive["coefficients"]), lambda x: x.reshape(r, -1)
    B = np.column_stack([col(a["loads"]), col(a["to_hall"]) @ c, col(a["offset"]) @ c])
    return -K(c), B, a["outputs"].reshape(r, -1).T
)";

}  // namespace

std::string machine_text(const MachineModel& model) {
  const effects::HeatBalance balance = effects::heat_balance(model.effects);
  std::string text = model.written + structure(balance);
  if (const auto* imported = std::get_if<mesh::ImportedMesh>(&model.mesh)) {
    const std::string bytes = bytes_of(imported->path);
    text += fmt::format("mesh file of {} bytes, {:016x}\n", bytes.size(), hash(bytes));
  }
  if (model.start == Start::kHall || model.start == Start::kSteady || !balance.fixed.empty()) {
    text += fmt::format("hall at the start {} K\n", model.hall.at(0.0));
  }
  if (model.start == Start::kSteady) text += numbers_of_laws(model);
  return text;
}

std::string machine_key(const MachineModel& model, const ReductionPlan& plan, const std::string& version) {
  const effects::HeatBalance balance = reducible(effects::heat_balance(model.effects));
  std::string key = fmt::format("driftwright {} store {}\n{}\n", version, kFormat, machine_text(model));
  const bool makes_modes = plan.n_modes > 0 && balance.thermostats.empty();
  const bool freezes_laws = makes_modes && looks_at_temperatures(balance);
  if (freezes_laws) {  // modal predictors are frozen at the typical drive
    const Drive& t = plan.typical;
    key += fmt::format("typical {} {} {}\n", t.speed_rpm, fmt::join(t.feed_m_s, " "), t.cutting_power_W);
    key += numbers_of_laws(model);
  } else if (makes_modes) {  // or taken at standstill
    key += fmt::format("at standstill {}\n", fmt::join(coefficients_at_standstill(balance, model.hall.at(0.0)), " "));
  }
  if (freezes_laws || has_curves(model)) key += fmt::format("frozen in a hall of {} K\n", model.hall.at(0.0));
  const auto numbers = [](const Eigen::VectorXd& v) {
    return fmt::format("{}", fmt::join(v.data(), v.data() + v.size(), " "));
  };
  const solver::ReductionDemand& d = plan.demand;
  key +=
      fmt::format("power {}\nlow {}\nhigh {}\nhall {} K, {} s, tolerance {} K, {} modes, fields {}\n", numbers(d.power_W),
                  numbers(d.low), numbers(d.high), d.hall_K, d.duration_s, plan.tolerance_K, plan.n_modes, plan.with_fields);
  return key;
}

std::filesystem::path machine_store() {
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache == '/') {
    return std::filesystem::path(cache) / "driftwright";
  }
  if (const char* home = std::getenv("HOME"); home && *home == '/')
    return std::filesystem::path(home) / ".cache/driftwright";
  return {};
}

std::optional<ReducedMachine> load_machine(const std::filesystem::path& store, const std::string& key,
                                           const effects::HeatBalance& balance) {
  if (store.empty()) return std::nullopt;
  const std::filesystem::path folder = folder_of(store, key);
  std::error_code missing;
  if (!std::filesystem::exists(folder / "key.txt", missing)) return std::nullopt;
  try {
    if (bytes_of(folder / "key.txt") != key) return std::nullopt;
    const Json json = Json::parse(bytes_of(folder / "model.json"));
    ReducedMachine machine;
    machine.n_unknowns = json.at("n_unknowns");
    machine.mesh = read_mesh(json.at("regions"), in_folder(folder));
    machine.system = read_system(json.at("system"), balance, in_folder(folder), machine.start);
    machine.error = {json.at("error_K"), json.at("error_m"), json.at("error_rad")};
    if (json.contains("modal")) {
      const auto read = [&](const char* name) {
        const Json& m = json.at("modal").at(name);
        compensation::ModalPredictor p;
        p.time_constant_s = m.at("time_constant_s").get<std::vector<double>>();
        p.system = read_system(m.at("system"), balance, in_folder(folder, fmt::format("modal_{}_", name)), p.start);
        return p;
      };
      machine.modal = {read("bare"), read("completed")};
    }
    const bool has_fields = json.at("has_fields");
    const Eigen::Index size = has_fields ? machine.system.size() : 0, n_nodes = has_fields ? machine.mesh.n_nodes() : 0;
    machine.temperature = array_of<float>(folder / "temperature.npy", n_nodes, size);
    machine.displacement_m = array_of<float>(folder / "displacement_m.npy", 3 * n_nodes, size);
    return machine;
  } catch (const InputError&) {
  } catch (const nlohmann::json::exception&) {
  }
  return std::nullopt;  // damaged: made anew
}

void save_machine(const std::filesystem::path& store, const std::string& key, const ReducedMachine& machine) {
  if (store.empty()) return;
  const std::filesystem::path folder = folder_of(store, key),
                              work = folder.string() + fmt::format(".partial-{}", ::getpid());
  std::error_code failed;
  std::filesystem::create_directories(work, failed);
  if (failed) throw InputError(fmt::format("{}: {}", work.string(), failed.message()));
  try {
    write_machine(work, key, machine);
  } catch (...) {  // a full disk is not filled further
    std::filesystem::remove_all(work, failed);
    throw;
  }
  const std::filesystem::path old = folder.string() + fmt::format(".old-{}", ::getpid());
  std::error_code none, ignored;
  std::filesystem::rename(folder, old, none);  // a damaged one
  std::filesystem::rename(work, folder, failed);
  if (failed) std::filesystem::remove_all(work, ignored);  // another process was first
  if (!none) std::filesystem::remove_all(old, ignored);
}

void export_reduced(const ReducedSystem& system, const Eigen::VectorXd& start, const solver::ReductionError& error,
                    const std::vector<Drive>& drives, const FileOf& file) {
  Json json = write_system(system, start, file);
  json["error"] = {
      {"temperature_K", error.temperature_K}, {"displacement_m", error.displacement_m}, {"angle_rad", error.angle_rad}};
  for (const Drive& drive : drives) {
    const effects::Inputs at{.drive = drive};
    std::vector<double> coefficients, powers_W;
    for (const auto& e : system.exchanges) coefficients.push_back(e.coefficient(at));
    for (const auto& s : system.sources) powers_W.push_back(s.power_W(at));
    json["drives"].push_back({{"speed_rpm", drive.speed_rpm},
                              {"feed_m_s", drive.feed_m_s},
                              {"cutting_power_W", drive.cutting_power_W},
                              {"coefficients", coefficients},
                              {"powers_W", powers_W}});
  }
  const auto write = [&](const char* name, const std::string& text) {
    std::ofstream out(file(name), std::ios::binary);
    out << text;
    out.close();
    if (!out) throw InputError(fmt::format("{}: cannot be written; is the disk full?", file(name).string()));
  };
  write("model.json", json.dump(1) + "\n");
  write("reduced_model.py", kReader);
}

}  // namespace driftwright::scenarios
