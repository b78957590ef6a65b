/* Several predictors of the same drift that are probed together: each has a filter for its own residual (probe_feedback.h),
 * and the axis is corrected by their mean, with weights that move with their losses at probings. This very file is compiled
 * into Driftwright, which judges by it, and into controls. C99; it needs <math.h> alone, allocates nothing, and keeps all
 * that it remembers in structs of the caller, which are all zero before the first row. One member alone is its filter.
 *
 *   correction = sum_i w_i (prediction_i + expected residual_i)
 *   in time    dw_i / dt = (1 - w_i - (n - 1) w_i) / ((n - 1) S),   one change of the best in S = PROBE_SHIFT_S on average
 *   a probing  w_i ~ w_i exp(-l_i),   l_i = -ln of the density of the reading by the filters of member i (probe_feedback.h)
 *
 * Of a normal density l is u^2 / 2 + ln d, with the expected deviation d and u = (read - expected) / d, of which four
 * deviations count at most, so that a chip does not decide. w_i is then the probability that member i is the best one. Over
 * a time h the share a = (n - 1) / n (1 - exp(-n h / ((n - 1) S))) of each weight goes to the others in equal parts. After T
 * losses the sum of -ln(sum_i w_i exp(-l_i)) exceeds that along any sequence of members with k changes by at most
 * ln n + k ln((n - 1) / a) - (T - 1 - k) ln(1 - a), with the share a of equal intervals.
 *
 * Source: Herbster & Warmuth, Machine Learning 32 (1998) 151-178, "Fixed Share", with learning rate 1. */
#ifndef DRIFTWRIGHT_PROBE_MEMBERS_H
#define DRIFTWRIGHT_PROBE_MEMBERS_H

#include "probe_feedback.h"

#ifdef __cplusplus
extern "C" {
#endif

#define PROBE_SHIFT_S 28800.0 /* a work shift */

/* What is remembered of one member; all zero before the first row. */
typedef struct {
  probe_state probing;
  double prediction_um; /* in the last row */
  double weight;        /* 0 before the first row; their sum is 1 */
  double loss;          /* l at the last probing */
  int is_leading;       /* of the last probing: it had the largest weight; its verdict is the one that counts */
  int n_refused;        /* of the first member: probings that the one that led has refused */
} probe_member;

/* Of a blend: a member's prediction as it may go to an axis [um]. The blend's own prediction blend_um has become
 * correction_um by trust, clamp and slew limit; a member differs from that by what trust leaves of its distance from the
 * blend. */
double probe_member_um(double correction_um, double trust, double blend_um, double member_um);

/* A row: as probe_row() for each of the n members. predictions_um: n numbers; one that is not finite leaves the last one. */
void probe_members_row(const probe_process* processes, probe_member* members, int n, const double* predictions_um,
                       double correction_um, double dt_s);

/* The first member's prediction and what is expected beyond it [um], between two bounds. */
double probe_members_corrected_um(const probe_process* processes, const probe_member* members, int n, double lowest_um,
                                  double highest_um);

/* A probing whose value has come in the last row: as probe_drift() and probe_left(). What became of it by the member that
 * leads. */
int probe_members_drift(const probe_process* processes, probe_member* members, int n, double drift_um);
int probe_members_left(const probe_process* processes, probe_member* members, int n, double left_um);

/* The member that led at the last probing; before one, the first. */
const probe_state* probe_leading(const probe_member* members, int n);

/* What is expected after ahead_s beyond the prediction of the first member, if predictions stay: sum_i w_i (prediction_i -
 * prediction_1 + expected residual_i) [um]; and the deviation of the mixture about it, 1 sigma [um]. */
double probe_members_expected_um(const probe_process* processes, const probe_member* members, int n, double ahead_s);
double probe_members_deviation_um(const probe_process* processes, const probe_member* members, int n, double ahead_s);

/* The parts of the weights. */
double probe_share(int n, double time_s);
void probe_weights_share(probe_member* members, int n, double share);
/* By `loss` of each; returns -ln(sum_i w_i exp(-l_i)). */
double probe_weights_learn(probe_member* members, int n);

#ifdef __cplusplus
}
#endif

#endif
