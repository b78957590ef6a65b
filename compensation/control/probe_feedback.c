/* See probe_feedback.h for what is computed. */
#include "probe_feedback.h"

#include <math.h>

#ifdef __FAST_MATH__
#error "probe_feedback.c marks missing values by NAN: compile it without -ffast-math"
#endif
#if defined(__clang__)
#pragma STDC FP_CONTRACT OFF
#elif defined(__GNUC__)
#pragma GCC optimize("fp-contract=off")
#endif

static int probe_is_above(double x, double least) {
  return x > least && isfinite(x);
}

static double probe_time_s(double dt_s) {
  return probe_is_above(dt_s, 0.0) ? dt_s : 0.0;
}

int probe_is_valid(const probe_process* process) {
  return probe_is_above(process->deviation_um, 0.0) && probe_is_above(process->time_constant_s, 0.0) &&
         probe_is_above(process->noise_um, 0.0) && process->lag_s >= 0.0 && isfinite(process->lag_s);
}

/* Factors of s and T, and the first weight of each filter of a size: exp(-(ln factor)^2 / (pi^2 / 4)) over the sum of
 * all. */
static const double kProbeSizes[PROBE_SIZES] = {1.0 / 3.0, 1.0, 3.0, 9.0}, kProbeTimes[PROBE_TIMES] = {0.25, 1.0, 4.0, 16.0};
static const double kProbeFirst[PROBE_SIZES] = {0.0647425292435455, 0.10559133412205336, 0.0647425292435455,
                                                0.014923607390855635};

static double probe_size_um(const probe_process* process, int k) {
  return kProbeSizes[k / PROBE_TIMES] * process->deviation_um;
}

static void probe_begin(const probe_process* process, probe_estimate* bank) {
  int k;
  for (k = 0; k < PROBE_BANK; ++k) {
    const double size_um = probe_size_um(process, k);
    bank[k].residual_um2 = process->is_known_at_start ? 0.0 : size_um * size_um;
    bank[k].weight = kProbeFirst[k / PROBE_TIMES];
  }
}

static void probe_wait(const probe_process* process, probe_estimate* bank, double step_s) {
  const double same = exp(-step_s / PROBE_REDRAW_S);
  double kept[PROBE_TIMES];
  int k;
  for (k = 0; k < PROBE_TIMES; ++k) kept[k] = exp(-step_s / (kProbeTimes[k] * process->time_constant_s));
  for (k = 0; k < PROBE_BANK; ++k) {
    const double by = kept[k % PROBE_TIMES], size_um = probe_size_um(process, k);
    bank[k].residual_um *= by;
    bank[k].both_um2 *= by;
    bank[k].residual_um2 = by * by * bank[k].residual_um2 + (1.0 - by * by) * size_um * size_um;
    bank[k].weight = same * bank[k].weight + (1.0 - same) * kProbeFirst[k / PROBE_TIMES];
  }
}

static double probe_sum_um(const probe_estimate* e) {
  return e->level_um + e->residual_um;
}

static double probe_sum_um2(const probe_estimate* e) {
  return e->level_um2 + 2.0 * e->both_um2 + e->residual_um2;
}

/* Mean of the bank, and the variance of the mixture about it. */
static double probe_mean_um(const probe_estimate* bank) {
  double um = 0.0;
  int k;
  for (k = 0; k < PROBE_BANK; ++k) um += bank[k].weight * probe_sum_um(&bank[k]);
  return um;
}

static double probe_mixture_um2(const probe_estimate* bank) {
  const double mean_um = probe_mean_um(bank);
  double um2 = 0.0;
  int k;
  for (k = 0; k < PROBE_BANK; ++k) {
    const double apart_um = probe_sum_um(&bank[k]) - mean_um;
    um2 += bank[k].weight * (probe_sum_um2(&bank[k]) + apart_um * apart_um);
  }
  return um2 > 0.0 ? um2 : 0.0;
}

/* By how much a probing is off what is expected, and by how much it may be. */
static double probe_off_um(const probe_process* process, const probe_estimate* bank, double read_um, double* bound_um) {
  *bound_um = PROBE_REFUSED * sqrt(probe_mixture_um2(bank) + process->noise_um * process->noise_um);
  return read_um - probe_mean_um(bank);
}

/* See probe_state. */
static double probe_loss(const probe_process* process, const probe_estimate* bank, double read_um, double bound_um) {
  const double most = 0.5 * PROBE_REFUSED * PROBE_REFUSED + log(bound_um / PROBE_REFUSED);
  double density = 0.0, loss;
  int k;
  for (k = 0; k < PROBE_BANK; ++k) {
    const double um2 = probe_sum_um2(&bank[k]) + process->noise_um * process->noise_um;
    const double off_um = read_um - probe_sum_um(&bank[k]);
    density += bank[k].weight * exp(-0.5 * off_um * off_um / um2) / sqrt(um2);
  }
  loss = -log(density); /* infinite where all exponentials vanish */
  return loss < most ? loss : most;
}

/* Weights by the density of what was read. */
static void probe_weigh(const probe_process* process, probe_estimate* bank, double read_um) {
  double logarithm[PROBE_BANK], most = 0.0, sum = 0.0; /* most: so that no exponential vanishes for all */
  int k;
  for (k = 0; k < PROBE_BANK; ++k) {
    const double um2 = probe_sum_um2(&bank[k]) + process->noise_um * process->noise_um;
    const double off_um = read_um - probe_sum_um(&bank[k]);
    logarithm[k] = -0.5 * (off_um * off_um / um2 + log(um2));
    if (k == 0 || logarithm[k] > most) most = logarithm[k];
  }
  for (k = 0; k < PROBE_BANK; ++k) sum += bank[k].weight *= exp(logarithm[k] - most);
  for (k = 0; k < PROBE_BANK; ++k) bank[k].weight /= sum;
}

static void probe_learn(const probe_process* process, probe_estimate* bank, double read_um) {
  int k;
  probe_weigh(process, bank, read_um);
  for (k = 0; k < PROBE_BANK; ++k) {
    probe_estimate* e = &bank[k];
    const double level = e->level_um2 + e->both_um2, residual = e->both_um2 + e->residual_um2;
    const double all = level + residual + process->noise_um * process->noise_um, off_um = read_um - probe_sum_um(e);
    e->level_um += level / all * off_um;
    e->residual_um += residual / all * off_um;
    e->level_um2 -= level * level / all;
    e->both_um2 -= level * residual / all;
    e->residual_um2 -= residual * residual / all;
  }
}

/* The level has jumped: what is read is its first and only news, whatever it was before. */
static void probe_begin_jumped(const probe_process* process, probe_estimate* e, double read_um) {
  e->level_um = read_um - e->residual_um;
  e->level_um2 = e->residual_um2 + process->noise_um * process->noise_um;
  e->both_um2 = -e->residual_um2;
}

static void probe_copy(probe_estimate* to, const probe_estimate* from) {
  int k;
  for (k = 0; k < PROBE_BANK; ++k) to[k] = from[k];
}

void probe_row(const probe_process* process, probe_state* state, double prediction_um, double correction_um, double dt_s) {
  const double spacing_s = process->lag_s / (PROBE_PASTS - 2);
  double before_s, after_s;
  int k;
  if (!probe_is_valid(process)) return;
  if (!state->has_begun) {
    state->has_begun = 1;
    probe_begin(process, state->now);
  } else {
    before_s = state->time_s - process->lag_s;
    state->time_s += probe_time_s(dt_s);
    after_s = state->time_s - process->lag_s;
    if (before_s < 0.0) before_s = 0.0; /* a probing of times before the first row is not taken */
    if (after_s > before_s) {
      probe_wait(process, state->now, after_s - before_s);
      if (state->has_jumped) probe_wait(process, state->jumped, after_s - before_s);
    }
  }
  /* The newest of the past rows is this one. It is written over while it is near the one before it: then the ring reaches
   * back over lag_s, however fast rows come. */
  k = (state->newest + PROBE_PASTS - 1) % PROBE_PASTS;
  if (state->n_pasts == 0) {
    state->n_pasts = 1;
  } else if (state->n_pasts == 1 || state->past[state->newest].time_s - state->past[k].time_s >= spacing_s) {
    state->newest = (state->newest + 1) % PROBE_PASTS;
    if (state->n_pasts < PROBE_PASTS) ++state->n_pasts;
  }
  state->past[state->newest].time_s = state->time_s;
  state->past[state->newest].prediction_um = isfinite(prediction_um) ? prediction_um : 0.0;
  state->past[state->newest].correction_um = isfinite(correction_um) ? correction_um : 0.0;
}

/* Prediction and correction at a time between two rows that are kept: the prediction on a straight line, the correction as
 * it was in force until the later one. */
static probe_past probe_past_at(const probe_state* state, double time_s) {
  int k = state->newest, i;
  probe_past at = state->past[k];
  for (i = 1; i < state->n_pasts && at.time_s > time_s; ++i) {
    const probe_past later = at;
    k = (k + PROBE_PASTS - 1) % PROBE_PASTS;
    at = state->past[k];
    if (at.time_s <= time_s && later.time_s > at.time_s) {
      const double share = (time_s - at.time_s) / (later.time_s - at.time_s);
      at.prediction_um += share * (later.prediction_um - at.prediction_um);
      if (at.time_s < time_s) at.correction_um = later.correction_um;
      at.time_s = time_s;
      return at;
    }
  }
  return at;
}

static int probe_refuse(probe_state* state, int verdict) {
  ++state->n_refused;
  return state->verdict = verdict;
}

static int probe_accept(probe_state* state, int verdict) {
  state->has_jumped = 0;
  state->n_in_row = 0;
  ++state->n_taken;
  if (verdict == PROBE_JUMP) ++state->n_jumps;
  return state->verdict = verdict;
}

/* Whether a good probe would read the same number so often. */
static int probe_is_stuck(const probe_process* process, probe_state* state, double read_um, double residual_um) {
  const double moved_um = fmin(fabs(state->off_um), fabs(residual_um - state->residual_um));
  const double apart_um = fabs(read_um - state->read_um), chance = state->step_um * PROBE_DENSEST / moved_um;
  if (!state->has_read || apart_um > PROBE_ROUNDING * process->noise_um) {
    if (state->has_read && (state->step_um == 0.0 || apart_um < state->step_um)) state->step_um = apart_um;
    state->ln_chance = 0.0;
  } else if (state->step_um > 0.0 && chance < 1.0) {
    state->ln_chance += log(chance);
  }
  state->has_read = 1;
  state->read_um = read_um;
  state->residual_um = residual_um;
  return state->ln_chance < log(PROBE_CHANCE);
}

/* read_um: as the probe has it. */
static int probe_hear(const probe_process* process, probe_state* state, double residual_um, double read_um) {
  double jumped_bound_um;
  int is_third = 0, k;
  state->off_um = 0.0;
  state->bound_um = 0.0;
  if (!probe_is_valid(process) || !isfinite(residual_um)) return probe_refuse(state, PROBE_NO_NUMBER);
  if (!state->has_begun || state->time_s < process->lag_s) return probe_refuse(state, PROBE_TOO_EARLY);
  state->off_um = probe_off_um(process, state->now, residual_um, &state->bound_um);
  state->loss = probe_loss(process, state->now, residual_um, state->bound_um);
  if (probe_is_stuck(process, state, read_um, residual_um)) return probe_refuse(state, PROBE_STUCK);
  if (fabs(state->off_um) <= state->bound_um) {
    probe_learn(process, state->now, residual_um);
    return probe_accept(state, PROBE_TAKEN);
  }
  if (state->has_jumped) {
    const double off_um = probe_off_um(process, state->jumped, residual_um, &jumped_bound_um);
    if (fabs(off_um) <= jumped_bound_um) {
      probe_copy(state->now, state->jumped);
      probe_learn(process, state->now, residual_um);
      return probe_accept(state, PROBE_JUMP);
    }
    is_third = state->n_in_row + 1 >= PROBE_IN_ROW;
    if (is_third) {
      probe_weigh(process, state->jumped, residual_um);
      for (k = 0; k < PROBE_BANK; ++k) state->now[k].weight = state->jumped[k].weight;
    }
  }
  probe_copy(state->jumped, state->now);
  for (k = 0; k < PROBE_BANK; ++k) probe_begin_jumped(process, &state->jumped[k], residual_um);
  state->has_jumped = 1;
  ++state->n_in_row;
  if (is_third) {
    probe_copy(state->now, state->jumped);
    return probe_accept(state, PROBE_JUMP);
  }
  return probe_refuse(state, PROBE_UNLIKELY);
}

int probe_drift(const probe_process* process, probe_state* state, double drift_um) {
  const probe_past at = probe_past_at(state, state->time_s - process->lag_s);
  return probe_hear(process, state, drift_um - at.prediction_um, drift_um);
}

int probe_left(const probe_process* process, probe_state* state, double left_um) {
  const probe_past at = probe_past_at(state, state->time_s - process->lag_s);
  return probe_hear(process, state, left_um + at.correction_um - at.prediction_um, left_um);
}

/* The bank ahead_s from now. */
static void probe_ahead(const probe_process* process, const probe_state* state, double ahead_s, probe_estimate* bank) {
  const double since_s = state->time_s < process->lag_s ? state->time_s : process->lag_s; /* of the estimate */
  probe_copy(bank, state->now);
  probe_wait(process, bank, since_s + probe_time_s(ahead_s));
}

double probe_expected_um(const probe_process* process, const probe_state* state, double ahead_s) {
  probe_estimate bank[PROBE_BANK];
  if (!state->has_begun || !probe_is_valid(process)) return 0.0;
  probe_ahead(process, state, ahead_s, bank);
  return probe_mean_um(bank);
}

double probe_deviation_um(const probe_process* process, const probe_state* state, double ahead_s) {
  probe_estimate bank[PROBE_BANK];
  if (!state->has_begun || !probe_is_valid(process)) return 0.0;
  probe_ahead(process, state, ahead_s, bank);
  return sqrt(probe_mixture_um2(bank));
}

double probe_corrected_um(const probe_process* process, const probe_state* state, double prediction_um, double lowest_um,
                          double highest_um) {
  const double um = prediction_um + probe_expected_um(process, state, 0.0);
  return um < lowest_um ? lowest_um : um > highest_um ? highest_um : um;
}

double probe_slewed_um(double before_um, double wanted_um, double most_rate_um_s, double dt_s) {
  const double most_um = most_rate_um_s * probe_time_s(dt_s);
  if (wanted_um > before_um + most_um) return before_um + most_um;
  if (wanted_um < before_um - most_um) return before_um - most_um;
  return wanted_um;
}
