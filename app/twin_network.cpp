#include "app/twin_network.hpp"

#include <algorithm>

namespace driftwright::app {

output::TwinNetwork network_of(const effects::HeatBalance& balance, Eigen::MatrixXd temperature) {
  output::TwinNetwork network{.temperature = std::move(temperature)};
  for (const effects::LumpedNode& node : balance.nodes) network.node.push_back(node.name);
  network.node.emplace_back(effects::kAmbientName);
  const auto index_of = [&](const std::string& name) {
    return static_cast<int>(std::find(network.node.begin(), network.node.end(), name) - network.node.begin());
  };
  for (const effects::Exchange& e : balance.exchanges) {
    const std::pair<int, int> link{index_of(e.body.name), index_of(e.medium_K ? effects::kAmbientName : e.surrounding)};
    if (!e.medium_K && std::find(network.link.begin(), network.link.end(), link) == network.link.end())
      network.link.push_back(link);
  }
  return network;
}

}  // namespace driftwright::app
