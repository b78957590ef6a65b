#include "output/fmu/plain_c.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "compensation/control/state_observer.h"
#include "output/fmu/model_data.hpp"
#include "output/fmu/source_files.hpp"

namespace driftwright::output {
namespace {

// As in sources/: of model.h, machine.c and observer.c. plain_start() refuses sizes that are too small.
constexpr std::size_t kFirstInput = 4, kObserverRows = kObserverRowsBack + 2, kPieces = 32, kStepsKept = 12, kModesKept = 12,
                      kSlotsBeside = 8;
// Doubles, more than the structs take with pointers of 64 bits; vectors of live.c.
constexpr std::size_t kMachineHead = 32, kSlotHead = 16, kLiveHead = 48, kLiveVectors = 27;

struct PlainSizes {
  std::size_t saved = 0, scratch = 0;  // doubles
};

PlainSizes sizes_of_observer(const FmuModel& model, std::size_t n_inputs) {
  const FmuObserver& observer = *model.observer;
  state_observer o{};
  o.machine.n = static_cast<int>(model.start.size());
  o.machine.n_sources = static_cast<int>(model.sources.size());
  o.machine.n_exchanges = static_cast<int>(model.exchanges.size());
  o.n_sensors = static_cast<int>(observer.sensors.size());
  const std::size_t pieces = kPieces * (1 + model.drive.size()), row = 3 + observer.sensors.size() + pieces;
  const std::size_t probing = (sizeof(probe_state) + sizeof(double) - 1) / sizeof(double);
  return {kFirstInput + n_inputs + 5 + probing + pieces + kObserverRows * row + observer_n_remembered(&o),
          sizeof(state_observer) / sizeof(double) + 2 + model.sources.size() + observer_n_room(&o, kStepsKept, kModesKept)};
}

PlainSizes sizes_of_machine(const FmuModel& model, std::size_t n_inputs) {
  const auto n = static_cast<std::size_t>(model.start.size());
  const std::size_t slots = model.known_drives.size() + kSlotsBeside, exchanges = model.exchanges.size(),
                    sources = model.sources.size();
  Eigen::Index n_probes = 0;
  bool has_live = false;
  const auto take_live = [&](const auto& laws) {
    for (const auto& law : laws) {
      if (!law.live) continue;
      has_live = true;
      n_probes = std::max(n_probes, law.live->weights.cols());
    }
  };
  take_live(model.sources);
  take_live(model.exchanges);
  const std::size_t live =
      has_live ? kLiveHead + 2 * (model.drive.size() + static_cast<std::size_t>(n_probes)) + kLiveVectors * n : 0;
  const std::size_t thermostats = model.thermostats.size();
  return {kFirstInput + n_inputs + 1 + n + (has_live ? 1 : 0) + thermostats,  // the rate of the ambient is no input here
          kMachineHead + slots * (kSlotHead + exchanges + n + n * n + 3 * n) + 2 * model.drive.size() +
              2 * (exchanges + sources) + 8 * n + 2 * n * n + thermostats * (n + 2) + live};
}

std::string names_text(const std::vector<std::string>& names) {
  std::string text;
  for (std::string name : names) {
    std::replace_if(
        name.begin(), name.end(), [](char ch) { return ch == '"' || ch == '\\' || ch == '\n'; }, '_');
    text += fmt::format("  \"{}\",\n", name);
  }
  return text;
}

bool is_plain(const std::string& name, bool is_observer) {
  if (name.starts_with("fmi") || name.starts_with("instance")) return false;
  return is_of_model(name, is_observer);
}

}  // namespace

std::vector<FmuEntry> plain_c_files(const FmuOrder& order, const Provenance& made_by) {
  const FmuModel& model = order.model;
  const bool is_observer = model.observer.has_value();
  std::vector<std::string> inputs, outputs;
  std::string input_lines;
  for (const FmuVariable& v : variables_of(model)) {
    if (v.causality == "output") outputs.push_back(v.name);
    if (v.causality != "input" || v.name == "ambient_temperature_rate") continue;
    input_lines += fmt::format(" *   {} {}{}{}\n", inputs.size(), v.name, v.unit.empty() ? "" : ", " + v.unit,
                               v.max ? fmt::format(", from {:g} to {:g}", *v.min, *v.max) : "");
    inputs.push_back(v.name);
  }
  std::string output_lines;
  for (std::size_t k = 0; k < outputs.size(); ++k) output_lines += fmt::format(" *   {} {}\n", k, outputs[k]);
  for (std::string* lines : {&input_lines, &output_lines}) {
    for (std::size_t at = 0; (at = lines->find("*/", at)) != std::string::npos;) lines->replace(at, 2, "* ");
  }
  const PlainSizes sizes = is_observer ? sizes_of_observer(model, inputs.size()) : sizes_of_machine(model, inputs.size());
  const std::string words = fmt::format("Driftwright {}, scenario {}.", made_by.version, made_by.scenario);
  const std::string header = fmt::format(
      "/* {}. {}\n"
      " * C99, libm alone; it takes no memory. Compile all .c files beside it but example.c, with -ffp-contract=off and\n"
      " * without -ffast-math. A plain_model is {} KiB; keep it where it is not cleared between rows.\n"
      " *\n * inputs:\n{} * outputs, in degC, um and urad; error = actual - commanded:\n{} */\n"
      "#ifndef DRIFTWRIGHT_PLAIN_MODEL_H\n#define DRIFTWRIGHT_PLAIN_MODEL_H\n\n"
      "enum {{ PLAIN_INPUTS = {}, PLAIN_OUTPUTS = {}, PLAIN_SAVED = {}, PLAIN_SCRATCH = {} }};\n\n"
      "typedef struct {{\n  double saved[PLAIN_SAVED]; /* what the model remembers: a copy of it continues from there */\n"
      "  union {{\n    double numbers[PLAIN_SCRATCH];\n    void *aligned;\n  }} scratch;\n"
      "  double outputs[PLAIN_OUTPUTS]; /* of the last row */\n}} plain_model;\n\n"
      "extern const char *const plain_output_names[PLAIN_OUTPUTS];\n\n"
      "/* The first row. Returns 0, or what is wrong in words: such a row changes nothing, and outputs stay those of the "
      "last\n"
      " * one that was taken. */\n"
      "const char *plain_start(plain_model *m, const double *inputs);\n"
      "/* The next row, dt_s after the last one that was taken. The drive has been what that row said, {}.\n"
      " * Returns as plain_start(). */\n"
      "const char *plain_row(plain_model *m, const double *inputs, double dt_s);\n\n#endif\n",
      model.description, words, (sizes.saved + sizes.scratch + outputs.size()) * sizeof(double) / 1024 + 1, input_lines,
      output_lines, inputs.size(), outputs.size(), sizes.saved, sizes.scratch,
      is_observer
          ? fmt::format("and a sample is taken\n * every {:g} s: of rows that come sooner only the drive counts. Before a "
                        "row\n * that comes later its thermometers count as unchanged",
                        model.observer->settings.period_s)
          : "the ambient\n * linear between the two");
  std::vector<FmuEntry> files = {{"plain_model.h", header}};
  for (const SourceFile& s : fmu_source_files()) {
    if (is_plain(s.name, is_observer)) files.push_back({s.name, s.text});
  }
  files.push_back(
      {"model_data.c",
       fmt::format("{}\n#include \"plain_model.h\"\n\nconst char *const plain_output_names[PLAIN_OUTPUTS] = {{\n{}}};\n",
                   model_data_c(model, "", words), names_text(outputs))});
  if (!order.reference_out.empty()) {
    files.push_back({"reference_in.csv", order.reference_in});
    files.push_back({"reference_out.csv", order.reference_out});
  }
  return files;
}

}  // namespace driftwright::output
