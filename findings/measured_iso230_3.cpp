#include "findings/measured_iso230_3.hpp"

#include "base/mapped_record.hpp"

namespace driftwright::findings {

std::vector<Iso230Run> measured_iso230_3(const studies::MeasuredTwin& measured) {
  std::vector<Iso230Run> list;
  for (const diagnosis::MeasuredRun& run : measured.runs) {
    // read again, because ranges refer to the recorded values, and the diagnosis keeps only what it compares with a model
    compensation::Iso230Figures figures;
    if (run.start_K.size() > 0) {
      figures.not_available = "the machine was warm at the start";
    } else {
      figures = compensation::iso230_3_figures(read_record(run.path, measured.scenario.columns).record);
    }
    list.push_back({run.name, std::move(figures)});
  }
  return list;
}

}  // namespace driftwright::findings
