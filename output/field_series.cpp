#include "output/field_series.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "output/vtk_fields.hpp"
#include "output/xdmf_fields.hpp"

namespace driftwright::output {
namespace {

std::unique_ptr<FieldWriter> make_writer(ResultsFolder& folder, const mesh::Mesh& mesh, FieldsFormat format) {
  switch (format) {
    case FieldsFormat::kVtu:
      return make_vtu_writer(folder, mesh);
    case FieldsFormat::kXdmf:
      return make_xdmf_writer(folder, mesh);
    case FieldsFormat::kNone:
      break;
  }
  throw std::logic_error("a format of fields without a writer");
}

}  // namespace

FieldSeries::FieldSeries(ResultsFolder& folder, const mesh::Mesh& mesh, FieldsFormat format)
    : format_(format), n_nodes_(mesh.n_nodes()), writer_(make_writer(folder, mesh, format)) {}

void FieldSeries::write(double time_s, const Eigen::VectorXd& temperature_degC, const Eigen::Matrix3Xd& displacement_um,
                        const StressField* stress) {
  if (temperature_degC.size() != n_nodes_ || displacement_um.cols() != n_nodes_) {
    throw std::logic_error(
        fmt::format("fields of {} and {} nodes on a mesh of {}", temperature_degC.size(), displacement_um.cols(), n_nodes_));
  }
  if (stress && (stress->stress_MPa.cols() != n_nodes_ || stress->von_mises_MPa.size() != n_nodes_)) {
    throw std::logic_error(fmt::format("stresses of {} and {} nodes on a mesh of {}", stress->stress_MPa.cols(),
                                       stress->von_mises_MPa.size(), n_nodes_));
  }
  if (with_stress_.value_or(stress != nullptr) != (stress != nullptr)) {
    throw std::logic_error(fmt::format("stresses at some times only: the choice changes at {} s", time_s));
  }
  if (!times_s_.empty() && !(time_s > times_s_.back())) {
    throw std::logic_error(fmt::format("fields at {} s after those at {} s", time_s, times_s_.back()));
  }
  with_stress_ = stress != nullptr;
  writer_->write(times_s_.size(), time_s, temperature_degC, displacement_um, stress);
  times_s_.push_back(time_s);
}

void FieldSeries::finish() {
  writer_->finish(times_s_);
}

}  // namespace driftwright::output
