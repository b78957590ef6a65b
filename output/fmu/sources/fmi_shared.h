/* The functions that both versions of the standard have with the same parameters. fmi2.c and fmi3.c include this after
 * F(name), a name with the version's prefix, EXPORT, HANDLE, REAL, and the names that differ by a letter: STATE(verb),
 * STATE_TYPE, STATE_SIZE, DESERIALIZE and GET_RATES. */
#define TEXT_OF(name) #name
#define TEXT(name) TEXT_OF(name)
#define ALLOW(modes, name) \
  if (!instance_allows(c, modes, TEXT(name))) return F(Error)
/* A function with the parameters after the handle, which returns what instance.h says. */
#define SHARED(name, modes, parameters, call)  \
  EXPORT F(Status) name(HANDLE c parameters) { \
    ALLOW(modes, name);                        \
    return (F(Status))(call);                  \
  }
#define AND ,

static int go_to(instance* in, instance_mode mode) {
  in->mode = mode;
  return kOk;
}

EXPORT F(Status) F(SetDebugLogging)(HANDLE c, F(Boolean) loggingOn, size_t nCategories, const F(String) categories[]) {
  (void)nCategories, (void)categories;
  ALLOW(kAnyMode, F(SetDebugLogging));
  ((instance*)c)->is_logging = loggingOn != F(False);
  return F(OK);
}
EXPORT void F(FreeInstance)(HANDLE c) {
  instance_free(c);
}
SHARED(F(ExitInitializationMode), kInitialization, , instance_exit_initialization(c))
SHARED(F(EnterEventMode), kContinuousTime | kEvent, , go_to(c, kEvent))
SHARED(F(EnterContinuousTimeMode), kEvent, , go_to(c, kContinuousTime))
SHARED(F(Terminate), kRunning, , go_to(c, kTerminated))
SHARED(F(Reset), kAnyMode, , instance_reset(c))

SHARED(F(SetTime), kEvent | kContinuousTime, AND REAL time, instance_set_time(c, time))
SHARED(F(SetContinuousStates), kContinuousTime | kEvent, AND const REAL states[] AND size_t n,
       instance_set_states(c, states, n))
SHARED(F(GetContinuousStates), kReadable, AND REAL states[] AND size_t n, instance_get_states(c, states, n))
SHARED(GET_RATES, kReadable, AND REAL rates[] AND size_t n, instance_get_derivatives(c, rates, n))
SHARED(F(GetNominalsOfContinuousStates), kAnyMode, AND REAL nominals[] AND size_t n, instance_get_nominals(c, nominals, n))
SHARED(F(GetEventIndicators), kReadable, AND REAL indicators[] AND size_t n, instance_get_indicators(c, indicators, n))
EXPORT F(Status) F(CompletedIntegratorStep)(HANDLE c, F(Boolean) noSetPriorToCurrentPoint, F(Boolean) * enterEventMode,
                                            F(Boolean) * terminateSimulation) {
  (void)noSetPriorToCurrentPoint;
  ALLOW(kContinuousTime, F(CompletedIntegratorStep));
  *enterEventMode = *terminateSimulation = F(False);
  return F(OK);
}

SHARED(STATE(Get), kAnyMode, AND STATE_TYPE* state, instance_keep_state(c, state))
SHARED(STATE(Set), kAnyMode, AND STATE_TYPE state, instance_restore_state(c, state))
SHARED(STATE(Free), kAnyMode, AND STATE_TYPE* state, instance_free_state(c, state))
SHARED(STATE(Serialize), kAnyMode, AND STATE_TYPE state AND F(Byte) bytes[] AND size_t size,
       instance_write_state(c, state, bytes, size))
SHARED(DESERIALIZE, kAnyMode, AND const F(Byte) bytes[] AND size_t size AND STATE_TYPE* state,
       instance_read_state(c, bytes, size, state))
EXPORT F(Status) STATE_SIZE(HANDLE c, STATE_TYPE state, size_t* size) {
  (void)state;
  ALLOW(kAnyMode, STATE_SIZE);
  *size = instance_state_bytes();
  return F(OK);
}
