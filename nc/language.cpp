#include "nc/language.hpp"

#include "nc/written_words.hpp"

namespace driftwright {

std::vector<std::string> NcLanguage::straight_lines(const NcLine& line) const {
  return iso_straight_lines((line.rapid ? "G0" : "G1") + axis_words(line.to_m, line.before.unit_m, written_length),
                            line.feed, line.before.absolute);
}

void NcLanguage::check_written(const std::vector<NcStep>& steps, std::size_t front,
                               const NcOffsetOptions& /*options*/) const {
  for (std::size_t i = front; i + 1 < steps.size(); ++i) {
    if (steps[i].resets != std::array<bool, 3>{} && steps[i].moves())
      throw InputError(steps[i].where,
                       "this control may load its base frame again at a work offset; write the offset in a block of its "
                       "own, before the motion");
  }
}

}  // namespace driftwright
