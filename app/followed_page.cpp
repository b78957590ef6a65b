#include "app/followed_page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "app/twin_network.hpp"
#include "base/errors.hpp"
#include "base/file_bytes.hpp"
#include "base/quantity.hpp"
#include "base/version.hpp"
#include "findings/machine_section.hpp"
#include "output/twin/live_page.hpp"
#include "scenarios/reader/scenario.hpp"

namespace driftwright::app {
namespace {

/// Adds the picture of a model: its surface with the fields of the small system's states, or, for lumped nodes, whose
/// temperatures are the state, the network.
void add_picture(output::LivePage& page, const std::string& path, const scenarios::Model& model) {
  const scenarios::Scenario scenario = scenarios::read_scenario(path);
  page.reference_degC = scenario.machine->reference_K - kZeroCelsius_K;
  const auto n_nodes = static_cast<Eigen::Index>(model.balance.nodes.size());
  if (model.reduced() && model.mesh().n_nodes() > 0) {
    page.surface = output::twin_surface(*model.reduced());
    page.marks = findings::marks_of(*scenario.machine);
  } else if (model.full() && model.mesh().n_nodes() == 0) {
    page.network = network_of(model.balance, Eigen::MatrixXd::Identity(n_nodes, n_nodes));
  } else {
    page.note = model.full()
                    ? "The machine is followed by finite elements, which are not drawn here; with `model: reduced` it is."
                    : "The machine is followed by a reduced model of its lumped nodes, which are not drawn here; without "
                      "`model: reduced` they are.";
  }
}

}  // namespace

follow::PageAddress page_address(const FollowVerbOptions& options) {
  follow::PageAddress address{.host = options.bind, .port = *options.serve, .token = options.token};
  if (address.token.starts_with('@')) {
    const std::string text = read_bytes(address.token.substr(1));
    address.token = text.substr(0, text.find_first_of("\r\n"));
    if (address.token.empty()) throw InputError(fmt::format("--token {}: its first line is empty", options.token));
  }
  follow::require_safe(address);
  return address;
}

std::string followed_page(const FollowVerbOptions& options, const follow::Session& session) {
  std::vector<std::string> names;
  for (const auto& m : session.models()) names.push_back(std::filesystem::path(m.path).filename().string());
  output::LivePage page{.name = fmt::format("{}", fmt::join(names, ", ")),
                        .subtitle = "Beside the running machine.",
                        .made_by = fmt::format("Driftwright {}, docs/how-to/follow.md.", kVersion)};
  for (const auto& m : session.models()) {
    if (!m.followed->model() || page.surface || page.network) continue;
    add_picture(page, m.path, *m.followed->model());
  }
  if (!options.watch.empty()) page.subtitle += " Its residuals are watched.";
  return output::live_html(page);
}

follow::PageRow page_row(const follow::Session& session, const follow::FollowLine& line) {
  follow::PageRow row{.run_s = session.now_s(), .line = line, .values = session.taken().values, .state = {}};
  row.values.resize(session.channels().size(), std::numeric_limits<double>::quiet_NaN());
  for (const auto& m : session.models()) {
    auto state = m.followed->machine_state();
    if (!state || row.state.size() > 0) continue;
    row.state = std::move(state->state);
    row.ambient_K = state->ambient_K;
  }
  return row;
}

}  // namespace driftwright::app
