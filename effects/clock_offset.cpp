#include "effects/effect.hpp"

namespace driftwright::effects {
namespace {

void change_readings(const Effect& e, ReadingChain& chain) {
  chain.clock_offset_s += e["offset"] * 60.0;
}

}  // namespace

EffectKind clock_offset() {
  return {.key = "clock_offset",
          .title = "readings logged late or early against drive and hall",
          .law =
              "reading(t) = reading taken at t - offset, temperatures and displacements; the first and the last one stand "
              "in beyond the ends",
          .places = {Place::kClock},
          .parameters = {{"offset", "min", -1e4, 1e4, {}, "> 0: a reading carries a later time than it was taken at"}},
          .change_readings = change_readings};
}

}  // namespace driftwright::effects
