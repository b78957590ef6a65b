#include "diagnosis/level_machine.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "diagnosis/no_solution.hpp"

namespace driftwright::diagnosis {
namespace {

/// The real drive of the machine at a level; the level itself if the real drive is not constant.
Drive felt(const effects::DriveChange& change, const Drive& level, double duration_s, const std::string& run) {
  const Cyclogram is = effects::true_cyclogram(change, {.name = run, .sections = {{duration_s, level}}});
  return is.sections.size() == 1 ? is.sections.front().drive : level;
}

}  // namespace

LevelMachine::LevelMachine(const Twin& twin, const Doubts& doubts, const std::vector<Drive>& levels, const MeasuredRun& like,
                           double row_s, double interval_s, const std::map<std::string, NoiseModel>& noise)
    : twin_(twin),
      run_(planned_run(like.cyclogram, row_s, like.ambient, like.has_ambient, like.channels)),
      levels_(levels),
      row_s_(row_s),
      n_steps_(run_.time_s.size() - 1) {
  run_.grid_s = run_.time_s;
  for (std::size_t i = 0; i < run_.grid_s.size(); ++i) run_.row_in_grid[i] = static_cast<Eigen::Index>(i);
  run_.row_in_grid.resize(run_.grid_s.size());
  for (Eigen::ArrayXXd* a : {&carry_, &gain_, &scale_})
    a->resize(static_cast<Eigen::Index>(run_.channels.size()), static_cast<Eigen::Index>(n_steps_) + 1);
  for (Eigen::Index channel = 0; const MeasuredChannel& c : run_.channels) {
    outputs_.push_back(c.output);
    NoiseModel of_row = noise.at(c.name);
    of_row.white *= std::sqrt(std::min(1.0, interval_s / row_s));
    const Whitener whitener(of_row, run_.time_s, std::vector<char>(run_.time_s.size(), 1));
    const auto row = [](const std::vector<double>& v) {
      return Eigen::Map<const Eigen::ArrayXd>(v.data(), static_cast<Eigen::Index>(v.size())).transpose();
    };
    carry_.row(channel) = row(whitener.carry());
    gain_.row(channel) = row(whitener.gain());
    scale_.row(channel++) = row(whitener.scale());
  }
  turned_.push_back({.state = twin.as_written()});
  for (const Knob& k : doubts.numbers) turned_.push_back({.state = with_number(twin, k), .by = k.step});
  for (const Doubts::Shape& s : doubts.shapes) turned_.push_back({.state = with_law(twin, doubts, s), .by = s.x[0]});
  courses_.resize(turned_.size());
  for_each_index(
      turned_.size(), [&] { return Twin::Workspace(twin); },
      [&](std::size_t i, Twin::Workspace& workspace) {
        Turned& t = turned_[i];
        t.reads = !effects::reading_chain(t.state, run_.name).empty();
        t.course = i;
        const bool of_instruments = i > doubts.numbers.size() &&
                                    doubts.variant(doubts.shapes[i - 1 - doubts.numbers.size()]).knobs.front().reading_only;
        if (of_instruments || !has_solution([&] { courses_[i] = course_of(t.state, levels_, workspace); })) t.course = 0;
      });
}

LevelMachine::Course LevelMachine::course_of(const TwinState& state, const std::vector<Drive>& levels,
                                             Twin::Workspace& workspace) const {
  const Twin::Bound bound = twin_.bound(state, run_, workspace);
  const solver::ReducedSystem& system = bound.system;
  Course course;
  course.start = bound.start.cast<float>();
  course.ambient_K.resize(static_cast<Eigen::Index>(n_steps_) + 1);
  for (std::size_t i = 0; i <= n_steps_; ++i)
    course.ambient_K[static_cast<Eigen::Index>(i)] = static_cast<float>(bound.ambient.at(run_.time_s[i]));
  course.observe = Eigen::MatrixXf::Zero(twin_.outputs().state.cols(), system.size());
  course.observe.leftCols(bound.outputs.rows()) = bound.outputs.transpose().cast<float>();
  const effects::DriveChange change = effects::drive_change(state, run_.name);
  for (const Drive& level : levels) {
    effects::Inputs at{.drive = felt(change, level, run_.cyclogram.duration_s(), run_.name),
                       .ambient_K = static_cast<double>(course.ambient_K.mean()),
                       .time_s = 0.5 * run_.cyclogram.duration_s()};
    at.run = run_.name;
    const LinearStep step = linear_step(linear_system(system, at, bound.start), system.mass, row_s_);
    course.steps.push_back(
        {step.phi.cast<float>(), step.constant.cast<float>(), step.of_ambient.cast<float>(), step.of_rise.cast<float>()});
  }
  return course;
}

Eigen::MatrixXd LevelMachine::response(const Course& course, const std::vector<int>& level_of_step) const {
  Eigen::MatrixXf states(course.start.size(), static_cast<Eigen::Index>(n_steps_) + 1);
  states.col(0) = course.start;
  for (std::size_t i = 0; i < n_steps_; ++i) {
    const Step& step = course.steps[static_cast<std::size_t>(level_of_step[i])];
    const auto k = static_cast<Eigen::Index>(i);
    const float ambient_K = course.ambient_K[k];
    states.col(k + 1) = step.constant + ambient_K * step.of_ambient + (course.ambient_K[k + 1] - ambient_K) * step.of_rise;
    states.col(k + 1).noalias() += step.phi * states.col(k);
  }
  Eigen::MatrixXd outputs = (course.observe * states).cast<double>();
  if ((twin_.outputs().ambient.array() != 0.0).any())
    outputs.noalias() += twin_.outputs().ambient * course.ambient_K.cast<double>().transpose();
  return outputs;
}

Eigen::MatrixXd LevelMachine::information(const std::vector<int>& level_of_step) const {
  MeasuredRun run;  // the data that instruments depend on
  run.name = run_.name;
  run.ambient = run_.ambient;
  run.time_s = run_.time_s;
  run.grid_s = run_.grid_s;
  run.row_in_grid = run_.row_in_grid;
  run.cyclogram.name = run_.name;
  for (int level : level_of_step) {
    const Drive& drive = levels_[static_cast<std::size_t>(level)];
    auto& sections = run.cyclogram.sections;
    if (!sections.empty() && sections.back().drive == drive)
      sections.back().duration_s += row_s_;
    else
      sections.push_back({row_s_, drive});
  }
  const Eigen::MatrixXd machine = response(courses_[0], level_of_step);
  const Eigen::MatrixXd as_written = turned_[0].reads ? twin_.read(turned_[0].state, run, machine) : machine;
  const auto n_rows = static_cast<Eigen::Index>(n_steps_) + 1;
  const auto n_channels = static_cast<Eigen::Index>(outputs_.size());
  Eigen::MatrixXd columns(n_rows * n_channels, static_cast<Eigen::Index>(turned_.size()) - 1);
  Eigen::ArrayXd estimate(n_channels), innovation(n_channels);
  for (std::size_t i = 1; i < turned_.size(); ++i) {
    const Turned& t = turned_[i];
    Eigen::MatrixXd readings = t.course == 0 ? machine : response(courses_[i], level_of_step);
    if (t.reads) readings = twin_.read(t.state, run, std::move(readings));
    Eigen::Map<Eigen::ArrayXXd> whitened(columns.col(static_cast<Eigen::Index>(i) - 1).data(), n_channels, n_rows);
    whitened = (readings(outputs_, Eigen::all) - as_written(outputs_, Eigen::all)).array() / t.by;
    estimate.setZero();
    for (Eigen::Index row = 0; row < n_rows; ++row) {  // as Whitener::apply, for all channels at once
      estimate *= carry_.col(row);
      innovation = whitened.col(row) - estimate;
      estimate += gain_.col(row) * innovation;
      whitened.col(row) = scale_.col(row) * innovation;
    }
  }
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(columns.cols(), columns.cols());
  information.selfadjointView<Eigen::Lower>().rankUpdate(columns.transpose());
  information.triangularView<Eigen::StrictlyUpper>() = information.transpose();
  return information;
}

}  // namespace driftwright::diagnosis
