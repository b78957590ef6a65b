// The drift second by second, as a program beside a control would follow it: rows "speed_rpm ambient_degC" from standard
// input, one a second.
//
//   yes '3000 21.5' | head -n 600 | beside_a_control SCENARIO.yaml

#include <cstdio>
#include <driftwright/machine.hpp>
#include <iostream>

using namespace driftwright;

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "beside_a_control SCENARIO.yaml < rows\n");
    return 2;
  }
  try {
    const Machine machine(argv[1]);
    Row row;
    double ambient_degC = 0.0;
    if (!(std::cin >> row.drive.speed_rpm >> ambient_degC)) return 0;
    Run run = machine.start(ambient_degC);
    std::printf("time_s");
    for (const Channel& channel : run.channels()) std::printf(",%s", channel.header().c_str());
    std::printf("\n");
    do {
      row.time_s += 1.0;
      row.ambient_degC = ambient_degC;
      std::printf("%.0f", row.time_s);
      for (double reading : run.step(row)) std::printf(",%.4f", reading);
      std::printf("\n");
    } while (std::cin >> row.drive.speed_rpm >> ambient_degC);
  } catch (const InputError& e) {
    std::fprintf(stderr, "error: %s\n", e.what());
    return 2;
  }
}
