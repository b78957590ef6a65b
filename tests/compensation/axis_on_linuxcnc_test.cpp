// The touch cycle of one axis on a whole LinuxCNC, headless. The axis drifts while a job runs that probes between its parts,
// and what is left is measured at the place of the work. A touch that misses or is too far is refused, an abort in the
// middle of a touch leaves the last good offset. Skipped where LinuxCNC is not installed.

#include <gtest/gtest.h>

#include <cmath>

#include "compensation/frames/axis_programs.hpp"
#include "tests/shared/headless_linuxcnc.hpp"

namespace driftwright::compensation::axis_on_linuxcnc_test {
namespace {

// The face at -20 mm, met by the probe of 100 mm: joint 2 at 80 mm, less the drift. A low-pass lets the drift grow with a
// time constant of 50 s, by 0.8 um/s at first: 150 times as fast as a spindle that grows by 20 um in an hour. A probing
// each 3.5 s is then one each 9 min.
const std::string kHal = std::string(R"(loadrt trivkins coordinates=XYZ
loadrt motmod servo_period_nsec=1000000 num_joints=3
loadrt comp count=1
loadrt lowpass count=1
loadrt sum2 count=1
addf motion-command-handler servo-thread
addf motion-controller servo-thread
addf lowpass.0 servo-thread
addf sum2.0 servo-thread
addf comp.0 servo-thread
net m0 joint.0.motor-pos-cmd => joint.0.motor-pos-fb
net m1 joint.1.motor-pos-cmd => joint.1.motor-pos-fb
net m2 joint.2.motor-pos-cmd => joint.2.motor-pos-fb comp.0.in0
net drift lowpass.0.out => sum2.0.in1
setp lowpass.0.gain 0.00002
setp sum2.0.gain1 -1
setp sum2.0.in0 80.0
net face sum2.0.out => comp.0.in1
net probe comp.0.out => motion.probe-input
setp axis.z.eoffset-scale 0.0001
setp axis.z.eoffset-enable 1
)") + kHeadlessIo;

constexpr const char* kJob = R"(G21 G90 G43 G59.3
o1 repeat [12]
o<probe_z> call
o2 if [#<_value> NE 0]
M0
o2 endif
G0 X0 Y0
G0 Z10
G4 P0.6
o1 endrepeat
M2
)";

constexpr const char* kScript = R"(#!/usr/bin/python3
import linuxcnc, hal, subprocess, threading, time
c, s, e = linuxcnc.command(), linuxcnc.stat(), linuxcnc.error_channel()
out = open("result.txt", "w")
words = []
def say(*a): print(*a, file=out, flush=True)
def drain():
    while m := e.poll():
        words.append(m[1].strip())
def until(done, seconds):
    end = time.time() + seconds
    while True:
        s.poll(); drain()
        if done(): return
        if time.time() > end:
            say("error timeout"); return
        time.sleep(0.01)
def get(pin): return float(subprocess.run(["halcmd", "getp", pin], capture_output=True, text=True).stdout)
def put(pin, value): subprocess.run(["halcmd", "setp", pin, repr(value)])
def mdi(line):
    c.mode(linuxcnc.MODE_MDI); c.wait_complete(10)
    c.mdi(line); c.wait_complete(30)
def start(file):
    words.clear()
    c.mode(linuxcnc.MODE_AUTO); c.wait_complete(10)
    c.program_open(file)
    c.auto(linuxcnc.AUTO_RUN, 0)
    time.sleep(0.3)
def finished(seconds=40):
    until(lambda: s.interp_state == linuxcnc.INTERP_IDLE, seconds)
    time.sleep(0.1); s.poll(); drain()
def offset():     # of Z in G59.3 over that of G54 [um]; the system of a program that has ended is G54
    mdi("G59.3"); time.sleep(0.1); s.poll(); z = s.g5x_offset[2]
    mdi("G54"); time.sleep(0.1); s.poll()
    return 1e3 * (z - s.g5x_offset[2])
def probe(of, file="probe_z.ngc"):
    start(file); finished()
    say(of + "Offset", offset()); say(of + "Drift", 1e3 * get("lowpass.0.out"))
    s.poll(); say(of + "Z", s.joint_position[2])
    for k in ("taken", "no gauge", "too far", "no probe", "spindle turns", "in the way"): say(of + k.split()[-1], int(any(k in w for w in words)))
c.state(linuxcnc.STATE_ESTOP_RESET); c.wait_complete(10)
c.state(linuxcnc.STATE_ON); c.wait_complete(10)
c.teleop_enable(0); c.wait_complete(10)
c.home(-1)
until(lambda: all(s.homed[:3]), 20)
probe("bare")
mdi("M61 Q1")
probe("first")
mdi("M3 S100"); probe("turning"); mdi("M5")
put("sum2.0.in0", 105.0); probe("tall"); put("sum2.0.in0", 80.0)
mdi("M61 Q2"); probe("cutter"); mdi("M61 Q1")
# the axis drifts to 40 um while a job runs
put("lowpass.0.in", 0.04)
start("job.ngc")
left = []
end = time.time() + 90
while time.time() < end:
    s.poll(); drain()
    if s.interp_state == linuxcnc.INTERP_IDLE: break
    if s.g5x_index == 9 and s.inpos and abs(s.joint_position[2] - 117) < 0.1:      # the job stops at Z10 of G59.3
        d = get("lowpass.0.out"); s.poll()
        if abs(s.joint_position[2] - 117) > 0.1: continue      # it went on while the drift was read
        left.append(1e3 * (s.joint_position[2] - 100 - 10 - 7 + d))
    time.sleep(0.02)
drain()
say("jobSamples", len(left)); say("jobLargest", max(map(abs, left))); say("jobDrift", 1e3 * get("lowpass.0.out")); say("jobTaken", sum("taken" in w for w in words))
put("lowpass.0.gain", 1.0)             # the drift stays
time.sleep(0.2)
probe("still")
put("sum2.0.in0", 80.040); probe("chip")
put("sum2.0.in0", 60.0); probe("missing")
put("sum2.0.in0", 80.0)
start("probe_z.ngc")
until(lambda: s.probing, 10)
c.abort(); c.wait_complete(10); time.sleep(0.2); s.poll()
say("abortedProbing", int(s.probing)); say("abortedOffset", offset())
probe("again")
put("axis.z.eoffset-counts", -100); time.sleep(1)
probe("led")
put("axis.z.eoffset-counts", 0); time.sleep(1)
put("sum2.0.in0", 79.99); probe("back")
# the component of a model in place of an offset of the program's own
mdi("G10 L2 P7 Z0")
put("sum2.0.in0", 80.0)
h = hal.component("thermal")
h.newpin("probe-um", hal.HAL_FLOAT, hal.HAL_IN); h.newpin("probe-strobe", hal.HAL_BIT, hal.HAL_IN); h.newpin("probe-verdict", hal.HAL_S32, hal.HAL_OUT)
h.ready()
for pins in ("left motion.analog-out-02 thermal.probe-um", "touched motion.digital-out-02 thermal.probe-strobe"):
    subprocess.run(["halcmd", "net", *pins.split()])
corrections = []
def serve():
    was, c_um = False, 0.0
    while True:
        now = h["probe-strobe"]
        if now and not was:
            h["probe-verdict"] = 1 if abs(h["probe-um"]) < 45 else 3
            if h["probe-verdict"] == 1:
                c_um += h["probe-um"]
                put("axis.z.eoffset-counts", round(-10 * c_um))
            corrections.append(h["probe-um"])
        was = now
        time.sleep(0.01)
threading.Thread(target=serve, daemon=True).start()
for of in ("given", "given again"):
    start("component/probe_z.ngc"); finished(); time.sleep(1)
put("sum2.0.in0", 80.1)
start("component/probe_z.ngc"); finished()
say("givenFirst", corrections[0]); say("givenSecond", corrections[1]); say("givenChip", corrections[2]); say("givenRefused", int("refused: by the component" in words[-1]))
say("givenOffset", offset()); say("givenZ", 1e3 * get("axis.z.eoffset")); say("givenStrobe", int(h["probe-strobe"]))
say("done 1")
)";

AxisProgram program() {
  AxisProgram p;
  p.at_m = {0.1, 0.05, -0.02};
  p.first_um = 60.0;
  p.step_um = 30.0;
  p.most_um = 100.0;
  p.made_by = "a test";
  return p;
}

TEST(AxisOnLinuxcnc, KeepsADriftingAxisTrueAndItsOffsetWhereATouchIsRefused) {
  if (!has_linuxcnc()) GTEST_SKIP() << "LinuxCNC is not installed (linuxcnc-uspace)";
  AxisProgram given = program();
  given.to_component = true;
  std::map<std::string, double> found = run_headless(fresh_folder("linuxcnc"),
                                                     {{"sim.ini", headless_ini("OFFSET_AV_RATIO = 0.2\n", "")},
                                                      {"sim.hal", kHal},
                                                      {"script.py", kScript},
                                                      {"job.ngc", kJob},
                                                      {"probe_z.ngc", linuxcnc_axis(program()).front().text},
                                                      {"component/probe_z.ngc", linuxcnc_axis(given).front().text},
                                                      {"tool.tbl", "T1 P1 Z100 D6\nT2 P2 Z100 D6\n"},
                                                      {"sim.var", "5220 1\n5221 400\n5222 50\n5223 7\n5230 0\n"}},
                                                     200);
  const std::filesystem::path folder = temporary_folder() / "linuxcnc";
  EXPECT_EQ(found["exit"], 0.0);
  ASSERT_TRUE(found.contains("done") && !found.contains("error"))
      << read_text(folder / "result.txt") << read_text(folder / "log.txt");
  // A slow touch of 30 mm/min stops within a servo cycle, 0.5 um.
  constexpr double kTouch_um = 0.6;
  EXPECT_EQ(found["bareprobe"], 1.0) << "without a probe nothing is touched";
  EXPECT_EQ(found["bareZ"], 0.0);
  EXPECT_EQ(found["firsttaken"], 1.0);
  EXPECT_NEAR(found["firstOffset"], 0.0, kTouch_um);
  // a spindle that turns, what is 25 mm above the gauge, and another tool
  EXPECT_EQ(found["turningturns"], 1.0);
  EXPECT_EQ(found["tallway"], 1.0);
  EXPECT_NEAR(found["tallZ"], 130.0, 1e-6);
  EXPECT_EQ(found["cutterprobe"], 1.0);
  for (const std::string of : {"turning", "tall", "cutter"}) EXPECT_EQ(found[of + "Offset"], found["firstOffset"]) << of;
  // the job: the drift alone would leave more than 20 um
  EXPECT_GT(found["jobDrift"], 20.0);
  EXPECT_EQ(found["jobTaken"], 12.0);
  EXPECT_GT(found["jobSamples"], 24.0) << "two each probing; a slow computer takes fewer";
  EXPECT_LT(found["jobLargest"], 2.0);
  EXPECT_NEAR(found["stillOffset"], -40.0, kTouch_um);
  // 40 um of a chip are more than a step of 30 um; without a gauge the tip is taken up again
  EXPECT_EQ(found["chipfar"], 1.0);
  EXPECT_EQ(found["missinggauge"], 1.0);
  EXPECT_EQ(found["abortedProbing"], 0.0);
  for (const std::string of : {"chip", "missing", "aborted"}) EXPECT_EQ(found[of + "Offset"], found["stillOffset"]) << of;
  for (const std::string of : {"chip", "missing"}) EXPECT_NEAR(found[of + "Z"], 130.0, 1e-6) << of;
  EXPECT_EQ(found["againtaken"], 1.0);
  EXPECT_NEAR(found["againOffset"], -40.0, kTouch_um);
  // 10 um that an external offset corrects are not corrected again; the touch itself reads the place of the joint
  EXPECT_NEAR(found["ledOffset"], -30.0, kTouch_um);
  EXPECT_NEAR(found["backOffset"], -50.0, kTouch_um);
  // the component of a model gets what is left
  EXPECT_NEAR(found["givenFirst"], 40.0, kTouch_um);
  EXPECT_NEAR(found["givenSecond"], 0.0, kTouch_um);
  EXPECT_NEAR(found["givenZ"], -40.0, kTouch_um);
  EXPECT_LT(found["givenChip"], -90.0);
  EXPECT_EQ(found["givenRefused"], 1.0);
  EXPECT_EQ(found["givenStrobe"], 0.0);
}

}  // namespace
}  // namespace driftwright::compensation::axis_on_linuxcnc_test
