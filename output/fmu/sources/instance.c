#include "instance.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model.h"
#include "model_data.h"

/* What stands before the numbers of a kept state. */
typedef struct {
  unsigned long long mark; /* of the unit */
  int mode, is_co_simulation;
} state_head;

static unsigned long long mark_of_unit(void) { /* FNV-1a of the guid */
  unsigned long long mark = 14695981039346656037ull;
  const char* c;
  for (c = model_guid; *c; ++c) mark = (mark ^ (unsigned char)*c) * 1099511628211ull;
  return mark;
}

int instance_tell(instance* in, int status, const char* message) {
  if (status >= kError) in->mode = kFailed;
  if (status != kOk && in->tell) in->tell(in, status, message);
  return status;
}

int instance_allows(instance* in, int modes, const char* call) {
  char message[160];
  if (!in) return 0;
  if (in->mode & modes) return 1;
  sprintf(message, "%.60s is not allowed in this mode (%s)", call,
          in->mode == kInstantiated     ? "instantiated"
          : in->mode == kInitialization ? "initialization"
          : in->mode == kEvent          ? "event"
          : in->mode == kContinuousTime ? "continuous time"
          : in->mode == kStep           ? "step"
          : in->mode == kTerminated     ? "terminated"
                                        : "error");
  instance_tell(in, kError, message);
  return 0;
}

instance* instance_new(const char* name, const char* guid, int is_co_simulation, int is_logging, void* environment,
                       void (*tell)(const instance*, int, const char*), void (*callback)(void),
                       void* (*allocate)(size_t, size_t), void (*release)(void*)) {
  const size_t n_saved = model_n_saved(), n_out = (size_t)model_n_outputs(), n_states = (size_t)model_n_states(),
               n_switches = (size_t)model_n_switches(), n_doubles = n_saved + 2 * n_out + 2 * n_states + 2 * n_switches;
  /* One block: the instance, the model's scratch, all numbers. */
  const size_t head = (sizeof(instance) + 15) / 16 * 16, scratch = (model_scratch_size() + 15) / 16 * 16;
  instance* in = allocate(1, head + scratch + n_doubles * sizeof(double));
  double* numbers;
  if (!in) return 0;
  in->mode = kInstantiated;
  in->is_co_simulation = is_co_simulation;
  in->is_logging = is_logging;
  in->environment = environment;
  in->tell = tell;
  in->callback = callback;
  in->release = release;
  strncpy(in->name, name ? name : "", sizeof in->name - 1);
  in->name[sizeof in->name - 1] = '\0';
  in->scratch = (char*)in + head;
  numbers = (double*)(void*)((char*)in + head + scratch);
  in->saved = numbers;
  in->outputs = numbers + n_saved;
  in->output_seeds = in->outputs + n_out;
  in->derivatives = in->output_seeds + n_out;
  in->derivative_seeds = in->derivatives + n_states;
  in->is_on = in->derivative_seeds + n_states;
  in->indicators = in->is_on + n_switches;
  if (!*model_guid) {
    instance_tell(in, kError, "the numbers at the end of the unit's binary cannot be read; the file is not complete");
    release(in);
    return 0;
  }
  if (!guid || strcmp(guid, model_guid) != 0) {
    instance_tell(in, kError, "the GUID or instantiation token is not the one of this unit's modelDescription.xml");
    release(in);
    return 0;
  }
  if (model_prepare(in->scratch) != 0) {
    instance_tell(in, kError, "the decomposition of a conduction matrix did not converge");
    release(in);
    return 0;
  }
  model_reset(in->saved, in->scratch);
  return in;
}

void instance_free(instance* in) {
  if (in) in->release(in);
}

static void touched(instance* in) {
  in->has_outputs = in->has_derivatives = 0;
}

static void start_anew(instance* in) {
  if (in->mode == kInitialization) model_start(in->saved, in->scratch);
}

int instance_enter_initialization(instance* in, double start_s) {
  in->mode = kInitialization;
  in->saved[kTime] = start_s;
  touched(in);
  start_anew(in);
  return kOk;
}

int instance_exit_initialization(instance* in) {
  start_anew(in);
  touched(in);
  in->mode = in->is_co_simulation ? kStep : kEvent;
  return kOk;
}

int instance_reset(instance* in) {
  model_reset(in->saved, in->scratch);
  touched(in);
  in->mode = kInstantiated;
  return kOk;
}

static const double* outputs_of(instance* in) {
  if (!in->has_outputs) model_outputs(in->saved, in->scratch, in->outputs);
  in->has_outputs = 1;
  return in->outputs;
}

static const double* derivatives_of(instance* in) {
  if (!in->has_derivatives) model_derivatives(in->saved, in->scratch, in->derivatives);
  in->has_derivatives = 1;
  return in->derivatives;
}

static const instance* switches_of(instance* in) {
  model_switches(in->saved, in->is_on, in->indicators);
  return in;
}

/* The index of a reference in a group of n, or -1. */
static int index_in(unsigned reference, unsigned first, int n) {
  return reference >= first && reference - first < (unsigned)n ? (int)(reference - first) : -1;
}

int instance_get(instance* in, const unsigned* references, size_t n, double* values) {
  size_t k;
  for (k = 0; k < n; ++k) {
    const unsigned r = references[k];
    int i;
    if (r == kTimeReference)
      values[k] = in->saved[kTime];
    else if (r == kStartWarmerReference)
      values[k] = in->saved[kStartWarmer];
    else if ((i = index_in(r, kInputReference, model_n_inputs())) >= 0)
      values[k] = in->saved[kInputs + i];
    else if ((i = index_in(r, kOutputReference, model_n_outputs())) >= 0)
      values[k] = outputs_of(in)[i];
    else if ((i = index_in(r, kStateReference, model_n_states())) >= 0)
      values[k] = model_states(in->saved)[i];
    else if ((i = index_in(r, kDerivativeReference, model_n_states())) >= 0)
      values[k] = derivatives_of(in)[i];
    else if ((i = index_in(r, kIsOnReference, model_n_switches())) >= 0)
      values[k] = switches_of(in)->is_on[i];
    else if ((i = index_in(r, kIndicatorReference, model_n_switches())) >= 0)
      values[k] = switches_of(in)->indicators[i];
    else
      return instance_tell(in, kError, "there is no such real variable");
  }
  return kOk;
}

int instance_set(instance* in, const unsigned* references, size_t n, const double* values) {
  size_t k;
  for (k = 0; k < n; ++k) {
    const unsigned r = references[k];
    const int input = index_in(r, kInputReference, model_n_inputs());
    if (r == kStartWarmerReference) {
      if (!(in->mode & (kInstantiated | kInitialization)))
        return instance_tell(in, kError, "start_warmer may be set only before the start");
      if (!(fabs(values[k]) < 1e3)) return instance_tell(in, kError, "start_warmer is no temperature difference");
      in->saved[kStartWarmer] = values[k];
    } else if (input >= 0) {
      const char* const wrong = model_before_input(in->saved, input, values[k]);
      if (wrong) return instance_tell(in, kError, wrong);
      in->saved[kInputs + input] = values[k];
    } else if (index_in(r, kStateReference, model_n_states()) >= 0 && in->mode == kContinuousTime) {
      model_states(in->saved)[r - kStateReference] = values[k];
    } else {
      return instance_tell(in, kError, "there is no such real variable that may be set now");
    }
  }
  model_touched(in->scratch);
  touched(in);
  start_anew(in);
  return kOk;
}

int instance_set_input_rates(instance* in, const unsigned* references, size_t n, const int* orders, const double* values) {
  const unsigned ambient = kInputReference + (unsigned)thermal.n_drive;
  size_t k;
  for (k = 0; k < n; ++k) {
    const unsigned rate = ambient + 1;
    if (orders[k] != 1) return instance_tell(in, kError, "inputs are interpolated to first order at most");
    if (references[k] == ambient) {
      const int status = instance_set(in, &rate, 1, &values[k]);
      if (status != kOk) return status;
    } else if (values[k] != 0.0) {
      return instance_tell(in, kError, "only the ambient temperature has a rate; the drive is constant over a step");
    }
  }
  return kOk;
}

int instance_get_flag(instance* in, unsigned reference, int* value) {
  if (reference != kAmbientFromInputReference || model_kind_is_observer)
    return instance_tell(in, kError, "there is no such Boolean variable");
  *value = in->saved[kAmbientFromInput] != 0.0;
  return kOk;
}

int instance_set_flag(instance* in, unsigned reference, int value) {
  if (reference != kAmbientFromInputReference || model_kind_is_observer)
    return instance_tell(in, kError, "there is no such Boolean variable");
  if (!(in->mode & (kInstantiated | kInitialization)))
    return instance_tell(in, kError, "ambient_from_input may be set only before the start");
  in->saved[kAmbientFromInput] = value ? 1.0 : 0.0;
  touched(in);
  start_anew(in);
  return kOk;
}

int instance_set_time(instance* in, double time_s) {
  if (!(fabs(time_s) < 1e300)) return instance_tell(in, kError, "the time is no finite number");
  in->saved[kTime] = time_s;
  touched(in);
  return kOk;
}

static int is_n_states(instance* in, size_t n) {
  if (n == (size_t)model_n_states()) return 1;
  instance_tell(in, kError, "the number of continuous states is wrong");
  return 0;
}

int instance_set_states(instance* in, const double* states, size_t n) {
  if (!is_n_states(in, n)) return kError;
  if (n > 0) memcpy(model_states(in->saved), states, n * sizeof *states);
  touched(in);
  return kOk;
}

int instance_get_states(instance* in, double* states, size_t n) {
  if (!is_n_states(in, n)) return kError;
  if (n > 0) memcpy(states, model_states(in->saved), n * sizeof *states);
  return kOk;
}

int instance_get_derivatives(instance* in, double* derivatives, size_t n) {
  if (!is_n_states(in, n)) return kError;
  if (n > 0) memcpy(derivatives, derivatives_of(in), n * sizeof *derivatives);
  return kOk;
}

int instance_get_nominals(instance* in, double* nominals, size_t n) {
  if (!is_n_states(in, n)) return kError;
  if (n > 0) memcpy(nominals, thermal.nominal, n * sizeof *nominals);
  return kOk;
}

int instance_get_indicators(instance* in, double* indicators, size_t n) {
  if (n != (size_t)model_n_switches()) return instance_tell(in, kError, "the number of event indicators is wrong");
  if (n > 0) memcpy(indicators, switches_of(in)->indicators, n * sizeof *indicators);
  return kOk;
}

int instance_event(instance* in, int* has_next, double* next_s) {
  const char* const wrong = model_event(in->saved, in->scratch);
  touched(in);
  if (wrong) return instance_tell(in, kError, wrong);
  *next_s = model_next_event_s(in->saved);
  *has_next = *next_s < HUGE_VAL;
  return kOk;
}

int instance_step(instance* in, double from_s, double h_s) {
  const char* wrong;
  if (!(h_s > 0.0) || !(h_s < 1e300)) return instance_tell(in, kError, "the step must be longer than 0 and finite");
  if (!(fabs(from_s - in->saved[kTime]) <= 1e-9 * (fabs(from_s) + h_s)))
    return instance_tell(in, kError, "the step does not begin where the last one ended");
  wrong = model_step(in->saved, in->scratch, h_s);
  touched(in);
  if (wrong) return instance_tell(in, kError, wrong);
  in->saved[kTime] = from_s + h_s;
  return kOk;
}

int instance_sensitivity(instance* in, const unsigned* unknowns, size_t n_unknowns, const unsigned* knowns, size_t n_knowns,
                         const double* seeds, double* sensitivities) {
  size_t k;
  if (model_kind_is_observer)
    return instance_tell(in, kError, "an observer jumps from sample to sample and has no derivatives");
  memset(in->output_seeds, 0, (size_t)model_n_outputs() * sizeof *in->output_seeds);
  if (model_n_states() > 0) memset(in->derivative_seeds, 0, (size_t)model_n_states() * sizeof *in->derivative_seeds);
  for (k = 0; k < n_knowns; ++k) {
    const int state = index_in(knowns[k], kStateReference, model_n_states()),
              input = index_in(knowns[k], kInputReference, model_n_inputs());
    if (state < 0 && input < 0) return instance_tell(in, kError, "derivatives exist only along states and inputs");
    if (seeds[k] == 0.0) continue;
    model_add_sensitivity(in->saved, in->scratch, state >= 0, state >= 0 ? state : input, seeds[k], in->output_seeds,
                          in->derivative_seeds);
  }
  for (k = 0; k < n_unknowns; ++k) {
    const int derivative = index_in(unknowns[k], kDerivativeReference, model_n_states()),
              output = index_in(unknowns[k], kOutputReference, model_n_outputs());
    if (derivative < 0 && output < 0)
      return instance_tell(in, kError, "derivatives exist only of outputs and of states' derivatives");
    sensitivities[k] = output >= 0 ? in->output_seeds[output] : in->derivative_seeds[derivative];
  }
  return kOk;
}

size_t instance_state_bytes(void) {
  return sizeof(state_head) + model_n_saved() * sizeof(double);
}

int instance_keep_state(instance* in, void** kept) {
  state_head head;
  if (!*kept) *kept = malloc(instance_state_bytes()); /* the one place: the importer asks for memory here */
  if (!*kept) return instance_tell(in, kError, "there is no memory for a copy of the state");
  memset(&head, 0, sizeof head);
  head.mark = mark_of_unit();
  head.mode = (int)in->mode;
  head.is_co_simulation = in->is_co_simulation;
  memcpy(*kept, &head, sizeof head);
  memcpy((char*)*kept + sizeof head, in->saved, model_n_saved() * sizeof(double));
  return kOk;
}

int instance_restore_state(instance* in, const void* kept) {
  state_head head;
  if (!kept) return instance_tell(in, kError, "there is no such state");
  memcpy(&head, kept, sizeof head);
  if (head.mark != mark_of_unit()) return instance_tell(in, kError, "the state is not one of this unit");
  if (head.is_co_simulation != in->is_co_simulation)
    return instance_tell(in, kError, "the state is one of the other kind of interface");
  memcpy(in->saved, (const char*)kept + sizeof head, model_n_saved() * sizeof(double));
  in->mode = (instance_mode)head.mode;
  model_touched(in->scratch);
  touched(in);
  return kOk;
}

int instance_free_state(instance* in, void** kept) {
  (void)in;
  if (!kept) return kOk;
  free(*kept);
  *kept = 0;
  return kOk;
}

int instance_write_state(instance* in, const void* kept, void* bytes, size_t n_bytes) {
  if (!kept || n_bytes < instance_state_bytes())
    return instance_tell(in, kError, "the state does not fit into so many bytes");
  memcpy(bytes, kept, instance_state_bytes());
  return kOk;
}

int instance_read_state(instance* in, const void* bytes, size_t n_bytes, void** kept) {
  state_head head;
  if (n_bytes < instance_state_bytes()) return instance_tell(in, kError, "so few bytes are no state of this unit");
  memcpy(&head, bytes, sizeof head);
  if (head.mark != mark_of_unit()) return instance_tell(in, kError, "the bytes are no state of this unit");
  if (!*kept) *kept = malloc(instance_state_bytes());
  if (!*kept) return instance_tell(in, kError, "there is no memory for a copy of the state");
  memcpy(*kept, bytes, instance_state_bytes());
  return kOk;
}
