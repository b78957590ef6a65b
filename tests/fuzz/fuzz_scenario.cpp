// Scenarios: YAML and all that is read from it, as plain structs and as text again.

#include "scenarios/reader/scenario.hpp"
#include "tests/fuzz/driver.hpp"

using namespace driftwright;

int main(int argc, char** argv) {
  return fuzz::run(argc, argv,
                   {.name = "scenario",
                    .corpus = {"scenarios"},
                    .extensions = {".yaml"},
                    .words = {": ",
                              "- ",
                              "[",
                              "]",
                              "{",
                              "}",
                              "&a ",
                              "*a",
                              "!!int ",
                              "~",
                              "|\n",
                              "\"",
                              "'",
                              "#",
                              "\t",
                              "<<: *a",
                              "degC",
                              " mm",
                              " W/(m^2 K)",
                              "true",
                              "effects:",
                              "cyclograms:",
                              "machine:",
                              "study:",
                              "type: convection",
                              "\xEF\xBB\xBF",
                              "\xE4"},
                    .read = [](const std::filesystem::path& file) { (void)scenarios::read_scenario(file.string()); },
                    .file_name = "scenario"});
}
