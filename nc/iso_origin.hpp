#pragma once
// The origin of an RS-274 program's coordinates: work offsets and, added to them, the shift of G52 and G92.

#include <array>
#include <map>
#include <string>

#include "nc/execution.hpp"

namespace driftwright {

/// Machine position = offset of the active system + shift + program position. An offset is known from
/// NcSettings::parameters (5221 ... 5223 of G54, 20 more for each next system, in mm) or from G10. If an offset is unknown,
/// a change of the system does not change positions.
class IsoOrigin {
 public:
  explicit IsoOrigin(NcExecution& run);

  [[nodiscard]] int system() const { return system_; }
  /// True once the program has named a system.
  [[nodiscard]] bool system_named() const { return named_; }
  /// Selects a system; G54 is 1. @param word  for a note
  void use(int system, const std::string& word);
  /// G10 L2: sets an offset.
  void set(int system, int axis, double offset_m);
  /// G10 L20: sets an offset such that the tool is at x_m.
  void set_here(int system, int axis, double x_m);
  /// G52: sets the shift.
  void set_shift(int axis, double shift_m);
  /// G92: sets the shift such that the tool is at x_m.
  void shift_here(int axis, double x_m);
  /// G92.1, G92.2: clears the shift.
  void clear_shift();

 private:
  NcExecution& run_;
  int system_ = 1;
  bool named_ = false;
  std::map<std::pair<int, int>, double> offset_m_;  // of a system and an axis, if known
  std::array<double, 3> shift_m_ = {0, 0, 0};
};

}  // namespace driftwright
