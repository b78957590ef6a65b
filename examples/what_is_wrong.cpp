// What does the simulation get wrong? Diagnoses records and writes the scenario with what was found in it.
//
//   what_is_wrong SCENARIO.yaml RECORD.csv... > extended.yaml

#include <cstdio>
#include <driftwright/machine.hpp>

using namespace driftwright;

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "what_is_wrong SCENARIO.yaml RECORD.csv... > extended.yaml\n");
    return 2;
  }
  try {
    const Machine machine(argv[1],
                          {.on_begin = [](const std::string& work) { std::fprintf(stderr, "%s\n", work.c_str()); }});
    std::vector<Record> measured;
    for (int i = 2; i < argc; ++i) measured.push_back(read_record_csv(argv[i]));
    const Diagnosis found = machine.diagnose(measured);
    std::fprintf(stderr, "%s: %s\n", found.verdict.c_str(), found.reason.c_str());
    for (const Cause& cause : found.causes) {
      std::fprintf(stderr, "  %s: %s at %s\n", cause.standing.c_str(), cause.effect.c_str(), cause.where.c_str());
      for (const Estimate& p : cause.parameters)
        std::fprintf(stderr, "    %s %g %s, 95 %%: %g to %g\n", p.name.c_str(), p.value, p.unit.c_str(), p.low, p.high);
    }
    for (const ChannelGain& g : found.gain)
      if (g.rmse_before == g.rmse_before)  // NaN if no held-out row could judge it
        std::fprintf(stderr, "  %s: %.3g -> %.3g %s\n", g.name.c_str(), g.rmse_before, g.rmse_after, g.unit.c_str());
    std::fputs(found.extended_scenario.c_str(), stdout);
  } catch (const InputError& e) {
    std::fprintf(stderr, "error: %s\n", e.what());
    return 2;
  }
}
