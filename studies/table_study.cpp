#include "studies/table_study.hpp"

#include <algorithm>
#include <cmath>

#include "compensation/frames/even_growth.hpp"
#include "compensation/sensors/interpolate.hpp"
#include "machine/as_recorded.hpp"
#include "machine/run_record.hpp"
#include "scenarios/reader/felt_run.hpp"
#include "solver/reduced_transient.hpp"
#include "solver/transient.hpp"
#include "studies/table_strategy.hpp"

namespace driftwright::studies {
namespace {

using compensation::TableErrors;
using Errors = std::vector<Eigen::Matrix3Xd>;

/// The course of a scattered model, in the recorded ambient.
TableCourse wrong_course(const scenarios::Scenario& scenario, const scenarios::Model& model, int repetition) {
  const scenarios::TableSettings& s = *scenario.table;
  const MachineRun felt = scenarios::felt_run(*scenario.machine, scenario.cyclogram(s.cyclogram));
  const std::vector<double> times_s = scenarios::output_times_s(felt.cyclogram, scenario.solver.output_interval_s);
  solver::Trajectory trajectory;
  if (const scenarios::Machine* full = model.full()) {
    const Eigen::VectorXd start = scenarios::start_state(*scenario.machine, *full);
    trajectory = solver::simulate(wrong_system(full->system, s, repetition), felt.cyclogram, felt.ambient, times_s,
                                  scenario.solver.transient, start);
  } else {
    const scenarios::ReducedMachine& reduced = *model.reduced();
    trajectory = solver::simulate(wrong_system(reduced.system, s, repetition), felt.cyclogram, felt.ambient, times_s,
                                  scenario.solver.transient, reduced.start);
  }
  return table_course(
      scenario, scenarios::as_recorded(*scenario.machine, trajectory, model.outputs(), scenario.cyclogram(s.cyclogram)),
      wrong_expansions(s, repetition));
}

TableErrors first_rows(const TableErrors& table, std::size_t n) {
  const auto end = static_cast<std::ptrdiff_t>(n);
  return {{table.time_s.begin(), table.time_s.begin() + end},
          table.points_m,
          {table.error_m.begin(), table.error_m.begin() + end}};
}

template <class T>
std::vector<T> first_rows(const std::vector<T>& rows, std::size_t n) {
  return {rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(n)};
}

const solver::Expansion& table_expansion(const scenarios::Scenario& scenario) {
  const auto& materials = scenario.machine->materials;
  return std::find_if(materials.begin(), materials.end(),
                      [&](const scenarios::MaterialEntry& m) { return m.region == scenario.table->region; })
      ->material.expansion_1_K;
}

/// Errors at points of the table from its thermometer and those of its scales, with the model's wrong expansions.
Errors by_thermometers(const scenarios::Scenario& scenario, const Record& readings,
                       std::span<const Eigen::Vector3d> points_m, const ExpansionFactors& factor) {
  const scenarios::TableSettings& s = *scenario.table;
  const solver::Expansion& table = table_expansion(scenario);
  const double reference_K = scenario.machine->reference_K;
  const std::vector<double> table_K = mean_K(readings, {s.thermometer}), scale_x_K = mean_K(readings, s.scale_x.sensors),
                            scale_y_K = s.scale_y ? mean_K(readings, s.scale_y->sensors) : table_K;
  std::vector<compensation::EvenTemperatures> T;
  for (std::size_t i = 0; i < table_K.size(); ++i)
    T.push_back({table_K[i] - reference_K, scale_x_K[i] - reference_K, scale_y_K[i] - reference_K});
  const compensation::EvenAxis x{.table_1_K = factor.table * table.x,
                                 .scale_1_K = factor.scale_x * s.scale_x.expansion_1_K,
                                 .held_at_m = s.head_m[0],
                                 .fixed_at_m = s.scale_x.fixed_at_m};
  std::optional<compensation::EvenAxis> y;
  if (s.scale_y) {
    y = {.table_1_K = factor.table * table.y,
         .scale_1_K = factor.scale_y * s.scale_y->expansion_1_K,
         .held_at_m = s.head_m[1],
         .fixed_at_m = s.scale_y->fixed_at_m};
  }
  return compensation::even_growth(points_m, x, y, T);
}

/// The control's own compensation over the judged time, at its own updates.
std::vector<compensation::TableFrame> control_frames(const scenarios::TableSettings& s,
                                                     const compensation::AxisTemperature& axis,
                                                     const std::vector<double>& time_s, const std::vector<double>& T_K) {
  std::vector<compensation::TableFrame> frames;
  const double travel_m = std::max(std::abs(s.low_m[0]), std::abs(s.high_m[0]));
  compensation::AxisTemperatureData data, wanted;
  double next_s = time_s.front();
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    if (time_s[i] >= next_s - 1e-6) {
      wanted = compensation::data_at(axis, T_K[i]);
      while (next_s <= time_s[i] + 1e-6) next_s += s.update_s;
    }
    const double dt_s = i > 0 ? time_s[i] - time_s[i - 1] : 60.0;
    data = compensation::slewed(data, wanted, dt_s, s.slew * s.velocity_m_s, travel_m);
    frames.push_back(data.frame());
  }
  return frames;
}

void compare_with_readings(TableStudy& study, const scenarios::Scenario& scenario) {
  const scenarios::TableReadings& readings = *scenario.table->readings;
  TimeSeries ambient{readings.time_s, readings.ambient_K};
  const double length_um = 1e6 * (scenario.table->high_m[0] - scenario.table->low_m[0]);
  study.ambient_models =
      compensation::compare_ambient_models(ambient, readings.time_s, readings.x_um, length_um * table_expansion(scenario).x,
                                           length_um * scenario.table->scale_x.expansion_1_K);
  std::vector<double> x_um;
  for (std::size_t i = 0; i < study.course.table.time_s.size(); ++i)
    x_um.push_back(study.course.table_only_x_um[i] - study.course.scale_only_x_um[i]);
  double square = 0.0;
  for (std::size_t i = 0; i < readings.time_s.size(); ++i) {
    const double off = compensation::interpolate(study.course.table.time_s, x_um, readings.time_s[i]) - readings.x_um[i];
    square += off * off / static_cast<double>(readings.time_s.size());
  }
  study.computed_rms_um = std::sqrt(square);
}

}  // namespace

TableCourse table_course(const scenarios::Scenario& scenario, Record record, const ExpansionFactors& factor) {
  const scenarios::TableSettings& s = *scenario.table;
  const std::vector<Eigen::Vector3d> points = scenarios::table_points(s);
  const std::size_t n_grid = static_cast<std::size_t>(s.n_x) * static_cast<std::size_t>(s.n_y), n_times = record.n_samples();
  const std::vector<double> scale_x_K = mean_K(record, s.scale_x.sensors);
  const std::vector<double> scale_y_K = s.scale_y ? mean_K(record, s.scale_y->sensors) : std::vector<double>{};
  std::vector<const std::vector<double>*> u_um;  // three per point
  for (std::size_t p = 0; p < points.size(); ++p) {
    for (char axis : {'x', 'y', 'z'}) u_um.push_back(&record.at(fmt::format("table_{}_{}", p + 1, axis)).values);
  }
  TableCourse result;
  result.table.time_s = record.time_s;
  result.table.points_m.assign(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(n_grid));
  for (std::size_t i = 0; i < n_times; ++i) {
    const auto moved_m = [&](std::size_t p, std::size_t axis) { return factor.table * 1e-6 * (*u_um[3 * p + axis])[i]; };
    const std::size_t head = points.size() - 1;
    const double grown_x = factor.scale_x * s.scale_x.expansion_1_K * (scale_x_K[i] - scenario.machine->reference_K);
    const double grown_y =
        s.scale_y ? factor.scale_y * s.scale_y->expansion_1_K * (scale_y_K[i] - scenario.machine->reference_K) : 0.0;
    Eigen::Matrix3Xd errors(3, static_cast<Eigen::Index>(head));
    for (std::size_t p = 0; p < head; ++p) {
      const double y0_m = s.scale_y ? s.scale_y->fixed_at_m : 0.0;
      errors.col(static_cast<Eigen::Index>(p))
          << moved_m(p, 0) - moved_m(head, 0) - grown_x * (points[p][0] - s.scale_x.fixed_at_m),
          moved_m(p, 1) - moved_m(head, 1) - grown_y * (points[p][1] - y0_m), moved_m(p, 2);
    }
    result.table.error_m.emplace_back(errors.leftCols(static_cast<Eigen::Index>(n_grid)));
    result.rings_m.emplace_back(errors.rightCols(static_cast<Eigen::Index>(s.rings.size())));
    const std::size_t row = static_cast<std::size_t>(s.n_y / 2) * static_cast<std::size_t>(s.n_x);
    result.table_only_x_um.push_back(1e6 * (moved_m(row + static_cast<std::size_t>(s.n_x) - 1, 0) - moved_m(row, 0)));
    result.scale_only_x_um.push_back(1e6 * grown_x * (s.high_m[0] - s.low_m[0]));
  }
  result.record = std::move(record);
  return result;
}

TableStudy study_table(const scenarios::Scenario& scenario, const scenarios::Model& model, const Listener& listener,
                       const scenarios::FieldSink& fields) {
  const scenarios::TableSettings& s = *scenario.table;
  TableStudy study;
  const std::vector<const Cyclogram*> cyclogram = {&scenario.cyclogram(s.cyclogram)};
  study.course = table_course(
      scenario, std::move(scenarios::simulate_cyclograms(scenario, model, cyclogram, listener, fields).front().record));
  const TableCourse& truth = study.course;
  const auto judged_end = std::upper_bound(truth.table.time_s.begin(), truth.table.time_s.end(), s.judge_until_s + 1e-6);
  const std::size_t n = static_cast<std::size_t>(judged_end - truth.table.time_s.begin());
  study.n_judged = n;
  const TableErrors judged = first_rows(truth.table, n);
  const Errors rings_m = first_rows(truth.rings_m, n);
  std::vector<Eigen::Vector3d> places_m;
  for (const scenarios::TableRing& ring : s.rings) places_m.push_back(ring.at_m);

  listener.begin("running models that are off");
  const MachineRun felt = scenarios::felt_run(*scenario.machine, *cyclogram.front());
  std::vector<Errors> model_m, model_table_m, warmth_m, warmth_table_m;
  std::vector<std::vector<double>> ambient_K, thermometer_K;
  for (int k = 0; k < kTableRepetitions; ++k) {
    const TableCourse wrong = wrong_course(scenario, model, k);
    model_m.push_back(first_rows(wrong.rings_m, n));
    model_table_m.push_back(first_rows(wrong.table.error_m, n));
    const Record readings = table_readings(scenario, felt, truth.record, k);
    ambient_K.push_back(mean_K(readings, {kFeltAmbient}));
    thermometer_K.push_back(mean_K(readings, {s.thermometer}));
    warmth_m.push_back(first_rows(by_thermometers(scenario, readings, places_m, wrong_expansions(s, k)), n));
    warmth_table_m.push_back(first_rows(by_thermometers(scenario, readings, judged.points_m, wrong_expansions(s, k)), n));
    listener.share((k + 1.0) / kTableRepetitions);
  }
  const auto left = [&](const Errors& believed_m) {
    return compensation::through_frame(judged, places_m, believed_m).left_m;
  };
  const auto by_rings = [&](double every_s) {
    return [&, every_s](int k) { return left(compensation::held_rings(judged.time_s, rings_m, ring_plan(s, every_s, k))); };
  };
  const auto by_both = [&](int k) {
    return left(compensation::carried_rings(judged.time_s, rings_m, model_m[static_cast<std::size_t>(k)],
                                            ring_plan(s, s.every_s, k)));
  };
  const auto over_table = [&](const Errors& believed_m) {
    return compensation::through_best_frame(judged, believed_m).left_m;
  };
  const auto by_whole_table = [&](double every_s, const std::vector<Errors>& table_m,
                                  const std::vector<Errors>& at_rings_m) {
    return [&, every_s](int k) {
      const auto repetition = static_cast<std::size_t>(k);
      return over_table(compensation::carried_table(judged, places_m, rings_m, table_m[repetition], at_rings_m[repetition],
                                                    ring_plan(s, every_s, k)));
    };
  };

  listener.begin("correcting through the frame");
  const auto by_temperature = [&](const std::vector<std::vector<double>>& T_K) {
    return [&](int k) {
      const std::vector<double>& read_K = T_K[static_cast<std::size_t>(k)];
      const TableTraining t = train(truth, s, k);
      return left(compensation::rings_by_temperature(t.at(read_K), t.rings_m, first_rows(read_K, n)));
    };
  };
  const auto control = [&](int k) {
    const TableTraining t = train(truth, s, k);
    return compensation::fit_axis_temperature(t.at(thermometer_K[static_cast<std::size_t>(k)]), t.rings_m, places_m);
  };
  study.control = control(0);
  study.strategies = {
      repeated("none", [&](int) { return judged.error_m; }),
      repeated("ambient temperature", by_temperature(ambient_K)),
      repeated("table thermometer", by_temperature(thermometer_K)),
      repeated("control's own (SD43900/43910)",
               [&](int k) {
                 const std::vector<double> read_K = first_rows(thermometer_K[static_cast<std::size_t>(k)], n);
                 return compensation::through_frame(judged, control_frames(s, control(k), judged.time_s, read_K)).left_m;
               }),
      repeated("model alone", [&](int k) { return left(model_m[static_cast<std::size_t>(k)]); }),
      repeated("rings", by_rings(s.every_s)),
      repeated("rings, thermometers between", by_whole_table(s.every_s, warmth_table_m, warmth_m)),
      repeated("rings and model", by_both),
      repeated("rings and model of the whole table", by_whole_table(s.every_s, model_table_m, model_m)),
      repeated("exact rings at all times", [&](int) { return left(rings_m); }),
      repeated("best frame (minimax) at all times", [&](int) { return over_table(judged.error_m); }),
  };
  for (double minutes : {10, 20, 30, 45, 60, 90, 120, 180, 240, 360, 480}) {
    const double every_s = 60.0 * minutes;
    study.intervals.push_back({every_s, repeated("", by_rings(every_s)).peak.position_m,
                               repeated("", by_whole_table(every_s, warmth_table_m, warmth_m)).peak.position_m,
                               repeated("", by_whole_table(every_s, model_table_m, model_m)).peak.position_m});
  }
  const auto last = compensation::held_rings(judged.time_s, rings_m, ring_plan(s, s.every_s, 0));
  study.frame = compensation::through_frame(judged, places_m, last).frames.back();
  listener.begin("touching with a probe that lags");
  study.probe = compensation::study_probe(s.probe);
  if (s.readings) compare_with_readings(study, scenario);
  return study;
}

}  // namespace driftwright::studies
