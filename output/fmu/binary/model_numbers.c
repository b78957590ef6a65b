/* The tables of model_data.h in the binary of a unit, which is compiled before the unit is known. The export writes the
 * numbers at the end of the binary's file (model_numbers() in model_data.cpp): numbers of eight bytes, their count, and a
 * mark of eight characters. They are read when the binary is loaded, before any function of the interface is called. Without
 * them model_guid stays empty, and no instance is made. */
#define _GNU_SOURCE
#include <link.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model_data.h"

static const char kMark[8] = {'D', 'w', 'N', 'u', 'm', 'b', 'e', 'r'};

const char* model_guid = "";
thermal_data thermal;
observer_data observer;

static double* numbers; /* all of them; the tables point into it */
static drive_law *powers, *coefficients, *direct;
static live_law* live;
static drive_formula* formulas;
static output_along* along;
static int* sensor_output;

/* What has not been taken yet. `left` below 0: there was less than the counts say. */
typedef struct {
  const double* at;
  long left;
} reader;

static const double* list(reader* r, long n) {
  static const double zero = 0.0; /* as an empty list of model_data.c */
  const double* const taken = r->at;
  if (n == 0) return &zero;
  r->left = n < 0 || n > r->left ? -1 : r->left - n;
  if (r->left < 0) return &zero;
  r->at += n;
  return taken;
}
static double number(reader* r) {
  return *list(r, 1);
}
static int count(reader* r) {
  return (int)number(r);
}

static void free_laws(drive_law* laws, int n) {
  int k;
  for (k = 0; laws && k < n; ++k) free((void*)laws[k].terms);
  free(laws);
}

/* n laws of the drive, or null. */
static drive_law* laws(reader* r, int n) {
  drive_law* const all = calloc((size_t)n + 1, sizeof *all);
  int k, t;
  for (k = 0; all && k < n && r->left >= 0; ++k) {
    law_term* terms;
    all[k].at_rest = number(r);
    all[k].n_terms = count(r);
    terms = r->left < all[k].n_terms ? 0 : calloc((size_t)all[k].n_terms + 1, sizeof *terms);
    all[k].terms = terms;
    if (!terms) {
      free_laws(all, n);
      return 0;
    }
    for (t = 0; t < all[k].n_terms; ++t) {
      terms[t].variable = count(r);
      terms[t].n_pieces = count(r);
      terms[t].degree = count(r);
      terms[t].log_x = list(r, terms[t].n_pieces + 1L);
      terms[t].coefficients = list(r, (long)terms[t].n_pieces * (terms[t].degree + 1L));
    }
  }
  return all;
}

/* n laws that follow temperatures of a system of n_states; null if there is no memory or less than the counts say. */
static live_law* live_laws(reader* r, int n, int n_states) {
  live_law* const all = r->left < n ? 0 : calloc((size_t)n + 1, sizeof *all);
  int k;
  for (k = 0; all && k < n; ++k) {
    all[k].source = count(r);
    all[k].exchange = count(r);
    all[k].n_steps = count(r);
    all[k].steps = list(r, 2L * all[k].n_steps);
    all[k].n_probes = count(r);
    all[k].weights = list(r, (long)all[k].n_probes * n_states);
    all[k].ambient_share = list(r, all[k].n_probes);
    all[k].offset_K = list(r, all[k].n_probes);
  }
  return all;
}

static drive_formula* formulas_of(reader* r, int n) {
  drive_formula* const all = r->left < n ? 0 : calloc((size_t)n + 1, sizeof *all);
  int k;
  for (k = 0; all && k < n; ++k) {
    all[k].source = count(r);
    all[k].exchange = count(r);
    all[k].n_steps = count(r);
    all[k].steps = list(r, 2L * all[k].n_steps);
  }
  return all;
}

static output_along* along_of(reader* r, int n, int n_states) {
  output_along* const all = r->left < n ? 0 : calloc((size_t)n + 1, sizeof *all);
  int k;
  for (k = 0; all && k < n; ++k) {
    all[k].output = count(r);
    all[k].variable = count(r);
    all[k].n_pieces = count(r);
    all[k].ends = list(r, all[k].n_pieces + 1L);
    all[k].cubics = list(r, (long)all[k].n_pieces * 4L * (n_states + 1L));
  }
  return all;
}

/* Returns whether the tables are complete. */
static int take(reader* r, const char** guid) {
  const long guid_length = count(r);
  long n, m;
  int i;
  *guid = (const char*)list(r, guid_length / 8 + 1);
  n = thermal.n = count(r);
  thermal.n_drive = count(r);
  thermal.n_sources = count(r);
  thermal.n_exchanges = count(r);
  thermal.n_outputs = count(r);
  thermal.n_first = count(r);
  m = thermal.n_outputs + thermal.n_first;
  thermal.conduction = list(r, n * n);
  thermal.constant_load = list(r, n);
  thermal.ambient_load = list(r, n);
  thermal.loads = list(r, thermal.n_sources * n);
  if (r->left < 0 || !(thermal.powers = powers = laws(r, thermal.n_sources))) return 0;
  thermal.exchanges = list(r, thermal.n_exchanges * n * n);
  thermal.to_ambient = list(r, thermal.n_exchanges * n);
  thermal.offsets = list(r, thermal.n_exchanges * n);
  if (r->left < 0 || !(thermal.coefficients = coefficients = laws(r, thermal.n_exchanges))) return 0;
  thermal.outputs = list(r, m * n);
  thermal.outputs_ambient = list(r, m);
  thermal.output_factor = list(r, thermal.n_outputs);
  thermal.output_offset = list(r, thermal.n_outputs);
  thermal.start = list(r, n);
  thermal.ones = list(r, n);
  thermal.start_ambient_K = number(r);
  thermal.start_follows_ambient = count(r);
  thermal.reference_degC = number(r);
  thermal.n_ambient = count(r);
  thermal.ambient_time_s = list(r, thermal.n_ambient);
  thermal.ambient_K = list(r, thermal.n_ambient);
  thermal.most_drive = list(r, thermal.n_drive);
  thermal.nominal = list(r, n);
  thermal.n_known = count(r);
  thermal.known_drive = list(r, (long)thermal.n_known * thermal.n_drive);
  thermal.n_live = count(r);
  if (r->left < 0 || !(thermal.live = live = live_laws(r, thermal.n_live, thermal.n))) return 0;
  thermal.least_drive = list(r, thermal.n_drive);
  thermal.n_formulas = count(r);
  if (r->left < 0 || !(thermal.formulas = formulas = formulas_of(r, thermal.n_formulas))) return 0;
  thermal.n_along = count(r);
  thermal.n_along_first = count(r);
  if (r->left < 0 || !(thermal.along = along = along_of(r, thermal.n_along + thermal.n_along_first, thermal.n))) return 0;
  thermal.n_thermostats = count(r);
  thermal.thermostats = list(r, thermal.n_thermostats * (kProbeWeights + n));
  thermal.switched_by = list(r, thermal.n_sources);
  thermal.n_direct = count(r);
  thermal.direct_output = list(r, thermal.n_direct);
  if (r->left < 0 || !(thermal.direct = direct = laws(r, thermal.n_direct))) return 0;
  if (count(r)) {
    const long f = thermal.n_sources + thermal.n_exchanges + 1L;
    const double* of;
    observer.n_sensors = count(r);
    of = list(r, observer.n_sensors);
    if (r->left < 0 || !(sensor_output = calloc((size_t)observer.n_sensors + 1, sizeof *sensor_output))) return 0;
    for (i = 0; i < observer.n_sensors; ++i) sensor_output[i] = (int)of[i];
    observer.sensor_output = sensor_output;
    observer.drift_output = count(r);
    observer.settings.reading_K = number(r);
    observer.settings.model_K = number(r);
    observer.settings.drift_um = number(r);
    observer.settings.model_um = number(r);
    observer.settings.model_holds_s = number(r);
    observer.settings.factor = number(r);
    observer.settings.factor_walk = number(r);
    observer.settings.longest_step_s = number(r);
    observer.settings.period_s = number(r);
    observer.settings.most_apart = number(r);
    observer.factor_mean = list(r, f);
    observer.factor_covariance = list(r, f * f);
    observer.takes_probings = count(r);
    observer.probing.deviation_um = number(r);
    observer.probing.time_constant_s = number(r);
    observer.probing.noise_um = number(r);
    observer.probing.lag_s = number(r);
    observer.probing.is_known_at_start = count(r);
  }
  return r->left == 0;
}

/* The numbers at the end of a file, or null. */
static double* numbers_of(FILE* file, long* n) {
  double tail[2];
  double* all = 0;
  if (fseek(file, -(long)sizeof tail, SEEK_END) != 0 || fread(tail, sizeof tail, 1, file) != 1) return 0;
  if (memcmp(&tail[1], kMark, sizeof kMark) != 0 || !(tail[0] >= 1.0 && tail[0] <= 1e9)) return 0;
  *n = (long)tail[0];
  if (fseek(file, -(long)sizeof tail - *n * (long)sizeof *all, SEEK_END) != 0) return 0;
  all = malloc((size_t)*n * sizeof *all);
  if (all && fread(all, sizeof *all, (size_t)*n, file) != (size_t)*n) {
    free(all);
    all = 0;
  }
  return all;
}

/* Whether a loaded file is the one that this code is in; if so, *found is its path. */
static int is_own(struct dl_phdr_info* loaded, size_t size, void* found) {
  const ElfW(Addr) own = (ElfW(Addr)) & thermal;
  int i;
  (void)size;
  for (i = 0; i < loaded->dlpi_phnum; ++i) {
    const ElfW(Addr) begin = loaded->dlpi_addr + loaded->dlpi_phdr[i].p_vaddr;
    if (loaded->dlpi_phdr[i].p_type == PT_LOAD && own >= begin && own - begin < loaded->dlpi_phdr[i].p_memsz) {
      *(const char**)found = loaded->dlpi_name;
      return 1;
    }
  }
  return 0;
}

__attribute__((constructor)) static void read_numbers(void) {
  const char *path = 0, *guid = 0;
  reader r = {0, 0};
  FILE* file;
  if (!dl_iterate_phdr(is_own, &path)) return;
  file = fopen(path, "rb");
  if (!file) return;
  numbers = numbers_of(file, &r.left);
  fclose(file);
  r.at = numbers;
  if (numbers && take(&r, &guid)) model_guid = guid;
}

__attribute__((destructor)) static void free_numbers(void) {
  free_laws(powers, thermal.n_sources);
  free_laws(coefficients, thermal.n_exchanges);
  free_laws(direct, thermal.n_direct);
  free(live);
  free(formulas);
  free(along);
  free(sensor_output);
  free(numbers);
}
