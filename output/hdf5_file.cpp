#include "output/hdf5_file.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "base/errors.hpp"

namespace driftwright::output {
namespace {

/// An HDF5 identifier and the function that closes it.
class Id {
 public:
  Id(hid_t id, herr_t (*close_function)(hid_t)) : id_(id), close_(close_function) {}
  Id(Id&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Id& operator=(Id&&) = delete;
  ~Id() {
    if (id_ >= 0) close_(id_);
  }
  operator hid_t() const { return id_; }
  [[nodiscard]] herr_t close() { return close_(std::exchange(id_, -1)); }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// HDF5 prints its errors by default; here they become exceptions.
class QuietErrors {
 public:
  QuietErrors() {
    H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~QuietErrors() { H5Eset_auto2(H5E_DEFAULT, print_, data_); }
  QuietErrors(const QuietErrors&) = delete;
  QuietErrors& operator=(const QuietErrors&) = delete;

 private:
  H5E_auto2_t print_ = nullptr;
  void* data_ = nullptr;
};

/// The innermost reason of the last HDF5 error; only the system's message if there is one.
std::string last_reason() {
  std::string reason = "HDF5 gives no reason";
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_UPWARD,
      [](unsigned depth, const H5E_error2_t* error, void* text) -> herr_t {
        if (depth == 0 && error->desc) *static_cast<std::string*>(text) = error->desc;
        return 0;
      },
      &reason);
  const std::string before = "error message = '";
  const std::size_t at = reason.find(before);
  if (at == std::string::npos) return reason;
  const std::size_t from = at + before.size();
  return reason.substr(from, reason.find('\'', from) - from);
}

[[noreturn]] void fail(const std::filesystem::path& file) {
  throw InputError(fmt::format("cannot write '{}': {}", file.string(), last_reason()));
}

hid_t checked(hid_t id, const std::filesystem::path& file) {
  if (id < 0) fail(file);
  return id;
}

void check(herr_t status, const std::filesystem::path& file) {
  if (status < 0) fail(file);
}

constexpr hsize_t kMaxRowsInChunk = 65536;
constexpr unsigned kDeflateLevel = 4;
constexpr unsigned kChunksInNode = 2;  // chunks in an index node: half the default of 64 would waste 2 kB of zeros per array

/// Writes rows of `type` in their memory layout.
void write_rows(hid_t file, const std::filesystem::path& path, const std::string& dataset, hid_t type, const void* values,
                std::size_t n_values, std::size_t n_columns) {
  if (n_columns == 0 || n_values == 0 || n_values % n_columns != 0) {
    throw std::logic_error(fmt::format("'{}' of {} values in rows of {}", dataset, n_values, n_columns));
  }
  const std::array<hsize_t, 2> size = {n_values / n_columns, n_columns};
  const std::array<hsize_t, 2> chunk = {std::min(size[0], kMaxRowsInChunk), n_columns};
  const int n_dimensions = n_columns == 1 ? 1 : 2;

  const Id space(checked(H5Screate_simple(n_dimensions, size.data(), nullptr), path), H5Sclose);
  const Id how(checked(H5Pcreate(H5P_DATASET_CREATE), path), H5Pclose);
  check(H5Pset_obj_track_times(how, false), path);
  check(H5Pset_chunk(how, n_dimensions, chunk.data()), path);
  check(H5Pset_shuffle(how), path);  // groups equal bytes of the numbers, which deflate packs better
  check(H5Pset_deflate(how, kDeflateLevel), path);
  const Id link(checked(H5Pcreate(H5P_LINK_CREATE), path), H5Pclose);
  check(H5Pset_create_intermediate_group(link, 1), path);
  Id data(checked(H5Dcreate2(file, dataset.c_str(), type, space, link, how, H5P_DEFAULT), path), H5Dclose);
  check(H5Dwrite(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), path);
  check(data.close(), path);
}

}  // namespace

struct Hdf5File::Handle {
  Id id;
};

Hdf5File::Hdf5File(std::filesystem::path file) : path_(std::move(file)) {
  // After a full disk a file cannot be closed, and HDF5 would print a message about it at the end of the program. This
  // class closes every identifier itself. (The call fails if it was made before.)
  H5dont_atexit();
  const QuietErrors quiet;
  const Id how(checked(H5Pcreate(H5P_FILE_CREATE), path_), H5Pclose);
  check(H5Pset_obj_track_times(how, false), path_);  // of the root group
  check(H5Pset_istore_k(how, kChunksInNode), path_);
  file_ = std::make_unique<Handle>(
      Handle{Id(checked(H5Fcreate(path_.c_str(), H5F_ACC_TRUNC, how, H5P_DEFAULT), path_), H5Fclose)});
}

Hdf5File::~Hdf5File() {
  const QuietErrors quiet;  // a destructor cannot report errors
  file_.reset();
}

void Hdf5File::write(const std::string& dataset, std::span<const float> values, std::size_t n_columns) {
  const QuietErrors quiet;
  if (!file_) throw std::logic_error("a closed HDF5 file is written to");
  write_rows(file_->id, path_, dataset, H5T_NATIVE_FLOAT, values.data(), values.size(), n_columns);
}

void Hdf5File::write(const std::string& dataset, std::span<const double> values, std::size_t n_columns) {
  const QuietErrors quiet;
  if (!file_) throw std::logic_error("a closed HDF5 file is written to");
  write_rows(file_->id, path_, dataset, H5T_NATIVE_DOUBLE, values.data(), values.size(), n_columns);
}

void Hdf5File::write(const std::string& dataset, std::span<const int> values, std::size_t n_columns) {
  const QuietErrors quiet;
  if (!file_) throw std::logic_error("a closed HDF5 file is written to");
  write_rows(file_->id, path_, dataset, H5T_NATIVE_INT, values.data(), values.size(), n_columns);
}

void Hdf5File::close() {
  const QuietErrors quiet;
  if (file_) check(file_->id.close(), path_);
  file_.reset();
}

}  // namespace driftwright::output
