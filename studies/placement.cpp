#include "studies/placement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <numeric>

#include "compensation/sensors/exchange_search.hpp"
#include "mesh/machine_skin.hpp"
#include "studies/placement_rivals.hpp"
#include "studies/placement_tests.hpp"

namespace driftwright::studies {
namespace {

using compensation::DriftLeft;
using Sets = std::vector<std::vector<int>>;

constexpr int kUsual = 4, kMostUnasked = 8;        // thermometers, where nobody says how many
constexpr int kRows = 36;                          // of each run that is chosen on
constexpr double kJudgedRow_s = 300.0;
constexpr int kBlock = 250;                        // nodes of the picture at once
const std::vector<int> kDesignSeeds = {1, 2, 3};   // machines that regressions are chosen on, of each scatter
const std::vector<int> kJudgedSeeds = {1001, 1002};

/// Runs that are chosen on, as all candidates need them.
struct DesignRuns {
  const std::vector<PlacementRun>& runs;
  std::vector<std::vector<Eigen::MatrixXd>> by_factor, scattered;
};

/// The three criteria of one list of candidates.
struct Criteria {
  compensation::ObserverLeft observer;
  compensation::RegressionLeft regression;
  compensation::LeftOfBoth both;

  Criteria(const PlacementModel& model, const DesignRuns& design, const PlacementOptions& how, const Eigen::MatrixXd& rows,
           const Eigen::VectorXd& ambient)
      : observer(sensitivities(model, design.runs, design.by_factor, how.noise_K, rows), how.scatter),
        regression(scattered_runs(model, design.runs, design.scattered, rows, ambient), how.noise_K),
        both(observer, regression) {}
  Criteria(const Criteria&) = delete;
  Criteria& operator=(const Criteria&) = delete;
  [[nodiscard]] const DriftLeft& of(PlacedFor placed_for) const {
    if (placed_for == PlacedFor::kObserver) return observer;
    if (placed_for == PlacedFor::kRegression) return regression;
    return both;
  }
};

std::vector<std::string> names_of(const std::vector<Cyclogram>& cyclograms) {
  std::vector<std::string> names;
  for (const Cyclogram& c : cyclograms) names.push_back(c.name);
  return names;
}

/// Corners of cells.
std::vector<bool> corners_of(const mesh::Mesh& mesh) {
  std::vector<bool> is_corner(static_cast<std::size_t>(mesh.n_nodes()));
  for (int c = 0; c < mesh.cells.size(); ++c) {
    const auto n_corners = static_cast<std::size_t>(mesh::n_corners_of(mesh.cells.shape[static_cast<std::size_t>(c)]));
    for (int node : mesh.cells.nodes(c).first(n_corners)) is_corner[static_cast<std::size_t>(node)] = true;
  }
  return is_corner;
}

/// Mid-side nodes of the skin as the mean of the corners beside them.
void fill_mid_sides(Eigen::VectorXd& told_um, const mesh::MachineSkin& skin, const std::vector<bool>& is_corner) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(told_um.size()), n = sum;
  for (const auto& triangle : skin.triangle) {
    for (int mid : triangle) {
      if (is_corner[static_cast<std::size_t>(mid)]) continue;
      for (int corner : triangle) {
        if (!is_corner[static_cast<std::size_t>(corner)]) continue;
        sum[mid] += told_um[corner];
        n[mid] += 1.0;
      }
    }
  }
  for (Eigen::Index node = 0; node < told_um.size(); ++node) {
    if (n[node] > 0.0) told_um[node] = sum[node] / n[node];
  }
}

/// What one thermometer at each node leaves; NaN at nodes inside, and of regions that may carry none.
Eigen::VectorXd told_everywhere(const PlacementModel& model, const DesignRuns& design, const PlacementOptions& how,
                                const Listener& listener) {
  const scenarios::ReducedMachine& machine = *model.opened.reduced();
  const mesh::MachineSkin skin = mesh::skin_of(machine.mesh);
  const std::vector<bool> is_corner = corners_of(machine.mesh);
  std::vector<int> nodes;
  for (std::size_t i = 0; i < skin.triangle.size(); ++i) {
    const std::string& region = machine.mesh.regions[static_cast<std::size_t>(skin.region[i])];
    if (std::find(model.regions.begin(), model.regions.end(), region) == model.regions.end()) continue;
    for (int node : skin.triangle[i]) {
      if (is_corner[static_cast<std::size_t>(node)]) nodes.push_back(node);
    }
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  Eigen::VectorXd told = Eigen::VectorXd::Constant(machine.mesh.n_nodes(), std::numeric_limits<double>::quiet_NaN());
  const std::vector<int> mounted = model.mounted();
  const auto n_mounted = static_cast<Eigen::Index>(mounted.size());
  std::vector<int> beside(mounted.size());
  std::iota(beside.begin(), beside.end(), 0);
  for (std::size_t first = 0; first < nodes.size() && !listener.wants_end(); first += kBlock) {
    const auto n = static_cast<Eigen::Index>(std::min<std::size_t>(kBlock, nodes.size() - first));
    Eigen::MatrixXd rows(n_mounted + n, model.rows.cols());
    Eigen::VectorXd ambient = Eigen::VectorXd::Zero(n_mounted + n);
    rows.topRows(n_mounted) = model.rows(mounted, Eigen::all);
    ambient.head(n_mounted) = model.ambient(mounted);
    for (Eigen::Index i = 0; i < n; ++i)
      rows.row(n_mounted + i) = machine.temperature.row(nodes[first + static_cast<std::size_t>(i)]).cast<double>();
    const Criteria criteria(model, design, how, rows, ambient);
    const std::vector<double> left = criteria.of(how.placed_for).with_each(beside);
    for (Eigen::Index i = 0; i < n; ++i) told[nodes[first + static_cast<std::size_t>(i)]] = left[static_cast<std::size_t>(n_mounted + i)];
    listener.share(static_cast<double>(first) / static_cast<double>(nodes.size()));
  }
  fill_mid_sides(told, skin, is_corner);
  return told;
}

/// Names for sensors at the places of a set: p1, p2, ..., past those that the scenario has.
std::vector<std::string> new_names(const scenarios::Scenario& scenario, std::size_t n) {
  std::vector<std::string> taken;
  for (const auto& s : scenario.machine->sensors) taken.push_back(s.name);
  for (const auto& d : scenario.machine->displacements) taken.push_back(d.name);
  for (const auto& t : scenario.machine->tilts) taken.push_back(t.name);
  std::vector<std::string> names;
  for (int i = 1; names.size() < n; ++i) {
    std::string name = fmt::format("p{}", i);
    if (std::find(taken.begin(), taken.end(), name) == taken.end()) names.push_back(std::move(name));
  }
  return names;
}

/// Residuals of all sets, each judged once.
class JudgedOnce {
 public:
  explicit JudgedOnce(const PlacementJudge& judge) : judge_(judge) {}
  std::vector<Residual> of(const Sets& sets) {
    Sets unknown;
    for (std::vector<int> set : sets) {
      std::sort(set.begin(), set.end());
      if (!known_.contains(set) && std::find(unknown.begin(), unknown.end(), set) == unknown.end()) unknown.push_back(set);
    }
    const std::vector<Residual> left = judge_.of(unknown);
    for (std::size_t i = 0; i < unknown.size(); ++i) known_[unknown[i]] = left[i];
    std::vector<Residual> all;
    for (std::vector<int> set : sets) {
      std::sort(set.begin(), set.end());
      all.push_back(known_.at(set));
    }
    return all;
  }

 private:
  const PlacementJudge& judge_;
  std::map<std::vector<int>, Residual> known_;
};

LossOfOne loss_of_one(JudgedOnce& judge, const std::string& way, const std::vector<int>& set, std::size_t n_mounted) {
  Sets sets = {set};
  for (std::size_t i = n_mounted; i < set.size(); ++i) {
    sets.push_back(set);
    sets.back().erase(sets.back().begin() + static_cast<std::ptrdiff_t>(i));
  }
  const std::vector<Residual> left = judge.of(sets);
  LossOfOne loss{.way = way, .all = left.front(), .worst = {}};
  for (std::size_t i = 1; i < left.size(); ++i) {
    const int lost = set[n_mounted + i - 1];
    if (left[i].observer_um > loss.worst.observer_um) {
      loss.worst.observer_um = left[i].observer_um;
      loss.worst_for_observer = lost;
    }
    if (left[i].regression_um > loss.worst.regression_um) {
      loss.worst.regression_um = left[i].regression_um;
      loss.worst_for_regression = lost;
    }
  }
  return loss;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

/// Random sets of each number as one way: medians, and the best.
ChosenBy of_random(const std::vector<Residual>& left, int n_most) {
  ChosenBy by{.way = "random", .sets = Sets(static_cast<std::size_t>(n_most)), .left = {}};
  for (int n = 0; n < n_most; ++n) {
    std::vector<double> observer_um, regression_um;
    for (int k = 0; k < kRandomSets; ++k) {
      observer_um.push_back(left[static_cast<std::size_t>(n * kRandomSets + k)].observer_um);
      regression_um.push_back(left[static_cast<std::size_t>(n * kRandomSets + k)].regression_um);
    }
    by.left.push_back({median(observer_um), median(regression_um)});
    by.best.push_back({*std::min_element(observer_um.begin(), observer_um.end()), *std::min_element(regression_um.begin(), regression_um.end())});
  }
  return by;
}

}  // namespace

Placement place_thermometers(const scenarios::Scenario& scenario, const PlacementOptions& asked, const Listener& listener) {
  PlacementOptions how = asked;
  const PlacementFamilies families = placement_families(scenario, how.train, how.test);
  std::vector<const Cyclogram*> cyclograms;
  for (const auto* list : {&families.chosen_on, &families.judged_on}) {
    for (const Cyclogram& c : *list) cyclograms.push_back(&c);
  }
  const PlacementModel model = placement_model(scenario, cyclograms, how.where, how.mounted, how.channels, listener);
  if (how.n == 0) how.n = std::min({scenario.study ? scenario.study->sensors_to_choose : kUsual, kMostUnasked, model.n_free()});
  if (how.n > model.n_free())
    throw InputError(fmt::format("{} thermometers are to be placed, and there are {} places for them", how.n, model.n_free()));
  how.n_most = std::min(std::max(how.n, how.n_most), model.n_free());
  const std::vector<int> mounted = model.mounted();
  const std::vector<PlacementRun> chosen_on = runs_in_all_ambients(scenario, families.chosen_on, families.ambients, kRows);
  listener.begin(fmt::format("{} places in {} runs", model.n_free(), chosen_on.size()));
  const DesignRuns design{chosen_on, factor_states(model, chosen_on), scattered_states(model, chosen_on, how.scatter, kDesignSeeds)};
  const Criteria criteria(model, design, how, model.rows.topRows(model.n_candidates), model.ambient.head(model.n_candidates));
  const DriftLeft& whole = criteria.of(how.placed_for);
  const compensation::LeftWithLoss with_loss(whole, mounted);
  const DriftLeft& objective = how.any_may_fail ? static_cast<const DriftLeft&>(with_loss) : whole;
  Placement placement{.options = how,
                      .channels = model.channels,
                      .regions = model.regions,
                      .left_out = model.left_out,
                      .factors = factor_names(model),
                      .chosen_on = names_of(families.chosen_on),
                      .judged_on = names_of(families.judged_on),
                      .ambients = {},
                      .made = families.made,
                      .spots = model.spots,
                      .mounted = mounted,
                      .names = new_names(scenario, static_cast<std::size_t>(how.n)),
                      .chosen = {.way = "chosen", .sets = {}, .left = {}},
                      .objective_um = {},
                      .observer_um = {},
                      .regression_um = {},
                      .others = {},
                      .own = {},
                      .losses = {},
                      .chosen_lost = {},
                      .tests = {},
                      .told_um = {},
                      .model = model.opened.words(),
                      .is_linearised = model.is_linearised,
                      .mesh = {}};
  for (const auto& ambient : families.ambients) placement.ambients.push_back(ambient.name);
  listener.begin("choosing");
  for (const compensation::ThermometerSet& set : compensation::best_sets(objective, how.n_most, mounted, listener)) {
    placement.chosen.sets.push_back(set.members);
    placement.objective_um.push_back(set.left_um);
    placement.observer_um.push_back(criteria.observer.of(set.members));
    placement.regression_um.push_back(criteria.regression.of(set.members));
  }
  placement.told_nothing_um = whole.of(mounted);
  placement.others = rival_places(model, chosen_on, how.n_most, how.noise_K);
  const Sets random = random_places(model, how.n_most);
  std::vector<int> own = mounted;
  for (int i = model.n_candidates; i < static_cast<int>(model.spots.size()); ++i) own.push_back(i);

  listener.begin("judging on other cyclograms and machines");
  std::vector<int> used = own;
  const auto use = [&](const Sets& sets) {
    for (const std::vector<int>& set : sets) used.insert(used.end(), set.begin(), set.end());
  };
  use(placement.chosen.sets);
  for (const ChosenBy& other : placement.others) use(other.sets);
  use(random);
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  const PlacementJudge judge(model, chosen_on, runs_in_turn(scenario, families.judged_on, families.ambients, kJudgedRow_s), used, how.scatter,
                             kJudgedSeeds, how.noise_K);
  placement.drift_um = judge.drift_um();
  JudgedOnce judged(judge);
  placement.without = judged.of({mounted}).front();
  placement.chosen.left = judged.of(placement.chosen.sets);
  const auto at_n = static_cast<std::size_t>(how.n) - 1;
  placement.losses.push_back(loss_of_one(judged, "chosen", placement.chosen.sets[at_n], mounted.size()));
  for (const std::vector<int>& set : placement.chosen.sets)
    placement.chosen_lost.push_back(loss_of_one(judged, "chosen", set, mounted.size()).worst);
  for (ChosenBy& other : placement.others) {
    other.left = judged.of(other.sets);
    if (!other.sets[at_n].empty()) placement.losses.push_back(loss_of_one(judged, other.way, other.sets[at_n], mounted.size()));
  }
  placement.others.push_back(of_random(judged.of(random), how.n_most));
  if (own.size() > mounted.size()) placement.own = ChosenBy{.way = "the scenario's own", .sets = {own}, .left = judged.of({own})};

  listener.begin("tests of it");
  placement.tests = tried_tests(scenario, judge, placement.chosen.sets[at_n], listener);
  const scenarios::ReducedMachine& machine = *model.opened.reduced();
  if (machine.mesh.n_nodes() > 0) {
    listener.begin("the picture");
    placement.told_um = told_everywhere(model, design, how, listener);
    placement.mesh = machine.mesh;
  }
  return placement;
}

}  // namespace driftwright::studies
