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

#define F(name) fmi2##name
#define EXPORT FMI2_Export
#define HANDLE fmi2Component
#define REAL fmi2Real
#define STATE(verb) fmi2##verb##FMUstate
#define STATE_TYPE fmi2FMUstate
#define STATE_SIZE fmi2SerializedFMUstateSize
#define DESERIALIZE fmi2DeSerializeFMUstate
#define GET_RATES fmi2GetDerivatives
#include "fmi_shared.h"

FMI2_Export const char* fmi2GetTypesPlatform(void) {
  return fmi2TypesPlatform;
}
FMI2_Export const char* fmi2GetVersion(void) {
  return fmi2Version;
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

FMI2_Export fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean toleranceDefined, fmi2Real tolerance,
                                           fmi2Real startTime, fmi2Boolean stopTimeDefined, fmi2Real stopTime) {
  (void)toleranceDefined, (void)tolerance, (void)stopTimeDefined, (void)stopTime;
  ALLOW(kInstantiated, fmi2SetupExperiment);
  return (fmi2Status)instance_set_time(c, startTime);
}
FMI2_Export fmi2Status fmi2EnterInitializationMode(fmi2Component c) {
  ALLOW(kInstantiated, fmi2EnterInitializationMode);
  return (fmi2Status)instance_enter_initialization(c, ((instance*)c)->saved[kTime]);
}

FMI2_Export fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2Real value[]) {
  ALLOW(kReadable, fmi2GetReal);
  return (fmi2Status)instance_get(c, vr, nvr, value);
}
FMI2_Export fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, const fmi2Real value[]) {
  ALLOW(kInstantiated | kInitialization | kRunning, fmi2SetReal);
  return (fmi2Status)instance_set(c, vr, nvr, value);
}
FMI2_Export fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2Boolean value[]) {
  size_t k;
  ALLOW(kReadable, fmi2GetBoolean);
  for (k = 0; k < nvr; ++k) {
    const int status = instance_get_flag(c, vr[k], &value[k]);
    if (status != kOk) return (fmi2Status)status;
  }
  return fmi2OK;
}
FMI2_Export fmi2Status fmi2SetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                                      const fmi2Boolean value[]) {
  size_t k;
  ALLOW(kInstantiated | kInitialization | kRunning, fmi2SetBoolean);
  for (k = 0; k < nvr; ++k) {
    const int status = instance_set_flag(c, vr[k], value[k] != fmi2False);
    if (status != kOk) return (fmi2Status)status;
  }
  return fmi2OK;
}

/* There are no integers and strings: asked for none of them, all is well. */
static fmi2Status none_of_these(fmi2Component c, size_t n, const char* call) {
  if (!instance_allows(c, kAnyMode, call)) return fmi2Error;
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

FMI2_Export fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknowns[], size_t nUnknown,
                                                    const fmi2ValueReference knowns[], size_t nKnown,
                                                    const fmi2Real dvKnown[], fmi2Real dvUnknown[]) {
  ALLOW(kInitialization | kRunning | kTerminated, fmi2GetDirectionalDerivative);
  return (fmi2Status)instance_sensitivity(c, unknowns, nUnknown, knowns, nKnown, dvKnown, dvUnknown);
}

/* Model exchange. */
FMI2_Export fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo* info) {
  ALLOW(kEvent, fmi2NewDiscreteStates);
  memset(info, 0, sizeof *info);
  return (fmi2Status)instance_event(c, &info->nextEventTimeDefined, &info->nextEventTime);
}

/* Co-simulation. */
FMI2_Export fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                                                   const fmi2Integer order[], const fmi2Real value[]) {
  ALLOW(kInstantiated | kInitialization | kStep, fmi2SetRealInputDerivatives);
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
  ALLOW(kStep, fmi2DoStep);
  return (fmi2Status)instance_step(c, currentCommunicationPoint, communicationStepSize);
}
FMI2_Export fmi2Status fmi2CancelStep(fmi2Component c) {
  ALLOW(kStep, fmi2CancelStep);
  return (fmi2Status)instance_tell(c, kError, "no step runs in the background");
}
FMI2_Export fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind s, fmi2Status* value) {
  (void)s, (void)value;
  ALLOW(kStep | kTerminated | kFailed, fmi2GetStatus);
  return fmi2Discard; /* steps end before they return */
}
FMI2_Export fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind s, fmi2Real* value) {
  ALLOW(kStep | kTerminated | kFailed, fmi2GetRealStatus);
  if (s != fmi2LastSuccessfulTime) return fmi2Discard;
  *value = ((instance*)c)->saved[kTime];
  return fmi2OK;
}
FMI2_Export fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind s, fmi2Integer* value) {
  (void)s, (void)value;
  ALLOW(kStep | kTerminated | kFailed, fmi2GetIntegerStatus);
  return fmi2Discard;
}
FMI2_Export fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind s, fmi2Boolean* value) {
  ALLOW(kStep | kTerminated | kFailed, fmi2GetBooleanStatus);
  if (s != fmi2Terminated) return fmi2Discard;
  *value = ((instance*)c)->mode == kTerminated;
  return fmi2OK;
}
FMI2_Export fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind s, fmi2String* value) {
  (void)s, (void)value;
  ALLOW(kStep | kTerminated | kFailed, fmi2GetStringStatus);
  return fmi2Discard;
}
