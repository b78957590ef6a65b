/* What a correction leaves, estimated from probings: a touch probe measures now and then by how much an axis is off, and
 * the correction takes up what it found and forgets it as fast as errors of the model come and go. This very file is
 * compiled into Driftwright, which judges by it, and into controls. C99; it needs <math.h> alone, allocates nothing, and
 * keeps all that it remembers in a struct of the caller, which is all zero before the first row.
 *
 *   drift = prediction + level + r,   dr = -r / T dt + s sqrt(2 / T) dW   (Ornstein-Uhlenbeck: deviation s, time constant T)
 *   a probing reads level + r as they were lag_s ago, + noise
 *
 * Errors of this run may be smaller or larger, faster or slower than those of the runs of the fit. So PROBE_BANK filters of
 * Kalman run side by side, with s times 1/3, 1, 3, 9 and T times 1/4, 1, 4, 16, and answer by their mean with weights w:
 *
 *   before a probing   w ~ exp(-(ln factor of s)^2 / (pi^2 / 4))
 *   in time            dw / dt = (w before a probing - w) / PROBE_REDRAW_S
 *   a probing          w ~ w exp(-u^2 / 2) / d,   u = (read - expected) / d,   d: deviation of read - expected
 *
 * w is then nearly the probability of the pair (s, T), given all probings, if it is drawn anew once in PROBE_REDRAW_S, a
 * day, on average: a calm axis does not say that the next cut is calm. (Exactly, a filter would take over the estimates of
 * the others with the weight that comes from them; each keeps its own.) pi / sqrt(8) is the deviation of the logarithm of
 * |x| of a normal x: the size is known beforehand as well as from one value. Time constants are equally likely beforehand.
 * The deviation of the answer is that of the mixture: before the first probing it is 2.76 times s.
 *
 * `level` is 0 until a jump. Each filter is the one of Kalman for level and r. It runs lag_s late, and its answer is
 * continued over lag_s: with a constant lag that is exact.
 *
 * A probing that is further than PROBE_REFUSED deviations from what is expected is refused (a chip, another tool). From
 * there a second bank starts, for which the level has jumped to a value of which nothing was known before. The next probing
 * that the first bank refuses is taken if the second one expects it: two probings that agree with each other, within
 * PROBE_REFUSED times the deviation of their difference (of each filter sqrt(2 noise^2 + 2 s^2 (1 - exp(-h / T))) at a
 * distance h in time), are a jump of the axis. It does not fade, as a collision or another clamping does not; later
 * probings correct it. A probing that the first bank expects ends the second one. The third refused probing in a row is
 * taken as a jump, too, though it agrees with none: errors are then larger than was known, and the weights learn it.
 *
 * A stuck probe goes on reading the same number, though the axis was corrected by it or the prediction has moved. A good one
 * repeats its last reading by chance, as its readings are rounded: with steps of q, at a distance d from what is expected,
 * once in d / (PROBE_DENSEST q) readings or more seldom, whatever the deviation of a normal law. d is what the filters
 * expect, or what a residual that stays would have moved the reading by, whichever is less: a calm axis is no stuck probe. q
 * is at most the smallest difference of two readings in a row so far. A reading is refused if the product of these chances,
 * over all readings in a row that are equal, is below PROBE_CHANCE, that of one normal value beyond PROBE_REFUSED
 * deviations. So are further ones, until the probe reads another number. What a stuck probe has said until then remains in
 * the estimate, and fades. Not noticed is a probe that has read a single number since the first row, and one that is stuck
 * at what is expected, which does no harm.
 *
 * Of a mixture more lies beyond PROBE_REFUSED deviations than of one normal law, 1 in 16,000: with probings each T / 2 the
 * filters refuse one of 3,000 good ones where s is right, one of 120 where errors are 3 times as large, and one of 24, the
 * first one in 5 times, where they are 9 times as large. A bound with 1 in 16,000 would be 30 s at first, and find no chip.
 *
 * Sources: Uhlenbeck & Ornstein, Phys. Rev. 36 (1930) 823; Kalman, J. Basic Eng. 82 (1960) 35; a bank of filters with their
 * probabilities: Magill, IEEE Trans. Autom. Control 10 (1965) 434; a jump as a second filter: Willsky & Jones, IEEE Trans.
 * Autom. Control 21 (1976) 108; a unit of information: Kass & Wasserman, J. Am. Stat. Assoc. 90 (1995) 928. */
#ifndef DRIFTWRIGHT_PROBE_FEEDBACK_H
#define DRIFTWRIGHT_PROBE_FEEDBACK_H

#ifdef __cplusplus
extern "C" {
#endif

#define PROBE_REFUSED 4.0 /* deviations of the mixture */
#define PROBE_IN_ROW 3    /* refused probings of which the last one is taken */
#define PROBE_CHANCE 6.334e-5        /* of a normal value to be further than PROBE_REFUSED deviations from its mean */
#define PROBE_DENSEST 0.24197072451914337 /* exp(-1/2) / sqrt(2 pi): a normal density at x is at most this / |x| */
#define PROBE_ROUNDING 1e-9  /* of the noise: readings that are nearer are equal but for the rounding of their computation */
#define PROBE_PASTS 32    /* past rows that are kept, over lag_s */
#define PROBE_SIZES 4     /* factors of s: 3^-1 to 3^2 */
#define PROBE_TIMES 4     /* factors of T: 4^-1 to 4^2 */
#define PROBE_BANK (PROBE_SIZES * PROBE_TIMES)
#define PROBE_REDRAW_S 86400.0 /* a day */

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
  PROBE_NO_NUMBER = 5, /* refused: the probe missed, or a setting is out of its range */
  PROBE_STUCK = 6      /* refused: it has read the same number too often in a row */
};

/* Of one filter of the bank: mean and covariance of level and r, and its weight; the sum of the weights is 1. */
typedef struct {
  double level_um, residual_um;
  double level_um2, both_um2, residual_um2;
  double weight;
} probe_estimate;

/* A row that has passed. */
typedef struct {
  double time_s, prediction_um, correction_um;
} probe_past;

/* What is remembered; all zero before the first row. */
typedef struct {
  int has_begun, has_jumped;                          /* has_jumped: `jumped` is in use */
  int n_pasts, newest;                                /* of the ring `past` */
  double time_s;                                      /* since the first row */
  probe_estimate now[PROBE_BANK], jumped[PROBE_BANK]; /* lag_s ago */
  probe_past past[PROBE_PASTS];
  int verdict;     /* of the last probing, one of PROBE_... */
  double off_um;   /* of the last probing: read minus expected */
  double bound_um; /* by which they may differ */
  double loss;     /* -ln of the density of the reading times sqrt(2 pi) um; of a normal one it is u^2 / 2 + ln d, of which
                      PROBE_REFUSED deviations count at most, so that a chip does not decide among predictors */
  int n_taken, n_refused, n_jumps;
  int n_in_row; /* unlikely ones since the last that was taken */
  int has_read; /* `read_um` is there */
  double read_um, residual_um, step_um; /* the last reading, minus prediction; smallest difference of two in a row, 0: none yet */
  double ln_chance;        /* of so many equal readings in a row */
} probe_state;

/* Whether all settings are in their ranges. Otherwise the residual stays 0, and all probings are refused. */
int probe_is_valid(const probe_process* process);

/* A row: time passes. prediction_um: of the drift. correction_um: in force from the row before until now. dt_s: since the
 * row before; of no account in the first one. It may be called between rows with the last prediction. */
void probe_row(const probe_process* process, probe_state* state, double prediction_um, double correction_um, double dt_s);

/* A probing whose value has come in the last row; what became of it. */
int probe_drift(const probe_process* process, probe_state* state, double drift_um); /* of the axis without correction */
int probe_left(const probe_process* process, probe_state* state, double left_um);   /* of the corrected axis */

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
