#pragma once
// The cyclograms and ambients that places of thermometers are chosen on, and those that they are judged on.

#include "studies/placement_model.hpp"

namespace driftwright::studies {

struct PlacementFamilies {
  std::vector<Cyclogram> chosen_on, judged_on;          ///< as recorded
  std::vector<scenarios::Validation::Season> ambients;  ///< relative to the scenario's own
  std::vector<std::string> made;                        ///< cyclograms made from the scenario's drives
};

/// @param train, test  cyclograms of the scenario or of its `validation`, or record CSVs. If empty: those that
/// `validation` trains on and judges by (the first and the last of each family); without `validation` all cyclograms of
/// the scenario to choose on, and generated ones to judge by.
/// The ambients are the seasons of `validation`; without it the scenario's own, one with a daily swing of 3 K, and one
/// that is 5 K colder with a swing of 2 K. If there are fewer than three cyclograms to choose on, the rest is generated:
/// five hours of the scenario's drives and rest in random order, 10 to 60 min each.
/// @throws InputError  for unknown names, and for a cyclogram that is both to be chosen on and judged by
[[nodiscard]] PlacementFamilies placement_families(const scenarios::Scenario& scenario,
                                                   const std::vector<std::string>& train,
                                                   const std::vector<std::string>& test);

/// The runs of felt_run() of each cyclogram in each ambient, without readings, but with their times and a name as source.
/// @param rows  approximate number of rows of each
[[nodiscard]] std::vector<MachineRun> runs_in_all_ambients(const scenarios::Scenario& scenario,
                                                           const std::vector<Cyclogram>& cyclograms,
                                                           const std::vector<scenarios::Validation::Season>& ambients,
                                                           int rows);
/// Each cyclogram in one ambient, with the ambients in turn. @param row_s  time between rows
[[nodiscard]] std::vector<MachineRun> runs_in_turn(const scenarios::Scenario& scenario,
                                                   const std::vector<Cyclogram>& cyclograms,
                                                   const std::vector<scenarios::Validation::Season>& ambients, double row_s);

/// The drives of the scenario's cyclograms except rest, from the slowest speed to the fastest; those of one speed by feed
/// and cutting power.
[[nodiscard]] std::vector<Drive> drives_of(const scenarios::Scenario& scenario);

}  // namespace driftwright::studies
