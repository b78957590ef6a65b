// NC programs: words, motion, time.

#include "nc/program.hpp"
#include "tests/fuzz/driver.hpp"

using namespace driftwright;

int main(int argc, char** argv) {
  NcSettings settings;
  settings.rapid_m_s = 0.2;
  settings.tool_change_s = 5.0;
  settings.machine_zero_m = {0.0, 0.0, 0.0};
  return fuzz::run(argc, argv,
                   {.name = "program",
                    .corpus = {"scenarios/parts"},
                    .extensions = {".ngc"},
                    .words = {"G0",  "G1",  "G2",  "G3", "G4 P", "G17", "G20", "G28", "G73",     "G81", "G83",
                              "G98", "G93", "G95", "M3", "M6",   "M30", "%",   "N",   "R",       "I",   "J",
                              "K",   "P",   "L",   "F",  "S",    "(",   ")",   ";",   "O100 sub"},
                    .read = [&](const std::filesystem::path& file) { (void)read_nc_program(file.string(), settings); }});
}
