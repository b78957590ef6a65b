#pragma once
// Programmes of speeds before a job, run on the model from the state that the machine is in.

#include <atomic>
#include <string>
#include <vector>

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

  /// Rows of the job behind a warm-up, times and displacements from its first row on.
  [[nodiscard]] Record job_rows(const std::vector<Cyclogram::Section>& sections) const;
  /// A programme that the machine has no solution for is not enough.
  [[nodiscard]] WarmUp tried(std::vector<Cyclogram::Section> sections, double tolerance_um) const;

  [[nodiscard]] const Outlook& ahead() const { return ahead_; }
  [[nodiscard]] const Cyclogram& job() const { return job_; }
  [[nodiscard]] const std::vector<std::string>& channels() const { return channels_; }
  [[nodiscard]] int n_tried() const { return n_tried_; }

 private:
  const Cyclogram& job_;
  solver::TransientOptions transient_;
  double interval_s_ = 0.0;
  Outlook ahead_;
  double now_s_ = 0.0;
  Cyclogram before_;
  bool reads_back_ = false;  ///< instruments remember
  Eigen::VectorXd now_;
  std::vector<std::string> channels_;
  mutable std::atomic<int> n_tried_ = 0;
};

}  // namespace driftwright::studies
