#include "machine/reduced_files.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/file_bytes.hpp"
#include "base/npy_file.hpp"

namespace driftwright::scenarios {
namespace {

using solver::ReducedSystem;
using Json = nlohmann::ordered_json;

constexpr const char* kReader =
    R"(# Reads the reduced model beside this file: dz/dt = -K(c) z + loads P + to_hall c T_ambient + offset c,  y = outputs' z + outputs_hall T_ambient.
# z(0) = start; temperatures in K over reference_K, displacements in m, tilts in rad. c and P at some drives: model.json, "drives".
import json, os, numpy as np
here = os.path.dirname(os.path.abspath(__file__))
model = json.load(open(os.path.join(here, "model.json")))
a = {n: np.load(os.path.join(here, n + ".npy")) for n in
     "conduction exchanges to_hall offset loads outputs outputs_hall start".split()}
r = model["size"]
G = a["exchanges"].reshape(-1, r, r)  # one symmetric matrix per exchange
def K(c): return a["conduction"] + np.tensordot(c, G, 1)
def ABC(drive):  # u = [P of each source, T_ambient, 1]
    c, col = np.array(drive["coefficients"]), lambda x: x.reshape(r, -1)
    B = np.column_stack([col(a["loads"]), col(a["to_hall"]) @ c, col(a["offset"]) @ c])
    return -K(c), B, a["outputs"].reshape(r, -1).T
)";

}  // namespace

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

template Eigen::MatrixXd array_of<double>(const std::filesystem::path&, Eigen::Index, Eigen::Index);
template Eigen::MatrixXf array_of<float>(const std::filesystem::path&, Eigen::Index, Eigen::Index);

solver::WriteArray into_npy(FileOf file) {
  return [file = std::move(file)](const std::string& name, const Eigen::MatrixXd& values) {
    write_npy(file(name + ".npy"), values);
  };
}

solver::ReadArray from_npy(FileOf file) {
  return
      [file = std::move(file)](const std::string& name) -> Eigen::MatrixXd { return read_npy<double>(file(name + ".npy")); };
}

void export_reduced(const ReducedSystem& system, const Eigen::VectorXd& start, const solver::ReductionError& error,
                    const std::vector<Drive>& drives, const FileOf& file) {
  Json json = solver::write_system(system, start, into_npy(file));
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
  write_bytes(file("model.json"), json.dump(1) + "\n");
  write_bytes(file("reduced_model.py"), kReader);
}

}  // namespace driftwright::scenarios
