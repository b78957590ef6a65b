// Rows of MTConnect agents whose clocks are set or whose answers do not go on. The agent is a server whose answers the
// test writes.

#include "follow/agent_rows.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <thread>

#include "base/errors.hpp"
#include "follow/bounded_server.hpp"
#include "follow/row_text.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::follow::agent_rows_test {
namespace {

using namespace std::chrono_literals;
using ::testing::AllOf, ::testing::Contains, ::testing::ElementsAre, ::testing::HasSubstr, ::testing::SizeIs;
using ::testing::ThrowsMessage;

/// Seconds after noon of 2026-11-23, as agents and rows write them.
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

constexpr const char* kProbe =
    R"(<MTConnectDevices><Header/><Devices><Device id="d"><DataItems><DataItem id="s1" type="ROTARY_VELOCITY" units="REVOLUTION/MINUTE"/>)"
    R"(</DataItems></Device></Devices></MTConnectDevices>)";

/// Answers `/current` by one text, and questions for samples by others in turn; the last one again and again.
class Agent {
 public:
  Agent(std::string current, std::vector<std::string> samples, std::string probe = kProbe)
      : server_("127.0.0.1", 0,
                [this, current = std::move(current), samples = std::move(samples),
                 probe = std::move(probe)](const HttpRequest& request) {
                  if (request.path == "/probe") {
                    ++n_probes_;
                    return plain_answer(200, probe);
                  }
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
  [[nodiscard]] int n_probes() const { return n_probes_; }

 private:
  std::mutex mutex_;
  std::vector<std::string> asked_from_;
  std::atomic<bool> is_over_ = false;
  std::atomic<int> n_probes_ = 0;
  BoundedServer server_;
  std::thread thread_;
};

HeardValues speed() {
  return {{{"speed_rpm", "speed"}}, std::numeric_limits<double>::infinity()};
}

/// Rows after the header, as seconds after noon and the speed, until there are enough or the time is over.
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

// A probing is in one row, whether its message comes once or is asked for again and again; one from before does not count.
TEST(HeardValues, AProbingIsInOneRowAlone) {
  HeardValues values({{"t_degC", "t"}, {"probe_y_um", "p"}}, std::numeric_limits<double>::infinity());
  values.hear("t", "21");
  values.hear_former("p", "3", 7);
  EXPECT_EQ(values.row(1.0), "1.000,21,");
  values.hear("p", "3", 7);  // the same observation
  EXPECT_EQ(values.row(2.0), "2.000,21,");
  values.hear("p", "4", 8);
  EXPECT_EQ(values.row(3.0), "3.000,21,4");
  EXPECT_EQ(values.row(4.0), "4.000,21,");
  values.hear("p", "4");  // a message: each one is new
  EXPECT_EQ(values.row(5.0), "5.000,21,4");
  values.hear("p", "4");
  EXPECT_EQ(values.row(6.0), "6.000,21,4");
  values.hear_former("p", "5");
  EXPECT_EQ(values.row(7.0), "7.000,21,");
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
  // The observations are older than the answer that lacks them, because their clock is slower than the agent's: a spindle
  // that turned for a moment.
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

// --- units
// ------------------------------------------------------------------------------------------------------------------------

struct Item {
  const char* element;
  const char* attributes;  ///< of the observation
  const char* number;
};

std::string observed(const Item& item) {
  return fmt::format(
      R"(<MTConnectStreams><Header creationTime="{}" instanceId="1" nextSequence="2" lastSequence="1"/><Streams><Samples>)"
      R"(<{} dataItemId="i1" name="item" sequence="1" timestamp="{}" {}>{}</{}></Samples></Streams></MTConnectStreams>)",
      stamp(0), item.element, stamp(0), item.attributes, item.number, item.element);
}

std::string probe_of(const std::string& attributes) {
  return fmt::format(
      R"(<MTConnectDevices><Devices><Device id="d"><Components><Axes id="a"><DataItems><DataItem id="i1" {}/></DataItems></Axes>)"
      R"(</Components></Device></Devices></MTConnectDevices>)",
      attributes);
}

/// The first cell that a channel of that header has, and what is said.
struct Told {
  std::string cell;
  std::vector<std::string> said;
};

Told told(const std::string& header, const Item& item, const std::string& probe,
          const std::optional<ColumnMap>& columns = std::nullopt, bool samples = false) {
  Agent agent(observed(item), {streams(0, 2, 1, {})}, probe);
  HeardValues values({{header, "item", column_units({"time_s", header}, columns)[1]}}, 60.0);
  Told result;
  const Say say = [&](const std::string& words) { result.said.push_back(words); };
  std::unique_ptr<RowSource> source;
  if (samples)
    source = std::make_unique<SampleRows>(agent.url(), values, 0.05, say);
  else
    source = std::make_unique<CurrentRows>(agent.url(), values, 0.05, say);
  std::string line;
  (void)source->next(line, 0.0);
  for (const auto until = std::chrono::steady_clock::now() + 10s; std::chrono::steady_clock::now() < until;) {
    if (source->next(line, 0.05) == RowSource::Got::kLine) break;
  }
  result.cell = line.substr(line.find(',') + 1);
  EXPECT_EQ(agent.n_probes(), 1);
  return result;
}

struct Unit {
  const char* name;
  const char* header;
  Item item;
  const char* probe;  ///< attributes of the data item
  double value;
};

class ItemUnit : public ::testing::TestWithParam<Unit> {};

TEST_P(ItemUnit, IsTheProbesAndBecomesTheChannels) {
  for (const bool samples : {false, true}) {
    const Told result = told(GetParam().header, GetParam().item, probe_of(GetParam().probe), std::nullopt, samples);
    EXPECT_NEAR(std::stod(result.cell), GetParam().value, 1e-9);
    EXPECT_THAT(result.said, SizeIs(0));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Each, ItemUnit,
    ::testing::Values(
        Unit{"feed_of_an_axis", "feed_x_mm_min", {"AxisFeedrate", "", "50"}, "units='MILLIMETER/SECOND'", 3000},
        Unit{"feed_that_an_agent_gives_otherwise", "feed_x_mm_min", {"AxisFeedrate", "", "50"}, "units='INCH/MINUTE'", 1270},
        Unit{"native_units_are_not_the_agents",
             "feed_x_mm_min",
             {"PathFeedrate", "", "50"},
             "units='MILLIMETER/SECOND' nativeUnits='FOOT/MINUTE'",
             3000},
        Unit{"speed", "speed_rpm", {"RotaryVelocity", "", "50"}, "units='REVOLUTION/MINUTE'", 50},
        Unit{"speed_per_second", "speed_rpm", {"RotaryVelocity", "", "50"}, "units='REVOLUTION/SECOND'", 3000},
        Unit{"speed_in_degrees", "speed_rpm", {"AngularVelocity", "", "60"}, "units='DEGREE/SECOND'", 10},
        Unit{"temperature", "t_degC", {"Temperature", "", "21.5"}, "units='CELSIUS'", 21.5},
        Unit{"temperature_in_fahrenheit", "t_degC", {"Temperature", "", "50"}, "units='FAHRENHEIT'", 10},
        Unit{"position", "x_um", {"Position", "", "-0.0125"}, "units='MILLIMETER'", -12.5},
        Unit{"tilt", "a_urad", {"Tilt", "", "7"}, "units='MICRO_RADIAN'", 7},
        Unit{"load", "load_percent", {"Load", "", "40"}, "units='PERCENT'", 40},
        Unit{"load_as_a_share", "load_1", {"Load", "", "40"}, "units='PERCENT'", 0.4},
        Unit{"parts", "parts_count", {"PartCount", "", "7"}, "units='COUNT'", 7},
        Unit{"power", "p_W", {"Wattage", "", "1500"}, "units='WATT'", 1500},
        Unit{"power_in_kilowatt", "p_W", {"Wattage", "", "1.5"}, "units='KILOWATT'", 1500}),
    [](const auto& each) { return std::string(each.param.name); });

struct ByStandard {
  const char* header;
  Item item;
  double value;
};

TEST(ItemUnits, AreTheStandardsWhereTheProbeGivesNone) {
  for (const ByStandard& c :
       {ByStandard{"feed_x_mm_min", {"AxisFeedrate", "", "50"}, 3000},
        ByStandard{"feed_x_mm_min", {"PathFeedrate", "", "50"}, 3000},
        ByStandard{"override_percent", {"PathFeedrate", "subType='OVERRIDE'", "50"}, 50},
        ByStandard{"speed_rpm", {"SpindleSpeed", "", "50"}, 50}, ByStandard{"a_urad", {"Tilt", "", "50"}, 50},
        ByStandard{"u_V", {"VoltageAC", "", "50"}, 50}}) {
    const Told no_units = told(c.header, c.item, probe_of("type='X'"));
    EXPECT_NEAR(std::stod(no_units.cell), c.value, 1e-9) << c.item.element;
    EXPECT_THAT(no_units.said,
                ElementsAre(AllOf(HasSubstr("its probe gives no units for them, so the standard's units are taken"),
                                  HasSubstr(c.item.element))));
    const Told no_probe = told(c.header, c.item, "<!DOCTYPE html><html><br></html>");
    EXPECT_NEAR(std::stod(no_probe.cell), c.value, 1e-9);
    EXPECT_THAT(no_probe.said, ElementsAre(HasSubstr("it gives no probe (its answer is no XML), so the standard's units")));
  }
  const Told own = told("speed_rpm", {"SpindleTemper", "", "50"}, probe_of("type='x:SPINDLE_TEMPER'"));
  EXPECT_EQ(own.cell, "50");
  EXPECT_THAT(own.said, ElementsAre(AllOf(HasSubstr("the standard has none for their types"),
                                          HasSubstr("item (SpindleTemper) in rpm"))));
}

struct OtherQuantity {
  const char* header;
  Item item;
  const char* units;
  const char* why;
};

TEST(ItemUnits, OfAnotherQuantityAreRefused) {
  for (const OtherQuantity& c :
       {OtherQuantity{"feed_x_mm_min", {"Position", "", "5"}, "MILLIMETER", "MILLIMETER (by its probe)"},
        OtherQuantity{"speed_rpm", {"RotaryVelocity", "", "5"}, "PERCENT", "must convert to the channel's unit 'rpm'"},
        OtherQuantity{"speed_rpm", {"Frequency", "", "5"}, "HERTZ", "must convert to the channel's unit 'rpm'"},
        OtherQuantity{"wait_s", {"Frequency", "", "5"}, "HERTZ", "another quantity"},  // 1/5 s is another quantity
        OtherQuantity{"rise_K", {"Temperature", "", "5"}, "CELSIUS", "a difference of two"},
        OtherQuantity{"x_um", {"PathPosition", "", "1 2 3"}, "MILLIMETER_3D", "three numbers"},
        OtherQuantity{"noise_1", {"SoundLevel", "", "5"}, "DECIBEL", "unknown unit"},
        OtherQuantity{"feed_x_mm_min", {"Position", "", "5"}, "", "MILLIMETER (by the standard)"}}) {
    EXPECT_THAT([&] { (void)told(c.header, c.item, probe_of(fmt::format("units='{}'", c.units))); },
                ThrowsMessage<InputError>(
                    AllOf(HasSubstr(fmt::format("--topic {}=item", c.header)), HasSubstr(c.units), HasSubstr(c.why))))
        << c.header;
  }
}

TEST(ItemUnits, BecomeThoseOfAMapWithoutAFactor) {
  const auto map = [](double factor, double offset) {
    ColumnMap columns;
    columns.channels = {{"feed_x", "mm_min", {"Feed X", 0, {}}, "m/min", factor, offset, false}};
    return columns;
  };
  const Item item{"AxisFeedrate", "", "50"};
  EXPECT_NEAR(std::stod(told("Feed X", item, probe_of("units='MILLIMETER/SECOND'"), map(1, 0)).cell), 3, 1e-12);
  EXPECT_REFUSED(told("Feed X", item, probe_of("units='MILLIMETER/SECOND'"), map(0.06, 0)),
                 "write that unit into the map, without a factor or an offset");
  EXPECT_EQ(told("Feed X", item, probe_of("units='METER/MINUTE'"), map(0.5, 0)).cell, "50");
}

TEST(ItemUnits, AreAskedForAgainWhereTheAgentIsBusyAndThenTheStandardsAreTaken) {
  // A server that is busy at /probe: it is asked three times.
  std::atomic<int> n_asked = 0;
  std::atomic<bool> is_over = false;
  BoundedServer server("127.0.0.1", 0, [&](const HttpRequest& request) {
    if (request.path == "/probe") {
      ++n_asked;
      return plain_answer(503, "busy");
    }
    return plain_answer(200, observed({"AxisFeedrate", "", "50"}));
  });
  std::thread thread([&] {
    while (!is_over) server.turn(5ms);
  });
  std::vector<std::string> said;
  CurrentRows source(fmt::format("http://127.0.0.1:{}", server.port()),
                     {{{"feed_x_mm_min", "item", {"mm/min", false, false}}}, 60.0}, 0.05,
                     [&](const std::string& words) { said.push_back(words); });
  EXPECT_EQ(rows(source, 1).at(0).second, 3000.0);
  is_over = true;
  thread.join();
  EXPECT_EQ(n_asked, 3);
  EXPECT_THAT(said, Contains(HasSubstr("HTTP status 503")));
  EXPECT_THAT(said, Contains(HasSubstr("standard's units are taken: item (AxisFeedrate) in MILLIMETER/SECOND")));
}

TEST(ItemUnits, AreAskedForAgainWhereTheAgentIsStartedAnew) {
  std::atomic<int> instance = 1;
  std::atomic<bool> is_over = false;
  BoundedServer server("127.0.0.1", 0, [&](const HttpRequest& request) {
    if (request.path == "/probe")
      return plain_answer(200, probe_of(instance == 1 ? "units='MILLIMETER/SECOND'" : "units='MILLIMETER/MINUTE'"));
    std::string text = observed({"AxisFeedrate", "", "50"});
    text.replace(text.find("instanceId=\"1"), 13, fmt::format("instanceId=\"{}", instance.load()));
    return plain_answer(200, text);
  });
  std::thread thread([&] {
    while (!is_over) server.turn(5ms);
  });
  CurrentRows source(fmt::format("http://127.0.0.1:{}", server.port()),
                     {{{"feed_x_mm_min", "item", {"mm/min", false, false}}}, 60.0}, 0.05, [](const std::string&) {});
  EXPECT_EQ(rows(source, 2).at(1).second, 3000.0);
  instance = 2;
  EXPECT_EQ(rows(source, 2).at(1).second, 50.0);
  is_over = true;
  thread.join();
}

TEST(CurrentRows, AskWhichOfTwoItemsOfOneNameIsMeant) {
  std::string two = streams(0, 3, 2, {{1, 0, 1000}, {2, 0, 500}});
  two.at(two.rfind("\"s1\"") + 2) = '2';
  Agent agent(two, {two});
  CurrentRows source(agent.url(), speed(), 0.05, [](const std::string&) {});
  EXPECT_REFUSED(rows(source, 1), "several data items have that name, s1, s2");
}

}  // namespace
}  // namespace driftwright::follow::agent_rows_test
