#include "studies/drawn_machines.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <memory>

#include "base/dense.hpp"
#include "base/parallel.hpp"
#include "solver/reduced_model.hpp"

namespace driftwright::studies {
namespace {

using diagnosis::Knob, diagnosis::MeasuredRun, diagnosis::Twin, diagnosis::TwinState;

constexpr double kNarrowError = 0.02;     // of the differences; limits from 200 draws err by 2 to 3 % (band_limits.hpp)
constexpr double kNegligible = 1e-3;      // of the largest differences in the same unit
constexpr double kLeastShare = 1e-4;      // length of a direction that is left out at first, relative to the first one
constexpr double kShareStep = 0.3;        // of that after each failure
constexpr double kLargestNarrow = 0.75;   // of the states: 0.75^3 of the time saves too little
constexpr std::size_t kCheckedDraws = 4;  // run on both models
constexpr int kMostNarrowings = 3;

/// A model, and the run of the machine as written on it.
struct BaseRun {
  const Twin& twin;
  const MeasuredRun& run;
  std::shared_ptr<const solver::KeptStates> kept;
  Eigen::MatrixXd states, readings;

  BaseRun(const Twin& of, const MeasuredRun& in) : twin(of), run(in) {
    Twin::Workspace workspace(twin);
    kept = twin.kept_run(twin.as_written(), run, workspace, false);
    states = twin.states(twin.as_written(), run, workspace, kept.get());
    readings = twin.read(twin.as_written(), run, twin.outputs_of(twin.as_written(), run, states));
  }
};

/// The drawn machines.
struct Draws {
  const std::vector<Knob>& knobs;
  const Eigen::MatrixXd& deviations;

  [[nodiscard]] TwinState of(const Twin& twin, std::size_t d) const {
    TwinState state = twin.as_written();
    for (std::size_t k = 0; k < knobs.size(); ++k)
      knobs[k].set(state, knobs[k].value(deviations(static_cast<Eigen::Index>(d), static_cast<Eigen::Index>(k))));
    return state;
  }
};

using Differences = std::vector<std::optional<Eigen::MatrixXd>>;

/// Runs the machines of a list. @param differences  of all machines; receives those of the list
/// @param states  unless null, receives the states of those that have a solution, one beside the other
void run_draws(const BaseRun& base, const Draws& draws, const std::vector<std::size_t>& list, Differences& differences,
               std::vector<Eigen::MatrixXd>* states, const Listener& listener) {
  std::vector<Eigen::MatrixXd> found(list.size());
  for_each_index(
      list.size(), [&] { return Twin::Workspace(base.twin); },
      [&](std::size_t i, Twin::Workspace& workspace) {
        try {
          const TwinState state = draws.of(base.twin, list[i]);
          found[i] = base.twin.states(state, base.run, workspace, base.kept.get());
          differences[list[i]] =
              base.twin.read(state, base.run, base.twin.outputs_of(state, base.run, found[i])) - base.readings;
        } catch (const SolveError&) {
        } catch (const RangeError&) {  // outside the range of a law
        }
      },
      listener);
  if (!states) return;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (differences[list[i]]) states->push_back(std::move(found[i]));
  }
}

/// The model on the leading directions of some states.
struct NarrowModel {
  scenarios::ReducedMachine machine;
  std::unique_ptr<const Twin> twin;
  std::unique_ptr<const BaseRun> base;
};

/// @returns null if the states have too many directions, or the machine as written no solution in them
/// @param share  length of a direction that is left out, relative to the first one
std::unique_ptr<const NarrowModel> narrowed(const BaseRun& whole, const std::vector<Eigen::MatrixXd>& states, double share,
                                            const solver::TransientOptions& tolerances) {
  const scenarios::ReducedMachine& machine = whole.twin.machine();
  Eigen::VectorXd start = machine.start;
  const solver::ReducedSystem unit = solver::with_unit_mass(machine.system, start);
  const Eigen::MatrixXd root = machine.system.mass.llt().matrixU();
  const Eigen::Index n = unit.size();
  Eigen::MatrixXd square = whole.states * whole.states.transpose();
  for (const Eigen::MatrixXd& s : states) square.noalias() += (s - whole.states) * (s - whole.states).transpose();
  const dense::SymmetricEigen directions(root * square * root.transpose());
  const double least = share * share * directions.eigenvalues()[n - 1];
  const auto n_kept = static_cast<Eigen::Index>((directions.eigenvalues().array() > least).count());
  Eigen::MatrixXd spanning(n, n_kept + 2);  // 1 K everywhere, which the ambient adds, and the start are exact
  spanning << unit.ones, start, directions.eigenvectors().rightCols(n_kept);
  if (static_cast<double>(spanning.cols()) > kLargestNarrow * static_cast<double>(n)) return nullptr;
  const Eigen::MatrixXd basis = dense::orthonormal_from(spanning).leftCols(spanning.cols());
  auto model = std::make_unique<NarrowModel>();
  model->machine.mesh.regions = machine.mesh.regions;
  model->machine.system = solver::project(unit, basis);
  model->machine.start = basis.transpose() * start;
  model->twin = std::make_unique<Twin>(whole.twin.augmented(), model->machine, tolerances);
  try {
    model->base = std::make_unique<BaseRun>(*model->twin, whole.run);
  } catch (const SolveError&) {
    return nullptr;
  } catch (const RangeError&) {
    return nullptr;
  }
  return model;
}

/// True if the differences of a list agree in each output.
bool agree(const Differences& narrow, const Differences& whole, const std::vector<std::size_t>& list,
           const BaseRun& as_written) {
  Eigen::ArrayXd error = Eigen::ArrayXd::Zero(as_written.readings.rows()), size = error;
  for (const std::size_t d : list) {
    if (!whole[d]) continue;
    if (!narrow[d]) return false;
    error += (*narrow[d] - *whole[d]).rowwise().squaredNorm().array();
    size += whole[d]->rowwise().squaredNorm().array();
  }
  const std::vector<std::string>& units = as_written.twin.outputs().unit;
  Eigen::ArrayXd allowed = kNarrowError * size.sqrt() + 1e-12 * as_written.readings.rowwise().norm().array();  // rounding
  for (Eigen::Index o = 0; o < size.size(); ++o) {
    for (Eigen::Index other = 0; other < size.size(); ++other) {
      if (units[static_cast<std::size_t>(o)] == units[static_cast<std::size_t>(other)])
        allowed[o] = std::max(allowed[o], kNegligible * std::sqrt(size[other]));
    }
  }
  return (error.sqrt() <= allowed).all();
}

}  // namespace

DrawnDifferences drawn_differences(const Twin& twin, const std::vector<Knob>& knobs, const Eigen::MatrixXd& deviations,
                                   const MeasuredRun& run, const solver::TransientOptions& tolerances,
                                   const Listener& listener, Eigen::Index narrowed_from) {
  const auto n_draws = static_cast<std::size_t>(deviations.rows());
  const BaseRun whole(twin, run);
  const Draws draws{knobs, deviations};
  DrawnDifferences drawn{.of = Differences(n_draws), .n_states = whole.states.rows()};
  std::size_t next = 0;
  const auto take = [&](std::size_t n) {
    std::vector<std::size_t> list;
    for (; n > 0 && next < n_draws; --n) list.push_back(next++);
    return list;
  };
  std::unique_ptr<const NarrowModel> narrow;
  if (whole.states.rows() >= narrowed_from) {
    std::vector<Eigen::MatrixXd> states;
    run_draws(whole, draws, take(knobs.size() + 1), drawn.of, &states, {});
    for (int i = 0; i < kMostNarrowings && next < n_draws; ++i) {
      narrow = narrowed(whole, states, kLeastShare * std::pow(kShareStep, i), tolerances);
      if (!narrow) break;
      const std::vector<std::size_t> checked = take(kCheckedDraws);
      Differences of_narrow(n_draws);
      run_draws(*narrow->base, draws, checked, of_narrow, nullptr, {});
      run_draws(whole, draws, checked, drawn.of, &states, {});
      if (agree(of_narrow, drawn.of, checked, whole)) break;
      narrow.reset();
    }
  }
  std::vector<std::size_t> rest = take(n_draws);
  if (narrow) {
    drawn.n_states = narrow->base->states.rows();
    run_draws(*narrow->base, draws, rest, drawn.of, nullptr, listener);
    std::erase_if(rest, [&](std::size_t d) { return drawn.of[d].has_value(); });
  }
  if (!rest.empty()) run_draws(whole, draws, rest, drawn.of, nullptr, listener);
  return drawn;
}

}  // namespace driftwright::studies
