#pragma once
// The commonest blunders in a record, recognised before anything is fitted: a speed in 1/s under rpm, times in minutes under
// seconds, mm under um, a sign, degF or kelvin under degC, two channels exchanged, an ambient thermometer on the machine, a
// drive from another clock.
//
// One principle: a blunder is a transformation of the record's columns. For a transformation of the drive, of the clock or
// of the ambient the scenario as written is simulated once more; for one of readings not at all. A blunder is said if
// - the readings are likelier with it, by ln N + ln 99 + ln 99, than with any fault that changes a course by a gain, an
//   offset or the time that the machine takes, and than with an instrument that reads something else (blunder_match.hpp).
//   N is the number of transformations tried; one record in a hundred has a blunder; and one that is said is right with
//   99 %;
// - with it the scenario meets the readings within its own scatter, and without it it does not.

#include "diagnosis/twin.hpp"

namespace driftwright::diagnosis {

struct Blunder {
  std::string path;     ///< of the record
  std::string what;     ///< what it looks like, a sentence without its full stop
  std::string instead;  ///< what to write instead, a sentence
  double nats = 0.0;    ///< how much likelier the readings are with it, before its price
};

/// A column of a record whose name the scenario does not have, and the sensor or displacement that it looks like.
struct Renaming {
  std::string path, column;  ///< header of the column
  std::string header;        ///< what to call it
};

struct RecordCheck {
  std::vector<Blunder> blunders;    ///< of the drive first, then as sure as they are
  std::vector<Renaming> renamings;  ///< none for a record with a blunder
};

/// Checks a record beside the scenario as written. If more than half of the channels that move are met it costs one
/// simulation, else up to 20. Nothing is said if the scenario has no solution.
/// @param unnamed  temperatures and displacements of the record that the scenario lacks (channels_without_output())
[[nodiscard]] RecordCheck check_record(const MeasuredRun& run, const std::vector<MeasuredChannel>& unnamed,
                                       const Twin& twin);

/// All blunders of some records in one text: what, and what to write instead, a line each.
[[nodiscard]] std::string words(const std::vector<Blunder>& blunders);

}  // namespace driftwright::diagnosis
