#pragma once
// A study of many variants of one scenario, as its file describes it (docs/how-to/sweep.md): the varied values, the
// members that result, and the numbers collected of each. Nothing is simulated here.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/config_address.hpp"
#include "base/config_map.hpp"
#include "scenarios/reader/scenario.hpp"

namespace driftwright::scenarios {

/// One value that a member sets in the scenario.
struct SweepValue {
  ConfigNodePtr node;
  std::string label;    ///< text in the table: the number without its unit, a word, or a given name
  double number = 0.0;  ///< in the variation's unit; NaN if it is no number
};

/// A distribution by its inverse: the value that a share u of all values lies below.
struct Spread {
  enum class Kind { kUniform, kLogUniform, kNormal };
  Kind kind = Kind::kUniform;
  double first = 0.0;   ///< lower end, or mean
  double second = 0.0;  ///< upper end, or standard deviation

  /// @param u  0 < u < 1
  [[nodiscard]] double at(double u) const;
};

/// One entry of `vary`.
struct Variation {
  std::string name;
  std::string unit;                 ///< of all its numbers, as written; "" for plain numbers
  bool is_number = false;           ///< false for words, lists and maps
  std::vector<ConfigSteps> places;  ///< in the scenario; all take the same value
  std::vector<std::string> tops;    ///< key of the scenario that contains each of them
  std::vector<SweepValue> values;   ///< those listed, or the steps
  std::optional<Spread> spread;     ///< instead of values
  ConfigNodePtr written_at;         ///< place in the study for errors about a value

  /// Name of its column, with the unit of numbers.
  [[nodiscard]] std::string header() const;
  /// The value for a number in `unit`.
  [[nodiscard]] SweepValue value_of(double number) const;
};

/// A number of a value as tables show it.
[[nodiscard]] std::string number_label(double number);

/// A number that summarises a channel over a cyclogram.
enum class Scalar { kPeak, kTimeOfPeak, kEnd, kMin, kMax };
/// Their names in studies and tables.
[[nodiscard]] const std::vector<std::pair<std::string, Scalar>>& scalar_names();

/// One column of results.
struct CollectedScalar {
  std::string cyclogram;
  std::string channel;
  std::string unit;  ///< of the channel
  Scalar scalar = Scalar::kPeak;

  /// "<cyclogram>_<channel>_<scalar>_<unit>"
  [[nodiscard]] std::string header() const;
};

enum class Design { kList, kGrid, kLatinHypercube, kSobol };

struct SweepPlan {
  std::string path;
  std::string name;
  ConfigNodePtr study;
  ConfigNodePtr scenario;  ///< as in its file
  Design design = Design::kList;
  std::vector<Variation> variations;
  std::size_t n_members = 0;
  Eigen::MatrixXd samples;  ///< of a Latin hypercube or for Sobol' indices: n_members x variations, in (0, 1)
  std::vector<CollectedScalar> collect;

  /// The value of a variation in a member (from 0).
  [[nodiscard]] SweepValue value(std::size_t member, std::size_t variation) const;
  /// The scenario of a member. Errors about a varied value name the study's line.
  [[nodiscard]] ConfigMap scenario_of(std::size_t member) const;
  /// Header row of its table: member, varied values, results, status.
  [[nodiscard]] std::string table_header() const;
};

/// What two members share when their keys are equal.
enum class Shared {
  kStructure,  ///< mesh and influence vectors
  kMachine,    ///< the whole machine; drive, ambient, start and solver may differ
};
/// @returns "" if all members of the plan are equal in this
[[nodiscard]] std::string sharing_key(const SweepPlan& plan, std::size_t member, Shared what);

/// Members of part `part` of `n_parts` (from 0), with those that share a machine next to each other. Each member is in
/// one part, and the sizes of parts differ by at most one.
[[nodiscard]] std::vector<std::size_t> members_of_part(const SweepPlan& plan, std::size_t part, std::size_t n_parts);

/// A hash of everything that determines the table: program version, study, scenario, and the files that they name. 16 hex
/// digits.
[[nodiscard]] std::string content_key(const SweepPlan& plan, const std::string& version);

/// The schemas of a study's file, by design.
[[nodiscard]] const std::vector<schema::Map>& sweep_schemas();

/// Reads a study and its scenario, and finds every varied key in the scenario.
/// @throws InputError  with file, line and key
[[nodiscard]] SweepPlan read_sweep_plan(const std::string& path);

}  // namespace driftwright::scenarios
