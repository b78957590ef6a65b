#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/statement_builder.hpp"
#include "effects/reading_chain.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kRunBefore_s[] = {600.0, 2400.0, 9600.0};
constexpr double kBetween_s[] = {0.0, 600.0, 2400.0};
constexpr double kGuard_s = 600.0;  // time constant of enclosed air, if it follows slowly
constexpr double kBodyLags_s[] = {0.0, 300.0, 1200.0, 3600.0, 14400.0};

/// Whether one effect of the scenario makes both nodes, as the sections of a screw: they exchange heat where it says so.
bool are_of_one_effect(const std::vector<effects::HeatBalance>& alone, const effects::Body& a, const effects::Body& b) {
  return std::any_of(alone.begin(), alone.end(), [&](const effects::HeatBalance& of) {
    const auto has = [&](const effects::Body& body) {
      return std::any_of(of.nodes.begin(), of.nodes.end(), [&](const auto& n) { return effects::node(n.name) == body; });
    };
    return has(a) && has(b);
  });
}

/// A law, with the surface or joint that it belongs to.
std::string law_at(const Statement& s, const std::string& law) {
  return s.at.empty() ? law : law.empty() ? "at " + s.at : law + ", at " + s.at;
}

}  // namespace

void StatementBuilder::heats() {
  const double size_W = scene_.unknown_heat_W();
  std::vector<Body> places = scene_.bodies;
  for (const std::string& s : scene_.surfaces) places.push_back(effects::surface(s));
  for (const Body& body : places) {
    if (body == effects::ambient_node()) continue;
    auto loads = std::make_shared<Loads>();
    for (const LinearOperator& m : machine_) loads->push_back(m.heat(body));
    if (loads->front().size() == 0) continue;
    const Statement says{.quantity = StatedQuantity::kHeat,
                         .place = body.kind == effects::BodyKind::kSurface ? fitter_.twin().bodies_at(body.name)
                                                                           : std::vector<std::string>{body.name},
                         .at = body.kind == effects::BodyKind::kSurface ? body.name : "",
                         .unit_size = size_W,
                         .unit = "W"};
    for (const TimedCourse& course : courses_) {
      Statement s = says;
      s.follows = course.follows;
      s.law = law_at(s, course.law);
      add(s, {respond(loads, course)});
    }
    own_laws(body, says, loads);
    add_heat_cells(says, loads);
  }
}

void StatementBuilder::all_alike() {
  const auto say = [&](StatedQuantity quantity, const char* follows, std::string law, double size, const char* unit,
                       std::vector<Acting> acts) {
    add({.quantity = quantity, .place = {"all"}, .follows = follows, .law = std::move(law), .unit_size = size, .unit = unit},
        std::move(acts));
  };
  auto heat = std::make_shared<Loads>(), air = std::make_shared<Loads>();
  for (const LinearOperator& m : machine_) {
    heat->push_back(m.all_heat());
    air->push_back(m.all_loss());
  }
  say(StatedQuantity::kHeat, "own heat", "factor on all heat", kUsualLogarithm, "1", {respond(heat, courses_.front())});
  say(StatedQuantity::kExchange, "constant", "factor on all loss to the ambient", kUsualLogarithm, "1",
      {respond(air, courses_.front())});
  for (double run_s : kRunBefore_s) {
    if (!scene_.turns) break;
    const effects::Effect before = effects::make_effect(
        "run_state", effects::Place::kSpindle, effects::place_key(effects::Place::kSpindle), {{"warmed_up", run_s / 60.0}});
    say(StatedQuantity::kHeat, "before the record",
        fmt::format("as after {:g} min of its mean drive before the record", run_s / 60.0), run_s, "s",
        exactly(before, run_s));
  }
}

void StatementBuilder::own_laws(const Body& body, const Statement& says, const std::shared_ptr<const Loads>& loads) {
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
    s.law = law_at(s, c.law);
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
    return 0.1 * (t.head(t.size() - 1).array() - t[0]);  // a tenth per K
  });
}

void StatementBuilder::exchanges() {
  const auto courses_at = [&](const Statement& says, const std::shared_ptr<const Loads>& loads) {
    for (std::size_t i = 0; i < n_drives_; ++i) {
      Statement s = says;
      s.follows = courses_[i].follows;
      s.law = law_at(s, courses_[i].law);
      add(s, {respond(loads, courses_[i])});
    }
    Statement s = says;
    s.follows = courses_.back().follows;
    s.law = law_at(s, courses_.back().law);
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
  std::vector<effects::HeatBalance> alone;
  for (const effects::Effect& e : scene_.own) {
    if (!e.kind->contribute) continue;
    alone.push_back(effects::heat_balance({e}));
    if (alone.back().nodes.size() < 2) alone.pop_back();
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    for (std::size_t j = i + 1; j <= bodies.size(); ++j) {
      const Body other = j < bodies.size() ? bodies[j] : effects::ambient_node();
      const bool solid = bodies[i].kind == effects::BodyKind::kRegion && other.kind == effects::BodyKind::kRegion;
      if (solid) continue;                                                                             // covered by joints
      if (other == effects::ambient_node() && bodies[i].kind == effects::BodyKind::kRegion) continue;  // covered by surfaces
      const double is = own(bodies[i], other.name);
      if (is == 0.0 && are_of_one_effect(alone, bodies[i], other)) continue;
      auto loads = std::make_shared<Loads>();
      for (const LinearOperator& m : machine_) loads->push_back(m.conductance(bodies[i], other));
      if (loads->front().size() == 0) continue;
      const Statement says{.quantity = StatedQuantity::kExchange,
                           .place = {bodies[i].name, other.name},
                           .unit_size = is > 0.0 ? is : typical,
                           .unit = "W/K"};
      courses_at(says, loads);
      if (is > 0.0 || j == bodies.size() || bodies.size() < 12) add_heat_cells(says, loads);
      if (j == bodies.size()) continue;
      by_a_third(says, bodies[i], bodies[j], own(bodies[i], effects::kAmbientName), own(bodies[j], effects::kAmbientName));
    }
  }
  const auto& system = fitter_.twin().machine().system;
  for (std::size_t e = 0; e < system.exchanges.size(); ++e) {
    const auto& place = system.exchanges[e].place;
    const bool of_bodies =
        place.per == effects::Per::kTotal && (place.body.kind == effects::BodyKind::kNode || !place.surrounding.empty());
    // A film from a file: what is stated of its surface is stated of the even film that lies there as well.
    if (of_bodies || !place.part.empty()) continue;
    auto loads = std::make_shared<Loads>();
    double squares = 0.0;
    for (const LinearOperator& m : machine_) {
      loads->push_back(m.exchange(e));
      squares += loads->back().squaredNorm();
    }
    if (!(squares > 0.0)) continue;
    const double is = std::abs(machine_.front().coefficient(e));
    const bool is_of_mesh = place.body.kind != effects::BodyKind::kNode && place.body.kind != effects::BodyKind::kRegion;
    std::vector<std::string> where =
        is_of_mesh ? fitter_.twin().bodies_at(place.body.name) : std::vector<std::string>{place.body.name};
    if (where.size() == 1) where.push_back(place.surrounding.empty() ? effects::kAmbientName : place.surrounding);
    const Statement says{.quantity = StatedQuantity::kExchange,
                         .place = where,
                         .at = is_of_mesh ? place.body.name : "",
                         .unit_size = is > 0.0                           ? is
                                      : place.per == effects::Per::kArea ? 10.0
                                                                         : typical,
                         .unit = place.per == effects::Per::kArea ? "W/(m^2 K)" : "W/K"};
    courses_at(says, loads);
    add_heat_cells(says, loads);
  }
}

void StatementBuilder::by_a_third(const Statement& of_both, const Body& a, const Body& b, double loss_a_W_K,
                                  double loss_b_W_K) {
  const auto between_rows = [](const Row& at_rows) -> Row {
    const Eigen::Index n = at_rows.size() - 1;
    return 0.5 * (at_rows.head(n) + at_rows.tail(n));
  };
  for (const LinearOperator& m : machine_) {
    if (m.heat(a).size() == 0 || m.heat(b).size() == 0 || m.temperature(a).size() == 0 || m.temperature(b).size() == 0)
      return;
  }
  Statement says = of_both;
  /// @param temperature  of the third body, from those of a, b and the ambient. @param heat  into a and b, from its
  /// temperature and those of a and b
  const auto say = [&](double lag_s, const auto& temperature, const auto& heat) {
    auto loads = std::make_shared<Loads>();
    for (const LinearOperator& m : machine_) {
      const Row of_a = m.temperature(a), of_b = m.temperature(b);
      Row third = temperature(of_a, of_b, m.ambient_K());
      if (lag_s > 0.0) effects::lag_behind(third, m.time_s(), lag_s);
      const auto [to_a, to_b] = heat(third, of_a, of_b);
      loads->push_back(m.heat(a) * between_rows(to_a).asDiagonal() + m.heat(b) * between_rows(to_b).asDiagonal());
    }
    add(says, {respond(loads, courses_.front())});
  };
  says.follows = "body between";
  for (double lag_s : kBetween_s) {
    says.law = "through a body between them that loses heat, too";
    if (lag_s > 0.0) says.law += fmt::format(", with a lag of {:g} min", lag_s / 60.0);
    say(
        lag_s, [](const Row& of_a, const Row& of_b, const Row& air) -> Row { return (of_a + of_b + air) / 3.0; },
        [](const Row& third, const Row& of_a, const Row& of_b) { return std::pair<Row, Row>(third - of_a, third - of_b); });
  }
  if (!(loss_a_W_K > 0.0) || !(loss_b_W_K > 0.0)) return;
  says.follows = "guard";
  says.unit = "K/W";
  says.unit_size = 1.0 / (loss_a_W_K + loss_b_W_K);
  for (double lag_s : {0.0, kGuard_s}) {
    says.law = lag_s > 0.0 ? "in air that is shut in with them and warms slowly" : "in air that is shut in with them";
    say(
        lag_s,
        [&](const Row& of_a, const Row& of_b, const Row& air) -> Row {
          return loss_a_W_K * (of_a - air) + loss_b_W_K * (of_b - air);
        },
        [&](const Row& third, const Row&, const Row&) {
          return std::pair<Row, Row>(loss_a_W_K * third, loss_b_W_K * third);
        });
  }
}

void StatementBuilder::conductivities() {
  const auto& parts = fitter_.twin().machine().system.parts;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (!(parts[p].conduction.cwiseAbs().maxCoeff() > 0.0)) continue;
    auto loads = std::make_shared<Loads>();
    for (const LinearOperator& m : machine_) loads->push_back(m.conduction(p));
    add({.quantity = StatedQuantity::kExchange,
         .place = {parts[p].body},
         .follows = "constant",
         .law = "its conductivity",
         .unit_size = kUsualLogarithm,
         .unit = "1"},
        {respond(loads, courses_.front())});
  }
}

void StatementBuilder::capacities() {
  for (const auto& material : scene_.materials) {
    if (!material.stores || !(material.capacity_J_K > 0.0)) continue;
    for (double lag_s : kBodyLags_s) {
      auto loads = std::make_shared<Loads>();
      for (const LinearOperator& m : machine_) loads->push_back(m.capacity(material.body, lag_s));
      if (loads->front().size() == 0) break;
      Statement says{.quantity = StatedQuantity::kCapacity,
                     .place = {material.body.name},
                     .follows = lag_s > 0.0 ? "lagged" : "constant",
                     .law = lag_s > 0.0 ? fmt::format("a body with a lag of {:g} min", lag_s / 60.0) : "its own",
                     .unit_size = material.capacity_J_K,
                     .unit = "J/K"};
      add(says, {respond(loads, courses_.front())});
    }
  }
}

}  // namespace driftwright::diagnosis
