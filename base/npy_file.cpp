#include "base/npy_file.hpp"

#include <fmt/format.h>

#include <fstream>
#include <type_traits>

#include "base/errors.hpp"

namespace driftwright {
namespace {

template <class Scalar>
constexpr const char* kDescr = std::is_same_v<Scalar, double>  ? "<f8"
                               : std::is_same_v<Scalar, float> ? "<f4"
                                                               : "<i4";

/// Magic, version, header length and header: everything before the values. Its length is a multiple of 64.
template <class Scalar>
std::string header(Eigen::Index rows, Eigen::Index columns) {
  const std::string shape = columns == 1 ? fmt::format("({},)", rows) : fmt::format("({}, {})", rows, columns);
  std::string text = fmt::format("{{'descr': '{}', 'fortran_order': True, 'shape': {}, }}", kDescr<Scalar>, shape);
  constexpr std::size_t kBefore = 10;
  while ((kBefore + text.size() + 1) % 64 != 0) text += ' ';
  text += '\n';
  const auto length = static_cast<unsigned>(text.size());
  return std::string("\x93NUMPY\x01\x00", 8) + static_cast<char>(length & 255u) + static_cast<char>(length >> 8u) + text;
}

template <class Scalar>
void write(const std::filesystem::path& path, const Scalar* values, Eigen::Index rows, Eigen::Index columns,
           Eigen::Index stride) {
  std::ofstream file(path, std::ios::binary);
  file << header<Scalar>(rows, columns);
  for (Eigen::Index c = 0; c < columns; ++c) {
    file.write(reinterpret_cast<const char*>(values + c * stride),
               static_cast<std::streamsize>(static_cast<std::size_t>(rows) * sizeof(Scalar)));
  }
  file.close();
  if (!file) throw InputError(fmt::format("{}: cannot be written; is the disk full?", path.string()));
}

}  // namespace

void write_npy(const std::filesystem::path& file, const Eigen::Ref<const Eigen::MatrixXd>& values) {
  write(file, values.data(), values.rows(), values.cols(), values.outerStride());
}
void write_npy(const std::filesystem::path& file, const Eigen::Ref<const Eigen::MatrixXf>& values) {
  write(file, values.data(), values.rows(), values.cols(), values.outerStride());
}
void write_npy(const std::filesystem::path& file, const Eigen::Ref<const Eigen::MatrixXi>& values) {
  write(file, values.data(), values.rows(), values.cols(), values.outerStride());
}

template <class Scalar>
Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic> read_npy(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const auto fail = [&](const char* what) { throw InputError(fmt::format("{}: {}", path.string(), what)); };
  std::string start(10, '\0');
  if (!file.read(start.data(), 10) || start.substr(0, 8) != std::string("\x93NUMPY\x01\x00", 8)) {
    fail("no array of NumPy's format 1.0");
  }
  const std::size_t length = static_cast<unsigned char>(start[8]) + 256u * static_cast<unsigned char>(start[9]);
  std::string text(length, '\0');
  if (!file.read(text.data(), static_cast<std::streamsize>(length))) fail("cut short");
  const auto shape_at = text.find("'shape': (");
  if (text.find(std::string("'descr': '") + kDescr<Scalar> + "'") == std::string::npos ||
      text.find("'fortran_order': True") == std::string::npos || shape_at == std::string::npos) {
    fail("an array of another type or order");
  }
  long long rows = 0, columns = 1;
  if (std::sscanf(text.c_str() + shape_at, "'shape': (%lld, %lld", &rows, &columns) < 1 || rows < 0 || columns < 0) {
    fail("an array of unreadable shape");
  }
  const auto values_at = file.tellg();
  file.seekg(0, std::ios::end);  // of the open file: its name may no longer exist
  const auto n_bytes = static_cast<double>(file.tellg() - values_at);
  file.seekg(values_at);
  if (static_cast<double>(rows) * static_cast<double>(columns) * sizeof(Scalar) > n_bytes) {
    fail("cut short");
  }
  Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic> values(rows, columns);
  if (!file.read(reinterpret_cast<char*>(values.data()),
                 static_cast<std::streamsize>(static_cast<std::size_t>(values.size()) * sizeof(Scalar)))) {
    fail("cut short");
  }
  return values;
}

template Eigen::MatrixXd read_npy<double>(const std::filesystem::path&);
template Eigen::MatrixXf read_npy<float>(const std::filesystem::path&);
template Eigen::MatrixXi read_npy<int>(const std::filesystem::path&);

}  // namespace driftwright
