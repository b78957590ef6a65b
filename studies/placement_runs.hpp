#pragma once
// The cyclograms and ambients that places of thermometers are chosen on, and others that they are judged on.

#include "studies/placement_model.hpp"

namespace driftwright::studies {

struct PlacementFamilies {
  std::vector<Cyclogram> chosen_on, judged_on;         ///< as recorded
  std::vector<scenarios::Validation::Season> ambients;    ///< against the scenario's own
  std::vector<std::string> made;                       ///< cyclograms among them that were made of the scenario's drives
};

/// @param train, test  cyclograms of the scenario, of its `validation`, or record CSVs. None: those that `validation` trains on and judges by (of each family the
///                     first and the last); without it all of the scenario, and made ones to judge by.
/// Ambients are the seasons of `validation`; without it the scenario's own, one that swings by 3 K in a day and one that is 5 K colder and swings by 2 K. Of fewer
/// than three to choose on, the rest is made: five hours of the scenario's drives and rest in random order, 10 to 60 min each.
/// @throws InputError  for names that are not there, for a cyclogram that is to be chosen on and judged by
[[nodiscard]] PlacementFamilies placement_families(const scenarios::Scenario& scenario, const std::vector<std::string>& train,
                                                   const std::vector<std::string>& test);

/// Each cyclogram in each ambient. @param rows  about so many in each
[[nodiscard]] std::vector<PlacementRun> runs_in_all_ambients(const scenarios::Scenario& scenario, const std::vector<Cyclogram>& cyclograms,
                                                          const std::vector<scenarios::Validation::Season>& ambients, int rows);
/// Each cyclogram in one ambient, one ambient after another. @param row_s  between rows
[[nodiscard]] std::vector<PlacementRun> runs_in_turn(const scenarios::Scenario& scenario, const std::vector<Cyclogram>& cyclograms,
                                                     const std::vector<scenarios::Validation::Season>& ambients, double row_s);

/// The drives of the scenario's cyclograms without rest, from the slowest speed to the fastest; of one speed by feed and cutting power.
[[nodiscard]] std::vector<Drive> drives_of(const scenarios::Scenario& scenario);

}  // namespace driftwright::studies
