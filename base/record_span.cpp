#include "base/record_span.hpp"

#include <fmt/format.h>

#include "base/errors.hpp"

namespace driftwright {

void require_possible_span(const std::string& path, double first_s, double last_s) {
  if (last_s - first_s <= kLongestRecord_s) return;
  throw InputError(fmt::format(
      "{}: its rows reach from {:g} s to {:g} s, {:.3g} years; 100 years are allowed. Is the unit of time right?", path,
      first_s, last_s, (last_s - first_s) / kLongestRecord_s * 100.0));
}

}  // namespace driftwright
