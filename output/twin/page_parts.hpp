#pragma once
// Parts of pages that show a machine: numbers as text, the machine's picture, its colours, and the assembly of the files
// of page/.

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "output/base64.hpp"
#include "output/machine_picture.hpp"
#include "output/twin/twin_surface.hpp"

namespace driftwright::output {

/// Lumped nodes and the pairs that exchange heat; the ambient is the last node.
struct TwinNetwork {
  std::vector<std::string> node = {};
  std::vector<std::pair<int, int>> link = {};
  Eigen::MatrixXd temperature = {};  ///< of all nodes except the ambient, in each state, over the reference [K]
};

/// Numbers as base64 of their little-endian bytes, as pages read them.
template <class Number>
[[nodiscard]] std::string text_of(const Number* data, std::size_t n) {
  return base64({reinterpret_cast<const char*>(data), n * sizeof(Number)});  // NOLINT: bytes are required
}
template <class Number>
[[nodiscard]] std::string text_of(const std::vector<Number>& v) {
  return text_of(v.data(), v.size());
}
template <class Derived>
[[nodiscard]] std::string text_of(const Eigen::PlainObjectBase<Derived>& m) {
  return text_of(m.data(), static_cast<std::size_t>(m.size()));
}

[[nodiscard]] nlohmann::ordered_json surface_json(const TwinSurface& surface);
/// Each mark with its point, and the node of the surface that it moves with.
[[nodiscard]] nlohmann::ordered_json marks_json(const std::vector<PictureMark>& marks, const TwinSurface& surface);
[[nodiscard]] nlohmann::ordered_json network_json(const TwinNetwork& network);
/// The colours of temperature from cold to warm, three bytes each, as base64.
[[nodiscard]] std::string palette_text();

/// The frame (a file of page/) with its placeholders @TITLE@, @STYLE@, @DATA@ and @SCRIPT@ replaced.
/// @param title    is escaped
/// @param styles, scripts  files of page/, in their order
/// @param data     is written so that nothing in it can end its HTML element
[[nodiscard]] std::string page_text(const std::string& frame, const std::string& title,
                                    const std::vector<std::string>& styles, const nlohmann::ordered_json& data,
                                    const std::vector<std::string>& scripts);

}  // namespace driftwright::output
