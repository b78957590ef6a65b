#include "studies/warm_up_error.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "compensation/judging/model_scatter.hpp"

namespace driftwright::studies {
namespace {

constexpr int kErrorTimes = 16;  // times of a warm-up at one speed, from none to the longest
constexpr int kBetween = 8;      // then between the last insufficient and the first sufficient one

/// The scattered model without the parts that only pictures need.
std::shared_ptr<const scenarios::Model> drawn(const scenarios::Model& model, double sigma, int seed) {
  Random random(static_cast<std::uint64_t>(seed), 7);
  auto other = std::make_shared<scenarios::Model>(scenarios::Model{.machine = {}, .balance = model.balance});
  if (const scenarios::ReducedMachine* reduced = model.reduced()) {
    scenarios::ReducedMachine machine;
    machine.n_unknowns = reduced->n_unknowns;
    machine.system = compensation::scattered(reduced->system, sigma, random);
    machine.start = reduced->start;
    other->machine.emplace<scenarios::ReducedMachine>(std::move(machine));
  } else {
    scenarios::Machine machine;
    machine.system = compensation::scattered(model.full()->system, sigma, random);
    other->machine.emplace<scenarios::Machine>(std::move(machine));
  }
  return other;
}

double share_within(const Eigen::MatrixXd& peaks_um, Eigen::Index programme, double tolerance_um) {
  return static_cast<double>((peaks_um.row(programme).array() <= tolerance_um).count()) /
         static_cast<double>(peaks_um.cols());
}

}  // namespace

Eigen::MatrixXd DrawnMachines::peaks_um(const std::vector<std::vector<Cyclogram::Section>>& programmes,
                                        const Listener& listener) const {
  Eigen::MatrixXd peaks(static_cast<Eigen::Index>(programmes.size()), n_);
  parallel_for(
      static_cast<std::size_t>(n_),
      [&](std::size_t m) {
        const WarmUpTrials machine(trials_, drawn(*trials_.ahead().model, sigma_, first_seed_ + static_cast<int>(m)));
        for (std::size_t p = 0; p < programmes.size(); ++p)
          peaks(static_cast<Eigen::Index>(p), static_cast<Eigen::Index>(m)) = machine.tried(programmes[p], 0.0).peak_um;
      },
      {.on_begin = {}, .on_share = listener.on_share, .wants_end_now = {}});
  return peaks;
}

int DrawnMachines::n_kept(const std::vector<Cyclogram::Section>& programme, double tolerance_um,
                          const Listener& listener) const {
  return static_cast<int>((peaks_um({programme}, listener).array() <= tolerance_um).count());
}

std::optional<double> free_share(const WarmUpTrials& trials, const DrawnMachines& machines, double speed_rpm, double most_s,
                                 double tolerance_um, const Listener& listener) {
  const auto at_speed = [&](double time_s) {
    std::vector<Cyclogram::Section> sections;
    if (time_s >= 1.0) sections.push_back({std::round(time_s), {.speed_rpm = speed_rpm}});
    return sections;
  };
  double low_s = 0.0, high_s = most_s;
  bool is_found = false;
  for (int n : {kErrorTimes, kBetween}) {
    std::vector<std::vector<Cyclogram::Section>> programmes;
    std::vector<double> times_s;
    for (int i = 0; i <= n; ++i) {
      const double share = static_cast<double>(i) / n;
      times_s.push_back(low_s + (high_s - low_s) * (n == kErrorTimes ? share * share : share));
      programmes.push_back(at_speed(times_s.back()));
    }
    const Eigen::MatrixXd peaks = machines.peaks_um(programmes, listener);
    Eigen::Index first = 0;
    while (first <= n && share_within(peaks, first, tolerance_um) < kKeptOfDraws) ++first;
    if (first > n) break;
    is_found = true;
    high_s = times_s[static_cast<std::size_t>(first)];
    if (first == 0) break;
    low_s = times_s[static_cast<std::size_t>(first) - 1];
  }
  if (!is_found) return std::nullopt;
  return std::max(0.0, 1.0 - trials.tried(at_speed(high_s), 0.0).peak_um / tolerance_um);
}

}  // namespace driftwright::studies
