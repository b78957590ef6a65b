#include "switches.h"

#include <math.h>

#include "thermal.h"

const double kSwitchReached_K = 1e-9;

static const double* row_of(int thermostat) {
  return thermal.thermostats + (size_t)thermostat * (size_t)(kProbeWeights + thermal.n);
}

double thermostat_probe_K(int thermostat, const double* z, double ambient_K) {
  const double* const row = row_of(thermostat);
  double sum;
  multiply(1, thermal.n, row + kProbeWeights, z, &sum);
  return sum + row[kAmbientShare] * ambient_K + row[kProbeOffset];
}

double beyond_switch_K(int thermostat, double is_on, double probe_K) {
  const double* const row = row_of(thermostat);
  return is_on != 0.0 ? row[kOffBelow] - probe_K : probe_K - row[kOnAbove];
}

static double mode_at(const mode_course* m, int i, double t_s) {
  double of_power[3];
  load_integrals(t_s, m->lambda[i], of_power);
  return exp(-m->lambda[i] * t_s) * m->modes[i] + of_power[0] * m->a[i] + of_power[1] * m->b[i] +
         (m->c ? of_power[2] * m->c[i] : 0.0);
}

void modes_at(const mode_course* m, double t_s, double* modes) {
  int i;
  for (i = 0; i < thermal.n; ++i) modes[i] = mode_at(m, i, t_s);
}

/* When a thermostat switches, or infinity. */
static double switch_s(const mode_course* m, int thermostat, double h_s) {
  const double *const row = row_of(thermostat), *const weight = m->in_modes + (size_t)thermostat * (size_t)thermal.n;
  const double towards = m->is_on[thermostat] != 0.0 ? -1.0 : 1.0;
  double t_s = 0.0;
  while (t_s < h_s) { /* false for NaN, too */
    double probe_K = row[kAmbientShare] * (m->ambient_K + t_s * m->ambient_K_s) + row[kProbeOffset],
           slope = row[kAmbientShare] * m->ambient_K_s, most = 0.0, beyond_K, root;
    int i;
    for (i = 0; i < thermal.n; ++i) {
      const double lambda = m->lambda[i], c = m->c ? m->c[i] : 0.0, at = mode_at(m, i, t_s),
                   v = m->a[i] + t_s * (m->b[i] + t_s * c) - lambda * at, w = m->b[i] + 2.0 * t_s * c - lambda * v,
                   left_s = lambda * (h_s - t_s) > 1.0 ? 1.0 / lambda : h_s - t_s;
      probe_K += weight[i] * at;
      slope += weight[i] * v;
      most += fabs(weight[i]) * (fabs(w) + 2.0 * fabs(c) * left_s);
    }
    beyond_K = beyond_switch_K(thermostat, m->is_on[thermostat], probe_K);
    if (beyond_K >= -kSwitchReached_K) return t_s;
    slope *= towards;
    root = sqrt(slope * slope - 2.0 * most * beyond_K);
    t_s += slope > 0.0 ? -2.0 * beyond_K / (slope + root) : (root - slope) / most;
  }
  return HUGE_VAL;
}

int first_switch(const mode_course* m, double h_s, double* at_s) {
  double first_s = h_s;
  int which = -1, k;
  for (k = 0; k < thermal.n_thermostats; ++k) {
    const double t_s = switch_s(m, k, first_s);
    if (!(t_s < first_s)) continue;
    first_s = t_s;
    which = k;
  }
  if (which >= 0) *at_s = first_s;
  return which;
}
