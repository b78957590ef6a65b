#include "nc/block.hpp"

namespace driftwright {

Where NcBlock::at(const NcWord& word) const {
  Where place = where;
  place.column = word.column;
  return place;
}

}  // namespace driftwright
