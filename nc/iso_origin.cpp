#include "nc/iso_origin.hpp"

namespace driftwright {

IsoOrigin::IsoOrigin(NcExecution& run) : run_(run) {
  for (int system = 1; system <= 9; ++system) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto given = run.settings().parameters.find(5221 + 20 * (system - 1) + axis);
      if (given != run.settings().parameters.end()) offset_m_[{system, axis}] = 1e-3 * given->second;
    }
  }
}

void IsoOrigin::use(int system, const std::string& word) {
  if (named_ && system != system_) {
    bool known = true;
    for (int axis = 0; axis < 3; ++axis)
      known = known && offset_m_.contains({system_, axis}) && offset_m_.contains({system, axis});
    if (known) {
      for (int axis = 0; axis < 3; ++axis)
        run_.motion.position_m[axis] += offset_m_[{system_, axis}] - offset_m_[{system, axis}];
    } else {
      run_.note(word,
                "this is another coordinate system, and what it holds is known only at the machine; positions are counted "
                "as if in "
                "the one before");
    }
  }
  named_ = true;
  system_ = system;
}

void IsoOrigin::set(int system, int axis, double offset_m) {
  const auto before = offset_m_.find({system, axis});
  if (system == system_) {
    if (before != offset_m_.end()) {
      run_.motion.position_m[axis] += before->second - offset_m;
    } else {
      run_.note("G10 L2",
                "what the offset held before is known only at the machine; positions are counted as if in the one before");
      run_.forget();
    }
  }
  offset_m_[{system, axis}] = offset_m;
}

void IsoOrigin::set_here(int system, int axis, double x_m) {
  double& position_m = run_.motion.position_m[axis];
  const auto before = offset_m_.find({system, axis});
  if (system == system_) {
    if (before != offset_m_.end()) before->second += position_m - x_m;
    position_m = x_m;
    return;
  }
  const auto own = offset_m_.find({system_, axis});
  if (own != offset_m_.end()) offset_m_[{system, axis}] = own->second + position_m - x_m;
}

void IsoOrigin::set_shift(int axis, double shift_m) {
  run_.motion.position_m[axis] += shift_m_[axis] - shift_m;
  shift_m_[axis] = shift_m;
}

void IsoOrigin::shift_here(int axis, double x_m) {
  shift_m_[axis] += run_.motion.position_m[axis] - x_m;
  run_.motion.position_m[axis] = x_m;
}

void IsoOrigin::clear_shift() {
  for (int axis = 0; axis < 3; ++axis) set_shift(axis, 0.0);
}

}  // namespace driftwright
