#pragma once
// Programmes of speeds before a job, run on the model from the state that the machine is in.

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "compensation/predictors/observed_run.hpp"
#include "solver/propagator.hpp"
#include "studies/warm_up.hpp"

namespace driftwright::studies {

/// Calls may come from several threads.
class WarmUpTrials {
 public:
  /// @param job       outlives this
  /// @param most_rpm  no programme is faster
  /// @throws InputError  as plan_warm_up()
  WarmUpTrials(const scenarios::Scenario& scenario, const Cyclogram& job, const WarmUpOptions& options, double most_rpm,
               const Listener& listener);
  /// The same programmes on another model of that machine. @param same  its job outlives this
  WarmUpTrials(const WarmUpTrials& same, std::shared_ptr<const scenarios::Model> other);

  /// Rows of the job behind a warm-up, times and displacements from its first row on.
  [[nodiscard]] Record job_rows(const std::vector<Cyclogram::Section>& sections) const;
  /// What was before, the warm-up and the job as one run, with true readings. @param n_before  rows in front of the job's first
  [[nodiscard]] compensation::ObservedRun whole_run(const std::vector<Cyclogram::Section>& sections, std::size_t& n_before) const;
  /// A programme that the machine has no solution for is not enough.
  [[nodiscard]] WarmUp tried(std::vector<Cyclogram::Section> sections, double tolerance_um) const;

  [[nodiscard]] const Outlook& ahead() const { return ahead_; }
  /// When a warm-up begins, and the state of the model then.
  [[nodiscard]] double now_s() const { return now_s_; }
  [[nodiscard]] const Eigen::VectorXd& now() const { return now_; }
  [[nodiscard]] double interval_s() const { return interval_s_; }
  [[nodiscard]] const Cyclogram& job() const { return job_; }
  [[nodiscard]] const std::vector<std::string>& channels() const { return channels_; }
  [[nodiscard]] int n_tried() const { return n_tried_; }

 private:
  /// Brings the model to the moment that the warm-up begins at.
  void go_to_now();
  /// The job behind a warm-up, and when it begins. @param before  what was before
  [[nodiscard]] Cyclogram joined(const Cyclogram& before, const std::vector<Cyclogram::Section>& sections, double& start_s) const;
  /// The largest drift of each channel that counts, by exponentials alone [um].
  [[nodiscard]] std::vector<double> linear_peaks_um(const std::vector<Cyclogram::Section>& sections) const;

  const Cyclogram& job_;
  solver::TransientOptions transient_;
  double interval_s_ = 0.0;
  Outlook ahead_;
  double now_s_ = 0.0;
  Cyclogram before_, whole_before_;
  bool reads_back_ = false;  ///< instruments remember
  Eigen::VectorXd now_;
  std::vector<std::string> channels_;
  std::vector<Eigen::Index> outputs_;        ///< of the model, which they are
  bool is_linear_ = false;                   ///< reduced, without laws of temperature and without memories of instruments
  mutable std::mutex idle_mutex_;
  mutable std::vector<std::unique_ptr<solver::Propagator>> idle_;  ///< each with the decompositions that it has met
  mutable std::atomic<int> n_tried_ = 0;
};

}  // namespace driftwright::studies
