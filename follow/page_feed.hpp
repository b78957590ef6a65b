#pragma once
// Hands rows from the stream's thread to the page's thread, so that the stream never waits.

#include <Eigen/Core>
#include <deque>
#include <mutex>
#include <vector>

#include "follow/session.hpp"

namespace driftwright::follow {

/// What a page shows of one line.
struct PageRow {
  double run_s = 0.0;  ///< of the row; without a row for a while, time since the first row
  FollowLine line;
  std::vector<double> values;  ///< of the channels, from the last row taken; NaN where missing
  Eigen::VectorXd state;       ///< of the machine's model; empty if no machine is drawn
  double ambient_K = 0.0;      ///< over the reference, with `state`
};

/// A queue between two threads, one that gives and one that takes. The giving thread never waits: while the other one is
/// taking, rows stay with the giver until its next call. If rows arrive faster than they are taken, the oldest are
/// dropped, so that memory is bounded.
class PageFeed {
 public:
  void offer(PageRow row);
  /// Retries what the last offer() kept. Call it when there are no rows.
  void hand_on();
  /// All rows since the last call.
  [[nodiscard]] std::deque<PageRow> taken();

 private:
  std::deque<PageRow> kept_;  // used by the giving thread only
  std::mutex mutex_;          // held only while two lists are swapped
  std::deque<PageRow> given_;
};

}  // namespace driftwright::follow
