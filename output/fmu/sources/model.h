/* What the interface (instance.c) asks of a model, which is machine.c or observer.c. All that a model remembers are numbers
 * in one array, so that its state is copied by copying it; what can be made anew from them is in the scratch, which is made
 * at instantiation. */
#ifndef DRIFTWRIGHT_MODEL_H
#define DRIFTWRIGHT_MODEL_H

#include <stddef.h>

/* The array begins alike in both models. */
enum {
  kTime = 0,             /* s */
  kAmbientSetAt = 1,     /* when the ambient's input was set last */
  kAmbientFromInput = 2, /* 1: the ambient is the input; 0: the scenario's */
  kStartWarmer = 3,      /* K, everywhere, than the scenario's start */
  kInputs = 4 /* the drive, the ambient [degC], its rate [K/s], then readings [degC], then a probing [um] and its strobe */
};

extern const int model_kind_is_observer;

size_t model_n_saved(void);      /* doubles */
size_t model_scratch_size(void); /* bytes */
int model_n_inputs(void);
int model_n_outputs(void);
int model_n_states(void);
int model_n_switches(void);

/* At instantiation, once. Returns 0, or 1 where a decomposition fails. */
int model_prepare(void* scratch);
/* All saved numbers as before the first call. */
void model_reset(double* saved, void* scratch);
/* What the scratch was made from may be something else now. */
void model_touched(void* scratch);
/* Whether an input may have this value: 0, or what is wrong in words. */
const char* model_check_input(int input, double value);
/* Whether the laws of the drive have values where the inputs, each of them checked, are these: 0, or what is wrong in words.
 * `before`: inputs that were found to be right; 0: there are none. */
const char* model_check_drive(const double* inputs, const double* before);
/* Before an input gets another value. Returns as model_check_input(). */
const char* model_before_input(double* saved, int input, double value);
/* The start, from parameters and inputs at the start time. */
void model_start(double* saved, void* scratch);
/* To time + h, inputs held, the ambient going on at its rate. Returns 0, or what is wrong in words; states are then as
 * before. */
const char* model_step(double* saved, void* scratch, double h_s);
/* At an event. Returns 0, or what is wrong in words. */
const char* model_event(double* saved, void* scratch);
/* The next event in time, or infinity. */
double model_next_event_s(const double* saved);

void model_outputs(const double* saved, void* scratch, double* outputs);
/* Of each switch whether it is on, and its temperature over the one at which it switches next: its event indicator [K]. */
void model_switches(const double* saved, double* is_on, double* indicators);
double* model_states(double* saved);
void model_derivatives(const double* saved, void* scratch, double* derivatives);
/* sensitivity += d(outputs) or d(derivatives) of one state or input changing by seed. */
void model_add_sensitivity(const double* saved, void* scratch, int known_is_state, int known, double seed, double* outputs,
                           double* derivatives);

#endif
