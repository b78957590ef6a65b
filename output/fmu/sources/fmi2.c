/* FMI 2.0, model exchange and co-simulation. */
#include <stdlib.h>
#include <string.h>

#include "fmi2_interface.h"
#include "instance.h"
#include "model.h"

static void tell(const instance* in, int status, const char* message) {
  fmi2CallbackLogger logger;
  logger = (fmi2CallbackLogger)in->callback;
  if (logger && (in->is_logging || status >= kError))
    logger(in->environment, in->name, (fmi2Status)status, status >= kError ? "logStatusError" : "logStatusWarning", "%s",
           message);
}

#define ALLOW(modes, call) \
  if (!instance_allows(c, modes, call)) return fmi2Error

FMI2_Export const char* fmi2GetTypesPlatform(void) {
  return fmi2TypesPlatform;
}
FMI2_Export const char* fmi2GetVersion(void) {
  return fmi2Version;
}
FMI2_Export fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean loggingOn, size_t nCategories,
                                           const fmi2String categories[]) {
  (void)nCategories, (void)categories;
  ALLOW(kAnyMode, "fmi2SetDebugLogging");
  ((instance*)c)->is_logging = loggingOn != fmi2False;
  return fmi2OK;
}

FMI2_Export fmi2Component fmi2Instantiate(fmi2String instanceName, fmi2Type fmuType, fmi2String fmuGUID,
                                          fmi2String fmuResourceLocation, const fmi2CallbackFunctions* functions,
                                          fmi2Boolean visible, fmi2Boolean loggingOn) {
  (void)fmuResourceLocation, (void)visible;
  if (!functions) return 0;
  return instance_new(instanceName, fmuGUID, fmuType == fmi2CoSimulation, loggingOn != fmi2False,
                      functions->componentEnvironment, tell, (void (*)(void))functions->logger,
                      functions->allocateMemory ? functions->allocateMemory : calloc,
                      functions->freeMemory && functions->allocateMemory ? functions->freeMemory : free);
}
FMI2_Export void fmi2FreeInstance(fmi2Component c) {
  instance_free(c);
}

FMI2_Export fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean toleranceDefined, fmi2Real tolerance,
                                           fmi2Real startTime, fmi2Boolean stopTimeDefined, fmi2Real stopTime) {
  (void)toleranceDefined, (void)tolerance, (void)stopTimeDefined, (void)stopTime;
  ALLOW(kInstantiated, "fmi2SetupExperiment");
  return (fmi2Status)instance_set_time(c, startTime);
}
FMI2_Export fmi2Status fmi2EnterInitializationMode(fmi2Component c) {
  ALLOW(kInstantiated, "fmi2EnterInitializationMode");
  return (fmi2Status)instance_enter_initialization(c, ((instance*)c)->saved[kTime]);
}
FMI2_Export fmi2Status fmi2ExitInitializationMode(fmi2Component c) {
  ALLOW(kInitialization, "fmi2ExitInitializationMode");
  return (fmi2Status)instance_exit_initialization(c);
}
FMI2_Export fmi2Status fmi2Terminate(fmi2Component c) {
  ALLOW(kRunning, "fmi2Terminate");
  ((instance*)c)->mode = kTerminated;
  return fmi2OK;
}
FMI2_Export fmi2Status fmi2Reset(fmi2Component c) {
  ALLOW(kAnyMode, "fmi2Reset");
  return (fmi2Status)instance_reset(c);
}

FMI2_Export fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2Real value[]) {
  ALLOW(kReadable, "fmi2GetReal");
  return (fmi2Status)instance_get(c, vr, nvr, value);
}
FMI2_Export fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, const fmi2Real value[]) {
  ALLOW(kInstantiated | kInitialization | kRunning, "fmi2SetReal");
  return (fmi2Status)instance_set(c, vr, nvr, value);
}
FMI2_Export fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2Boolean value[]) {
  size_t k;
  ALLOW(kReadable, "fmi2GetBoolean");
  for (k = 0; k < nvr; ++k) {
    const int status = instance_get_flag(c, vr[k], &value[k]);
    if (status != kOk) return (fmi2Status)status;
  }
  return fmi2OK;
}
FMI2_Export fmi2Status fmi2SetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                                      const fmi2Boolean value[]) {
  size_t k;
  ALLOW(kInstantiated | kInitialization | kRunning, "fmi2SetBoolean");
  for (k = 0; k < nvr; ++k) {
    const int status = instance_set_flag(c, vr[k], value[k] != fmi2False);
    if (status != kOk) return (fmi2Status)status;
  }
  return fmi2OK;
}

/* There are no integers and strings: asked for none of them, all is well. */
static fmi2Status none_of_these(fmi2Component c, size_t n, const char* call) {
  ALLOW(kAnyMode, call);
  return n == 0 ? fmi2OK : (fmi2Status)instance_tell(c, kError, "there is no variable of this type");
}
FMI2_Export fmi2Status fmi2GetInteger(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2Integer value[]) {
  (void)vr, (void)value;
  return none_of_these(c, nvr, "fmi2GetInteger");
}
FMI2_Export fmi2Status fmi2SetInteger(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                                      const fmi2Integer value[]) {
  (void)vr, (void)value;
  return none_of_these(c, nvr, "fmi2SetInteger");
}
FMI2_Export fmi2Status fmi2GetString(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2String value[]) {
  (void)vr, (void)value;
  return none_of_these(c, nvr, "fmi2GetString");
}
FMI2_Export fmi2Status fmi2SetString(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, const fmi2String value[]) {
  (void)vr, (void)value;
  return none_of_these(c, nvr, "fmi2SetString");
}

FMI2_Export fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate* FMUstate) {
  ALLOW(kAnyMode, "fmi2GetFMUstate");
  return (fmi2Status)instance_keep_state(c, FMUstate);
}
FMI2_Export fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate FMUstate) {
  ALLOW(kAnyMode, "fmi2SetFMUstate");
  return (fmi2Status)instance_restore_state(c, FMUstate);
}
FMI2_Export fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate* FMUstate) {
  ALLOW(kAnyMode, "fmi2FreeFMUstate");
  if (FMUstate) instance_free_state(c, FMUstate);
  return fmi2OK;
}
FMI2_Export fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate FMUstate, size_t* size) {
  (void)FMUstate;
  ALLOW(kAnyMode, "fmi2SerializedFMUstateSize");
  *size = instance_state_bytes();
  return fmi2OK;
}
FMI2_Export fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate FMUstate, fmi2Byte bytes[], size_t size) {
  ALLOW(kAnyMode, "fmi2SerializeFMUstate");
  return (fmi2Status)instance_write_state(c, FMUstate, bytes, size);
}
FMI2_Export fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size,
                                               fmi2FMUstate* FMUstate) {
  ALLOW(kAnyMode, "fmi2DeSerializeFMUstate");
  return (fmi2Status)instance_read_state(c, bytes, size, FMUstate);
}

FMI2_Export fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknowns[], size_t nUnknown,
                                                    const fmi2ValueReference knowns[], size_t nKnown,
                                                    const fmi2Real dvKnown[], fmi2Real dvUnknown[]) {
  ALLOW(kInitialization | kRunning | kTerminated, "fmi2GetDirectionalDerivative");
  return (fmi2Status)instance_sensitivity(c, unknowns, nUnknown, knowns, nKnown, dvKnown, dvUnknown);
}

/* Model exchange. */
FMI2_Export fmi2Status fmi2EnterEventMode(fmi2Component c) {
  ALLOW(kContinuousTime | kEvent, "fmi2EnterEventMode");
  ((instance*)c)->mode = kEvent;
  return fmi2OK;
}
FMI2_Export fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo* info) {
  ALLOW(kEvent, "fmi2NewDiscreteStates");
  memset(info, 0, sizeof *info);
  return (fmi2Status)instance_event(c, &info->nextEventTimeDefined, &info->nextEventTime);
}
FMI2_Export fmi2Status fmi2EnterContinuousTimeMode(fmi2Component c) {
  ALLOW(kEvent, "fmi2EnterContinuousTimeMode");
  ((instance*)c)->mode = kContinuousTime;
  return fmi2OK;
}
FMI2_Export fmi2Status fmi2CompletedIntegratorStep(fmi2Component c, fmi2Boolean noSetFMUStatePriorToCurrentPoint,
                                                   fmi2Boolean* enterEventMode, fmi2Boolean* terminateSimulation) {
  (void)noSetFMUStatePriorToCurrentPoint;
  ALLOW(kContinuousTime, "fmi2CompletedIntegratorStep");
  *enterEventMode = fmi2False;
  *terminateSimulation = fmi2False;
  return fmi2OK;
}
FMI2_Export fmi2Status fmi2SetTime(fmi2Component c, fmi2Real time) {
  ALLOW(kEvent | kContinuousTime, "fmi2SetTime");
  return (fmi2Status)instance_set_time(c, time);
}
FMI2_Export fmi2Status fmi2SetContinuousStates(fmi2Component c, const fmi2Real x[], size_t nx) {
  ALLOW(kContinuousTime | kEvent, "fmi2SetContinuousStates");
  return (fmi2Status)instance_set_states(c, x, nx);
}
FMI2_Export fmi2Status fmi2GetDerivatives(fmi2Component c, fmi2Real derivatives[], size_t nx) {
  ALLOW(kReadable, "fmi2GetDerivatives");
  return (fmi2Status)instance_get_derivatives(c, derivatives, nx);
}
FMI2_Export fmi2Status fmi2GetEventIndicators(fmi2Component c, fmi2Real eventIndicators[], size_t ni) {
  (void)eventIndicators;
  ALLOW(kReadable, "fmi2GetEventIndicators");
  return ni == 0 ? fmi2OK : (fmi2Status)instance_tell(c, kError, "there are no event indicators");
}
FMI2_Export fmi2Status fmi2GetContinuousStates(fmi2Component c, fmi2Real x[], size_t nx) {
  ALLOW(kReadable, "fmi2GetContinuousStates");
  return (fmi2Status)instance_get_states(c, x, nx);
}
FMI2_Export fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component c, fmi2Real x_nominal[], size_t nx) {
  ALLOW(kAnyMode, "fmi2GetNominalsOfContinuousStates");
  return (fmi2Status)instance_get_nominals(c, x_nominal, nx);
}

/* Co-simulation. */
FMI2_Export fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                                                   const fmi2Integer order[], const fmi2Real value[]) {
  ALLOW(kInstantiated | kInitialization | kStep, "fmi2SetRealInputDerivatives");
  return (fmi2Status)instance_set_input_rates(c, vr, nvr, order, value);
}
FMI2_Export fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                                                    const fmi2Integer order[], fmi2Real value[]) {
  (void)vr, (void)order, (void)value;
  return none_of_these(c, nvr, "fmi2GetRealOutputDerivatives");
}
FMI2_Export fmi2Status fmi2DoStep(fmi2Component c, fmi2Real currentCommunicationPoint, fmi2Real communicationStepSize,
                                  fmi2Boolean noSetFMUStatePriorToCurrentPoint) {
  (void)noSetFMUStatePriorToCurrentPoint;
  ALLOW(kStep, "fmi2DoStep");
  return (fmi2Status)instance_step(c, currentCommunicationPoint, communicationStepSize);
}
FMI2_Export fmi2Status fmi2CancelStep(fmi2Component c) {
  ALLOW(kStep, "fmi2CancelStep");
  return (fmi2Status)instance_tell(c, kError, "no step runs in the background");
}
FMI2_Export fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind s, fmi2Status* value) {
  (void)s, (void)value;
  ALLOW(kStep | kTerminated | kFailed, "fmi2GetStatus");
  return fmi2Discard; /* steps end before they return */
}
FMI2_Export fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind s, fmi2Real* value) {
  ALLOW(kStep | kTerminated | kFailed, "fmi2GetRealStatus");
  if (s != fmi2LastSuccessfulTime) return fmi2Discard;
  *value = ((instance*)c)->saved[kTime];
  return fmi2OK;
}
FMI2_Export fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind s, fmi2Integer* value) {
  (void)s, (void)value;
  ALLOW(kStep | kTerminated | kFailed, "fmi2GetIntegerStatus");
  return fmi2Discard;
}
FMI2_Export fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind s, fmi2Boolean* value) {
  ALLOW(kStep | kTerminated | kFailed, "fmi2GetBooleanStatus");
  if (s != fmi2Terminated) return fmi2Discard;
  *value = ((instance*)c)->mode == kTerminated;
  return fmi2OK;
}
FMI2_Export fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind s, fmi2String* value) {
  (void)s, (void)value;
  ALLOW(kStep | kTerminated | kFailed, "fmi2GetStringStatus");
  return fmi2Discard;
}
