/* A law that follows temperatures, as a formula in postfix order: what it is, and how it changes. */
#ifndef DRIFTWRIGHT_FORMULA_H
#define DRIFTWRIGHT_FORMULA_H

/* In the order of driftwright::effects::Op. */
enum {
  kFormulaNumber,
  kFormulaName,
  kFormulaAdd,
  kFormulaSubtract,
  kFormulaMultiply,
  kFormulaDivide,
  kFormulaPower,
  kFormulaLess,
  kFormulaGreater,
  kFormulaMin,
  kFormulaMax,
  kFormulaIf,
  kFormulaNegate,
  kFormulaAbs,
  kFormulaSqrt,
  kFormulaExp,
  kFormulaLn,
  kFormulaLog10,
  kFormulaSin,
  kFormulaCos,
  kFormulaTan,
  kFormulaTanh,
  kFormulaKelvin,
  kFormulaCelsius
};

/* Most values that wait for each other. */
enum { kFormulaDeepest = 72 };

/* steps: n_steps pairs of operation and number (of kFormulaNumber: the number; of kFormulaName: the index in x). Returns
 * NaN if a part that counts has no finite value. slope, unless null: the change along dx. It is finite also where a root
 * begins (a film of free convection between equal temperatures): the part that is infinite there counts as 0. */
double formula_value(int n_steps, const double* steps, const double* x, const double* dx, double* slope);

#endif
