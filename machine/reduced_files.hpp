#pragma once
// A reduced system as files: arrays in .npy, names and numbers in JSON. For the store and for other programs.

#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>

#include "machine/reduced_machine.hpp"

namespace driftwright::scenarios {

/// Path of the file with a given name.
using FileOf = std::function<std::filesystem::path(const std::string&)>;

/// Stores an array under a name, or returns the stored one.
using WriteArray = std::function<void(const std::string& name, const Eigen::MatrixXd& values)>;
using ReadArray = std::function<Eigen::MatrixXd(const std::string& name)>;
/// Arrays in files NAME.npy. @throws InputError  as write_npy() and read_npy()
[[nodiscard]] WriteArray into_npy(FileOf file);
[[nodiscard]] ReadArray from_npy(FileOf file);

/// Writes the arrays. @return names and numbers, which belong to the arrays. @throws what `write` throws
[[nodiscard]] nlohmann::ordered_json write_system(const solver::ReducedSystem& system, const Eigen::VectorXd& start,
                                                  const WriteArray& write);
/// Reads what write_system() has written. The laws come from a balance of effects::heat_balance().
/// @throws InputError  for an array of another size, and what `read` throws
/// @throws nlohmann::json::exception  for a name or number that is missing
/// @throws std::logic_error  as solver::bind_laws(), for the balance of another machine
[[nodiscard]] solver::ReducedSystem read_system(const nlohmann::ordered_json& json, const effects::HeatBalance& balance,
                                                const ReadArray& read, Eigen::VectorXd& start);

/// An array of known size. @throws InputError  as read_npy(), and for another size
template <class Scalar>
[[nodiscard]] Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic> array_of(const std::filesystem::path& path,
                                                                             Eigen::Index rows, Eigen::Index columns);

/// Exports the small system to other programs: its matrices as .npy, names and numbers in model.json, and reduced_model.py,
/// which reads them and makes A, B, C of dz/dt = A z + B u, y = C z (docs/theory/reduced_model.md).
///
/// @param drives  at which coefficients and powers are evaluated; the system must not contain laws that depend on
///                temperatures
/// @param file    path of the file with a given name
void export_reduced(const solver::ReducedSystem& system, const Eigen::VectorXd& start, const solver::ReductionError& error,
                    const std::vector<Drive>& drives, const FileOf& file);

}  // namespace driftwright::scenarios
