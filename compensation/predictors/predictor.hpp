#pragma once
// The interface of everything that predicts the drift of a machine: a formula, a model, a model with thermometers, or
// earlier measurements. A predictor is already fitted, and is followed row by row. It says what it needs, which of its
// inputs must be guarded, how it is written (predictor_kind.hpp) and what else can be made of it; no other file knows its
// class. With fail-safe and interval it becomes a DeployedPredictor (deployed_predictor.hpp), which `validate` judges and
// stores in a file. Those that `run` fits, and the modes of `compensate --model modes`, are judged on their run and not
// stored.

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/machine_run.hpp"

namespace driftwright::effects {
struct Effect;
}

namespace driftwright::compensation {

struct DriftModel;
class Observer;
struct Written;

/// Time constant with which a low trust is forgotten: one work shift [s]. A model that was wrong is still wrong after its
/// filter has adapted.
inline constexpr double kRemembersDoubt_s = 8.0 * 3600.0;

/// A predictor during one run.
class Follower {
 public:
  virtual ~Follower() = default;
  /// Takes the next row, beginning with the first. @return the drift there [um]; NaN without a prediction
  /// @param run  the same at every call, at least up to that row. Later rows are never read: a run may grow between calls
  virtual double next(const MachineRun& run) = 0;
  /// memory() gives everything that the follower knows of the rows taken, for storing it in a file. recall() sets it in a
  /// new follower, which then continues from there. The run given next must contain the last row taken before the next one.
  /// @throws std::logic_error  if the follower does not support it, and for the memory of another predictor
  [[nodiscard]] virtual std::vector<double> memory() const = 0;
  virtual void recall(std::span<const double> memory) = 0;
  /// Standard deviation of the last drift [um], if known.
  [[nodiscard]] virtual std::optional<double> deviation_um() const { return std::nullopt; }
  /// Of a mean of formulas (Predictor::members()): the last drift of each [um]; empty for others.
  [[nodiscard]] virtual std::vector<double> members_um() const { return {}; }
  /// Trust in the model that its inputs justify, 0 to 1: 1 while they agree, and for a predictor without such a check.
  [[nodiscard]] virtual double deserved_trust() const { return 1.0; }
  /// The inputs that it has stopped using, and from when: "t05 from 31 min".
  [[nodiscard]] virtual std::vector<std::string> given_up() const { return {}; }
};

/// A channel of the readings.
struct Input {
  std::string name, unit;
  bool operator==(const Input&) const = default;
};

/// A fitted predictor.
class Predictor {
 public:
  virtual ~Predictor() = default;

  /// The channels that it reads, each once. Drive and ambient of the run, which a model uses, are not channels.
  [[nodiscard]] virtual std::vector<Input> inputs() const = 0;
  /// True if it uses drive and ambient of the run; the caller must then provide them.
  [[nodiscard]] virtual bool is_driven() const = 0;
  /// For a driven one: zero point of its ambient temperatures [K].
  [[nodiscard]] virtual double reference_K() const { return 273.15; }
  /// For a driven one: the effects whose laws it evaluates. They may follow recorded columns, or hold in a part of a run.
  [[nodiscard]] virtual std::vector<effects::Effect> laws() const;
  /// Interval of the rows that it must be given during a run [s]; 0: of any. Rows that come sooner are left out.
  [[nodiscard]] virtual double period_s() const { return 0.0; }

  /// Longest time constant of what it remembers of the time before a row, and takes for granted at the start [s]; 0: of none,
  /// or it finds out by itself.
  [[nodiscard]] virtual double memory_s() const { return 0.0; }

  /// True if it checks its own inputs; the inputs of all others are checked by a fail-safe (guarded_inputs()).
  [[nodiscard]] virtual bool looks_after_inputs() const { return false; }

  /// What a file holds of it; none: it is not stored.
  [[nodiscard]] virtual std::optional<Written> written() const = 0;

  /// The formula that gives the same drift, for text, C, LinuxCNC and means of several; null: it is no formula of its
  /// inputs.
  [[nodiscard]] virtual const DriftModel* formula() const { return nullptr; }
  /// Of a mean of formulas: these formulas; null for others.
  [[nodiscard]] virtual const std::vector<DriftModel>* members() const { return nullptr; }
  /// The state observer in it, for a watch over the machine and for functional mock-up units; null if it has no observer.
  [[nodiscard]] virtual const Observer* observer() const { return nullptr; }

  /// A follower at the start of a run. The predictor must outlive it.
  [[nodiscard]] virtual std::unique_ptr<Follower> follow() const = 0;
};

/// The inputs that must not be used without a fail-safe: all of them, and none of a predictor that looks after them.
[[nodiscard]] std::vector<Input> guarded_inputs(const Predictor& predictor);

/// The drift of a run [um], row by row, including the lead-in: as it would be predicted during the run. NaN without a
/// prediction.
/// @throws InputError  for readings that lack an input or have it in another unit
[[nodiscard]] std::vector<double> live(const Predictor& predictor, const MachineRun& run);

/// The drift of a run [um] predicted before it: from drive and ambient alone, and from channels that are known ahead. All
/// NaN for a predictor that needs its thermometers.
/// @param known  its readings contain the times, and channels that are known ahead: `speed`, which follows from the
///               cyclogram, or temperatures that a model predicts
[[nodiscard]] std::vector<double> ahead(const Predictor& predictor, MachineRun known);

}  // namespace driftwright::compensation
