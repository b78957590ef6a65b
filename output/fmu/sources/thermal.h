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

/* e^{-x}, (1 - e^{-x}) / x and (1 - (1 - e^{-x}) / x) / x: what a mode keeps of itself over a step, and of a constant and of a rising
 * load, x = lambda h >= 0. */
void decay_of(double x, double* kept, double* of_constant, double* of_slope);

/* The scenario's ambient over the reference [K]; the first knot behind a time, or infinity. */
double ambient_by_scenario_K(double time_s);
double next_ambient_knot_s(double time_s);

/* K of the drive, n x n, and what loads z beside the ambient and per kelvin of it. */
void thermal_matrix(const double* coefficient, double* matrix);
void thermal_loads(const double* coefficient, const double* power_W, double* constant_W, double* per_ambient_W_K);

#endif
