#pragma once
// From the stream to the page that shows it: handed on so that the stream never waits.

#include <Eigen/Core>
#include <deque>
#include <mutex>
#include <vector>

#include "follow/session.hpp"

namespace driftwright::follow {

/// What a page shows of one line.
struct PageRow {
  double run_s = 0.0;  ///< of the row, or since the first row where no row was taken for a while
  FollowLine line;
  std::vector<double> values;  ///< of the channels, of the row taken last; NaN where missing
  Eigen::VectorXd state;       ///< of the machine's model; empty where nothing is drawn of it
  double ambient_K = 0.0;      ///< over the reference, with that
};

/// Two threads, one that gives and one that takes. The giving one never waits: where the other is just taking, its rows stay with it until the next
/// call. Where rows come faster than they are taken the oldest are passed over, so that memory is bounded.
class PageFeed {
 public:
  void offer(PageRow row);
  /// Tries again what the last offer() kept. For times without rows.
  void hand_on();
  /// All that came since the last call.
  [[nodiscard]] std::deque<PageRow> taken();

 private:
  std::deque<PageRow> kept_;  // of the giving thread alone
  std::mutex mutex_;          // held for as long as two lists take to change places
  std::deque<PageRow> given_;
};

}  // namespace driftwright::follow
