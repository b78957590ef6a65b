// A feed axis: its screw against closed forms of rods and against a rod of finite elements, its error by value.

#include "effects/feed_axis.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "base/errors.hpp"
#include "solver/steady_state.hpp"
#include "solver/transient.hpp"
#include "tests/shared/effect_list.hpp"
#include "tests/shared/fixtures.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::solver::feed_axis_test {
namespace {

using effects::Effect;
using effects::ScrewRod;
using fixtures::flow;

const TimeSeries kStillAmbient{{0.0}, {0.0}};
const TransientOptions kFine{.relative_tolerance = 1e-7, .absolute_tolerance_K = 1e-7};
// Of bearing steel, the default.
constexpr double kConductivity = 42.0, kCapacity = 7810.0 * 470.0, kExpansion = 11.9e-6;
const double kDiffusivity = kConductivity / kCapacity;

/// A screw of 1 m without film: 36 mm, travel 200 mm to 800 mm of it.
std::string axis(const std::string& more) {
  return "{type: feed_axis, node: nut, screw: s, axis: x, lowest: 200 mm, travel: 600 mm, fixed_gap: 200 mm, "
         "far_gap: 200 mm, "
         "diameter: 36 mm, lead: 10 mm, nut_length: 80 mm, " +
         more + "}";
}
Effect read(const std::string& text) {
  return effects::read_effect(ConfigMap::read_file(write_file("feed_axis.yaml", text)));
}

/// The screw and its nut, of which the nut comes first, with what else there is.
FullSystem system_of(const std::string& screw, std::vector<std::string> others = {}) {
  others.insert(others.begin(), {"{type: node, node: nut, capacity: 1 kJ/K}", screw});
  return fixtures::lumped_system(others);
}
/// The temperatures of the sections [K], from the state of such a system.
std::vector<double> sections_of(const Eigen::VectorXd& state, int n) {
  return {state.data() + 1, state.data() + 1 + n};
}
double um(double m) {
  return 1e6 * m;
}

// --- the error of the axis ----------------------------------------------------------------------------------------

ScrewRod rod_of(const std::string& more) {
  return effects::screw_rod(read(axis("torque: 1 N m, " + more)));
}
double error_um(const ScrewRod& rod, double position_m, double rise_K) {
  return um(effects::axis_error_m(rod, position_m, std::vector<double>(static_cast<std::size_t>(rod.n_sections), rise_K)));
}

TEST(AxisError, OfAnEvenlyWarmScrewIsItsFreeGrowthFromTheFixedBearing) {
  // 10 K: 119 um a metre. The fixed bearing is 200 mm below the travel's lower end, at the position 0.
  for (const char* mounting : {"mounting: fixed_free", "mounting: fixed_supported"}) {
    const ScrewRod rod = rod_of(mounting);
    EXPECT_EQ(rod.n_sections, 25);
    EXPECT_NEAR(error_um(rod, 0.2, 10.0), 23.8, 1e-9);
    EXPECT_NEAR(error_um(rod, 0.513, 10.0), 119.0 * 0.513, 1e-9);  // within a section
    EXPECT_NEAR(error_um(rod, 0.8, 10.0), 95.2, 1e-9);
  }
  // With the fixed bearing at the upper end, at the position 1 m, the nut moves down.
  const ScrewRod upper = rod_of("mounting: fixed_free, fixed_end: high");
  EXPECT_NEAR(error_um(upper, 0.8, 10.0), -23.8, 1e-9);
  EXPECT_NEAR(error_um(upper, 0.2, 10.0), -95.2, 1e-9);
  EXPECT_THROW((void)effects::axis_error_m_K(upper, 1.01), RangeError);
}

TEST(AxisError, OfAStretchedScrewIsWhatItsEndsLeave) {
  // Rigid ends: an evenly warm screw keeps every place.
  EXPECT_NEAR(error_um(rod_of("mounting: stretched"), 0.5, 10.0), 0.0, 1e-9);
  // E A / L = 208e9 * pi/4 * 0.036^2 / 1 m = 211.720 N/um; 1/211.720 + 1/400 + 1/200 = 0.0122232 um/N in all. Its growth of
  // 119 um takes 9735.6 N from the tension, which had moved the fixed bearing by 1/400 um/N: -24.339 um there, and at 0.5 m
  // 59.5 - 9735.6 (0.5 / 211.720 + 1 / 400) = 12.169 um.
  const ScrewRod soft = rod_of("mounting: stretched, fixed_stiffness: 400 N/um, far_stiffness: 200 N/um");
  EXPECT_NEAR(error_um(soft, 0.5, 10.0), 12.169, 2e-3);
  // A stretch of 50 um is used up by 4.2 K; what comes after is free: at the far end 119 - 50 um, in the middle half of it.
  const ScrewRod pulled = rod_of("mounting: stretched, stretch: 50 um");
  EXPECT_NEAR(error_um(pulled, 0.5, 4.0), 0.0, 1e-9);
  EXPECT_NEAR(error_um(pulled, 0.5, 10.0), 0.5 * (119.0 - 50.0), 1e-9);
  EXPECT_NEAR(error_um(pulled, 0.5, -10.0), 0.0, 1e-9);  // colder: more tension
}

TEST(AxisError, IsExactForATemperatureThatIsLinearAlongTheScrew) {
  // theta = 30 s K from means of sections: alpha 15 s^2 = 178.5 s^2 um at every s, on faces and between them.
  const ScrewRod rod = rod_of("mounting: fixed_free, section_length: 70 mm");
  std::vector<double> theta_K;
  for (int i = 0; i < rod.n_sections; ++i) theta_K.push_back(30.0 * (i + 0.5) * rod.section_m());
  for (const double s_m : {0.2, 0.2 + 1e-3, 0.431, 0.6667, 0.8})
    EXPECT_NEAR(um(effects::axis_error_m(rod, s_m, theta_K)), 178.5 * s_m * s_m, 1e-9) << s_m;
}

TEST(NutShare, IsThatOfATrapezoid) {
  // Sections of 40 mm; a nut of 80 mm at 500 mm covers 460 mm to 540 mm: 20 mm of section 11, sections 12, and 20 mm of 13.
  const ScrewRod rod = rod_of("mounting: fixed_free");
  EXPECT_NEAR(effects::nut_share(rod, 11, 0.5, 0.0), 0.25, 1e-12);
  EXPECT_NEAR(effects::nut_share(rod, 12, 0.5, 0.0), 0.5, 1e-12);
  EXPECT_NEAR(effects::nut_share(rod, 10, 0.5, 0.0), 0.0, 1e-12);
  // A stroke of 400 mm: density 1/400 a mm within 160 mm about 500 mm, falling to zero over 80 mm on either side.
  EXPECT_NEAR(effects::nut_share(rod, 12, 0.5, 0.4), 0.1, 1e-12);
  // Of the flank from 260 mm to 340 mm the middle half: (60^2 - 20^2) / (2 * 80 * 400).
  EXPECT_NEAR(effects::nut_share(rod, 7, 0.5, 0.4), 0.05, 1e-12);
  for (const double stroke_m : {0.0, 1e-9, 0.03, 0.08, 0.6}) {
    double sum = 0.0;
    for (int i = 0; i < rod.n_sections; ++i) sum += effects::nut_share(rod, i, 0.5, stroke_m);
    EXPECT_NEAR(sum, 1.0, 1e-12) << stroke_m;
  }
}

// --- its heat -----------------------------------------------------------------------------------------------------

TEST(FeedAxis, BetweenTwoTemperaturesGrowsAsALinearProfileDoes) {
  // 20 K at the fixed end, none at the other: theta = 20 (1 - s), growth alpha (20 s - 10 s^2) = 238 s - 119 s^2 um.
  const std::string text = axis(
      "torque: 0 N m, mounting: fixed_supported, film: 0 W/(m^2 K), film_growth: 0, fixed_bearing: a, far_bearing: b, "
      "fixed_conductance: 1e6 W/K, far_conductance: 1e6 W/K");
  const FullSystem system =
      system_of(text, {"{type: link, node: nut, to: ambient, conductance: 1 W/K}", "{type: node, node: a, capacity: 1 J/K}",
                       "{type: node, node: b, capacity: 1 J/K}", "{type: fixed_temperature, node: a, temperature: 40 degC}",
                       "{type: fixed_temperature, node: b, temperature: 20 degC}"});
  const Effect e = read(text);
  const ScrewRod rod = effects::screw_rod(e);
  const Eigen::VectorXd theta = steady_state(system, {}, Eigen::VectorXd::Zero(system.size()));
  for (const double s_m : {0.2, 0.5, 0.8}) {
    EXPECT_NEAR(um(effects::axis_error_m(rod, s_m, sections_of(theta, rod.n_sections))), 238.0 * s_m - 119.0 * s_m * s_m,
                1e-3)  // seats of 1e6 W/K beside 0.04 W/K
        << s_m;
  }
}

/// Growth [um] at 0.8 m of a fin whose fixed end is 20 K warmer than its surrounding, film 10 W/(m^2 K), in sections.
double fin_growth_um(int section_mm) {
  const std::string text = axis(
      "torque: 0 N m, mounting: fixed_free, film: 10 W/(m^2 K), film_growth: 0, fixed_bearing: a, "
      "fixed_conductance: 1e6 W/K, section_length: " +
      std::to_string(section_mm) + " mm");
  const FullSystem system =
      system_of(text, {"{type: link, node: nut, to: ambient, conductance: 1 W/K}", "{type: node, node: a, capacity: 1 J/K}",
                       "{type: fixed_temperature, node: a, temperature: 40 degC}"});
  const ScrewRod rod = effects::screw_rod(read(text));
  const Eigen::VectorXd theta = steady_state(system, {}, Eigen::VectorXd::Zero(system.size()));
  return um(effects::axis_error_m(rod, 0.8, sections_of(theta, rod.n_sections)));
}

TEST(FeedAxis, ConvergesToTheFinWithTheSquareOfItsSections) {
  // theta = 20 cosh m(1 - s) / cosh m, m^2 = 4 h / (k d); its integral to 0.8 m: 20 (sinh m - sinh 0.2 m) / (m cosh m).
  const double m = std::sqrt(4.0 * 10.0 / (kConductivity * 0.036));
  const double exact_um = um(kExpansion * 20.0 * (std::sinh(m) - std::sinh(0.2 * m)) / (m * std::cosh(m)));
  std::vector<double> width, error;
  for (const int section_mm : {100, 50, 25, 10}) {
    width.push_back(section_mm);
    error.push_back(std::abs(fin_growth_um(section_mm) - exact_um));
  }
  EXPECT_NEAR(fixtures::observed_order(width, error), 2.0, 0.1);
  EXPECT_LT(error[2], 0.1) << "with sections of 25 mm";
  RecordProperty("exact_um", std::to_string(exact_um));
}

/// A cyclogram that moves the nut at one speed from 300 mm to 700 mm within 600 s, in rows of 10 s.
Cyclogram one_way() {
  Cyclogram c{.name = "way", .sections = {}};
  c.columns = {{"position_x", "mm", {}}, {"stroke_x", "mm", {}}};
  for (int i = 0; i < 60; ++i) {
    c.sections.push_back({10.0, {.feed_m_s = {0.4 / 600.0, 0.0, 0.0}}});
    for (Cyclogram::Column& column : c.columns) column.rows.time_s.push_back(10.0 * i);
    c.columns[0].rows.value.push_back(300.0 + 400.0 * (i + 0.5) / 60.0);
    c.columns[1].rows.value.push_back(400.0 / 60.0);
  }
  return c;
}

/// Growth [m] up to s of a rod of 1 m with insulated ends, whose moving source has given `power_W` over its length:
/// instant sources on an infinite rod, superposed (Carslaw & Jaeger, Conduction of Heat in Solids, 10.3 and 10.7), with
/// images at both ends. The source of one instant is even over the nut; its growth up to s is that of two integrals of erf.
double growth_by_sources_m(double power_W, double nut_m, double s_m) {
  const double area_m2 = 0.25 * std::numbers::pi * 0.036 * 0.036;
  constexpr int kSteps = 20000;
  double sum = 0.0;
  for (int k = 0; k < kSteps; ++k) {
    const double t_s = 600.0 * (k + 0.5) / kSteps, at_m = 0.3 + 0.4 * t_s / 600.0;
    const double width_m = 2.0 * std::sqrt(kDiffusivity * (600.0 - t_s));
    // share of a unit source, even over the nut, that lies below s: integral of erf from one end of the nut to the other
    const auto below = [&](double middle_m, double x_m) {
      const auto integral = [&](double z) { return z * std::erf(z) + std::exp(-z * z) / std::sqrt(std::numbers::pi); };
      const double a = (x_m - middle_m + 0.5 * nut_m) / width_m, b = (x_m - middle_m - 0.5 * nut_m) / width_m;
      return 0.5 + 0.5 * width_m / nut_m * (integral(a) - integral(b));
    };
    for (const double image_m : {at_m, -at_m, 2.0 - at_m}) sum += below(image_m, s_m) - below(image_m, 0.0);
  }
  return kExpansion * power_W / (kCapacity * area_m2) * sum * 600.0 / kSteps;
}

TEST(FeedAxis, FollowsAMovingSourceAsCarslawAndJaegerDo) {
  // 150 N m at a lead of 10 mm and 0.667 mm/s: 2 pi 150 / 0.01 * 0.4 / 600 = 62.832 W, all into the screw.
  const std::string text = axis(
      "torque: 150 N m, share: 1, mounting: fixed_free, film: 0 W/(m^2 K), film_growth: 0, "
      "section_length: 10 mm, position: position_x, stroke: stroke_x");
  const Effect e = read(text);
  FullSystem system = system_of(text, {"{type: link, node: nut, to: ambient, conductance: 1 W/K}"});
  const ScrewRod rod = effects::screw_rod(e);
  std::vector<int> unknowns(static_cast<std::size_t>(rod.n_sections));
  std::iota(unknowns.begin(), unknowns.end(), 1);
  fixtures::observe_unknowns(system, unknowns);
  const Cyclogram felt = effects::true_cyclogram(effects::drive_change({e}, "way"), one_way());
  const Trajectory run = simulate(system, felt, kStillAmbient, {600.0}, kFine, Eigen::VectorXd::Zero(system.size()));
  const std::vector<double> theta_K(run.outputs.data(), run.outputs.data() + rod.n_sections);
  for (const double s_m : {0.3, 0.5, 0.65, 0.8}) {
    EXPECT_NEAR(um(effects::axis_error_m(rod, s_m, theta_K)), um(growth_by_sources_m(62.83185307, 0.08, s_m)), 0.1) << s_m;
  }
  // All of the heat is in the screw: 37 699 J, which alpha / (c A) turns into growth.
  EXPECT_LT(run.energy_gap(), 1e-9);
  const double whole_um = um(kExpansion * 62.83185307 * 600.0 / (kCapacity * 0.25 * std::numbers::pi * 0.036 * 0.036));
  EXPECT_NEAR(kExpansion * 0.01 * um(std::accumulate(theta_K.begin(), theta_K.end(), 0.0)), whole_um, 1e-3);
}

TEST(FeedAxis, GrowsAsARodOfFiniteElements) {
  // A square rod of 36 mm has the round one's ratios of section, surface and volume. One end is held 30 K warmer, its sides
  // have a film of 10 W/(m^2 K); after half an hour.
  const double seconds = 1800.0;
  const Cyclogram rest{.name = "rest", .sections = {{seconds, {}}}};
  fixtures::Box box{.size_m = {1.0, 0.036, 0.036}, .n = {100, 1, 1}, .shape = mesh::CellShape::kHex20};
  const mesh::Mesh mesh = fixtures::box_mesh(box);
  Material steel = fixtures::steel();
  steel.density_kg_m3 = 7810.0;
  steel.conductivity_W_mK = kConductivity;
  steel.heat_capacity_J_kgK = 470.0;
  std::vector<std::string> entries = {"{type: fixed_temperature, surface: x0, temperature: 50 degC}"};
  for (const char* side : {"y0", "y1", "z0", "z1"})
    entries.push_back(std::string("{type: convection, surface: ") + side + ", film: 10 W/(m^2 K)}");
  const effects::HeatBalance balance = fixtures::balance_of(entries);
  FullSystem elements = assemble_heat(mesh, {steel}, balance);
  fixtures::observe_unknowns(elements, {0});
  elements.outputs.state.col(0) = mean_weights(mesh, balance, effects::region("body"));
  const Trajectory of_elements =
      simulate(elements, rest, kStillAmbient, {seconds}, kFine, Eigen::VectorXd::Zero(elements.size()));
  const double elements_um = um(kExpansion * of_elements.outputs(0, 0));

  const std::string text = axis(
      "torque: 0 N m, mounting: fixed_free, film: 10 W/(m^2 K), film_growth: 0, fixed_bearing: a, "
      "fixed_conductance: 1e6 W/K, section_length: 10 mm");
  FullSystem sections =
      system_of(text, {"{type: link, node: nut, to: ambient, conductance: 1 W/K}", "{type: node, node: a, capacity: 1 J/K}",
                       "{type: fixed_temperature, node: a, temperature: 50 degC}"});
  const ScrewRod rod = effects::screw_rod(read(text));
  fixtures::observe_unknowns(sections, {0});
  sections.outputs.state.setZero();
  sections.outputs.state.block(1, 0, rod.n_sections, 1).setConstant(rod.section_m());
  const Trajectory of_sections =
      simulate(sections, rest, kStillAmbient, {seconds}, kFine, Eigen::VectorXd::Zero(sections.size()));
  EXPECT_NEAR(um(kExpansion * of_sections.outputs(0, 0)), elements_um, 0.1);
  EXPECT_GT(elements_um, 20.0);
}

TEST(FeedAxis, SharesItsHeatWithTheNutAndCoolsItsBore) {
  // 2 N m, 10 mm, 0.1 m/s: 2 pi 2 / 0.01 * 0.1 = 125.664 W; a quarter into the screw. 3 L/min of 3800 J/(L K) carry 190 W/K,
  // a passage of 95 W/K: 190 (1 - exp(-1/2)) = 74.759 W/K.
  const effects::HeatBalance b = fixtures::balance_of(
      {axis("torque: 2 N m, share: 0.25, mounting: fixed_free, bore: 12 mm, flow: 3 L/min, passage_conductance: 95 W/K")});
  const effects::Inputs moving{.drive = {.feed_m_s = {0.1, 0.0, 0.0}}};
  double screw_W = 0.0, coolant_W_K = 0.0, film_W_K = 0.0, still_W_K = 0.0, capacity_J_K = 0.0;
  for (const auto& h : b.heats) {
    if (h.body == effects::node("nut")) {
      EXPECT_NEAR(h.power_W(moving), 94.248, 1e-3);
    } else {
      screw_W += h.power_W(moving);
    }
  }
  EXPECT_NEAR(screw_W, 31.416, 1e-3);
  for (const auto& x : b.exchanges) {
    if (x.name.ends_with("coolant in the screw")) coolant_W_K += x.coefficient(moving);
    if (x.name.ends_with("film of the screw")) {
      film_W_K += x.coefficient(moving);
      still_W_K += x.coefficient({});
    }
  }
  for (const auto& n : b.nodes) capacity_J_K += n.capacity_J_K;
  EXPECT_NEAR(coolant_W_K, 74.759, 1e-3);
  EXPECT_NEAR(still_W_K, 6.0 * std::numbers::pi * 0.036, 1e-9);
  // 600 rpm: Re = pi 0.036^2 10 / 15.9e-6 = 2560.7; Nu = 0.133 * 187.2 * 0.8921 = 22.21; h = 22.21 * 0.026 / 0.036 = 16.04.
  EXPECT_NEAR(film_W_K - still_W_K, 16.04 * std::numbers::pi * 0.036, 0.003);
  EXPECT_NEAR(capacity_J_K, kCapacity * 0.25 * std::numbers::pi * (0.036 * 0.036 - 0.012 * 0.012), 1e-6);
}

TEST(FeedAxis, RefusesWhatCannotBe) {
  const auto refuses = [](const std::string& more, const std::string& message) {
    EXPECT_REFUSED(read(axis("torque: 1 N m, " + more)), message) << more;
  };
  refuses("mounting: fixed_free, bore: 36 mm", "the bore must be smaller");
  refuses("mounting: fixed_free, section_length: 2 mm", "200 are allowed");
  refuses("mounting: fixed_free, far_bearing: b", "no bearing at its far end");
  refuses("mounting: fixed_supported, stretch: 20 um", "only with `mounting: stretched`");
  refuses("mounting: fixed_free, flow: 2 L/min", "requires both");
  refuses("mounting: fixed_free, flow: 2 L/min, passage_conductance: 3 W/K", "which is missing");
  refuses("mounting: fixed_free, stroke: stroke_x", "which is missing");
  refuses("mounting: fixed_free, position: feed_x", "are no positions");
  refuses("mounting: loose", "fixed_supported");
  const Effect e = read(axis("torque: 1 N m, mounting: fixed_free, position: position_x, stroke: stroke_x"));
  Cyclogram beyond = one_way();
  beyond.columns[0].rows.value[7] = 799.0;  // and half of a stroke of 6.67 mm
  EXPECT_REFUSED(effects::true_cyclogram(effects::drive_change({e}, "way"), beyond),
                 "row 8 of column 'position_x', at 1.16667 min, has 799 mm");
}

}  // namespace
}  // namespace driftwright::solver::feed_axis_test
