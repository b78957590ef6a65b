#pragma once
// A case from its seed to its files.

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
  double d_prime_beside_others = 0.0;  ///< what is left of it when the sizes of the case's other effects are free
};

struct Case {
  CasePlan plan;
  Values values;  ///< scattered, without what is hidden
  std::vector<double> scatter_z;
  std::vector<HiddenTruth> hidden;
  std::string without;  ///< key to be taken out of the catalogue; ""
};

/// All that the seed decides, with sizes tuned to how loud an effect shall be: d' log-uniform in 12 to 60, in every tenth case 5 to 10,
/// in every twentieth 1.5 to 5.
[[nodiscard]] Case make_case(const Subject& subject, std::uint64_t seed);

/// The record as a user would measure it.
[[nodiscard]] Record measured(const Subject& subject, const Case& of, std::size_t record);

/// Steps of the truth's time integration.
[[nodiscard]] double truth_step_s(const Subject& subject);

/// Writes <folder>/scenario.yaml, measured_1.csv, measured_2.csv (where there is one), holdout.csv and, last of all, truth.json; and the
/// drawing that the scenario names to <folder>/../parts.
void write_case(const Subject& subject, const Case& of, const std::filesystem::path& folder);

/// One more record of a case, with a cyclogram of the user's own: the same machine and hidden effects, another ambient, fresh noise. What
/// happened in one record only does not happen again.
/// @param further  0, 1, ...: each has its own ambient and noise
[[nodiscard]] Record further_record(const Subject& subject, Case of, Cyclogram cyclogram, std::uint64_t further);

/// Makes cases of a range of seeds; those whose truth.json is there are kept.
class CaseMaker {
 public:
  /// @param mesh_share  size of the truth's cells over those of the scenario
  explicit CaseMaker(std::string machines, double mesh_share = 0.7)
      : machines_(std::move(machines)), mesh_share_(mesh_share) {}
  /// @return false for one that was there
  bool make(std::uint64_t seed, const std::filesystem::path& out);
  /// One more record of the case in a folder, with the cyclogram that a diagnosis of it proposes to tell ambiguous causes apart.
  /// @return none where the diagnosis is not ambiguous, or proposes a further sensor instead
  /// @throws InputError  where a file is not there or is none of ours
  [[nodiscard]] std::optional<Record> proposed(const std::filesystem::path& folder,
                                               const std::filesystem::path& diagnosis_json);

 private:
  const Subject& subject(std::size_t which);
  std::string machines_;
  double mesh_share_;
  std::map<std::size_t, std::unique_ptr<Subject>> subjects_;
};

}  // namespace driftwright::blind
