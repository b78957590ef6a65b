/* See probe_members.h for what is computed. */
#include "probe_members.h"

#include <math.h>

#ifdef __FAST_MATH__
#error "probe_members.c marks missing values by NAN: compile it without -ffast-math"
#endif
#if defined(__clang__)
#pragma STDC FP_CONTRACT OFF
#elif defined(__GNUC__)
#pragma GCC optimize("fp-contract=off")
#endif

double probe_member_um(double correction_um, double trust, double blend_um, double member_um) {
  return correction_um + trust * (member_um - blend_um);
}

double probe_share(int n, double time_s) {
  const double others = n - 1.0;
  return n < 2 ? 0.0 : others / n * (1.0 - exp(-n * time_s / (others * PROBE_SHIFT_S)));
}

void probe_weights_share(probe_member* members, int n, double share) {
  int i;
  for (i = 0; n > 1 && i < n; ++i)
    members[i].weight = (1.0 - share) * members[i].weight + share * (1.0 - members[i].weight) / (n - 1.0);
}

double probe_weights_learn(probe_member* members, int n) {
  double least = members[0].loss, sum = 0.0; /* least: so that no exponential vanishes for all */
  int i;
  for (i = 1; i < n; ++i) least = members[i].loss < least ? members[i].loss : least;
  for (i = 0; i < n; ++i) sum += members[i].weight *= exp(least - members[i].loss);
  for (i = 0; i < n; ++i) members[i].weight /= sum;
  return least - log(sum);
}

void probe_members_row(const probe_process* processes, probe_member* members, int n, const double* predictions_um,
                       double correction_um, double dt_s) {
  const int is_first = !members[0].probing.has_begun;
  int i;
  for (i = 0; i < n; ++i) {
    if (is_first) members[i].weight = 1.0 / n;
    if (isfinite(predictions_um[i])) members[i].prediction_um = predictions_um[i];
    probe_row(&processes[i], &members[i].probing, members[i].prediction_um, correction_um, dt_s);
  }
  if (!is_first && dt_s > 0.0 && isfinite(dt_s)) probe_weights_share(members, n, probe_share(n, dt_s));
}

/* The member with the largest weight, the first of equals. */
static int probe_heaviest(const probe_member* members, int n) {
  int i, heaviest = 0;
  for (i = 1; i < n; ++i) {
    if (members[i].weight > members[heaviest].weight) heaviest = i;
  }
  return heaviest;
}

static int probe_members_read(const probe_process* processes, probe_member* members, int n, double read_um, int is_left) {
  const int leading = probe_heaviest(members, n);
  int i, is_heard = 1;
  for (i = 0; i < n; ++i) {
    probe_state* state = &members[i].probing;
    const int verdict = is_left ? probe_left(&processes[i], state, read_um) : probe_drift(&processes[i], state, read_um);
    members[i].is_leading = i == leading;
    if (verdict == PROBE_TOO_EARLY || verdict == PROBE_NO_NUMBER || verdict == PROBE_STUCK)
      is_heard = 0;
    else
      members[i].loss = state->loss;
  }
  if (is_heard) (void)probe_weights_learn(members, n);
  if (members[leading].probing.verdict >= PROBE_UNLIKELY) ++members[0].n_refused;
  return members[leading].probing.verdict;
}

int probe_members_drift(const probe_process* processes, probe_member* members, int n, double drift_um) {
  return probe_members_read(processes, members, n, drift_um, 0);
}

int probe_members_left(const probe_process* processes, probe_member* members, int n, double left_um) {
  return probe_members_read(processes, members, n, left_um, 1);
}

const probe_state* probe_leading(const probe_member* members, int n) {
  int i;
  for (i = 0; i < n; ++i) {
    if (members[i].is_leading) return &members[i].probing;
  }
  return &members[0].probing;
}

static double probe_member_expected_um(const probe_process* processes, const probe_member* members, int i, double ahead_s) {
  return members[i].prediction_um - members[0].prediction_um +
         probe_expected_um(&processes[i], &members[i].probing, ahead_s);
}

double probe_members_expected_um(const probe_process* processes, const probe_member* members, int n, double ahead_s) {
  double um = 0.0;
  int i;
  for (i = 0; i < n; ++i) um += members[i].weight * probe_member_expected_um(processes, members, i, ahead_s);
  return um;
}

double probe_members_deviation_um(const probe_process* processes, const probe_member* members, int n, double ahead_s) {
  const double mean_um = probe_members_expected_um(processes, members, n, ahead_s);
  double um2 = 0.0;
  int i;
  if (n == 1) return probe_deviation_um(processes, &members[0].probing, ahead_s);
  for (i = 0; i < n; ++i) {
    const double own_um = probe_deviation_um(&processes[i], &members[i].probing, ahead_s);
    const double apart_um = probe_member_expected_um(processes, members, i, ahead_s) - mean_um;
    um2 += members[i].weight * (own_um * own_um + apart_um * apart_um);
  }
  return sqrt(um2);
}

double probe_members_corrected_um(const probe_process* processes, const probe_member* members, int n, double lowest_um,
                                  double highest_um) {
  const double um = members[0].prediction_um + probe_members_expected_um(processes, members, n, 0.0);
  return um < lowest_um ? lowest_um : um > highest_um ? highest_um : um;
}
