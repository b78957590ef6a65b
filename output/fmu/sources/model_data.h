/* What one exported model is made of: the tables of model_data.c, which the export writes. Everything else here is the same
 * in every unit. SI and kelvin inside; what the importer sees is in the units of modelDescription.xml. Driftwright's own
 * build defines DRIFTWRIGHT_NUMBERS_ARE_READ: a binary for all units, whose tables are read when it is loaded. */
#ifndef DRIFTWRIGHT_MODEL_DATA_H
#define DRIFTWRIGHT_MODEL_DATA_H

#include "observer_filter.h"
#include "probe_feedback.h"

/* A law of one variable x >= 0 of the drive: 0 at x = 0, and behind it a polynomial of log x in Chebyshev's form in each
 * piece. Below the first piece it is what it is at the piece's beginning. */
typedef struct {
  int variable; /* index of the drive */
  int n_pieces;
  int degree;
  const double* log_x;        /* ends of the pieces, n_pieces + 1 */
  const double* coefficients; /* n_pieces rows of degree + 1 */
} law_term;

/* A power or a coefficient over the drive: what it is at rest, and a term for each variable that it looks at. */
typedef struct {
  double at_rest;
  int n_terms;
  const law_term* terms;
} drive_law;

/* A power or a coefficient that follows temperatures as well: a formula (formula.h) of the drive and of its probes, which
 * are mean temperatures in K: weights' z + ambient_share ambient + offset_K. Of a source it is the power, whose drive_law
 * is 0; of an exchange it is the coefficient, whose drive_law is what the formula gives at the temperatures of the start. */
typedef struct {
  int source, exchange; /* index of the one that it belongs to; the other is -1 */
  int n_steps;
  const double* steps; /* n_steps pairs; names are indices of the drive, then of the probes */
  int n_probes;
  const double* weights; /* n_probes rows */
  const double* ambient_share;
  const double* offset_K;
} live_law;

/* The power of a source or the coefficient of an exchange by a formula (formula.h) of several variables of the drive. Its
 * drive_law is 0. */
typedef struct {
  int source, exchange; /* index of the one that it belongs to; the other is -1 */
  int n_steps;
  const double* steps; /* n_steps pairs; names are indices of the drive */
} drive_formula;

/* What an output has of the place of an axis, which is a variable x of the drive: cubics' (z, ambient), cubics = c0 + c1 t +
 * c2 t^2 + c3 t^3 with t from the beginning of the piece that x is in. */
typedef struct {
  int output, variable;
  int n_pieces;
  const double* ends;   /* n_pieces + 1 */
  const double* cubics; /* of each piece four rows of n + 1 */
} output_along;

/* A switch with hysteresis as a row of doubles: on above one temperature, off below another, both in K, of the probe
 * weights' z + ambient_share ambient + offset_K; the weights follow. It switches sources. */
enum { kOnAbove, kOffBelow, kAmbientShare, kProbeOffset, kProbeWeights };

/* dz/dt = -K z + f, M = 1: K = K0 + sum c_e G_e, f = f0 + ambient h0 + sum P_s b_s + sum c_e (ambient g_e + o_e). Matrices
 * by rows. */
typedef struct {
  int n, n_drive, n_sources, n_exchanges, n_outputs;
  const double* conduction;    /* K0 */
  const double* constant_load; /* f0 */
  const double* ambient_load;  /* h0 */
  const double* loads;         /* b_s, n_sources rows */
  const drive_law* powers;
  const double* exchanges;  /* G_e, n_exchanges matrices */
  const double* to_ambient; /* g_e, n_exchanges rows */
  const double* offsets;    /* o_e, n_exchanges rows */
  const drive_law* coefficients;
  const double* outputs; /* n_outputs + n_first rows: y = outputs z + outputs_ambient ambient */
  const double* outputs_ambient;
  const double* output_factor; /* what is told is factor y + offset */
  const double* output_offset;
  const double* start; /* z at the start in the ambient start_ambient_K */
  const double* ones;  /* z of 1 K everywhere */
  double start_ambient_K;
  int start_follows_ambient; /* a start in a warmer ambient is as much warmer */
  double reference_degC;     /* ambient temperatures count from here */
  int n_ambient;             /* knots of the scenario's ambient, linear between them and constant outside */
  const double* ambient_time_s;
  const double* ambient_K;
  const double* most_drive; /* of each variable of the drive, for which the model was reduced */
  const double* nominal;    /* of each state */
  int n_known;              /* sets of the drive whose decompositions are made ahead */
  const double* known_drive;
  int n_live; /* laws that follow temperatures; 0: the machine is linear */
  const live_law* live;
  const double* least_drive; /* of each variable of the drive: 0 but for places */
  int n_formulas;
  const drive_formula* formulas;
  int n_along;
  const output_along* along; /* n_along, then n_along_first */
  int n_thermostats;
  const double* thermostats;   /* rows of kProbeWeights + n */
  const double* switched_by;   /* of each source: its thermostat plus 1; 0: none */
  int n_first, n_along_first;  /* so many of the last states begin with what the rows after those of the outputs give then */
  int n_direct;                /* what outputs have of the drive at once */
  const double* direct_output; /* their indices */
  const drive_law* direct;
} thermal_data;

/* Of an observer alone (observer.c); otherwise all zero. */
typedef struct {
  int n_sensors;
  const int* sensor_output; /* of each sensor, index of the output that it reads */
  int drift_output;
  observer_settings settings;      /* period_s: from sample to sample */
  const double* factor_mean;       /* of the sources, the exchanges and the drift, minus 1 */
  const double* factor_covariance; /* by rows */
  int takes_probings;              /* 1: `probing` is known */
  probe_process probing;           /* of what the observer leaves */
} observer_data;

#ifdef DRIFTWRIGHT_NUMBERS_ARE_READ
#define CONSTANT
#else
#define CONSTANT const
#endif
extern const char* CONSTANT model_guid;
extern CONSTANT thermal_data thermal;
extern CONSTANT observer_data observer;

#endif
