#pragma once
// Simulates a machine, and the same machine with each doubt applied, under programmes of a few levels of drive: thousands
// of programmes in seconds.
//
// At a constant drive, M z' = -K z + f + h q with the ambient h linear from row to row, so that from one row to the next
//
//     z' = Φ z + b + h_k q_0 + (h_k+1 - h_k) q_1
//
// with matrices that are computed once for each level and doubt (Van Loan: one exponential of the block matrix). Laws of
// temperatures are linearised at the state halfway to balance of each level. A thermostat switches in proportion between
// its two limits if the machine becomes that warm. Of a power of a temperature difference a third of the information is
// kept, of a conductance that follows the difference somewhat more than a half. Heat that continues for some minutes
// after the spindle has stopped is omitted, and so is heat after each stop. This is good enough to find programmes;
// information_by_channel() judges those that are found.
// Source: Van Loan, IEEE Trans. Autom. Control 23 (1978) 395-404.

#include "diagnosis/foresight.hpp"
#include "diagnosis/linear_step.hpp"

namespace driftwright::diagnosis {

class LevelMachine {
 public:
  /// @param levels  the levels of programmes
  /// @param like    a run as long as all programmes, with their channels, ambient and name
  /// @param row_s   time of one row of the simulation; the run is a whole number of them
  /// @param noise   of readings every `interval_s`, by channel
  LevelMachine(const Twin& twin, const Doubts& doubts, const std::vector<Drive>& levels, const MeasuredRun& like,
               double row_s, double interval_s, const std::map<std::string, NoiseModel>& noise);

  [[nodiscard]] std::size_t n_steps() const { return n_steps_; }
  /// The information of all channels, for a Question. @param level_of_step  n_steps() of them. May be called from any
  /// thread
  [[nodiscard]] Eigen::MatrixXd information(const std::vector<int>& level_of_step) const;

 private:
  /// A LinearStep in single precision, which halves the time: outputs are rounded to 10⁻⁶ K, and the effect of a doubt,
  /// taken at a half or tenth of it, to 10⁻⁵ K.
  struct Step {
    Eigen::MatrixXf phi;
    Eigen::VectorXf constant, of_ambient, of_rise;
  };
  /// One machine under all levels.
  struct Course {
    std::vector<Step> steps;  ///< one per level
    Eigen::VectorXf start;
    Eigen::VectorXf ambient_K;  ///< at the rows
    Eigen::MatrixXf observe;    ///< n_outputs x size
  };
  struct Turned {
    TwinState state;
    double by = 1.0;         ///< x of the knob
    std::size_t course = 0;  ///< index of the machine that it uses
    bool reads = false;      ///< the readings change, besides the machine
  };
  [[nodiscard]] Course course_of(const TwinState& state, const std::vector<Drive>& levels, Twin::Workspace& workspace) const;
  [[nodiscard]] Eigen::MatrixXd response(const Course& course, const std::vector<int>& level_of_step) const;

  const Twin& twin_;
  MeasuredRun run_;  ///< with one row per step
  std::vector<Drive> levels_;
  double row_s_ = 0.0;
  std::size_t n_steps_ = 0;
  std::vector<int> outputs_;              ///< of the channels
  Eigen::ArrayXXd carry_, gain_, scale_;  ///< of the channels' Whitener, n_channels x n_rows
  std::vector<Course> courses_;
  std::vector<Turned> turned_;  ///< as written, then numbers, then shapes of laws
};

}  // namespace driftwright::diagnosis
