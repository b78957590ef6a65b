/* Rows of reference_in.csv from standard input through the model; its outputs as CSV to standard output:
 * cc -std=c99 -O2 -ffp-contract=off *.c -lm -o example && ./example < reference_in.csv */
#include <stdio.h>
#include <stdlib.h>

#include "plain_model.h"

int main(void) {
  static plain_model model;
  static char line[65536];
  double before_s = 0.0;
  long row = 0;
  int k;
  if (!fgets(line, (int)sizeof line, stdin)) return 1;
  printf("\"time\"");
  for (k = 0; k < PLAIN_OUTPUTS; ++k) printf(",\"%s\"", plain_output_names[k]);
  printf("\n");
  for (; fgets(line, (int)sizeof line, stdin); ++row) {
    double inputs[PLAIN_INPUTS];
    char* at = line;
    const double time_s = strtod(at, &at);
    const char* wrong;
    for (k = 0; k < PLAIN_INPUTS; ++k) inputs[k] = strtod(at + (*at == ','), &at);
    wrong = row == 0 ? plain_start(&model, inputs) : plain_row(&model, inputs, time_s - before_s);
    if (wrong != 0) {
      fprintf(stderr, "row %ld: %s\n", row + 1, wrong);
      return 1;
    }
    before_s = time_s;
    printf("%.17g", time_s);
    for (k = 0; k < PLAIN_OUTPUTS; ++k) printf(",%.17g", model.outputs[k]);
    printf("\n");
  }
  return 0;
}
