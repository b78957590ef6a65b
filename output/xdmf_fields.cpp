#include "output/xdmf_fields.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "output/hdf5_file.hpp"

namespace driftwright::output {
namespace {

constexpr const char* kHdf5Name = "fields.h5";
constexpr const char* kXdmfName = "fields.xdmf";

struct XdmfShape {
  const char* name;
  int number;  ///< of the shape, in a mixed topology
};

XdmfShape xdmf_shape(mesh::CellShape shape) {
  switch (shape) {
    case mesh::CellShape::kTet4:
      return {"Tetrahedron", 0x6};
    case mesh::CellShape::kWedge6:
      return {"Wedge", 0x8};
    case mesh::CellShape::kHex8:
      return {"Hexahedron", 0x9};
    case mesh::CellShape::kTet10:
      return {"Tetrahedron_10", 0x26};
    case mesh::CellShape::kWedge15:
      return {"Wedge_15", 0x28};
    case mesh::CellShape::kHex20:
      return {"Hexahedron_20", 0x30};
    case mesh::CellShape::kTri3:
    case mesh::CellShape::kTri6:
    case mesh::CellShape::kQuad4:
    case mesh::CellShape::kQuad8:
      break;
  }
  throw std::logic_error("a facet among the cells of a mesh");
}

/// Text of an attribute. XML allows no control characters except these; others become '?'.
std::string attribute_text(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '"') {
      out += "&quot;";
    } else if (c == '\n' || c == '\t' || c == '\r') {
      out += fmt::format("&#{};", static_cast<int>(c));
    } else {
      out += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
    }
  }
  return out + '"';
}

std::string data_item(const std::string& dimensions, const char* number, const std::string& dataset) {
  return fmt::format(R"(<DataItem Dimensions="{}" {} Format="HDF">{}:/{}</DataItem>)", dimensions, number, kHdf5Name,
                     dataset);
}
constexpr const char* kFloat32 = R"(NumberType="Float" Precision="4")";
constexpr const char* kFloat64 = R"(NumberType="Float" Precision="8")";
constexpr const char* kInt32 = R"(NumberType="Int" Precision="4")";

class XdmfWriter : public FieldWriter {
 public:
  XdmfWriter(ResultsFolder& folder, const mesh::Mesh& mesh)
      : folder_(folder), region_names_(mesh.regions), n_nodes_(mesh.n_nodes()), file_(folder.path(kHdf5Name)) {
    const Eigen::Index n_coords = mesh.coords.size();
    file_.write("mesh/coordinates", std::span(mesh.coords.data(), n_coords), 3);
    write_cells(mesh.cells);
    file_.write("mesh/region", mesh.cells.group);
    mesh_xml_ += fmt::format("        <Geometry GeometryType=\"XYZ\">{}</Geometry>\n",
                             data_item(fmt::format("{} 3", n_nodes_), kFloat64, "mesh/coordinates"));
    mesh_xml_ += fmt::format("        <Attribute Name=\"region\" AttributeType=\"Scalar\" Center=\"Cell\">{}</Attribute>\n",
                             data_item(std::to_string(mesh.cells.size()), kInt32, "mesh/region"));
  }

  std::string file_to_open() const override { return kXdmfName; }

  void write(std::size_t i, double /*time_s*/, const Eigen::VectorXd& temperature_degC,
             const Eigen::Matrix3Xd& displacement_um, const StressField* stress) override {
    with_stress_ = stress != nullptr;
    write_array(i, "temperature_degC", temperature_degC.transpose());
    write_array(i, "displacement_um", displacement_um);
    if (!stress) return;
    write_array(i, "stress_MPa", stress->stress_MPa);
    write_array(i, "von_mises_MPa", stress->von_mises_MPa.transpose());
  }

  void finish(const std::vector<double>& times_s) override {
    file_.close();
    const Provenance& made_by = folder_.made_by();
    // Information is placed inside the domain: ParaView's XDMF 3 readers take the first element below Xdmf for the
    // domain.
    std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Xdmf Version=\"2.2\">\n  <Domain>\n";
    xml += fmt::format("    <Information Name=\"made_by\" Value={}/>\n",
                       attribute_text(fmt::format("Driftwright {}, {}", made_by.version, made_by.scenario)));
    xml += fmt::format("    <Information Name=\"region_names\" Value={}/>\n",
                       attribute_text(fmt::format("{}", fmt::join(region_names_, "\n"))));
    xml += "    <Grid Name=\"fields\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
    for (std::size_t i = 0; i < times_s.size(); ++i) {
      // The same text for the mesh at each time: from that ParaView knows that it has already read it.
      xml += fmt::format("      <Grid Name=\"machine\" GridType=\"Uniform\">\n        <Time Value=\"{}\"/>\n{}", times_s[i],
                         mesh_xml_);
      xml += attribute(i, "temperature_degC", "Scalar", 1) + attribute(i, "displacement_um", "Vector", 3);
      if (with_stress_) xml += attribute(i, "stress_MPa", "Matrix", 6) + attribute(i, "von_mises_MPa", "Scalar", 1);
      xml += "      </Grid>\n";
    }
    folder_.write_text(kXdmfName, xml + "    </Grid>\n  </Domain>\n</Xdmf>\n");
  }

 private:
  void write_cells(const mesh::Cells& cells) {
    const auto differs = [&](mesh::CellShape shape) { return shape != cells.shape.front(); };
    std::string type = "Mixed", dimensions;
    if (std::none_of(cells.shape.begin(), cells.shape.end(), differs)) {
      const int n = mesh::n_nodes_of(cells.shape.front());
      type = xdmf_shape(cells.shape.front()).name;
      dimensions = fmt::format("{} {}", cells.size(), n);
      file_.write("mesh/cells", cells.node, n);
    } else {
      std::vector<int> numbers;
      for (int c = 0; c < cells.size(); ++c) {
        numbers.push_back(xdmf_shape(cells.shape[c]).number);
        numbers.insert(numbers.end(), cells.nodes(c).begin(), cells.nodes(c).end());
      }
      dimensions = std::to_string(numbers.size());
      file_.write("mesh/cells", numbers);
    }
    mesh_xml_ = fmt::format("        <Topology TopologyType=\"{}\" NumberOfElements=\"{}\">{}</Topology>\n", type,
                            cells.size(), data_item(dimensions, kInt32, "mesh/cells"));
  }

  static std::string dataset(std::size_t i, const char* array) { return fmt::format("times/{:04}/{}", i, array); }

  /// One row in the file per node, a column here.
  void write_array(std::size_t i, const char* array, const Eigen::Ref<const Eigen::MatrixXd>& values) {
    const Eigen::MatrixXf rounded = values.cast<float>();
    file_.write(dataset(i, array), std::span(rounded.data(), static_cast<std::size_t>(rounded.size())), rounded.rows());
  }

  std::string attribute(std::size_t i, const char* array, const char* type, int n_columns) const {
    const std::string dimensions = n_columns == 1 ? std::to_string(n_nodes_) : fmt::format("{} {}", n_nodes_, n_columns);
    return fmt::format("        <Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"Node\">{}</Attribute>\n", array, type,
                       data_item(dimensions, kFloat32, dataset(i, array)));
  }

  ResultsFolder& folder_;
  std::vector<std::string> region_names_;
  int n_nodes_;
  Hdf5File file_;
  std::string mesh_xml_;
  bool with_stress_ = false;
};

}  // namespace

std::unique_ptr<FieldWriter> make_xdmf_writer(ResultsFolder& folder, const mesh::Mesh& mesh) {
  return std::make_unique<XdmfWriter>(folder, mesh);
}

}  // namespace driftwright::output
