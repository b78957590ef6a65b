/* The extended Kalman filter of a state observer: the equations alone. Which readings it may use is judged in
 * state_observer.h. This very file is compiled into Driftwright, which judges by it, and into functional mock-up units. C99;
 * it needs <math.h> alone and allocates nothing. Matrices are by rows.
 *
 *   dz/dt = -K(u) z + sum_s (1 + w_s) P_s(u) b_s + sum_e c_e(u) (ambient g_e + o_e)
 *           + sum_e v_e c_e(u) (ambient g_e + o_e - G_e z),      K(u) = K0 + sum_e c_e(u) G_e,   M = 1
 *
 * The filter has a normal distribution over, in this order, the state z, the factors w and v (minus 1), the factor on the
 * drift (minus 1) and the offset of the indicator's zero [m]. K(u) enters by its exponential, exact for any step; factors on
 * exchanges act as heat over a step. Source: Kalman, J. Basic Eng. 82 (1960) 35; Jazwinski, Stochastic Processes and
 * Filtering Theory (1970), ch. 8. */
#ifndef DRIFTWRIGHT_OBSERVER_FILTER_H
#define DRIFTWRIGHT_OBSERVER_FILTER_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The reduced machine, M = 1. */
typedef struct {
  int n, n_sources, n_exchanges;
  const double* conduction; /* K0, n x n, symmetric */
  const double* loads;      /* b_s, n_sources rows */
  const double* exchanges;  /* G_e, n_exchanges matrices, symmetric */
  const double* to_ambient; /* g_e, n_exchanges rows; 0 for one that does not reach the ambient */
  const double* offsets;    /* o_e, n_exchanges rows */
  const double* ones;       /* z of 1 K everywhere */
} observer_machine;

/* Assumed uncertainties, as standard deviations; ObserverSettings (compensation/predictors/observer.hpp) says what each is.
 */
typedef struct {
  double reading_K, model_K, drift_um, model_um, model_holds_s, factor, factor_walk, longest_step_s, period_s, most_apart;
} observer_settings;

/* A filter: borrowed pointers to its machine, to what it remembers and to its room for computing. Copies are the same
 * filter. */
typedef struct {
  const observer_machine* machine;
  const observer_settings* settings;
  const double* factor_mean;       /* learned of the sources, the exchanges and the drift, minus 1 */
  const double* factor_covariance; /* the same; square */
  int with_drift;                  /* the drift is measured: factors walk at random and do not return to what was learned */
  int n_all;                       /* variables */

  double *mean, *covariance; /* one after the other */
  double* start_state;       /* z at the start of the run */
  double *least_W, *most_W;  /* of each source in this run */

  int n_steps, n_modes; /* kept in the room */
  double *steps, *modes, *next, *power_W, *coefficient, *slopes, *transition, *top, *load, *state, *vector, *matrix, *packed,
      *unseen, *unseen_before;
} observer_filter;

/* Factors on heat flows; variables of the filter. */
int observer_n_factors(const observer_machine* machine);
int observer_n_all(const observer_machine* machine);
/* How many doubles the filter remembers, and how many it needs as room. @param n_steps, n_modes  of the steps of different
 * length or coefficients, and of the decompositions for different coefficients, that the room keeps; >= 1 */
size_t observer_filter_n_remembered(const observer_machine* machine);
size_t observer_filter_n_room(const observer_machine* machine, int n_steps, int n_modes);
/* Sets the pointers of a filter (of: machine, settings, factors, with_drift are set by the caller). */
void observer_filter_place(observer_filter* filter, double* remembered, double* room, int n_steps, int n_modes);
/* The room keeps no step. */
void observer_filter_clear_room(const observer_filter* filter);

/* Before a run: the factors as learned, the state with an uncertainty of 0.1 K everywhere; each source has been at rest_W.
 */
void observer_filter_start(const observer_filter* filter, const double* state, const double* rest_W);
/* The state at the start of the run. */
void observer_filter_begin(const observer_filter* filter, const double* state);
/* Advances by h_s with constant drive, whose powers and coefficients the caller has put into filter->power_W and
 * filter->coefficient.
 * @param is_gap  the drive is unknown: filter->unseen goes on. Returns 0, or 1 where the decomposition of K fails */
int observer_filter_step(const observer_filter* filter, double ambient_K, double h_s, int is_gap);
/* The drive of the steps between these two calls is unknown: at the end the state is less certain by all that each source
 * may have done, between its extremes of rest and of this run. */
void observer_filter_begin_gap(const observer_filter* filter);
void observer_filter_end_gap(const observer_filter* filter);

/* h'P h of a gradient over the first `length` variables: the variance of what is expected. Leaves P h in filter->vector for
 * a correction with this gradient. */
double observer_filter_variance(const observer_filter* filter, const double* gradient, int length);
/* A reading at this distance from the expected one, with the gradient of the last observer_filter_variance(), whose result
 * is given. */
void observer_filter_correct(const observer_filter* filter, double expected_variance, double innovation, double variance);

/* Drift since the start of the run [m], without the ambient's share and the factor on it. @param output  row of n numbers */
double observer_filter_unscaled_drift_m(const observer_filter* filter, const double* output);
/* The gradient of the drift over all variables, n_all numbers. */
void observer_filter_drift_gradient(const observer_filter* filter, const double* output, double* gradient);

#ifdef __cplusplus
}
#endif

#endif
