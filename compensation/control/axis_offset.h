/* From a correction to the counts of a control's external offset, with a watchdog, cycle by cycle. C99; it needs no library,
 * and what it remembers is all zero before the first cycle.
 *
 * The offset goes to sign * correction while it is enabled and the heartbeat is in time, and else to 0: both ways no faster
 * than the slew limit. LinuxCNC adds up the changes of its pin axis.L.eoffset-counts, times axis.L.eoffset-scale, while
 * axis.L.eoffset-enable is on, and begins at 0 whenever the machine is switched on: so do the counts here.
 * Source: LinuxCNC, "External Axis Offsets" (docs/src/motion/external-offsets). */
#ifndef DRIFTWRIGHT_AXIS_OFFSET_H
#define DRIFTWRIGHT_AXIS_OFFSET_H

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
  double most_rate_um_s; /* slew limit of the offset; >= 0 */
  double sign;         /* -1: the axis moves against the drift; +1 where the control takes the offset the other way round */
  double um_per_count; /* > 0 */
  double unit_um;      /* um in one unit of the control, 1000 for mm, 25400 for inch; > 0 */
  double most_age_s;   /* the heartbeat must change within this time; > 0 */
  double most_um;      /* the offset goes no further than this, by size; 0: no limit; >= 0 */
} axis_offset_settings;

typedef struct {
  int has_heartbeat, has_beat, last_heartbeat;
  double age_s; /* since the heartbeat last changed */
  int is_late;  /* 1: the heartbeat has not changed yet, or not for most_age_s */
  int is_wrong; /* 1: a setting is out of its range; the offset then goes to 0 by the last ones that were in range */
  double most_rate_um_s;              /* in force */
  double sign, um_per_count, unit_um; /* in force; new ones wait until the offset has gone back to 0 */
  double scale;                       /* um_per_count / unit_um: units of the control per count */
  double offset_um;                   /* of the axis */
  int counts;                         /* offset_um / um_per_count, rounded */
  int is_offset_enabled; /* for the control: 1 while an offset is wanted, and until its last count has been taken back */
} axis_offset_state;

/* The first call of a cycle. heartbeat: a bit that whoever delivers the readings turns over while they are fresh.
 * Returns is_late: readings are then no news of the machine. dt_s: since the cycle before. */
int axis_offset_watch(const axis_offset_settings* settings, axis_offset_state* state, int heartbeat, double dt_s);

/* The second call of a cycle. is_machine_on: 0 sets offset and counts to 0 at once. is_enabled: 0 leads them back to 0.
 * correction_um: in force; no number: 0. Returns the counts. */
int axis_offset_step(const axis_offset_settings* settings, axis_offset_state* state, int is_machine_on, int is_enabled,
                     double correction_um, double dt_s);

/* The correction in force [um]: what is taken away from the position now. */
double axis_offset_correction_um(const axis_offset_state* state);

#ifdef __cplusplus
}
#endif

#endif
