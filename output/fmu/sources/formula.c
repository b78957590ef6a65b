#include "formula.h"

#include <math.h>

static int n_arguments(int op) {
  return op <= kFormulaName ? 0 : op <= kFormulaMax ? 2 : op == kFormulaIf ? 3 : 1;
}

static double applied(int op, const double* a) {
  switch (op) {
    case kFormulaAdd:
      return a[0] + a[1];
    case kFormulaSubtract:
      return a[0] - a[1];
    case kFormulaMultiply:
      return a[0] * a[1];
    case kFormulaDivide:
      return a[0] / a[1];
    case kFormulaPower:
      return pow(a[0], a[1]);
    case kFormulaLess:
      return a[0] < a[1] ? 1.0 : 0.0;
    case kFormulaGreater:
      return a[0] > a[1] ? 1.0 : 0.0;
    case kFormulaMin:
      return a[1] < a[0] ? a[1] : a[0];
    case kFormulaMax:
      return a[0] < a[1] ? a[1] : a[0];
    case kFormulaNegate:
      return -a[0];
    case kFormulaAbs:
      return fabs(a[0]);
    case kFormulaSqrt:
      return sqrt(a[0]);
    case kFormulaExp:
      return exp(a[0]);
    case kFormulaLn:
      return log(a[0]);
    case kFormulaLog10:
      return log10(a[0]);
    case kFormulaSin:
      return sin(a[0]);
    case kFormulaCos:
      return cos(a[0]);
    case kFormulaTan:
      return tan(a[0]);
    case kFormulaTanh:
      return tanh(a[0]);
    case kFormulaKelvin:
      return a[0];
    case kFormulaCelsius:
      return a[0] - 273.15;
    default:
      return 0.0;
  }
}

/* By how much `value`, made of the arguments a, changes where they change by d. */
static double changed(int op, const double* a, const double* d, double value) {
  switch (op) {
    case kFormulaAdd:
      return d[0] + d[1];
    case kFormulaSubtract:
      return d[0] - d[1];
    case kFormulaMultiply:
      return d[0] * a[1] + a[0] * d[1];
    case kFormulaDivide:
      return (d[0] - value * d[1]) / a[1];
    case kFormulaPower: {
      const double of_base = d[0] == 0.0 ? 0.0 : d[0] * a[1] * pow(a[0], a[1] - 1.0);
      const double of_exponent = d[1] == 0.0 ? 0.0 : d[1] * value * log(a[0]);
      return of_base + of_exponent;
    }
    case kFormulaMin:
      return a[1] < a[0] ? d[1] : d[0];
    case kFormulaMax:
      return a[0] < a[1] ? d[1] : d[0];
    case kFormulaIf:
      return a[0] != 0.0 ? d[1] : d[2];
    case kFormulaNegate:
      return -d[0];
    case kFormulaAbs:
      return a[0] < 0.0 ? -d[0] : d[0];
    case kFormulaSqrt:
      return 0.5 * d[0] / value;
    case kFormulaExp:
      return d[0] * value;
    case kFormulaLn:
      return d[0] / a[0];
    case kFormulaLog10:
      return d[0] / (a[0] * 2.30258509299404568402);
    case kFormulaSin:
      return d[0] * cos(a[0]);
    case kFormulaCos:
      return -d[0] * sin(a[0]);
    case kFormulaTan:
      return d[0] * (1.0 + value * value);
    case kFormulaTanh:
      return d[0] * (1.0 - value * value);
    case kFormulaKelvin:
    case kFormulaCelsius:
      return d[0];
    default: /* a comparison */
      return 0.0;
  }
}

static int is_finite(double x) {
  return fabs(x) < HUGE_VAL;
}

double formula_value(int n_steps, const double* steps, const double* x, const double* dx, double* slope) {
  double values[kFormulaDeepest], slopes[kFormulaDeepest];
  int top = 0, k;
  for (k = 0; k < n_steps; ++k) {
    const int op = (int)steps[2 * k], n = n_arguments(op);
    double* a;
    double value, d = 0.0;
    top -= n;
    a = values + top;
    if (op == kFormulaNumber) {
      value = steps[2 * k + 1];
    } else if (op == kFormulaName) {
      value = x[(int)steps[2 * k + 1]];
      if (slope) d = dx[(int)steps[2 * k + 1]];
    } else if (op == kFormulaIf) { /* only the part that is chosen must have a value */
      value = !is_finite(a[0]) ? NAN : a[0] != 0.0 ? a[1] : a[2];
    } else {
      value = is_finite(a[0]) && (n < 2 || is_finite(a[1])) ? applied(op, a) : NAN;
    }
    if (!is_finite(value)) value = NAN;
    if (slope && n > 0) d = changed(op, a, slopes + top, value);
    values[top] = value;
    slopes[top] = is_finite(d) ? d : 0.0;
    ++top;
  }
  if (slope) *slope = slopes[0];
  return values[0];
}
