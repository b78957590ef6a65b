/* See axis_travel.h. */
#include "axis_travel.h"

#define FARTHEST 1e300           /* positions beyond are none */
#define MOST_TRAVEL_COUNTS 2.0e9 /* that a signed counter of 32 bits holds */

double axis_travel_value(const double* at, const double* values, int n, double position) {
  int k = 1;
  if (n < 2 || !(position > at[0])) return values[0];
  while (k < n - 1 && position > at[k]) ++k;
  if (position >= at[k]) return values[k];
  return values[k - 1] + (values[k] - values[k - 1]) * ((position - at[k - 1]) / (at[k] - at[k - 1]));
}

int axis_travel_watch(const axis_offset_settings* settings, axis_travel_state* state, int n, int heartbeat, double dt_s) {
  int k, is_late = 1;
  for (k = 0; k < n; ++k) is_late = axis_offset_watch(settings, &state->places[k], heartbeat, dt_s);
  return is_late;
}

int axis_travel_step(const axis_offset_settings* settings, axis_travel_state* state, const double* at, int n,
                     int is_machine_on, int is_enabled, const double* corrections_um, double position, double dt_s) {
  const int counts_before = state->counts;
  double offsets_um[AXIS_TRAVEL_PLACES], counts;
  int k, is_any_enabled = 0;
  for (k = 0; k < n; ++k) {
    axis_offset_step(settings, &state->places[k], is_machine_on, is_enabled, corrections_um[k], dt_s);
    offsets_um[k] = state->places[k].offset_um;
    is_any_enabled = is_any_enabled || state->places[k].is_offset_enabled;
  }
  state->is_wrong = state->places[0].is_wrong;
  if (state->counts == 0 && !state->is_wrong) { /* the control has added up as many counts forth as back */
    state->um_per_count = settings->um_per_count;
    state->scale = settings->um_per_count / settings->unit_um;
  }
  if (position >= -FARTHEST && position <= FARTHEST) state->position = position; /* no NAN is */
  state->offset_um = axis_travel_value(at, offsets_um, n, state->position);
  counts = state->um_per_count > 0.0 ? state->offset_um / state->um_per_count : 0.0;
  if (counts > MOST_TRAVEL_COUNTS) counts = MOST_TRAVEL_COUNTS;
  if (counts < -MOST_TRAVEL_COUNTS) counts = -MOST_TRAVEL_COUNTS;
  state->counts = (int)(counts < 0.0 ? counts - 0.5 : counts + 0.5);
  state->is_offset_enabled = is_machine_on && (is_any_enabled || state->counts != 0 || counts_before != 0);
  return state->counts;
}
