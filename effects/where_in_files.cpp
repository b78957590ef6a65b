#include "effects/where_in_files.hpp"

#include "effects/heat_balance.hpp"

namespace driftwright::effects {

std::string where_in_files(const std::string& where) {
  std::string text;
  for (std::size_t begin = 0, end = 0; end != std::string::npos; begin = end + 1) {
    end = where.find(',', begin);
    const std::string place = where.substr(begin, end == std::string::npos ? end : end - begin);
    text += (begin == 0 ? "" : ",") + (place == kAmbientName ? std::string(kAmbientInWhere) : place);
  }
  return text;
}

}  // namespace driftwright::effects
