#include "machine/heat_flow_record.hpp"

#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <limits>
#include <set>

namespace driftwright::scenarios {
namespace {

std::string channel_name(const std::string& flow, std::set<std::string>& taken) {
  std::string name = flow;
  for (char& c : name) {
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-') c = '_';
  }
  std::string unique = name;
  for (int i = 2; !taken.insert(unique).second; ++i) unique = fmt::format("{}_{}", name, i);
  return unique;
}

/// Differences of a heat [J] between rows, divided by the interval [W].
template <class Heat>
std::vector<double> mean_power_W(const std::vector<double>& time_s, const Heat& heat_J) {
  std::vector<double> power_W = {std::numeric_limits<double>::quiet_NaN()};
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    power_W.push_back((heat_J[k] - heat_J[k - 1]) / (time_s[i] - time_s[i - 1]));
  }
  return power_W;
}

}  // namespace

Record heat_flow_record(const solver::Trajectory& run, const std::string& source) {
  Record record{.source = source, .time_s = run.time_s, .channels = {}};
  std::set<std::string> taken = {"time"};
  record.channels.push_back({channel_name("stored", taken), "W", mean_power_W(run.time_s, run.stored_J)});
  for (std::size_t j = 0; j < run.flows.size(); ++j) {
    const bool within = run.flows[j].kind == solver::FlowKind::kInternal;
    const Eigen::VectorXd heat_J = run.heat_J.row(static_cast<Eigen::Index>(j)).transpose();
    record.channels.push_back(
        {channel_name((within ? "within_" : "") + run.flows[j].name, taken), "W", mean_power_W(run.time_s, heat_J)});
  }
  return record;
}

}  // namespace driftwright::scenarios
