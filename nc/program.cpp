#include "nc/program.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/delimited_text.hpp"
#include "nc/execution.hpp"

namespace driftwright {

double NcProgram::duration_s() const {
  double sum_s = 0.0;
  for (const NcMove& m : moves) sum_s += m.duration_s;
  return sum_s;
}

NcProgram read_nc_program(const std::string& path, const NcSettings& settings, const std::vector<NcControl>& controls) {
  const NcControl& control = nc_control(settings.control, controls);
  const std::vector<std::string> lines = read_text_lines(path);
  const auto language = std::find_if(control.languages.begin(), control.languages.end(),
                                     [&](const NcLanguage* known) { return known->recognises(lines); });
  if (language == control.languages.end())
    throw InputError(fmt::format("{}: the program is in no language of {} ({})", path, control.title, control.about));
  NcExecution run(settings);
  run.expect(lines.size());
  (*language)->read(path, lines, run);
  return std::move(run).result(path, **language);
}

}  // namespace driftwright
