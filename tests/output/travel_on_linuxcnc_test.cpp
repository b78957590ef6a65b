// A screw that grows on a whole LinuxCNC, headless: its motor's encoder closes the loop, and the exported component holds
// the axis by external offsets over its travel. Skipped where LinuxCNC, halcompile or the right to LinuxCNC's folder of
// modules is missing.

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>

#include "compensation/control/control_files.hpp"
#include "output/drift_model_c.hpp"
#include "output/linuxcnc_component.hpp"
#include "tests/shared/headless_linuxcnc.hpp"

namespace driftwright::output::travel_on_linuxcnc_test {
namespace {

namespace fs = std::filesystem;
const fs::path kModules = "/usr/lib/linuxcnc/modules";

/// The screw's growth where the axis is [um for each kelvin]: a parabola, 1.2 at 0 mm, 5.8 at 400 mm, 9.6 at 800 mm. At 10 K
/// it lies 1 um from its chords.
constexpr const char* kGrowth = "(1.2 + 0.0125 * x - 2.5e-6 * x * x)";

DeployedModel formula(double at_mm, double um_per_K) {
  DeployedModel d;
  d.model = {.kind = "by hand",
             .target = fmt::format("x_{:.0f}", at_mm),
             .target_unit = "um",
             .intercept = -20.0 * um_per_K,
             .terms = {{.input = "T", .unit = "degC", .coefficient = um_per_K}}};
  d.safe.guards = {{.input = "T", .unit = "degC", .low = 0, .high = 100, .most_jump = 1e9, .others_coefficient = {}}};
  d.safe.lowest_um = -200;
  d.safe.highest_um = 200;
  d.safe.most_rate_um_s = 1000;
  d.safe.period_s = 0.5;
  d.safe.stale_s = 5.0;
  d.safe.fade_s = 50.0;
  return d;
}

const std::string kHal = std::string(R"(loadrt trivkins coordinates=XYZ
loadrt motmod servo_period_nsec=1000000 num_joints=3
loadrt grown_screw_axis names=thermal
loadrt charge_pump
loadrt and2
addf motion-command-handler servo-thread
addf charge-pump servo-thread
addf and2.0 servo-thread
addf thermal servo-thread
addf motion-controller servo-thread
net m0 joint.0.motor-pos-cmd => joint.0.motor-pos-fb
net m1 joint.1.motor-pos-cmd => joint.1.motor-pos-fb
net m2 joint.2.motor-pos-cmd => joint.2.motor-pos-fb
net place joint.0.pos-cmd => thermal.position
net counts thermal.eoffset-counts => axis.x.eoffset-counts
net scale thermal.eoffset-scale => axis.x.eoffset-scale
net enable thermal.eoffset-enable => axis.x.eoffset-enable
net beat charge-pump.out => thermal.heartbeat
net on motion.motion-enabled => and2.0.in0
net homed motion.is-all-homed => and2.0.in1
net ready and2.0.out => thermal.machine-is-on
setp thermal.T-degC 20
)") + kHeadlessIo;

const std::string kScript = fmt::format(R"(#!/usr/bin/python3
import linuxcnc, subprocess, time
c, s, e = linuxcnc.command(), linuxcnc.stat(), linuxcnc.error_channel()
out = open("result.txt", "w")
def say(*a): print(*a, file=out, flush=True)
def get(pin): return float(subprocess.run(["halcmd", "getp", pin], capture_output=True, text=True).stdout)
def put(pin, value): subprocess.run(["halcmd", "setp", pin, repr(value)])
def left(T, x):        # where the table is, less where it was sent [um]
    c.mdi("G53 G0 X%r" % x); c.wait_complete(30); time.sleep(0.25)
    motor = get("joint.0.motor-pos-cmd")
    growth = lambda x: {}
    return 1e3 * (motor - x) + (T - 20) * growth(motor)
c.state(linuxcnc.STATE_ESTOP_RESET); c.wait_complete(10)
c.state(linuxcnc.STATE_ON); c.wait_complete(10)
c.teleop_enable(0); c.wait_complete(10)
c.home(-1)
for _ in range(1000):
    s.poll()
    if all(s.homed[:3]): break
    time.sleep(0.02)
c.mode(linuxcnc.MODE_MDI); c.wait_complete(10)
put("thermal.T-degC", 30.0); time.sleep(2)
places = [800, 0, 400, 200, 600, 100, 700, 300, 500, 50, 750]
say("without", max(abs(left(30, x)) for x in places))
put("thermal.enable", 1)
for T in (30.0, 25.0, 18.0):
    put("thermal.T-degC", T); time.sleep(2)
    say("at%d" % T, max(abs(left(T, x)) for x in places))
say("chord", left(18.0, 200))
put("thermal.enable", 0); time.sleep(2)
say("offset", 1e3 * get("axis.x.eoffset"))
m = e.poll()
if m: say("error", m[1])
say("done 1")
)",
                                        kGrowth);

TEST(TravelOnLinuxcnc, HoldsAGrownScrewToTwoMicrometresOverItsTravel) {
  if (!has_linuxcnc() || std::system("command -v halcompile >/dev/null 2>&1") != 0 || access(kModules.c_str(), W_OK) != 0)
    GTEST_SKIP() << "no linuxcnc or halcompile here, or no right to its modules (linuxcnc-uspace, linuxcnc-uspace-dev)";
  const fs::path folder = fresh_folder("travel_on_linuxcnc");
  const std::vector<PlacedModel> places = {
      {formula(0.0, 1.2), 0.0}, {formula(400.0, 5.8), 400.0}, {formula(800.0, 9.6), 800.0}};
  std::ofstream(folder / "grown_screw.c") << c_over_travel(places, "grown_screw", "a test");
  std::ofstream(folder / "grown_screw_axis.comp")
      << linuxcnc_over_travel(places, "grown_screw", "grown_screw_axis", "grown_screw.c", "a test");
  for (const compensation::ControlFile& file : compensation::control_files())
    std::ofstream(folder / file.name, std::ios::binary) << file.text;
  ASSERT_EQ(
      std::system(fmt::format("cd {} && halcompile --compile grown_screw_axis.comp >said 2>&1", folder.string()).c_str()), 0)
      << read_text(folder / "said");
  const fs::path module = kModules / "grown_screw_axis.so";
  ASSERT_FALSE(fs::exists(module)) << module << ": another test's, or one that was killed";
  fs::copy_file(folder / "grown_screw_axis.so", module);
  std::map<std::string, double> found = run_headless(folder,
                                                     {{"sim.ini", headless_ini("OFFSET_AV_RATIO = 0.2\n", "")},
                                                      {"sim.hal", kHal},
                                                      {"script.py", kScript},
                                                      {"tool.tbl", "T1 P1\n"},
                                                      {"sim.var", "5220 1\n"}},
                                                     120);
  fs::remove(module);
  ASSERT_TRUE(found.contains("done") && !found.contains("error"))
      << read_text(folder / "result.txt") << read_text(folder / "log.txt");
  EXPECT_NEAR(found["without"], 96.0, 0.2);
  // 1 um of 10 K is the parabola between its chords; a count is 0.1 um, and halcmd prints 0.1 um
  EXPECT_LT(found["at30"], 1.3);
  EXPECT_LT(found["at25"], 0.8);
  EXPECT_LT(found["at18"], 0.5);
  EXPECT_NEAR(found["chord"], -0.2, 0.2);
  EXPECT_NEAR(found["offset"], 0.0, 1e-3);
}

}  // namespace
}  // namespace driftwright::output::travel_on_linuxcnc_test
