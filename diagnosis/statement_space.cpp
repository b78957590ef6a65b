#include <algorithm>
#include <cmath>

#include "diagnosis/statement_builder.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr Eigen::Index kCells = 48;       // per record, for windows and unknown courses
constexpr Eigen::Index kMostRows = 4000;  // of all columns

}  // namespace

StatementBuilder::StatementBuilder(StatementSpace& space, const Fitter& fitter, const TwinState& state)
    : space_(space),
      machine_(space.machine_),
      fitter_(fitter),
      runs_(fitter.runs()),
      scene_(scene_of(fitter.twin(), fitter.runs())),
      state_(state) {
  Twin::Workspace workspace(fitter.twin());
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    machine_.emplace_back(fitter.twin(), runs_[r], state, workspace);
    space_.record.push_back(runs_[r].name);
    space_.channels_.emplace_back();
    for (const MeasuredChannel& c : runs_[r].channels) space_.channels_.back().push_back(c.name);
  }
  const Comparison& comparison = fitter.comparison();
  space_.together = std::max<Eigen::Index>(1, (comparison.n_condensed() + kMostRows - 1) / kMostRows);
  Eigen::Index at = 0;
  for (std::size_t r = 0, b = 0; r < runs_.size(); ++r) {
    space_.first_block_.push_back(b);
    const Eigen::Index first = at;
    for (std::size_t c = 0; c < runs_[r].channels.size(); ++c, ++b)
      at += (comparison.condensed_block(b).second + space_.together - 1) / space_.together;
    space_.rows.push_back({first, at - first});
  }
  settled_ = fitter.twin().augmented().model.start == scenarios::Start::kSteady;
  for (const MeasuredRun& run : runs_) {
    for (const MeasuredChannel& c : run.channels) {
      if (std::none_of(channels_.begin(), channels_.end(), [&](const auto& x) { return x.name == c.name; }))
        channels_.push_back({c.name, c.unit, swing(c.name), c.output});
    }
  }
  make_courses();
}

void StatementBuilder::build() {
  heats();
  all_alike();
  exchanges();
  conductivities();
  capacities();
  numbers_at_positions();
  readings();
  exchanged_channels();
  expansions();
  instruments_in_common();
  surroundings();
}

std::vector<Eigen::Index> StatementBuilder::edges(std::size_t r) const {
  const Eigen::Index n = machine_[r].n_rows() - 1, cells = std::min(n, kCells);
  std::vector<Eigen::Index> list;
  for (Eigen::Index c = 0; c <= cells; ++c) list.push_back(c * n / cells);
  return list;
}

void StatementBuilder::add(Statement says, std::vector<Acting> acts) {
  const std::size_t index = space_.columns.size();
  space_.columns.push_back({.says = std::move(says), .acts = std::move(acts), .of_run = {}});
  Chosen unit{
      .is_cells = false, .index = index, .amount = std::vector<Eigen::VectorXd>(runs_.size(), Eigen::VectorXd::Ones(1))};
  const auto of = space_.readings({unit});
  double squares = 0.0;
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    space_.columns.back().of_run.push_back(space_.condensed(r, of[r]));
    squares += space_.columns.back().of_run.back().squaredNorm();
  }
  if (!(squares > 1e-12) || !std::isfinite(squares)) space_.columns.pop_back();
}

void StatementBuilder::add_cells(Statement says, std::vector<Acting> acts, bool lasts) {
  const std::size_t index = space_.cells.size();
  if (!says.at.empty() && says.law.empty()) says.law = "at " + says.at;
  space_.cells.push_back({.says = std::move(says), .acts = std::move(acts), .runs = {}, .lasts = lasts});
  StatementCells& cells = space_.cells.back();
  for (Acting& a : cells.acts) a.always = false;
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    StatementCells::Run run{.edge = edges(r), .edge_s = {}, .of_cell = {}};
    for (Eigen::Index e : run.edge) run.edge_s.push_back(machine_[r].time_s()[static_cast<std::size_t>(e)]);
    cells.runs.push_back(std::move(run));
  }
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    const auto n = static_cast<Eigen::Index>(cells.runs[r].edge.size()) - 1;
    cells.runs[r].of_cell.resize(space_.rows[r].n, n);
    for (Eigen::Index c = 0; c < n; ++c) {
      Chosen unit{.is_cells = true, .index = index, .amount = std::vector<Eigen::VectorXd>(runs_.size())};
      unit.amount[r] = Eigen::VectorXd::Unit(n, c);
      cells.runs[r].of_cell.col(c) = space_.condensed(r, space_.readings({unit})[r]);
    }
    if (cells.runs[r].of_cell.allFinite()) continue;
    space_.cells.pop_back();
    return;
  }
}

void StatementBuilder::add_heat_cells(const Statement& says, const std::shared_ptr<const Loads>& loads) {
  std::vector<Row> ones;
  for (const LinearOperator& m : machine_) ones.push_back(Row::Ones(m.n_rows() - 1));
  add_cells(says, {{.loads = loads, .channel = {}, .course = ones, .always = false}});
}

Acting StatementBuilder::respond(const std::shared_ptr<const Loads>& loads, const TimedCourse& course) const {
  return {.loads = loads, .channel = {}, .course = course.in_interval, .always = settled_ && !course.rests};
}

Acting StatementBuilder::alone(const std::string& channel, const std::vector<Row>& course) {
  return {.loads = nullptr, .channel = channel, .course = course, .always = false};
}

const char* word(StatedQuantity quantity) {
  switch (quantity) {
    case StatedQuantity::kHeat:
      return "heat";
    case StatedQuantity::kExchange:
      return "exchange";
    case StatedQuantity::kCapacity:
      return "capacity";
    case StatedQuantity::kReading:
      return "reading";
    case StatedQuantity::kDisplacement:
      return "displacement";
    case StatedQuantity::kAmbient:
      return "ambient";
    case StatedQuantity::kSpeed:
      return "speed";
    case StatedQuantity::kClock:
      return "clock";
  }
  return "";
}

Eigen::MatrixXd StatementSpace::condense(const Comparison& comparison, const Eigen::MatrixXd& whitened) const {
  const Eigen::MatrixXd all = comparison.condensed(whitened);
  if (together == 1) return all;
  Eigen::MatrixXd few(rows.back().first + rows.back().n, all.cols());
  Eigen::Index at = 0;
  for (std::size_t b = 0; b < comparison.blocks().size(); ++b) {
    const auto [first, n] = comparison.condensed_block(b);
    at += gather(all.middleRows(first, n), together, few.bottomRows(few.rows() - at));
  }
  return few;
}

Eigen::VectorXd StatementSpace::condensed(std::size_t run, const Eigen::MatrixXd& readings) const {
  Eigen::VectorXd whitened(comparison_.n_of(run));
  comparison_.whiten(run, readings, whitened);
  const Eigen::VectorXd all = comparison_.condensed(run, whitened);
  if (together == 1) return all;
  Eigen::VectorXd few(rows[run].n);
  const Eigen::Index from = comparison_.condensed_rows(run).first;
  for (Eigen::Index c = 0, at = 0; c < readings.rows(); ++c) {
    const auto [first, n] = comparison_.condensed_block(first_block_[run] + static_cast<std::size_t>(c));
    at += gather(all.segment(first - from, n), together, few.tail(few.size() - at));
  }
  return few;
}

StatementSpace::StatementSpace(const Fitter& fitter, const TwinState& state) : comparison_(fitter.comparison()) {
  StatementBuilder(*this, fitter, state).build();
}

Eigen::RowVectorXd StatementSpace::course_of(const Chosen& chosen, const Acting& acting, std::size_t run) const {
  const Eigen::VectorXd& amount = chosen.amount[run];
  if (!chosen.is_cells) return amount[0] * acting.course[run];
  Eigen::RowVectorXd course = Eigen::RowVectorXd::Zero(acting.course[run].size());
  const auto& edge = cells[chosen.index].runs[run].edge;
  if (chosen.rows && chosen.rows->run == run) {
    const auto& [of, first, end] = *chosen.rows;
    const double size = amount.maxCoeff() + amount.minCoeff();  // one value within the window, zero elsewhere
    course.segment(first, end - first) = size * acting.course[run].segment(first, end - first);
    return course;
  }
  for (Eigen::Index c = 0; c < amount.size(); ++c) {
    if (amount[c] == 0.0) continue;
    const Eigen::Index from = edge[static_cast<std::size_t>(c)];
    Eigen::Index to = edge[static_cast<std::size_t>(c + 1)];
    if (!acting.loads && c + 1 == amount.size()) to = course.size();
    course.segment(from, to - from) = amount[c] * acting.course[run].segment(from, to - from);
  }
  return course;
}

std::vector<Eigen::MatrixXd> StatementSpace::readings(const std::vector<Chosen>& chosen) const {
  std::vector<Eigen::MatrixXd> all;
  for (std::size_t r = 0; r < machine_.size(); ++r) {
    Eigen::MatrixXd& y =
        all.emplace_back(Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(channels_[r].size()), machine_[r].n_rows()));
    for (const Chosen& c : chosen) {
      if (c.amount[r].size() == 0) continue;
      const auto& acts = c.is_cells ? cells[c.index].acts : columns[c.index].acts;
      const double unit = (c.is_cells ? cells[c.index].says : columns[c.index].says).unit_size;
      for (const Acting& a : acts) {
        const Eigen::RowVectorXd course = unit * course_of(c, a, r);
        if (a.loads) {
          y += machine_[r].response((*a.loads)[r], course, a.always ? course[0] : 0.0);
          continue;
        }
        for (std::size_t i = 0; i < channels_[r].size(); ++i) {
          if (channels_[r][i] == a.channel) y.row(static_cast<Eigen::Index>(i)) += course;
        }
      }
    }
  }
  return all;
}

}  // namespace driftwright::diagnosis
