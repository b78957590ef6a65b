#pragma once
// Makes a blind case from its seed and writes its files.

#include <filesystem>
#include <map>
#include <memory>
#include <optional>

#include "base/record.hpp"
#include "blind/signature.hpp"

namespace driftwright::blind {

struct HiddenTruth {
  Hidden hidden;
  double d_prime = 0.0;
  double d_prime_beside_others = 0.0;  ///< the part of it that is left if the sizes of the case's other effects are free
};

struct Case {
  CasePlan plan;
  Values values;  ///< scattered, without the hidden effects
  std::vector<double> scatter_z;
  std::vector<HiddenTruth> hidden;
  std::string without;  ///< key to be removed from the catalogue; ""
};

/// Everything that the seed determines, with sizes tuned to the desired strength of the effects: d' log-uniform in 12 to
/// 60, in every tenth case 5 to 10, in every twentieth 1.5 to 5.
[[nodiscard]] Case make_case(const Subject& subject, std::uint64_t seed);

/// The record that a user would measure.
[[nodiscard]] Record measured(const Subject& subject, const Case& of, std::size_t record);

/// Number of steps of the truth's time integration.
[[nodiscard]] double truth_step_s(const Subject& subject);

/// Writes <folder>/scenario.yaml, measured_1.csv, measured_2.csv (if there is one), holdout.csv and finally truth.json;
/// and the drawing that the scenario names to <folder>/../parts.
void write_case(const Subject& subject, const Case& of, const std::filesystem::path& folder);

/// One more record of a case, with a cyclogram of the user: the same machine and hidden effects, another ambient and new
/// noise. Events of one record do not happen again.
/// @param further  0, 1, ...: each has its own ambient and noise
[[nodiscard]] Record further_record(const Subject& subject, Case of, Cyclogram cyclogram, std::uint64_t further);

/// Makes the cases of a range of seeds; those that already have a truth.json are kept.
class CaseMaker {
 public:
  /// @param mesh_share  size of the truth's cells over those of the scenario
  explicit CaseMaker(std::string machines, double mesh_share = 0.7)
      : machines_(std::move(machines)), mesh_share_(mesh_share) {}
  /// @return false if the case existed already
  bool make(std::uint64_t seed, const std::filesystem::path& out);
  /// One more record of the case in a folder, with the cyclogram that a diagnosis of it proposes to distinguish ambiguous
  /// causes.
  /// @return none if the diagnosis is not ambiguous, or proposes another sensor instead
  /// @throws InputError  for a file that is missing or not from this program
  [[nodiscard]] std::optional<Record> proposed(const std::filesystem::path& folder,
                                               const std::filesystem::path& diagnosis_json);

 private:
  const Subject& subject(std::size_t which);
  std::string machines_;
  double mesh_share_;
  std::map<std::size_t, std::unique_ptr<Subject>> subjects_;
};

}  // namespace driftwright::blind
