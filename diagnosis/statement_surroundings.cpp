#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/no_solution.hpp"
#include "diagnosis/statement_builder.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kAmbient_K = 2.0;  // typical error of an ambient
constexpr double kSpeedFactors[] = {0.5, 0.8, 0.95, 1.05, 1.25, 2.0};
constexpr double kClocks_s[] = {-3600.0, -1500.0, -720.0, -360.0, -180.0, -60.0,  -20.0,
                                20.0,    60.0,    180.0,  360.0,  720.0,  1500.0, 3600.0};

constexpr double kSet_s = 60.0;         // typical shift of a clock that is set during a record
constexpr double kLeastLate_s = 180.0;  // least delay of an ambient's record, which changes slowly

effects::Effect ambient_effect(const char* kind, const char* number, double value) {
  return effects::make_effect(kind, effects::Place::kAmbient, effects::kAmbientName, {{number, value}});
}

}  // namespace

void StatementBuilder::surroundings() {
  ambients();
  late_ambients();
  stratification();
  if (scene_.turns) speeds();
  clocks();
}

Statement StatementBuilder::of_ambient() {
  return {.quantity = StatedQuantity::kAmbient, .place = {"hall"}, .unit_size = kAmbient_K, .unit = "K"};
}

void StatementBuilder::ambients() {
  auto air = std::make_shared<Loads>();
  for (const LinearOperator& m : machine_) air->push_back(m.ambient());
  const auto with_instruments = [&](const TimedCourse& course, bool always) {
    std::vector<Acting> acts = {{.loads = air, .channel = {}, .course = course.in_interval, .always = always}};
    for (const Channel& c : channels_) {
      const double share = fitter_.twin().outputs().ambient[c.output];
      if (share != 0.0)
        acts.push_back(alone(c.name, by_run([&](std::size_t r) -> Row { return share * course.at_row[r]; })));
    }
    return acts;
  };
  const scenarios::Start start = fitter_.twin().augmented().model.start;
  const bool starts_in_air = start == scenarios::Start::kAmbient || start == scenarios::Start::kSteady;
  for (std::size_t i = 0; i < courses_.size(); ++i) {
    if (i > 0 && i + 1 < courses_.size()) continue;  // no course of the drive: only constant and growing
    Statement s = of_ambient();
    s.follows = courses_[i].follows;
    s.law = courses_[i].law;
    add(s, with_instruments(courses_[i], starts_in_air && !courses_[i].rests));
  }
  add_cells(of_ambient(), with_instruments(courses_.front(), false));
}

void StatementBuilder::late_ambients() {
  const bool is_recorded = std::any_of(runs_.begin(), runs_.end(), [](const MeasuredRun& run) { return run.has_ambient; });
  for (double late_s : kClocks_s) {
    if (!is_recorded || std::abs(late_s) < kLeastLate_s) continue;
    Statement s = of_ambient();
    s.follows = "late";
    s.law = fmt::format("its record {}, by some {:g} min", late_s > 0.0 ? "late" : "early", std::abs(late_s) / 60.0);
    s.unit_size = late_s;
    s.unit = "s";
    add(s, exactly(ambient_effect("ambient", "late", late_s / 60.0), late_s));
  }
}

void StatementBuilder::stratification() {
  if (fitter_.twin().machine().mesh.n_nodes() == 0) return;
  Statement s = of_ambient();
  s.follows = "height";
  s.law = "warmer above than below";
  s.unit_size = 1.0;
  s.unit = "K/m";
  TwinState other = state_;
  const auto written =
      std::find_if(other.begin(), other.end(), [](const effects::Effect& e) { return e.kind->key == "stratification"; });
  if (written == other.end()) {
    other.push_back(ambient_effect("stratification", "gradient", 1.0));
  } else {  // about its present level
    written->set("gradient", (*written)["gradient"] + 1.0);
  }
  add(s, exactly(other, 1.0));
}

void StatementBuilder::speeds() {
  Statement speed{.quantity = StatedQuantity::kSpeed,
                  .place = {"spindle"},
                  .follows = "constant",
                  .law = "a factor",
                  .unit_size = kUsualLogarithm,
                  .unit = "1"};
  for (double factor : kSpeedFactors) {
    speed.law = factor > 1.0 ? "faster" : "slower";
    speed.law += fmt::format(", about {:g} times", factor);
    speed.unit_size = std::log(factor);
    add(speed, exactly(effects::make_effect("speed_override", effects::Place::kSpindle, "spindle", {{"factor", factor}}),
                       speed.unit_size));
  }
  speed.law = "another speed";
  speed.unit_size = 1.0;
  auto standing = std::make_shared<Loads>();
  for (const LinearOperator& m : machine_) standing->push_back(m.standing());
  add_heat_cells(speed, standing);
}

void StatementBuilder::clocks() {
  double longest_s = 0.0;
  for (const MeasuredRun& run : runs_) longest_s = std::max(longest_s, run.time_s.back());
  const auto late_by = [&](double late_s) {
    return exactly(effects::make_effect("clock_offset", effects::Place::kClock, "clock", {{"offset", late_s / 60.0}}),
                   late_s);
  };
  Statement clock{
      .quantity = StatedQuantity::kClock, .place = {"clock"}, .follows = "constant", .unit_size = kSet_s, .unit = "s"};
  for (double late_s : kClocks_s) {
    if (std::abs(late_s) > 0.2 * longest_s) continue;
    clock.law = fmt::format("{}, by some {:g} min", late_s > 0.0 ? "late" : "early", std::abs(late_s) / 60.0);
    clock.unit_size = late_s;
    add(clock, late_by(late_s));
  }
  clock.law = "late";
  clock.unit_size = kSet_s;
  add_cells(clock, late_by(kSet_s), true);
}

std::vector<Acting> StatementBuilder::exactly(const effects::Effect& effect, double size) const {
  TwinState with = state_;
  with.push_back(effect);
  return exactly(with, size);
}

std::vector<Acting> StatementBuilder::exactly(const TwinState& with, double size) const {
  const Twin& twin = fitter_.twin();
  Twin::Workspace workspace(twin);
  std::vector<Eigen::MatrixXd> difference;
  const bool is_solved = has_solution([&] {
    for (const MeasuredRun& run : runs_) {
      difference.push_back((twin.readings(with, run, workspace) - twin.readings(state_, run, workspace)) / size);
    }
  });
  if (!is_solved) return {};
  std::vector<Acting> acts;
  for (const Channel& c : channels_)
    acts.push_back(alone(c.name, by_run([&](std::size_t r) -> Row { return difference[r].row(c.output); })));
  return acts;
}

}  // namespace driftwright::diagnosis
