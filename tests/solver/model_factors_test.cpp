// Factors on a model against closed forms of lumped machines, and against sensitivities derived by hand.

#include "solver/model_factors.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <functional>
#include <memory>

#include "solver/propagator.hpp"

namespace driftwright::solver::model_factors_test {
namespace {

using ::testing::ElementsAre, ::testing::HasSubstr, ::testing::ThrowsMessage;

template <class Matrix>
Matrix as(const Eigen::MatrixXd& m) {
  if constexpr (std::is_same_v<Matrix, SparseRow>) {
    return m.sparseView();
  } else {
    return m;
  }
}

constexpr double kAmbient_K = 3.0;
const effects::Inputs kAtWork{.drive = {.speed_rpm = 2000.0}, .ambient_K = kAmbient_K};
const Cyclogram kWork{.name = "work", .sections = {{20000.0, {.speed_rpm = 2000.0}}}};
const TimeSeries kAmbient{{0.0}, {kAmbient_K}};

/// Nodes of 4, 5 and 10 kJ/K. Part "head" is nodes 0 and 1 with 20 W/K between them, "bed" node 2 with nothing to
/// conduct; a joint of 15 W/K from 1 to 2; films of 6 W/K on 0 and, with air 0.7 K warmer than the ambient, 8 W/K on 2;
/// motor into 0, screw into 1. Outputs: T0, T2 with a tenth of the ambient's, and the drift 2, 3 um/K of the head's nodes
/// and 1.5 um/K of the bed's.
template <class Matrix = Eigen::MatrixXd>
ThermalSystem<Matrix> head_and_bed() {
  const auto unit = [](int i) -> Eigen::VectorXd { return Eigen::Vector3d::Unit(i); };
  const Eigen::VectorXd across = unit(0) - unit(1), joint = unit(1) - unit(2);
  ThermalSystem<Matrix> s;
  s.mass = as<Matrix>(Eigen::Vector3d(4e3, 5e3, 10e3).asDiagonal().toDenseMatrix());
  s.conduction = as<Matrix>(20.0 * across * across.transpose());
  s.sources = {{"motor", {}, unit(0), BoundLaw([](const effects::Inputs& u) { return 0.1 * u.drive.speed_rpm; })},
               {"screw", {}, unit(1), BoundLaw([](const effects::Inputs& u) { return 0.03 * u.drive.speed_rpm; })}};
  const auto exchange = [&](const char* name, const Eigen::VectorXd& from, double ambient_sum, double W_K) {
    s.exchanges.push_back({.name = name,
                           .matrix = as<Matrix>(from * from.transpose()),
                           .to_ambient = ambient_sum * from,
                           .ambient_sum = ambient_sum,
                           .coefficient = BoundLaw([W_K](const effects::Inputs&) { return W_K; }),
                           .flow = from});
  };
  exchange("film of the head", unit(0), 1.0, 6.0);
  exchange("film of the bed", unit(2), 1.0, 8.0);
  exchange("joint", joint, 0.0, 15.0);
  s.exchanges[1].offset = 0.7 * unit(2);
  s.exchanges[1].offset_sum = 0.7;
  s.outputs.name = {"T0", "T2", "drift"};
  s.outputs.unit = {"K", "K", "m"};
  s.outputs.state = Eigen::Matrix3d::Zero();
  s.outputs.state.col(0) = unit(0);
  s.outputs.state.col(1) = 0.9 * unit(2);
  s.outputs.state.col(2) = 1e-6 * Eigen::Vector3d(2.0, 3.0, 1.5);
  s.outputs.ambient = Eigen::Vector3d(0.0, 0.1, 0.0);
  s.ones = Eigen::Vector3d::Ones();
  for (const auto& [body, of] :
       {std::pair{"head", Eigen::Vector3d(1.0, 1.0, 0.0)}, {"bed", Eigen::Vector3d(0.0, 0.0, 1.0)}}) {
    const Eigen::Matrix3d diagonal = of.asDiagonal();
    Eigen::MatrixXd outputs = Eigen::Matrix3d::Zero();
    outputs.col(2) = diagonal * s.outputs.state.col(2);
    s.parts.push_back({body, as<Matrix>(diagonal * Eigen::MatrixXd(s.conduction) * diagonal),
                       as<Matrix>(diagonal * Eigen::MatrixXd(s.mass)), outputs});
  }
  return s;
}

/// One node of 4 kJ/K with a film of 6 W/K and 200 W at work, in an ambient at the reference temperature.
ReducedSystem one_node() {
  ReducedSystem s;
  const Eigen::MatrixXd one = Eigen::MatrixXd::Ones(1, 1);
  const Eigen::VectorXd on = Eigen::VectorXd::Ones(1);
  s.mass = 4e3 * one;
  s.conduction = 0.0 * one;
  s.sources = {{"motor", {}, on, BoundLaw([](const effects::Inputs& u) { return 0.1 * u.drive.speed_rpm; })}};
  s.exchanges.push_back({.name = "film",
                         .matrix = one,
                         .to_ambient = on,
                         .ambient_sum = 1.0,
                         .coefficient = BoundLaw([](const effects::Inputs&) { return 6.0; }),
                         .flow = on});
  s.outputs = {{"T"}, {"K"}, one, Eigen::VectorXd::Zero(1)};
  s.ones = on;
  s.parts = {{"node", 0.0 * one, 4e3 * one, 0.0 * one}};
  return s;
}
double rise_K(const ReducedSystem& s, double t_s) {
  return Propagator(s).run(kWork, {{0.0}, {0.0}}, {t_s}, Eigen::VectorXd::Zero(1)).outputs(0, 0);
}

template <class Matrix>
Eigen::MatrixXd k_of(const ThermalSystem<Matrix>& s) {
  Eigen::MatrixXd k = Eigen::MatrixXd(s.conduction);
  for (const auto& e : s.exchanges) k += e.coefficient(kAtWork) * Eigen::MatrixXd(e.matrix);
  return k;
}
template <class Matrix>
Eigen::VectorXd steady_outputs(const ThermalSystem<Matrix>& s) {
  return s.observe(k_of(s).lu().solve(s.load(kAtWork)), kAmbient_K);
}

/// Everything that factors reach, in a row.
template <class Matrix>
std::vector<double> numbers_of(const ThermalSystem<Matrix>& s) {
  std::vector<double> all;
  const auto add = [&](const Eigen::MatrixXd& m) { all.insert(all.end(), m.data(), m.data() + m.size()); };
  add(Eigen::MatrixXd(s.mass));
  add(Eigen::MatrixXd(s.conduction));
  for (const HeatSource& source : s.sources) add(source.load);
  for (const auto& e : s.exchanges) {
    for (const Eigen::MatrixXd& m :
         {Eigen::MatrixXd(e.matrix), Eigen::MatrixXd(e.to_ambient), Eigen::MatrixXd(e.flow), Eigen::MatrixXd(e.offset)})
      add(m);
    all.push_back(e.ambient_sum);
    all.push_back(e.offset_sum);
  }
  for (const auto& p : s.parts) {
    add(Eigen::MatrixXd(p.conduction));
    add(Eigen::MatrixXd(p.mass));
    add(p.outputs);
  }
  add(s.outputs.state);
  add(s.outputs.ambient);
  return all;
}

/// A factor of its own on everything.
ModelFactors all_different(double from) {
  ModelFactors f{.source = {from, from + 0.1},
                 .exchange = {from + 0.2, from + 0.3, from + 0.4},
                 .conductivity = {from + 0.5, from + 0.6},
                 .heat_capacity = {from + 0.7, from + 0.8},
                 .expansion = Eigen::MatrixXd::Ones(2, 3),
                 .output = {from + 0.9, from + 1.0, from + 1.1},
                 .conduction = from + 1.2,
                 .rate = from + 1.3};
  f.expansion.col(2) << from + 1.4, from + 1.5;
  return f;
}
std::vector<double> product(std::vector<double> a, const std::vector<double>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] *= b[i];
  return a;
}

TEST(ModelFactors, OnTheHeatOfOneNodeDoublesItsSteadyRise) {
  const ReducedSystem s = one_node();
  // P/h = 200 W / 6 W/K; after 20000 s = 30 time constants nothing is left of the start.
  EXPECT_NEAR(rise_K(s, 20000.0), 200.0 / 6.0, 1e-10);
  EXPECT_NEAR(rise_K(with_factors(s, {.source = {2.0}}), 20000.0), 2.0 * 200.0 / 6.0, 1e-10);
  EXPECT_NEAR(rise_K(with_factors(s, {.exchange = {2.0}}), 20000.0), 200.0 / (2.0 * 6.0), 1e-10);
}

TEST(ModelFactors, OnTheCapacityOfOneNodeStretchItsTimeConstant) {
  for (const double g : {0.5, 1.0, 1.7}) {
    for (const double t_s : {100.0, 700.0, 3000.0}) {
      const double exact_K = 200.0 / 6.0 * (1.0 - std::exp(-6.0 * t_s / (g * 4e3)));
      EXPECT_NEAR(rise_K(with_factors(one_node(), {.heat_capacity = {g}}), t_s), exact_K, 1e-10);
      EXPECT_NEAR(rise_K(with_factors(one_node(), {.rate = 1.0 / g}), t_s), exact_K, 1e-10);
    }
  }
}

// K(u) stays as it is only as a whole: conduction, films and joint, motor, ambient and stratified air, all have to be
// faster.
TEST(ModelFactors, OnRatesStretchTimeAndLeaveLevels) {
  const ReducedSystem s = head_and_bed(), fast = with_factors(s, {.rate = 1.6});
  const Eigen::VectorXd start = Eigen::Vector3d(1.0, -2.0, 4.0);
  const std::vector<double> time_s = {160.0, 1600.0, 16000.0}, sooner_s = {100.0, 1000.0, 10000.0};
  const Eigen::MatrixXd slow_y = Propagator(s).run(kWork, kAmbient, time_s, start).outputs,
                        fast_y = Propagator(fast).run(kWork, kAmbient, sooner_s, start).outputs;
  EXPECT_LT((slow_y - fast_y).topRows(2).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_LT((slow_y - fast_y).row(2).cwiseAbs().maxCoeff(), 1e-16);
  EXPECT_LT((steady_outputs(s) - steady_outputs(fast)).cwiseAbs().maxCoeff(), 1e-11);
}

TEST(ModelFactors, OnExpansionsAndOutputsScaleWhatIsReadOffTheState) {
  const ReducedSystem s = head_and_bed();
  const Eigen::Vector3d state(10.0, 20.0, 40.0);
  const double ambient_K = 5.0;
  Eigen::MatrixXd expansion = Eigen::MatrixXd::Ones(2, 3);
  expansion.row(0).setConstant(1.1);  // of the head: its 2 * 10 + 3 * 20 um
  const Eigen::VectorXd grown = with_factors(s, {.expansion = expansion}).observe(state, ambient_K);
  EXPECT_NEAR(grown(2), 1e-6 * (1.1 * 80.0 + 60.0), 1e-18);
  EXPECT_EQ(grown(0), 10.0);
  EXPECT_EQ(grown(1), 0.9 * 40.0 + 0.1 * ambient_K);
  const Eigen::VectorXd scaled = with_factors(s, {.output = {1.0, 2.0, 0.5}}).observe(state, ambient_K);
  EXPECT_EQ(scaled(0), 10.0);
  EXPECT_NEAR(scaled(1), 2.0 * (0.9 * 40.0 + 0.1 * ambient_K), 1e-13);
  EXPECT_NEAR(scaled(2), 0.5e-6 * 140.0, 1e-18);
  expansion.setOnes();
  expansion(1, 2) = 3.0;  // after a factor on the output, parts are still what it consists of
  EXPECT_NEAR(
      with_factors(with_factors(s, {.output = {1.0, 2.0, 0.5}}), {.expansion = expansion}).observe(state, ambient_K)(2),
      0.5e-6 * (80.0 + 3.0 * 60.0), 1e-18);
}

TEST(ModelFactors, NameAndTakeFlowsInOneOrder) {
  const ReducedSystem s = head_and_bed();
  EXPECT_THAT(flow_names(s), ElementsAre("motor", "screw", "film of the head", "film of the bed", "joint"));
  const std::vector<double> factor = {1.0, 2.0, 3.0, 4.0, 5.0};
  const ModelFactors f = flow_factors(s, factor);
  EXPECT_THAT(f.source, ElementsAre(1.0, 2.0));
  EXPECT_THAT(f.exchange, ElementsAre(3.0, 4.0, 5.0));
  EXPECT_THAT([&] { (void)flow_factors(s, std::vector<double>(4, 1.0)); },
              ThrowsMessage<std::logic_error>(HasSubstr("4 factors for 5 flows")));
}

template <class Matrix>
class ModelFactorsOf : public ::testing::Test {};
using BothMatrices = ::testing::Types<SparseRow, Eigen::MatrixXd>;
TYPED_TEST_SUITE(ModelFactorsOf, BothMatrices);

TYPED_TEST(ModelFactorsOf, OneLeaveEveryBitAlone) {
  const ThermalSystem<TypeParam> s = head_and_bed<TypeParam>();
  EXPECT_EQ(numbers_of(with_factors(s, {})), numbers_of(s));
  const ModelFactors ones{.source = {1.0, 1.0},
                          .exchange = {1.0, 1.0, 1.0},
                          .conductivity = {1.0, 1.0},
                          .heat_capacity = {1.0, 1.0},
                          .expansion = Eigen::MatrixXd::Ones(2, 3),
                          .output = {1.0, 1.0, 1.0}};
  EXPECT_EQ(numbers_of(with_factors(s, ones)), numbers_of(s));
}

TYPED_TEST(ModelFactorsOf, OneAfterTheOtherAreTheirProduct) {
  const ThermalSystem<TypeParam> s = head_and_bed<TypeParam>();
  const ModelFactors a = all_different(0.6), b = all_different(1.3);
  const ModelFactors both{.source = product(a.source, b.source),
                          .exchange = product(a.exchange, b.exchange),
                          .conductivity = product(a.conductivity, b.conductivity),
                          .heat_capacity = product(a.heat_capacity, b.heat_capacity),
                          .expansion = a.expansion.cwiseProduct(b.expansion),
                          .output = product(a.output, b.output),
                          .conduction = a.conduction * b.conduction,
                          .rate = a.rate * b.rate};
  const std::vector<double> twice = numbers_of(with_factors(with_factors(s, a), b)),
                            once = numbers_of(with_factors(s, both)), before = numbers_of(s);
  ASSERT_EQ(twice.size(), once.size());
  for (std::size_t i = 0; i < once.size(); ++i) {
    EXPECT_NEAR(twice[i], once[i], 1e-14 * std::abs(once[i]));  // a few roundings of numbers of one sign
    EXPECT_TRUE(before[i] == 0.0 || std::abs(once[i] / before[i] - 1.0) > 0.05) << "a factor does not reach number " << i;
  }
}

// With θ = K^-1 f: a source's factor moves θ by K^-1 P b, an exchange's by K^-1 c (g θ_ambient + o - G θ), conduction's
// by -K^-1 K0 θ.
TYPED_TEST(ModelFactorsOf, SensitivitiesOfTheSteadyOutputsAreThoseDerivedByHand) {
  const ThermalSystem<TypeParam> s = head_and_bed<TypeParam>();
  const Eigen::MatrixXd inverse = k_of(s).inverse(), l = s.outputs.state;
  const Eigen::VectorXd theta = inverse * s.load(kAtWork), none = Eigen::VectorXd::Zero(3);
  const auto by_heat = [&](const Eigen::VectorXd& heat_W) -> Eigen::VectorXd { return l.transpose() * (inverse * heat_W); };
  struct Case {
    const char* name;
    std::function<void(ModelFactors&, double)> set;
    Eigen::VectorXd exact;
  };
  std::vector<Case> cases;
  for (std::size_t i = 0; i < s.sources.size(); ++i) {
    cases.push_back({s.sources[i].name.c_str(),
                     [i](ModelFactors& f, double x) {
                       f.source.assign(2, 1.0);
                       f.source[i] = x;
                     },
                     by_heat(s.sources[i].power_W(kAtWork) * s.sources[i].load)});
  }
  for (std::size_t i = 0; i < s.exchanges.size(); ++i) {
    const auto& e = s.exchanges[i];
    Eigen::VectorXd into = kAmbient_K * e.to_ambient - Eigen::MatrixXd(e.matrix) * theta;
    if (e.offset.size() > 0) into += e.offset;
    cases.push_back({e.name.c_str(),
                     [i](ModelFactors& f, double x) {
                       f.exchange.assign(3, 1.0);
                       f.exchange[i] = x;
                     },
                     by_heat(e.coefficient(kAtWork) * into)});
  }
  const Eigen::VectorXd by_conduction = by_heat(-(Eigen::MatrixXd(s.conduction) * theta));
  cases.push_back({"conduction", [](ModelFactors& f, double x) { f.conduction = x; }, by_conduction});
  cases.push_back({"conductivity of the head", [](ModelFactors& f, double x) { f.conductivity = {x, 1.0}; }, by_conduction});
  cases.push_back({"conductivity of the bed", [](ModelFactors& f, double x) { f.conductivity = {1.0, x}; }, none});
  cases.push_back({"heat capacity of the bed", [](ModelFactors& f, double x) { f.heat_capacity = {1.0, x}; }, none});
  cases.push_back({"rate", [](ModelFactors& f, double x) { f.rate = x; }, none});
  cases.push_back({"expansion of the head",
                   [](ModelFactors& f, double x) {
                     f.expansion.setOnes(2, 3);
                     f.expansion.row(0).setConstant(x);
                   },
                   Eigen::Vector3d(0.0, 0.0, 1e-6 * (2.0 * theta(0) + 3.0 * theta(1)))});
  cases.push_back({"drift",
                   [](ModelFactors& f, double x) {
                     f.output = {1.0, 1.0, x};
                   },
                   Eigen::Vector3d(0.0, 0.0, s.observe(theta, kAmbient_K)(2))});
  constexpr double kStep = 1e-4;  // central: its square of the third derivative, 1e-8, beside 1e-16 / 1e-4 of rounding
  for (const Case& c : cases) {
    ModelFactors more, less;
    c.set(more, 1.0 + kStep);
    c.set(less, 1.0 - kStep);
    const Eigen::VectorXd found =
        (steady_outputs(with_factors(s, more)) - steady_outputs(with_factors(s, less))) / (2.0 * kStep);
    EXPECT_LT((found - c.exact).template head<2>().norm(), 1e-6) << c.name;
    EXPECT_LT(std::abs(found(2) - c.exact(2)), 1e-12) << c.name;
    EXPECT_TRUE(c.exact == none || c.exact.cwiseAbs()(2) > 1e-7) << c.name << " has nothing to find";
  }
}

TEST(ModelFactors, RefuseListsOfAnotherLength) {
  const ReducedSystem s = head_and_bed();
  const auto refuses = [&](const ModelFactors& f, const char* words) {
    EXPECT_THAT([&] { (void)with_factors(s, f); }, ThrowsMessage<std::logic_error>(HasSubstr(words))) << words;
  };
  refuses({.source = {1.0}}, "1 factors for 2 heat sources");
  refuses({.exchange = {1.0}}, "1 factors for 3 films, joints and links");
  refuses({.conductivity = {1.0}}, "1 factors for 2 parts that conduct");
  refuses({.heat_capacity = {1.0, 1.0, 1.0}}, "3 factors for 2 parts that store heat");
  refuses({.expansion = Eigen::MatrixXd::Ones(1, 3)}, "1 factors for 2 parts that expand");
  refuses({.expansion = Eigen::MatrixXd::Ones(2, 1)}, "1 factors for 3 outputs of an expansion");
  refuses({.output = {1.0}}, "1 factors for 3 outputs");
}

/// Radiation or varying conduction of no strength.
class Term : public NonlinearTerm {
 public:
  explicit Term(bool radiates) : NonlinearTerm("term"), radiates_(radiates) {}
  void add_heat_out(const double*, double, double*) const override {}
  void add_tangent(const double*, double, SparseRow&) const override {}
  [[nodiscard]] bool is_flow() const override { return radiates_; }

 private:
  bool radiates_;
};

TEST(ModelFactors, RefuseWhatMatricesAloneCannotSay) {
  FullSystem s = head_and_bed<SparseRow>();
  s.nonlinear = {std::make_shared<Term>(true)};
  EXPECT_THAT([&] { (void)with_factors(s, {.rate = 2.0}); }, ThrowsMessage<std::logic_error>(HasSubstr("nonlinear terms")));
  (void)with_factors(s, {.source = {2.0, 2.0}, .conductivity = {2.0, 1.0}, .heat_capacity = {2.0, 1.0}, .conduction = 2.0});
  s.nonlinear = {std::make_shared<Term>(false)};
  const auto says = ThrowsMessage<std::logic_error>(HasSubstr("conductivity that varies"));
  EXPECT_THAT([&] { (void)with_factors(s, {.conduction = 2.0}); }, says);
  EXPECT_THAT([&] { (void)with_factors(s, {.conductivity = {2.0, 1.0}}); }, says);
  (void)with_factors(s, {.source = {2.0, 2.0}, .conductivity = {1.0, 1.0}});
  s.nonlinear.clear();
  s.capacity = std::make_shared<VariableCapacity>();
  EXPECT_THAT(
      [&] {
        (void)with_factors(s, {.heat_capacity = {2.0, 1.0}});
      },
      ThrowsMessage<std::logic_error>(HasSubstr("heat capacity")));
  (void)with_factors(s, {.heat_capacity = {1.0, 1.0}, .rate = 2.0});
}

}  // namespace
}  // namespace driftwright::solver::model_factors_test
