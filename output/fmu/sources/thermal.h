/* The thermal system of model_data.h under one drive, and its exact solution over a step. */
#ifndef DRIFTWRIGHT_THERMAL_H
#define DRIFTWRIGHT_THERMAL_H

#include <stddef.h>

#include "model_data.h"

/* y = A x, rows x columns. */
void multiply(int rows, int columns, const double* matrix, const double* x, double* y);
/* y += A' x */
void add_transposed(int rows, int columns, const double* matrix, const double* x, double* y);

/* The law's value, and how it changes with one variable of the drive (at rest: 0). */
double law_value(const drive_law* law, const double* drive);
double law_slope(const drive_law* law, const double* drive, int variable);

/* The integrals of e^{-(t - s) lambda} s^k over s from 0 to t, k = 0, 1, 2: what a mode has at t of a load of 1, of one that
 * rises by 1 a second, and of one that rises with the square of time. */
void load_integrals(double t_s, double lambda, double* of_power);

/* The scenario's ambient over the reference [K]; the first knot behind a time, or infinity. */
double ambient_by_scenario_K(double time_s);
double next_ambient_knot_s(double time_s);

/* K of the drive, n x n, and what loads z beside the ambient and per kelvin of it. */
void thermal_matrix(const double* coefficient, double* matrix);
void thermal_loads(const double* coefficient, const double* power_W, double* constant_W, double* per_ambient_W_K);

#endif
