#include "app/table_study.hpp"

#include <algorithm>
#include <cmath>

#include "base/quantity.hpp"
#include "compensation/interpolate.hpp"
#include "scenarios/as_recorded.hpp"
#include "solver/reduced_transient.hpp"
#include "solver/transient.hpp"

namespace driftwright::app {
namespace {

using compensation::PeakErrors;
using compensation::TableErrors;
using Errors = std::vector<Eigen::Matrix3Xd>;

constexpr int kRepetitions = 5;
/// Expansions of a library are known to 3 %: grey iron from 10.0 to 11.7, say its standards.
constexpr double kExpansionScatter = 0.03;

std::vector<double> kelvins(const Record& record, const std::string& sensor) {
  std::vector<double> T_K = record.at(sensor).values;
  for (double& T : T_K) T += kZeroCelsius_K;
  return T_K;
}

/// The same machine off by random factors in each power and coefficient.
template <class System>
System scattered(System system, double sigma, Random& random) {
  for (auto& source : system.sources) source.load *= std::exp(sigma * random.normal());
  for (auto& e : system.exchanges) {
    const double f = std::exp(sigma * random.normal());
    e.matrix *= f;
    e.to_hall *= f;
    e.hall_sum *= f;
    e.flow *= f;
    e.offset *= f;
    e.offset_sum *= f;
  }
  return system;
}

/// The run of a model that is wrong, in the hall that was recorded.
TableRun wrong_run(const scenarios::Scenario& scenario, const Model& model, int repetition) {
  const scenarios::TableSettings& s = *scenario.table;
  Random random(static_cast<std::uint64_t>(s.seed), 50 + static_cast<std::uint64_t>(repetition));
  const scenarios::FeltRun felt = scenarios::felt_run(*scenario.machine, scenario.cyclogram(s.cyclogram));
  const std::vector<double> times_s = scenarios::output_times_s(felt.cyclogram, scenario.solver.output_interval_s);
  SimulatedRun run;
  if (const scenarios::Machine* full = model.full()) {
    const Eigen::VectorXd start = scenarios::start_state(*scenario.machine, *full);
    run.trajectory = solver::simulate(scattered(full->system, s.model_scatter, random), felt.cyclogram, felt.hall, times_s,
                                      scenario.solver.transient, start);
  } else {
    const scenarios::ReducedMachine& reduced = *model.reduced();
    run.trajectory = solver::simulate(scattered(reduced.system, s.model_scatter, random), felt.cyclogram, felt.hall, times_s,
                                      scenario.solver.transient, reduced.start);
  }
  run.record = scenarios::as_recorded(*scenario.machine, run.trajectory, model.outputs(), scenario.cyclogram(s.cyclogram));
  const auto factor = [&] { return std::exp(kExpansionScatter * random.normal()); };
  const ExpansionFactors expansions{.table = factor(), .scale_x = factor(), .scale_y = factor()};
  return table_run(scenario, std::move(run), expansions);
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

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// Repeats a correction and keeps what is typical and what is worst.
template <class Correct>
TableStrategy repeated(const std::string& name, const Correct& correct) {
  TableStrategy strategy{.name = name};
  std::vector<PeakErrors> all;
  for (int k = 0; k < kRepetitions; ++k) {
    const Errors left_m = correct(k);
    all.push_back(compensation::peaks(left_m));
    if (k > 0) continue;
    for (const Eigen::Matrix3Xd& e : left_m) strategy.course_um.push_back(1e6 * e.colwise().norm().maxCoeff());
  }
  for (auto member : {&PeakErrors::x_m, &PeakErrors::y_m, &PeakErrors::z_m, &PeakErrors::position_m}) {
    std::vector<double> values;
    for (const PeakErrors& p : all) values.push_back(p.*member);
    strategy.peak.*member = median(values);
    strategy.worst.*member = *std::max_element(values.begin(), values.end());
  }
  return strategy;
}

/// Rings measured while training, and what a thermometer read then.
struct Training {
  std::vector<std::size_t> rows;
  Errors rings_m;
  [[nodiscard]] std::vector<double> at(const std::vector<double>& values) const {
    std::vector<double> found;
    for (std::size_t row : rows) found.push_back(values[row]);
    return found;
  }
};

Training train(const TableRun& run, const scenarios::TableSettings& s, int repetition) {
  Training training;
  Random random(static_cast<std::uint64_t>(s.seed), 80 + static_cast<std::uint64_t>(repetition));
  double next_s = s.train_from_s;
  for (std::size_t i = 0; i < run.table.time_s.size(); ++i) {
    if (run.table.time_s[i] < next_s - 1e-6) continue;
    next_s += s.every_s;
    training.rows.push_back(i);
    Eigen::Matrix3Xd measured_m = run.rings_m[i];
    for (double& value : measured_m.reshaped()) value += s.probe_noise_m * random.normal();
    training.rings_m.push_back(std::move(measured_m));
  }
  return training;
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
  TimeSeries hall{readings.time_s, readings.ambient_K};
  const auto& materials = scenario.machine->materials;
  const auto table = std::find_if(materials.begin(), materials.end(),
                                  [&](const scenarios::MaterialEntry& m) { return m.region == scenario.table->region; });
  const double length_um = 1e6 * (scenario.table->high_m[0] - scenario.table->low_m[0]);
  study.hall_models =
      compensation::compare_hall_models(hall, readings.time_s, readings.x_um, length_um * table->material.expansion_1_K.x,
                                        length_um * scenario.table->scale_x.expansion_1_K);
  std::vector<double> x_um;
  for (std::size_t i = 0; i < study.run.table.time_s.size(); ++i)
    x_um.push_back(study.run.table_only_x_um[i] - study.run.scale_only_x_um[i]);
  double square = 0.0;
  for (std::size_t i = 0; i < readings.time_s.size(); ++i) {
    const double off = compensation::interpolate(study.run.table.time_s, x_um, readings.time_s[i]) - readings.x_um[i];
    square += off * off / static_cast<double>(readings.time_s.size());
  }
  study.computed_rms_um = std::sqrt(square);
}

}  // namespace

TableRun table_run(const scenarios::Scenario& scenario, SimulatedRun run, const ExpansionFactors& factor) {
  const scenarios::TableSettings& s = *scenario.table;
  const std::vector<Eigen::Vector3d> points = scenarios::table_points(s);
  const std::size_t n_grid = static_cast<std::size_t>(s.n_x) * static_cast<std::size_t>(s.n_y),
                    n_times = run.record.n_samples();
  const std::vector<double> scale_x_K = kelvins(run.record, s.scale_x.sensor);
  const std::vector<double> scale_y_K = s.scale_y ? kelvins(run.record, s.scale_y->sensor) : std::vector<double>{};
  std::vector<const std::vector<double>*> u_um;  // three a point
  for (std::size_t p = 0; p < points.size(); ++p) {
    for (char axis : {'x', 'y', 'z'}) u_um.push_back(&run.record.at(fmt::format("table_{}_{}", p + 1, axis)).values);
  }
  TableRun result;
  result.table.time_s = run.record.time_s;
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
  result.record = std::move(run.record);
  result.trajectory = std::move(run.trajectory);
  return result;
}

TableStudy study_table(const scenarios::Scenario& scenario, const Model& model, Progress& progress,
                       output::FieldSeries* fields) {
  const scenarios::TableSettings& s = *scenario.table;
  TableStudy study;
  const std::vector<const Cyclogram*> cyclogram = {&scenario.cyclogram(s.cyclogram)};
  study.run = table_run(scenario, std::move(simulate_cyclograms(scenario, model, cyclogram, progress, 0, fields).front()));
  const TableRun& truth = study.run;
  const auto judged_end = std::upper_bound(truth.table.time_s.begin(), truth.table.time_s.end(), s.judge_until_s + 1e-6);
  const std::size_t n = static_cast<std::size_t>(judged_end - truth.table.time_s.begin());
  study.n_judged = n;
  const TableErrors judged = first_rows(truth.table, n);
  const Errors rings_m = first_rows(truth.rings_m, n);
  std::vector<Eigen::Vector3d> places_m;
  for (const scenarios::TableRing& ring : s.rings) places_m.push_back(ring.at_m);

  progress.begin("running models that are off");
  std::vector<Errors> model_m, model_table_m;
  for (int k = 0; k < kRepetitions; ++k) {
    const TableRun wrong = wrong_run(scenario, model, k);
    model_m.push_back(first_rows(wrong.rings_m, n));
    model_table_m.push_back(first_rows(wrong.table.error_m, n));
    progress.update((k + 1.0) / kRepetitions);
  }
  const auto plan = [&](double every_s, int repetition) {
    return compensation::RingPlan{
        .every_s = every_s, .noise_m = s.probe_noise_m, .seed = static_cast<std::uint64_t>(s.seed + 1000 * repetition)};
  };
  const auto left = [&](const Errors& believed_m) {
    return compensation::through_frame(judged, places_m, believed_m).left_m;
  };
  const auto by_rings = [&](double every_s) {
    return [&, every_s](int k) { return left(compensation::held_rings(judged.time_s, rings_m, plan(every_s, k))); };
  };
  const auto by_both = [&](double every_s) {
    return [&, every_s](int k) {
      return left(
          compensation::carried_rings(judged.time_s, rings_m, model_m[static_cast<std::size_t>(k)], plan(every_s, k)));
    };
  };
  const auto over_table = [&](const Errors& believed_m) {
    return compensation::through_frame(judged, judged.points_m, believed_m).left_m;
  };
  const auto by_whole_table = [&](double every_s) {
    return [&, every_s](int k) {
      const auto repetition = static_cast<std::size_t>(k);
      return over_table(compensation::carried_table(judged, places_m, rings_m, model_table_m[repetition],
                                                    model_m[repetition], plan(every_s, k)));
    };
  };

  progress.begin("correcting through the frame");
  const std::vector<double> thermometer_K = kelvins(truth.record, s.thermometer);
  std::vector<double> hall_K;
  const scenarios::FeltRun felt = scenarios::felt_run(*scenario.machine, *cyclogram.front());
  for (double t_s : truth.table.time_s) hall_K.push_back(felt.hall.at(t_s) + scenario.machine->reference_K);
  const auto by_thermometer = [&](const std::vector<double>& T_K) {
    return [&](int k) {
      const Training t = train(truth, s, k);
      return left(compensation::rings_by_temperature(t.at(T_K), t.rings_m, first_rows(T_K, n)));
    };
  };
  const Training training = train(truth, s, 0);
  study.control = compensation::fit_axis_temperature(training.at(thermometer_K), training.rings_m, places_m);
  study.strategies = {
      repeated("none", [&](int) { return judged.error_m; }),
      repeated("hall temperature", by_thermometer(hall_K)),
      repeated("table thermometer", by_thermometer(thermometer_K)),
      repeated("control's own (SD43900/43910)",
               [&](int k) {
                 const Training t = train(truth, s, k);
                 const auto axis = compensation::fit_axis_temperature(t.at(thermometer_K), t.rings_m, places_m);
                 return compensation::through_frame(judged,
                                                    control_frames(s, axis, judged.time_s, first_rows(thermometer_K, n)))
                     .left_m;
               }),
      repeated("model alone", [&](int k) { return left(model_m[static_cast<std::size_t>(k)]); }),
      repeated("rings", by_rings(s.every_s)),
      repeated("rings and model", by_both(s.every_s)),
      repeated("rings and model of the whole table", by_whole_table(s.every_s)),
      repeated("exact rings at all times", [&](int) { return left(rings_m); }),
      repeated("best frame at all times", [&](int) { return over_table(judged.error_m); }),
  };
  for (double minutes : {10, 20, 30, 45, 60, 90, 120, 180, 240, 360, 480}) {
    const double every_s = 60.0 * minutes;
    study.intervals.push_back(
        {every_s, repeated("", by_rings(every_s)).peak.position_m, repeated("", by_whole_table(every_s)).peak.position_m});
  }
  const auto last = compensation::held_rings(judged.time_s, rings_m, plan(s.every_s, 0));
  study.frame = compensation::through_frame(judged, places_m, last).frames.back();
  progress.begin("touching with a probe that lags");
  study.probe = compensation::study_probe(s.probe);
  if (s.readings) compare_with_readings(study, scenario);
  return study;
}

}  // namespace driftwright::app
