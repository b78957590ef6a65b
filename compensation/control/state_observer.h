/* A state observer during a run: the reduced machine and factors on its heat flows, corrected by thermometers row by row. It
 * judges which readings it uses, when it drops a sensor and takes it back, and how far its model is to be trusted. This very
 * file is compiled into Driftwright (compensation/predictors/observer.hpp says what it is for) and into functional mock-up
 * units. C99; it needs <math.h> alone and allocates nothing: what a run remembers is one array of doubles of the caller,
 * another one is room for computing.
 *
 * - A sensor whose mean innovation (of about ten rows) is beyond five deviations is dropped, and the filter returns to its
 *   state of 30 rows before and follows them without it. If other sensors still differ then, the model is wrong: the sensor
 *   is used again.
 * - A sensor that agrees again for 8 h, while temperatures move by more than a stuck one could agree with, is used again.
 * - Readings that are together further from the model than most_apart correct less, and trust decreases as much.
 * - An ambient that jumps by more than 3 K from row to row (for rows more than 10 min apart: in 10 min) is held at its old
 *   value until it returns, or until the other sensors agree better with what its thermometer has shown since.
 * - In a gap between rows the drive is unknown: the state becomes less certain by all that the heat sources may have done.
 */
#ifndef DRIFTWRIGHT_STATE_OBSERVER_H
#define DRIFTWRIGHT_STATE_OBSERVER_H

#include "observer_filter.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Rows up to the one taken that may be asked for again (observer_rows), with the time and ambient of the one before them;
 * rows that a mean innovation remembers: before, and until a sensor is tried again, it says nothing new. */
enum { kObserverRowsBack = 30, kObserverRowsWarm = 10 };

/* What an observer is made of. */
typedef struct {
  observer_machine machine;
  observer_settings settings;
  int n_outputs;
  const double* outputs;         /* n_outputs rows of n: K, m, rad per unit of each state */
  const double* outputs_ambient; /* K, m, rad per kelvin of the ambient */
  double reference_degC;         /* ambient temperatures and states count from here */
  const double* start; /* z at the start of every run in the ambient start_ambient_K; as much warmer in a warmer one */
  double start_ambient_K;
  int n_sensors;
  const int* sensor_output; /* of each sensor, index of the output in K that it reads */
  int drift_output;
  const double* factor_mean;       /* learned of the sources, the exchanges and the drift, minus 1 */
  const double* factor_covariance; /* by rows */
  const double* rest_W;            /* power of each source at rest */
  int with_drift;                  /* the drift is measured, and factors are learned from it */
  int keeps_all;                   /* no sensor is dropped */
} state_observer;

/* The rows of a run, as the caller knows them. */
typedef struct {
  void* of;
  double (*time_s)(void* of, long row);
  /* As its thermometer shows it, above the reference [K]. @param t_s  between the row before and this row, or its time */
  double (*ambient_K)(void* of, long row, double t_s);
  double (*reading_C)(void* of, long row, int sensor); /* NaN: none */
  double (*drift_um)(void* of, long row);              /* as measured; NaN: none. Null where it never is */
  /* Until when the drive of piece 0, 1, ... is constant; pieces that ended before the row before count. Returns 0 after the
   * last one. */
  int (*piece)(void* of, long row, int piece, double* until_s);
  /* Powers and coefficients of this piece from a time on. Returns 0, or what observer_next() then returns. */
  int (*laws)(void* of, long row, int piece, double from_s, double ambient_K, double* power_W, double* coefficient);
} observer_rows;

/* How long something has agreed with what is expected, and over which expected temperatures: a sensor that is stuck agrees
 * only as long as nothing moves. Temperatures are means over as many rows as the innovations that agree. */
typedef struct {
  double agreed_s;      /* in rows with a reading; < 0: it does not */
  double mean_C;        /* NaN: no row yet */
  double low_C, high_C; /* of mean_C */
} observer_agreement;

/* What is remembered; doubles alone, so that all of it is one array. */
typedef struct {
  double row; /* rows taken */
  double start_s, now_s, start_ambient_K;
  double usual_step_s; /* between rows: the longest of the last ones */
  double is_model_wrong;
  double again_row;              /* from which on a sensor may be dropped again */
  double means_from;             /* row from which the mean innovations count */
  double doubted_row, doubted_s; /* where doubt of the ambient began, or was last found justified; when it began */
  double n_history;
  double first_drift_row; /* < 0: none */
  double drift_zero_m, last_drift_s;
  observer_agreement model;
} observer_memory;
typedef struct {
  double is_live, dropped_s; /* s: NaN if it is live */
  double mean_innovation;    /* in deviations */
  double last_s;             /* of the last reading that counts; NaN: none */
  observer_agreement agreement;
} observer_sensor;
typedef struct {
  double last_s; /* NaN: none */
  double spread_K;
  double deviation_K;  /* from the expected reading; NaN: no reading in this row */
  double innovation_K; /* the same, at most six deviations; NaN also for a sensor that is dropped */
  double sees_state;   /* 0: of a thermometer of the ambient alone, which says nothing of the model */
  double returns;      /* has agreed for long enough to be used again */
} observer_reading;

/* A run: pointers to all that it is made of. */
typedef struct {
  const state_observer* of;
  observer_filter filter;
  observer_memory* memory;
  observer_sensor* sensors;
  observer_reading* readings;
  double *ambient_K, *is_doubted; /* of the last rows */
  double* history;                /* what the filter believed before each of the last rows */
  double *kept, *gradient;
} observer_run;

enum { kObserverNotDecomposed = 1 };

/* Numbers that a run remembers, and that it needs as room. @param n_steps, n_modes  as observer_filter_n_room() */
size_t observer_n_remembered(const state_observer* of);
size_t observer_n_room(const state_observer* of, int n_steps, int n_modes);
/* The run in these arrays. It borrows all of its arguments. */
observer_run observer_run_in(const state_observer* of, double* remembered, double* room, int n_steps, int n_modes);
/* Before the first use of a room. */
void observer_clear_room(const observer_run* run);
/* Before the first row. */
void observer_start(const observer_run* run);
/* Takes the next row. Returns 0, kObserverNotDecomposed or what observer_rows.laws() returned; the run cannot go on then. */
int observer_next(const observer_run* run, const observer_rows* rows);
/* After a start, where the caller has set what another run remembered: the ambient of its last row, as used. */
void observer_recall_ambient(const observer_run* run, double ambient_K, int is_doubted);

/* Of the last row. @{ */
double observer_drift_um(const observer_run* run);     /* actual - commanded since the start of the run */
double observer_deviation_um(const observer_run* run); /* its standard deviation by the filter */
double observer_ambient_K(const observer_run* run);    /* as used */
int observer_doubts_ambient(const observer_run* run);
/* Without a reading for so long that it says nothing of the present state. */
int observer_is_silent(const observer_run* run, int sensor);
/* Distance of the active sensors from the model, relative to the distance that chance exceeds in one of a thousand rows: the
 * sum of squares of their mean innovations, chi-squared if the model is right, without the worst of them while it may be the
 * sensor's own fault. */
double observer_apart(const observer_run* run);
/* 0 to 1; 1 without any sensor to compare with. */
double observer_trust(const observer_run* run);
/* All outputs of the model in the estimated state, in K, m, rad. */
void observer_outputs(const observer_run* run, double* outputs);
/* @} */

#ifdef __cplusplus
}
#endif

#endif
