// What other people's programs count in the files of `driftwright inject`: LinuxCNC's HAL encoder and sigrok's rotary
// decoder. A machine has one HAL at a time; CTest keeps others off by the resource lock `hal`.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <regex>

#include "tests/app/inject_filter.hpp"
#include "tests/shared/one_hal.hpp"

namespace driftwright::real_counters_test {
namespace {

/// Out and back, turns at all four states, corrections forward and backward; the last step is forward.
const std::vector<int> kLegs = {57, -23, 118, -301, 3, 42, -7, 260};
constexpr int kEncoder = 57 - 23 + 118 - 301 + 3 + 42 - 7 + 260;
constexpr const char* kCorrection = "row,e_um\n20,3\n200,9\n500,-4\n";
constexpr int kInsertedCycles = -4;

bool has(const std::string& program) {
  return std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) == 0;
}

std::string said_by(const std::string& command) {
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  std::string text;
  char buffer[4096];
  while (std::fgets(buffer, sizeof buffer, pipe)) text += buffer;
  pclose(pipe);
  return text;
}

std::string last_match(const std::string& text, const std::string& pattern) {
  std::string last = "nothing";
  const std::regex regex(pattern);
  for (std::sregex_iterator i(text.begin(), text.end(), regex), end; i != end; ++i) last = (*i)[1];
  return last;
}

/// What a HAL says that runs play.hal in a folder. A machine has one HAL at a time: where another program has it, waits
/// two minutes.
std::string said_by_hal(const std::filesystem::path& folder) {
  std::filesystem::permissions(folder, std::filesystem::perms::all);
  // As root, LinuxCNC runs under a user of its own, which must be able to write its pipe.
  const std::string user = geteuid() == 0 ? "RTAPI_UID=65534 " : "";
  const std::string command = fmt::format("cd {} && {}RTAPI_FIFO_PATH={} {}timeout 60 halrun -f play.hal", folder.string(),
                                          user, (folder / "rtapi").string(), kOneHal);
  std::string text;
  for (int i = 0; i < 60; ++i) {
    text = said_by(command);
    if (text.find("Realtime already running") == std::string::npos) break;
    sleep(2);
  }
  return text;
}

/// Runs a HAL file of the filter; rawcounts after the last row.
std::string hal_count(const std::filesystem::path& folder, int n_rows) {
  const std::string text = said_by_hal(folder);
  char last_row[16];
  std::snprintf(last_row, sizeof last_row, "%08X", static_cast<unsigned>(n_rows));
  EXPECT_EQ(last_match(text, R"(0x([0-9A-F]{8})\s+streamer\.0\.pin)"), last_row) << text;
  return last_match(text, R"((-?\d+)\s+encoder\.0\.rawcounts)");
}

TEST(RealCounters, LinuxCncsEncoderCountsThePredictedPosition) {
  if (!has("halrun")) GTEST_SKIP() << "no halrun here; Debian's linuxcnc-uspace has it";
  const std::string c = write_file("c.csv", kCorrection);
  for (const char* insert : {"cycle", "quarter"}) {
    const auto folder = fresh_folder(std::string("hal_") + insert);
    const Filtered f =
        inject(std::string("hal_") + insert,
               "--period '1 um' --halstream rows.txt --hal play.hal --insert " + std::string(insert) + " --correction " + c,
               row_text(legs(kLegs)));
    ASSERT_EQ(f.exit_code, 0) << f.words;
    EXPECT_EQ(hal_count(folder, static_cast<int>(f.rows.size() / 4)), std::to_string(kEncoder + 4 * kInsertedCycles))
        << insert;
  }
}

TEST(RealCounters, LinuxCncsEncoderCountsOnePerCycleAtX1) {
  if (!has("halrun")) GTEST_SKIP() << "no halrun here; Debian's linuxcnc-uspace has it";
  const std::string c = write_file("c.csv", kCorrection);
  const auto folder = fresh_folder("hal_x1");
  const Filtered f = inject("hal_x1", "--counts x1 --period '1 um' --halstream rows.txt --hal play.hal --correction " + c,
                            row_text(legs(kLegs)));
  // kEncoder = 149 quarters from 00: "A rises while B is low" 38 times net (at 1, 5, ... 149)
  EXPECT_EQ(hal_count(folder, static_cast<int>(f.rows.size() / 4)), std::to_string(38 + kInsertedCycles));
}

// LinuxCNC's encoder begins at 00; a signal that begins elsewhere is led there first. Clocked, as in a running simulation.
TEST(RealCounters, LinuxCncsEncoderAgreesFromAnyStateOnAndClocked) {
  if (!has("halrun")) GTEST_SKIP() << "no halrun here; Debian's linuxcnc-uspace has it";
  const std::string c = write_file("c5.csv", "row,e_um\n1,5\n");
  const auto folder = fresh_folder("hal_clocked");
  const Filtered f = inject("hal_clocked", "--clocked --period '1 um' --halstream rows.txt --hal play.hal --correction " + c,
                            row_text(compensation::motion_rows(compensation::kLineA, 60), 7));  // begins at 11
  EXPECT_EQ(counted(f.rows).count(), 59 + 20);
  EXPECT_EQ(hal_count(folder, static_cast<int>(f.rows.size() / 4) + 1), std::to_string(2 + 59 + 20));
}

// As a filter inside a running control simulation: an encoder turns there and back, the sampled lines go through the
// filter and on to a second counter, which must see 2 cycles less. Rows of 1 ms; edges come every 12 ms and more, so
// there is room.
TEST(RealCounters, SitsInARunningHal) {
  if (!has("halrun")) GTEST_SKIP() << "no halrun here; Debian's linuxcnc-uspace has it";
  const auto folder = fresh_folder("live");
  write_file("live/c.csv", "time_s,e_um\n0,0\n0.3,5\n1.2,-2\n");
  write_file("live/filter.sh",
             "halsampler | " + std::string(DRIFTWRIGHT_PROGRAM) +
                 " inject --clocked --period '1 um' --row-time '1 ms' --correction c.csv 2>err.txt | halstreamer\n");
  write_file(
      "live/play.hal",
      "loadrt sim_encoder num_chan=1\nloadrt sampler depth=8000 cfg=bb\nloadrt streamer depth=8000 cfg=bb\n"
      "loadrt encoder num_chan=2\nloadrt threads name1=fast period1=1000000\n"
      "addf sim-encoder.make-pulses fast\naddf sim-encoder.update-speed fast\naddf sampler.0 fast\naddf streamer.0 fast\n"
      "addf encoder.update-counters fast\naddf encoder.capture-position fast\nsetp sim-encoder.0.ppr 10\n"
      "net a sim-encoder.0.phase-A => sampler.0.pin.0 encoder.0.phase-A\n"
      "net b sim-encoder.0.phase-B => sampler.0.pin.1 encoder.0.phase-B\n"
      "net a2 streamer.0.pin.0 => encoder.1.phase-A\nnet b2 streamer.0.pin.1 => encoder.1.phase-B\n"
      "setp encoder.0.x4-mode 1\nsetp encoder.1.x4-mode 1\nloadusr sh filter.sh\nloadusr -w sleep 0.5\nstart\n"
      "setp sim-encoder.0.speed 2\nloadusr -w sleep 2\nsetp sim-encoder.0.speed -1.5\nloadusr -w sleep 1\n"
      "setp sim-encoder.0.speed 0\nloadusr -w sleep 1\nshow pin encoder.0.rawcounts\nshow pin encoder.1.rawcounts\n"
      "show pin sampler.0.overruns\n");
  const std::string text = said_by_hal(folder);
  const int encoder = std::stoi(fmt::format("0{}", last_match(text, R"((\d+)\s+encoder\.0\.rawcounts)")));
  ASSERT_EQ(last_match(text, R"((\d+)\s+sampler\.0\.overruns)"), "0") << text;
  EXPECT_GT(encoder, 50) << text;
  EXPECT_EQ(last_match(text, R"((-?\d+)\s+encoder\.1\.rawcounts)"), std::to_string(encoder - 8)) << text;
}

/// sigrok reports a count when the next edge comes, so the last step is missing from its output.
std::string sigrok_count(const std::filesystem::path& vcd, const std::string& side) {
  const std::string text = said_by("sigrok-cli -I vcd -i " + vcd.string() + " -P graycode:d0=a_" + side + ":d1=b_" + side +
                                   " -A graycode=count --protocol-decoder-samplenum");
  return last_match(text, R"(graycode-1: (-?\d+))");
}

TEST(RealCounters, SigrokReadsTheSameCountsBeforeAndAfter) {
  if (!has("sigrok-cli")) GTEST_SKIP() << "no sigrok-cli here; Debian's package of this name has it";
  const std::string c = write_file("c.csv", kCorrection);
  const auto folder = fresh_folder("vcd");
  ASSERT_EQ(inject("vcd", "--period '1 um' --vcd lines.vcd --correction " + c, row_text(legs(kLegs))).exit_code, 0);
  EXPECT_EQ(sigrok_count(folder / "lines.vcd", "in"), std::to_string(kEncoder - 1));
  EXPECT_EQ(sigrok_count(folder / "lines.vcd", "out"), std::to_string(kEncoder + 4 * kInsertedCycles - 1));
}

}  // namespace
}  // namespace driftwright::real_counters_test
