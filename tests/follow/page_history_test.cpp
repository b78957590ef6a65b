// What the page of a followed stream keeps of it, and what it lets in.

#include "follow/page_history.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/errors.hpp"
#include "follow/page_server.hpp"

namespace driftwright::follow::page_history_test {
namespace {

PageRow row_at(double run_s, double um = 0.0) {
  PageRow row{.run_s = run_s, .line = {}, .values = {run_s}, .state = {}};
  row.line.run_s = row.line.time_s = run_s;
  row.line.state = "on";
  row.line.axes = {
      {.name = "y", .correction_um = um, .predicted_um = 2.0 * um, .interval_um = {}, .deviation_um = {}, .trust = 1.0}};
  return row;
}

/// The data of a message of Server-Sent Events.
nlohmann::json data_of(const std::string& message) {
  const std::size_t from = message.find("data: ") + 6;
  return nlohmann::json::parse(message.substr(from, message.find("\n\n", from) - from));
}

TEST(PageHistory, IsBoundedOverADayAndKeepsItsLastTwelveHours) {
  PageHistory history("run");
  history.begin({{"speed", "rpm", {}}});
  for (int second = 0; second <= 86400; ++second) history.add(row_at(second, 1e-3 * second));
  EXPECT_LE(history.n_points(), 3000U);
  EXPECT_GE(history.n_points(), 1000U);  // halved where they get too many
  const nlohmann::json all = data_of(history.news(0));
  EXPECT_GE(all["points"].front()[0].get<double>(), 43200.0);
  EXPECT_LE(all["points"].front()[0].get<double>(), 43200.0 + 60.0);
  double before_s = 0.0;
  for (const nlohmann::json& point : all["points"]) {  // each where its row was
    EXPECT_GT(point[0].get<double>(), before_s);
    before_s = point[0].get<double>();
    EXPECT_DOUBLE_EQ(point[2].get<double>(), 1e-3 * before_s);
    EXPECT_DOUBLE_EQ(point[1].get<double>(), 2e-3 * before_s);
  }
  EXPECT_EQ(all["tip"][0], 86400);
  EXPECT_EQ(all["line"]["axes"]["y"]["correction_um"], 86.4);
}

TEST(PageHistory, TellsWhoComesBackWhatCameSinceAndANewcomerAll) {
  PageHistory history("run");
  history.begin({{"speed", "rpm", {}}});
  for (int k = 1; k <= 5; ++k) history.add(row_at(k));
  EXPECT_EQ(history.number_of("run-3"), 3U);
  const nlohmann::json since = data_of(history.news(3));
  ASSERT_EQ(since["points"].size(), 2U);
  EXPECT_EQ(since["points"][0][0], 4);
  EXPECT_FALSE(since.contains("head"));
  for (const char* strange : {"", "other-3", "run-", "run-99", "run--1", "run-3x", "run-99999999999999999999"})
    EXPECT_EQ(history.number_of(strange), 0U) << strange;
  EXPECT_EQ(data_of(history.news(0))["head"]["axes"][0], "y");
}

TEST(PageHistory, SaysWhatHasChangedOnceAndPassesOverSingleRows) {
  PageHistory history("run");
  history.begin({});
  PageRow late = row_at(2), silent = row_at(3), alarmed = row_at(4);
  late.line.run_s.reset();
  late.line.state = "held";
  late.line.faults = {"late"};
  silent.line.run_s = silent.line.time_s = std::nullopt;
  silent.line.state = "held";
  silent.line.why = "no row for 5 s";
  alarmed.line.axes[0].alarm = "since 4 min: <b>t06</b> is \"warm\"";
  alarmed.line.axes[0].doubted = {"t07"};
  for (const PageRow& row : {row_at(1), late, row_at(2.5), silent, silent, alarmed, alarmed, row_at(5)}) history.add(row);
  std::vector<std::string> words;
  const nlohmann::json all = data_of(history.news(0));
  for (const nlohmann::json& entry : all["journal"]) words.push_back(entry["words"]);
  EXPECT_THAT(words,
              testing::ElementsAre("on", "held: no row for 5 s", "on", "alarm of y: since 4 min: <b>t06</b> is \"warm\"",
                                   "t07 in doubt for y", "alarm of y: no longer", "t07 in doubt for y: no longer"));
}

TEST(PageFeed, NeverWaitsAndIsBoundedWhereNobodyTakes) {
  PageFeed feed;
  for (int k = 0; k < 100000; ++k) feed.offer(row_at(k));
  const std::deque<PageRow> rows = feed.taken();
  ASSERT_LE(rows.size(), 1000U);
  EXPECT_EQ(rows.back().run_s, 99999.0);
  EXPECT_TRUE(feed.taken().empty());
}

TEST(PageFeed, HandsOnInOrderAndToTheLastRow) {
  PageFeed feed;
  std::atomic<bool> is_over = false;
  std::vector<double> got;
  std::thread taking([&] {
    for (bool is_last = false; !is_last;) {
      is_last = is_over;
      for (const PageRow& row : feed.taken()) got.push_back(row.run_s);
    }
  });
  for (int k = 0; k < 5000; ++k) {
    feed.offer(row_at(k));
    if (k % 100 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  for (int again = 0; again < 20; ++again) {  // as a stream without rows does
    feed.hand_on();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  is_over = true;
  taking.join();
  for (const PageRow& row : feed.taken()) got.push_back(row.run_s);
  EXPECT_TRUE(std::is_sorted(got.begin(), got.end()));
  EXPECT_EQ(got.back(), 4999.0);
}

TEST(PageServer, TokensAreTheSameOrNot) {
  EXPECT_TRUE(is_same_token("0123456789abcdef", "0123456789abcdef"));
  for (const char* wrong :
       {"", "0", "0123456789abcdeg", "0123456789abcde", "0123456789abcdef0", "0123456789abcdef0123456789abcdef"})
    EXPECT_FALSE(is_same_token(wrong, "0123456789abcdef")) << wrong;
}

TEST(PageServer, ListensBeyondLoopbackWithATokenAlone) {
  const std::string token = "0123456789abcdef";
  for (const char* host : {"127.0.0.1", "127.1.2.3", "::1", "localhost"})
    EXPECT_NO_THROW(require_safe({host, 8080, ""})) << host;
  for (const char* host : {"0.0.0.0", "::", "10.0.0.7", "127.evil.org", "mill", ""}) {
    EXPECT_THROW(require_safe({host, 8080, ""}), InputError) << host;
    EXPECT_NO_THROW(require_safe({host, 8080, token})) << host;
  }
  EXPECT_THROW(require_safe({"127.0.0.1", 8080, "short"}), InputError);
  EXPECT_THROW(require_safe({"127.0.0.1", 65536, ""}), InputError);
}

}  // namespace
}  // namespace driftwright::follow::page_history_test
