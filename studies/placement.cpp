// The course of one study, in its order: candidates, choice, rivals, judgement. What it computes with is in placement_*.
#include "studies/placement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <numeric>

#include "base/lists.hpp"
#include "compensation/sensors/exchange_search.hpp"
#include "mesh/machine_skin.hpp"
#include "studies/placement_rivals.hpp"
#include "studies/placement_tests.hpp"

namespace driftwright::studies {
namespace {

using compensation::DriftLeft;
using Sets = std::vector<std::vector<int>>;

constexpr int kUsual = 4, kMostUnasked = 8;  // thermometers, if no number is given
constexpr int kRows = 36;                    // of each run that is used for the choice
constexpr double kJudgedRow_s = 300.0;
constexpr std::size_t kBlock = 250;               // nodes of the picture per block
const std::vector<int> kDesignSeeds = {1, 2, 3};  // machines for the choice of regressions, for each scatter
const std::vector<int> kJudgedSeeds = {1001, 1002};
/// First numbers of the pieces of each stage.
constexpr std::size_t kSearch = 0, kChosen = 1'000'000, kRivals = 1'000'001, kJudged = 2'000'000, kTests = 3'000'000,
                      kPicture = 4'000'000;

/// The runs used for the choice, with the data that all candidates need.
struct DesignRuns {
  const std::vector<MachineRun>& runs;
  std::size_t n_ambients = 0;  ///< number of runs of each cyclogram
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
        regression(scattered_runs(model, design.runs, design.n_ambients, design.scattered, rows, ambient), how.noise_K),
        both(observer, regression) {}
  Criteria(const Criteria&) = delete;
  Criteria& operator=(const Criteria&) = delete;
  [[nodiscard]] const DriftLeft& of(PlacedFor placed_for) const {
    if (placed_for == PlacedFor::kObserver) return observer;
    if (placed_for == PlacedFor::kRegression) return regression;
    return both;
  }
};

/// Whether a node is a corner of a cell.
std::vector<bool> corners_of(const mesh::Mesh& mesh) {
  std::vector<bool> is_corner(static_cast<std::size_t>(mesh.n_nodes()));
  for (int c = 0; c < mesh.cells.size(); ++c) {
    const auto n_corners = static_cast<std::size_t>(mesh::n_corners_of(mesh.cells.shape[static_cast<std::size_t>(c)]));
    for (int node : mesh.cells.nodes(c).first(n_corners)) is_corner[static_cast<std::size_t>(node)] = true;
  }
  return is_corner;
}

/// Sets mid-side nodes of the skin to the mean of their neighbouring corners.
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

/// Outer nodes at corners of cells that may carry a thermometer.
std::vector<int> nodes_to_draw(const PlacementModel& model, const mesh::MachineSkin& skin,
                               const std::vector<bool>& is_corner) {
  const mesh::Mesh& mesh = model.opened.reduced()->mesh;
  std::vector<int> nodes;
  for (std::size_t i = 0; i < skin.triangle.size(); ++i) {
    const std::string& region = mesh.regions[static_cast<std::size_t>(skin.region[i])];
    if (std::find(model.regions.begin(), model.regions.end(), region) == model.regions.end()) continue;
    for (int node : skin.triangle[i]) {
      if (is_corner[static_cast<std::size_t>(node)]) nodes.push_back(node);
    }
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

/// The drift left with one thermometer at each of these nodes.
Pieces::Numbers told_at(const PlacementModel& model, const DesignRuns& design, const PlacementOptions& how,
                        std::span<const int> nodes) {
  const scenarios::ReducedMachine& machine = *model.opened.reduced();
  const std::vector<int> mounted = model.mounted();
  const auto n_mounted = static_cast<Eigen::Index>(mounted.size()), n = static_cast<Eigen::Index>(nodes.size());
  std::vector<int> beside(mounted.size());
  std::iota(beside.begin(), beside.end(), 0);
  Eigen::MatrixXd rows(n_mounted + n, model.rows.cols());
  Eigen::VectorXd ambient = Eigen::VectorXd::Zero(n_mounted + n);
  rows.topRows(n_mounted) = model.rows(mounted, Eigen::all);
  ambient.head(n_mounted) = model.ambient(mounted);
  for (Eigen::Index i = 0; i < n; ++i)
    rows.row(n_mounted + i) = machine.temperature.row(nodes[static_cast<std::size_t>(i)]).cast<double>();
  const Criteria criteria(model, design, how, rows, ambient);
  const std::vector<double> left = criteria.of(how.placed_for).with_each(beside);
  return {left.begin() + n_mounted, left.end()};
}

/// The drift left with one thermometer at each node; NaN at inner nodes, and in regions that may carry none.
Eigen::VectorXd told_everywhere(const PlacementModel& model, const std::function<const DesignRuns&()>& design,
                                const PlacementOptions& how, const Pieces& pieces, const Listener& listener) {
  const mesh::Mesh& mesh = model.opened.reduced()->mesh;
  const mesh::MachineSkin skin = mesh::skin_of(mesh);
  const std::vector<bool> is_corner = corners_of(mesh);
  const std::vector<int> nodes = nodes_to_draw(model, skin, is_corner);
  Eigen::VectorXd told = Eigen::VectorXd::Constant(mesh.n_nodes(), std::numeric_limits<double>::quiet_NaN());
  const std::size_t n_blocks = (nodes.size() + kBlock - 1) / kBlock;
  for (std::size_t block = 0; block < n_blocks && !listener.wants_end(); ++block) {  // each block uses all cores
    if (!pieces.shard.has(block)) continue;
    const std::span<const int> of_block =
        std::span(nodes).subspan(block * kBlock, std::min(kBlock, nodes.size() - block * kBlock));
    const Pieces::Numbers left = pieces.of(block, [&] { return told_at(model, design(), how, of_block); });
    for (std::size_t i = 0; i < of_block.size(); ++i) told[of_block[i]] = left[i];
    listener.share(static_cast<double>(block) / static_cast<double>(n_blocks));
  }
  fill_mid_sides(told, skin, is_corner);
  return told;
}

/// Names for sensors at the places of a set: p1, p2, ..., skipping those in the scenario.
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

std::vector<int> sorted(std::vector<int> set) {
  std::sort(set.begin(), set.end());
  return set;
}

/// A set, and the set without each thermometer that is not mounted.
Sets with_losses(const std::vector<int>& set, std::size_t n_mounted) {
  Sets sets = {set};
  for (std::size_t i = n_mounted; i < set.size(); ++i) {
    sets.push_back(set);
    sets.back().erase(sets.back().begin() + static_cast<std::ptrdiff_t>(i));
  }
  return sets;
}

/// Residuals of all sets; each set is judged once, whatever its order.
class JudgedOnce {
 public:
  void want(const Sets& sets) {
    for (const std::vector<int>& set : sets) {
      if (known_.emplace(sorted(set), Residual{}).second) wanted_.push_back(sorted(set));
    }
  }
  [[nodiscard]] const Sets& wanted() const { return wanted_; }
  void set(std::size_t wanted, const Residual& left) { known_.at(wanted_[wanted]) = left; }
  [[nodiscard]] std::vector<Residual> of(const Sets& sets) const {
    std::vector<Residual> all;
    for (const std::vector<int>& set : sets) all.push_back(known_.at(sorted(set)));
    return all;
  }

 private:
  Sets wanted_;
  std::map<std::vector<int>, Residual> known_;
};

LossOfOne loss_of_one(const JudgedOnce& judged, const std::string& way, const std::vector<int>& set, std::size_t n_mounted) {
  const std::vector<Residual> left = judged.of(with_losses(set, n_mounted));
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

/// Sets as a piece: the size of each, then its members.
void add(Pieces::Numbers& numbers, const std::vector<int>& set) {
  numbers.push_back(static_cast<double>(set.size()));
  numbers.insert(numbers.end(), set.begin(), set.end());
}

/// Reads a piece from its beginning.
class PieceReader {
 public:
  explicit PieceReader(const Pieces::Numbers& numbers) : numbers_(numbers) {}
  [[nodiscard]] bool is_at_end() const { return at_ >= numbers_.size(); }
  double number() { return numbers_.at(at_++); }
  std::vector<int> set() {
    std::vector<int> members;
    for (auto n = static_cast<std::size_t>(number()); n > 0; --n) members.push_back(static_cast<int>(number()));
    return members;
  }

 private:
  const Pieces::Numbers& numbers_;
  std::size_t at_ = 0;
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

/// Random sets of each number as one way: their medians, and the best.
ChosenBy of_random(const std::vector<Residual>& left, int n_most) {
  ChosenBy by{.way = "random", .sets = Sets(static_cast<std::size_t>(n_most)), .left = {}};
  for (int n = 0; n < n_most; ++n) {
    std::vector<double> observer_um, regression_um;
    for (int k = 0; k < kRandomSets; ++k) {
      observer_um.push_back(left[static_cast<std::size_t>(n * kRandomSets + k)].observer_um);
      regression_um.push_back(left[static_cast<std::size_t>(n * kRandomSets + k)].regression_um);
    }
    by.left.push_back({median(observer_um), median(regression_um)});
    by.best.push_back({*std::min_element(observer_um.begin(), observer_um.end()),
                       *std::min_element(regression_um.begin(), regression_um.end())});
  }
  return by;
}

/// Copies the residuals of the sets into the result. @param own  all of the scenario's sensors
void add_judged(Placement& placement, const JudgedOnce& judged, const Sets& random, const std::vector<int>& own) {
  const std::size_t n_mounted = placement.mounted.size(), at_n = static_cast<std::size_t>(placement.options.n) - 1;
  placement.without = judged.of({placement.mounted}).front();
  placement.chosen.left = judged.of(placement.chosen.sets);
  placement.losses.push_back(loss_of_one(judged, "chosen", placement.chosen.sets[at_n], n_mounted));
  for (const std::vector<int>& set : placement.chosen.sets)
    placement.chosen_lost.push_back(loss_of_one(judged, "chosen", set, n_mounted).worst);
  for (ChosenBy& other : placement.others) {
    other.left = judged.of(other.sets);
    if (!other.sets[at_n].empty()) placement.losses.push_back(loss_of_one(judged, other.way, other.sets[at_n], n_mounted));
  }
  placement.others.push_back(of_random(judged.of(random), placement.options.n_most));
  if (own.size() > n_mounted) placement.own = ChosenBy{.way = "the scenario's own", .sets = {own}, .left = judged.of({own})};
}

/// The best sets of each number by the criterion that is asked for, as numbers of a piece: what is left without any, and of
/// each set its members and what it leaves, by the criterion, of the observer, of the regression.
Pieces::Numbers chosen_places(const PlacementModel& model, const DesignRuns& design, const PlacementOptions& how,
                              const std::vector<int>& mounted, const Pieces& pieces, const Listener& listener) {
  const Criteria criteria(model, design, how, model.rows.topRows(model.n_candidates),
                          model.ambient.head(model.n_candidates));
  const DriftLeft& whole = criteria.of(how.placed_for);
  const compensation::LeftWithLoss with_loss(whole, mounted);
  const DriftLeft& objective = how.any_may_fail ? static_cast<const DriftLeft&>(with_loss) : whole;
  listener.begin("choosing");
  Pieces::Numbers numbers = {whole.of(mounted)};
  for (const compensation::ThermometerSet& set :
       compensation::best_sets(objective, how.n_most, mounted, listener, pieces.from(kSearch))) {
    add(numbers, set.members);
    numbers.insert(numbers.end(), {set.left_um, criteria.observer.of(set.members), criteria.regression.of(set.members)});
  }
  return numbers;
}

/// From the numbers of chosen_places().
void take_chosen(Placement& placement, const Pieces::Numbers& chosen) {
  PieceReader reader(chosen);
  placement.told_nothing_um = reader.number();
  while (!reader.is_at_end()) {
    placement.chosen.sets.push_back(reader.set());
    placement.objective_um.push_back(reader.number());
    placement.observer_um.push_back(reader.number());
    placement.regression_um.push_back(reader.number());
  }
}

/// All places of the sets that are judged, each once.
std::vector<int> used_places(const Placement& placement, const Sets& random, const std::vector<int>& own) {
  std::vector<int> used = own;
  const auto use = [&](const Sets& sets) {
    for (const std::vector<int>& set : sets) used.insert(used.end(), set.begin(), set.end());
  };
  use(placement.chosen.sets);
  for (const ChosenBy& other : placement.others) use(other.sets);
  use(random);
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  return used;
}

/// All sets whose remaining errors are needed. @param at_n  index of the number of thermometers that is asked for
JudgedOnce all_to_judge(const Placement& placement, std::size_t at_n, const Sets& random, const std::vector<int>& own) {
  const std::vector<int>& mounted = placement.mounted;
  JudgedOnce judged;
  judged.want({mounted});
  for (const std::vector<int>& set : placement.chosen.sets) judged.want(with_losses(set, mounted.size()));
  for (const ChosenBy& other : placement.others) {
    judged.want(other.sets);
    if (!other.sets[at_n].empty()) judged.want(with_losses(other.sets[at_n], mounted.size()));
  }
  judged.want(random);
  if (own.size() > mounted.size()) judged.want({own});
  return judged;
}

/// What a placement says of its machine and its runs, before any place is chosen.
Placement without_places(const scenarios::Scenario& scenario, const PlacementModel& model, const PlacementFamilies& families,
                         const PlacementOptions& how) {
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
                      .mounted = model.mounted(),
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
  return placement;
}

/// The sets of the other ways to place, of each number. @param numbers  a piece: set after set
std::vector<ChosenBy> rivals_of(const Pieces::Numbers& numbers, int n_most) {
  std::vector<ChosenBy> rivals;
  PieceReader theirs(numbers);
  for (const std::string& way : kRivalWays) {
    rivals.push_back({.way = way, .sets = {}, .left = {}});
    for (int n = 1; n <= n_most; ++n) rivals.back().sets.push_back(theirs.set());
  }
  return rivals;
}

}  // namespace

std::optional<Placement> place_thermometers(const scenarios::Scenario& scenario, const PlacementOptions& asked,
                                            const Listener& listener, const Pieces& pieces) {
  PlacementOptions how = asked;
  const PlacementFamilies families = placement_families(scenario, how.train, how.test);
  std::vector<const Cyclogram*> cyclograms;
  for (const auto* list : {&families.chosen_on, &families.judged_on}) {
    for (const Cyclogram& c : *list) cyclograms.push_back(&c);
  }
  const PlacementModel model = placement_model(scenario, cyclograms, how.where, how.mounted, how.channels, listener);
  if (how.n == 0)
    how.n = std::min({scenario.study ? scenario.study->sensors_to_choose : kUsual, kMostUnasked, model.n_free()});
  if (how.n > model.n_free())
    throw InputError(
        fmt::format("{} thermometers are to be placed, and there are {} places for them", how.n, model.n_free()));
  how.n_most = std::min(std::max(how.n, how.n_most), model.n_free());
  const std::vector<int> mounted = model.mounted();
  const std::vector<MachineRun> chosen_on = runs_in_all_ambients(scenario, families.chosen_on, families.ambients, kRows);
  std::optional<DesignRuns> made;
  const auto design = [&]() -> const DesignRuns& {
    if (!made) {
      listener.begin(fmt::format("{} places in {} runs", model.n_free(), chosen_on.size()));
      made.emplace(DesignRuns{chosen_on, families.ambients.size(), factor_states(model, chosen_on),
                              scattered_states(model, chosen_on, how.scatter, kDesignSeeds)});
    }
    return *made;
  };
  Placement placement = without_places(scenario, model, families, how);
  const Pieces::Numbers chosen =
      pieces.of(kChosen, [&] { return chosen_places(model, design(), how, mounted, pieces, listener); });
  take_chosen(placement, chosen);
  const Pieces::Numbers rivals = pieces.of(kRivals, [&] {
    Pieces::Numbers numbers;
    for (const auto& sets : rival_places(model, chosen_on, how.n_most, how.noise_K)) {
      for (const std::vector<int>& set : sets) add(numbers, set);
    }
    return numbers;
  });
  placement.others = rivals_of(rivals, how.n_most);
  const Sets random = random_places(model, how.n_most);
  std::vector<int> own = mounted;
  for (int i = model.n_candidates; i < static_cast<int>(model.spots.size()); ++i) own.push_back(i);

  listener.begin("judging on other cyclograms and machines");
  const std::vector<int> used = used_places(placement, random, own);
  std::optional<PlacementJudge> made_judge;
  const auto judge = [&]() -> const PlacementJudge& {
    if (!made_judge)
      made_judge.emplace(model, chosen_on, runs_in_turn(scenario, families.judged_on, families.ambients, kJudgedRow_s), used,
                         how.scatter, kJudgedSeeds, how.noise_K);
    return *made_judge;
  };
  const auto at_n = static_cast<std::size_t>(how.n) - 1;
  JudgedOnce judged = all_to_judge(placement, at_n, random, own);
  const std::vector<Pieces::Numbers> residuals = pieces.of_shard(
      kJudged, judged.wanted().size() + 1, [&] { (void)judge(); },
      [&](std::size_t i) {
        if (i == 0) return Pieces::Numbers{judge().drift_um()};
        const Residual left = judge().of({judged.wanted()[i - 1]}).front();
        return Pieces::Numbers{left.observer_um, left.regression_um};
      },
      listener);
  if (pieces.shard.is_all()) {
    placement.drift_um = residuals.front().front();
    for (std::size_t i = 0; i < judged.wanted().size(); ++i) judged.set(i, {residuals[i + 1][0], residuals[i + 1][1]});
    add_judged(placement, judged, random, own);
  }

  listener.begin("tests of it");
  placement.tests = tried_tests(scenario, judge, placement.chosen.sets[at_n], pieces.from(kTests), listener);
  const scenarios::ReducedMachine& machine = *model.opened.reduced();
  if (machine.mesh.n_nodes() > 0) {
    listener.begin("the picture");
    placement.told_um = told_everywhere(model, design, how, pieces.from(kPicture), listener);
    placement.mesh = machine.mesh;
  }
  if (!pieces.shard.is_all()) return std::nullopt;
  return placement;
}

}  // namespace driftwright::studies
