#include "machine/channel_sections.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <map>

#include "effects/flow_path.hpp"

namespace driftwright::scenarios {
namespace {

/// A line through points, with the length up to each of them.
struct FlowLine {
  std::vector<Eigen::Vector3d> points_m;
  std::vector<double> until_m = {0.0};

  explicit FlowLine(const std::vector<effects::Point_mm>& points_mm) {
    for (const effects::Point_mm& p : points_mm) {
      points_m.push_back(1e-3 * Eigen::Vector3d(p[0], p[1], p[2]));
      if (points_m.size() > 1) until_m.push_back(until_m.back() + (points_m.back() - points_m[points_m.size() - 2]).norm());
    }
  }
  /// The share of its length at which it is nearest to a point, 0 to 1.
  [[nodiscard]] double share_at(const Eigen::Vector3d& x_m) const {
    double nearest_m = std::numeric_limits<double>::infinity(), at_m = 0.0;
    for (std::size_t i = 0; i + 1 < points_m.size(); ++i) {
      const Eigen::Vector3d way = points_m[i + 1] - points_m[i];
      const double share = std::clamp((x_m - points_m[i]).dot(way) / way.squaredNorm(), 0.0, 1.0);
      const double distance_m = (x_m - points_m[i] - share * way).norm();
      if (distance_m >= nearest_m) continue;
      nearest_m = distance_m;
      at_m = until_m[i] + share * way.norm();
    }
    return at_m / until_m.back();
  }
};

Eigen::Vector3d middle_of(const mesh::Mesh& mesh, int facet) {
  const int n = mesh::n_corners_of(mesh.facets.shape[static_cast<std::size_t>(facet)]);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const int node : mesh.facets.nodes(facet).first(static_cast<std::size_t>(n))) sum += mesh.coords.col(node);
  return sum / n;
}

/// The line of an effect and the number of its sections; none for an effect without one.
struct Cut {
  std::string line;
  int n = 0;
};
Cut cut_of(const effects::Effect& e) {
  for (const effects::Mention& m : e.kind->mentions) {
    if (m.of != effects::Mention::Of::kPoints || e.words.at(m.name).empty()) continue;
    const std::vector<effects::Exchange> sections = effects::heat_balance({e}).exchanges;
    const auto is_section = [&](const effects::Exchange& x) { return x.body.name.starts_with(e.place + "@"); };
    return {m.name, static_cast<int>(std::count_if(sections.begin(), sections.end(), is_section))};
  }
  return {};
}

/// The section of n in which a share of the line is.
int section_of(double share, int n) {
  return std::min(n - 1, static_cast<int>(share * n));
}

/// The largest number of sections, below n, of which each has one of the shares.
int most_sections(const std::vector<double>& shares, int n) {
  for (int fewer = n - 1; fewer > 1; --fewer) {
    std::vector<char> has(static_cast<std::size_t>(fewer), 0);
    for (const double share : shares) has[static_cast<std::size_t>(section_of(share, fewer))] = 1;
    if (std::find(has.begin(), has.end(), 0) == has.end()) return fewer;
  }
  return 1;
}

void cut(const effects::Effect& e, const Cut& into, mesh::Mesh& mesh) {
  const FlowLine line(effects::points_of_text(e.words.at(into.line)));
  const auto first = static_cast<int>(mesh.surfaces.size());
  std::vector<int> n_facets(static_cast<std::size_t>(into.n), 0);
  std::vector<double> shares;
  for (const int facet : mesh.facets_on(mesh.surface(e.place))) {
    shares.push_back(line.share_at(middle_of(mesh, facet)));
    const int i = section_of(shares.back(), into.n);
    ++n_facets[static_cast<std::size_t>(i)];
    const auto nodes = mesh.facets.nodes(facet);
    const std::vector<int> own(nodes.begin(), nodes.end());  // add() may move the list that `nodes` is part of
    mesh.facets.add(mesh.facets.shape[static_cast<std::size_t>(facet)], own, first + i);
  }
  for (int i = 0; i < into.n; ++i) {
    if (n_facets[static_cast<std::size_t>(i)] == 0) {
      throw InputError(e.reference_where.at(into.line),
                       fmt::format("section {} of {} of surface '{}' has no face of the mesh: no face is nearest to that "
                                   "part of the line. Write `sections: {}`, the most of which each has a face, or give a "
                                   "finer mesh, or points in mm from the inlet to the outlet of this surface",
                                   i + 1, into.n, e.place, most_sections(shares, into.n)));
    }
    mesh.surfaces.push_back(effects::section_name(e.place, i, into.n));
  }
}

}  // namespace

void add_channel_sections(const MachineModel& model, mesh::Mesh& mesh) {
  std::map<std::string, std::string> line_of;  // by the name of the first section
  for (const effects::Effect& e : model.effects) {
    const Cut into = cut_of(e);
    if (into.n == 0 || mesh.surface(e.place) < 0) continue;
    const std::string& line = e.words.at(into.line);
    const auto [known, is_new] = line_of.emplace(effects::section_name(e.place, 0, into.n), line);
    if (is_new) {
      cut(e, into, mesh);
    } else if (known->second != line) {
      throw InputError(e.reference_where.at(into.line),
                       fmt::format("surface '{}' is cut into {} sections by another entry along another line; give both the "
                                   "same line, or another number of sections",
                                   e.place, into.n));
    }
  }
}

}  // namespace driftwright::scenarios
