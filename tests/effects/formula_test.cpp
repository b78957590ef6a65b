// Formulas of scenarios: by value, their units, what is refused and where, what a diagnosis may turn.

#include "effects/formula.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "base/errors.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::effects::formula_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

Effect read(const std::string& text) {
  return read_effect(ConfigMap::read_file(write_file("formula_test.yaml", text)));
}
Effect heat(const std::string& formula, const std::string& names = "") {
  return read("{type: formula, node: a, power: \"" + formula + "\"" + (names.empty() ? "" : ", " + names) + "}");
}
/// The heat of a formula at a speed and at temperatures of its bodies [degC].
double power_W(const Effect& e, double speed_rpm, const std::vector<double>& bodies_C = {}) {
  Inputs at{.drive = {.speed_rpm = speed_rpm, .feed_m_s = {0.5, 0.0, 0.0}, .cutting_power_W = 800.0}};
  for (const double t_C : bodies_C) at.probe_K.push_back(t_C + 273.15);
  return heat_balance({e}).heats.at(0).power_W(at);
}

// --- by value

TEST(Formula, IsEvaluatedInTheUnitsOfItsNumbers) {
  const Effect e =
      heat("P0*(n/6000)^1.7*(1 + k*(T_bearing - T_housing))", "P0: 0.15 kW, k: 2 %/K, T_bearing: a, T_housing: {region: b}");
  EXPECT_NEAR(power_W(e, 3000, {45, 30}), 150.0 * std::pow(0.5, 1.7) * 1.3, 1e-12 * 150.0);
  const HeatBalance balance = heat_balance({e});
  EXPECT_EQ(balance.heats.at(0).power_W.probes, (std::vector<Body>{node("a"), region("b")}));
  EXPECT_TRUE(heat_balance({heat("P", "P: 3 W")}).heats.at(0).power_W.probes.empty());
}

struct Value {
  const char* formula;
  const char* names;
  double expected_W;  ///< at 1000 rpm, 0.5 m/s, 800 W of cutting, 30 and 20 degC
};
class FormulaValues : public ::testing::TestWithParam<Value> {};
TEST_P(FormulaValues, AreThoseByHand) {
  const Effect e = heat(GetParam().formula, GetParam().names);
  EXPECT_NEAR(power_W(e, 1000, {30, 20}), GetParam().expected_W, 1e-9 * std::abs(GetParam().expected_W));
}
INSTANTIATE_TEST_SUITE_P(
    Each, FormulaValues,
    ::testing::Values(
        Value{"-W*2^2", "W: 1 W", -4.0}, Value{"W*2^-1", "W: 1 W", 0.5}, Value{"W*2^3^2", "W: 1 W", 512.0},
        Value{"W*(1 - (2 - 3) - 4)", "W: 1 W", -2.0}, Value{"c*n", "c: 20 mW/rpm", 20.0}, Value{"F*v_x", "F: 40 N", 20.0},
        Value{"0.1*P_cut", "", 80.0}, Value{"M*2*pi*n/60/s", "M: 3 N m, s: 1 s", 3.0 * 2.0 * M_PI * 1000.0 / 60.0},
        Value{"if(n > 999, W, 1/0*W)", "W: 7 W", 7.0}, Value{"if(n < 999, W, 2*W)", "W: 7 W", 14.0},
        Value{"max(0, G*(T_a - T_b))", "G: 3 W/K, T_a: a, T_b: b", 30.0}, Value{"W*abs(-3)*sqrt(4)", "W: 1 W", 6.0},
        Value{"W*exp(-k*(T_a - T_0))*(T_b < T_a)", "W: 100 W, k: 0.03 1/K, T_0: 20 degC, T_a: a, T_b: b",
              100.0 * std::exp(-0.3)},
        Value{"s*A*(kelvin(T_a)^4 - kelvin(T_b)^4)", "s: 5.67e-8 W/(m^2 K^4), A: 0.5 m^2, T_a: a, T_b: b",
              2.835e-8 * (std::pow(303.15, 4) - std::pow(293.15, 4))},
        Value{"W*celsius(T_a)*celsius(T_b)", "W: 1 W, T_a: a, T_b: b", 600.0},
        Value{"W*(ln(2) + log10(100) + sin(pi/6) + cos(0) + tan(0) + tanh(0))", "W: 1 W", std::log(2.0) + 3.5},
        Value{"W*sin(angle)", "W: 1 W, angle: 30 degree", 0.5}, Value{"min(W, sqrt(W*V))", "W: 9 W, V: 4 W", 6.0}));

TEST(Formula, GivesConductancesFilmsAndReadings) {
  const auto exchange = [](const std::string& text) { return heat_balance({read(text)}).exchanges.at(0); };
  const Exchange link = exchange("{type: formula, node: a, to: b, conductance: \"G*(1 + n/3000)\", G: 6 W/K}");
  EXPECT_EQ(link.per, Per::kTotal);
  EXPECT_EQ(link.surrounding, "b");
  EXPECT_DOUBLE_EQ(link.coefficient({.drive = {.speed_rpm = 1500}}), 9.0);
  const Exchange film = exchange("{type: formula, surface: s, film: \"h\", h: 8 W/(m^2 K)}");
  EXPECT_EQ(film.per, Per::kArea);
  EXPECT_EQ(film.surrounding, kAmbientName);
  EXPECT_DOUBLE_EQ(film.coefficient(Inputs{}), 8.0);
  const Exchange joint = exchange("{type: formula, joint: j, conductance: \"h\", h: 900 W/(m^2 K)}");
  EXPECT_EQ(joint.body, effects::joint("j"));
  EXPECT_DOUBLE_EQ(joint.coefficient(Inputs{}), 900.0);

  const Effect e =
      read("{type: formula, sensor: t, reading: \"T + b + s*(T_air - T)\", b: 0.5 K, s: 0.2, T_air: ambient, from: 10 s}");
  EXPECT_TRUE(e.kind->is_of_readings());
  const Cyclogram rest{.name = "rest", .sections = {{20.0, {}}}};
  const Eigen::MatrixXd seen =
      reading_chain({e}, "rest").apply({"t"}, {"K"}, {0.0, 10.0}, rest, {{0.0}, {-1.0}}, Eigen::RowVector2d(4.0, 4.0));
  EXPECT_DOUBLE_EQ(seen(0, 0), 4.0) << "before it begins";
  EXPECT_DOUBLE_EQ(seen(0, 1), 4.0 + 0.5 + 0.2 * (-1.0 - 4.0));
}

// --- what a diagnosis may turn

TEST(Formula, DeclaresItsNumbersAsParameters) {
  const Effect e = heat("P0*(n/n0)^x*exp(-k*(T_a - T_0))",
                        "P0: 100 W, n0: 6000 rpm, x: 1.5, k: 0.02 1/K, T_0: 20 degC, T_a: a, known_to: {P0: 20 %}");
  EXPECT_EQ(e.kind->known_roughly(), (std::vector<std::string>{"P0", "x", "k"})) << "n0 and T_0 are conditions";
  EXPECT_EQ(known_to(e.known_to, "P0", 0.1), 0.2);
  const auto parameter = [&](const std::string& name) {
    for (const Parameter& p : e.kind->parameters) {
      if (p.name == name) return p;
    }
    throw std::logic_error(name);
  };
  EXPECT_EQ(parameter("P0").doubted, Doubted::kNo) << "the size of a law is doubted as a whole";
  EXPECT_EQ(parameter("k").doubted, Doubted::kFactor);
  EXPECT_EQ(parameter("x").scatter, 0.03);
  EXPECT_EQ(parameter("x").finding, "friction_law");
  EXPECT_EQ(parameter("k").finding, "heat_source");
  Effect other = e;
  other.set("P0", 200.0);
  EXPECT_DOUBLE_EQ(power_W(other, 6000, {20}), 200.0);
}

TEST(Formula, ComesBackFromItsText) {
  for (const char* text :
       {"{type: formula, node: a, power: \"P0*(n/n0)^1.7*(1 + k*(T_a - T_0))\", P0: 150 W, n0: 6000 rpm, k: 0.01 1/K, T_0: "
        "20 degC, "
        "T_a: {region: b}, known_to: {P0: 20 %}}",
        "{type: formula, surface: s, film: \"h*(1 + n/1000)\", h: 8 W/(m^2 K), to: air, from: 60 s, in: monday}"}) {
    const Effect e = read(text), back = read(yaml_of(e));
    EXPECT_EQ(yaml_of(back), yaml_of(e));
    EXPECT_EQ(back.kind, e.kind) << "entries that declare the same have the same kind";
    EXPECT_EQ(back.values, e.values);
    EXPECT_EQ(back.references, e.references);
    EXPECT_EQ(back.words, e.words);
  }
  EXPECT_NE(heat("P", "P: 1 W").kind, heat("P", "P: 1 kW").kind);
}

TEST(Formula, IsReadAndEvaluatedInManyThreads) {
  std::vector<double> found_W(8, 0.0);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < found_W.size(); ++i) {
    write_file("formula_thread_" + std::to_string(i) + ".yaml",
               "{type: formula, node: a, power: \"P*n/1000 + P*" + std::to_string(i % 4) + "\", P: 1 W}");
  }
  for (std::size_t i = 0; i < found_W.size(); ++i) {
    threads.emplace_back([&found_W, i] {
      for (int k = 0; k < 50; ++k) {
        const auto path = temporary_folder() / ("formula_thread_" + std::to_string(i) + ".yaml");
        found_W[i] = power_W(read_effect(ConfigMap::read_file(path.string())), 2000);
      }
    });
  }
  for (std::thread& t : threads) t.join();
  for (std::size_t i = 0; i < found_W.size(); ++i) EXPECT_DOUBLE_EQ(found_W[i], 2.0 + static_cast<double>(i % 4));
}

// --- what is refused

struct Bad {
  const char* formula;  ///< a '@' before the character that the error points to
  const char* names;
  const char* message;
};
class FormulaErrors : public ::testing::TestWithParam<Bad> {};
TEST_P(FormulaErrors, PointToTheCharacter) {
  std::string formula = GetParam().formula;
  const std::size_t at = formula.find('@');
  formula.erase(at, 1);
  const std::string before = "{type: formula, node: a, power: \"";
  const std::string where = ":1:" + std::to_string(before.size() + at + 1) + ": ";
  EXPECT_THAT([&] { (void)heat(formula, GetParam().names); },
              ThrowsMessage<InputError>(AllOf(HasSubstr(where), HasSubstr(GetParam().message))));
}
INSTANTIATE_TEST_SUITE_P(
    Each, FormulaErrors,
    ::testing::Values(
        Bad{"W*@m", "W: 1 W", "'m' is not known here; known names: n, v_x, v_y, v_z, P_cut, pi, W"},
        Bad{"W*@sqr(2)", "W: 1 W", "no function 'sqr'; there are abs, sqrt, exp"},
        Bad{"W*@", "W: 1 W", "ends where a number, a name or a bracket must follow"},
        Bad{"W*(n/2@", "W: 1 W", "a bracket is not closed"}, Bad{"2 @W", "W: 1 W", "'W' cannot follow here"},
        Bad{"W*@*2", "W: 1 W", "'*' cannot follow here"}, Bad{"n > 1 @? W : 0", "W: 1 W", "write if(condition, then, else)"},
        Bad{"W@, n", "W: 1 W", "one value"}, Bad{"W*n @$ 3", "W: 1 W", "'$' cannot follow here"},
        Bad{"W*n/6000 @rpm", "W: 1 W", "is not known here"},
        Bad{"W*@π", "W: 1 W", "'π' is not known here; names have ASCII letters"},
        Bad{"W*n@²", "W: 1 W", "'²' is not known here"}, Bad{"W @− 2", "W: 1 W", "'−' is not known here"},
        Bad{"W*(n @>= 3)", "W: 1 W", "'>=' is not known here; only the comparisons < and > exist"},
        Bad{"W*(n @== 3)", "W: 1 W", "only the comparisons < and > exist"},
        Bad{"W*(n @!= 3)", "W: 1 W", "only the comparisons < and > exist"},
        Bad{"W*@SIN(1)", "W: 1 W", "Did you mean 'sin'?"}, Bad{"W*@N", "W: 1 W", "Did you mean 'n'?"},
        Bad{"W*@Pi", "W: 1 W", "Did you mean 'pi'?"}, Bad{"W*(n/6000) @+ k", "W: 1 W, k: 1 1/K", "is in W, 'k' is in 1/K"},
        Bad{"W*k*@T_a", "W: 1 W, k: 1 1/K, T_a: a", "'T_a' is a temperature; write the difference"},
        Bad{"G*(T_a @+ T_b)", "G: 1 W/K, T_a: a, T_b: b", "temperatures, which cannot be added"},
        Bad{"G@*(T_a - T_b)", "G: 1 W, T_a: a, T_b: b", "gives a value in W K, but"},
        Bad{"W*exp(@k)", "W: 1 W, k: 1 1/K", "must be a number without unit; 'k' is in 1/K"},
        Bad{"W*(T_a - T_b)@^x", "W: 1 W, x: 2, T_a: a, T_b: b", "must be written as a number"},
        Bad{"@n", "", "gives a number, but a value in W is required"}, Bad{"W@*W", "W: 1 W", "but a value in W is required"},
        Bad{"W*if(@W, 1, 2)", "W: 1 W", "the condition of 'if' must be a number"},
        Bad{"@T_a", "T_a: a", "gives a temperature"}, Bad{"W*kelvin(@W)", "W: 1 W", "take a temperature"}));

struct BadEntry {
  const char* text;
  const char* message;
};
class FormulaEntries : public ::testing::TestWithParam<BadEntry> {};
TEST_P(FormulaEntries, AreRefused) {
  EXPECT_REFUSED(read(GetParam().text), GetParam().message);
}
INSTANTIATE_TEST_SUITE_P(
    Each, FormulaEntries,
    ::testing::Values(
        BadEntry{"{type: formula, node: a}", "requires exactly one formula: power or conductance or film or reading"},
        BadEntry{"{type: formula, node: a, power: \"W\", W: 1 W, film: \"h\"}", "exactly one formula"},
        BadEntry{"{type: formula, node: a, film: \"h\", h: 1 W/(m^2 K)}", "requires another place: surface"},
        BadEntry{"{type: formula, node: a, to: b, power: \"W\", W: 1 W}", "have another end"},
        BadEntry{"{type: formula, node: a, to: a, conductance: \"G\", G: 1 W/K}", "a conductance joins two bodies"},
        BadEntry{"{type: formula, node: ambient, conductance: \"G\", G: 1 W/K}", "a conductance joins two bodies"},
        BadEntry{"{type: formula, node: a, power: \"W\", W: 1 W, knwon_to: 3 %}", "does not use 'knwon_to'"},
        BadEntry{"{type: formula, node: a, power: \"W\", W: 1 W, knwon_to: 3 %}", "Did you mean 'known_to'?"},
        BadEntry{"{type: formula, node: a, power: \"n\", n: 1 W}", "has a meaning in every formula"},
        BadEntry{"{type: formula, node: a, power: \"W\", W: 1 Wat}", "unknown unit 'Wat'"},
        BadEntry{"{type: formula, node: a, power: \"W\", W: [1 W]}", "must be a quantity"},
        BadEntry{"{type: formula, node: a, power: \"W\", W: 1 W, known_to: {V: 3 %}}", "that a diagnosis calibrates: W"},
        BadEntry{"{type: formula, node: a, power: 0, known_to: 3 %}", "has no number that a diagnosis calibrates"},
        BadEntry{"{type: formula, sensor: t, reading: \"T + s*celsius(T)\", s: 1 K}",
                 "differences of the machine's temperatures alone"},
        BadEntry{"{type: formula, sensor: t, reading: \"b\", b: 1 K}", "a temperature is required"},
        BadEntry{"{type: formula, sensor: t, reading: \"T\", T: a}", "'T' is the temperature of the sensor's place"}));

TEST(Formula, ANumberThatIsInfiniteFailsWhereItIsUsed) {
  EXPECT_THAT([] { (void)power_W(heat("P/(a - 3) + P*n/1000", "P: 1 W, a: 3"), 1000); },
              ThrowsMessage<RangeError>(HasSubstr("'P/(a - 3)' is not a finite number")));
  EXPECT_DOUBLE_EQ(power_W(heat("P*((a + 1)*(a - 1))^(1/2 + 1/2)", "P: 1 W, a: 3"), 0), 8.0);
}

struct Undefined {
  const char* formula;
  const char* part;
};
class UndefinedFormulas : public ::testing::TestWithParam<Undefined> {};
/// At standstill. Functions that have a value for an infinite argument or lose NaN must not hide that a part has none.
TEST_P(UndefinedFormulas, FailAtThePart) {
  const Effect e = heat(GetParam().formula, "W: 1 W");
  EXPECT_THAT([&] { (void)power_W(e, 0); },
              ThrowsMessage<RangeError>(HasSubstr("'" + std::string(GetParam().part) + "' is not a finite number")));
}
INSTANTIATE_TEST_SUITE_P(Each, UndefinedFormulas,
                         ::testing::Values(Undefined{"max(0*W, W*sqrt(n - 100))", "sqrt(n - 100)"},
                                           Undefined{"max(W*sqrt(n - 100), 0*W)", "sqrt(n - 100)"},
                                           Undefined{"W*min(3, ln(n - 1))", "ln(n - 1)"},
                                           Undefined{"W*min(ln(n - 1), 3)", "ln(n - 1)"},
                                           Undefined{"W*if(sqrt(n - 100) > 1, 5, 7)", "sqrt(n - 100)"},
                                           Undefined{"W*(1 < ln(n))", "ln(n)"}, Undefined{"W*if(ln(n), 5, 7)", "ln(n)"},
                                           Undefined{"W*tanh(1/n)", "1/n"}, Undefined{"W/(1 + 1/n)", "1/n"},
                                           Undefined{"W*exp(-1/n)", "-1/n"}, Undefined{"W*(1/n)^0", "1/n"},
                                           Undefined{"W*1^ln(n)", "ln(n)"}, Undefined{"W*if(n > 1, 1/n, ln(n))", "ln(n)"},
                                           Undefined{"W*tanh(1/0)*n", "1/0"}));

TEST(Formula, MayLackAValueInThePartOfAnIfThatIsNotChosen) {
  EXPECT_DOUBLE_EQ(power_W(heat("W*if(n > 0, ln(n), 3)", "W: 1 W"), 0), 3.0);
  EXPECT_DOUBLE_EQ(power_W(heat("W*max(1, if(n > 0, 2, 1/n))", "W: 1 W"), 1), 2.0);
}

TEST(Formula, OfAReadingThatFailsSaysWhatItsTemperaturesCountFrom) {
  const Effect e = read("{type: formula, sensor: t, reading: \"T + b*ln((T_air - T)/d)\", b: 1 K, d: 1 K, T_air: ambient}");
  const Cyclogram rest{.name = "rest", .sections = {{20.0, {}}}};
  EXPECT_THAT(
      [&] {
        (void)reading_chain({e}, "rest")
            .apply({"t"}, {"K"}, {0.0}, rest, {{0.0}, {-1.5}}, Eigen::RowVectorXd::Constant(1, 4.0));
      },
      ThrowsMessage<RangeError>(AllOf(HasSubstr("T = 4 K from the reference temperature"),
                                      HasSubstr("T_air = -1.5 K from the reference temperature"))));
}

TEST(Formula, MayBeABlockOfYaml) {
  const Effect line = heat("P *n/1000", "P: 2 W");
  for (const char* block : {"|\n  P *n/1000\n", ">\n  P\n  *n/1000\n"}) {
    const Effect e = read(std::string("type: formula\nnode: a\npower: ") + block + "P: 2 W\n");
    EXPECT_EQ(e.words, line.words);
    EXPECT_EQ(e.kind, line.kind);
  }
}

TEST(Formula, UsesBodiesOfTheListWhereverTheyAre) {
  const auto read_all = [](const std::string& name) {
    const std::string text = "effects:\n  - {type: formula, node: a, power: \"W*T/T\", W: 1 W, T: " + name +
                             "}\n  - {type: node, node: abutment, capacity: 1 J/K}\n";
    return read_effects(ConfigMap::read_file(write_file("formula_list.yaml", text)).maps("effects"));
  };
  // The units of the formula do not fit either; a word that is no body is the reason that comes first.
  EXPECT_REFUSED(read_all("about 5 W"), "'about 5 W' is neither a quantity nor a body; bodies are ambient, abutment");
  EXPECT_REFUSED(read_all("abutmnet"), "Did you mean 'abutment'?");
  EXPECT_REFUSED(read_all("abutment"), "'T' is a temperature");
  EXPECT_REFUSED(read_all("{region: r}"), "'T' is a temperature");
}

TEST(Formula, SaysWhatFailedAndWithWhichValues) {
  const Effect e = heat("P*((T_a - T_b)/d)^0.25", "P: 100 W, d: 2 K, T_a: a, T_b: {region: b}");
  EXPECT_NEAR(power_W(e, 0, {52, 20}), 200.0, 1e-9);
  EXPECT_THAT(
      [&] {
        (void)power_W(e, 0, {20, 21});
      },
      ThrowsMessage<RangeError>(AllOf(HasSubstr("the formula of the power of a"),
                                      HasSubstr("'((T_a - T_b)/d)^0.25' is not a finite number"),
                                      HasSubstr("T_a = 20 degC, T_b = 21 degC, P = 100 W, d = 2 K"))));
  EXPECT_THAT([] { (void)power_W(heat("P/(n - 3000)", "P: 1 W"), 3000); },
              ThrowsMessage<RangeError>(HasSubstr("with n = 3000 rpm, P = 1 W")));
  const Effect film = read("{type: formula, surface: s, film: \"h*(1 - n/1000)\", h: 8 W/(m^2 K)}");
  EXPECT_THAT([&] { (void)heat_balance({film}).exchanges.at(0).coefficient({.drive = {.speed_rpm = 2000}}); },
              ThrowsMessage<RangeError>(HasSubstr("-8 is negative")));
}

}  // namespace
}  // namespace driftwright::effects::formula_test
