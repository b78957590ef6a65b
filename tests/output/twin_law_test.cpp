// Laws as tables against the laws themselves.

#include "output/twin/twin_law.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "effects/bearing_formulas.hpp"

namespace driftwright::output::twin_law_test {
namespace {

using Law = std::function<double(const Drive&, const std::vector<double>&)>;

const TemperatureRange kRange{.low_K = 268.15, .high_K = 383.15, .usual_K = 293.15};
const std::vector<DriveRange> kSpeed = {{DriveVariable::kSpeed, 12000.0}};

/// As law.js does: linear between nodes, the ends beyond.
double value_of(const TwinLaw& law, double speed_rpm, const std::vector<double>& probe_K) {
  double value = law.drive.at({speed_rpm}) * (1.0 - static_cast<double>(law.tables.size()));
  for (const TwinTable& table : law.tables) {
    std::vector<std::pair<std::size_t, double>> place;
    for (const TwinAxis& axis : table.axes) {
      const double x = probe_K[static_cast<std::size_t>(axis.probe)] -
                       (axis.minus >= 0 ? probe_K[static_cast<std::size_t>(axis.minus)] : 0.0);
      std::size_t low = 0;
      while (low + 2 < axis.nodes_K.size() && axis.nodes_K[low + 1] <= x) ++low;
      place.emplace_back(low, (x - axis.nodes_K[low]) / (axis.nodes_K[low + 1] - axis.nodes_K[low]));
    }
    const auto at = [&](std::size_t i) { return table.at[i].at({speed_rpm}); };
    const auto [i, u] = place.back();
    if (place.size() == 1) {
      value += (1 - u) * at(i) + u * at(i + 1);
    } else {
      const std::size_t n = table.axes.back().nodes_K.size();
      const auto [k, w] = place.front();
      const auto along = [&](std::size_t row) { return (1 - u) * at(row * n + i) + u * at(row * n + i + 1); };
      value += (1 - w) * along(k) + w * along(k + 1);
    }
  }
  return value;
}

double worst_miss(const Law& law, const TwinLaw& table, int n_probes, double largest) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> speed(0.0, 12000.0), temperature(kRange.low_K, kRange.high_K);
  double worst = 0.0;
  for (int k = 0; k < 2000; ++k) {
    std::vector<double> t_K;
    for (int p = 0; p < n_probes; ++p) t_K.push_back(temperature(random));
    const double rpm = speed(random);
    worst = std::max(worst, std::abs(value_of(table, rpm, t_K) - law({.speed_rpm = rpm}, t_K)) / largest);
  }
  return worst;
}

TEST(TwinLaw, FollowsOilThatThinsAndPreloadThatGrows) {
  // Front bearing of scenarios/lumped_spindle.yaml: oil alone, both rings only by their difference.
  const Law friction = [](const Drive& d, const std::vector<double>& t_K) {
    if (d.speed_rpm <= 0.0) return 0.0;
    const double torque_Nmm =
        effects::palmgren_viscous_torque_Nmm(0.4, effects::walther_viscosity_mm2_s(25, 5.4, t_K[0]), d.speed_rpm, 90) +
        effects::palmgren_load_torque_Nmm(6e-4, effects::thermal_preload_N(300, 15, t_K[1], t_K[2]), 90);
    return 2.0 * effects::friction_power_W(torque_Nmm, d.speed_rpm);
  };
  const auto table = twin_law(friction, 3, kSpeed, kRange);
  ASSERT_TRUE(table);
  ASSERT_EQ(table->tables.size(), 2U);
  EXPECT_EQ(table->tables[1].axes.size(), 1U);
  EXPECT_EQ(table->tables[1].axes[0].minus, 2);
  // Of the largest power: linear over 1 K of oil that gets 4 % thinner a kelvin misses by 0.04^2 / 8 of it; the kink
  // where the preload vanishes lies within one node of the difference.
  EXPECT_LT(worst_miss(friction, *table, 3, friction({.speed_rpm = 12000.0}, {273.15, 293.15, 293.15})), 2e-3);
}

TEST(TwinLaw, FollowsRadiationAndFreeConvectionOfTwoTemperatures) {
  const Law film = [](const Drive&, const std::vector<double>& t_K) {
    const double radiation = 0.9 * 5.67e-8 * (t_K[0] * t_K[0] + t_K[1] * t_K[1]) * (t_K[0] + t_K[1]);
    return radiation + 1.4 * std::pow(std::abs(t_K[0] - t_K[1]) / 0.3, 0.25) * std::sqrt(293.15 / t_K[0]);
  };
  const auto table = twin_law(film, 2, kSpeed, kRange);
  ASSERT_TRUE(table);
  ASSERT_EQ(table->tables.size(), 1U);
  EXPECT_EQ(table->tables[0].axes.size(), 2U);
  EXPECT_LT(worst_miss(film, *table, 2, film({}, {300.0, 293.0})), 1e-3);
}

TEST(TwinLaw, OfTheDriveAloneHasNoTables) {
  const Law motor = [](const Drive& d, const std::vector<double>&) {
    return 25.0 + 70.0 * std::pow(d.speed_rpm / 2000.0, 1.2);
  };
  const auto table = twin_law(motor, 1, kSpeed, kRange);
  ASSERT_TRUE(table);
  EXPECT_TRUE(table->tables.empty());
  EXPECT_NEAR(value_of(*table, 3333.0, {300.0}), motor({.speed_rpm = 3333.0}, {}), 1e-9);
}

TEST(TwinLaw, ThreeTemperaturesTogetherAreNoTable) {
  EXPECT_FALSE(
      twin_law([](const Drive&, const std::vector<double>& t_K) { return t_K[0] * t_K[1] * t_K[2]; }, 3, kSpeed, kRange));
}

}  // namespace
}  // namespace driftwright::output::twin_law_test
