/* An importer of functional mock-up units for tests, in C against the headers of the standard: it loads a binary and calls
 * it in the order that the standard prescribes, in co-simulation or, with an integrator of its own, in model exchange. */
#ifndef DRIFTWRIGHT_TESTS_FMU_IMPORTER_H
#define DRIFTWRIGHT_TESTS_FMU_IMPORTER_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
  const char* library; /* path of the binary */
  const char* guid;
  int is_co_simulation;
  /* Inputs, held from each row on. */
  size_t n_inputs, n_rows;
  const unsigned* inputs; /* value references */
  const double* time_s;
  const double* input_rows; /* n_rows x n_inputs */
  int ambient_from_input;   /* -1: the unit has no such parameter */
  unsigned ambient_from_input_reference;
  /* Of co-simulation: steps no longer than this, and of its first ambient_rate_input, if one is not -1, the rate by that of
   * the rows. */
  double step_s;
  int ambient_input;
  size_t rewind_at_row;  /* there the state is kept, written, read and set again after a step elsewhere; 0: nowhere */
  int tells_behind_step; /* outputs of a row are those behind the step from it on: of a unit that samples */
  /* Of model exchange. */
  size_t n_states, n_indicators;
  const unsigned *states, *derivatives;
  /* What comes out, n_rows x n_outputs. */
  size_t n_outputs;
  const unsigned* outputs;
  double* output_rows;
  double jacobian_gap; /* of directional derivatives and differences, over the largest entry */
  long long allocated; /* bytes that the heap grew by from the start to the end of the run */
  double seconds;      /* of the run without instantiation */
  int n_events;
  int n_switches;  /* of these events, those that an event indicator announced */
  char wrong[512]; /* what went wrong, in words; "" when nothing did */
} importer_run;

/* Return 0, or 1 with words in `wrong`. */
int import_fmi2(importer_run* run);
int import_fmi3(importer_run* run);

/* Radau IIA of order 5, for both; the Jacobian is that of the beginning. */
typedef struct {
  void* of;
  int (*slopes)(void* of, double t_s, const double* z, double* dz); /* not 0: failed */
  int (*column)(void* of, size_t state, double* derivatives);       /* of the Jacobian, by directional derivatives */
} integrand;
/* Steps begin short and grow, unless nothing has jumped at the beginning (is_smooth). Returns 0, or 1. */
int integrate_radau(const integrand* f, size_t n, double from_s, double to_s, int is_smooth, double* z);
double monotonic_s(void);

#ifdef __cplusplus
}
#endif
#endif
