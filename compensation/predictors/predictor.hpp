#pragma once
// What tells the drift of a machine, whatever it is made of: a formula, a model, a model that reads thermometers, or what was measured
// before. It is fitted already, and followed row by row. With fail-safe and interval it is a DeployedPredictor (deployed_predictor.hpp), which
// `validate` judges and keeps in a file; what `run` fits, and modes of `compensate --model modes`, are judged on their run and kept in none.

#include <memory>
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
