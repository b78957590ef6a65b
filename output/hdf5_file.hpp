#pragma once
// Writes arrays into an HDF5 file, one after the other.

#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace driftwright::output {

/// Rows of arrays in chunks of at most 65536, shuffled and deflated without loss. No time stamps: the same calls give the
/// same bytes. One thread at a time.
class Hdf5File {
 public:
  /// Creates the file or replaces it. @throws InputError  naming the file and the reason
  explicit Hdf5File(std::filesystem::path file);
  ~Hdf5File();
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;

  /// Writes an array of `values.size() / n_columns` rows; with one column it has one dimension, otherwise two.
  /// @param dataset    path of the array in the file, "mesh/region"; missing groups are created
  /// @param values     row after row, at least one row
  /// @throws std::logic_error  when the values do not fill whole rows
  /// @throws InputError        naming the file and the reason, such as a full disk
  void write(const std::string& dataset, std::span<const float> values, std::size_t n_columns = 1);
  void write(const std::string& dataset, std::span<const double> values, std::size_t n_columns = 1);
  void write(const std::string& dataset, std::span<const int> values, std::size_t n_columns = 1);

  /// Closes the file, after which nothing can be written. @throws InputError  when that fails
  void close();

 private:
  struct Handle;  // keeps HDF5's header out of this one
  std::filesystem::path path_;
  std::unique_ptr<Handle> file_;
};

}  // namespace driftwright::output
