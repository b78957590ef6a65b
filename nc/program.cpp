#include "nc/program.hpp"

#include "base/delimited_text.hpp"
#include "nc/heidenhain/din_reader.hpp"
#include "nc/heidenhain/klartext_lines.hpp"
#include "nc/heidenhain/klartext_reader.hpp"
#include "nc/iso_reader.hpp"
#include "nc/siemens/reader.hpp"

namespace driftwright {

double NcProgram::duration_s() const {
  double sum_s = 0.0;
  for (const NcMove& m : moves) sum_s += m.duration_s;
  return sum_s;
}

NcProgram read_nc_program(const std::string& path, const NcSettings& settings) {
  NcRun run(settings);
  if (settings.control == NcControl::kLinuxCnc) {
    run_iso_program(path, run);
    return std::move(run).result(path, NcDialect::kLinuxCnc);
  }
  const std::vector<std::string> lines = read_text_lines(path);
  run.expect(lines.size());
  if (settings.control == NcControl::kSiemens) {
    if (asks_for_iso_mode(lines)) {
      run_iso_program(path, run);
      return std::move(run).result(path, NcDialect::kSiemensIso);
    }
    run_siemens_program(path, lines, run);
    return std::move(run).result(path, NcDialect::kSiemens);
  }
  if (is_klartext(lines)) {
    run_klartext_program(path, lines, run);
    return std::move(run).result(path, NcDialect::kKlartext);
  }
  run_heidenhain_program(path, lines, run);
  return std::move(run).result(path, NcDialect::kHeidenhainIso);
}

}  // namespace driftwright
