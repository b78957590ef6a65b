#include <fmt/format.h>

#include "app/results.hpp"
#include "findings/plausibility.hpp"
#include "findings/volume_document.hpp"
#include "output/vtk_fields.hpp"
#include "scenarios/reader/unusual.hpp"

namespace driftwright::app {
namespace {

/// One .vtu of each time: the points of the grid in the frame of the work, with their errors.
void write_volume(output::ResultsFolder& folder, const studies::WorkVolume& volume,
                  const scenarios::VolumeSettings& settings, const std::vector<scenarios::MovingAxis>& axes) {
  std::vector<int> n;
  for (const std::vector<double>& of_axis : settings.positions_SI) n.push_back(static_cast<int>(of_axis.size()));
  const auto n_points = static_cast<Eigen::Index>(volume.points.size());
  Eigen::Matrix3Xd place_m(3, n_points);
  std::vector<output::PointVectors> errors = {{"error_um", Eigen::Matrix3Xd(3, n_points)},
                                              {"turn_urad", Eigen::Matrix3Xd(3, n_points)}};
  std::vector<std::string> files;
  for (std::size_t t = 0; t < volume.time_s.size(); ++t) {
    for (Eigen::Index i = 0; i < n_points; ++i) {
      const studies::VolumePoint& p = volume.points[static_cast<std::size_t>(i)];
      place_m.col(i) = p.place_m;
      const Eigen::Matrix3d into_work =
          scenarios::motion_of(scenarios::axes_at(axes, p.pose), settings.work).turn.transpose();
      errors[0].value.col(i) = 1e6 * into_work * p.error_m[t];
      errors[1].value.col(i) = 1e6 * into_work * p.turn_rad[t];
    }
    files.push_back(fmt::format("volume/volume_{:04}.vtu", t));
    output::write_point_grid(n, place_m, errors, volume.time_s[t], folder.path(files.back()));
  }
  folder.write_text("volume.pvd", output::pvd_text(volume.time_s, files));
}

}  // namespace

void run_volume(const CommonOptions& options, const scenarios::Scenario& scenario) {
  const scenarios::VolumeSettings& settings = *scenario.volume;
  output::ResultsFolder folder = open_results(options, scenario.name);
  Progress progress(options.quiet);
  progress.begin("meshing");
  const mesh::Mesh drawn = scenarios::build_mesh(scenario.machine->mesh);
  const scenarios::Model machine =
      scenarios::open_model(scenario, {&scenario.cyclogram(settings.cyclogram)}, progress.listener(), false, &drawn, nullptr,
                            scenarios::Follows::kMoves);
  if (const scenarios::ReducedMachine* reduced = machine.reduced(); reduced && !reduced->gives_node_temperatures())
    throw InputError(settings.where,
                     "`volume` requires the temperatures of all nodes; write `solver: {model: full}`, or take "
                     "`fields_format: none` out");
  const studies::WorkVolume volume = studies::study_volume(scenario, drawn, machine, progress.listener());
  progress.begin("writing results");
  write_volume(folder, volume, settings, scenario.machine->axes);
  folder.write_text("record.csv",
                    record_csv(volume.run.record, provenance_lines(folder.made_by(), "cyclogram " + settings.cyclogram)));
  folder.write_text("heat_flows.csv", heat_flows_csv(volume.run.trajectory, settings.cyclogram, folder.made_by()));
  output::Document document = findings::document_of(volume, scenario, machine, folder.made_by());
  findings::add_plausibility(document.body, scenario, scenarios::unusual_values(volume.run.record));
  finish(document, folder, progress, options, "volume.pvd opens in ParaView: glyphs along error_um\n");
}

}  // namespace driftwright::app
