#pragma once
// A machine, and the same machine with each doubt turned, under programmes of a few levels of drive: thousands of programmes in seconds.
//
// While a drive holds, M z' = -K z + f + h q with the ambient h linear from row to row, so that from one row to the next
//
//     z' = Φ z + b + h_k q_0 + (h_k+1 - h_k) q_1
//
// with matrices that level and doubt have once and for all (Van Loan: one exponential of the block matrix). A law that looks at temperatures is taken to first
// order about the state halfway to balance at each level; what a thermostat switches goes in proportion between its two limits where the machine
// comes that warm; of a power of a temperature difference a third of its information is left, of a conductance that follows the difference somewhat more than a half; what runs on for some minutes after the spindle has stopped does so in none, and of heat behind each stop nothing is left. That is for finding programmes: what is found is judged by information_by_channel().
// Source: Van Loan, IEEE Trans. Autom. Control 23 (1978) 395-404.

#include "diagnosis/foresight.hpp"
#include "diagnosis/linear_step.hpp"

namespace driftwright::diagnosis {

class LevelMachine {
 public:
  /// @param levels  what programmes are made of
  /// @param like    a run as long as all programmes, with their channels and ambient; its name is theirs
  /// @param row_s   a reading stands for so much time; the run is a whole number of these
  /// @param noise   of readings every `interval_s`, by channel
  LevelMachine(const Twin& twin, const Doubts& doubts, const std::vector<Drive>& levels, const MeasuredRun& like,
               double row_s, double interval_s, const std::map<std::string, NoiseModel>& noise);

  [[nodiscard]] std::size_t n_steps() const { return n_steps_; }
  /// Of the readings of all channels, as Question wants it. @param level_of_step  n_steps() of them. Any thread
  [[nodiscard]] Eigen::MatrixXd information(const std::vector<int>& level_of_step) const;

 private:
  /// A LinearStep in single precision, which halves the time: outputs are rounded to 10⁻⁶ K, and what a doubt makes of them, by its half or tenth, to 10⁻⁵ K.
  struct Step {
    Eigen::MatrixXf phi;
    Eigen::VectorXf constant, of_ambient, of_rise;
  };
  /// One machine under all levels.
  struct Course {
    std::vector<Step> steps;  ///< by level
    Eigen::VectorXf start;
    Eigen::VectorXf ambient_K;  ///< at the rows
    Eigen::MatrixXf observe;    ///< n_outputs x size
  };
  struct Turned {
    TwinState state;
    double by = 1.0;         ///< x of the knob
    std::size_t course = 0;  ///< whose machine it is
    bool reads = false;      ///< instruments do something of their own
  };
  [[nodiscard]] Course course_of(const TwinState& state, const std::vector<Drive>& levels, Twin::Workspace& workspace) const;
  [[nodiscard]] Eigen::MatrixXd response(const Course& course, const std::vector<int>& level_of_step) const;

  const Twin& twin_;
  MeasuredRun run_;  ///< with a row a step
  std::vector<Drive> levels_;
  double row_s_ = 0.0;
  std::size_t n_steps_ = 0;
  std::vector<int> outputs_;  ///< of the channels
  Eigen::ArrayXXd carry_, gain_, scale_;  ///< of the channels' Whitener, n_channels x n_rows
  std::vector<Course> courses_;
  std::vector<Turned> turned_;  ///< as written, then numbers, then shapes of laws
};

}  // namespace driftwright::diagnosis
