#pragma once
// The part that both languages of Heidenhain's controls share: Q parameters, labels, datum shifts, cycles, M words.

#include <map>
#include <string>
#include <vector>

#include "nc/execution.hpp"
#include "nc/expression.hpp"

namespace driftwright {

/// A cycle of the 200 series and its Q parameters, lengths in the program's unit, feeds per minute.
struct HeidenhainCycle {
  int number = 200;
  std::map<int, double> q;
};

/// A block in either language, with the lines of the file that it covers.
struct HeidenhainLine {
  Where where = {};
  std::string text = {};   ///< upper case, without block number, comment and '*'; of a cycle all its lines, joined
  std::string label = {};  ///< the label that begins here, or "0" where a subprogram ends
  bool deletable = false;
  int last_line = 0;  ///< of the file, from 1
};

/// The state of a running program, which the two readers act on.
class HeidenhainExecution {
 public:
  HeidenhainExecution(NcExecution& run, const std::vector<HeidenhainLine>& lines) : run_(run), lines_(lines) {}

  /// Index of the line to run next.
  std::size_t at = 0;
  std::array<double, 3> pole_m = {0, 0, 0};
  /// Direction of the last motion in the plane, for tangential arcs; none at the start.
  std::optional<std::array<double, 2>> direction;

  [[noreturn]] void fail(const HeidenhainLine& line, const std::string& message) const {
    throw InputError(line.where, message);
  }
  /// The value at text[i]: +10,5 or -Q1; `i` is then the index after it. @param whole  an expression is allowed
  double value(const HeidenhainLine& line, const std::string& text, std::size_t& i, bool whole = false) const;
  void set_q(const std::string& name, double x) { q_[name] = x; }
  /// FN n of plain language, Dn of ISO; sets q from a and b. @returns false  if n is none of 0 to 8, 13
  bool function(const HeidenhainLine& line, int n, const std::string& q, double a, double b);
  /// FN 9 to 12: the result of the comparison of a and b.
  [[nodiscard]] bool compares(const HeidenhainLine& line, int n, double a, double b) const;

  /// Continues at a label's line.
  void go_to(const HeidenhainLine& line, const std::string& label);
  /// CALL LBL: calls a subprogram or, with times > 0, repeats the part before this line that many times.
  void call(const HeidenhainLine& line, const std::string& label, int times);
  /// LBL 0. Without a call the program simply continues.
  void end_subprogram();

  /// Cycle 7, G54: shifts the datum of an axis.
  void shift_datum(int axis, double x_m, bool incremental);
  /// Another preset, or one of a datum table: the shift is unknown.
  void other_datum(const std::string& word);
  void mirror(bool on, const std::string& word);
  void turn(bool on, const std::string& word);

  void define(const HeidenhainCycle& cycle) { cycle_ = cycle; }
  void call_cycle();
  void change_tool();
  /// @returns true  if it ends the program. M91 and M140 are handled by the reader.
  bool m_word(int m);

  /// Moves in a straight line; `rapid` means FMAX.
  void line_to(const std::array<double, 3>& target_m, bool rapid);
  void circle_to(const std::array<double, 3>& target_m, const std::array<double, 3>& centre_m, bool clockwise, int turns);
  /// Turns of a helix through that incremental polar angle, the last one begun. @throws InputError  for more than 100000
  [[nodiscard]] int turns_of(double angle_deg) const;
  /// An arc that leaves tangentially.
  void tangent_arc_to(const std::array<double, 3>& target_m);

 private:
  void update_transformed() { run_.transformed = mirrored_ || turned_; }
  void drill(const HeidenhainCycle& cycle);

  NcExecution& run_;
  const std::vector<HeidenhainLine>& lines_;
  std::map<std::string, double> q_;
  std::vector<std::size_t> returns_;
  std::map<std::size_t, int> repeats_left_;
  std::array<double, 3> shift_m_ = {0, 0, 0};
  bool mirrored_ = false, turned_ = false;
  std::optional<HeidenhainCycle> cycle_;
};

}  // namespace driftwright
