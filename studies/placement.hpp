#pragma once
// Finds the places where thermometers predict the drift at the tool best, how many thermometers are worthwhile, and which
// test they need.

#include <optional>
#include <string>
#include <vector>

#include "base/pieces.hpp"
#include "studies/placement_judge.hpp"

namespace driftwright::studies {

/// The predictor for which places are chosen.
enum class PlacedFor { kBoth, kObserver, kRegression };

struct PlacementOptions {
  int n = 0;       ///< number to buy; 0: that of the study, else four, or all places if there are fewer
  int n_most = 8;  ///< largest number in the curve, >= n
  SpotRules where = {};
  std::vector<std::string> mounted = {};           ///< sensors of the scenario that are mounted already and are also used
  std::vector<std::string> channels = {};          ///< displacements; empty: the study's target, else all
  std::vector<std::string> train = {}, test = {};  ///< placement_families()
  PlacedFor placed_for = PlacedFor::kBoth;
  bool any_may_fail = true;
  double noise_K = 0.1;                      ///< of a reading, > 0
  std::vector<double> scatter = {0.1, 0.3};  ///< standard deviations of the logarithm of each factor of the model
};

/// The sets that one way of choosing gives: 1, 2, ... thermometers in addition to the mounted ones.
struct ChosenBy {
  std::string way;                     ///< "chosen", "grey grade", ...
  std::vector<std::vector<int>> sets;  ///< spots; empty if the way has no set of this number
  std::vector<Residual> left;          ///< on machines and cyclograms that were not chosen on
  std::vector<Residual> best = {};     ///< of random sets: the best of each number; `left` is their median
};

/// The effect of losing one thermometer of a set of n: the worst case.
struct LossOfOne {
  std::string way;
  Residual all, worst;
  int worst_for_observer = -1, worst_for_regression = -1;  ///< which one, for each
};

/// A test that a regression could be fitted to, and the drift that then remains.
struct TriedTest {
  std::string programme;
  double duration_s = 0.0;
  Residual left;
};

struct Placement {
  PlacementOptions options;
  std::vector<std::string> channels, regions, left_out, factors;
  std::vector<std::string> chosen_on, judged_on, ambients, made;
  std::vector<Spot> spots;  ///< candidates, the mounted last
  std::vector<int> mounted;
  std::vector<std::string> names;  ///< names of the places of the set of n, as sensors of the scenario
  ChosenBy chosen;                 ///< its sets hold the mounted first
  std::vector<double> objective_um, observer_um, regression_um;  ///< of the chosen sets, with failures; then all working
  std::vector<ChosenBy> others;
  std::optional<ChosenBy> own;        ///< the scenario's own sensors among the candidates, as one set
  std::vector<LossOfOne> losses;      ///< of n
  std::vector<Residual> chosen_lost;  ///< of the chosen sets, without the thermometer whose loss is worst
  std::vector<TriedTest> tests;
  double drift_um = 0.0;         ///< without correction
  Residual without = {};         ///< with no thermometers except the mounted ones
  Eigen::VectorXd told_um = {};  ///< at each node: drift left with one thermometer there; NaN: none allowed
  double told_nothing_um = 0.0;  ///< without any thermometer
  std::string model;             ///< in words
  bool is_linearised = false;
  mesh::Mesh mesh = {};  ///< empty for lumped nodes
};

/// The sets are chosen by ObserverLeft and RegressionLeft over the families, on the model and on machines scattered by
/// options.scatter, and judged by PlacementJudge on other cyclograms and machines.
/// @param pieces  the search, the judging and the drawing, piece by piece. Unless they are kept already, each shard of
/// several also computes what all others need: the runs that are chosen on, and the sets
/// @returns nothing if this is one shard of several
/// @throws InputError  as placement_model() and placement_families(), and for more thermometers than places
[[nodiscard]] std::optional<Placement> place_thermometers(const scenarios::Scenario& scenario,
                                                          const PlacementOptions& options, const Listener& listener,
                                                          const Pieces& pieces = {});

}  // namespace driftwright::studies
