/* See plain_model.h. It takes no memory: what the model remembers and its room are in the caller's plain_model. */
#include "plain_model.h"

#include "model.h"

static const char* check_inputs(const double* inputs, const double* before) {
  const char* wrong = 0;
  int k;
  for (k = 0; k < PLAIN_INPUTS && !wrong; ++k) wrong = model_check_input(k, inputs[k]);
  return wrong ? wrong : model_check_drive(inputs, before);
}

/* Inputs that were checked. */
static void take_inputs(plain_model* m, const double* inputs) {
  int k;
  for (k = 0; k < PLAIN_INPUTS; ++k) {
    (void)model_before_input(m->saved, k, inputs[k]);
    m->saved[kInputs + k] = inputs[k];
  }
}

static const char* finish_row(plain_model* m) {
  const char* const wrong = model_event(m->saved, m->scratch.numbers);
  if (wrong == 0) model_outputs(m->saved, m->scratch.numbers, m->outputs);
  return wrong;
}

const char* plain_start(plain_model* m, const double* inputs) {
  const char* const wrong = check_inputs(inputs, 0);
  if (wrong != 0) return wrong;
  if (model_n_saved() > (size_t)PLAIN_SAVED || model_scratch_size() > sizeof m->scratch ||
      model_n_outputs() != PLAIN_OUTPUTS)
    return "plain_model.h is not the one of model_data.c";
  if (model_prepare(m->scratch.numbers) != 0) return "the decomposition of a conduction matrix did not converge";
  model_reset(m->saved, m->scratch.numbers);
  if (!model_kind_is_observer) m->saved[kAmbientFromInput] = 1.0;
  take_inputs(m, inputs);
  model_start(m->saved, m->scratch.numbers);
  return finish_row(m);
}

const char* plain_row(plain_model* m, const double* inputs, double dt_s) {
  const double end_s = m->saved[kTime] + dt_s;
  const char* wrong;
  if (!(dt_s > 0.0 && dt_s < 1e9)) return "the time since the row before must be above 0";
  wrong = check_inputs(inputs, m->saved + kInputs);
  if (wrong != 0) return wrong;
  if (!model_kind_is_observer) /* the ambient was linear since the row before */
    m->saved[kInputs + PLAIN_INPUTS] = (inputs[PLAIN_INPUTS - 1] - m->saved[kInputs + PLAIN_INPUTS - 1]) / dt_s;
  wrong = model_step(m->saved, m->scratch.numbers, dt_s);
  if (!model_kind_is_observer) m->saved[kInputs + PLAIN_INPUTS] = 0.0;
  if (wrong != 0) return wrong;
  m->saved[kTime] = end_s;
  take_inputs(m, inputs);
  return finish_row(m);
}
