#pragma once
// A predictor from `validate` on a stream, with the numbers that it was judged by.

#include <memory>

#include "follow/followed.hpp"

namespace driftwright::follow {

struct FollowOptions {
  std::optional<double> most_rate_um_s = {};  ///< slew limit; none: the model's own, or 1 um/s
  std::optional<double> hold_s = {};          ///< none: the model's own, or 300 s
  std::optional<double> fade_s = {};          ///< none: the model's own, or 600 s
  bool for_picture = false;                   ///< the machine's displacements everywhere are asked for
  std::string watch = {};                     ///< file of a watch's limits; empty: those in the model's file
  bool no_watch = false;                      ///< nothing is watched
  bool despite_verdict = false;               ///< false: what `validate` calls unsafe is refused
  std::optional<double> probe_noise_um = {};  ///< of a probing, 1 sigma; none: the model's own
  std::optional<double> probe_lag_s = {};     ///< from a touch until its value is in a row; none: the model's own
  std::optional<double> tolerance_um = {};    ///< a probing is due where the interval passes a half of it; none: never
};

/// @param path  of its file
/// @throws InputError  for a file that holds no predictor, and for one that no stream can tell enough of: laws of recorded
///                     columns, laws that hold for a part of a run, an ambient that no thermometer reads; for a watch over
///                     what is no observer, or with another model's limits; for one that `validate` calls unsafe
[[nodiscard]] std::unique_ptr<Followed> followed_predictor(const std::string& path, const FollowOptions& options);

}  // namespace driftwright::follow
