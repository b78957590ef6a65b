#include "studies/test_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <numeric>
#include <set>

#include "base/parallel.hpp"
#include "base/quantity.hpp"
#include "diagnosis/level_machine.hpp"

namespace driftwright::studies {
namespace {

constexpr int kRowsPerSlot = 3;
constexpr std::size_t kBatch = 250, kBest = 20;
constexpr int kAsked = 4;                // programmes asked for, for each one that shall be tried: some come twice
constexpr double kRandom = 0.5;          // share of all that is tried
constexpr std::size_t kMostOfAKind = 8;  // laws that the search looks at
constexpr int kMostProgrammes = 10000, kFewestProgrammes = 300;
constexpr double kWork = 1.5e11;         // multiplications, some ten seconds of two cores
constexpr double kWorthASection = 0.01;  // of the best

struct Tried {
  TestProgramme programme;
  double share = 0.0;
};

/// All that were tried, the best first.
class Search {
 public:
  Search(const diagnosis::LevelMachine& machine, const diagnosis::Question& question)
      : machine_(machine), question_(question) {}

  [[nodiscard]] double share(const TestProgramme& programme) const {
    std::vector<int> steps;
    for (int level : programme) steps.insert(steps.end(), kRowsPerSlot, level);
    return diagnosis::share_named(question_, machine_.information(steps));
  }
  void attempt(std::vector<TestProgramme> programmes) {
    std::erase_if(programmes, [&](const TestProgramme& p) { return !seen_.insert(p).second; });
    std::vector<double> shares(programmes.size());
    parallel_for(programmes.size(), [&](std::size_t i) { shares[i] = share(programmes[i]); });
    for (std::size_t i = 0; i < programmes.size(); ++i) best_.push_back({programmes[i], shares[i]});
    std::stable_sort(best_.begin(), best_.end(), [](const Tried& a, const Tried& b) { return a.share > b.share; });
    if (best_.size() > kBest) best_.resize(kBest);
  }
  [[nodiscard]] const std::vector<Tried>& best() const { return best_; }
  [[nodiscard]] int n_tried() const { return static_cast<int>(seen_.size()); }

 private:
  const diagnosis::LevelMachine& machine_;
  const diagnosis::Question& question_;
  std::set<TestProgramme> seen_;
  std::vector<Tried> best_;
};

/// Without sections that are worth little.
Tried simplified(const Search& search, const Tried& best) {
  Tried simple = best;
  for (bool goes_on = true; goes_on;) {
    goes_on = false;
    Tried next;
    for (TestProgramme& less : with_one_section_less(simple.programme)) {
      const double share = search.share(less);
      if (share > next.share) next = {std::move(less), share};
    }
    if (next.share >= (1.0 - kWorthASection) * best.share) {
      simple = std::move(next);
      goes_on = true;
    }
  }
  return simple;
}

Tried found(const diagnosis::LevelMachine& machine, const diagnosis::Question& question, const TestLevels& levels,
            int n_programmes, unsigned seed, int& n_tried, const Listener& listener) {
  Search search(machine, question);
  search.attempt({usual_test(levels), stepped_test(levels)});
  std::mt19937_64 random(seed);
  const int most_asked = kAsked * n_programmes;  // a small machine has fewer programmes than that
  for (int asked = 0; search.n_tried() < n_programmes && asked < most_asked && !listener.wants_end();) {
    const std::size_t n = std::min(kBatch, static_cast<std::size_t>(n_programmes - search.n_tried()));
    std::vector<TestProgramme> programmes;
    while (programmes.size() < n) {
      if (search.n_tried() < kRandom * n_programmes) {
        programmes.push_back(random_test(levels, random));
        continue;
      }
      TestProgramme changed = search.best()[random() % search.best().size()].programme;
      for (std::size_t changes = 1 + random() % 3; changes > 0; --changes)
        changed = changed_test(std::move(changed), levels, random);
      programmes.push_back(std::move(changed));
    }
    asked += static_cast<int>(n);
    search.attempt(std::move(programmes));
    listener.share(static_cast<double>(search.n_tried()) / n_programmes);
  }
  n_tried = search.n_tried();
  return simplified(search, search.best().front());
}

/// A programme's cost: every doubt from row to row, and the products of its columns.
int programmes_of(const PlannedTwin& p, const diagnosis::Doubts& doubts) {
  const double size = p.twin->machine().system.size(), n_doubts = static_cast<double>(doubts.question.n());
  const double n_rows = kTestSlots * kRowsPerSlot, n_readings = n_rows * static_cast<double>(p.channels.size());
  const double each = n_doubts * n_rows * size * (size + static_cast<double>(p.twin->outputs().name.size())) +
                      0.5 * n_doubts * n_doubts * n_readings;
  return std::clamp(static_cast<int>(kWork / each), kFewestProgrammes, kMostProgrammes);
}

Record record_of(const PlannedTwin& p, const diagnosis::MeasuredRun& run) {
  diagnosis::Twin::Workspace workspace(*p.twin);
  const diagnosis::TwinState& state = p.twin->as_written();
  const Eigen::MatrixXd readings = p.twin->read(state, run, p.twin->respond(state, run, workspace));
  Record record{.source = run.name, .time_s = run.time_s, .channels = {{"speed", "rpm", {}}}};
  for (double t_s : run.time_s) record.channels.front().values.push_back(run.cyclogram.speed_rpm(t_s));
  for (const diagnosis::MeasuredChannel& c : p.channels) {
    const bool is_temperature = c.unit == "K";
    Channel channel{c.name, is_temperature ? "degC" : c.unit == "m" ? "um" : "urad", {}};
    for (Eigen::Index i = 0; i < readings.cols(); ++i)
      channel.values.push_back(is_temperature ? readings(c.output, i) + p.twin->reference_K() - kZeroCelsius_K
                                              : 1e6 * readings(c.output, i));
    record.channels.push_back(std::move(channel));
  }
  return record;
}

}  // namespace

TestPlan plan_test(const scenarios::Scenario& scenario, const TestPlanOptions& options, const Listener& listener) {
  const TestLevels levels = test_levels(scenario, options.most_speed_rpm);
  const auto cyclogram = [&](const TestProgramme& p) { return cyclogram_of(p, levels, options.duration_s, "planned"); };
  std::vector<Cyclogram> like = {cyclogram(usual_test(levels)), cyclogram(stepped_test(levels))};
  std::mt19937_64 random(options.seed);
  like.push_back(cyclogram(random_test(levels, random)));
  for (std::size_t i = 1; i < like.size(); ++i) like[i].name += fmt::format("_{}", i);
  const PlannedTwin p = open_planned_twin(scenario, "plan-test", like, options.interval_s, options.noise, listener);
  const auto run_of = [&](const Cyclogram& c, const std::vector<diagnosis::MeasuredChannel>& channels) {
    return diagnosis::planned_run(c, options.interval_s, p.ambient, true, channels);
  };
  const diagnosis::MeasuredRun usual = run_of(like.front(), p.channels);
  const diagnosis::Doubts doubts = diagnosis::doubts_before(*p.twin, usual);

  TestPlan plan{.duration_s = options.duration_s,
                .interval_s = options.interval_s,
                .noise = options.noise,
                .numbers = doubts.numbers,
                .question = doubts.question};
  for (const diagnosis::MeasuredChannel& c : p.channels) plan.channels.push_back(c.name);
  const diagnosis::Doubts searched = diagnosis::thinned(*p.twin, doubts, usual, kMostOfAKind);
  const int n_programmes = options.n_programmes > 0 ? options.n_programmes : programmes_of(p, searched);
  listener.begin(fmt::format("{} doubts at {} levels", searched.question.n(), levels.drives.size()));
  const double row_s = options.duration_s / (kTestSlots * kRowsPerSlot);
  const diagnosis::LevelMachine machine(*p.twin, searched, levels.drives, usual, row_s, options.interval_s, p.noise);
  listener.begin(fmt::format("trying {} programmes", n_programmes));
  const auto begin = std::chrono::steady_clock::now();
  const Tried best = found(machine, searched.question, levels, n_programmes, options.seed, plan.n_tried, listener);
  plan.search_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  plan.search_share = best.share;

  listener.begin("judging the best");
  std::vector<diagnosis::MeasuredChannel> all = p.channels;
  all.insert(all.end(), p.further.begin(), p.further.end());
  const auto n_own = static_cast<std::ptrdiff_t>(p.channels.size());
  const auto judge = [&](const std::string& name, const TestProgramme& programme,
                         std::vector<Eigen::MatrixXd>& of_channels) {
    of_channels = diagnosis::information_by_channel(*p.twin, doubts, run_of(cyclogram(programme), all), p.noise);
    const Eigen::MatrixXd total = std::accumulate(of_channels.begin() + 1, of_channels.begin() + n_own, of_channels.front());
    return JudgedTest{name, cyclogram(programme), diagnosis::prospect(doubts.question, total)};
  };
  std::vector<Eigen::MatrixXd> of_usual, of_stepped, of_channels;
  plan.usual = judge("usual", usual_test(levels), of_usual);
  plan.stepped = judge("stepped", stepped_test(levels), of_stepped);
  plan.planned = judge("planned", best.programme, of_channels);
  for (const auto& [other, theirs] : {std::pair(&plan.usual, &of_usual), std::pair(&plan.stepped, &of_stepped)}) {
    if (other->prospect.share_named <= plan.planned.prospect.share_named) continue;
    plan.planned = *other;
    of_channels = *theirs;
  }
  plan.planned.name = "planned";
  const Eigen::MatrixXd total = std::accumulate(of_channels.begin() + 1, of_channels.begin() + n_own, of_channels.front());
  for (std::size_t c = 0; c < of_channels.size(); ++c) {
    const bool is_own = c < p.channels.size();
    const Eigen::MatrixXd with = is_own ? Eigen::MatrixXd(total - of_channels[c]) : Eigen::MatrixXd(total + of_channels[c]);
    (is_own ? plan.without : plan.with)
        .push_back({is_own ? all[c].name : all[c].name.substr(std::string("mean of ").size()),
                    diagnosis::share_named(doubts.question, with)});
  }
  std::stable_sort(plan.without.begin(), plan.without.end(),
                   [](const auto& a, const auto& b) { return a.share_named < b.share_named; });
  std::stable_sort(plan.with.begin(), plan.with.end(),
                   [](const auto& a, const auto& b) { return a.share_named > b.share_named; });
  plan.usual_record = record_of(p, run_of(plan.usual.cyclogram, p.channels));
  plan.planned_record = record_of(p, run_of(plan.planned.cyclogram, p.channels));
  return plan;
}

}  // namespace driftwright::studies
