#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/no_solution.hpp"
#include "diagnosis/scene.hpp"
#include "diagnosis/statement.hpp"
#include "effects/reading_chain.hpp"
#include "effects/recorded_column.hpp"

namespace driftwright::diagnosis {
namespace {

using effects::Body;
using Row = Eigen::RowVectorXd;

constexpr Eigen::Index kCells = 48;  // of a record, of windows and unknown courses
constexpr double kAmbient_K = 2.0;   // typical size of an ambient that is wrong
constexpr double kLogarithm = 0.7;   // of a factor's logarithm
constexpr double kExponents[] = {0.5, 1.0, 1.5, 2.0, 3.0};
constexpr double kDriveLags_s[] = {0.0, 120.0, 600.0, 1800.0, 5400.0};
constexpr double kSpeedFactors[] = {0.5, 0.8, 0.95, 1.05, 1.25, 2.0};
constexpr double kClocks_s[] = {-3600.0, -1500.0, -720.0, -360.0, -180.0, -60.0,  -20.0,
                                20.0,    60.0,    180.0,  360.0,  720.0,  1500.0, 3600.0};
constexpr double kReadingLags_s[] = {30.0, 120.0, 360.0, 1200.0, 3600.0};
constexpr double kBodyLags_s[] = {0.0, 300.0, 1200.0, 3600.0, 14400.0};
constexpr double kBurst_s = 600.0;
constexpr Eigen::Index kMostRows = 4000;  // of all columns

/// Rows of a block of the comparison's condensed ones, `together` of them summed over the root of their number.
template <class In, class Out>
Eigen::Index gather(const In& rows, Eigen::Index together, Out&& out) {
  Eigen::Index k = 0;
  for (Eigen::Index from = 0; from < rows.rows(); from += together, ++k) {
    const Eigen::Index n = std::min(together, rows.rows() - from);
    out.row(k) = rows.middleRows(from, n).colwise().sum() / std::sqrt(static_cast<double>(n));
  }
  return k;
}

/// A course in time, of any quantity that takes one.
struct TimedCourse {
  std::string follows, law;
  std::vector<Row> at_row, in_interval;  ///< by run
  bool rests = false;                    ///< nothing while the machine has not been started
};

}  // namespace

class StatementBuilder {
 public:
  StatementBuilder(StatementSpace& space, const Fitter& fitter, const TwinState& state)
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
      first_block_.push_back(b);
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

  void build() {
    heats();
    all_alike();
    exchanges();
    conductivities();
    capacities();
    readings();
    rest();
  }

 private:
  struct Channel {
    std::string name, unit;
    double swing = 1.0;
    int output = -1;
  };
  using Loads = std::vector<LinearOperator::Load>;

  double swing(const std::string& name) const {
    double squares = 0.0, n = 0.0, sum = 0.0;
    for (const MeasuredRun& run : runs_) {
      const MeasuredChannel* c = run.find(name);
      if (!c) continue;
      for (double v : c->value) {
        if (std::isnan(v)) continue;
        squares += v * v;
        sum += v;
        n += 1.0;
      }
    }
    return n > 1.0 ? std::sqrt(std::max(1e-18, squares / n - sum * sum / n / n)) : 1.0;
  }

  /// Course of a function of the drive.
  TimedCourse of_drive(std::string follows, std::string law, const std::function<double(const Drive&)>& u) const {
    TimedCourse c{.follows = std::move(follows), .law = std::move(law), .at_row = {}, .in_interval = {}, .rests = true};
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      const auto& drive = machine_[r].drive();
      Row in(static_cast<Eigen::Index>(drive.size())), at(in.size() + 1);
      for (std::size_t k = 0; k < drive.size(); ++k) in[static_cast<Eigen::Index>(k)] = u(drive[k]);
      at << in, in[in.size() - 1];
      c.in_interval.push_back(in);
      c.at_row.push_back(at);
    }
    return c;
  }

  void make_courses() {
    TimedCourse c = of_drive("constant", "constant", [](const Drive&) { return 1.0; });
    c.rests = false;
    courses_.push_back(c);
    const double top = std::max(1.0, scene_.top_rpm);
    if (scene_.turns) {
      if (scene_.starts_and_stops)
        courses_.push_back(of_drive("running", "running", [](const Drive& d) { return d.speed_rpm > 0.0 ? 1.0 : 0.0; }));
      for (double p : kExponents)
        courses_.push_back(of_drive("power of speed", fmt::format("speed^{:g}", p),
                                    [top, p](const Drive& d) { return std::pow(d.speed_rpm / top, p); }));
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double feed = scene_.top_feed_m_s[axis];
      if (!(feed > 0.0)) continue;
      const char name = "xyz"[axis];
      for (double p : {1.0, 2.0})
        courses_.push_back(of_drive(fmt::format("power of feed_{}", name), fmt::format("feed_{}^{:g}", name, p),
                                    [axis, feed, p](const Drive& d) { return std::pow(d.feed_m_s[axis] / feed, p); }));
    }
    for (const auto& column : scene_.columns) {
      const std::string name = column.header.substr(0, column.header.rfind('_'));
      if (column.header == "cutting_power_W") {
        courses_.push_back(of_drive("power of cutting_power", "cutting_power^1",
                                    [&](const Drive& d) { return d.cutting_power_W / column.top; }));
        continue;
      }
      TimedCourse of{.follows = "power of " + name, .law = name + "^1", .at_row = {}, .in_interval = {}, .rests = false};
      for (const MeasuredRun& run : runs_) {
        const Cyclogram::Column* rows = run.cyclogram.column(column.header);
        const auto n = static_cast<Eigen::Index>(run.time_s.size());
        Row at = Row::Zero(n), in = Row::Zero(n - 1);
        for (Eigen::Index i = 0; rows && i < n; ++i) at[i] = value_at(rows->rows, run.time_s[static_cast<std::size_t>(i)]);
        at = (at.array() - (column.is_temperature() ? at[0] : 0.0)) / column.span;
        in = at.head(n - 1);
        of.at_row.push_back(at);
        of.in_interval.push_back(in);
      }
      courses_.push_back(of);
    }
    n_drives_ = courses_.size();
    if (scene_.starts_and_stops) {
      for (const bool on : {true, false}) {
        TimedCourse of{.follows = on ? "since start" : "since stop",
                       .law = fmt::format("{} s after it", kBurst_s),
                       .at_row = {},
                       .in_interval = {},
                       .rests = true};
        for (std::size_t r = 0; r < runs_.size(); ++r) {
          const auto& drive = machine_[r].drive();
          const auto& time_s = machine_[r].time_s();
          Row in = Row::Zero(static_cast<Eigen::Index>(drive.size()));
          double since = -1.0;
          bool was = on ? false : drive.front().speed_rpm > 0.0;
          for (std::size_t k = 0; k < drive.size(); ++k) {
            const bool turns = drive[k].speed_rpm > 0.0;
            if (turns != was) since = turns == on ? time_s[k] : -1.0;
            was = turns;
            if (since >= 0.0) in[static_cast<Eigen::Index>(k)] = std::exp(-(time_s[k] - since) / kBurst_s);
          }
          Row at(in.size() + 1);
          at << in, in[in.size() - 1];
          of.in_interval.push_back(in);
          of.at_row.push_back(at);
        }
        courses_.push_back(of);
      }
    }
    TimedCourse ramp{.follows = "ramp", .law = "growing with time", .at_row = {}, .in_interval = {}, .rests = true};
    double longest = 0.0;
    for (const MeasuredRun& run : runs_) longest = std::max(longest, run.time_s.back());
    for (const MeasuredRun& run : runs_) {
      Row at = Eigen::Map<const Row>(run.time_s.data(), static_cast<Eigen::Index>(run.time_s.size())) / longest;
      ramp.in_interval.push_back(at.head(at.size() - 1));
      ramp.at_row.push_back(at);
    }
    courses_.push_back(ramp);
  }

  static double value_at(const TimeSeries& series, double t_s) {
    const auto next = std::upper_bound(series.time_s.begin(), series.time_s.end(), t_s + 1e-6);
    return next == series.time_s.begin() ? series.value.front()
                                         : series.value[static_cast<std::size_t>(next - series.time_s.begin() - 1)];
  }

  Eigen::VectorXd condensed(std::size_t run, const Eigen::MatrixXd& readings) const {
    const Comparison& comparison = fitter_.comparison();
    Eigen::VectorXd whitened(comparison.n_of(run));
    comparison.whiten(run, readings, whitened);
    const Eigen::VectorXd all = comparison.condensed(run, whitened);
    if (space_.together == 1) return all;
    Eigen::VectorXd few(space_.rows[run].n);
    const Eigen::Index from = comparison.condensed_rows(run).first;
    for (std::size_t c = 0, at = 0; c < runs_[run].channels.size(); ++c) {
      const auto [first, n] = comparison.condensed_block(first_block_[run] + c);
      const auto end = few.size() - static_cast<Eigen::Index>(at);
      at += static_cast<std::size_t>(gather(all.segment(first - from, n), space_.together, few.tail(end)));
    }
    return few;
  }

  void add(Statement says, std::vector<Acting> acts) {
    const std::size_t index = space_.columns.size();
    space_.columns.push_back({.says = std::move(says), .acts = std::move(acts), .of_run = {}});
    Chosen unit{
        .is_cells = false, .index = index, .amount = std::vector<Eigen::VectorXd>(runs_.size(), Eigen::VectorXd::Ones(1))};
    const auto of = space_.readings({unit});
    double squares = 0.0;
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      space_.columns.back().of_run.push_back(condensed(r, of[r]));
      squares += space_.columns.back().of_run.back().squaredNorm();
    }
    if (!(squares > 1e-12) || !std::isfinite(squares)) space_.columns.pop_back();
  }

  Acting respond(const std::shared_ptr<const Loads>& loads, const TimedCourse& course) const {
    return {.loads = loads, .channel = {}, .course = course.in_interval, .always = settled_ && !course.rests};
  }
  /// A channel alone. @param course  of the rows by run
  static Acting alone(const std::string& channel, const std::vector<Row>& course) {
    return {.loads = nullptr, .channel = channel, .course = course, .always = false};
  }

  std::vector<Eigen::Index> edges(std::size_t r) const {
    const Eigen::Index n = machine_[r].n_rows() - 1, cells = std::min(n, kCells);
    std::vector<Eigen::Index> list;
    for (Eigen::Index c = 0; c <= cells; ++c) list.push_back(c * n / cells);
    return list;
  }

  void add_cells(Statement says, std::vector<Acting> acts) {
    const std::size_t index = space_.cells.size();
    space_.cells.push_back({.says = std::move(says), .acts = std::move(acts), .runs = {}});
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
        cells.runs[r].of_cell.col(c) = condensed(r, space_.readings({unit})[r]);
      }
      if (cells.runs[r].of_cell.allFinite()) continue;
      space_.cells.pop_back();
      return;
    }
  }
  void add_heat_cells(const Statement& says, const std::shared_ptr<const Loads>& loads) {
    std::vector<Row> ones;
    for (const LinearOperator& m : machine_) ones.push_back(Row::Ones(m.n_rows() - 1));
    add_cells(says, {{.loads = loads, .channel = {}, .course = ones, .always = false}});
  }

  void heats() {
    const double size_W = scene_.unknown_heat_W();
    std::vector<Body> places = scene_.bodies;
    for (const std::string& s : scene_.surfaces) places.push_back(effects::surface(s));
    for (const Body& body : places) {
      if (body == effects::ambient_node()) continue;
      auto loads = std::make_shared<Loads>();
      for (const LinearOperator& m : machine_) loads->push_back(m.heat(body));
      if (loads->front().size() == 0) continue;
      const Statement says{.quantity = StatedQuantity::kHeat,
                           .place = {body.name},
                           .follows = {},
                           .law = {},
                           .in_run = {},
                           .unit_size = size_W,
                           .unit = "W"};
      for (const TimedCourse& course : courses_) {
        Statement s = says;
        s.follows = course.follows;
        s.law = course.law;
        add(s, {respond(loads, course)});
      }
      own_laws(body, says, loads);
      add_heat_cells(says, loads);
    }
  }

  /// All own heat, and all exchange with the ambient: states of running.
  void all_alike() {
    auto heat = std::make_shared<Loads>(), air = std::make_shared<Loads>();
    for (const LinearOperator& m : machine_) {
      heat->push_back(m.all_heat());
      air->push_back(m.all_loss());
    }
    add({.quantity = StatedQuantity::kHeat,
         .place = {"all"},
         .follows = "own heat",
         .law = "factor on all heat",
         .in_run = {},
         .unit_size = kLogarithm,
         .unit = "1"},
        {respond(heat, courses_.front())});
    add({.quantity = StatedQuantity::kExchange,
         .place = {"all"},
         .follows = "constant",
         .law = "factor on all loss to the ambient",
         .in_run = {},
         .unit_size = kLogarithm,
         .unit = "1"},
        {respond(air, courses_.front())});
  }

  /// Another size, exponent or growth with temperature of the heat that a body has.
  void own_laws(const Body& body, const Statement& says, const std::shared_ptr<const Loads>& loads) {
    std::vector<Row> own;
    double largest = 0.0;
    for (const LinearOperator& m : machine_) {
      own.push_back(m.own_heat(body));
      largest = std::max(largest, own.back().cwiseAbs().maxCoeff());
    }
    if (!(largest > 0.0)) return;
    const auto take = [&](const std::string& follows, const std::string& law, const auto& of) {
      TimedCourse c{.follows = follows, .law = law, .at_row = {}, .in_interval = {}, .rests = false};
      for (std::size_t r = 0; r < runs_.size(); ++r) c.in_interval.push_back(of(r).cwiseProduct(own[r]) / largest);
      Statement s = says;
      s.follows = c.follows;
      s.law = c.law;
      s.unit_size = largest;
      add(s, {respond(loads, c)});
    };
    take("own heat", "factor on its heat", [&](std::size_t r) -> Row { return Row::Ones(own[r].size()); });
    const double typical = std::max(1.0, scene_.typical_rpm);
    if (scene_.turns)
      take("own heat, exponent", "exponent of its heat", [&](std::size_t r) -> Row {
        Row log(own[r].size());
        for (Eigen::Index k = 0; k < log.size(); ++k) {
          const double rpm = machine_[r].drive()[static_cast<std::size_t>(k)].speed_rpm;
          log[k] = rpm > 0.0 ? std::log(rpm / typical) : 0.0;
        }
        return log;
      });
    take("temperature of " + body.name, "growth of its heat with its temperature", [&](std::size_t r) -> Row {
      const Row t = machine_[r].temperature(body);
      if (t.size() == 0) return Row::Zero(own[r].size());
      return 0.1 * (t.head(t.size() - 1).array() - t[0]);  // a tenth for each K
    });
  }

  void exchanges() {
    const auto courses_at = [&](const Statement& says, const std::shared_ptr<const Loads>& loads) {
      for (std::size_t i = 0; i < n_drives_; ++i) {
        Statement s = says;
        s.follows = courses_[i].follows;
        s.law = courses_[i].law;
        add(s, {respond(loads, courses_[i])});
      }
      Statement s = says;
      s.follows = courses_.back().follows;
      s.law = courses_.back().law;
      add(s, {respond(loads, courses_.back())});
    };
    const double typical = scene_.typical_conductance_W_K();
    std::vector<Body> bodies;
    for (const Body& b : scene_.bodies) {
      if (!(b == effects::ambient_node())) bodies.push_back(b);
    }
    const auto own = [&](const Body& a, const std::string& b) {
      const auto& system = fitter_.twin().machine().system;
      double sum = 0.0;
      for (std::size_t e = 0; e < system.exchanges.size(); ++e) {
        const auto& place = system.exchanges[e].place;
        if (place.per == effects::Per::kTotal &&
            ((place.body == a && place.surrounding == b) || (place.body.name == b && place.surrounding == a.name)))
          sum += machine_.front().coefficient(e);
      }
      return sum;
    };
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      for (std::size_t j = i + 1; j <= bodies.size(); ++j) {
        const Body other = j < bodies.size() ? bodies[j] : effects::ambient_node();
        const bool solid = bodies[i].kind == effects::BodyKind::kRegion && other.kind == effects::BodyKind::kRegion;
        if (solid) continue;                                                                             // joints say that
        if (other == effects::ambient_node() && bodies[i].kind == effects::BodyKind::kRegion) continue;  // and surfaces that
        auto loads = std::make_shared<Loads>();
        for (const LinearOperator& m : machine_) loads->push_back(m.conductance(bodies[i], other));
        if (loads->front().size() == 0) continue;
        const double is = own(bodies[i], other.name);
        const Statement says{.quantity = StatedQuantity::kExchange,
                             .place = {bodies[i].name, other.name},
                             .follows = {},
                             .law = {},
                             .in_run = {},
                             .unit_size = is > 0.0 ? is : typical,
                             .unit = "W/K"};
        courses_at(says, loads);
        if (is > 0.0 || j == bodies.size() || bodies.size() < 12) add_heat_cells(says, loads);
      }
    }
    const auto& system = fitter_.twin().machine().system;
    for (std::size_t e = 0; e < system.exchanges.size(); ++e) {
      const auto& place = system.exchanges[e].place;
      const bool of_bodies =
          place.per == effects::Per::kTotal && (place.body.kind == effects::BodyKind::kNode || !place.surrounding.empty());
      if (of_bodies) continue;
      auto loads = std::make_shared<Loads>();
      double squares = 0.0;
      for (const LinearOperator& m : machine_) {
        loads->push_back(m.exchange(e));
        squares += loads->back().squaredNorm();
      }
      if (!(squares > 0.0)) continue;
      const double is = std::abs(machine_.front().coefficient(e));
      std::vector<std::string> where = {place.body.name};
      if (!place.surrounding.empty()) where.push_back(place.surrounding);
      const Statement says{.quantity = StatedQuantity::kExchange,
                           .place = where,
                           .follows = {},
                           .law = {},
                           .in_run = {},
                           .unit_size = is > 0.0                           ? is
                                        : place.per == effects::Per::kArea ? 10.0
                                                                           : typical,
                           .unit = place.per == effects::Per::kArea ? "W/(m^2 K)" : "W/K"};
      courses_at(says, loads);
      add_heat_cells(says, loads);
    }
  }

  void conductivities() {
    const auto& parts = fitter_.twin().machine().system.parts;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      if (!(parts[p].conduction.cwiseAbs().maxCoeff() > 0.0)) continue;
      auto loads = std::make_shared<Loads>();
      for (const LinearOperator& m : machine_) loads->push_back(m.conduction(p));
      add({.quantity = StatedQuantity::kExchange,
           .place = {parts[p].body},
           .follows = "constant",
           .law = "its conductivity",
           .in_run = {},
           .unit_size = kLogarithm,
           .unit = "1"},
          {respond(loads, courses_.front())});
    }
  }

  void capacities() {
    for (const auto& material : scene_.materials) {
      if (!material.stores || !(material.capacity_J_K > 0.0)) continue;
      for (double lag_s : kBodyLags_s) {
        auto loads = std::make_shared<Loads>();
        for (const LinearOperator& m : machine_) loads->push_back(m.capacity(material.body, lag_s));
        if (loads->front().size() == 0) break;
        Statement says{.quantity = StatedQuantity::kCapacity,
                       .place = {material.body.name},
                       .follows = lag_s > 0.0 ? "lagged" : "constant",
                       .law = lag_s > 0.0 ? fmt::format("a body {:g} min behind", lag_s / 60.0) : "its own",
                       .in_run = {},
                       .unit_size = material.capacity_J_K,
                       .unit = "J/K"};
        add(says, {respond(loads, courses_.front())});
      }
    }
  }

  Row predicted(std::size_t r, const std::string& name) const {
    for (std::size_t c = 0; c < runs_[r].channels.size(); ++c) {
      if (runs_[r].channels[c].name == name) return machine_[r].predicted().row(static_cast<Eigen::Index>(c));
    }
    return {};
  }

  template <class Of>
  std::vector<Row> by_run(Of of) const {
    std::vector<Row> rows;
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      Row row = of(r);
      rows.push_back(row.size() > 0 ? row : Row(Row::Zero(machine_[r].n_rows())));
    }
    return rows;
  }

  void readings() {
    for (const Channel& c : channels_) {
      const bool is_sensor = c.unit == "K";
      const StatedQuantity q = is_sensor ? StatedQuantity::kReading : StatedQuantity::kDisplacement;
      const Statement says{
          .quantity = q, .place = {c.name}, .follows = {}, .law = {}, .in_run = {}, .unit_size = c.swing, .unit = c.unit};
      const auto say = [&](const std::string& follows, const std::string& law, double size, const std::string& unit,
                           const std::vector<Row>& course) {
        Statement s = says;
        s.follows = follows;
        s.law = law;
        s.unit_size = size;
        s.unit = unit;
        add(s, {alone(c.name, course)});
      };
      for (std::size_t i = 0; i < courses_.size(); ++i) {
        const TimedCourse& course = courses_[i];
        const bool drives = i > 0 && i < n_drives_;
        for (double lag_s : kDriveLags_s) {
          if (lag_s > 0.0 && !drives) break;
          say(course.follows, lag_s > 0.0 ? fmt::format("{}, {:g} min behind", course.law, lag_s / 60) : course.law, c.swing,
              c.unit, by_run([&](std::size_t r) -> Row {
                Row row = course.at_row[r];
                if (lag_s > 0.0) {
                  row[0] = 0.0;
                  effects::lag_behind(row, machine_[r].time_s(), lag_s);
                }
                return row;
              }));
        }
      }
      const auto own = by_run([&](std::size_t r) { return predicted(r, c.name); });
      for (double lag_s : kReadingLags_s)
        say("itself before", fmt::format("a lag of {:g} min", lag_s / 60), 1.0, "1", by_run([&](std::size_t r) -> Row {
              Row late = own[r];
              if (late.size() == 0) return late;
              late.array() -= own[r][0];
              effects::lag_behind(late, machine_[r].time_s(), lag_s);
              return late.array() + own[r][0] - own[r].array();
            }));
      say("itself", "a gain", 1.0, "1",
          by_run([&](std::size_t r) -> Row { return is_sensor ? Row(own[r].array() - own[r][0]) : own[r]; }));
      std::vector<Row> air;
      if (is_sensor) {
        air =
            by_run([&](std::size_t r) -> Row { return own[r].size() == 0 ? Row() : Row(machine_[r].ambient_K() - own[r]); });
        say("difference to ambient", "a share of the ambient", 1.0, "1", air);
        Statement share = says;
        share.unit_size = 1.0;
        share.unit = "1";
        share.law = "difference to ambient";
        add_cells(share, {alone(c.name, air)});
      }
      for (const Body& body : scene_.bodies) {
        if (body == effects::ambient_node()) continue;
        const auto warm = by_run([&](std::size_t r) { return machine_[r].temperature(body); });
        if (is_sensor) {
          say("difference to " + body.name, "a share of " + body.name, 1.0, "1",
              by_run([&](std::size_t r) -> Row { return warm[r] - own[r]; }));
        } else {
          double rms = 0.0;
          for (const Row& w : warm) rms = std::max(rms, (w.array() - w[0]).abs().maxCoeff());
          if (!(rms > 1e-9)) continue;
          for (double lag_s : {0.0, 600.0, 2400.0}) {
            say("temperature of " + body.name, lag_s > 0.0 ? fmt::format("{:g} min behind", lag_s / 60) : "at once",
                c.swing / rms, c.unit + "/K", by_run([&](std::size_t r) -> Row {
                  Row w = warm[r].array() - warm[r][0];
                  if (lag_s > 0.0) effects::lag_behind(w, machine_[r].time_s(), lag_s);
                  return w;
                }));
          }
        }
      }
      if (!is_sensor) {
        const auto air_of =
            by_run([&](std::size_t r) -> Row { return machine_[r].ambient_K().array() - machine_[r].ambient_K()[0]; });
        double rms = 0.0;
        for (const Row& w : air_of) rms = std::max(rms, w.cwiseAbs().maxCoeff());
        if (rms > 1e-9) say("temperature of ambient", "at once", c.swing / rms, c.unit + "/K", air_of);
      }
      add_cells(says, {alone(c.name, by_run([&](std::size_t r) -> Row { return Row::Ones(machine_[r].n_rows()); }))});
    }
    for (std::size_t i = 0; i < channels_.size(); ++i) {
      for (std::size_t j = i + 1; j < channels_.size(); ++j) {
        if (channels_[i].unit != channels_[j].unit) continue;
        const auto difference = by_run([&](std::size_t r) -> Row {
          const Row a = predicted(r, channels_[i].name), b = predicted(r, channels_[j].name);
          return a.size() > 0 && b.size() > 0 ? Row(b - a) : Row();
        });
        std::vector<Row> other = difference;
        for (Row& row : other) row = -row;
        add({.quantity = channels_[i].unit == "K" ? StatedQuantity::kReading : StatedQuantity::kDisplacement,
             .place = {channels_[i].name, channels_[j].name},
             .follows = "exchanged",
             .law = "exchanged",
             .in_run = {},
             .unit_size = 1.0,
             .unit = "1"},
            {alone(channels_[i].name, difference), alone(channels_[j].name, other)});
      }
    }
    const auto& parts = fitter_.twin().machine().system.parts;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      std::vector<Acting> acts;
      for (const Channel& c : channels_) {
        const auto of = by_run([&](std::size_t r) -> Row {
          const Eigen::MatrixXd all = machine_[r].expansion(p);
          for (std::size_t i = 0; i < runs_[r].channels.size(); ++i) {
            if (runs_[r].channels[i].name == c.name) return all.row(static_cast<Eigen::Index>(i));
          }
          return {};
        });
        if (std::any_of(of.begin(), of.end(), [](const Row& row) { return row.squaredNorm() > 0.0; }))
          acts.push_back(alone(c.name, of));
      }
      if (acts.empty()) continue;
      add({.quantity = StatedQuantity::kDisplacement,
           .place = {parts[p].body},
           .follows = "expansion",
           .law = "its expansion",
           .in_run = {},
           .unit_size = kLogarithm,
           .unit = "1"},
          acts);
    }
  }

  void rest() {
    auto air = std::make_shared<Loads>(), standing = std::make_shared<Loads>();
    for (const LinearOperator& m : machine_) {
      air->push_back(m.ambient());
      standing->push_back(m.standing());
    }
    const Statement ambient{.quantity = StatedQuantity::kAmbient,
                            .place = {"hall"},
                            .follows = {},
                            .law = {},
                            .in_run = {},
                            .unit_size = kAmbient_K,
                            .unit = "K"};
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
      if (i > 0 && i + 1 < courses_.size()) continue;  // constant, growing: no ambient knows of a drive
      Statement s = ambient;
      s.follows = courses_[i].follows;
      s.law = courses_[i].law;
      add(s, with_instruments(courses_[i], starts_in_air && !courses_[i].rests));
    }
    add_cells(ambient, with_instruments(courses_.front(), false));
    if (scene_.turns) {
      Statement speed{.quantity = StatedQuantity::kSpeed,
                      .place = {"spindle"},
                      .follows = "constant",
                      .law = "a factor",
                      .in_run = {},
                      .unit_size = kLogarithm,
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
      add_heat_cells(speed, standing);
    }
    double longest_s = 0.0;
    for (const MeasuredRun& run : runs_) longest_s = std::max(longest_s, run.time_s.back());
    for (double late_s : kClocks_s) {
      if (std::abs(late_s) > 0.2 * longest_s) continue;
      add({.quantity = StatedQuantity::kClock,
           .place = {"clock"},
           .follows = "constant",
           .law = fmt::format("{}, by some {:g} min", late_s > 0.0 ? "late" : "early", std::abs(late_s) / 60.0),
           .in_run = {},
           .unit_size = late_s,
           .unit = "s"},
          exactly(effects::make_effect("clock_offset", effects::Place::kClock, "clock", {{"offset", late_s / 60.0}}),
                  late_s));
    }
  }

  /// What an effect does to all channels, by the twin itself. @param size  that it has: columns are of one of that
  std::vector<Acting> exactly(const effects::Effect& effect, double size) const {
    const Twin& twin = fitter_.twin();
    Twin::Workspace workspace(twin);
    TwinState with = state_;
    with.push_back(effect);
    std::vector<Eigen::MatrixXd> difference;
    const bool is_solved = has_solution([&] {
      for (const MeasuredRun& run : runs_) {
        difference.push_back((twin.read(with, run, twin.respond(with, run, workspace)) -
                              twin.read(state_, run, twin.respond(state_, run, workspace))) /
                             size);
      }
    });
    if (!is_solved) return {};
    std::vector<Acting> acts;
    for (const Channel& c : channels_)
      acts.push_back(alone(c.name, by_run([&](std::size_t r) -> Row { return difference[r].row(c.output); })));
    return acts;
  }

  StatementSpace& space_;
  std::vector<LinearOperator>& machine_;
  const Fitter& fitter_;
  const std::vector<MeasuredRun>& runs_;
  effects::DoubtScene scene_;
  TwinState state_;
  std::vector<Channel> channels_;
  std::vector<TimedCourse> courses_;
  std::size_t n_drives_ = 0;  ///< of the courses, the constant among them
  bool settled_ = false;
  std::vector<std::size_t> first_block_;  ///< of each run
};

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

StatementSpace::StatementSpace(const Fitter& fitter, const TwinState& state) {
  StatementBuilder(*this, fitter, state).build();
}

Eigen::RowVectorXd StatementSpace::course_of(const Chosen& chosen, const Acting& acting, std::size_t run) const {
  const Eigen::VectorXd& amount = chosen.amount[run];
  if (!chosen.is_cells) return amount[0] * acting.course[run];
  Eigen::RowVectorXd course = Eigen::RowVectorXd::Zero(acting.course[run].size());
  const auto& edge = cells[chosen.index].runs[run].edge;
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
