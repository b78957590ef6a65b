/* Thermostats: which of them switches next, and when.
 *
 * Up to then each mode obeys m' = -lambda m + a + b t + c t^2, so that the temperature of a probe, its slope and its
 * bend are known in closed form. In a mode the bend w obeys w' = -lambda w + 2 c: later it is at most |w| + 2 |c| min(1 /
 * lambda, time), whatever its sign. With the sum M of these bounds the probe stays below its switching temperature as long
 * as the parabola of slope and bend M does. From its root the search goes on: no crossing is passed over, however long
 * the step is. */
#ifndef DRIFTWRIGHT_SWITCHES_H
#define DRIFTWRIGHT_SWITCHES_H

typedef struct {
  const double *lambda, *modes; /* the modes at t = 0 */
  const double *a, *b, *c;      /* of each mode; c may be null: 0 */
  const double* in_modes;       /* the weights of each thermostat's probe in the modes */
  const double* is_on;          /* of each thermostat: 0 or 1 */
  double ambient_K, ambient_K_s;
} mode_course;

/* By how much a probe of this temperature is short of its next switch (< 0) or beyond it [K]. */
double beyond_switch_K(int thermostat, double is_on, double probe_K);
/* How near to the switching temperature counts as there [K]. */
extern const double kSwitchReached_K;
/* The temperature of a probe at a state. */
double thermostat_probe_K(int thermostat, const double* z, double ambient_K);

/* The first thermostat that switches from 0 to h_s, and then *at_s; -1: none, and *at_s is as before. */
int first_switch(const mode_course* course, double h_s, double* at_s);
/* The modes at t_s. */
void modes_at(const mode_course* course, double t_s, double* modes);

#endif
