/* The external offset of an axis whose correction depends on where the axis is: corrections for several places along its
 * travel, straight between them; beyond the outermost places their corrections hold. C99; it needs axis_offset.c, and what
 * it remembers is all zero before the first cycle.
 *
 * Each place has enable, watchdog and slew limit of its own (axis_offset.h): they limit how fast a correction grows in time,
 * not how it changes while the axis moves. */
#ifndef DRIFTWRIGHT_AXIS_TRAVEL_H
#define DRIFTWRIGHT_AXIS_TRAVEL_H

#include "axis_offset.h"

#ifdef __cplusplus
extern "C" {
#endif

#define AXIS_TRAVEL_PLACES 16 /* at most */

/* The value at a position. at: n positions that rise, n >= 1; values: one for each. No number: the value at the first
 * place. */
double axis_travel_value(const double* at, const double* values, int n, double position);

typedef struct {
  axis_offset_state places[AXIS_TRAVEL_PLACES];
  double position;                 /* the last one that was a number */
  double um_per_count;             /* in force; a new one waits until the counts are 0 */
  double scale;                    /* units of the control per count */
  double offset_um;                /* of the axis, where it is */
  int counts;                      /* offset_um / um_per_count, rounded */
  int is_offset_enabled, is_wrong; /* as of axis_offset_state */
} axis_travel_state;

/* The first call of a cycle, as axis_offset_watch(). n: number of places, 1 to AXIS_TRAVEL_PLACES. */
int axis_travel_watch(const axis_offset_settings* settings, axis_travel_state* state, int n, int heartbeat, double dt_s);

/* The second call of a cycle, as axis_offset_step(). at, position: in one unit. corrections_um: one for each place. */
int axis_travel_step(const axis_offset_settings* settings, axis_travel_state* state, const double* at, int n,
                     int is_machine_on, int is_enabled, const double* corrections_um, double position, double dt_s);

#ifdef __cplusplus
}
#endif

#endif
