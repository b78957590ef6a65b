#pragma once
// Where on a machine thermometers tell most of the drift at the tool, how many are worth their money, and which test they need.

#include <optional>
#include <string>
#include <vector>

#include "base/pieces.hpp"
#include "studies/placement_judge.hpp"

namespace driftwright::studies {

/// For whom places are chosen.
enum class PlacedFor { kBoth, kObserver, kRegression };

struct PlacementOptions {
  int n = 0;                               ///< that are to be bought; 0: those of the study, else four, or all places if there are fewer
  int n_most = 8;                          ///< up to which the curve goes, >= n
  SpotRules where = {};
  std::vector<std::string> mounted = {};   ///< sensors of the scenario that are there already, and used beside
  std::vector<std::string> channels = {};  ///< displacements; empty: the study's target, else all
  std::vector<std::string> train = {}, test = {};  ///< placement_families()
  PlacedFor placed_for = PlacedFor::kBoth;
  bool any_may_fail = true;
  double noise_K = 0.1;                    ///< of a reading, > 0
  std::vector<double> scatter = {0.1, 0.3};  ///< 1 sigma of the logarithm of each factor that the model may be wrong by
};

/// Sets of one way to choose them, of 1, 2, ... thermometers beside those that are mounted.
struct ChosenBy {
  std::string way;                      ///< "chosen", "grey grade", ...
  std::vector<std::vector<int>> sets;   ///< spots; empty where the way has none of so many
  std::vector<Residual> left;           ///< on what was not chosen on
  std::vector<Residual> best = {};      ///< of several sets of a number, as random ones: the best of each, known behindhand; `left` is their median
};

/// What the loss of one of the sets of n does: the worst of them.
struct LossOfOne {
  std::string way;
  Residual all, worst;
  int worst_for_observer = -1, worst_for_regression = -1;  ///< which one's
};

/// A test that a regression could be fitted to, and what it then leaves.
struct TriedTest {
  std::string programme;
  double duration_s = 0.0;
  Residual left;
};

struct Placement {
  PlacementOptions options;
  std::vector<std::string> channels, regions, left_out, factors;
  std::vector<std::string> chosen_on, judged_on, ambients, made;
  std::vector<Spot> spots;             ///< candidates, the mounted last
  std::vector<int> mounted;
  std::vector<std::string> names;      ///< of the places of the set of n, as sensors of the scenario
  ChosenBy chosen;                     ///< its sets hold the mounted first
  std::vector<double> objective_um, observer_um, regression_um;  ///< of the chosen sets, as designed: with what may fail; all there
  std::vector<ChosenBy> others;
  std::optional<ChosenBy> own;         ///< all of the scenario's sensors that are candidates' equals, one set
  std::vector<LossOfOne> losses;       ///< of n
  std::vector<Residual> chosen_lost;   ///< of the chosen sets, without the one whose loss is worst
  std::vector<TriedTest> tests;
  double drift_um = 0.0;               ///< without correction
  Residual without = {};                    ///< without thermometers beside those mounted
  Eigen::VectorXd told_um = {};             ///< of each node of the mesh: what one thermometer there leaves, as designed; NaN where none may sit
  double told_nothing_um = 0.0;        ///< without any
  std::string model;                   ///< in words
  bool is_linearised = false;
  mesh::Mesh mesh = {};                     ///< empty for lumped nodes
};

/// The sets are chosen by ObserverLeft and RegressionLeft over the families, on the model and machines scattered by options.scatter, and judged by PlacementJudge on
/// other cyclograms and machines.
/// @param pieces  what is looked for, judged and drawn, piece by piece. Each shard of several works out what all the others need too, unless it is kept
///                already: the runs that are chosen on, and the sets
/// @returns nothing where this is one shard of several
/// @throws InputError  as placement_model() and placement_families(), for more thermometers than places
[[nodiscard]] std::optional<Placement> place_thermometers(const scenarios::Scenario& scenario, const PlacementOptions& options,
                                                          const Listener& listener, const Pieces& pieces = {});

}  // namespace driftwright::studies
