#include "studies/mesh_ladder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>

#include "base/errors.hpp"
#include "mesh/quality.hpp"
#include "studies/other_mesh.hpp"

namespace driftwright::studies {
namespace {

MeshRung rung_of(const scenarios::MeshRecipe& recipe, double factor) {
  const mesh::Mesh m = scenarios::build_mesh(recipe);
  double volume_m3 = 0.0;
  for (std::size_t r = 0; r < m.regions.size(); ++r) volume_m3 += mesh::volume_m3(m, static_cast<int>(r));
  return {recipe, factor, std::cbrt(volume_m3 / m.cells.size()), m.cells.size()};
}

/// Elements of a mesh that is finer by a ratio of sizes, at least.
double elements_of_finer(const MeshRung& from) {
  return from.n_elements * std::pow(kLeastSizeRatio, 3);
}

/// The next mesh that is coarser or finer than `from` by kLeastSizeRatio; none if no factor gives one.
/// @param most_elements  a finer mesh with more counts as none
std::optional<MeshRung> next_rung(const scenarios::MeshRecipe& own, const MeshRung& from, bool finer, int most_elements) {
  constexpr int kTries = 6;         // the factor is corrected by what the last one gave; two or three are enough
  constexpr double kMargin = 1.01;  // meshes of nearly one size differ in their number of elements by a few per cent
  constexpr double kAfterFailure = 1.1, kMostGrowth = 2.0;
  if (finer && elements_of_finer(from) > most_elements) return std::nullopt;
  double step = kLeastSizeRatio;
  for (int i = 0; i < kTries; ++i) {
    const double factor = finer ? from.factor / step : from.factor * step;
    try {
      MeshRung rung = rung_of(other_mesh(own, factor).recipe.value(), factor);
      if (finer && rung.n_elements > most_elements) return std::nullopt;
      const double ratio = finer ? from.size_m / rung.size_m : rung.size_m / from.size_m;
      if (ratio >= kLeastSizeRatio) return rung;
      // The size follows as the factor to an exponent below 1 where walls are thin; the next step assumes the same exponent.
      const double exponent = std::log(ratio) / std::log(step), most = kMostGrowth * step;
      step = exponent > 0.0 ? std::min(most, std::pow(kMargin * kLeastSizeRatio, 1.0 / exponent)) : most;
    } catch (const SolveError&) {  // Gmsh may fail at one size and not at the next
      step *= kAfterFailure;
    } catch (const InputError&) {  // so coarse that a named place has no element, or so fine that there are too many
      step *= kAfterFailure;
    }
  }
  return std::nullopt;
}

}  // namespace

int element_order(const scenarios::MeshRecipe& recipe) {
  return std::visit(
      [](const auto& of_kind) {
        if constexpr (requires { of_kind.element_order; })
          return of_kind.element_order;
        else
          return 0;
      },
      recipe);
}

MeshLadder mesh_ladder(const scenarios::MeshRecipe& own, int most_elements, const Listener& listener) {
  if (std::holds_alternative<scenarios::LumpedMachine>(own))
    throw InputError("This machine consists of lumped bodies. It has no mesh, so there is nothing to refine");
  if (!other_mesh(own, kLeastSizeRatio).recipe)
    throw InputError(
        "The mesh of this machine comes from a file with nodes, so the program cannot make it finer or coarser. Bring a "
        "finer "
        "mesh of the same machine, run both scenarios and compare their results");
  listener.begin("meshing in other sizes");
  std::deque<MeshRung> rungs = {rung_of(own, 1.0)};
  MeshLadder ladder;
  const auto add_finer = [&] {
    std::optional<MeshRung> finer = next_rung(own, rungs.back(), true, most_elements);
    if (finer) rungs.push_back(std::move(*finer));
    return finer.has_value();
  };
  const auto add_coarser = [&] {
    std::optional<MeshRung> coarser = next_rung(own, rungs.front(), false, most_elements);
    if (!coarser) return false;
    rungs.push_front(std::move(*coarser));
    ++ladder.own;
    return true;
  };
  add_finer();
  while (rungs.size() < 3 && add_coarser()) {
  }
  while (rungs.size() < 3) {
    if (add_finer()) continue;
    throw InputError(fmt::format(
        "The machine's mesh has {} elements, and three meshes of different sizes are required. A coarser one that Gmsh can "
        "make does not exist, and a finer one would have more than --most-elements {}. Allow more elements",
        rungs[ladder.own].n_elements, most_elements));
  }
  for (std::size_t i = 0; i < 3; ++i) ladder.rungs[i] = std::move(rungs[i]);
  return ladder;
}

}  // namespace driftwright::studies
