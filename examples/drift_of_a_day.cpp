// How far does the tool drift over a shift? Fifty shifts of random jobs, predicted side by side by the reduced model.
//
//   drift_of_a_day SCENARIO.yaml [HIGHEST_SPEED_RPM]

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <driftwright/machine.hpp>
#include <random>

using namespace driftwright;

namespace {

Cyclogram random_shift(unsigned seed, double highest_rpm) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> speed_rpm(0.2 * highest_rpm, highest_rpm), minutes(5.0, 40.0);
  Cyclogram shift{.name = "shift " + std::to_string(seed), .sections = {}};
  while (shift.duration_s() < 8 * 3600.0) {
    shift.sections.push_back({60.0 * minutes(random), Drive{.speed_rpm = speed_rpm(random)}});
    shift.sections.push_back({180.0, Drive{}});  // a new part is clamped
  }
  return shift;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "drift_of_a_day SCENARIO.yaml [HIGHEST_SPEED_RPM]\n");
    return 2;
  }
  try {
    const Machine machine(argv[1]);
    std::vector<Cyclogram> shifts;
    for (unsigned i = 0; i < 50; ++i) shifts.push_back(random_shift(i, argc > 2 ? std::atof(argv[2]) : 6000.0));
    std::vector<double> peaks_um;
    const std::string channel = machine.displacements().back();
    for (const Record& record : machine.predict(shifts)) {
      const std::vector<double>& drift_um = record.at(channel).values;
      peaks_um.push_back(std::abs(*std::max_element(drift_um.begin(), drift_um.end(),
                                                    [](double a, double b) { return std::abs(a) < std::abs(b); })));
    }
    std::sort(peaks_um.begin(), peaks_um.end());
    std::printf("%s over 50 shifts: %.1f um in the middle, %.1f um at most\n", channel.c_str(), peaks_um[25],
                peaks_um.back());
  } catch (const InputError& e) {
    std::fprintf(stderr, "error: %s\n", e.what());
    return 2;
  }
}
