#include "diagnosis/extended_scenario.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>

#include "base/config_map.hpp"
#include "base/config_text.hpp"
#include "base/errors.hpp"
#include "base/mapped_record.hpp"
#include "base/quantity.hpp"
#include "base/yaml_text.hpp"
#include "effects/former_words.hpp"
#include "scenarios/reader/moved_paths.hpp"
#include "scenarios/reader/read_cyclogram.hpp"

namespace driftwright::diagnosis {
namespace {

using effects::Effect;

constexpr const char* kKnownTogether = "known_together";

double rounded(double value) {
  return std::isfinite(value) ? std::strtod(fmt::format("{:.7g}", value).c_str(), nullptr) : value;
}

double rounded(double value, const effects::Parameter& parameter) {
  const double zero = parameter.unit == "degC" ? kZeroCelsius_K : 0.0;
  return rounded(value - zero) + zero;
}

/// Seven digits, accurate to a millikelvin: numbers that follow from fitted ones, such as a factor from a power. Fitted
/// ones come with fewer (written_numbers.hpp).
Effect rounded(Effect e) {
  for (std::size_t p = 0; p < e.values.size(); ++p) e.values[p] = rounded(e.values[p], e.kind->parameters[p]);
  for (auto& [name, table] : e.tables) {
    for (double& argument : table.time_s) argument = rounded(argument);
    for (double& value : table.value) value = rounded(value);
  }
  e.from_s = rounded(e.from_s);
  e.until_s = rounded(e.until_s);
  return e;
}

bool is_near(double a, double b) {
  return (std::isnan(a) && std::isnan(b)) || a == b || std::abs(a - b) <= 1e-6 * std::max(std::abs(a), std::abs(b));
}

bool is_near(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double x, double y) { return is_near(x, y); });
}

bool reads_back(const Effect& a, const Effect& b) {
  return a.kind == b.kind && a.place_kind == b.place_kind && a.place == b.place && a.references == b.references &&
         a.words == b.words && a.in == b.in && is_near(a.from_s, b.from_s) && is_near(a.until_s, b.until_s) &&
         is_near(a.values, b.values) &&
         std::equal(a.tables.begin(), a.tables.end(), b.tables.begin(), b.tables.end(), [](const auto& x, const auto& y) {
           return x.first == y.first && is_near(x.second.time_s, y.second.time_s) && is_near(x.second.value, y.second.value);
         });
}

class Writer {
 public:
  Writer(const scenarios::Scenario& scenario, const Twin& twin, const std::vector<MeasuredRun>& runs,
         std::filesystem::path to)
      : runs_(runs),
        yaml_(scenario.path),
        from_(std::filesystem::absolute(scenario.path).parent_path()),
        to_(std::move(to)),
        columns_(scenario.columns),
        list_(twin.as_written()) {
    effects_ = yaml_.root().find("effects");
    const std::size_t n = effects_ && effects_->is_list() ? effects_->items.size() : 0;
    if (n != list_.size()) throw InputError(fmt::format("{}: has changed while it was diagnosed", scenario.path));
    for (const Cyclogram& c : scenario.cyclograms) cyclograms_.push_back(c.name);
    if (!scenarios::move_paths(yaml_, from_, to_).empty()) in_one_piece_ = true;
    for (Effect& e : list_) give_path(e, from_);
  }

  /// @returns the changes, as sentences; empty if nothing differs
  std::vector<std::string> write(const StatedChange& change) {
    TwinState next = list_;
    change.make(next);
    change_ = &change;
    done_.clear();
    notes_.clear();
    for (std::size_t i = 0; i < list_.size(); ++i) values(i, next[i]);
    for (std::size_t i = list_.size(); i < next.size(); ++i) append(next[i]);
    for (const auto& [line, notes] : notes_)
      yaml_.comment(line, fmt::format("{}: {}; {}", change.by, fmt::join(notes, ", "), change.comment));
    return done_;
  }

  /// What the fit leaves open, after everything else and in place of what the text says of it.
  void known_together(const scenarios::KnownTogether& known) {
    says_anew_ = true;
    if (!known.numbers.empty()) tail_ = scenarios::yaml_of(known);
    if (yaml_.root().find(kKnownTogether) && !yaml_.remove(kKnownTogether)) in_one_piece_ = true;
  }

  /// The edited text; if it does not have the right effects, a text written anew.
  [[nodiscard]] std::string text(std::vector<std::string> head) const {
    if (const std::string edited = yaml_.text(head) + tail_; !in_one_piece_ && says_what_it_should(edited)) return edited;
    head.emplace_back("written anew: the text of the scenario could not be edited in place");
    std::string out;
    for (const std::string& line : head) out += fmt::format("# {}\n", line);
    const ConfigNode& root = yaml_.root();
    for (std::size_t i = 0; i < root.keys.size(); ++i) {
      const std::string& key = root.keys[i].text;
      if (key == kKnownTogether && says_anew_) continue;
      if (key == "effects") {
        out += "effects:\n";
        for (const Effect& e : list_) out += fmt::format("  - {}\n", effects::yaml_of(e));
      } else if (key == "cyclograms") {
        out += "cyclograms:\n";
        for (std::size_t c = 0; c < root.items[i]->keys.size(); ++c)
          out += fmt::format("  {}: {}\n", root.items[i]->keys[c].text, anew(*root.items[i]->items[c]));
        for (const auto& [name, written] : added_cyclograms_) out += fmt::format("  {}: {}\n", name, written);
      } else {
        out += fmt::format("{}: {}\n", key, anew(*root.items[i]));
      }
    }
    return out + tail_;
  }

 private:
  /// Whether the effects of a text are those of the list, and what is known together is in it; replaced entries are at
  /// another position.
  [[nodiscard]] bool says_what_it_should(const std::string& edited) const {
    TwinState read;
    try {
      std::vector<effects::FormerWord> former;  // in the user's text; they are kept
      const ConfigMap root =
          ConfigMap::of_tree(effects::in_present_words(read_config_text(edited, yaml_.root().source->path), former));
      if (says_anew_ && root.has(kKnownTogether) == tail_.empty()) return false;  // as after a line "..."
      for (const ConfigMap& one : root.maps("effects")) {
        read.push_back(effects::read_effect(one));
        if (!to_.empty()) give_path(read.back(), to_);
      }
    } catch (const InputError&) {  // it is no longer valid YAML, or has an invalid effect
      return false;
    }
    if (read.size() != list_.size()) return false;
    return std::all_of(list_.begin(), list_.end(), [&](const Effect& wanted) {
      return std::any_of(read.begin(), read.end(), [&](const Effect& e) { return reads_back(e, wanted); });
    });
  }

  [[nodiscard]] const ConfigNode& entry(std::size_t i) const { return *effects_->items[i]; }
  [[nodiscard]] bool is_in_file(std::size_t i) const { return i < effects_->items.size() && !replaced_.contains(i); }

  /// A factor on the capacity of a node that the scenario has becomes the node's own capacity. @returns whether it is one
  bool take_up(const Effect& factor) {
    const auto node = std::find_if(list_.begin(), list_.end(), [&](const Effect& e) {
      return e.kind->key == "node" && e.place == factor.place && e.has("capacity");
    });
    if (factor.kind->key != "heat_capacity" || factor.place_kind != effects::Place::kNode || node == list_.end())
      return false;
    Effect next = *node;
    next.set("capacity", factor["factor"] * next["capacity"]);
    values(static_cast<std::size_t>(node - list_.begin()), next);
    return true;
  }

  void append(Effect e) {
    if (take_up(e)) return;
    e = rounded(std::move(e));
    if (!e.in.empty()) add_cyclogram(e.in);
    const std::string text = effects::yaml_of(e);
    if (!yaml_.append(*effects_, text,
                      change_->by == "diagnosis" ? change_->comment : change_->by + ": " + change_->comment))
      in_one_piece_ = true;
    list_.push_back(std::move(e));
    done_.push_back("added " + text);
  }

  /// Writes the changed numbers of an effect.
  void values(std::size_t i, const Effect& next) {
    for (std::size_t p = 0; p < next.values.size(); ++p) {
      const double was = list_[i].values[p], now = rounded(next.values[p], next.kind->parameters[p]);
      if (std::isnan(next.values[p]) || next.values[p] == was) continue;
      list_[i].values[p] = now;
      const effects::Parameter& parameter = next.kind->parameters[p];
      done_.push_back(fmt::format("{}: {} {} -> {}", next.name(), parameter.name,
                                  effects::yaml_of(parameter, rounded(was, parameter)), effects::yaml_of(parameter, now)));
      if (!is_in_file(i) || !in_place(i, parameter, was, now)) replace(i);
    }
  }

  /// Edits the number in place, in its unit.
  bool in_place(std::size_t i, const effects::Parameter& parameter, double was, double now) {
    const ConfigNode* scalar = entry(i).find(parameter.name);
    if (!scalar) {
      if (!yaml_.add_pair(entry(i), parameter.name, effects::yaml_of(parameter, now))) return false;
      notes_[entry(i).line].push_back(parameter.name + " is new");
      return true;
    }
    const std::string text = yaml_.current(*scalar);
    char* unit = nullptr;
    const double number = std::strtod(text.c_str(), &unit);
    const bool keeps_unit = parameter.unit != "degC" && unit != text.c_str() && was != 0.0 && number != 0.0;
    const std::string other =
        keeps_unit ? fmt::format("{:.7g}{}", number * now / was, unit) : effects::yaml_of(parameter, now);
    if (!yaml_.replace(*scalar, other)) return false;
    notes_[scalar->line].push_back(fmt::format("{} was {}", parameter.name, text));
    return true;
  }

  /// Writes the whole entry after the others; the old one becomes a comment.
  void replace(std::size_t i) {
    if (is_in_file(i) && yaml_.comment_out(*effects_, i) &&
        yaml_.append(*effects_, effects::yaml_of(list_[i]), change_->comment)) {
      replaced_.insert(i);
      return;
    }
    in_one_piece_ = true;
  }

  /// A cyclogram from the run's file and, for a logger's file, the scenario's `columns`; a record in memory has no file.
  [[nodiscard]] std::string cyclogram_of(const MeasuredRun& run) const {
    const auto is_read = [&](const std::optional<ColumnMap>& columns) {
      try {
        (void)read_record(run.path, columns);
        return true;
      } catch (const InputError&) {
        return false;
      }
    };
    std::error_code none;
    if (std::filesystem::is_regular_file(run.path, none)) {
      const std::string csv = scenarios::path_text(scenarios::moved_path(run.path, std::filesystem::current_path(), to_));
      const ConfigNode* columns = yaml_.root().find("columns");
      if (columns && is_read(columns_)) return fmt::format("{{csv: {}, columns: {}, measured: true}}", csv, anew(*columns));
      if (is_read(std::nullopt)) return fmt::format("{{csv: {}, measured: true}}", csv);
    }
    return scenarios::rows_yaml(run.cyclogram);
  }

  void add_cyclogram(const std::string& name) {
    if (std::find(cyclograms_.begin(), cyclograms_.end(), name) != cyclograms_.end()) return;
    const auto run = std::find_if(runs_.begin(), runs_.end(), [&](const MeasuredRun& r) { return r.name == name; });
    if (run == runs_.end()) throw std::logic_error("extended_scenario: a change in a run that does not exist, " + name);
    const std::string written = cyclogram_of(*run);
    const ConfigNode* list = yaml_.root().find("cyclograms");
    if (!yaml_.append(*list, fmt::format("{}: {}", name, written), "diagnosis: the measured run")) in_one_piece_ = true;
    cyclograms_.push_back(name);
    added_cyclograms_.emplace_back(name, written);
    done_.push_back(fmt::format("added the cyclogram {} from its record", name));
  }

  /// Gives the file of an effect, if it has one, the path that the text has. @param from  what its path is relative to
  void give_path(Effect& e, const std::filesystem::path& from) const {
    for (const effects::Mention& m : e.kind->mentions) {
      std::string& file = e.words.at(m.name);
      if (m.of == effects::Mention::Of::kFile && !file.empty()) file = scenarios::moved_path(file, from, to_);
    }
  }

  [[nodiscard]] std::string path_of(const std::string& path) const {
    const bool stays = std::filesystem::path(path).is_absolute();
    return scenarios::path_text(stays ? path : scenarios::moved_path(path, from_, to_));
  }

  /// A node on one line, with the paths that the text has.
  [[nodiscard]] std::string anew(const ConfigNode& node) const {
    if (!node.is_map() && !node.is_list()) return written(node);
    std::vector<std::string> parts;
    for (std::size_t i = 0; i < node.items.size(); ++i) {
      const ConfigNode& item = *node.items[i];
      if (!node.is_map()) {
        parts.push_back(anew(item));
        continue;
      }
      const std::string& key = node.keys[i].text;
      const bool is_path = item.is_scalar() && scenarios::is_path_key(key);
      parts.push_back(fmt::format("{}: {}", key, is_path ? path_of(item.text) : anew(item)));
    }
    const std::string list = fmt::format("{}", fmt::join(parts, ", "));
    return node.is_map() ? fmt::format("{{{}}}", list) : fmt::format("[{}]", list);
  }

  const std::vector<MeasuredRun>& runs_;
  YamlText yaml_;
  std::filesystem::path from_, to_;  ///< folder of the scenario, and of the text
  std::optional<ColumnMap> columns_;
  TwinState list_;  ///< effects of the text
  const ConfigNode* effects_ = nullptr;
  const StatedChange* change_ = nullptr;
  std::set<std::size_t> replaced_;
  std::vector<std::string> cyclograms_, done_;
  std::vector<std::pair<std::string, std::string>> added_cyclograms_;  ///< names and YAML
  std::map<int, std::vector<std::string>> notes_;                      ///< changes, by line
  std::string tail_;                                                   ///< after the text
  bool says_anew_ = false;                                             ///< the tail replaces `known_together`
  bool in_one_piece_ = false;                                          ///< the text could not be edited and is written anew
};

}  // namespace

std::function<void(TwinState&)> change_of(const Claim& claim, const Eigen::VectorXd& x) {
  return [knobs = claim.knobs, x](TwinState& state) {
    for (std::size_t k = 0; k < knobs.size(); ++k) knobs[k].set(state, knobs[k].value(x[static_cast<Eigen::Index>(k)]));
  };
}

ExtendedScenario extended_scenario(const scenarios::Scenario& scenario, const Twin& twin,
                                   const std::vector<MeasuredRun>& runs, const std::vector<StatedChange>& changes,
                                   std::vector<std::string> head, const std::filesystem::path& folder,
                                   const std::optional<scenarios::KnownTogether>& known_together) {
  ExtendedScenario result;
  Writer writer(scenario, twin, runs, folder);
  for (const StatedChange& change : changes) {
    const std::vector<std::string> done = writer.write(change);
    if (!done.empty()) result.written.push_back(fmt::format("{}: {}", change.name, fmt::join(done, "; ")));
  }
  if (known_together) writer.known_together(*known_together);
  result.text = writer.text(std::move(head));
  return result;
}

}  // namespace driftwright::diagnosis
