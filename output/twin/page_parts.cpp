#include "output/twin/page_parts.hpp"

#include <cmath>
#include <stdexcept>

#include "output/markup.hpp"
#include "output/surface_view.hpp"
#include "output/twin/page_files.hpp"

namespace driftwright::output {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kColours = 256;
constexpr double kDarkest = 0.22;  // lowest share of the palette: darker colours would hide the shape of a cold body

Json json_of(const Quantised& q) {
  return {{"scale", text_of(q.scale)}, {"value", text_of(q.value)}};
}

const std::string& file(const std::string& name) {
  for (const PageFile& f : twin_page_files()) {
    if (f.name == name) return f.text;
  }
  throw std::logic_error("page_text: there is no " + name);
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += file(name) + "\n";
  return text;
}

}  // namespace

Json surface_json(const TwinSurface& surface) {
  return {{"n_nodes", surface.node.size()},
          {"coords", text_of(surface.coords_m)},
          {"triangles", text_of(surface.triangle)},
          {"edges", text_of(surface.edge)},
          {"temperature", json_of(surface.temperature)},
          {"displacement", json_of(surface.displacement_m)}};
}

Json network_json(const TwinNetwork& network) {
  const Eigen::MatrixXd by_rows = network.temperature.transpose();
  return {{"names", network.node}, {"links", network.link}, {"temperature", text_of(by_rows)}};
}

Json marks_json(const std::vector<PictureMark>& marks, const TwinSurface& surface) {
  Json list = Json::array();
  for (const PictureMark& mark : marks) {
    Eigen::Index nearest = 0;
    (surface.coords_m.colwise() - mark.at_m.cast<float>()).colwise().squaredNorm().minCoeff(&nearest);
    list.push_back({{"name", mark.name},
                    {"at_m", {mark.at_m.x(), mark.at_m.y(), mark.at_m.z()}},
                    {"is_indicator", mark.is_indicator},
                    {"node", nearest}});
  }
  return list;
}

std::string palette_text() {
  std::string bytes;
  for (int i = 0; i < kColours; ++i) {
    for (float part : inferno(kDarkest + (1.0 - kDarkest) * i / (kColours - 1)))
      bytes += static_cast<char>(static_cast<unsigned char>(std::lround(255.0F * part)));
  }
  return base64(bytes);
}

std::string page_text(const std::string& frame_name, const std::string& title, const std::vector<std::string>& styles,
                      const Json& data, const std::vector<std::string>& scripts) {
  std::string safe;
  for (char ch : data.dump(-1, ' ', false, Json::error_handler_t::replace)) {
    if (ch == '<')
      safe += "\\u003c";
    else
      safe += ch;
  }
  const std::string& frame = file(frame_name);
  const std::vector<std::pair<std::string, std::string>> parts = {
      {"@TITLE@", escaped(title)}, {"@STYLE@", joined(styles)}, {"@DATA@", safe}, {"@SCRIPT@", joined(scripts)}};
  std::string text;
  std::size_t from = 0;
  for (const auto& [mark, part] : parts) {  // in order: inserted text is not searched again
    const std::size_t at = frame.find(mark, from);
    text += frame.substr(from, at - from) + part;
    from = at + mark.size();
  }
  return text + frame.substr(from);
}

}  // namespace driftwright::output
