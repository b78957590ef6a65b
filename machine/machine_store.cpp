#include "machine/machine_store.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "base/bounded_json.hpp"
#include "base/file_bytes.hpp"
#include "base/npy_file.hpp"
#include "machine/reduced_files.hpp"
#include "machine/travel.hpp"

namespace driftwright::scenarios {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kHashes = "hashes.json";  // hashes of all other files of a machine

std::filesystem::path folder_of(const std::filesystem::path& store, const std::string& key) {
  return store / content_hash(key);
}

Eigen::MatrixXi as_column(const std::vector<int>& values) {
  return Eigen::Map<const Eigen::VectorXi>(values.data(), static_cast<Eigen::Index>(values.size()));
}
std::vector<int> as_vector(const Eigen::MatrixXi& column) {
  return {column.data(), column.data() + column.size()};
}

/// Paths of files in a folder; their names get a prefix.
FileOf in_folder(const std::filesystem::path& folder, const std::string& prefix = "") {
  return [folder, prefix](const std::string& name) { return folder / (prefix + name); };
}

void write_cells(const mesh::Cells& cells, const FileOf& file) {
  std::vector<int> shapes;
  for (mesh::CellShape s : cells.shape) shapes.push_back(static_cast<int>(s));
  write_npy(file("shape.npy"), as_column(shapes));
  write_npy(file("offset.npy"), as_column(cells.offset));
  write_npy(file("node.npy"), as_column(cells.node));
  write_npy(file("group.npy"), as_column(cells.group));
}

/// @param n_groups  regions or surfaces of the mesh
mesh::Cells read_cells(const FileOf& file, int n_nodes, std::size_t n_groups) {
  mesh::Cells cells;
  for (int s : as_vector(read_npy<int>(file("shape.npy")))) cells.shape.push_back(static_cast<mesh::CellShape>(s));
  cells.offset = as_vector(read_npy<int>(file("offset.npy")));
  cells.node = as_vector(read_npy<int>(file("node.npy")));
  cells.group = as_vector(read_npy<int>(file("group.npy")));
  const std::size_t n_cells = cells.shape.size();
  const auto beyond = [](const std::vector<int>& indices, int n) {
    return std::any_of(indices.begin(), indices.end(), [n](int i) { return i < 0 || i >= n; });
  };
  if (beyond(cells.node, n_nodes) || beyond(cells.group, static_cast<int>(n_groups)) || cells.offset.size() != n_cells + 1 ||
      cells.group.size() != n_cells || cells.offset.back() != static_cast<int>(cells.node.size())) {
    throw InputError(fmt::format("{}: cells of another mesh", file("offset.npy").string()));
  }
  return cells;
}

/// The whole mesh but its notes: a diagnosis asks which bodies a surface or a joint belongs to.
Json write_mesh(const mesh::Mesh& mesh, const std::filesystem::path& folder) {
  const auto& [coords, cells, facets, regions, surfaces, joints, notes] = mesh;  // a further member must be kept, too
  write_npy(folder / "mesh_coords.npy", Eigen::MatrixXd(coords));
  write_cells(cells, in_folder(folder, "mesh_"));
  write_cells(facets, in_folder(folder, "mesh_facets_"));
  Json json = {{"regions", regions}, {"surfaces", surfaces}, {"joints", Json::array()}};
  for (const mesh::Joint& j : joints) json["joints"].push_back({j.name, j.side_a, j.side_b});
  return json;
}

mesh::Mesh read_mesh(const Json& json, const std::filesystem::path& folder) {
  mesh::Mesh mesh;
  mesh.regions = json.at("regions").get<std::vector<std::string>>();
  mesh.surfaces = json.at("surfaces").get<std::vector<std::string>>();
  for (const Json& j : json.at("joints")) mesh.joints.push_back({j.at(0), j.at(1), j.at(2)});
  const Eigen::MatrixXd coords = read_npy<double>(folder / "mesh_coords.npy");
  if (coords.rows() != 3) throw InputError(fmt::format("{}: no points", (folder / "mesh_coords.npy").string()));
  mesh.coords = coords;
  mesh.cells = read_cells(in_folder(folder, "mesh_"), mesh.n_nodes(), mesh.regions.size());
  mesh.facets = read_cells(in_folder(folder, "mesh_facets_"), mesh.n_nodes(), mesh.surfaces.size());
  return mesh;
}

void write_machine(const std::filesystem::path& work, const std::string& key, const ReducedMachine& machine) {
  Json json = {{"n_unknowns", machine.n_unknowns},
               {"has_fields", machine.displacement_m.size() > 0},
               {"mesh", write_mesh(machine.mesh, work)},
               {"error_K", machine.error.temperature_K},
               {"error_m", machine.error.displacement_m},
               {"error_rad", machine.error.angle_rad},
               {"system", solver::write_system(machine.system, machine.start, into_npy(in_folder(work)))}};
  if (machine.modal) {
    const auto write = [&](const char* name, const compensation::ModalPredictor& p) {
      json["modal"][name] = {
          {"time_constant_s", p.time_constant_s},
          {"system", solver::write_system(p.system, p.start, into_npy(in_folder(work, fmt::format("modal_{}_", name))))}};
    };
    write("bare", machine.modal->bare);
    write("completed", machine.modal->completed);
  }
  if (const Travel* travel = machine.travel.get()) {
    json["travel"] = {{"moves", travel->moves}, {"n_training", travel->n_training}};
    write_npy(work / "travel_temperature.npy", Eigen::MatrixXd(travel->temperature));
    write_npy(work / "travel_displacement.npy", Eigen::MatrixXd(travel->elastic.displacement));
    write_npy(work / "travel_stiffness.npy", travel->elastic.stiffness);
    write_npy(work / "travel_force.npy", travel->force);
    write_npy(work / "travel_rest_outputs.npy", travel->rest_outputs);
  }
  write_npy(work / "temperature.npy", machine.temperature);
  write_npy(work / "displacement_m.npy", machine.displacement_m);
  write_bytes(work / "model.json", json.dump());
  write_bytes(work / "key.txt", key);
  Json hashes;
  for (const auto& entry : std::filesystem::directory_iterator(work))
    hashes[entry.path().filename().string()] = content_hash(read_bytes(entry.path()));
  write_bytes(work / kHashes, hashes.dump());
}

/// @param machine  with its mesh and system
std::shared_ptr<const Travel> read_travel(const Json& json, const std::filesystem::path& folder,
                                          const ReducedMachine& machine) {
  auto travel = std::make_shared<Travel>();
  travel->moves = json.at("moves").get<std::vector<bool>>();
  travel->n_training = json.at("n_training");
  const Eigen::Index size = machine.system.size(), n_outputs = machine.system.outputs.state.cols();
  travel->temperature = array_of<double>(folder / "travel_temperature.npy", machine.n_unknowns, size);
  travel->elastic.stiffness = read_npy<double>(folder / "travel_stiffness.npy");
  const Eigen::Index m = travel->elastic.stiffness.rows();
  travel->elastic.displacement =
      array_of<double>(folder / "travel_displacement.npy", m == 0 ? 0 : 3 * machine.mesh.n_nodes(), m);
  travel->force = array_of<double>(folder / "travel_force.npy", m, m == 0 ? 0 : size);
  travel->rest_outputs = array_of<double>(folder / "travel_rest_outputs.npy", size, n_outputs);
  return travel;
}

/// @throws InputError  naming the first file that has changed; a JSON exception if the list of hashes is not valid
void require_whole(const std::filesystem::path& folder) {
  Json hashes;
  try {
    hashes = parse_json(read_bytes(folder / kHashes));
  } catch (const InputError& e) {
    throw InputError(fmt::format("{}: {}", (folder / kHashes).string(), e.what()));
  }
  for (const auto& [name, hash] : hashes.items()) {
    if (content_hash(read_bytes(folder / name)) != hash.get<std::string>())
      throw InputError(fmt::format("{}: is not as it was written", (folder / name).string()));
  }
  if (!hashes.contains("key.txt") || !hashes.contains("model.json"))
    throw InputError(fmt::format("{}: names not all files", (folder / kHashes).string()));
}

}  // namespace

std::filesystem::path machine_store() {
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache == '/') {
    return std::filesystem::path(cache) / "driftwright";
  }
  if (const char* home = std::getenv("HOME"); home && *home == '/')
    return std::filesystem::path(home) / ".cache/driftwright";
  return {};
}

std::optional<ReducedMachine> load_machine(const std::filesystem::path& store, const std::string& key,
                                           const effects::HeatBalance& balance, std::string* damage) {
  if (store.empty()) return std::nullopt;
  const std::filesystem::path folder = folder_of(store, key);
  std::error_code missing;
  if (!std::filesystem::exists(folder, missing)) return std::nullopt;
  std::string why;
  try {
    if (read_bytes(folder / "key.txt") != key)
      throw InputError(fmt::format("{}: is of another machine", (folder / "key.txt").string()));
    require_whole(folder);
    const Json json = parse_json(read_bytes(folder / "model.json"));
    ReducedMachine machine;
    machine.n_unknowns = json.at("n_unknowns");
    machine.mesh = read_mesh(json.at("mesh"), folder);
    machine.system = solver::read_system(json.at("system"), balance, from_npy(in_folder(folder)), machine.start);
    machine.error = {json.at("error_K"), json.at("error_m"), json.at("error_rad")};
    if (json.contains("modal")) {
      const auto read = [&](const char* name) {
        const Json& m = json.at("modal").at(name);
        compensation::ModalPredictor p;
        p.time_constant_s = m.at("time_constant_s").get<std::vector<double>>();
        p.system = solver::read_system(m.at("system"), balance, from_npy(in_folder(folder, fmt::format("modal_{}_", name))),
                                       p.start);
        return p;
      };
      machine.modal = {read("bare"), read("completed")};
    }
    if (json.contains("travel")) machine.travel = read_travel(json.at("travel"), folder, machine);
    const bool has_fields = json.at("has_fields");
    const Eigen::Index size = has_fields ? machine.system.size() : 0, n_nodes = has_fields ? machine.mesh.n_nodes() : 0;
    machine.temperature = array_of<float>(folder / "temperature.npy", n_nodes, size);
    machine.displacement_m = array_of<float>(folder / "displacement_m.npy", 3 * n_nodes, size);
    return machine;
  } catch (const InputError& e) {
    why = e.what();
  } catch (const nlohmann::json::exception& e) {
    why = fmt::format("{}: {}", folder.string(), e.what());
  } catch (const std::logic_error& e) {  // the machine belongs to another balance
    why = fmt::format("{}: {}", folder.string(), e.what());
  }
  if (damage) *damage = why;
  return std::nullopt;
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
  } catch (...) {  // avoids filling a full disk further
    std::filesystem::remove_all(work, failed);
    throw;
  }
  const std::filesystem::path old = folder.string() + fmt::format(".old-{}", ::getpid());
  std::error_code none, ignored;
  std::filesystem::rename(folder, old, none);  // an existing one is damaged
  std::filesystem::rename(work, folder, failed);
  if (failed) std::filesystem::remove_all(work, ignored);  // another process was faster
  if (!none) std::filesystem::remove_all(old, ignored);
}

}  // namespace driftwright::scenarios
