component followed_axis "A correction that comes from outside, as external offset of an axis";
description """
Leads a correction that another program gives (`driftwright follow` through follow_hal.py) to an axis as external offset: enable, watchdog, slew limit.
axis_offset.h and axis_offset.c must lie beside this file when it is compiled:

  halcompile --install followed_axis.comp

For the axis L, with [AXIS_L]OFFSET_AV_RATIO in the INI file:

  loadrt followed_axis names=thermal
  addf thermal servo-thread
  net thermal-counts thermal.eoffset-counts => axis.l.eoffset-counts
  net thermal-scale thermal.eoffset-scale => axis.l.eoffset-scale
  net thermal-enable thermal.eoffset-enable => axis.l.eoffset-enable
  net thermal-correction follow.drift-y.correction-um => thermal.correction-um
  net thermal-heartbeat follow.heartbeat => thermal.heartbeat

LinuxCNC adds up changes of the counts, drops them before all joints are homed, and forgets them when the machine is switched off.
machine-is-on must therefore be the and of motion.motion-enabled and motion.is-all-homed.
""";
pin in float correction_um "what is to be taken away from the position, um; not a number: 0";
pin in bit heartbeat = 0 "turns over with each correction; until it first does, and when it has not for most-age-s, the offset goes back to 0";
pin in bit enable = 0 "the offset follows the correction; else it goes back to 0 at the slew limit";
pin in bit machine_is_on = 0 "while it is off, counts and offset are 0 at once";
pin out signed eoffset_counts "to axis.L.eoffset-counts";
pin out float eoffset_scale "to axis.L.eoffset-scale: units of the machine per count";
pin out bit eoffset_enable "to axis.L.eoffset-enable";
pin out float axis_offset_um "of the axis, in force";
pin out bit heartbeat_is_late "the watchdog has bitten";
pin out bit setting_is_wrong "a parameter is out of its range; the offset goes back to 0";
param rw float most_rate_um_s = 0.5 "slew limit of the offset, um/s; 0 or more";
param rw float most_um = 0.0 "largest offset by size, um: `correction` of the scenario's `limits`; 0: no limit";
param rw float sign = -1.0 "-1: the axis moves against the drift; +1: with it. A new one waits until the offset is 0";
param rw float count_um = 0.1 "um per count, above 0. A new one waits until the offset is 0";
param rw float machine_unit_um = 1000.0 "um in one unit of the machine: 1000 for mm, 25400 for inch. A new one waits until the offset is 0";
param rw float most_age_s = 10.0 "the heartbeat must turn over within this time, s; above 0";
variable axis_offset_state axis;
include "axis_offset.c";
function _ fp;
license "GPL";
;;
FUNCTION(_) {
  const axis_offset_settings settings = {most_rate_um_s, sign, count_um, machine_unit_um, most_age_s, most_um};
  const int is_late = axis_offset_watch(&settings, &axis, heartbeat, fperiod);
  axis_offset_step(&settings, &axis, machine_is_on, enable, correction_um, fperiod);
  eoffset_counts = axis.counts;
  eoffset_scale = axis.scale;
  eoffset_enable = axis.is_offset_enabled;
  axis_offset_um = axis.offset_um;
  heartbeat_is_late = is_late;
  setting_is_wrong = axis.is_wrong;
}
