#pragma once
// A reduced system as files: its arrays (solver/system_json.hpp) in .npy. For the store and for other programs.

#include <filesystem>
#include <functional>

#include "machine/reduced_machine.hpp"
#include "solver/system_json.hpp"

namespace driftwright::scenarios {

/// Path of the file with a given name.
using FileOf = std::function<std::filesystem::path(const std::string&)>;

/// Arrays in files NAME.npy. @throws InputError  as write_npy() and read_npy()
[[nodiscard]] solver::WriteArray into_npy(FileOf file);
[[nodiscard]] solver::ReadArray from_npy(FileOf file);

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
