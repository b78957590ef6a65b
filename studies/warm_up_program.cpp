#include "studies/warm_up_program.hpp"

#include <fmt/format.h>

namespace driftwright::studies {
namespace {

constexpr std::size_t kLongestRemark = 200;

}  // namespace

std::string warm_up_program(const std::vector<Cyclogram::Section>& sections, const std::string& remark) {
  std::string plain;  // a bracket would end the comment, and the rest would be executed
  for (char c : remark.substr(0, kLongestRemark))
    plain += c >= ' ' && c <= '~' && c != '(' && c != ')' && c != ';' ? c : '_';
  std::string text = fmt::format("({})\nG21 G94\n", plain);
  bool turns = false;
  for (const Cyclogram::Section& section : sections) {
    const double rpm = section.drive.speed_rpm;
    if (rpm > 0.0) text += turns ? fmt::format("S{:.0f}\n", rpm) : fmt::format("S{:.0f} M3\n", rpm);
    if (rpm == 0.0 && turns) text += "M5\n";
    turns = rpm > 0.0;
    text += fmt::format("G4 P{:.0f} ({:.4g} min)\n", section.duration_s, section.duration_s / 60.0);
  }
  if (turns) text += "M5\n";
  return text + "M2\n";
}

}  // namespace driftwright::studies
