// The probing program on a whole LinuxCNC, headless: its joints are simulated, its probe of 100 mm meets two rings that
// have moved, and the offsets that it then has are the user's with ours; where it refuses, they stay. Skipped where
// LinuxCNC is not installed. One HAL a machine: registered with a lock.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <sstream>

#include "compensation/frames/frame_programs.hpp"
#include "tests/shared/headless_linuxcnc.hpp"

namespace driftwright::compensation::table_on_linuxcnc_test {
namespace {

constexpr double kRadius_mm = 3.0, kFeed_mm_min = 120.0;  // 2 um a servo cycle
constexpr double kProbe_mm = 100.0;                       // height of joint 2 above the tip
const Eigen::Vector3d kUser_mm(4000.0, 50.0, -10.0);      // G54
constexpr double kUser_deg = 30.0;

/// The probe is closed inside the table: below its face and outside the nearer ring's bore.
std::string hal(const Eigen::Vector3d& low_mm, const Eigen::Vector3d& high_mm) {
  std::string text = R"(loadrt trivkins coordinates=XYZ
loadrt motmod servo_period_nsec=1000000 num_joints=3
loadrt comp count=3
loadrt mux2 count=3
loadrt sum2 count=2
loadrt hypot
loadrt and2
addf motion-command-handler servo-thread
addf motion-controller servo-thread
)";
  for (const char* f : {"comp.0", "mux2.0", "mux2.1", "mux2.2", "sum2.0", "sum2.1", "hypot.0", "comp.1", "comp.2", "and2.0"})
    text += std::string("addf ") + f + " servo-thread\n";
  for (int j = 0; j < 3; ++j) {
    const std::string n = std::to_string(j);
    std::ostringstream places;
    places.precision(12);
    const double up_mm = j == 2 ? kProbe_mm : 0.0;
    places << "net m" << n << " joint." << n << ".motor-pos-cmd => joint." << n << ".motor-pos-fb\n";
    places << "setp mux2." << n << ".in0 " << low_mm[j] + up_mm << "\nsetp mux2." << n << ".in1 " << high_mm[j] + up_mm
           << "\n";
    text += places.str();
  }
  return text + kHeadlessIo + R"(net x joint.0.pos-cmd => comp.0.in1 sum2.0.in0
net y joint.1.pos-cmd => sum2.1.in0
net z joint.2.pos-cmd => comp.2.in0
setp comp.0.in0 0
net high comp.0.out => mux2.0.sel mux2.1.sel mux2.2.sel
net cx mux2.0.out => sum2.0.in1
net cy mux2.1.out => sum2.1.in1
net cz mux2.2.out => comp.2.in1
setp sum2.0.gain1 -1
setp sum2.1.gain1 -1
net dx sum2.0.out => hypot.0.in0
net dy sum2.1.out => hypot.0.in1
net r hypot.0.out => comp.1.in1
setp comp.1.in0 3.0
net outside comp.1.out => and2.0.in0
net below comp.2.out => and2.0.in1
net probe and2.0.out => motion.probe-input
)";
}

constexpr const char* kScript = R"(#!/usr/bin/python3
import linuxcnc, subprocess, time
c, s, e = linuxcnc.command(), linuxcnc.stat(), linuxcnc.error_channel()
out = open("result.txt", "w")
def say(*a):
    print(*a, file=out, flush=True)
def until(done, seconds):
    end = time.time() + seconds
    while time.time() < end:
        s.poll()
        m = e.poll()
        if m: say("error", m[1])
        if done(): return
        time.sleep(0.02)
    say("error timeout")
def mdi(line):
    c.mdi(line)
    c.wait_complete(30)
c.state(linuxcnc.STATE_ESTOP_RESET); c.wait_complete(10)
c.state(linuxcnc.STATE_ON); c.wait_complete(10)
c.teleop_enable(0); c.wait_complete(10)
c.home(-1)
until(lambda: all(s.homed[:3]), 20)
def offsets(of):
    c.mode(linuxcnc.MODE_MDI); c.wait_complete(10)
    for system in ("G59.3", "G54"):            # a system that is in force already is not read anew
        mdi(system)
        time.sleep(0.1)
        s.poll()
        for axis in range(3): say(of + system + "XYZ"[axis], s.g5x_offset[axis])
        say(of + system + "R", s.rotation_xy)
def run(of):
    c.mode(linuxcnc.MODE_AUTO); c.wait_complete(10)
    c.program_open("linuxcnc/thermframe.ngc")
    c.auto(linuxcnc.AUTO_RUN, 0)
    time.sleep(0.5)
    until(lambda: s.interp_state == linuxcnc.INTERP_IDLE, 120)
    time.sleep(0.2)
    s.poll()
    say(of + "Left", s.g5x_index)
    say(of + "LeftZ", s.joint_position[2])
    offsets(of)
def rings_rise(mm):
    for end in ("in0", "in1"):
        at = float(subprocess.run(["halcmd", "getp", "mux2.2." + end], capture_output=True, text=True).stdout)
        subprocess.run(["halcmd", "setp", "mux2.2." + end, repr(at + mm)])
def expect_refusal(of, wanted):
    global say
    plain, words = say, []
    say = lambda *a: words.append(" ".join(str(x) for x in a)) if a[0] == "error" else plain(*a)
    run(of)
    say = plain
    say(of + "Words", int(any(wanted in w for w in words)))
offsets("before")
expect_refusal("bare", "no probe in the spindle")                # no M6 before
c.mode(linuxcnc.MODE_MDI); c.wait_complete(10)
mdi("M61 Q2"); expect_refusal("cutter", "no probe in the spindle")
c.mode(linuxcnc.MODE_MDI); c.wait_complete(10)
mdi("M61 Q1")
mdi("M3 S100"); expect_refusal("turning", "the spindle turns")
c.mode(linuxcnc.MODE_MDI); c.wait_complete(10)
mdi("M5")
subprocess.run(["halcmd", "setp", "comp.1.in0", "-1"])      # the bore is full of chips
expect_refusal("full", "something is in the way above ring low")
subprocess.run(["halcmd", "setp", "comp.1.in0", "3"])
rings_rise(2)                         # a probe 2 mm shorter than its length says
expect_refusal("high", "height of ring low")
rings_rise(-22)                       # no ring at all
expect_refusal("missing", "ring low missing")
rings_rise(20)
run("after")
mdi("G49")
mdi("G53 G0 Z150")
for x in (-4800, 4800):
    mdi("G53 G0 X%d" % x)
    time.sleep(0.1)
    say("motor%d" % x, subprocess.run(["halcmd", "getp", "joint.0.motor-pos-cmd"], capture_output=True, text=True).stdout.strip())
say("done 1")
)";

TEST(TableOnLinuxcnc, ReadsBackTheFrameOfItsOwnProbingAndKeepsTheOldOneWhereItRefuses) {
  if (!has_linuxcnc()) GTEST_SKIP() << "LinuxCNC is not installed (linuxcnc-uspace)";
  const Eigen::Vector3d low_m(-4.8, 0.1, 0.0), high_m(4.8, 0.1, 0.0);
  const Eigen::Vector3d low_now_m = low_m + Eigen::Vector3d(-50e-6, 20e-6, 5e-6),
                        high_now_m = high_m + Eigen::Vector3d(70e-6, 40e-6, 15e-6);
  const std::vector<RingPair> rings = {{"low", low_m, low_now_m}, {"high", high_m, high_now_m}};
  FrameProgram program;
  program.rings = {{"low", low_m}, {"high", high_m}};
  program.frame = fit_table_frame(rings);
  program.free_diameter_m = 2e-3 * kRadius_mm;
  program.feed_mm_min = kFeed_mm_min;
  program.probe_tool = 1;

  const std::filesystem::path folder = fresh_folder("linuxcnc");
  std::map<std::string, std::string> files = {
      {"sim.ini", headless_ini("", "COMP_FILE = linuxcnc/joint_0.comp\nCOMP_FILE_TYPE = 1\n")},
      {"sim.hal", hal(1e3 * low_now_m, 1e3 * high_now_m)},
      {"script.py", kScript},
      {"tool.tbl", "T1 P1 Z100 D6\nT2 P2 Z100 D6\n"},
      {"sim.var", "150 0\n151 0\n5220 1\n5221 4000\n5222 50\n5223 -10\n5230 30\n5381 7\n5382 8\n5383 9\n5390 10\n"}};
  for (const ProgramFile& f : frame_programs(program)) files[f.name] = f.text;
  std::map<std::string, double> found = run_headless(folder, files, 150);
  EXPECT_EQ(found["exit"], 0.0);
  ASSERT_TRUE(found.contains("done") && !found.contains("error"))
      << read_text(folder / "result.txt") << read_text(folder / "log.txt");
  // G54 stays whatever happens, and G59.3 where nothing was measured.
  for (const std::string of : {"bare", "cutter", "turning", "full", "high", "missing"})
    EXPECT_EQ(found[of + "Words"], 1.0) << of;
  found["beforeLeft"] = 1.0;  // nothing has run
  for (const std::string of : {"before", "bare", "cutter", "turning", "full", "high", "missing", "after"}) {
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(found[of + "G54" + "XYZ"[axis]], kUser_mm[axis], 1e-6) << of;
      const double stays_mm = found[of + "G59.3" + "XYZ"[axis]] - (7.0 + axis);
      EXPECT_EQ(std::abs(stays_mm) < 1e-6, of != "after") << of << " " << stays_mm;
    }
    EXPECT_NEAR(found[of + "G54R"], kUser_deg, 1e-9) << of;
    EXPECT_EQ(found[of + "Left"], 1.0) << of << ": G54 is left in force";
    EXPECT_EQ(std::abs(found[of + "G59.3R"] - 10.0) < 1e-9, of != "after") << of;
  }
  for (const std::string of : {"missing", "full"})
    EXPECT_NEAR(found[of + "LeftZ"], kProbe_mm + 50.0, 1e-3) << of << ": the stylus is taken out of the ring";
  // Each touch stops on a servo cycle: 2 um, half of it in the middle of two touches along X and Y; the second one along
  // Z is ten times as slow. The turn is known to 2 um on 9.6 m; it carries the user's 4 m along by 8 um, to 1 um.
  const double turn_rad = program.frame.turn_rad;
  const Eigen::Vector2d user_mm = Eigen::Rotation2Dd(turn_rad) * kUser_mm.head<2>();
  EXPECT_NEAR(found["afterG59.3X"], 1e3 * program.frame.x.shift_m + user_mm[0], 0.002);
  EXPECT_NEAR(found["afterG59.3Y"], 1e3 * program.frame.shift_y_m + user_mm[1], 0.003);
  EXPECT_NEAR(found["afterG59.3Z"], 1e3 * program.frame.shift_z_m + kUser_mm[2], 0.001);
  EXPECT_NEAR(found["afterG59.3R"], kUser_deg + turn_rad * 180.0 / M_PI, 2e-6 / 9.6 * 180.0 / M_PI);
  // the scale, by the joint's trims: halcmd prints 7 digits, 1 um
  for (double x_mm : {-4800.0, 4800.0}) {
    EXPECT_NEAR(found[x_mm < 0 ? "motor-4800" : "motor4800"], program.frame.x.scale * x_mm, 0.001);
  }
}

}  // namespace
}  // namespace driftwright::compensation::table_on_linuxcnc_test
