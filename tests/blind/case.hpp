#pragma once
// A case from its seed to its files.

#include <filesystem>
#include <map>
#include <memory>

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

/// Makes cases of a range of seeds; those whose truth.json is there are kept.
class CaseMaker {
 public:
  /// @param mesh_share  size of the truth's cells over those of the scenario
  explicit CaseMaker(std::string machines, double mesh_share = 0.7)
      : machines_(std::move(machines)), mesh_share_(mesh_share) {}
  /// @return false for one that was there
  bool make(std::uint64_t seed, const std::filesystem::path& out);

 private:
  std::string machines_;
  double mesh_share_;
  std::map<std::size_t, std::unique_ptr<Subject>> subjects_;
};

}  // namespace driftwright::blind
