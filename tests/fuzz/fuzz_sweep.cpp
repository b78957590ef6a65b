// Studies of many variants, on a scenario that is whole, and the scenarios of their members.

#include <filesystem>

#include "scenarios/reader/scenario.hpp"
#include "scenarios/reader/sweep_plan.hpp"
#include "tests/fuzz/driver.hpp"

using namespace driftwright;

int main(int argc, char** argv) {
  return fuzz::run(argc, argv,
                   {.name = "sweep",
                    .corpus = {"scenarios/lumped_sweep.yaml"},
                    .extensions = {".yaml"},
                    .words = {": ",         "- ",      "[",        "]",    "{",      "}",
                              "&a ",        "*a",      "~",        "grid", "list",   "latin_hypercube",
                              "samples: 3", "values:", "from:",    "to:",  "steps:", "uniform:",
                              "normal:",    "key:",    "collect:", "\t"},
                    .read = [](const std::filesystem::path& file) {
                      const auto whole = file.parent_path() / "lumped_spindle.yaml";
                      if (!std::filesystem::exists(whole))
                        std::filesystem::copy_file("scenarios/lumped_spindle.yaml", whole);
                      const scenarios::SweepPlan plan = scenarios::read_sweep_plan(file.string());
                      for (const std::size_t member : {std::size_t(0), plan.n_members - 1})
                        (void)scenarios::read_scenario(plan.scenario_of(member));
                      (void)scenarios::content_key(plan, "1");
                    }});
}
