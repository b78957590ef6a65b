/* See axis_offset.h. */
#include "axis_offset.h"

#define LARGEST 1e300     /* beyond, numbers are none */
#define MOST_COUNTS 2.0e9 /* that a signed counter of 32 bits holds */

static int is_between(double x, double low, double high) {
  return x >= low && x <= high;
} /* no NAN is */

int axis_offset_watch(const axis_offset_settings* settings, axis_offset_state* state, int heartbeat, double dt_s) {
  heartbeat = heartbeat != 0;
  if (state->has_heartbeat && heartbeat != state->last_heartbeat) {
    state->has_beat = 1;
    state->age_s = 0.0;
  } else if (is_between(dt_s, 0.0, LARGEST)) {
    state->age_s += dt_s;
  }
  state->has_heartbeat = 1;
  state->last_heartbeat = heartbeat;
  state->is_late = !state->has_beat || !(state->age_s <= settings->most_age_s);
  return state->is_late;
}

int axis_offset_step(const axis_offset_settings* settings, axis_offset_state* state, int is_machine_on, int is_enabled,
                     double correction_um, double dt_s) {
  const int counts_before = state->counts;
  double target_um = 0.0, most_um = 0.0, move_um, n;
  int is_wanted;
  state->is_wrong =
      !is_between(settings->most_rate_um_s, 0.0, LARGEST) || !(settings->sign == 1.0 || settings->sign == -1.0) ||
      !is_between(settings->um_per_count, 1.0 / LARGEST, LARGEST) ||
      !is_between(settings->unit_um, 1.0 / LARGEST, LARGEST) || !is_between(settings->most_age_s, 1.0 / LARGEST, LARGEST) ||
      !is_between(settings->most_um, 0.0, LARGEST);
  if (!is_machine_on) state->offset_um = 0.0;
  if (!state->is_wrong) {
    state->most_rate_um_s = settings->most_rate_um_s;
    if (state->offset_um == 0.0) {
      state->sign = settings->sign;
      state->um_per_count = settings->um_per_count;
      state->unit_um = settings->unit_um;
      state->scale = settings->um_per_count / settings->unit_um;
    }
  }
  is_wanted = is_machine_on && is_enabled && !state->is_late && !state->is_wrong && state->sign == settings->sign &&
              state->um_per_count == settings->um_per_count && state->unit_um == settings->unit_um;
  if (is_wanted && is_between(correction_um, -LARGEST, LARGEST)) target_um = state->sign * correction_um;
  if (settings->most_um > 0.0 && target_um > settings->most_um) target_um = settings->most_um;
  if (settings->most_um > 0.0 && target_um < -settings->most_um) target_um = -settings->most_um;
  if (is_between(dt_s, 0.0, LARGEST)) most_um = state->most_rate_um_s * dt_s;
  move_um = target_um - state->offset_um;
  if (move_um > most_um) move_um = most_um;
  if (move_um < -most_um) move_um = -most_um;
  if (is_machine_on) state->offset_um += move_um;

  n = state->um_per_count > 0.0 ? state->offset_um / state->um_per_count : 0.0;
  if (n > MOST_COUNTS) n = MOST_COUNTS;
  if (n < -MOST_COUNTS) n = -MOST_COUNTS;
  state->counts = (int)(n < 0.0 ? n - 0.5 : n + 0.5);
  state->is_offset_enabled = is_machine_on && (is_wanted || state->counts != 0 || counts_before != 0);
  return state->counts;
}
