// Edges per second through the pulse injector: bench/injector.sh builds and runs this.
//
//   injector_bench   one line a way to use it: millions of edges per second (best of several), on one thread; every row is
//                    an edge

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <vector>

#include "bench/timing.hpp"
#include "compensation/injector/encoder.hpp"
#include "compensation/injector/pulse_injector.hpp"

namespace {

using namespace driftwright::compensation;
using driftwright::now_s;

long memory_kB() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

constexpr std::int64_t kEdges = 200'000'000;
constexpr int kBlock = 1 << 16;  // a multiple of a period

template <class Block>
void measure(const char* what, const Block& block) {
  double best_s = 1e9;
  std::int64_t check = 0;
  for (int i = 0; i < 5; ++i) {
    const double begin_s = now_s();
    check = block();
    best_s = std::min(best_s, now_s() - begin_s);
  }
  fmt::print("  {:<58} {:7.0f} million edges/s   (net count {}, {} MB)\n", what, static_cast<double>(kEdges) / best_s / 1e6,
             check, memory_kB() / 1024);
}

std::int64_t rows(bool bypass, bool inserting) {
  std::vector<Lines> in, out(static_cast<std::size_t>(kBlock) * kMostRowsPerRow);
  for (int i = 1; i <= kBlock; ++i) in.push_back(lines_of_phase(i));
  PulseInjector injector({.bypass = bypass});
  std::int64_t n_out = 0;
  for (std::int64_t done = 0, i = 0; done < kEdges; done += kBlock, ++i) {
    if (inserting) injector.set_target(i % 2 == 0 ? kBlock : -kBlock);  // a cycle after each low row
    n_out += static_cast<std::int64_t>(injector.run(in, out.data()));
  }
  return injector.encoder().count() + injector.inserted();
}

std::int64_t timed(bool inserting) {
  TimedInjector injector({.separation = 100, .insertion_interval = 400});
  std::vector<Edge> out;
  std::int64_t t = 0, phase = 0;
  for (std::int64_t done = 0, i = 0; done < kEdges; done += kBlock, ++i) {
    if (inserting) injector.set_target(t, i % 2 == 0 ? kBlock : -kBlock, out);
    for (int k = 0; k < kBlock; ++k) {
      t += 500;  // just room enough
      injector.input({t, lines_of_phase(++phase)}, out);
      if (out.size() > kBlock) out.clear();
    }
  }
  return injector.encoder().count() + injector.inserted();
}

}  // namespace

int main() {
  measure("rows, bypass", [] { return rows(true, false); });
  measure("rows, nothing to insert", [] { return rows(false, false); });
  measure("rows, a cycle in every low window", [] { return rows(false, true); });
  measure("time stamps, nothing to insert", [] { return timed(false); });
  measure("time stamps, a cycle in every low window", [] { return timed(true); });
}
