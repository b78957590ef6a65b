#define _GNU_SOURCE
#include <dlfcn.h>
#include <malloc.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fmi2Functions.h"
#include "importer.h"

/* What of the interface is called, by the types of the standard. */
#define FOR_EACH_FUNCTION(X)                                                                                                \
  X(GetTypesPlatform)                                                                                                       \
  X(GetVersion)                                                                                                             \
  X(SetDebugLogging)                                                                                                        \
  X(Instantiate) X(FreeInstance) X(SetupExperiment) X(EnterInitializationMode) X(ExitInitializationMode) X(Terminate)       \
      X(Reset) X(GetReal) X(SetReal) X(GetInteger) X(SetInteger) X(GetBoolean) X(SetBoolean) X(GetString) X(SetString)      \
          X(GetFMUstate) X(SetFMUstate) X(FreeFMUstate) X(SerializedFMUstateSize) X(SerializeFMUstate)                      \
              X(DeSerializeFMUstate) X(GetDirectionalDerivative) X(EnterEventMode) X(NewDiscreteStates)                     \
                  X(EnterContinuousTimeMode) X(CompletedIntegratorStep) X(SetTime) X(SetContinuousStates) X(GetDerivatives) \
                      X(GetEventIndicators) X(GetContinuousStates) X(GetNominalsOfContinuousStates)                         \
                          X(SetRealInputDerivatives) X(GetRealOutputDerivatives) X(DoStep) X(CancelStep) X(GetStatus)       \
                              X(GetRealStatus) X(GetIntegerStatus) X(GetBooleanStatus) X(GetStringStatus)

typedef struct {
  importer_run* run;
  fmi2Component c;
  char message[256];
#define MEMBER(name) fmi2##name##TYPE* name;
  FOR_EACH_FUNCTION(MEMBER)
} unit;

static void logger(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status, fmi2String category,
                   fmi2String message, ...) {
  unit* const u = environment;
  va_list arguments;
  (void)name;
  (void)status;
  (void)category;
  va_start(arguments, message);
  vsnprintf(u->message, sizeof u->message, message, arguments);
  va_end(arguments);
}

static int fail(unit* u, const char* what) {
  snprintf(u->run->wrong, sizeof u->run->wrong, "%s: %s", what, u->message);
  return 1;
}
#define CALL(name, ...) \
  if (u->name(u->c, ##__VA_ARGS__) != fmi2OK) return fail(u, "fmi2" #name)

static int set_inputs(unit* u, size_t row) {
  const importer_run* const run = u->run;
  CALL(SetReal, run->inputs, run->n_inputs, run->input_rows + row * run->n_inputs);
  if (run->is_co_simulation && run->ambient_input >= 0 && row + 1 < run->n_rows) {
    const size_t i = (size_t)run->ambient_input;
    const fmi2Integer order = 1;
    const double rate = (run->input_rows[(row + 1) * run->n_inputs + i] - run->input_rows[row * run->n_inputs + i]) /
                        (run->time_s[row + 1] - run->time_s[row]);
    CALL(SetRealInputDerivatives, &run->inputs[i], 1, &order, &rate);
  }
  return 0;
}

static int tell(unit* u, size_t row) {
  CALL(GetReal, u->run->outputs, u->run->n_outputs, u->run->output_rows + row * u->run->n_outputs);
  return 0;
}

static int steps(unit* u, double from_s, double to_s) {
  const int n = (int)ceil((to_s - from_s) / u->run->step_s - 1e-9);
  int k;
  for (k = 0; k < n; ++k) {
    const double t_s = k == 0 ? from_s : from_s + k * u->run->step_s,
                 end_s = k + 1 == n ? to_s : from_s + (k + 1) * u->run->step_s;
    CALL(DoStep, t_s, end_s - t_s, fmi2True);
  }
  return 0;
}

/* The state is kept and written out; the unit goes elsewhere; the state that was written is read and set. */
static int rewind_state(unit* u, double t_s) {
  fmi2FMUstate state = NULL, other = NULL;
  size_t size = 0;
  char* bytes;
  CALL(GetFMUstate, &state);
  CALL(SerializedFMUstateSize, state, &size);
  bytes = malloc(size);
  CALL(SerializeFMUstate, state, bytes, size);
  CALL(DoStep, t_s, 3600.0, fmi2False);
  CALL(DeSerializeFMUstate, bytes, size, &other);
  CALL(SetFMUstate, other);
  CALL(FreeFMUstate, &state);
  CALL(FreeFMUstate, &other);
  free(bytes);
  return 0;
}

static int co_simulate(unit* u) {
  const importer_run* const run = u->run;
  size_t row;
  if (!run->tells_behind_step && tell(u, 0)) return 1;
  for (row = 0; row + 1 < run->n_rows; ++row) {
    if (row > 0 && row == run->rewind_at_row && rewind_state(u, run->time_s[row])) return 1;
    if (set_inputs(u, row) || steps(u, run->time_s[row], run->time_s[row + 1])) return 1;
    if (tell(u, run->tells_behind_step ? row : row + 1)) return 1;
  }
  return 0;
}

static int slopes(void* of, double t_s, const double* z, double* dz) {
  unit* const u = of;
  CALL(SetTime, t_s);
  CALL(SetContinuousStates, z, u->run->n_states);
  CALL(GetDerivatives, dz, u->run->n_states);
  return 0;
}
static int column(void* of, size_t state, double* derivatives) {
  unit* const u = of;
  const double one = 1.0;
  CALL(GetDirectionalDerivative, u->run->derivatives, u->run->n_states, &u->run->states[state], 1, &one, derivatives);
  return 0;
}

/* Directional derivatives of slopes and outputs against differences, along states and along all inputs. */
static int check_jacobian(unit* u) {
  importer_run* const run = u->run;
  const size_t n = run->n_states, n_all = n + run->n_outputs;
  double* const z = malloc((n + 4 * n_all) * sizeof *z);
  double *const low = z + n, *const high = low + n_all, *const told = high + n_all;
  unsigned* const unknowns = malloc(n_all * sizeof *unknowns);
  double most = 0.0, gap = 0.0;
  size_t k, i;
  memcpy(unknowns, run->derivatives, n * sizeof *unknowns);
  memcpy(unknowns + n, run->outputs, run->n_outputs * sizeof *unknowns);
  CALL(GetContinuousStates, z, n);
  for (k = 0; k < n + run->n_inputs; ++k) {
    const int is_state = k < n;
    const unsigned known = is_state ? run->states[k] : run->inputs[k - n];
    const double one = 1.0;
    double value = 0.0, half = 1.0;
    CALL(GetDirectionalDerivative, unknowns, n_all, &known, 1, &one, told);
    if (is_state) {
      value = z[k];
      z[k] = value - half;
      CALL(SetContinuousStates, z, n);
    } else {
      CALL(GetReal, &known, 1, &value);
      half = 1e-4 * fabs(value);
      value -= half;
      CALL(SetReal, &known, 1, &value);
      value += half;
    }
    CALL(GetReal, unknowns, n_all, low);
    if (is_state) {
      z[k] = value + half;
      CALL(SetContinuousStates, z, n);
    } else {
      value += half;
      CALL(SetReal, &known, 1, &value);
      value -= half;
    }
    CALL(GetReal, unknowns, n_all, high);
    if (is_state) {
      z[k] = value;
      CALL(SetContinuousStates, z, n);
    } else {
      CALL(SetReal, &known, 1, &value);
    }
    most = gap = 0.0;
    for (i = 0; i < n_all; ++i) {
      if (half == 0.0) continue;
      most = fmax(most, fabs(told[i]));
      gap = fmax(gap, fabs(told[i] - (high[i] - low[i]) / (2.0 * half)));
    }
    if (most > 0.0) run->jacobian_gap = fmax(run->jacobian_gap, gap / most);
    if (most == 0.0 && gap > 0.0) run->jacobian_gap = HUGE_VAL;
  }
  free(z);
  free(unknowns);
  return 0;
}

static int handle_events(unit* u, fmi2EventInfo* info) {
  do {
    CALL(NewDiscreteStates, info);
  } while (info->newDiscreteStatesNeeded && !info->terminateSimulation);
  CALL(EnterContinuousTimeMode);
  ++u->run->n_events;
  return 0;
}

static int exchange(unit* u) {
  importer_run* const run = u->run;
  const integrand f = {u, slopes, column};
  fmi2EventInfo info;
  double *const z = malloc((run->n_states + 1) * sizeof *z), *const nominal = malloc((run->n_states + 1) * sizeof *nominal);
  size_t row, i;
  memset(&info, 0, sizeof info);
  for (row = 0; row < run->n_rows; ++row) {
    double t_s = run->time_s[row];
    if (row > 0) CALL(EnterEventMode);
    if (set_inputs(u, row) || handle_events(u, &info)) return 1;
    CALL(GetNominalsOfContinuousStates, nominal, run->n_states);
    for (i = 0; i < run->n_states; ++i) {
      if (!(nominal[i] > 0.0)) return fail(u, "a nominal is not above 0");
    }
    if (tell(u, row)) return 1;
    if (row == 2 && run->n_states > 0 && check_jacobian(u)) return 1;
    while (row + 1 < run->n_rows && t_s < run->time_s[row + 1]) {
      const int is_event = info.nextEventTimeDefined && info.nextEventTime < run->time_s[row + 1];
      const double until_s = is_event ? info.nextEventTime : run->time_s[row + 1];
      fmi2Boolean enter = fmi2False, terminate = fmi2False;
      CALL(GetContinuousStates, z, run->n_states);
      if (run->n_states > 0 && integrate_radau(&f, run->n_states, t_s, until_s, z)) return fail(u, "the integrator");
      t_s = until_s;
      CALL(SetTime, t_s);
      CALL(SetContinuousStates, z, run->n_states);
      CALL(CompletedIntegratorStep, fmi2True, &enter, &terminate);
      if (enter || terminate) return fail(u, "an event that nothing announced");
      if (is_event) {
        CALL(EnterEventMode);
        if (handle_events(u, &info)) return 1;
      }
    }
  }
  free(z);
  free(nominal);
  return 0;
}

static int go(unit* u, void* library) {
  importer_run* const run = u->run;
  const fmi2CallbackFunctions functions = {logger, calloc, free, NULL, u};
  double began_s;
  size_t before;
  int failed;
#define LOAD(name)                                    \
  *(void**)(&u->name) = dlsym(library, "fmi2" #name); \
  if (!u->name) return fail(u, "the binary lacks fmi2" #name);
  FOR_EACH_FUNCTION(LOAD)
  if (strcmp(u->GetVersion(), "2.0") != 0 || strcmp(u->GetTypesPlatform(), "default") != 0)
    return fail(u, "version or platform");
  if (u->Instantiate("wrong", fmi2CoSimulation, "{0}", NULL, &functions, fmi2False, fmi2True))
    return fail(u, "a wrong GUID was taken");
  u->c = u->Instantiate("tested", run->is_co_simulation ? fmi2CoSimulation : fmi2ModelExchange, run->guid, NULL, &functions,
                        fmi2False, fmi2True);
  if (!u->c) return fail(u, "fmi2Instantiate");
  if (u->DoStep(u->c, 0.0, 1.0, fmi2True) != fmi2Error) return fail(u, "a step before initialization was taken");
  CALL(Reset);
  CALL(SetupExperiment, fmi2False, 0.0, run->time_s[0], fmi2False, 0.0);
  if (run->ambient_from_input >= 0) CALL(SetBoolean, &run->ambient_from_input_reference, 1, &run->ambient_from_input);
  CALL(EnterInitializationMode);
  if (set_inputs(u, 0)) return 1;
  CALL(ExitInitializationMode);
  before = mallinfo2().uordblks;
  began_s = monotonic_s();
  failed = run->is_co_simulation ? co_simulate(u) : exchange(u);
  run->seconds = monotonic_s() - began_s;
  run->allocated = (long long)mallinfo2().uordblks - (long long)before;
  if (failed) return 1;
  CALL(Terminate);
  u->FreeInstance(u->c);
  return 0;
}

int import_fmi2(importer_run* run) {
  unit u;
  void* const library = dlopen(run->library, RTLD_NOW | RTLD_LOCAL);
  int failed;
  memset(&u, 0, sizeof u);
  u.run = run;
  run->wrong[0] = '\0';
  run->n_events = 0;
  run->jacobian_gap = 0.0;
  if (!library) {
    snprintf(run->wrong, sizeof run->wrong, "%s", dlerror());
    return 1;
  }
  failed = go(&u, library);
  dlclose(library);
  return failed;
}
