/* Eigenvalues and eigenvectors of a symmetric matrix. */
#ifndef DRIFTWRIGHT_SYMMETRIC_EIGEN_H
#define DRIFTWRIGHT_SYMMETRIC_EIGEN_H

/* A = V diag(values) V'. Householder's reduction to three diagonals, then implicit QL steps.
 * Source: Golub & Van Loan, Matrix Computations, ch. 8.3.
 *
 * matrix: A, n x n, lost. values: n, in no order. vectors: n x n, row k is the eigenvector of values[k]. work: 2 n.
 * Returns 0, or 1 where the steps do not converge. */
int symmetric_eigen(int n, double* matrix, double* values, double* vectors, double* work);

#endif
