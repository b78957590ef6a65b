#define _GNU_SOURCE
#include <dlfcn.h>
#include <malloc.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fmi3Functions.h"
#include "importer.h"

/* What of the interface is called, by the types of the standard. */
#define FOR_EACH_FUNCTION(X)                                                                                                \
  X(GetVersion)                                                                                                             \
  X(SetDebugLogging)                                                                                                        \
  X(InstantiateModelExchange) X(InstantiateCoSimulation) X(InstantiateScheduledExecution) X(FreeInstance)                   \
      X(EnterInitializationMode) X(ExitInitializationMode) X(EnterEventMode) X(Terminate) X(Reset) X(GetFloat32)            \
          X(GetFloat64) X(GetInt8) X(GetUInt8) X(GetInt16) X(GetUInt16) X(GetInt32) X(GetUInt32) X(GetInt64) X(GetUInt64)   \
              X(GetBoolean) X(GetString) X(GetBinary) X(GetClock) X(SetFloat32) X(SetFloat64) X(SetInt8) X(SetUInt8)        \
                  X(SetInt16) X(SetUInt16) X(SetInt32) X(SetUInt32) X(SetInt64) X(SetUInt64) X(SetBoolean) X(SetString)     \
                      X(SetBinary) X(SetClock) X(GetNumberOfVariableDependencies) X(GetVariableDependencies) X(GetFMUState) \
                          X(SetFMUState) X(FreeFMUState) X(SerializedFMUStateSize) X(SerializeFMUState)                     \
                              X(DeserializeFMUState) X(GetDirectionalDerivative) X(GetAdjointDerivative)                    \
                                  X(EnterConfigurationMode) X(ExitConfigurationMode) X(GetIntervalDecimal)                  \
                                      X(GetIntervalFraction) X(GetShiftDecimal) X(GetShiftFraction) X(SetIntervalDecimal)   \
                                          X(SetIntervalFraction) X(SetShiftDecimal) X(SetShiftFraction)                     \
                                              X(EvaluateDiscreteStates) X(UpdateDiscreteStates) X(EnterContinuousTimeMode)  \
                                                  X(CompletedIntegratorStep) X(SetTime) X(SetContinuousStates)              \
                                                      X(GetContinuousStateDerivatives) X(GetEventIndicators)                \
                                                          X(GetContinuousStates) X(GetNominalsOfContinuousStates)           \
                                                              X(GetNumberOfEventIndicators) X(GetNumberOfContinuousStates)  \
                                                                  X(EnterStepMode) X(GetOutputDerivatives) X(DoStep)        \
                                                                      X(ActivateModelPartition)

typedef struct {
  importer_run* run;
  fmi3Instance c;
  char message[256];
#define MEMBER(name) fmi3##name##TYPE* name;
  FOR_EACH_FUNCTION(MEMBER)
} unit;

static void logger(fmi3InstanceEnvironment environment, fmi3Status status, fmi3String category, fmi3String message) {
  unit* const u = environment;
  (void)status, (void)category;
  snprintf(u->message, sizeof u->message, "%s", message);
}

static int fail(unit* u, const char* what) {
  snprintf(u->run->wrong, sizeof u->run->wrong, "%s: %s", what, u->message);
  return 1;
}
#define CALL(name, ...) \
  if (u->name(u->c, ##__VA_ARGS__) != fmi3OK) return fail(u, "fmi3" #name)

static int get(unit* u, const unsigned* variables, size_t n, double* values) {
  CALL(GetFloat64, variables, n, values, n);
  return 0;
}
static int set(unit* u, const unsigned* variables, size_t n, const double* values) {
  CALL(SetFloat64, variables, n, values, n);
  return 0;
}
static int set_rate(unit* u, unsigned input, double rate) {
  const unsigned rate_input = input + 1; /* ambient_temperature_rate is the variable after it */
  return set(u, &rate_input, 1, &rate);
}
static int step(unit* u, double t_s, double end_s) {
  bool needs_event = false, terminate = false, is_early = false;
  double last_s = 0.0;
  CALL(DoStep, t_s, end_s - t_s, fmi3True, &needs_event, &terminate, &is_early, &last_s);
  if (needs_event || terminate || is_early || fabs(last_s - end_s) > 1e-9 * end_s)
    return fail(u, "what fmi3DoStep says of its end");
  return 0;
}
static int sensitivity(unit* u, const unsigned* unknowns, size_t n, unsigned known, double* values) {
  const double one = 1.0;
  CALL(GetDirectionalDerivative, unknowns, n, &known, 1, &one, 1, values, n);
  return 0;
}
static int derivatives(unit* u, double* dz, size_t n) {
  CALL(GetContinuousStateDerivatives, dz, n);
  return 0;
}

/* The state is kept and written out; the unit goes elsewhere; the state that was written is read and set. */
static int rewind_state(unit* u, double t_s) {
  fmi3FMUState state = NULL, other = NULL;
  bool ignored[3];
  double last_s;
  size_t size = 0;
  fmi3Byte* bytes;
  CALL(GetFMUState, &state);
  CALL(SerializedFMUStateSize, state, &size);
  bytes = malloc(size);
  CALL(SerializeFMUState, state, bytes, size);
  CALL(DoStep, t_s, 3600.0, fmi3False, &ignored[0], &ignored[1], &ignored[2], &last_s);
  CALL(DeserializeFMUState, bytes, size, &other);
  CALL(SetFMUState, other);
  CALL(FreeFMUState, &state);
  CALL(FreeFMUState, &other);
  free(bytes);
  return 0;
}

typedef struct {
  bool nextEventTimeDefined;
  double nextEventTime;
} event_info;

static int handle_events(unit* u, event_info* info) {
  bool again = true, terminate = false, nominals = false, states = false;
  while (again && !terminate)
    CALL(UpdateDiscreteStates, &again, &terminate, &nominals, &states, &info->nextEventTimeDefined, &info->nextEventTime);
  CALL(EnterContinuousTimeMode);
  ++u->run->n_events;
  return 0;
}

static int completed_step(unit* u) {
  bool enter = false, terminate = false;
  CALL(CompletedIntegratorStep, fmi3True, &enter, &terminate);
  if (enter || terminate) return fail(u, "an event that nothing announced");
  return 0;
}

#include "importer_body.h"

static int go(unit* u, void* library) {
  importer_run* const run = u->run;
#define LOAD(name)                                    \
  *(void**)(&u->name) = dlsym(library, "fmi3" #name); \
  if (!u->name) return fail(u, "the binary lacks fmi3" #name);
  FOR_EACH_FUNCTION(LOAD)
  if (strncmp(u->GetVersion(), "3.0", 3) != 0) return fail(u, "version");
  if (u->InstantiateModelExchange("wrong", "{0}", NULL, false, true, u, logger)) return fail(u, "a wrong token was taken");
  u->c = run->is_co_simulation
             ? u->InstantiateCoSimulation("tested", run->guid, NULL, false, true, false, false, NULL, 0, u, logger, NULL)
             : u->InstantiateModelExchange("tested", run->guid, NULL, false, true, u, logger);
  if (!u->c) return fail(u, "fmi3Instantiate");
  if (u->SetTime(u->c, 1.0) != fmi3Error) return fail(u, "a time before initialization was taken");
  CALL(Reset);
  if (run->ambient_from_input >= 0) {
    const bool value = run->ambient_from_input != 0;
    CALL(SetBoolean, &run->ambient_from_input_reference, 1, &value, 1);
  }
  CALL(EnterInitializationMode, false, 0.0, run->time_s[0], false, 0.0);
  if (set_inputs(u, 0)) return 1;
  CALL(ExitInitializationMode);
  return run_rows(u);
}

int import_fmi3(importer_run* run) {
  return import(run, go);
}
