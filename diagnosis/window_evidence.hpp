#pragma once
// What the whitened readings say of something that acts for a while in a body, or between two, cell of time by cell of time: linear theory about a fit.

#include "diagnosis/fit.hpp"
#include "diagnosis/linear_run.hpp"
#include "diagnosis/projection.hpp"
#include "diagnosis/window_search.hpp"

namespace driftwright::diagnosis {

/// Where something may act for a while: heat in a body, an exchange of two, or the speed of the spindle. Bodies are numbered as those that the runs were
/// seen with.
struct WindowPlace {
  std::size_t body = 0;
  std::optional<std::size_t> other = {};  ///< n_bodies: the ambient
  bool is_speed = false;                  ///< all heat that turning makes, and no body: the size is a share of it, -1 where the spindle stands
};

/// A run as linear theory sees it.
struct SeenRun {
  std::size_t number = 0;
  LinearRun linear;
  Eigen::Index first_row = 0, n_rows = 0;  ///< of the whitened readings, condensed
};

/// @param state  about which the machine is linear
/// @throws SolveError  where it has no solution
[[nodiscard]] SeenRun seen_run(const Fitter& fitter, const TwinState& state, std::size_t run,
                               const std::vector<effects::Body>& bodies, Twin::Workspace& workspace);

using Edges = std::vector<std::vector<Eigen::Index>>;  ///< rows between the cells of each run
/// @param most_cells  of a run
[[nodiscard]] Edges coarse_edges(const std::vector<MeasuredRun>& runs, Eigen::Index most_cells);
/// Finer cells about the edges of windows, and the windows in these.
[[nodiscard]] Edges finer_edges(const Edges& coarse, std::vector<FoundWindows::Window>& windows);

/// @param projection  of a fit, its readings condensed
[[nodiscard]] WindowEvidence evidence_of(const Fitter& fitter, const Projection& projection,
                                         const std::vector<SeenRun>& runs, const WindowPlace& place, std::size_t n_bodies,
                                         const Edges& edges);

}  // namespace driftwright::diagnosis
