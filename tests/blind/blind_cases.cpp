// Writes blind cases: blind_cases --from 0 --to 399 -o DIR [--every K --offset J]
//
// Cases that are there are kept. With --every 2 --offset 1 every second seed alone, so that two processes share the work.
// blind_cases --further DIR/case_0008 --diagnosis FILE.json -o FILE.csv: one more record of a case, with the cyclogram
// that its diagnosis proposes; nothing where it proposes none. --mesh-share 1.3 tries everything out on coarse meshes,
// four times as fast.

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <ctime>
#include <exception>
#include <fstream>
#include <string>
#include <vector>

#include "base/errors.hpp"
#include "blind/case.hpp"

int main(int argc, char** argv) {
  try {
    std::uint64_t from = 0, to = 0, every = 1, offset = 0;
    std::string out, further, diagnosis, machines = BLIND_MACHINES;
    double mesh_share = 0.7;
    for (int i = 1; i + 1 < argc; i += 2) {
      const std::string key = argv[i], value = argv[i + 1];
      if (key == "--from") {
        from = std::stoull(value);
      } else if (key == "--to") {
        to = std::stoull(value);
      } else if (key == "--every") {
        every = std::stoull(value);
      } else if (key == "--offset") {
        offset = std::stoull(value);
      } else if (key == "--machines") {
        machines = value;
      } else if (key == "--mesh-share") {
        mesh_share = std::stod(value);
      } else if (key == "--further") {
        further = value;
      } else if (key == "--diagnosis") {
        diagnosis = value;
      } else if (key == "-o") {
        out = value;
      } else {
        throw driftwright::InputError("blind_cases: unknown option " + key);
      }
    }
    if (argc % 2 == 0 || out.empty() || every == 0 || further.empty() != diagnosis.empty()) {
      throw driftwright::InputError(
          "usage: blind_cases --from N --to N [--every K --offset J] [--machines DIR] [--mesh-share 0.7] -o DIR\n"
          "       blind_cases --further CASE --diagnosis FILE.json [--machines DIR] [--mesh-share 0.7] -o FILE.csv");
    }
    driftwright::blind::CaseMaker maker(machines, mesh_share);
    if (!further.empty()) {
      const auto record = maker.proposed(further, diagnosis);
      if (!record) return 0;
      std::ofstream file(out, std::ios::binary);
      file << driftwright::record_csv(*record);
      if (!file.flush()) throw driftwright::InputError("blind_cases: cannot write " + out);
      return 0;
    }
    for (std::uint64_t seed = from; seed <= to; ++seed) {
      if (seed % every != offset) continue;
      const std::clock_t start = std::clock();
      if (!maker.make(seed, out)) continue;
      const double cpu_s = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
      fmt::print(stderr, "case {:04d} {} {} {:.1f} s CPU\n", seed,
                 driftwright::blind::subject_names()[driftwright::blind::subject_of(seed)],
                 driftwright::blind::class_name(driftwright::blind::class_of(seed)), cpu_s);
    }
    return 0;
  } catch (const driftwright::InputError& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 2;
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 3;
  }
}
