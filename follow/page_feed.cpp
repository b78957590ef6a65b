#include "follow/page_feed.hpp"

namespace driftwright::follow {
namespace {

constexpr std::size_t kMostRows = 1000;

}  // namespace

void PageFeed::offer(PageRow row) {
  if (kept_.size() >= kMostRows) kept_.pop_front();
  kept_.push_back(std::move(row));
  hand_on();
}

void PageFeed::hand_on() {
  if (kept_.empty()) return;
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock.owns_lock()) return;
  for (PageRow& row : kept_) {
    if (given_.size() >= kMostRows) given_.pop_front();
    given_.push_back(std::move(row));
  }
  kept_.clear();
}

std::deque<PageRow> PageFeed::taken() {
  std::deque<PageRow> rows;
  const std::lock_guard lock(mutex_);
  rows.swap(given_);
  return rows;
}

}  // namespace driftwright::follow
