#include "studies/test_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "base/parallel.hpp"
#include "base/quantity.hpp"
#include "base/shown_units.hpp"
#include "diagnosis/level_machine.hpp"

namespace driftwright::studies {
namespace {

/// The fineness of a search: steps per slot of a programme, and laws of each kind that judge it.
struct Fineness {
  int rows_per_slot;
  std::size_t most_of_a_kind;
};
constexpr Fineness kCoarse = {1, 2}, kFine = {3, 8};  // all are tried coarsely, the best of them also finely
constexpr std::size_t kBatch = 250;
constexpr std::size_t kParents = 20;  // the best so far, which are changed
constexpr std::size_t kTriedFinely = 200;
constexpr std::size_t kTogether = 10;  // programmes per piece
constexpr int kAsked = 4;              // programmes generated for each one tried, since some repeat
constexpr double kRandom = 0.5;        // share of random ones
constexpr int kMostProgrammes = 10000, kFewestProgrammes = 300;
constexpr double kWork = 1.8e11;         // multiplications, about ten seconds on two cores
constexpr double kWorthASection = 0.01;  // share of the best

/// First numbers of the pieces of each stage.
constexpr std::size_t kPlanSearch = 0, kFineSearch = 5'000'000, kFound = 10'000'000, kPlanJudged = 10'000'001;

struct Tried {
  TestProgramme programme;
  double share = 0.0;
};

/// All programmes that were tried, the best first.
class Search {
 public:
  /// @param n_kept  number of best programmes that are kept
  Search(const diagnosis::LevelMachine& machine, const diagnosis::Question& question, int rows_per_slot, std::size_t n_kept,
         Pieces pieces)
      : machine_(machine), question_(question), rows_per_slot_(rows_per_slot), n_kept_(n_kept), pieces_(std::move(pieces)) {}

  [[nodiscard]] double share(const TestProgramme& programme) const {
    std::vector<int> steps;
    for (int level : programme) steps.insert(steps.end(), static_cast<std::size_t>(rows_per_slot_), level);
    return diagnosis::share_named(question_, machine_.information(steps));
  }
  void attempt(std::vector<TestProgramme> programmes) {
    std::erase_if(programmes, [&](const TestProgramme& p) { return !seen_.insert(p).second; });
    const std::size_t n_pieces = (programmes.size() + kTogether - 1) / kTogether;
    const std::vector<Pieces::Numbers> shares = pieces_.of_all(
        n_pieces_, n_pieces, [] {},
        [&](std::size_t piece) {
          Pieces::Numbers of_piece;
          for (std::size_t i = piece * kTogether; i < std::min(programmes.size(), (piece + 1) * kTogether); ++i)
            of_piece.push_back(share(programmes[i]));
          return of_piece;
        });
    n_pieces_ += n_pieces;
    for (std::size_t i = 0; i < programmes.size(); ++i)
      best_.push_back({programmes[i], shares[i / kTogether][i % kTogether]});
    std::stable_sort(best_.begin(), best_.end(), [](const Tried& a, const Tried& b) { return a.share > b.share; });
    if (best_.size() > n_kept_) best_.resize(n_kept_);
  }
  [[nodiscard]] const std::vector<Tried>& best() const { return best_; }
  [[nodiscard]] int n_tried() const { return static_cast<int>(seen_.size()); }

 private:
  const diagnosis::LevelMachine& machine_;
  const diagnosis::Question& question_;
  int rows_per_slot_;
  std::size_t n_kept_;
  Pieces pieces_;
  std::size_t n_pieces_ = 0;
  std::set<TestProgramme> seen_;
  std::vector<Tried> best_;
};

/// The programme without sections that are worth little.
Tried simplified(const Search& search, const Tried& best) {
  Tried simple = best;
  for (bool goes_on = true; goes_on;) {
    goes_on = false;
    Tried next;
    const std::vector<TestProgramme> less = with_one_section_less(simple.programme);
    std::vector<double> shares(less.size());
    parallel_for(less.size(), [&](std::size_t i) { shares[i] = search.share(less[i]); });
    for (std::size_t i = 0; i < less.size(); ++i) {
      if (shares[i] > next.share) next = {less[i], shares[i]};
    }
    if (next.share >= (1.0 - kWorthASection) * best.share) {
      simple = std::move(next);
      goes_on = true;
    }
  }
  return simple;
}

/// Tries programmes; the usual and the stepped one come first.
void look_for(Search& search, const TestLevels& levels, int n_programmes, unsigned seed, const Listener& listener) {
  search.attempt({usual_test(levels), stepped_test(levels)});
  std::mt19937_64 random(seed);
  const int most_asked = kAsked * n_programmes;  // a small machine has fewer different programmes
  for (int asked = 0; search.n_tried() < n_programmes && asked < most_asked && !listener.wants_end();) {
    const std::size_t n = std::min(kBatch, static_cast<std::size_t>(n_programmes - search.n_tried()));
    std::vector<TestProgramme> programmes;
    while (programmes.size() < n) {
      if (search.n_tried() < kRandom * n_programmes) {
        programmes.push_back(random_test(levels, random));
        continue;
      }
      TestProgramme changed = search.best()[random() % std::min(kParents, search.best().size())].programme;
      for (std::size_t changes = 1 + random() % 3; changes > 0; --changes)
        changed = changed_test(std::move(changed), levels, random);
      programmes.push_back(std::move(changed));
    }
    asked += static_cast<int>(n);
    search.attempt(std::move(programmes));
    listener.share(static_cast<double>(search.n_tried()) / n_programmes);
  }
}

void add(Pieces::Numbers& numbers, const auto& matrix) {
  numbers.insert(numbers.end(), matrix.data(), matrix.data() + matrix.size());
}

/// The prospect of a test, and the shares by channel, as a piece.
Pieces::Numbers numbers_of(const diagnosis::Prospect& p, const std::vector<double>& by_channel) {
  Pieces::Numbers numbers = {p.share_named};
  for (const Eigen::VectorXd* v : {&p.seen, &p.named, &p.nats, &p.number_sigma}) add(numbers, *v);
  for (const Eigen::MatrixXd* m : {&p.d, &p.taken}) add(numbers, *m);
  numbers.insert(numbers.end(), by_channel.begin(), by_channel.end());
  return numbers;
}

diagnosis::Prospect prospect_of(const Pieces::Numbers& numbers, const diagnosis::Question& question,
                                std::vector<double>& by_channel) {
  const auto n_laws = static_cast<Eigen::Index>(question.laws.size());
  const double* at = numbers.data();
  diagnosis::Prospect p;
  p.share_named = *at++;
  const auto vector = [&](Eigen::VectorXd& v, Eigen::Index n) {
    v = Eigen::Map<const Eigen::VectorXd>(at, n);
    at += n;
  };
  for (Eigen::VectorXd* v : {&p.seen, &p.named, &p.nats}) vector(*v, n_laws);
  vector(p.number_sigma, question.number_sd.size());
  for (Eigen::MatrixXd* m : {&p.d, &p.taken}) {
    *m = Eigen::Map<const Eigen::MatrixXd>(at, n_laws, n_laws);
    at += n_laws * n_laws;
  }
  by_channel.assign(at, numbers.data() + numbers.size());
  return p;
}

/// The prospects of tests, each also without each of the machine's own channels, and with each further one.
std::vector<Pieces::Numbers> judge(const PlannedTwin& p, const diagnosis::Doubts& doubts, std::size_t n_tests,
                                   const Pieces& pieces, const Listener& listener,
                                   const std::function<diagnosis::MeasuredRun(std::size_t)>& run_of) {
  std::vector<Pieces::Numbers> told(n_tests);
  const auto n_own = static_cast<std::ptrdiff_t>(p.channels.size());
  for (std::size_t t = 0; t < n_tests; ++t) {  // each test uses all cores
    if (!pieces.shard.has(t)) continue;
    told[t] = pieces.of(kPlanJudged + t, [&] {
      const std::vector<Eigen::MatrixXd> of_channels =
          diagnosis::information_by_channel(*p.twin, doubts, run_of(t), p.noise);
      const Eigen::MatrixXd total =
          std::accumulate(of_channels.begin() + 1, of_channels.begin() + n_own, of_channels.front());
      std::vector<double> by_channel(of_channels.size());
      parallel_for(of_channels.size(), [&](std::size_t c) {
        const bool is_own = c < p.channels.size();
        by_channel[c] = diagnosis::share_named(
            doubts.question, is_own ? Eigen::MatrixXd(total - of_channels[c]) : Eigen::MatrixXd(total + of_channels[c]));
      });
      return numbers_of(diagnosis::prospect(doubts.question, total), by_channel);
    });
    listener.share(static_cast<double>(t + 1) / static_cast<double>(n_tests));
  }
  return told;
}

/// The number of programmes to try, from the cost of one: every doubt from row to row, and the products of its columns.
int programmes_of(const PlannedTwin& p, const diagnosis::Doubts& doubts) {
  const double size = p.twin->machine().system.size(), n_doubts = static_cast<double>(doubts.question.n());
  const double n_rows = kTestSlots * kCoarse.rows_per_slot, n_readings = n_rows * static_cast<double>(p.channels.size());
  const double each = n_doubts * n_rows * size * (size + static_cast<double>(p.twin->outputs().name.size())) +
                      0.5 * n_doubts * n_doubts * n_readings;
  return std::clamp(static_cast<int>(kWork / each), kFewestProgrammes, kMostProgrammes);
}

Record record_of(const PlannedTwin& p, const diagnosis::MeasuredRun& run) {
  diagnosis::Twin::Workspace workspace(*p.twin);
  const diagnosis::TwinState& state = p.twin->as_written();
  const Eigen::MatrixXd readings = p.twin->readings(state, run, workspace);
  Record record{.source = run.name, .time_s = run.time_s, .channels = {{"speed", "rpm", {}}}};
  for (double t_s : run.time_s) record.channels.front().values.push_back(run.cyclogram.speed_rpm(t_s));
  for (const diagnosis::MeasuredChannel& c : p.channels) {
    const bool is_temperature = c.unit == "K";
    Channel channel{c.name, shown_reading_unit(c.unit), {}};
    for (Eigen::Index i = 0; i < readings.cols(); ++i)
      channel.values.push_back(is_temperature ? readings(c.output, i) + p.twin->reference_K() - kZeroCelsius_K
                                              : 1e6 * readings(c.output, i));
    record.channels.push_back(std::move(channel));
  }
  return record;
}

}  // namespace

std::optional<TestPlan> plan_test(const scenarios::Scenario& scenario, const TestPlanOptions& options,
                                  const Listener& listener, const Pieces& pieces) {
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
  const Pieces::Numbers found_numbers = pieces.of(kFound, [&] {
    const auto doubts_of = [&](const Fineness& how) {
      return diagnosis::thinned(*p.twin, doubts, usual, how.most_of_a_kind);
    };
    const auto machine_of = [&](const Fineness& how, const diagnosis::Doubts& searched) {
      listener.begin(fmt::format("{} doubts at {} levels", searched.question.n(), levels.drives.size()));
      return diagnosis::LevelMachine(*p.twin, searched, levels.drives, usual,
                                     options.duration_s / (kTestSlots * how.rows_per_slot), options.interval_s, p.noise);
    };
    const diagnosis::Doubts few = doubts_of(kCoarse), more = doubts_of(kFine);
    const diagnosis::LevelMachine coarse_machine = machine_of(kCoarse, few);
    const int n_programmes = options.n_programmes > 0 ? options.n_programmes : programmes_of(p, few);
    listener.begin(fmt::format("trying {} programmes", n_programmes));
    Search coarse(coarse_machine, few.question, kCoarse.rows_per_slot, kTriedFinely, pieces.from(kPlanSearch));
    look_for(coarse, levels, n_programmes, options.seed, listener);
    const diagnosis::LevelMachine fine_machine = machine_of(kFine, more);
    Search fine(fine_machine, more.question, kFine.rows_per_slot, 1, pieces.from(kFineSearch));
    std::vector<TestProgramme> promising = {usual_test(levels), stepped_test(levels)};
    for (const Tried& tried : coarse.best()) promising.push_back(tried.programme);
    fine.attempt(std::move(promising));
    const Tried best = simplified(fine, fine.best().front());
    const int n_tried = coarse.n_tried();
    Pieces::Numbers numbers = {best.share, static_cast<double>(n_tried)};
    numbers.insert(numbers.end(), best.programme.begin(), best.programme.end());
    return numbers;
  });
  plan.search_share = found_numbers[0];
  plan.n_tried = static_cast<int>(found_numbers[1]);
  TestProgramme best;
  for (std::size_t i = 2; i < found_numbers.size(); ++i) best.push_back(static_cast<int>(found_numbers[i]));

  listener.begin("judging the best");
  std::vector<diagnosis::MeasuredChannel> all = p.channels;
  all.insert(all.end(), p.further.begin(), p.further.end());
  const std::size_t n_own = p.channels.size();
  const std::vector<std::pair<std::string, TestProgramme>> judged = {
      {"usual", usual_test(levels)}, {"stepped", stepped_test(levels)}, {"planned", best}};
  const std::vector<Pieces::Numbers> told = judge(p, doubts, judged.size(), pieces, listener,
                                                  [&](std::size_t i) { return run_of(cyclogram(judged[i].second), all); });
  if (!pieces.shard.is_all()) return std::nullopt;
  std::vector<double> by_channel;
  for (std::size_t i = 0; JudgedTest * test : {&plan.usual, &plan.stepped, &plan.planned}) {
    std::vector<double> of_test;
    JudgedTest next{judged[i].first, cyclogram(judged[i].second), prospect_of(told[i], doubts.question, of_test)};
    *test = std::move(next);
    if (test == &plan.planned) by_channel = of_test;
    ++i;
  }
  for (std::size_t i = 0; const JudgedTest* other : {&plan.usual, &plan.stepped}) {
    if (other->prospect.share_named > plan.planned.prospect.share_named) {
      plan.planned = *other;
      (void)prospect_of(told[i], doubts.question, by_channel);
    }
    ++i;
  }
  plan.planned.name = "planned";
  for (std::size_t c = 0; c < all.size(); ++c) {
    const bool is_own = c < n_own;
    (is_own ? plan.without : plan.with)
        .push_back({is_own ? all[c].name : all[c].name.substr(std::string("mean of ").size()), by_channel[c]});
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
