/* See drift_correction.h for what is computed, and for how this file must be compiled. */
#include "drift_correction.h"

#include <math.h>

#ifdef __FAST_MATH__
#error "drift_correction.c marks missing readings by NAN: compile it without -ffast-math"
#endif
#if defined(__clang__)
#pragma STDC FP_CONTRACT OFF
#elif defined(__GNUC__)
#pragma GCC optimize("fp-contract=off")
#endif

#define SOON_ENOUGH 1e-6 /* of a period: times that are sums of steps round */
#define UNTOLD 1e-6      /* pivot below which only others that are out tell of an input */

static double larger(double a, double b) {
  return a < b ? b : a;
}
static double smaller(double a, double b) {
  return b < a ? b : a;
}
static double clamped(double x, double low, double high) {
  return x < low ? low : high < x ? high : x;
}

/* A step that is no finite number above 0 takes no time. */
static double elapsed_s(double dt_s) {
  return dt_s > 0.0 && isfinite(dt_s) ? dt_s : 0.0;
}

static double by_others(const drift_guard* guard, int n, const double* x) {
  double expected = guard->others_intercept;
  int k;
  for (k = 0; k < n; ++k) {
    if (guard->others_coefficient[k] != 0.0) expected += guard->others_coefficient[k] * x[k];
  }
  return expected;
}

/* Replaces those that are out by what the other inputs lead to, all at once: x_k - sum_l b_kl x_l = b_k + sum_j b_kj x_j
 * with k and l out and j not. One that only others that are out tell of is untold and stays as it is. a: n x (n + 1). */
static void replace(const drift_fail_safe* safe, drift_input_state* inputs, double* a, double* x) {
  const int n = safe->n_inputs, width = n + 1;
  int i, j, k;
  for (k = 0; k < n; ++k) {
    double* row = a + k * width;
    inputs[k].is_untold = 0;
    if (!inputs[k].is_out) continue;
    for (j = 0; j < n; ++j) row[j] = j == k ? 1.0 : 0.0;
    row[n] = safe->guards[k].others_intercept;
    for (j = 0; j < n; ++j) {
      const double b = safe->guards[k].others_coefficient[j];
      if (inputs[j].is_out) {
        row[j] -= b;
      } else if (b != 0.0) {
        row[n] += b * x[j];
      }
    }
  }
  for (k = 0; k < n; ++k) {
    double* row = a + k * width;
    if (!inputs[k].is_out) continue;
    if (!(row[k] > UNTOLD)) {
      inputs[k].is_untold = 1;
      for (j = 0; j < n; ++j) row[j] = j == k ? 1.0 : 0.0;
      row[n] = x[k];
    }
    for (i = 0; i < n; ++i) {
      double share;
      if (!inputs[i].is_out || i == k) continue;
      share = a[i * width + k] / row[k];
      for (j = k; j <= n; ++j) a[i * width + j] -= share * row[j];
    }
  }
  for (k = 0; k < n; ++k) {
    if (inputs[k].is_out) x[k] = a[k * width + n] / a[k * width + k];
  }
}

static int is_doubted(const drift_input_state* in, double time_s, double soon_s) {
  return time_s < in->doubted_until_s - soon_s;
}

static void doubt(drift_input_state* in, int why, double size, double until_s) {
  if (in->doubt == DRIFT_NO_DOUBT) {
    in->doubt = why;
    in->doubt_size = size;
  }
  in->doubted_until_s = until_s;
}

/* How warm the first readings are: 0 as at the start of the training runs, 1 as in the mean of their rows. */
static double warmth_of_start(const drift_fail_safe* safe, drift_input_state* inputs, const double* readings) {
  double mean = 0.0, warmth = 0.0;
  int k, n_watched = 0;
  for (k = 0; k < safe->n_inputs; ++k) {
    if (safe->guards[k].start_weight == 0.0) continue;
    if (!inputs[k].has_first && isfinite(readings[k])) {
      inputs[k].first = readings[k];
      inputs[k].has_first = 1;
    }
    if (!inputs[k].has_first) continue;
    mean += inputs[k].first - safe->guards[k].start_offset;
    ++n_watched;
  }
  for (k = 0; k < safe->n_inputs; ++k) {
    const drift_guard* guard = &safe->guards[k];
    if (guard->start_weight != 0.0 && inputs[k].has_first)
      warmth += guard->start_weight * (inputs[k].first - guard->start_offset - mean / n_watched);
  }
  return warmth;
}

double drift_repair(const drift_fail_safe* safe, drift_state* state, drift_input_state* inputs, double* room,
                    const double* readings, double dt_s, double* repaired) {
  const int n = safe->n_inputs, is_first = !state->has_repaired;
  const double soon_s = SOON_ENOUGH * safe->period_s;
  double *x = repaired, deserved = 1.0, time_s, until_s;
  int k, pass, n_doubted = 0;
  if (!is_first) state->time_s += elapsed_s(dt_s);
  time_s = state->time_s;
  until_s = time_s + safe->back_after_s;

  for (k = 0; k < n; ++k) { /* missing for too long, or jumping */
    const drift_guard* guard = &safe->guards[k];
    drift_input_state* in = &inputs[k];
    double read = readings[k];
    in->doubt = DRIFT_NO_DOUBT;
    in->doubt_size = 0.0;
    if (!isfinite(read)) {
      if (!in->has_last || time_s - in->last_s > safe->stale_s + soon_s) doubt(in, DRIFT_NO_READING, 0.0, until_s);
    } else {
      double steps;
      if (guard->is_rise) {
        if (!in->has_start) {
          if (is_first) in->base = read;
          in->start = read - in->used; /* one that comes late goes on from what stood for it */
          in->has_start = 1;
        }
        read -= in->start;
      }
      steps = larger(1.0, (time_s - in->last_s) / safe->period_s);
      if (in->has_last && fabs(read - in->last) > steps * guard->most_jump) doubt(in, DRIFT_JUMP, read - in->last, until_s);
      in->last = read;
      in->last_s = time_s;
      in->has_last = 1;
    }
    x[k] = in->has_last ? in->last : 0.0;
  }

  for (pass = 0; pass <= n; ++pass) { /* or too far from what the others say */
    double furthest = 1.0;
    int any_out = 0, worst = -1;
    for (k = 0; k < n; ++k) {
      inputs[k].is_out = is_doubted(&inputs[k], time_s, soon_s) && safe->guards[k].others_coefficient;
      any_out = any_out || inputs[k].is_out;
    }
    if (any_out) replace(safe, inputs, room, x);
    for (k = 0; pass == 0 && k < n; ++k) {
      drift_input_state* in = &inputs[k];
      if (in->is_out && !(in->has_last && fabs(in->last - x[k]) <= safe->back_within * safe->guards[k].most_apart))
        in->doubted_until_s = until_s;
    }
    for (k = 0; k < n; ++k) {
      const drift_guard* guard = &safe->guards[k];
      double apart;
      if (is_doubted(&inputs[k], time_s, soon_s) || !guard->others_coefficient) continue;
      apart = fabs(x[k] - by_others(guard, n, x)) / guard->most_apart;
      if (apart > furthest) {
        furthest = apart;
        worst = k;
      }
    }
    if (worst < 0) break;
    doubt(&inputs[worst], DRIFT_APART, x[worst] - by_others(&safe->guards[worst], n, x), until_s);
  }

  if (isfinite(safe->most_start) && time_s <= safe->stale_s + soon_s)
    state->is_strange = fabs(warmth_of_start(safe, inputs, readings)) > safe->most_start;
  if (state->is_strange) deserved = 1.0 - exp(-time_s / safe->start_s);

  for (k = 0; k < n; ++k) { /* what the readings deserve */
    const drift_guard* guard = &safe->guards[k];
    drift_input_state* in = &inputs[k];
    double outside;
    if (guard->is_rise && is_first) x[k] = 0.0;
    in->is_doubted = is_doubted(in, time_s, soon_s);
    if (in->is_doubted && (++n_doubted > safe->most_replaced || !guard->others_coefficient || in->is_untold)) deserved = 0.0;
    outside = larger(0.0, larger(guard->low - x[k], x[k] - guard->high));
    if (outside > 0.0) deserved = smaller(deserved, larger(0.0, 1.0 - outside / (guard->high - guard->low)));
    in->used = x[k];
    x[k] = clamped(x[k], guard->low, guard->high) + (guard->is_rise ? in->base : 0.0);
  }
  state->has_repaired = 1;
  state->deserved = deserved;
  return deserved;
}

double drift_term_value(const drift_term* term, drift_term_state* state, double reading, double dt_s) {
  double value = 1.0;
  int i;
  state->since_s += elapsed_s(dt_s);
  if (!isfinite(reading)) return NAN;
  if (term->is_rise) {
    if (!state->has_start) {
      state->start = reading;
      state->has_start = 1;
    }
    reading -= state->start;
  }
  if (term->is_running) {
    value = reading != 0.0 ? 1.0 : 0.0;
  } else {
    for (i = 0; i < term->power; ++i) value *= reading;
  }
  if (!(term->lag_s > 0.0)) return value;
  if (state->has_lag) {
    const double towards = term->holds ? state->before : 0.5 * (state->before + value);
    state->lag += (1.0 - exp(-state->since_s / term->lag_s)) * (towards - state->lag);
  } else {
    state->lag = term->holds ? 0.0 : value;
    state->has_lag = 1;
  }
  state->before = value;
  state->since_s = 0.0;
  return state->lag;
}

double drift_formula_value(const drift_formula* formula, drift_term_state* terms, const double* readings, double dt_s) {
  double sum_um = formula->intercept_um;
  int k;
  for (k = 0; k < formula->n_terms; ++k) {
    const drift_term* term = &formula->terms[k];
    sum_um += term->coefficient * drift_term_value(term, &terms[k], readings[term->input], dt_s);
  }
  return sum_um;
}

double drift_guarded_um(const drift_fail_safe* safe, drift_state* state, double deserved, double prediction_um,
                        double dt_s) {
  const double step_s = elapsed_s(dt_s), most_um = safe->most_rate_um_s * step_s;
  double wanted_um;
  if (isfinite(prediction_um)) state->prediction_um = prediction_um;
  if (state->has_guarded) {
    state->trust += (1.0 - exp(-step_s / safe->fade_s)) * (deserved - state->trust);
  } else {
    state->trust = deserved;
  }
  wanted_um = clamped(state->trust * state->prediction_um, safe->lowest_um, safe->highest_um);
  if (state->has_guarded) {
    state->correction_um += clamped(wanted_um - state->correction_um, -most_um, most_um);
  } else {
    state->correction_um = wanted_um;
  }
  state->has_guarded = 1;
  return state->correction_um;
}

double drift_correction_step(const drift_fail_safe* safe, const drift_formula* formula, drift_state* state,
                             const drift_arrays* arrays, const double* readings, double dt_s) {
  const double deserved = drift_repair(safe, state, arrays->inputs, arrays->room, readings, dt_s, arrays->repaired);
  const double prediction_um = drift_formula_value(formula, arrays->terms, arrays->repaired, dt_s);
  return drift_guarded_um(safe, state, deserved, prediction_um, dt_s);
}
