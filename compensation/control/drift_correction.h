/* From the readings of a machine to the correction of its drift, row by row, with what keeps a broken sensor from making
 * things worse. This very file is compiled into Driftwright, which judges by it, and into controls. C99; it needs <math.h>
 * alone, allocates nothing, and keeps all that it remembers in structs of the caller, which are all zero before the first
 * row.
 *
 * Three stages, each of which can be called by itself, with the time since the row before (dt_s, of no account in the first
 * row):
 *
 *   drift_repair()           readings -> repaired readings, the trust that they deserve, doubts
 *   drift_formula_value()    repaired readings -> prediction; a prediction from elsewhere may take its place
 *   drift_guarded_um()       prediction, deserved trust -> correction: times trust, clamped, no faster than the slew limit
 *
 * and drift_correction_step(), which calls them in this order. The correction is what is to be taken away from the position:
 * the axis moves by its negative.
 *
 * To give the same bits everywhere it must be compiled to plain double arithmetic: with -ffp-contract=off (no fused
 * multiply-add), without -ffast-math, on a processor that computes in double (no x87). The .c file asks GCC and Clang for
 * the first itself. The
 * only function whose last bit is the C library's own is exp(). */
#ifndef DRIFTWRIGHT_DRIFT_CORRECTION_H
#define DRIFTWRIGHT_DRIFT_CORRECTION_H

#ifdef __cplusplus
extern "C" {
#endif

/* What is known of one input. A rise is a reading minus the first one of the run; bounds of rises hold for rises. */
typedef struct {
  int is_rise;                      /* 1: the reading counts from the first one of the run */
  double low, high;                 /* validity range, unit of the reading; a reading outside counts as its edge */
  double most_jump;                 /* between readings `period_s` apart, unit of the reading; HUGE_VAL: no bound */
  double others_intercept;          /* what the other inputs lead to: others_intercept + sum_j others_coefficient[j] x_j */
  const double* others_coefficient; /* n_inputs numbers, 0 for itself; a null pointer: no other input tells of this one */
  double most_apart;                /* by which reading and others may differ, unit of the reading; > 0 */
  double start_offset; /* first reading of a run minus the mean of those that are watched, unit of the reading */
  double start_weight; /* of what the first reading is above this, per unit of it; 0: it is not watched */
} drift_guard;

typedef struct {
  int n_inputs;
  const drift_guard* guards; /* n_inputs */
  int most_replaced;         /* of the inputs; more in doubt cost all trust */
  double period_s;           /* of the readings that the bounds were learned from; > 0 */
  double stale_s;            /* after so long without a reading an input is doubted; until then its last reading holds */
  double fade_s;             /* time constant with which trust is lost, and won again; > 0 */
  double back_after_s;       /* for so long a sensor must be beyond doubt before it counts again */
  double back_within;        /* share of most_apart within which a doubted reading must be to be on its way back */
  double most_start;         /* of the warmth of work with which a run may start; HUGE_VAL: the start is not watched */
  double start_s;            /* time constant with which the formula forgets how a run started; HUGE_VAL: never */
  double lowest_um, highest_um, most_rate_um_s; /* clamp and slew limit of the correction */
} drift_fail_safe;

/* One term of the formula: coefficient times L[value], lag_s dL/dt = value - L, L = value where lag_s is 0.
 * Over a step h the lag moves by (1 - exp(-h / lag_s)) towards the value at the step's start where the input holds, else
 * towards the mean of the values at both ends. Lags start from 0 where the input holds, else settled at the first value. */
typedef struct {
  int input;      /* index of its reading */
  int is_rise;    /* 1: the reading counts from the first one of the run */
  int holds;      /* 1: the input holds its value until the next row and starts from standstill, as a speed does */
  int is_running; /* 1: the value is 1 while the input is not 0, and else 0 */
  int power;      /* otherwise the value is the input to this power; >= 1 */
  double coefficient, lag_s; /* um per unit of the value; >= 0 */
} drift_term;

typedef struct {
  double intercept_um;
  int n_terms;
  const drift_term* terms; /* n_terms */
} drift_formula;

/* Why an input is in doubt. */
enum { DRIFT_NO_DOUBT = 0, DRIFT_NO_READING = 1, DRIFT_JUMP = 2, DRIFT_APART = 3 };

/* What is remembered of one input; all zero before the first row. */
typedef struct {
  int is_doubted;    /* in this row */
  int doubt;         /* what was found wrong in this row first, one of DRIFT_...; a doubt lasts longer than its cause */
  double doubt_size; /* of a jump, or of the distance from what the others say, unit of the reading */
  int has_start, has_last, is_out, is_untold, has_first;
  double base, start; /* of a rise: first reading of the first row, and what is taken from later ones */
  double used, last, last_s, doubted_until_s;
  double first; /* reading, before a rise is taken */
} drift_input_state;

/* What is remembered of one term; all zero before the first row. */
typedef struct {
  int has_start, has_lag;
  double start, lag, before, since_s;
} drift_term_state;

/* What is remembered of the run; all zero before the first row. */
typedef struct {
  int has_repaired, has_guarded;
  int is_strange;       /* the run started as no training run did */
  double time_s;        /* since the first row */
  double deserved;      /* trust that the readings of this row deserve, 0 to 1 */
  double trust;         /* that the prediction was multiplied by, 0 to 1 */
  double prediction_um; /* in force: the last one that was a number */
  double correction_um; /* in force */
} drift_state;

/* The caller's arrays: what is remembered of inputs and terms, the repaired readings, and room to compute in. */
typedef struct {
  drift_input_state* inputs; /* n_inputs */
  drift_term_state* terms;   /* n_terms */
  double* repaired;          /* n_inputs */
  double* room;              /* n_inputs * (n_inputs + 1) */
} drift_arrays;

/* Readings with what is doubted replaced by what the other inputs lead to.
 *
 * A reading is doubted that is missing for too long, that jumps, or that is too far from what the others say; of several
 * that disagree the one furthest beyond its bound is doubted first, and the rest is looked at anew with its replacement. It
 * stays doubted until nothing has been wrong, and its reading near what the others say, for back_after_s. Those in doubt are
 * replaced all at once by what those beyond doubt lead to. Up to most_replaced of them cost no trust; more, or one that
 * nothing can replace, cost all of it. A rise that has no reading in the first row goes on from its replacement where it
 * begins.
 *
 * Lags of speeds start at standstill. On a machine that has just worked they start wrong. How warm it is, 0 as at the start of
 * the training runs and 1 as in the mean of their rows, is a weighted sum of what the first readings of the inputs (within
 * stale_s) differ from each other. Beyond most_start trust is 0 and comes back while the formula forgets, with start_s.
 *
 * readings: n_inputs, in their units; what is no finite number is missing. repaired: n_inputs; never missing.
 * Returns the trust that the readings deserve, 0 to 1. */
double drift_repair(const drift_fail_safe* safe, drift_state* state, drift_input_state* inputs, double* room,
                    const double* readings, double dt_s, double* repaired);

/* The value of one term without its coefficient; NAN where its reading is missing: its lag then waits, and makes up for
 * it. */
double drift_term_value(const drift_term* term, drift_term_state* state, double reading, double dt_s);

/* intercept_um + sum_k coefficient_k value_k [um]; NAN where an input is missing. */
double drift_formula_value(const drift_formula* formula, drift_term_state* terms, const double* readings, double dt_s);

/* The prediction [um] as it may go to an axis. While the prediction is no number the last one holds, 0 before there was
 * one. */
double drift_guarded_um(const drift_fail_safe* safe, drift_state* state, double deserved, double prediction_um, double dt_s);

/* All three in a row; the correction [um]. */
double drift_correction_step(const drift_fail_safe* safe, const drift_formula* formula, drift_state* state,
                             const drift_arrays* arrays, const double* readings, double dt_s);

#ifdef __cplusplus
}
#endif

#endif
