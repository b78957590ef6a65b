#pragma once
// Runs programmes of speeds before a job on the model, from the machine's present state.

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "base/machine_run.hpp"
#include "solver/propagator.hpp"
#include "studies/warm_up.hpp"

namespace driftwright::studies {

/// The trials of one job. Calls may come from several threads.
class WarmUpTrials {
 public:
  /// @param job       must outlive this
  /// @param most_rpm  fastest speed of any programme
  /// @throws InputError  as plan_warm_up()
  WarmUpTrials(const scenarios::Scenario& scenario, const Cyclogram& job, const WarmUpOptions& options, double most_rpm,
               const Listener& listener);
  /// The same programmes on another model of that machine. @param same  its job must outlive this
  WarmUpTrials(const WarmUpTrials& same, std::shared_ptr<const scenarios::Model> other);

  /// Rows of the job after a warm-up, with times and displacements relative to its first row.
  [[nodiscard]] Record job_rows(const std::vector<Cyclogram::Section>& sections) const;
  /// The run before, the warm-up and the job as one run, with true readings. @param n_before  number of rows before the
  /// job's first row
  [[nodiscard]] MachineRun whole_run(const std::vector<Cyclogram::Section>& sections, std::size_t& n_before) const;
  /// Runs a programme; one for which the machine has no solution counts as not enough.
  [[nodiscard]] WarmUp tried(std::vector<Cyclogram::Section> sections, double tolerance_um) const;

  [[nodiscard]] const Outlook& ahead() const { return ahead_; }
  /// The time at which a warm-up begins, and the state of the model then.
  [[nodiscard]] double now_s() const { return now_s_; }
  [[nodiscard]] const Eigen::VectorXd& now() const { return now_; }
  [[nodiscard]] double interval_s() const { return interval_s_; }
  [[nodiscard]] const Cyclogram& job() const { return job_; }
  [[nodiscard]] const std::vector<std::string>& channels() const { return channels_; }
  [[nodiscard]] int n_tried() const { return n_tried_; }

 private:
  /// Runs the model to the time at which the warm-up begins.
  void go_to_now();
  /// The job after a warm-up, and its start time. @param before  the run before
  [[nodiscard]] Cyclogram joined(const Cyclogram& before, const std::vector<Cyclogram::Section>& sections,
                                 double& start_s) const;
  /// The largest drift of each judged channel, by exponentials alone [um].
  [[nodiscard]] std::vector<double> linear_peaks_um(const std::vector<Cyclogram::Section>& sections) const;

  const Cyclogram& job_;
  solver::TransientOptions transient_;
  double interval_s_ = 0.0;
  Outlook ahead_;
  double now_s_ = 0.0;
  Cyclogram before_, whole_before_;
  bool reads_back_ = false;  ///< instruments depend on earlier rows
  Eigen::VectorXd now_;
  std::vector<std::string> channels_;
  std::vector<Eigen::Index> outputs_;  ///< indices of these channels in the model
  bool is_linear_ = false;             ///< reduced, no laws of temperature, no instruments with memory
  mutable std::mutex idle_mutex_;
  mutable std::vector<std::unique_ptr<solver::Propagator>> idle_;  ///< each keeps the decompositions that it has made
  mutable std::atomic<int> n_tried_ = 0;
};

}  // namespace driftwright::studies
