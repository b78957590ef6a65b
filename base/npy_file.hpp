#pragma once
// Arrays in NumPy's .npy format, version 1.0, little endian: `numpy.load(file)` reads them.
// Source of the format: NumPy Enhancement Proposal 1.

#include <Eigen/Core>
#include <filesystem>

namespace driftwright {

/// Writes a matrix, column by column ("fortran_order"); a matrix of one column becomes an array of one dimension.
/// @throws InputError  naming the file, when it cannot be written
void write_npy(const std::filesystem::path& file, const Eigen::Ref<const Eigen::MatrixXd>& values);
void write_npy(const std::filesystem::path& file, const Eigen::Ref<const Eigen::MatrixXf>& values);
void write_npy(const std::filesystem::path& file, const Eigen::Ref<const Eigen::MatrixXi>& values);

/// Reads a file written by write_npy(): the same type, in Fortran order.
/// @throws InputError  naming the file, when it is missing, cut short, or of another type or order
template <class Scalar>
[[nodiscard]] Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic> read_npy(const std::filesystem::path& file);

}  // namespace driftwright
