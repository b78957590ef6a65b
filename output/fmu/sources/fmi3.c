/* FMI 3.0, model exchange and co-simulation. */
#include <stdlib.h>

#include "fmi3_interface.h"
#include "instance.h"
#include "model.h"

static void tell(const instance* in, int status, const char* message) {
  fmi3LogMessageCallback log_message;
  log_message = (fmi3LogMessageCallback)in->callback;
  if (log_message && (in->is_logging || status >= kError))
    log_message(in->environment, (fmi3Status)status, status >= kError ? "logStatusError" : "logStatusWarning", message);
}

#define F(name) fmi3##name
#define EXPORT FMI3_Export
#define HANDLE fmi3Instance
#define REAL fmi3Float64
#define STATE(verb) fmi3##verb##FMUState
#define STATE_TYPE fmi3FMUState
#define STATE_SIZE fmi3SerializedFMUStateSize
#define DESERIALIZE fmi3DeserializeFMUState
#define GET_RATES fmi3GetContinuousStateDerivatives
#include "fmi_shared.h"

FMI3_Export const char* fmi3GetVersion(void) {
  return fmi3Version;
}

FMI3_Export fmi3Instance fmi3InstantiateModelExchange(fmi3String instanceName, fmi3String instantiationToken,
                                                      fmi3String resourcePath, fmi3Boolean visible, fmi3Boolean loggingOn,
                                                      fmi3InstanceEnvironment environment,
                                                      fmi3LogMessageCallback logMessage) {
  (void)resourcePath, (void)visible;
  return instance_new(instanceName, instantiationToken, 0, loggingOn, environment, tell, (void (*)(void))logMessage, calloc,
                      free);
}
FMI3_Export fmi3Instance fmi3InstantiateCoSimulation(fmi3String instanceName, fmi3String instantiationToken,
                                                     fmi3String resourcePath, fmi3Boolean visible, fmi3Boolean loggingOn,
                                                     fmi3Boolean eventModeUsed, fmi3Boolean earlyReturnAllowed,
                                                     const fmi3ValueReference intermediateVariables[],
                                                     size_t nIntermediateVariables, fmi3InstanceEnvironment environment,
                                                     fmi3LogMessageCallback logMessage,
                                                     fmi3IntermediateUpdateCallback intermediateUpdate) {
  (void)resourcePath, (void)visible, (void)earlyReturnAllowed, (void)intermediateVariables, (void)nIntermediateVariables;
  (void)intermediateUpdate;
  if (eventModeUsed) {
    if (logMessage)
      logMessage(environment, fmi3Error, "logStatusError", "co-simulation has no event mode here (hasEventMode)");
    return 0;
  }
  return instance_new(instanceName, instantiationToken, 1, loggingOn, environment, tell, (void (*)(void))logMessage, calloc,
                      free);
}
FMI3_Export fmi3Instance fmi3InstantiateScheduledExecution(fmi3String instanceName, fmi3String instantiationToken,
                                                           fmi3String resourcePath, fmi3Boolean visible,
                                                           fmi3Boolean loggingOn, fmi3InstanceEnvironment environment,
                                                           fmi3LogMessageCallback logMessage,
                                                           fmi3ClockUpdateCallback clockUpdate,
                                                           fmi3LockPreemptionCallback lockPreemption,
                                                           fmi3UnlockPreemptionCallback unlockPreemption) {
  (void)instanceName, (void)instantiationToken, (void)resourcePath, (void)visible, (void)loggingOn, (void)clockUpdate;
  (void)lockPreemption, (void)unlockPreemption;
  if (logMessage) logMessage(environment, fmi3Error, "logStatusError", "scheduled execution is not supported");
  return 0;
}

FMI3_Export fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean toleranceDefined, fmi3Float64 tolerance,
                                                   fmi3Float64 startTime, fmi3Boolean stopTimeDefined,
                                                   fmi3Float64 stopTime) {
  (void)toleranceDefined, (void)tolerance, (void)stopTimeDefined, (void)stopTime;
  ALLOW(kInstantiated, fmi3EnterInitializationMode);
  return (fmi3Status)instance_enter_initialization(c, startTime);
}

FMI3_Export fmi3Status fmi3GetFloat64(fmi3Instance c, const fmi3ValueReference valueReferences[], size_t nValueReferences,
                                      fmi3Float64 values[], size_t nValues) {
  ALLOW(kReadable, fmi3GetFloat64);
  if (nValues != nValueReferences) return (fmi3Status)instance_tell(c, kError, "all variables are scalars");
  return (fmi3Status)instance_get(c, valueReferences, nValueReferences, values);
}
FMI3_Export fmi3Status fmi3SetFloat64(fmi3Instance c, const fmi3ValueReference valueReferences[], size_t nValueReferences,
                                      const fmi3Float64 values[], size_t nValues) {
  ALLOW(kInstantiated | kInitialization | kRunning, fmi3SetFloat64);
  if (nValues != nValueReferences) return (fmi3Status)instance_tell(c, kError, "all variables are scalars");
  return (fmi3Status)instance_set(c, valueReferences, nValueReferences, values);
}
FMI3_Export fmi3Status fmi3GetBoolean(fmi3Instance c, const fmi3ValueReference valueReferences[], size_t nValueReferences,
                                      fmi3Boolean values[], size_t nValues) {
  size_t k;
  ALLOW(kReadable, fmi3GetBoolean);
  if (nValues != nValueReferences) return (fmi3Status)instance_tell(c, kError, "all variables are scalars");
  for (k = 0; k < nValueReferences; ++k) {
    int value = 0;
    const int status = instance_get_flag(c, valueReferences[k], &value);
    if (status != kOk) return (fmi3Status)status;
    values[k] = value != 0;
  }
  return fmi3OK;
}
FMI3_Export fmi3Status fmi3SetBoolean(fmi3Instance c, const fmi3ValueReference valueReferences[], size_t nValueReferences,
                                      const fmi3Boolean values[], size_t nValues) {
  size_t k;
  ALLOW(kInstantiated | kInitialization | kRunning, fmi3SetBoolean);
  if (nValues != nValueReferences) return (fmi3Status)instance_tell(c, kError, "all variables are scalars");
  for (k = 0; k < nValueReferences; ++k) {
    const int status = instance_set_flag(c, valueReferences[k], values[k] ? 1 : 0);
    if (status != kOk) return (fmi3Status)status;
  }
  return fmi3OK;
}

/* There are no variables of other types: asked for none of them, all is well. */
static fmi3Status none_of_these(fmi3Instance c, size_t n, const char* call) {
  if (!instance_allows(c, kAnyMode, call)) return fmi3Error;
  return n == 0 ? fmi3OK : (fmi3Status)instance_tell(c, kError, "there is no variable of this type");
}
static fmi3Status unsupported(fmi3Instance c, const char* call) {
  if (!instance_allows(c, kAnyMode, call)) return fmi3Error;
  return (fmi3Status)instance_tell(c, kError, "this part of the standard is not supported (modelDescription.xml)");
}
/* Parameters that nothing here looks at. */
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-parameter"
#define NONE_OF_THESE(name, parameters)          \
  FMI3_Export fmi3Status fmi3##name parameters { \
    return none_of_these(c, n, "fmi3" #name);    \
  }
#define UNSUPPORTED(name, parameters)            \
  FMI3_Export fmi3Status fmi3##name parameters { \
    return unsupported(c, "fmi3" #name);         \
  }
#define OF(type) fmi3Instance c, const fmi3ValueReference r[], size_t n, type
#define NO_VARIABLES_OF(Type)                                         \
  NONE_OF_THESE(Get##Type, (OF(fmi3##Type) values[], size_t nValues)) \
  NONE_OF_THESE(Set##Type, (OF(const fmi3##Type) values[], size_t nValues))
NO_VARIABLES_OF(Float32)
NO_VARIABLES_OF(Int8)
NO_VARIABLES_OF(UInt8)
NO_VARIABLES_OF(Int16)
NO_VARIABLES_OF(UInt16)
NO_VARIABLES_OF(Int32)
NO_VARIABLES_OF(UInt32)
NO_VARIABLES_OF(Int64)
NO_VARIABLES_OF(UInt64)
NO_VARIABLES_OF(String)
NONE_OF_THESE(GetBinary, (OF(size_t) sizes[], fmi3Binary values[], size_t nValues))
NONE_OF_THESE(SetBinary, (OF(const size_t) sizes[], const fmi3Binary values[], size_t nValues))
NONE_OF_THESE(GetClock, (OF(fmi3Clock) values[]))
NONE_OF_THESE(SetClock, (OF(const fmi3Clock) values[]))
UNSUPPORTED(GetNumberOfVariableDependencies, (fmi3Instance c, fmi3ValueReference r, size_t* n))
UNSUPPORTED(GetVariableDependencies, (fmi3Instance c, fmi3ValueReference r, size_t elements[], fmi3ValueReference of[],
                                      size_t elementsOf[], fmi3DependencyKind kinds[], size_t n))
UNSUPPORTED(EnterConfigurationMode, (fmi3Instance c))
UNSUPPORTED(ExitConfigurationMode, (fmi3Instance c))
UNSUPPORTED(GetIntervalDecimal, (OF(fmi3Float64) intervals[], fmi3IntervalQualifier qualifiers[]))
UNSUPPORTED(GetIntervalFraction, (OF(fmi3UInt64) counters[], fmi3UInt64 resolutions[], fmi3IntervalQualifier qualifiers[]))
UNSUPPORTED(GetShiftDecimal, (OF(fmi3Float64) shifts[]))
UNSUPPORTED(GetShiftFraction, (OF(fmi3UInt64) counters[], fmi3UInt64 resolutions[]))
UNSUPPORTED(SetIntervalDecimal, (OF(const fmi3Float64) intervals[]))
UNSUPPORTED(SetIntervalFraction, (OF(const fmi3UInt64) counters[], const fmi3UInt64 resolutions[]))
UNSUPPORTED(SetShiftDecimal, (OF(const fmi3Float64) shifts[]))
UNSUPPORTED(SetShiftFraction, (OF(const fmi3UInt64) counters[], const fmi3UInt64 resolutions[]))
UNSUPPORTED(GetAdjointDerivative, (OF(const fmi3ValueReference) knowns[], size_t nKnowns, const fmi3Float64 seed[],
                                   size_t nSeed, fmi3Float64 sensitivity[], size_t nSensitivity))
UNSUPPORTED(GetOutputDerivatives, (OF(const fmi3Int32) orders[], fmi3Float64 values[], size_t nValues))
UNSUPPORTED(ActivateModelPartition, (fmi3Instance c, fmi3ValueReference clock, fmi3Float64 time))
UNSUPPORTED(EnterStepMode, (fmi3Instance c))
#pragma GCC diagnostic pop

FMI3_Export fmi3Status fmi3GetDirectionalDerivative(fmi3Instance c, const fmi3ValueReference unknowns[], size_t nUnknowns,
                                                    const fmi3ValueReference knowns[], size_t nKnowns,
                                                    const fmi3Float64 seed[], size_t nSeed, fmi3Float64 sensitivity[],
                                                    size_t nSensitivity) {
  ALLOW(kInitialization | kRunning | kTerminated, fmi3GetDirectionalDerivative);
  if (nSeed != nKnowns || nSensitivity != nUnknowns)
    return (fmi3Status)instance_tell(c, kError, "all variables are scalars");
  return (fmi3Status)instance_sensitivity(c, unknowns, nUnknowns, knowns, nKnowns, seed, sensitivity);
}

/* Model exchange. */
FMI3_Export fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance c) {
  ALLOW(kInitialization | kEvent, fmi3EvaluateDiscreteStates);
  return fmi3OK;
}
FMI3_Export fmi3Status fmi3UpdateDiscreteStates(fmi3Instance c, fmi3Boolean* discreteStatesNeedUpdate,
                                                fmi3Boolean* terminateSimulation, fmi3Boolean* nominalsChanged,
                                                fmi3Boolean* statesChanged, fmi3Boolean* nextEventTimeDefined,
                                                fmi3Float64* nextEventTime) {
  int has_next = 0, status;
  double next_s = 0.0;
  ALLOW(kEvent, fmi3UpdateDiscreteStates);
  status = instance_event(c, &has_next, &next_s);
  *discreteStatesNeedUpdate = *terminateSimulation = *nominalsChanged = *statesChanged = fmi3False;
  *nextEventTimeDefined = has_next != 0;
  *nextEventTime = has_next ? next_s : 0.0;
  return (fmi3Status)status;
}
FMI3_Export fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance c, size_t* nEventIndicators) {
  ALLOW(kAnyMode, fmi3GetNumberOfEventIndicators);
  *nEventIndicators = (size_t)model_n_switches();
  return fmi3OK;
}
FMI3_Export fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance c, size_t* nContinuousStates) {
  ALLOW(kAnyMode, fmi3GetNumberOfContinuousStates);
  *nContinuousStates = (size_t)model_n_states();
  return fmi3OK;
}

/* Co-simulation. */
FMI3_Export fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 currentCommunicationPoint, fmi3Float64 communicationStepSize,
                                  fmi3Boolean noSetFMUStatePriorToCurrentPoint, fmi3Boolean* eventHandlingNeeded,
                                  fmi3Boolean* terminateSimulation, fmi3Boolean* earlyReturn,
                                  fmi3Float64* lastSuccessfulTime) {
  int status;
  (void)noSetFMUStatePriorToCurrentPoint;
  ALLOW(kStep, fmi3DoStep);
  status = instance_step(c, currentCommunicationPoint, communicationStepSize);
  *eventHandlingNeeded = *terminateSimulation = *earlyReturn = fmi3False;
  *lastSuccessfulTime = ((instance*)c)->saved[kTime];
  return (fmi3Status)status;
}
