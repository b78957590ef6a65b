#pragma once
// What tells the drift of a machine, whatever it is made of: a formula, a model, a model that reads thermometers, or what was measured
// before. It is fitted already, and followed row by row. With fail-safe and interval it is a DeployedPredictor (deployed_predictor.hpp), which
// `validate` judges and keeps in a file; what `run` fits, and modes of `compensate --model modes`, are judged on their run and kept in none.

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compensation/predictors/observed_run.hpp"

namespace driftwright::compensation {

/// A predictor on its way through one run.
class Follower {
 public:
  virtual ~Follower() = default;
  /// Takes the next row: the first call the first one. @return the drift there [um]; NaN where nothing can be said
  /// @param run  the same at every call, up to that row at least. Nothing is read that lies behind it: a run may grow between calls
  virtual double next(const ObservedRun& run) = 0;
  /// All that it knows of the rows it has taken, such as goes into a file, and a follower at the start that goes on from there. The run that it
  /// is then given has the last row taken in front of the next.
  /// @throws std::logic_error  for one that knows no such thing, and for the memory of another
  [[nodiscard]] virtual std::vector<double> memory() const = 0;
  virtual void recall(std::span<const double> memory) = 0;
  /// 1 sigma of the drift that it gave last [um], where it knows it.
  [[nodiscard]] virtual std::optional<double> deviation_um() const { return std::nullopt; }
  /// Trust that what it reads gives its model, 0 to 1: 1 while they agree, and for one that has no model to be wrong.
  [[nodiscard]] virtual double deserved_trust() const { return 1.0; }
  /// What it reads and has given up, and from when: "t05 from 31 min".
  [[nodiscard]] virtual std::vector<std::string> given_up() const { return {}; }
};

/// A channel of the readings.
struct Input {
  std::string name, unit;
  bool operator==(const Input&) const = default;
};

class Predictor {
 public:
  virtual ~Predictor() = default;
  /// What it reads, each once. Drive and ambient of the run, which a model looks at, are no channels.
  [[nodiscard]] virtual std::vector<Input> inputs() const = 0;
  /// Whether it looks at drive and ambient of the run: who follows it must know them.
  [[nodiscard]] virtual bool is_driven() const = 0;
  /// Of a driven one: what its ambient temperatures are counted from [K].
  [[nodiscard]] virtual double reference_K() const { return 273.15; }
  /// Whether it doubts its own inputs; those of any other are watched by a fail-safe.
  [[nodiscard]] virtual bool looks_after_inputs() const { return false; }
  /// At the start of a run. The follower outlives no predictor.
  [[nodiscard]] virtual std::unique_ptr<Follower> follow() const = 0;
};

/// The drift of a run [um], row by row, lead-in included: what the machine would be told while it runs. NaN where nothing can be said.
/// @throws InputError  for readings that lack an input or have it in another unit
[[nodiscard]] std::vector<double> live(const Predictor& predictor, const ObservedRun& run);

/// The drift before the run [um]: by drive and ambient alone, with no reading but those of channels that are known ahead. All NaN for a predictor
/// that cannot do without its thermometers.
/// @param known  its readings hold the times, and channels that are known ahead: `speed`, which follows from the cyclogram, or temperatures that
///               a model foretells
[[nodiscard]] std::vector<double> ahead(const Predictor& predictor, ObservedRun known);

}  // namespace driftwright::compensation
