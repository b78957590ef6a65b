#include "output/twin/twin_page.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "base/lists.hpp"
#include "base/quantity.hpp"
#include "base/shown_units.hpp"
#include "effects/reading_chain.hpp"

namespace driftwright::output {
namespace {

using Json = nlohmann::ordered_json;

/// Vectors one after the other, n numbers each; empty vectors become zeros.
class Rows {
 public:
  explicit Rows(Eigen::Index n) : n_(n) {}
  void add(const Eigen::VectorXd& v) {
    for (Eigen::Index i = 0; i < n_; ++i) values_.push_back(v.size() > 0 ? v[i] : 0.0);
  }
  [[nodiscard]] std::string text() const { return text_of(values_); }

 private:
  Eigen::Index n_;
  std::vector<double> values_;
};

Json json_of(const DriveLaw& law) {
  if (law.terms.empty()) return law.at_rest;
  Json terms = Json::array();
  for (const LawTerm& t : law.terms)
    terms.push_back({{"variable", t.variable}, {"log_x", text_of(t.log_x)}, {"c", text_of(t.coefficients)}});
  return {{"rest", law.at_rest}, {"terms", terms}};
}

Json json_of(const TwinTimedLaw& timed) {
  Json laws = Json::array();
  for (const TwinLaw& law : timed.laws) {
    Json tables = Json::array();
    for (const TwinTable& table : law.tables) {
      Json axes = Json::array(), at = Json::array();
      for (const TwinAxis& a : table.axes)
        axes.push_back({{"probe", a.probe}, {"minus", a.minus}, {"nodes", text_of(a.nodes_K)}});
      for (const DriveLaw& l : table.at) at.push_back(json_of(l));
      tables.push_back({{"axes", axes}, {"at", at}});
    }
    laws.push_back({{"drive", json_of(law.drive)}, {"tables", tables}});
  }
  return {{"laws", laws}, {"of_stretch", timed.of_stretch}, {"probes", timed.probes}, {"thermostat", timed.thermostat}};
}

/// The outputs that instruments read.
std::vector<Eigen::Index> told_outputs(const solver::Outputs& outputs) {
  std::vector<Eigen::Index> told;
  for (std::size_t o = 0; o < outputs.name.size(); ++o) {
    if (!effects::is_mean_output(outputs.name[o])) told.push_back(static_cast<Eigen::Index>(o));
  }
  return told;
}

Json json_of(const TwinModel& model) {
  const solver::ReducedSystem& s = model.system;
  const Eigen::Index n = s.size();
  Rows loads(n), exchanges(n * n), to_ambient(n), offsets(n), probes(n), outputs(n);
  std::vector<double> probe_ambient, probe_offset_K, output_ambient;
  Json powers = Json::array(), coefficients = Json::array(), told = Json::array(), thermostats = Json::array();
  for (const solver::HeatSource& source : s.sources) loads.add(source.load);
  for (const auto& e : s.exchanges) {
    exchanges.add(e.matrix.reshaped());
    to_ambient.add(e.reaches_ambient() ? e.to_ambient : Eigen::VectorXd());
    offsets.add(e.offset);
  }
  for (const solver::Probe& p : s.probes) {
    probes.add(p.weights);
    probe_ambient.push_back(p.ambient_share);
    probe_offset_K.push_back(p.offset_K);
  }
  for (Eigen::Index o : told_outputs(s.outputs)) {
    const auto i = static_cast<std::size_t>(o);
    outputs.add(s.outputs.state.col(o));
    output_ambient.push_back(s.outputs.ambient[o]);
    const bool is_temperature = s.outputs.unit[i] == "K";
    told.push_back({{"name", s.outputs.name[i]},
                    {"unit", shown_reading_unit(s.outputs.unit[i])},
                    {"factor", shown_scale(s.outputs.unit[i])},
                    {"offset", is_temperature ? s.reference_K - kZeroCelsius_K : 0.0}});
  }
  for (const TwinTimedLaw& law : model.powers_W) powers.push_back(json_of(law));
  for (const TwinTimedLaw& law : model.coefficients) coefficients.push_back(json_of(law));
  for (const solver::Thermostat& t : s.thermostats)
    thermostats.push_back({{"probe", t.probe}, {"on_above_K", t.on_above_K}, {"off_below_K", t.off_below_K}});
  return {{"n", n},
          {"n_sources", s.sources.size()},
          {"n_exchanges", s.exchanges.size()},
          {"n_probes", s.probes.size()},
          {"n_outputs", told.size()},
          {"reference_K", s.reference_K},
          {"numbers",
           {{"conduction", text_of(s.conduction)},
            {"loads", loads.text()},
            {"exchanges", exchanges.text()},
            {"to_ambient", to_ambient.text()},
            {"offsets", offsets.text()},
            {"probe_weights", probes.text()},
            {"probe_ambient", text_of(probe_ambient)},
            {"probe_offset_K", text_of(probe_offset_K)},
            {"output_state", outputs.text()},
            {"output_ambient", text_of(output_ambient)},
            {"start", text_of(model.start)}}},
          {"powers", powers},
          {"coefficients", coefficients},
          {"change_times_s", s.change_times_s},
          {"thermostats", thermostats},
          {"outputs_told", told},
          {"ambient", {{"time_s", text_of(model.ambient.time_s)}, {"value_K", text_of(model.ambient.value)}}}};
}

struct DriveWords {
  const char *label, *unit;
};
DriveWords words_of(DriveVariable variable) {
  switch (variable) {
    case DriveVariable::kSpeed:
      return {"Spindle speed", "rpm"};
    case DriveVariable::kFeedX:
      return {"Feed x", "mm/min"};
    case DriveVariable::kFeedY:
      return {"Feed y", "mm/min"};
    case DriveVariable::kFeedZ:
      return {"Feed z", "mm/min"};
    case DriveVariable::kCuttingPower:
      return {"Cutting power", "W"};
  }
  return {"", ""};
}

Json json_of(const TwinCorrection& correction, const std::vector<std::string>& names) {
  Json formulas = Json::array();
  for (const compensation::Regression& r : correction.formulas) {
    Json inputs = Json::array();
    for (const std::string& input : r.inputs) inputs.push_back(index_of(names, input));
    formulas.push_back({{"output", index_of(names, r.target)},
                        {"inputs", inputs},
                        {"coefficients", r.coefficients},
                        {"intercept", r.intercept}});
  }
  return {{"name", correction.name},
          {"words", correction.words},
          {"formulas", formulas},
          {"resolution_K", correction.resolution_K},
          {"period_um", correction.period_um}};
}

/// Values of channels row by row; NaN where a record lacks one.
std::vector<double> row_by_row(const Record& record, const std::vector<std::string>& names) {
  std::vector<const Channel*> channels;
  for (const std::string& name : names) channels.push_back(record.find(name));
  std::vector<double> values;
  for (std::size_t row = 0; row < record.n_samples(); ++row) {
    for (const Channel* c : channels) values.push_back(c ? c->values[row] : std::nan(""));
  }
  return values;
}

Json check_json(const TwinPage& page, const std::vector<std::string>& names) {
  for (const std::string& name : names) (void)page.check.at(name);
  Json check = {{"cyclogram", page.first}, {"by", page.check_by}, {"values", text_of(row_by_row(page.check, names))}};
  if (!page.band || page.band->limits.channels.empty()) return check;
  std::vector<std::string> low, high;
  for (const std::string& name : names) {
    low.push_back(name + "_low");
    high.push_back(name + "_high");
  }
  check["band"] = {{"time_s", text_of(page.check.time_s)},
                   {"low", text_of(row_by_row(page.band->limits, low))},
                   {"high", text_of(row_by_row(page.band->limits, high))},
                   {"words", page.band->words}};
  return check;
}

Json cyclograms_json(const TwinPage& page) {
  Json list = Json::array();
  for (const Cyclogram& c : page.cyclograms) {
    Json sections = Json::array();
    for (const Cyclogram::Section& s : c.sections) {
      Json section = {s.duration_s};
      for (const DriveRange& r : page.model.drive) section.push_back(value_of(r.variable, s.drive));
      sections.push_back(section);
    }
    list.push_back({{"name", c.name}, {"sections", sections}});
  }
  return list;
}

Json data_of(const TwinPage& page, const Provenance& made_by) {
  std::vector<std::string> names;
  for (Eigen::Index o : told_outputs(page.model.system.outputs))
    names.push_back(page.model.system.outputs.name[static_cast<std::size_t>(o)]);
  Json drive = Json::array();
  for (const DriveRange& r : page.model.drive)
    drive.push_back({{"label", words_of(r.variable).label}, {"unit", words_of(r.variable).unit}, {"most", r.most}});
  Json data = {{"name", page.name},
               {"subtitle", page.subtitle},
               {"made_by", "Made by Driftwright " + made_by.version + " of the scenario " + made_by.scenario + "."},
               {"reference_degC", page.model.system.reference_K - kZeroCelsius_K},
               {"interval_s", page.interval_s},
               {"drive", drive},
               {"machine", json_of(page.model)},
               {"cyclograms", cyclograms_json(page)},
               {"first", page.first},
               {"check", check_json(page, names)},
               {"correction", json_of(page.correction, names)},
               {"target", page.target.empty() ? -1 : index_of(names, page.target)},
               {"tolerance_um", page.tolerance_um},
               {"notes", page.model.notes},
               {"palette", palette_text()}};
  if (page.surface) {
    data["surface"] = surface_json(*page.surface);
    data["marks"] = marks_json(page.marks, *page.surface);
  } else {
    data["network"] = network_json(page.network);
  }
  return data;
}

}  // namespace

std::string twin_html(const TwinPage& page, const Provenance& made_by) {
  return page_text("page.html", page.name, {"page.css"}, data_of(page, made_by),
                   {"eigen.js", "law.js", "model.js", "run.js", "correction.js", "twin.js", "fields.js", "scene.js",
                    "network.js", "charts.js", "plan.js", "picture.js", "page.js", "report.js"});
}

}  // namespace driftwright::output
