/* One instance of the unit, as both versions of the interface use it: values by reference, modes, states. Statuses are
 * numbered as in fmi2Status and fmi3Status. */
#ifndef DRIFTWRIGHT_INSTANCE_H
#define DRIFTWRIGHT_INSTANCE_H

#include <stddef.h>

enum { kOk = 0, kWarning = 1, kDiscard = 2, kError = 3 };

/* Value references, as modelDescription.xml has them. */
enum {
  kTimeReference = 0,
  kInputReference = 1000,
  kStartWarmerReference = 2000,
  kAmbientFromInputReference = 3000,
  kOutputReference = 4000,
  kStateReference = 10000,
  kDerivativeReference = 20000,
  kIsOnReference = 30000, /* of switches */
  kIndicatorReference = 40000
};

typedef enum {
  kInstantiated = 1,
  kInitialization = 2,
  kEvent = 4,
  kContinuousTime = 8,
  kStep = 16, /* between steps of co-simulation */
  kTerminated = 32,
  kFailed = 64
} instance_mode;
enum {
  kAnyMode = 127,
  kRunning = kEvent | kContinuousTime | kStep,
  kReadable = kInitialization | kRunning | kTerminated | kFailed
};

typedef struct instance instance;
struct instance {
  instance_mode mode;
  int is_co_simulation;
  int is_logging;
  void* environment;
  char name[128];
  /* Of the version: tells the importer. */
  void (*tell)(const instance*, int status, const char* message);
  void (*callback)(void); /* the importer's logger, of the version's type */
  void (*release)(void*);
  double* saved;
  void* scratch;
  double *outputs, *derivatives; /* room, and what was computed last */
  int has_outputs, has_derivatives;
  double *output_seeds, *derivative_seeds;
  double *is_on, *indicators; /* of switches */
};

/* allocate: as calloc. Returns null where there is no memory, or the guid is that of another unit. */
instance* instance_new(const char* name, const char* guid, int is_co_simulation, int is_logging, void* environment,
                       void (*tell)(const instance*, int, const char*), void (*callback)(void),
                       void* (*allocate)(size_t, size_t), void (*release)(void*));
void instance_free(instance* in);

/* Ends in kOk, or tells what is wrong and returns `status`; kError makes the instance fail. */
int instance_tell(instance* in, int status, const char* message);
/* Whether a call is allowed now. */
int instance_allows(instance* in, int modes, const char* call);

int instance_enter_initialization(instance* in, double start_s);
int instance_exit_initialization(instance* in);
int instance_reset(instance* in);

int instance_get(instance* in, const unsigned* references, size_t n, double* values);
int instance_set(instance* in, const unsigned* references, size_t n, const double* values);
int instance_set_input_rates(instance* in, const unsigned* references, size_t n, const int* orders, const double* values);
int instance_get_flag(instance* in, unsigned reference, int* value);
int instance_set_flag(instance* in, unsigned reference, int value);

int instance_set_time(instance* in, double time_s);
int instance_set_states(instance* in, const double* states, size_t n);
int instance_get_states(instance* in, double* states, size_t n);
int instance_get_derivatives(instance* in, double* derivatives, size_t n);
int instance_get_nominals(instance* in, double* nominals, size_t n);
int instance_get_indicators(instance* in, double* indicators, size_t n);
int instance_event(instance* in, int* has_next, double* next_s);
int instance_step(instance* in, double from_s, double h_s);
int instance_sensitivity(instance* in, const unsigned* unknowns, size_t n_unknowns, const unsigned* knowns, size_t n_knowns,
                         const double* seeds, double* sensitivities);

/* A kept state is one block: what state_bytes() says, the first of it a mark of the unit. */
size_t instance_state_bytes(void);
int instance_keep_state(instance* in, void** kept);
int instance_restore_state(instance* in, const void* kept);
int instance_free_state(instance* in, void** kept);
int instance_write_state(instance* in, const void* kept, void* bytes, size_t n_bytes);
int instance_read_state(instance* in, const void* bytes, size_t n_bytes, void** kept);

#endif
