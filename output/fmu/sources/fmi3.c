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

#define ALLOW(modes, call) \
  if (!instance_allows(instance_, modes, call)) return fmi3Error

FMI3_Export const char* fmi3GetVersion(void) {
  return fmi3Version;
}
FMI3_Export fmi3Status fmi3SetDebugLogging(fmi3Instance instance_, fmi3Boolean loggingOn, size_t nCategories,
                                           const fmi3String categories[]) {
  (void)nCategories, (void)categories;
  ALLOW(kAnyMode, "fmi3SetDebugLogging");
  ((instance*)instance_)->is_logging = loggingOn;
  return fmi3OK;
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
FMI3_Export void fmi3FreeInstance(fmi3Instance instance_) {
  instance_free(instance_);
}

FMI3_Export fmi3Status fmi3EnterInitializationMode(fmi3Instance instance_, fmi3Boolean toleranceDefined,
                                                   fmi3Float64 tolerance, fmi3Float64 startTime, fmi3Boolean stopTimeDefined,
                                                   fmi3Float64 stopTime) {
  (void)toleranceDefined, (void)tolerance, (void)stopTimeDefined, (void)stopTime;
  ALLOW(kInstantiated, "fmi3EnterInitializationMode");
  return (fmi3Status)instance_enter_initialization(instance_, startTime);
}
FMI3_Export fmi3Status fmi3ExitInitializationMode(fmi3Instance instance_) {
  ALLOW(kInitialization, "fmi3ExitInitializationMode");
  return (fmi3Status)instance_exit_initialization(instance_);
}
FMI3_Export fmi3Status fmi3EnterEventMode(fmi3Instance instance_) {
  ALLOW(kContinuousTime | kEvent, "fmi3EnterEventMode");
  ((instance*)instance_)->mode = kEvent;
  return fmi3OK;
}
FMI3_Export fmi3Status fmi3Terminate(fmi3Instance instance_) {
  ALLOW(kRunning, "fmi3Terminate");
  ((instance*)instance_)->mode = kTerminated;
  return fmi3OK;
}
FMI3_Export fmi3Status fmi3Reset(fmi3Instance instance_) {
  ALLOW(kAnyMode, "fmi3Reset");
  return (fmi3Status)instance_reset(instance_);
}

FMI3_Export fmi3Status fmi3GetFloat64(fmi3Instance instance_, const fmi3ValueReference valueReferences[],
                                      size_t nValueReferences, fmi3Float64 values[], size_t nValues) {
  ALLOW(kReadable, "fmi3GetFloat64");
  if (nValues != nValueReferences) return (fmi3Status)instance_tell(instance_, kError, "all variables are scalars");
  return (fmi3Status)instance_get(instance_, valueReferences, nValueReferences, values);
}
FMI3_Export fmi3Status fmi3SetFloat64(fmi3Instance instance_, const fmi3ValueReference valueReferences[],
                                      size_t nValueReferences, const fmi3Float64 values[], size_t nValues) {
  ALLOW(kInstantiated | kInitialization | kRunning, "fmi3SetFloat64");
  if (nValues != nValueReferences) return (fmi3Status)instance_tell(instance_, kError, "all variables are scalars");
  return (fmi3Status)instance_set(instance_, valueReferences, nValueReferences, values);
}
FMI3_Export fmi3Status fmi3GetBoolean(fmi3Instance instance_, const fmi3ValueReference valueReferences[],
                                      size_t nValueReferences, fmi3Boolean values[], size_t nValues) {
  size_t k;
  ALLOW(kReadable, "fmi3GetBoolean");
  if (nValues != nValueReferences) return (fmi3Status)instance_tell(instance_, kError, "all variables are scalars");
  for (k = 0; k < nValueReferences; ++k) {
    int value = 0;
    const int status = instance_get_flag(instance_, valueReferences[k], &value);
    if (status != kOk) return (fmi3Status)status;
    values[k] = value != 0;
  }
  return fmi3OK;
}
FMI3_Export fmi3Status fmi3SetBoolean(fmi3Instance instance_, const fmi3ValueReference valueReferences[],
                                      size_t nValueReferences, const fmi3Boolean values[], size_t nValues) {
  size_t k;
  ALLOW(kInstantiated | kInitialization | kRunning, "fmi3SetBoolean");
  if (nValues != nValueReferences) return (fmi3Status)instance_tell(instance_, kError, "all variables are scalars");
  for (k = 0; k < nValueReferences; ++k) {
    const int status = instance_set_flag(instance_, valueReferences[k], values[k] ? 1 : 0);
    if (status != kOk) return (fmi3Status)status;
  }
  return fmi3OK;
}

/* There are no variables of other types: asked for none of them, all is well. */
static fmi3Status none_of_these(fmi3Instance instance_, size_t n, const char* call) {
  ALLOW(kAnyMode, call);
  return n == 0 ? fmi3OK : (fmi3Status)instance_tell(instance_, kError, "there is no variable of this type");
}
static fmi3Status unsupported(fmi3Instance instance_, const char* call) {
  ALLOW(kAnyMode, call);
  return (fmi3Status)instance_tell(instance_, kError, "this part of the standard is not supported (modelDescription.xml)");
}
#define NO_VARIABLES_OF(Type)                                                                                \
  FMI3_Export fmi3Status fmi3Get##Type(fmi3Instance instance_, const fmi3ValueReference valueReferences[],   \
                                       size_t nValueReferences, fmi3##Type values[], size_t nValues) {       \
    (void)valueReferences, (void)values, (void)nValues;                                                      \
    return none_of_these(instance_, nValueReferences, "fmi3Get" #Type);                                      \
  }                                                                                                          \
  FMI3_Export fmi3Status fmi3Set##Type(fmi3Instance instance_, const fmi3ValueReference valueReferences[],   \
                                       size_t nValueReferences, const fmi3##Type values[], size_t nValues) { \
    (void)valueReferences, (void)values, (void)nValues;                                                      \
    return none_of_these(instance_, nValueReferences, "fmi3Set" #Type);                                      \
  }
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
FMI3_Export fmi3Status fmi3GetBinary(fmi3Instance instance_, const fmi3ValueReference valueReferences[],
                                     size_t nValueReferences, size_t valueSizes[], fmi3Binary values[], size_t nValues) {
  (void)valueReferences, (void)valueSizes, (void)values, (void)nValues;
  return none_of_these(instance_, nValueReferences, "fmi3GetBinary");
}
FMI3_Export fmi3Status fmi3GetClock(fmi3Instance instance_, const fmi3ValueReference valueReferences[],
                                    size_t nValueReferences, fmi3Clock values[]) {
  (void)valueReferences, (void)values;
  return none_of_these(instance_, nValueReferences, "fmi3GetClock");
}
FMI3_Export fmi3Status fmi3SetBinary(fmi3Instance instance_, const fmi3ValueReference valueReferences[],
                                     size_t nValueReferences, const size_t valueSizes[], const fmi3Binary values[],
                                     size_t nValues) {
  (void)valueReferences, (void)valueSizes, (void)values, (void)nValues;
  return none_of_these(instance_, nValueReferences, "fmi3SetBinary");
}
FMI3_Export fmi3Status fmi3SetClock(fmi3Instance instance_, const fmi3ValueReference valueReferences[],
                                    size_t nValueReferences, const fmi3Clock values[]) {
  (void)valueReferences, (void)values;
  return none_of_these(instance_, nValueReferences, "fmi3SetClock");
}
FMI3_Export fmi3Status fmi3GetNumberOfVariableDependencies(fmi3Instance instance_, fmi3ValueReference valueReference,
                                                           size_t* nDependencies) {
  (void)valueReference, (void)nDependencies;
  return unsupported(instance_, "fmi3GetNumberOfVariableDependencies");
}
FMI3_Export fmi3Status fmi3GetVariableDependencies(fmi3Instance instance_, fmi3ValueReference dependent,
                                                   size_t elementIndicesOfDependent[], fmi3ValueReference independents[],
                                                   size_t elementIndicesOfIndependents[],
                                                   fmi3DependencyKind dependencyKinds[], size_t nDependencies) {
  (void)dependent, (void)elementIndicesOfDependent, (void)independents, (void)elementIndicesOfIndependents;
  (void)dependencyKinds, (void)nDependencies;
  return unsupported(instance_, "fmi3GetVariableDependencies");
}
FMI3_Export fmi3Status fmi3EnterConfigurationMode(fmi3Instance instance_) {
  return unsupported(instance_, "fmi3EnterConfigurationMode");
}
FMI3_Export fmi3Status fmi3ExitConfigurationMode(fmi3Instance instance_) {
  return unsupported(instance_, "fmi3ExitConfigurationMode");
}
FMI3_Export fmi3Status fmi3GetIntervalDecimal(fmi3Instance instance_, const fmi3ValueReference valueReferences[],
                                              size_t nValueReferences, fmi3Float64 intervals[],
                                              fmi3IntervalQualifier qualifiers[]) {
  (void)valueReferences, (void)nValueReferences, (void)intervals, (void)qualifiers;
  return unsupported(instance_, "fmi3GetIntervalDecimal");
}
FMI3_Export fmi3Status fmi3GetIntervalFraction(fmi3Instance instance_, const fmi3ValueReference valueReferences[],
                                               size_t nValueReferences, fmi3UInt64 counters[], fmi3UInt64 resolutions[],
                                               fmi3IntervalQualifier qualifiers[]) {
  (void)valueReferences, (void)nValueReferences, (void)counters, (void)resolutions, (void)qualifiers;
  return unsupported(instance_, "fmi3GetIntervalFraction");
}
FMI3_Export fmi3Status fmi3GetShiftDecimal(fmi3Instance instance_, const fmi3ValueReference valueReferences[],
                                           size_t nValueReferences, fmi3Float64 shifts[]) {
  (void)valueReferences, (void)nValueReferences, (void)shifts;
  return unsupported(instance_, "fmi3GetShiftDecimal");
}
FMI3_Export fmi3Status fmi3GetShiftFraction(fmi3Instance instance_, const fmi3ValueReference valueReferences[],
                                            size_t nValueReferences, fmi3UInt64 counters[], fmi3UInt64 resolutions[]) {
  (void)valueReferences, (void)nValueReferences, (void)counters, (void)resolutions;
  return unsupported(instance_, "fmi3GetShiftFraction");
}
FMI3_Export fmi3Status fmi3SetIntervalDecimal(fmi3Instance instance_, const fmi3ValueReference valueReferences[],
                                              size_t nValueReferences, const fmi3Float64 intervals[]) {
  (void)valueReferences, (void)nValueReferences, (void)intervals;
  return unsupported(instance_, "fmi3SetIntervalDecimal");
}
FMI3_Export fmi3Status fmi3SetIntervalFraction(fmi3Instance instance_, const fmi3ValueReference valueReferences[],
                                               size_t nValueReferences, const fmi3UInt64 counters[],
                                               const fmi3UInt64 resolutions[]) {
  (void)valueReferences, (void)nValueReferences, (void)counters, (void)resolutions;
  return unsupported(instance_, "fmi3SetIntervalFraction");
}
FMI3_Export fmi3Status fmi3SetShiftDecimal(fmi3Instance instance_, const fmi3ValueReference valueReferences[],
                                           size_t nValueReferences, const fmi3Float64 shifts[]) {
  (void)valueReferences, (void)nValueReferences, (void)shifts;
  return unsupported(instance_, "fmi3SetShiftDecimal");
}
FMI3_Export fmi3Status fmi3SetShiftFraction(fmi3Instance instance_, const fmi3ValueReference valueReferences[],
                                            size_t nValueReferences, const fmi3UInt64 counters[],
                                            const fmi3UInt64 resolutions[]) {
  (void)valueReferences, (void)nValueReferences, (void)counters, (void)resolutions;
  return unsupported(instance_, "fmi3SetShiftFraction");
}
FMI3_Export fmi3Status fmi3GetAdjointDerivative(fmi3Instance instance_, const fmi3ValueReference unknowns[],
                                                size_t nUnknowns, const fmi3ValueReference knowns[], size_t nKnowns,
                                                const fmi3Float64 seed[], size_t nSeed, fmi3Float64 sensitivity[],
                                                size_t nSensitivity) {
  (void)unknowns, (void)nUnknowns, (void)knowns, (void)nKnowns, (void)seed, (void)nSeed, (void)sensitivity;
  (void)nSensitivity;
  return unsupported(instance_, "fmi3GetAdjointDerivative");
}
FMI3_Export fmi3Status fmi3GetOutputDerivatives(fmi3Instance instance_, const fmi3ValueReference valueReferences[],
                                                size_t nValueReferences, const fmi3Int32 orders[], fmi3Float64 values[],
                                                size_t nValues) {
  (void)valueReferences, (void)nValueReferences, (void)orders, (void)values, (void)nValues;
  return unsupported(instance_, "fmi3GetOutputDerivatives");
}
FMI3_Export fmi3Status fmi3ActivateModelPartition(fmi3Instance instance_, fmi3ValueReference clockReference,
                                                  fmi3Float64 activationTime) {
  (void)clockReference, (void)activationTime;
  return unsupported(instance_, "fmi3ActivateModelPartition");
}
FMI3_Export fmi3Status fmi3EnterStepMode(fmi3Instance instance_) {
  return unsupported(instance_, "fmi3EnterStepMode");
}

FMI3_Export fmi3Status fmi3GetFMUState(fmi3Instance instance_, fmi3FMUState* FMUState) {
  ALLOW(kAnyMode, "fmi3GetFMUState");
  return (fmi3Status)instance_keep_state(instance_, FMUState);
}
FMI3_Export fmi3Status fmi3SetFMUState(fmi3Instance instance_, fmi3FMUState FMUState) {
  ALLOW(kAnyMode, "fmi3SetFMUState");
  return (fmi3Status)instance_restore_state(instance_, FMUState);
}
FMI3_Export fmi3Status fmi3FreeFMUState(fmi3Instance instance_, fmi3FMUState* FMUState) {
  ALLOW(kAnyMode, "fmi3FreeFMUState");
  if (FMUState) instance_free_state(instance_, FMUState);
  return fmi3OK;
}
FMI3_Export fmi3Status fmi3SerializedFMUStateSize(fmi3Instance instance_, fmi3FMUState FMUState, size_t* size) {
  (void)FMUState;
  ALLOW(kAnyMode, "fmi3SerializedFMUStateSize");
  *size = instance_state_bytes();
  return fmi3OK;
}
FMI3_Export fmi3Status fmi3SerializeFMUState(fmi3Instance instance_, fmi3FMUState FMUState, fmi3Byte bytes[], size_t size) {
  ALLOW(kAnyMode, "fmi3SerializeFMUState");
  return (fmi3Status)instance_write_state(instance_, FMUState, bytes, size);
}
FMI3_Export fmi3Status fmi3DeserializeFMUState(fmi3Instance instance_, const fmi3Byte bytes[], size_t size,
                                               fmi3FMUState* FMUState) {
  ALLOW(kAnyMode, "fmi3DeserializeFMUState");
  return (fmi3Status)instance_read_state(instance_, bytes, size, FMUState);
}

FMI3_Export fmi3Status fmi3GetDirectionalDerivative(fmi3Instance instance_, const fmi3ValueReference unknowns[],
                                                    size_t nUnknowns, const fmi3ValueReference knowns[], size_t nKnowns,
                                                    const fmi3Float64 seed[], size_t nSeed, fmi3Float64 sensitivity[],
                                                    size_t nSensitivity) {
  ALLOW(kInitialization | kRunning | kTerminated, "fmi3GetDirectionalDerivative");
  if (nSeed != nKnowns || nSensitivity != nUnknowns)
    return (fmi3Status)instance_tell(instance_, kError, "all variables are scalars");
  return (fmi3Status)instance_sensitivity(instance_, unknowns, nUnknowns, knowns, nKnowns, seed, sensitivity);
}

/* Model exchange. */
FMI3_Export fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance instance_) {
  ALLOW(kInitialization | kEvent, "fmi3EvaluateDiscreteStates");
  return fmi3OK;
}
FMI3_Export fmi3Status fmi3UpdateDiscreteStates(fmi3Instance instance_, fmi3Boolean* discreteStatesNeedUpdate,
                                                fmi3Boolean* terminateSimulation, fmi3Boolean* nominalsChanged,
                                                fmi3Boolean* statesChanged, fmi3Boolean* nextEventTimeDefined,
                                                fmi3Float64* nextEventTime) {
  int has_next = 0, status;
  double next_s = 0.0;
  ALLOW(kEvent, "fmi3UpdateDiscreteStates");
  status = instance_event(instance_, &has_next, &next_s);
  *discreteStatesNeedUpdate = *terminateSimulation = *nominalsChanged = *statesChanged = fmi3False;
  *nextEventTimeDefined = has_next != 0;
  *nextEventTime = has_next ? next_s : 0.0;
  return (fmi3Status)status;
}
FMI3_Export fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance instance_) {
  ALLOW(kEvent, "fmi3EnterContinuousTimeMode");
  ((instance*)instance_)->mode = kContinuousTime;
  return fmi3OK;
}
FMI3_Export fmi3Status fmi3CompletedIntegratorStep(fmi3Instance instance_, fmi3Boolean noSetFMUStatePriorToCurrentPoint,
                                                   fmi3Boolean* enterEventMode, fmi3Boolean* terminateSimulation) {
  (void)noSetFMUStatePriorToCurrentPoint;
  ALLOW(kContinuousTime, "fmi3CompletedIntegratorStep");
  *enterEventMode = *terminateSimulation = fmi3False;
  return fmi3OK;
}
FMI3_Export fmi3Status fmi3SetTime(fmi3Instance instance_, fmi3Float64 time) {
  ALLOW(kEvent | kContinuousTime, "fmi3SetTime");
  return (fmi3Status)instance_set_time(instance_, time);
}
FMI3_Export fmi3Status fmi3SetContinuousStates(fmi3Instance instance_, const fmi3Float64 states[],
                                               size_t nContinuousStates) {
  ALLOW(kContinuousTime | kEvent, "fmi3SetContinuousStates");
  return (fmi3Status)instance_set_states(instance_, states, nContinuousStates);
}
FMI3_Export fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance instance_, fmi3Float64 derivatives[],
                                                         size_t nContinuousStates) {
  ALLOW(kReadable, "fmi3GetContinuousStateDerivatives");
  return (fmi3Status)instance_get_derivatives(instance_, derivatives, nContinuousStates);
}
FMI3_Export fmi3Status fmi3GetEventIndicators(fmi3Instance instance_, fmi3Float64 eventIndicators[],
                                              size_t nEventIndicators) {
  (void)eventIndicators;
  ALLOW(kReadable, "fmi3GetEventIndicators");
  return nEventIndicators == 0 ? fmi3OK : (fmi3Status)instance_tell(instance_, kError, "there are no event indicators");
}
FMI3_Export fmi3Status fmi3GetContinuousStates(fmi3Instance instance_, fmi3Float64 states[], size_t nContinuousStates) {
  ALLOW(kReadable, "fmi3GetContinuousStates");
  return (fmi3Status)instance_get_states(instance_, states, nContinuousStates);
}
FMI3_Export fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance instance_, fmi3Float64 nominals[],
                                                         size_t nContinuousStates) {
  ALLOW(kAnyMode, "fmi3GetNominalsOfContinuousStates");
  return (fmi3Status)instance_get_nominals(instance_, nominals, nContinuousStates);
}
FMI3_Export fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance instance_, size_t* nEventIndicators) {
  ALLOW(kAnyMode, "fmi3GetNumberOfEventIndicators");
  *nEventIndicators = 0;
  return fmi3OK;
}
FMI3_Export fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance instance_, size_t* nContinuousStates) {
  ALLOW(kAnyMode, "fmi3GetNumberOfContinuousStates");
  *nContinuousStates = (size_t)model_n_states();
  return fmi3OK;
}

/* Co-simulation. */
FMI3_Export fmi3Status fmi3DoStep(fmi3Instance instance_, fmi3Float64 currentCommunicationPoint,
                                  fmi3Float64 communicationStepSize, fmi3Boolean noSetFMUStatePriorToCurrentPoint,
                                  fmi3Boolean* eventHandlingNeeded, fmi3Boolean* terminateSimulation,
                                  fmi3Boolean* earlyReturn, fmi3Float64* lastSuccessfulTime) {
  int status;
  (void)noSetFMUStatePriorToCurrentPoint;
  ALLOW(kStep, "fmi3DoStep");
  status = instance_step(instance_, currentCommunicationPoint, communicationStepSize);
  *eventHandlingNeeded = *terminateSimulation = *earlyReturn = fmi3False;
  *lastSuccessfulTime = ((instance*)instance_)->saved[kTime];
  return (fmi3Status)status;
}
