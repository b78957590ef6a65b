// Effects as text and back: yaml_of() is the inverse of read_effect() for every kind of the catalogue.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"
#include "effects/effect.hpp"
#include "effects/formula.hpp"
#include "tests/effects/read_entry.hpp"

namespace driftwright::effects::yaml_of_test {
namespace {

void expect_same(const Effect& a, const Effect& b, const std::string& text) {
  ASSERT_EQ(a.kind, b.kind) << text;
  EXPECT_EQ(a.place_kind, b.place_kind) << text;
  EXPECT_EQ(a.place, b.place) << text;
  ASSERT_EQ(a.values.size(), b.values.size()) << text;
  for (std::size_t p = 0; p < a.values.size(); ++p) {
    if (std::isnan(a.values[p]) && std::isnan(b.values[p])) continue;
    EXPECT_NEAR(a.values[p], b.values[p], 1e-11 * std::abs(a.values[p])) << a.kind->parameters[p].name << " in " << text;
  }
  EXPECT_EQ(a.references, b.references) << text;
  EXPECT_EQ(a.words, b.words) << text;
  ASSERT_EQ(a.tables.size(), b.tables.size()) << text;
  for (const auto& [name, table] : a.tables) {
    ASSERT_TRUE(b.tables.contains(name)) << text;
    const TimeSeries& other = b.tables.at(name);
    ASSERT_EQ(table.time_s.size(), other.time_s.size()) << text;
    for (std::size_t i = 0; i < table.time_s.size(); ++i) {
      EXPECT_NEAR(table.time_s[i], other.time_s[i], 1e-9 * std::abs(table.time_s[i])) << text;
      EXPECT_NEAR(table.value[i], other.value[i], 1e-9 * std::abs(table.value[i])) << text;
    }
  }
  EXPECT_DOUBLE_EQ(a.from_s, b.from_s) << text;
  EXPECT_DOUBLE_EQ(a.until_s, b.until_s) << text;
  EXPECT_EQ(a.in, b.in) << text;
}

/// An effect whose every number is drawn from its range; keys that go together or exclude each other are the kind's own
/// business.
Effect drawn(const EffectKind& kind, Place place, Random& random) {
  Effect e = make_effect(
      kind.key, place,
      place == Place::kAmbient || place == Place::kClock || place == Place::kSpindle ? place_key(place) : "the spot-1/b@c");
  for (std::size_t p = 0; p < kind.parameters.size(); ++p) {
    const Parameter& parameter = kind.parameters[p];
    const bool may_be_left_out = parameter.fallback && std::isnan(*parameter.fallback);
    if (may_be_left_out && random.chance(0.5)) continue;
    e.values[p] = parameter.low + (parameter.high - parameter.low) * std::pow(random.uniform(), 3.0);
  }
  for (const Reference& r : kind.references) {
    if (random.chance(0.5) || !r.fallback) e.references[r.name] = {r.kinds.back(), "other"};
  }
  for (const Choice& c : kind.choices)
    e.words[c.name] = c.options[static_cast<std::size_t>(random.below(static_cast<int>(c.options.size())))];
  for (const Table& t : kind.tables) {
    if (!t.compulsory && random.chance(0.5)) continue;
    const double high = std::min(t.high, 1e6);
    if (t.argument_unit == t.value_unit) {  // windows
      e.tables[t.name] = {{10.0, 70.5}, {20.25, 90.0}};
      continue;
    }
    e.tables[t.name] = {{10.0, 70.5}, {t.low + 0.3 * (high - t.low), t.low + 0.7 * (high - t.low)}};
  }
  for (const Mention& m : kind.mentions) {
    if (m.compulsory || random.chance(0.5))
      e.words[m.name] = m.of == Mention::Of::kPoints ? "0 0 0, 100.5 -25 1e-05" : "z_2";
  }
  if (kind.timing != Timing::kAlways && random.chance(0.7)) e.in = "monday";
  if (kind.timing == Timing::kInTime && random.chance(0.7)) {
    e.from_s = 1e4 * random.uniform();
    e.until_s = e.from_s + 1e4 * random.uniform() + 1.0;
  }
  return e;
}

// What is left out by chance is drawn with a chance of 1/2, so that each part of a kind is among them.
constexpr int kReadAtAPlace = 20, kDrawnAtAPlace = 200;

TEST(YamlOf, ComesBackForEveryKindAtEveryPlace) {
  Random random(17, 0);
  for (const EffectKind& kind : catalogue()) {
    if (has_formula(kind)) continue;  // its entries declare the names that they have: formula_test
    int n_read = 0;
    for (const Place place : kind.places) {
      const int enough = n_read + kReadAtAPlace;
      for (int i = 0; i < kDrawnAtAPlace && n_read < enough; ++i) {
        const Effect e = drawn(kind, place, random);
        const std::string text = yaml_of(e);
        std::optional<Effect> back;
        try {
          back = read(text);
        } catch (const InputError& error) {  // what the kind's own check refuses is no effect
          ASSERT_TRUE(kind.check) << text << ": " << error.what();
          continue;
        }
        ++n_read;
        expect_same(e, *back, text);
      }
    }
    EXPECT_GE(n_read, 1) << kind.key << ": its check has refused all that was drawn";
  }
}

TEST(YamlOf, LeavesOutWhatStandsAtItsFallbackAndKeepsUnits) {
  EXPECT_EQ(yaml_of(read("{type: convection, surface: nose, film: 0.8 mW/(cm^2 K)}")),
            "{type: convection, surface: nose, film: 8 W/(m^2 K)}");
  EXPECT_EQ(yaml_of(read("{type: heat_source, node: oil tank, power: 1 kW, from: 2 min, in: monday}")),
            "{type: heat_source, node: \"oil tank\", power: 1000 W, from: 120 s, in: monday}");
  EXPECT_EQ(yaml_of(read("{type: fixed_temperature, surface: a, temperature: [[0 h, 20 degC], [1 h, 25.5 degC]]}")),
            "{type: fixed_temperature, surface: a, temperature: [[0 s, 20 degC], [3600 s, 25.5 degC]]}");
  EXPECT_EQ(
      yaml_of(read("{type: bearing_friction, region: a, f0: 1, viscosity_40: 32 mm^2/s, viscosity_100: 5 mm^2/s, "
                   "mean_diameter: 60 mm, oil: {region: b}}")),
      "{type: bearing_friction, region: a, f0: 1, viscosity_40: 32 mm^2/s, viscosity_100: 5 mm^2/s, mean_diameter: 60 mm, "
      "oil: {region: b}}");
}

}  // namespace
}  // namespace driftwright::effects::yaml_of_test
