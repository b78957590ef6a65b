// The component for LinuxCNC that `follow` feeds.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/output/component_stand_in.hpp"

namespace driftwright::output::followed_axis_test {
namespace {

/// The component that `follow` feeds, with the files that it needs beside it.
std::filesystem::path followed_axis(const std::string& folder_name) {
  std::filesystem::path folder = fresh_folder(folder_name);
  for (const char* name : {"followed_axis.comp", "axis_offset.h", "axis_offset.c"})
    std::filesystem::copy_file(std::filesystem::path("compensation/control") / name, folder / name,
                               std::filesystem::copy_options::overwrite_existing);
  return folder;
}

// 20 um at 0.5 um/s: there in 40 s. Then its feeder is killed: the correction stays on its pin, the heartbeat stops, and
// 10 s later the offset goes back as fast as it came. It never moves faster, and no count is lost: 0.1 um each.
TEST(FollowedAxis, LeadsTheOffsetBackWhenFollowIsKilled) {
  Component c(followed_axis("killed"), "followed_axis.comp");
  int heartbeat = 0;
  c.set("correction_um", 20.0);
  c.set("enable", 1);
  c.set("machine_is_on", 1);
  c.cycles(kSecond, kCycle_ns);
  beating(c, 50, heartbeat);
  for (int i = 0; i < 700; ++i) c.cycles(kSecond / 10, kCycle_ns);
  const auto out = c.outputs();
  ASSERT_EQ(out.size(), 951u);
  EXPECT_EQ(out[0].at("axis_offset_um"), 0.0);
  EXPECT_NEAR(out[250].at("axis_offset_um"), -20.0, 1e-9);
  EXPECT_EQ(out[250].at("heartbeat_is_late"), 0.0);
  for (int i = 251; i <= 950; ++i) {
    const auto& o = out[static_cast<std::size_t>(i)];
    const double silent_s = 0.2 + 0.1 * (i - 250), back_um = std::max(0.0, 0.5 * (silent_s - 10.0));
    EXPECT_NEAR(o.at("axis_offset_um"), -std::max(0.0, 20.0 - back_um), 0.5 * 0.002 + 1e-9) << i;
    EXPECT_NEAR(o.at("eoffset_counts"), 10.0 * o.at("axis_offset_um"), 0.5 + 1e-6) << i;
  }
  EXPECT_EQ(out[950].at("eoffset_counts"), 0.0);
  EXPECT_EQ(out[950].at("eoffset_enable"), 0.0);
}

TEST(FollowedAxis, WhatIsNoNumberIsNoCorrection) {
  Component c(followed_axis("no_number"), "followed_axis.comp");
  int heartbeat = 0;
  c.set("enable", 1);
  c.set("machine_is_on", 1);
  c.set("correction_um", 3.0);
  beating(c, 20, heartbeat);
  c.set("correction_um", NAN);
  beating(c, 20, heartbeat);
  const auto out = c.outputs();
  EXPECT_NEAR(out[99].at("axis_offset_um"), -3.0, 1e-9);
  EXPECT_EQ(out.back().at("axis_offset_um"), 0.0);
}

TEST(FollowedAxis, IsTakenByHalcompile) {
  if (std::system("command -v halcompile >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "no halcompile here; Debian's linuxcnc-uspace-dev has it";
  const std::filesystem::path folder = followed_axis("halcompile_followed");
  for (const char* what : {"--preprocess", "--compile", "--document"}) {
    EXPECT_EQ(
        std::system(fmt::format("cd {} && halcompile {} followed_axis.comp >said 2>&1", folder.string(), what).c_str()), 0)
        << what << ": " << read_text(folder / "said");
  }
  EXPECT_TRUE(std::filesystem::exists(folder / "followed_axis.so"));
}

}  // namespace
}  // namespace driftwright::output::followed_axis_test
