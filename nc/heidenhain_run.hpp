#pragma once
// What both languages of Heidenhain's controls share: Q parameters, labels, datum shifts, cycles, M words.

#include <map>
#include <string>
#include <vector>

#include "nc/expression.hpp"
#include "nc/run.hpp"

namespace driftwright {

/// A cycle of the 200 series and its Q parameters, lengths in the program's unit, feeds per minute.
struct HeidenhainCycle {
  int number = 200;
  std::map<int, double> q;
};

/// A block of either language, with the lines of its file that it covers.
struct HeidenhainLine {
  Where where = {};
  std::string text = {};   ///< upper case, without block number, comment and '*'; of a cycle all its lines joined
  std::string label = {};  ///< that it begins, or "0" where a subprogram ends
  bool deletable = false;
  int last_line = 0;  ///< of the file, from 1
};

class HeidenhainRun {
 public:
  HeidenhainRun(NcRun& run, const std::vector<HeidenhainLine>& lines) : run_(run), lines_(lines) {}

  /// Which line is run next.
  std::size_t at = 0;
  std::array<double, 3> pole_m = {0, 0, 0};
  /// Of the last motion in the plane, for what goes on tangentially; none at the start.
  std::optional<std::array<double, 2>> direction;

  [[noreturn]] void fail(const HeidenhainLine& line, const std::string& message) const {
    throw InputError(line.where, message);
  }
  /// The value at text[i]: +10,5 or -Q1; `i` then stands behind it. @param whole  an expression
  double value(const HeidenhainLine& line, const std::string& text, std::size_t& i, bool whole = false) const;
  void set_q(const std::string& name, double x) { q_[name] = x; }
  /// FN n of plain language, Dn of ISO: q is what it sets, a and b are its values. @returns false  where it is none of FN 0 to 8, 13
  bool function(const HeidenhainLine& line, int n, const std::string& q, double a, double b);
  /// FN 9 to 12: whether a and b are so.
  [[nodiscard]] bool compares(const HeidenhainLine& line, int n, double a, double b) const;

  /// Goes to a label's line.
  void go_to(const HeidenhainLine& line, const std::string& label);
  /// CALL LBL, of a subprogram or, with times > 0, of the part before it once more so many times.
  void call(const HeidenhainLine& line, const std::string& label, int times);
  /// LBL 0. Goes on, where nobody called.
  void end_subprogram();

  /// Cycle 7, G54.
  void shift_datum(int axis, double x_m, bool incremental);
  /// Another preset, or a datum table's: nobody here knows by how much.
  void other_datum(const std::string& word);
  void mirror(bool on, const std::string& word);
  void turn(bool on, const std::string& word);

  void define(const HeidenhainCycle& cycle) { cycle_ = cycle; }
  void call_cycle();
  void change_tool();
  /// @returns whether it ends the program. M91 and M140 are for the reader.
  bool m_word(int m);

  /// Moves; `rapid` is FMAX.
  void line_to(const std::array<double, 3>& target_m, bool rapid);
  void circle_to(const std::array<double, 3>& target_m, const std::array<double, 3>& centre_m, bool clockwise, int turns);
  /// Turns of a helix through that incremental polar angle, the last one begun. @throws InputError  for more than 100000
  [[nodiscard]] int turns_of(double angle_deg) const;
  /// An arc that leaves tangentially.
  void tangent_arc_to(const std::array<double, 3>& target_m);

 private:
  void update_transformed() { run_.transformed = mirrored_ || turned_; }
  void drill(const HeidenhainCycle& cycle);

  NcRun& run_;
  const std::vector<HeidenhainLine>& lines_;
  std::map<std::string, double> q_;
  std::vector<std::size_t> returns_;
  std::map<std::size_t, int> repeats_left_;
  std::array<double, 3> shift_m_ = {0, 0, 0};
  bool mirrored_ = false, turned_ = false;
  std::optional<HeidenhainCycle> cycle_;
};

}  // namespace driftwright
