/* What a correction leaves, estimated from probings: a touch probe measures now and then by how much an axis is off, and the
 * correction takes up what it found and forgets it as fast as errors of the model come and go. This very file is compiled
 * into Driftwright, which judges by it, and into controls. C99; it needs <math.h> alone, allocates nothing, and keeps all
 * that it remembers in a struct of the caller, which is all zero before the first row.
 *
 *   drift = prediction + level + r,   dr = -r / T dt + s sqrt(2 / T) dW   (Ornstein-Uhlenbeck: deviation s, time constant T)
 *   a probing reads level + r as they were lag_s ago, + noise
 *
 * Errors of this run may be larger than those of the runs of the fit. All variances, s^2 and noise^2 among them, are
 * therefore those above times a scale, known beforehand as well as from one probing (a unit of information), and from the n
 * that were taken:
 *
 *   scale = max(1, (1 + sum min(u^2, PROBE_REFUSED^2)) / (1 + n)),   u = (read - expected) / deviation of it before scaling
 *
 * the conjugate estimate of a variance, but never below that of the fit: a calm axis says nothing of the next cut. What is
 * expected after given probings does not depend on the scale; the interval and the bound beyond which a probing is refused
 * do.
 *
 * `level` is 0 until a jump. The filter is the one of Kalman for these two numbers. It runs lag_s late, and its answer is
 * continued over lag_s: with a constant lag that is exact.
 *
 * A probing that is further than PROBE_REFUSED deviations from what is expected is refused (a chip, another tool). From
 * there a second filter starts, for which the level has jumped to a value of which nothing was known before. The next
 * probing that the first filter refuses is taken if the second one expects it: two probings that agree with each other,
 * within PROBE_REFUSED deviations sqrt(scale (2 noise^2 + 2 s^2 (1 - exp(-h / T)))) at a distance h in time, are a jump of
 * the axis. It does not fade, as a collision or another clamping does not; later probings correct it. A probing that the
 * first filter expects ends the second one. The third refused probing in a row is taken as a jump, too, though it agrees
 * with none: errors are then larger than was known, and it adds to the scale. If no more than 4 % of all probings are bad,
 * three bad ones in a row are as rare as a good one that is refused (0.04^3 = 1 / 16,000).
 *
 * Sources: Uhlenbeck & Ornstein, Phys. Rev. 36 (1930) 823; Kalman, J. Basic Eng. 82 (1960) 35; a jump as a second filter:
 * Willsky & Jones, IEEE Trans. Autom. Control 21 (1976) 108; a variance that is learned with the state: West & Harrison,
 * Bayesian Forecasting
 * and Dynamic Models (1997), 4.5; a unit of information: Kass & Wasserman, J. Am. Stat. Assoc. 90 (1995) 928. */
#ifndef DRIFTWRIGHT_PROBE_FEEDBACK_H
#define DRIFTWRIGHT_PROBE_FEEDBACK_H

#ifdef __cplusplus
extern "C" {
#endif

#define PROBE_REFUSED 4.0 /* deviations; one of 16,000 good probings is refused at most */
#define PROBE_IN_ROW 3    /* refused probings of which the last one is taken */
#define PROBE_PASTS 32    /* past rows that are kept, over lag_s */

typedef struct {
  double deviation_um;    /* s of the residual; > 0 */
  double time_constant_s; /* T with which it fades; > 0 */
  double noise_um;        /* of a probing, 1 sigma; > 0 */
  double lag_s;           /* from the touch until its value is here; >= 0 */
  int is_known_at_start;  /* 1: the residual is 0 in the first row, because the drift counts from there */
} probe_process;

/* What became of a probing. */
enum {
  PROBE_NONE = 0,      /* there was none yet */
  PROBE_TAKEN = 1,     /* as expected */
  PROBE_JUMP = 2,      /* it agrees with the one refused before it, or is the third in a row: the axis has jumped */
  PROBE_UNLIKELY = 3,  /* refused: too far from what is expected */
  PROBE_TOO_EARLY = 4, /* refused: touched before the first row, where there was no prediction */
  PROBE_NO_NUMBER = 5  /* refused: the probe missed, or a setting is out of its range */
};

/* Mean and covariance of level and r; covariances before scaling. */
typedef struct {
  double level_um, residual_um;
  double level_um2, both_um2, residual_um2;
} probe_estimate;

/* A row that has passed. */
typedef struct {
  double time_s, prediction_um, correction_um;
} probe_past;

/* What is remembered; all zero before the first row. */
typedef struct {
  int has_begun, has_jumped;  /* has_jumped: `jumped` is in use */
  int n_pasts, newest;        /* of the ring `past` */
  double time_s;              /* since the first row */
  probe_estimate now, jumped; /* lag_s ago */
  probe_past past[PROBE_PASTS];
  int verdict;     /* of the last probing, one of PROBE_... */
  double off_um;   /* of the last probing: read minus expected */
  double bound_um; /* by which they may differ */
  int n_taken, n_refused, n_jumps;
  int n_in_row;       /* unlikely ones since the last that was taken */
  double sum_squares; /* of their u */
} probe_state;

/* Whether all settings are in their ranges. Otherwise the residual stays 0, and all probings are refused. */
int probe_is_valid(const probe_process* process);

/* A row: time passes. prediction_um: of the drift. correction_um: in force from the row before until now. dt_s: since the row before; of no account in
 * the first one. It may be called between rows with the last prediction. */
void probe_row(const probe_process* process, probe_state* state, double prediction_um, double correction_um, double dt_s);

/* A probing whose value has come in the last row; what became of it. */
int probe_residual(const probe_process* process, probe_state* state, double residual_um); /* drift minus prediction */
int probe_drift(const probe_process* process, probe_state* state, double drift_um); /* of the axis without correction */
int probe_left(const probe_process* process, probe_state* state, double left_um);   /* of the corrected axis */

/* Factor of all variances that probings of this run have taught; at least 1. */
double probe_scale(const probe_state* state);

/* The residual that is expected after ahead_s [um], and its deviation, 1 sigma [um]. */
double probe_expected_um(const probe_process* process, const probe_state* state, double ahead_s);
double probe_deviation_um(const probe_process* process, const probe_state* state, double ahead_s);

/* Prediction and residual together [um], between two bounds. */
double probe_corrected_um(const probe_process* process, const probe_state* state, double prediction_um, double lowest_um,
                          double highest_um);
/* A value on its way from before_um to wanted_um [um], no faster than most_rate_um_s. */
double probe_slewed_um(double before_um, double wanted_um, double most_rate_um_s, double dt_s);

#ifdef __cplusplus
}
#endif

#endif
