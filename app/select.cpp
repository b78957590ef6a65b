#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/record_study.hpp"
#include "app/results.hpp"
#include "output/json_text.hpp"

namespace driftwright::app {

void select(const RecordOptions& options) {
  const scenarios::Scenario scenario = scenarios::read_scenario(options.scenario);
  const scenarios::Study& settings = require_study(scenario, "select");
  RecordStudy study = read_records(settings, options);
  rank(study, settings);
  output::ResultsFolder folder = open_results(options, scenario.name);
  nlohmann::ordered_json j = {{"program", "driftwright"},
                              {"version", folder.made_by().version},
                              {"scenario", folder.made_by().scenario},
                              {"target", study.target},
                              {"records", options.train},
                              {"n_samples", study.ranking.n_samples},
                              {"image_reason", study.ranking.reason}};
  std::string csv = "rank,channel,grade_1\n", shown;
  for (std::size_t i = 0; i < study.ranking.channels.size(); ++i) {
    const auto& c = study.ranking.channels[i];
    const std::string grade = c.grade ? fmt::format("{:.6f}", *c.grade) : "";
    csv += fmt::format("{},{},{}\n", i + 1, c.name, grade);
    j["channels"].push_back(
        {{"name", c.name}, {"grade", c.grade ? nlohmann::ordered_json(*c.grade) : nullptr}, {"reversed", c.reversed}});
    shown += fmt::format("  {:2}  {:<16} {}{}\n", i + 1, c.name, c.grade ? grade : c.note,
                         c.grade && static_cast<int>(i) < settings.sensors_to_choose ? "  chosen" : "");
  }
  folder.write_text("ranking.csv", csv);
  folder.write_text("summary.json", output::json_text(j));
  folder.commit();
  fmt::print("grey relational grade against {}, {} samples; {}\n{}written to {}\n", study.target, study.ranking.n_samples,
             study.ranking.reason, shown, shown_path(folder.target()));
}

}  // namespace driftwright::app
