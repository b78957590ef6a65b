#pragma once
// The last hours of a stream, as a page shows them: curves with a limited number of points, a journal of changes, and the
// last line.

#include <cstdint>
#include <deque>
#include <optional>
#include <set>
#include <string>

#include "follow/page_feed.hpp"

namespace driftwright::follow {

class PageHistory {
 public:
  /// @param run  a word that differs for each run of the program, so that pages know when curves start again
  explicit PageHistory(std::string run) : run_(std::move(run)) {}
  void begin(const std::vector<Channel>& channels) { channels_ = channels; }
  void add(PageRow row);

  [[nodiscard]] std::uint64_t n_rows() const { return n_rows_; }
  [[nodiscard]] std::size_t n_points() const { return points_.size(); }
  /// The number of the last row in a message, from the id that a page sends back; 0 for an id of another run.
  [[nodiscard]] std::uint64_t number_of(const std::string& id) const;
  /// A message of Server-Sent Events (event: row) with all that is newer than row `since`; 0: everything, with the column
  /// names.
  /// @pre n_rows() > 0
  [[nodiscard]] std::string news(std::uint64_t since) const;

 private:
  struct Point {
    std::uint64_t number;
    double run_s;
    std::vector<double> numbers;  // predicted, correction, trust of each axis; then the channels
  };
  struct Entry {
    std::uint64_t number;
    double run_s;
    std::string words;
  };
  void note(const PageRow& row);
  void say(double run_s, std::string words);

  std::string run_;
  std::vector<Channel> channels_;
  std::uint64_t n_rows_ = 0;
  double spacing_s_ = 0.0;  // points closer than this are skipped
  std::deque<Point> points_;
  std::deque<Entry> journal_;
  std::optional<Point> tip_;
  PageRow last_;
  std::string state_;               // last state in the journal
  std::set<std::string> standing_;  // alarms and doubts in force, as in the journal
};

}  // namespace driftwright::follow
