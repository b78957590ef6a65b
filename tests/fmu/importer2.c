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
#define FOR_EACH_FUNCTION(X)                                                                                               \
  X(GetTypesPlatform)                                                                                                      \
  X(GetVersion)                                                                                                            \
  X(SetDebugLogging)                                                                                                       \
  X(Instantiate)                                                                                                           \
  X(FreeInstance) X(SetupExperiment) X(EnterInitializationMode) X(ExitInitializationMode) X(Terminate) X(Reset) X(GetReal) \
      X(SetReal) X(GetInteger) X(SetInteger) X(GetBoolean) X(SetBoolean) X(GetString) X(SetString) X(GetFMUstate)          \
          X(SetFMUstate) X(FreeFMUstate) X(SerializedFMUstateSize) X(SerializeFMUstate) X(DeSerializeFMUstate)             \
              X(GetDirectionalDerivative) X(EnterEventMode) X(NewDiscreteStates) X(EnterContinuousTimeMode)                \
                  X(CompletedIntegratorStep) X(SetTime) X(SetContinuousStates) X(GetDerivatives) X(GetEventIndicators)     \
                      X(GetContinuousStates) X(GetNominalsOfContinuousStates) X(SetRealInputDerivatives)                   \
                          X(GetRealOutputDerivatives) X(DoStep) X(CancelStep) X(GetStatus) X(GetRealStatus)                \
                              X(GetIntegerStatus) X(GetBooleanStatus) X(GetStringStatus)

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
  (void)name, (void)status, (void)category;
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

static int get(unit* u, const unsigned* variables, size_t n, double* values) {
  CALL(GetReal, variables, n, values);
  return 0;
}
static int set(unit* u, const unsigned* variables, size_t n, const double* values) {
  CALL(SetReal, variables, n, values);
  return 0;
}
static int set_rate(unit* u, unsigned input, double rate) {
  const fmi2Integer order = 1;
  CALL(SetRealInputDerivatives, &input, 1, &order, &rate);
  return 0;
}
static int step(unit* u, double t_s, double end_s) {
  CALL(DoStep, t_s, end_s - t_s, fmi2True);
  return 0;
}
static int sensitivity(unit* u, const unsigned* unknowns, size_t n, unsigned known, double* values) {
  const double one = 1.0;
  CALL(GetDirectionalDerivative, unknowns, n, &known, 1, &one, values);
  return 0;
}
static int derivatives(unit* u, double* dz, size_t n) {
  CALL(GetDerivatives, dz, n);
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

typedef fmi2EventInfo event_info;

static int handle_events(unit* u, fmi2EventInfo* info) {
  do {
    CALL(NewDiscreteStates, info);
  } while (info->newDiscreteStatesNeeded && !info->terminateSimulation);
  CALL(EnterContinuousTimeMode);
  ++u->run->n_events;
  return 0;
}

static int completed_step(unit* u) {
  fmi2Boolean enter = fmi2False, terminate = fmi2False;
  CALL(CompletedIntegratorStep, fmi2True, &enter, &terminate);
  if (enter || terminate) return fail(u, "an event that nothing announced");
  return 0;
}

#include "importer_body.h"

static int go(unit* u, void* library) {
  importer_run* const run = u->run;
  const fmi2CallbackFunctions functions = {logger, calloc, free, NULL, u};
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
  return run_rows(u);
}

int import_fmi2(importer_run* run) {
  return import(run, go);
}
