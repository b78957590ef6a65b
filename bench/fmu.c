/* What five hours of a functional mock-up unit cost: fmu LIBRARY GUID [STEP_S]. Prints the best of twenty runs over seven
 * speeds, as the cyclogram `chaotic` of the FP3 has them, outputs read at every step, and what an instance costs.
 * bench/fmu.sh */
#define _POSIX_C_SOURCE 200809L
#include <dlfcn.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "output/fmu/sources/fmi2_interface.h"

static void logger(fmi2ComponentEnvironment e, fmi2String name, fmi2Status status, fmi2String category, fmi2String message,
                   ...) {
  va_list arguments;
  (void)e, (void)name, (void)status, (void)category;
  va_start(arguments, message);
  vfprintf(stderr, message, arguments);
  va_end(arguments);
}
static double now_s(void) {
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}
static void* function(void* library, const char* name) {
  void* const f = dlsym(library, name);
  if (!f) exit(1);
  return f;
}
#define LOAD(type, name, ...) \
  type (*name)(__VA_ARGS__);  \
  *(void**)(&name) = function(library, #name)

int main(int argc, char** argv) {
  static const double speed_rpm[] = {1250, 2500, 500, 2000, 200, 1600, 800},
                      until_s[] = {2400, 4500, 7500, 10200, 12600, 15600, 18000};
  const double step_s = argc > 3 ? atof(argv[3]) : 60.0;
  void* const library = argc > 2 ? dlopen(argv[1], RTLD_NOW) : NULL;
  const fmi2CallbackFunctions callbacks = {logger, calloc, free, NULL, NULL};
  const fmi2ValueReference speed = 1000, output[] = {4014, 4015, 4016};
  double best_s = HUGE_VAL, best_start_s = HUGE_VAL, drift[3] = {0, 0, 0};
  int run;
  if (!library) {
    fprintf(stderr, "fmu LIBRARY GUID [STEP_S]\n");
    return 2;
  }
  LOAD(fmi2Component, fmi2Instantiate, fmi2String, fmi2Type, fmi2String, fmi2String, const fmi2CallbackFunctions*,
       fmi2Boolean, fmi2Boolean);
  LOAD(fmi2Status, fmi2EnterInitializationMode, fmi2Component);
  LOAD(fmi2Status, fmi2ExitInitializationMode, fmi2Component);
  LOAD(fmi2Status, fmi2SetReal, fmi2Component, const fmi2ValueReference*, size_t, const fmi2Real*);
  LOAD(fmi2Status, fmi2GetReal, fmi2Component, const fmi2ValueReference*, size_t, fmi2Real*);
  LOAD(fmi2Status, fmi2DoStep, fmi2Component, fmi2Real, fmi2Real, fmi2Boolean);
  LOAD(void, fmi2FreeInstance, fmi2Component);
  for (run = 0; run < 20; ++run) {
    double t_s = 0.0, began_s = now_s();
    fmi2Component c = fmi2Instantiate("bench", fmi2CoSimulation, argv[2], NULL, &callbacks, fmi2False, fmi2True);
    int section = 0, bad = 0;
    if (!c) return 1;
    bad |= fmi2EnterInitializationMode(c);
    bad |= fmi2ExitInitializationMode(c);
    best_start_s = fmin(best_start_s, now_s() - began_s);
    began_s = now_s();
    while (t_s < 18000.0 - 1e-6) {
      while (t_s >= until_s[section] - 1e-6) ++section;
      bad |= fmi2SetReal(c, &speed, 1, &speed_rpm[section]);
      bad |= fmi2DoStep(c, t_s, step_s, fmi2True);
      bad |= fmi2GetReal(c, output, 3, drift);
      t_s += step_s;
    }
    best_s = fmin(best_s, now_s() - began_s);
    fmi2FreeInstance(c);
    if (bad) return 1;
  }
  printf("5 h at %g s: %.3f ms of one thread, instantiation and start %.3f ms (drift_y at the end %.6f um)\n", step_s,
         1e3 * best_s, 1e3 * best_start_s, drift[1]);
  return 0;
}
