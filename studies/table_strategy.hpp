#pragma once
// How corrections of a table are judged: five repetitions, each with other noise and another scattered model, with the
// same instruments.

#include <cmath>
#include <functional>

#include "compensation/judging/model_scatter.hpp"
#include "scenarios/reader/felt_run.hpp"
#include "studies/table_study.hpp"

namespace driftwright::studies {

inline constexpr int kTableRepetitions = 5;

/// Repeats a correction and keeps its median and worst result.
/// @param correct  takes the number of the repetition, from 0; returns what is left on the table, one matrix per judged
/// time
[[nodiscard]] TableStrategy repeated(const std::string& name,
                                     const std::function<std::vector<Eigen::Matrix3Xd>(int)>& correct);

/// Random factors on expansions, which libraries know to 3 %: standards give 10.0 to 11.7 for grey iron.
[[nodiscard]] ExpansionFactors wrong_expansions(const scenarios::TableSettings& s, int repetition);

/// The same machine, full or reduced, with random factors on each power and coefficient.
template <class System>
[[nodiscard]] System wrong_system(System system, const scenarios::TableSettings& s, int repetition) {
  Random random(static_cast<std::uint64_t>(s.seed), 50 + static_cast<std::uint64_t>(repetition));
  return compensation::scattered(std::move(system), s.model_scatter, random);
}

[[nodiscard]] compensation::RingPlan ring_plan(const scenarios::TableSettings& s, double every_s, int repetition);

/// Channel of table_readings() with the real ambient of the machine; it has a blank, as no sensor's name may.
inline constexpr const char* kFeltAmbient = "felt ambient";

/// The record with its temperatures as read by the table's instrument: every `update`, averaged backwards, held.
/// @param felt  drive and ambient of the run
[[nodiscard]] Record table_readings(const scenarios::Scenario& scenario, const MachineRun& felt, const Record& record,
                                    int repetition);

/// The instrument in a sentence.
[[nodiscard]] std::string instrument_words(const scenarios::TableSettings& s);

/// Mean of some thermometers [K].
[[nodiscard]] std::vector<double> mean_K(const Record& record, const std::vector<std::string>& sensors);

/// Rings measured while training.
struct TableTraining {
  std::vector<std::size_t> rows;
  std::vector<Eigen::Matrix3Xd> rings_m;
  [[nodiscard]] std::vector<double> at(const std::vector<double>& values) const;
};
[[nodiscard]] TableTraining train(const TableCourse& course, const scenarios::TableSettings& s, int repetition);

}  // namespace driftwright::studies
