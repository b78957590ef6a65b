#include "mesh/mesh_bytes.hpp"

#include <cstring>
#include <stdexcept>
#include <type_traits>

namespace driftwright::mesh {
namespace {

/// Visits every part of a mesh in a fixed order, for writing and reading.
template <class MeshOrConst, class Visitor>
void each_part(MeshOrConst& mesh, Visitor&& part) {
  for (auto* cells : {&mesh.cells, &mesh.facets}) {
    part(cells->shape);
    part(cells->offset);
    part(cells->node);
    part(cells->group);
  }
  part(mesh.regions);
  part(mesh.surfaces);
  part(mesh.notes);
}

class Writer {
 public:
  std::string bytes;

  template <class T>
  requires std::is_trivially_copyable_v<T>
  void operator()(const std::vector<T>& values) {
    raw(values.size());
    append(values.data(), values.size() * sizeof(T));
  }
  void operator()(const std::vector<std::string>& texts) {
    raw(texts.size());
    for (const std::string& text : texts) (*this)(text);
  }
  void operator()(const std::string& text) {
    raw(text.size());
    append(text.data(), text.size());
  }
  void operator()(const Eigen::Matrix3Xd& coords) {
    raw(static_cast<std::size_t>(coords.cols()));
    append(coords.data(), static_cast<std::size_t>(coords.size()) * sizeof(double));
  }
  void raw(std::size_t n) { append(&n, sizeof n); }

 private:
  void append(const void* from, std::size_t n) {
    if (n > 0) bytes.append(static_cast<const char*>(from), n);
  }
};

class Reader {
 public:
  explicit Reader(std::string_view bytes) : left_(bytes) {}

  template <class T>
  requires std::is_trivially_copyable_v<T>
  void operator()(std::vector<T>& values) {
    values.resize(count(sizeof(T)));
    take(values.data(), values.size() * sizeof(T));
  }
  void operator()(std::vector<std::string>& texts) {
    texts.resize(count(sizeof(std::size_t)));
    for (std::string& text : texts) (*this)(text);
  }
  void operator()(std::string& text) {
    text.resize(count(1));
    take(text.data(), text.size());
  }
  void operator()(Eigen::Matrix3Xd& coords) {
    coords.resize(3, static_cast<Eigen::Index>(count(3 * sizeof(double))));
    take(coords.data(), static_cast<std::size_t>(coords.size()) * sizeof(double));
  }
  /// Reads a count of items of that size that follow.
  std::size_t count(std::size_t size) {
    std::size_t n = 0;
    take(&n, sizeof n);
    if (n > left_.size() / size) cut();
    return n;
  }
  void require_end() const {
    if (!left_.empty()) cut();
  }

 private:
  [[noreturn]] static void cut() { throw std::logic_error("a mesh in bytes is not of the size that it says"); }
  void take(void* to, std::size_t n) {
    if (n > left_.size()) cut();
    if (n > 0) std::memcpy(to, left_.data(), n);
    left_.remove_prefix(n);
  }
  std::string_view left_;
};

}  // namespace

std::string mesh_bytes(const Mesh& mesh) {
  Writer write;
  write(mesh.coords);
  each_part(mesh, write);
  write.raw(mesh.joints.size());
  for (const Joint& joint : mesh.joints) {
    for (const std::string* text : {&joint.name, &joint.side_a, &joint.side_b}) write(*text);
  }
  return std::move(write.bytes);
}

Mesh mesh_of_bytes(std::string_view bytes) {
  Mesh mesh;
  Reader read(bytes);
  read(mesh.coords);
  each_part(mesh, read);
  mesh.joints.resize(read.count(3 * sizeof(std::size_t)));
  for (Joint& joint : mesh.joints) {
    for (std::string* text : {&joint.name, &joint.side_a, &joint.side_b}) read(*text);
  }
  read.require_end();
  return mesh;
}

}  // namespace driftwright::mesh
