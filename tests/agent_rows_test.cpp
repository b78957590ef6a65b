// Rows of MTConnect agents whose clocks are set or whose answers do not go on. The agent is a server whose answers the test writes.

#include "follow/agent_rows.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <thread>

#include "base/errors.hpp"
#include "follow/bounded_server.hpp"

namespace driftwright::follow::agent_rows_test {
namespace {

using namespace std::chrono_literals;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using ::testing::ThrowsMessage;

/// Seconds behind noon of 2026-11-23, as agents and as rows write them.
std::string stamp(int seconds) {
  return fmt::format("2026-11-23T{:02d}:{:02d}:{:02d}Z", 12 + seconds / 3600, seconds / 60 % 60, seconds % 60);
}
constexpr int kNoon_s = 1795435200;

struct Observed {
  int sequence, at_s, rpm;
};

std::string streams(int created_s, int next, int last, const std::vector<Observed>& observations) {
  std::string samples;
  for (const Observed& o : observations)
    samples +=
        fmt::format(R"(<RotaryVelocity dataItemId="s1" name="speed" sequence="{}" timestamp="{}">{}</RotaryVelocity>)",
                    o.sequence, stamp(o.at_s), o.rpm);
  return fmt::format(R"(<MTConnectStreams><Header creationTime="{}" instanceId="1" nextSequence="{}" lastSequence="{}"/>)"
                     R"(<Streams><Samples>{}</Samples></Streams></MTConnectStreams>)",
                     stamp(created_s), next, last, samples);
}

/// Answers `/current` by one text, and questions for samples by others in turn; the last one again and again.
class Agent {
 public:
  Agent(std::string current, std::vector<std::string> samples)
      : server_("127.0.0.1", 0,
                [this, current = std::move(current), samples = std::move(samples)](const HttpRequest& request) {
                  if (request.path == "/current") return plain_answer(200, current);
                  const std::lock_guard lock(mutex_);
                  asked_from_.push_back(value_of(request.query, "from"));
                  return plain_answer(200, samples.at(std::min(asked_from_.size(), samples.size()) - 1));
                }),
        thread_([this] {
          while (!is_over_) server_.turn(5ms);
        }) {}
  ~Agent() {
    is_over_ = true;
    thread_.join();
  }
  [[nodiscard]] std::string url() const { return fmt::format("http://127.0.0.1:{}", server_.port()); }
  [[nodiscard]] std::vector<std::string> asked_from() {
    const std::lock_guard lock(mutex_);
    return asked_from_;
  }

 private:
  std::mutex mutex_;
  std::vector<std::string> asked_from_;
  std::atomic<bool> is_over_ = false;
  BoundedServer server_;
  std::thread thread_;
};

HeardValues speed() {
  return {{{"speed_rpm", "speed"}}, std::numeric_limits<double>::infinity()};
}

/// Rows behind the header, as seconds behind noon and the speed, until there are so many or the time is over.
std::vector<std::pair<double, double>> rows(RowSource& source, std::size_t n, std::chrono::milliseconds within = 10s) {
  std::vector<std::pair<double, double>> list;
  std::string line;
  (void)source.next(line, 0.0);
  for (const auto until = std::chrono::steady_clock::now() + within;
       list.size() < n && std::chrono::steady_clock::now() < until;) {
    if (source.next(line, 0.05) != RowSource::Got::kLine) continue;
    const std::size_t comma = line.find(',');
    list.emplace_back(std::stod(line.substr(0, comma)) - kNoon_s, std::stod(line.substr(comma + 1)));
  }
  return list;
}

TEST(SampleRows, AnObservationFarAheadOfTheAgentsOwnTimeIsOfThatTime) {
  // An adapter's clock is an hour ahead: what others observe meanwhile would be late for an hour.
  Agent agent(streams(0, 2, 1, {{1, 0, 1000}}),
              {streams(10, 3, 2, {{2, 3610, 1500}}), streams(20, 4, 3, {{3, 15, 1800}}), streams(20, 4, 3, {})});
  SampleRows source(agent.url(), speed(), 0.05, [](const std::string&) {});
  EXPECT_THAT(rows(source, 4), ElementsAre(std::pair(0.0, 1000.0), std::pair(10.0, 1500.0), std::pair(15.0, 1800.0),
                                           std::pair(20.0, 1800.0)));
}

TEST(SampleRows, AnObservationThatComesBehindARowOfLaterTimeIsNotLost) {
  // Observed before the answer that lacks them, by a clock that is behind the agent's: a spindle that turned for a moment.
  Agent agent(streams(0, 2, 1, {{1, 0, 1000}}),
              {streams(10, 2, 1, {}), streams(20, 4, 3, {{2, 9, 1500}, {3, 10, 1800}}), streams(20, 4, 3, {})});
  SampleRows source(agent.url(), speed(), 0.05, [](const std::string&) {});
  const auto told = rows(source, 5);
  ASSERT_THAT(told, SizeIs(5));
  EXPECT_EQ(told[1], std::pair(10.0, 1000.0));
  EXPECT_NEAR(told[2].first, 10.001, 1e-6);
  EXPECT_EQ(told[2].second, 1500.0);
  EXPECT_NEAR(told[3].first, 10.002, 1e-6);
  EXPECT_EQ(told[3].second, 1800.0);
  EXPECT_EQ(told[4], std::pair(20.0, 1800.0));
}

TEST(SampleRows, GoOnByAnAgentsClockThatIsSetBack) {
  Agent agent(streams(7200, 2, 1, {{1, 7200, 1000}}),
              {streams(7210, 3, 2, {{2, 7205, 1500}}), streams(3620, 4, 3, {{3, 3615, 1800}}), streams(3620, 4, 3, {})});
  SampleRows source(agent.url(), speed(), 0.05, [](const std::string&) {});
  const auto told = rows(source, 5);
  ASSERT_THAT(told, SizeIs(5));
  EXPECT_EQ(told[2], std::pair(7210.0, 1500.0));
  EXPECT_EQ(told[3], std::pair(3615.0, 1800.0));  // and not silent for the hour that comes again
  EXPECT_EQ(told[4], std::pair(3620.0, 1800.0));
}

TEST(SampleRows, SayThatAnAnswerDoesNotGoOnAndAskAgainAtTheirPace) {
  for (const std::string& answer : {streams(10, 2, 5, {{2, 5, 1500}}),  // goes on with what was asked for, for ever
                                    streams(10, 1, 5, {{2, 5, 1500}}), streams(10, 0, 5, {})}) {
    Agent agent(streams(0, 2, 1, {{1, 0, 1000}}), {answer});
    std::vector<std::string> said;
    SampleRows source(agent.url(), speed(), 0.2, [&](const std::string& words) { said.push_back(words); });
    EXPECT_THAT(rows(source, 2, 1s), ElementsAre(std::pair(0.0, 1000.0)));  // nothing that may be there twice
    EXPECT_THAT(said, ElementsAre(HasSubstr("does not continue after observation 2"))) << answer;
    EXPECT_THAT(agent.asked_from(), SizeIs(::testing::Le(7U)));  // in 1 s, every 0.2 s
    EXPECT_THAT(agent.asked_from(), ::testing::Each("2"));
  }
}

TEST(CurrentRows, AskWhichOfTwoItemsOfOneNameIsMeant) {
  std::string two = streams(0, 3, 2, {{1, 0, 1000}, {2, 0, 500}});
  two.at(two.rfind("\"s1\"") + 2) = '2';
  Agent agent(two, {two});
  CurrentRows source(agent.url(), speed(), 0.05, [](const std::string&) {});
  EXPECT_THAT([&] { (void)rows(source, 1); },
              ThrowsMessage<InputError>(HasSubstr("several data items have that name, s1, s2")));
}

}  // namespace
}  // namespace driftwright::follow::agent_rows_test
