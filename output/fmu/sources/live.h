/* Laws that follow temperatures: what they add to the system of thermal.h, and steps through time with them.
 *
 * In the modes of K, as the drive and the temperatures of the start make it, each mode obeys m' = -lambda m + N, where N
 * is the load and what the laws differ by. Over a step N is the parabola through its values at the beginning, the middle
 * and the end, which are iterated; then the step is exact (Hochbruck & Ostermann, Acta Numerica 19 (2010) 209-286:
 * exponential collocation). By how much N leaves the parabola at three quarters of the step estimates the error, and with
 * it the length of the next step. */
#ifndef DRIFTWRIGHT_LIVE_H
#define DRIFTWRIGHT_LIVE_H

#include <stddef.h>

#include "model_data.h"

/* The system that the laws are added to, under one drive. */
typedef struct {
  const double* drive;
  const double* coefficient;                  /* of each exchange, as K has it */
  const double *lambda, *vectors;             /* K in its eigenvectors, by rows */
  const double *constant_W, *per_ambient_W_K; /* what loads each mode beside the laws, and per kelvin of the ambient */
  const double *probes_in_modes, *is_on;      /* of each thermostat (switches.h) */
} live_system;

typedef struct live_room live_room;

/* Room for all that follows; bytes, and set up in them. */
size_t live_room_size(void);
live_room* live_prepare(void* bytes);
/* There is something else now where a system's lambda was. */
void live_forget(live_room* room);

/* rate += what the laws add to dz/dt at z. Returns 0, or 1 where one has no value. */
int live_add_rate(live_room* room, const double* drive, const double* coefficient, const double* z, double ambient_K,
                  double* rate);
/* rate += how that changes along dz, d_ambient and, of one variable of the drive, seed; which < 0: of none. */
void live_add_slope(live_room* room, const double* drive, const double* coefficient, const double* z, double ambient_K,
                    const double* dz, double d_ambient_K, int which, double seed, double* rate);

/* Steps z over *piece_s with an ambient that goes from ambient_K on at ambient_K_s, or up to where a thermostat switches:
 * then *which is its index and *piece_s how long that took; else *which is -1. *length_s: the length of a step that fits,
 * before and after. Returns 0, or what is wrong in words. */
const char* live_advance(live_room* room, const live_system* system, double* piece_s, double ambient_K, double ambient_K_s,
                         double* z, double* length_s, int* which);

#endif
