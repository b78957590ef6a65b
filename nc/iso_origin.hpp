#pragma once
// Where the coordinates of an RS-274 program count from: work offsets and the shift of G52 and G92 above them.

#include <array>
#include <map>
#include <string>

#include "nc/run.hpp"

namespace driftwright {

/// position of the machine = offset of the system in force + shift + position of the program. What the offsets hold is known from
/// NcSettings::parameters (5221 ... 5223 of G54, 20 more for each after it, in mm) or G10; else a change from one to another leaves positions as they are.
class IsoOrigin {
 public:
  explicit IsoOrigin(NcRun& run);

  [[nodiscard]] int system() const { return system_; }
  /// Whether the program has said it.
  [[nodiscard]] bool system_named() const { return named_; }
  /// G54 is 1. @param word  for a note
  void use(int system, const std::string& word);
  /// G10 L2.
  void set(int system, int axis, double offset_m);
  /// G10 L20: so that the tool stands at x_m.
  void set_here(int system, int axis, double x_m);
  /// G52.
  void set_shift(int axis, double shift_m);
  /// G92: so that the tool stands at x_m.
  void shift_here(int axis, double x_m);
  /// G92.1, G92.2.
  void clear_shift();

 private:
  NcRun& run_;
  int system_ = 1;
  bool named_ = false;
  std::map<std::pair<int, int>, double> offset_m_;  // of a system and an axis, where it is known
  std::array<double, 3> shift_m_ = {0, 0, 0};
};

}  // namespace driftwright
