#include "app/sweep_member.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/quantity.hpp"

namespace driftwright::app {

double scalar_of(const Record& record, const Channel& channel, scenarios::Scalar scalar, double neutral) {
  const std::vector<double>& values = channel.values;
  const auto peak = std::max_element(values.begin(), values.end(),
                                     [&](double a, double b) { return std::abs(a - neutral) < std::abs(b - neutral); });
  switch (scalar) {
    case scenarios::Scalar::kPeak:
      return *peak;
    case scenarios::Scalar::kTimeOfPeak:
      return record.time_s[static_cast<std::size_t>(peak - values.begin())];
    case scenarios::Scalar::kEnd:
      return values.back();
    case scenarios::Scalar::kMin:
      return *std::min_element(values.begin(), values.end());
    case scenarios::Scalar::kMax:
      return *std::max_element(values.begin(), values.end());
  }
  throw std::logic_error("scalar_of: no such scalar");
}

std::vector<double> simulate_member(const scenarios::Scenario& scenario, const scenarios::Machine& machine,
                                    const std::vector<scenarios::CollectedScalar>& collect) {
  const scenarios::MachineModel& model = *scenario.machine;
  const Eigen::VectorXd start = scenarios::start_state(model, machine);
  std::map<std::string, Record> records;
  std::vector<double> results;
  for (const scenarios::CollectedScalar& c : collect) {
    auto found = records.find(c.cyclogram);
    if (found == records.end()) {
      const Cyclogram& cyclogram = scenario.cyclogram(c.cyclogram);
      const solver::Trajectory run = solver::simulate(
          machine.system, cyclogram, model.hall, scenarios::output_times_s(cyclogram, scenario.solver.output_interval_s),
          scenario.solver.transient, start);
      found = records.emplace(c.cyclogram, scenarios::to_record(run, machine.system.outputs, cyclogram, model.reference_K))
                  .first;
    }
    const double neutral = c.unit == "degC" ? model.reference_K - kZeroCelsius_K : 0.0;
    results.push_back(scalar_of(found->second, found->second.at(c.channel), c.scalar, neutral));
  }
  return results;
}

}  // namespace driftwright::app
