#include "diagnosis/blunders.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/foreign_temperature.hpp"
#include "base/parallel.hpp"
#include "diagnosis/blunder_drives.hpp"
#include "diagnosis/blunder_match.hpp"
#include "diagnosis/no_solution.hpp"
#include "effects/doubt.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kSaidIsRight = 0.99;     // probability from which a blunder is said
constexpr double kRecordHasOne = 0.01;    // share of records with a blunder
constexpr Eigen::Index kFewestPairs = 3;  // readings
// Longest record that a longer clock is tried for: a machine that is integrated in steps takes as long as its record.
constexpr double kLongest_s = 30.0 * 86400.0, kLongestInSteps_s = 86400.0;

double log_odds(double probability) {
  return std::log(probability / (1.0 - probability));
}

/// The price of a blunder, of so many that were tried.
double price_of_blunder(std::size_t n_tried) {
  return std::log(static_cast<double>(std::max<std::size_t>(1, n_tried))) + log_odds(kSaidIsRight) - log_odds(kRecordHasOne);
}

/// Readings beside a row of a prediction, without missing ones.
ReadBeside read_beside(const Eigen::VectorXd& value, const Eigen::VectorXd& model, bool is_temperature) {
  ReadBeside r;
  r.is_temperature = is_temperature;
  const Eigen::Index n = (value.array() == value.array()).count();
  r.read.resize(n);
  r.model.resize(n);
  Eigen::Index k = 0;
  for (Eigen::Index i = 0; i < value.size(); ++i) {
    if (std::isnan(value[i])) continue;
    r.read[k] = value[i];
    r.model[k++] = model[i];
  }
  return r;
}

ReadBeside read_beside(const MeasuredChannel& c, const Eigen::MatrixXd& prediction, int output) {
  return read_beside(c.value, prediction.row(output).transpose(), c.unit == "K");
}

bool says_something(const MeasuredChannel& c) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  Eigen::Index n = 0;
  for (const double v : c.value) {
    if (std::isnan(v)) continue;
    low = std::min(low, v);
    high = std::max(high, v);
    ++n;
  }
  return n >= kFewestPairs && high > low;
}

/// A record beside the prediction of the scenario as written.
struct Beside {
  const MeasuredRun& run;
  Eigen::MatrixXd prediction;
  std::vector<double> independent = {};  ///< readings of each channel
  std::vector<Match> matched = {};
  std::vector<char> is_met = {};  ///< also channels that say nothing
};

Beside beside_of(const MeasuredRun& run, Eigen::MatrixXd prediction) {
  Beside b{.run = run, .prediction = std::move(prediction)};
  for (const MeasuredChannel& c : run.channels) {
    if (!says_something(c)) {
      b.independent.push_back(1.0);
      b.matched.emplace_back();
      b.is_met.push_back(1);
      continue;
    }
    const ReadBeside r = read_beside(c, b.prediction, c.output);
    b.independent.push_back(independent_readings(r));
    b.matched.push_back(match(r, {}, b.independent.back()));
    b.is_met.push_back(b.matched.back().is_met() ? 1 : 0);
  }
  return b;
}

/// Whether at most half of the channels that move, or should, are met: else no other drive can be said (gain_with()).
bool few_met(const Beside& b) {
  int n_moving = 0, n_met = 0;
  for (std::size_t c = 0; c < b.run.channels.size(); ++c) {
    if (!says_something(b.run.channels[c])) continue;
    const ReadBeside r = read_beside(b.run.channels[c], b.prediction, b.run.channels[c].output);
    if (std::max(course_of(r.read), course_of(r.model)) < 2.0 * reading_noise(r.read)) continue;
    ++n_moving;
    n_met += b.is_met[c] != 0 ? 1 : 0;
  }
  return n_moving > 0 && 2 * n_met <= n_moving;
}

/// The evidence of a channel without a blunder: a fault of the machine, or an instrument that reads something else.
double nats_without(const ReadBeside& r, double n_independent) {
  return std::max(match(r, {}, n_independent).nats, nats_of_unrelated(r, n_independent));
}

// --- readings ------------------------------------------------------------------------------------------

/// What a channel shows if its header is wrong.
struct ForeignHeader {
  Showing shown;
  std::string meant;    // unit; "": the sign
  std::string instead;  // for the map of the file
};

std::vector<ForeignHeader> foreign_headers(const MeasuredChannel& c, double reference_C, bool may_be_turned) {
  std::vector<ForeignHeader> list;
  if (c.unit == "K") {
    const double zero_C = c.recorded_unit == "degC" ? reference_C : 0.0;  // what reads 0 in `value`
    for (const TemperatureScale& s : kForeignScales)
      list.push_back({{s.per_K, s.per_K * reference_C + s.zero - zero_C},
                      s.unit,
                      s.per_K == 1.0 ? "unit: degC, offset: -273.15 K" : "unit: degF"});
    return list;
  }
  const bool is_tilt = c.unit == "rad", is_mm = c.recorded_unit == "mm";
  const char* greater = is_tilt ? "mrad" : is_mm ? "m" : "mm";
  const char* smaller = is_tilt ? "nrad" : is_mm ? "um" : "nm";
  list.push_back({{1e-3, 0.0}, greater, fmt::format("unit: {}", greater)});
  list.push_back({{1e3, 0.0}, smaller, fmt::format("unit: {}", smaller)});
  if (may_be_turned) list.push_back({{-1.0, 0.0}, "", "factor: -1"});
  return list;
}

/// Whether more thermometers go as the scenario does than otherwise. A machine that was warm at the start cools while the
/// scenario warms, and its displacements decrease with the correct sign.
bool thermometers_follow(const Beside& b) {
  int n_following = 0, n_other = 0;
  for (const MeasuredChannel& c : b.run.channels) {
    if (c.unit != "K" || !says_something(c)) continue;
    const ReadBeside r = read_beside(c, b.prediction, c.output);
    const double n = static_cast<double>(r.read.size());
    ++(match(r, {}, n).nats > nats_of_unrelated(r, n) ? n_following : n_other);
  }
  return n_following > n_other;
}

Blunder header_blunder(const Beside& b, std::size_t at, const ForeignHeader& h, double reference_C, double nats) {
  const MeasuredChannel& c = b.run.channels[at];
  const ReadBeside r = read_beside(c, b.prediction, c.output);
  const std::string header = c.name + "_" + c.recorded_unit;
  const double scale = c.unit == "K" ? 1.0 : c.recorded_unit == "mm" ? 1e3 : 1e6;
  const double zero = c.unit == "K" && c.recorded_unit == "degC" ? reference_C : 0.0;
  const double low = scale * r.read.minCoeff() + zero, high = scale * r.read.maxCoeff() + zero;
  const std::string range =
      fmt::format("it reads {:.3g} to {:.3g} where the scenario has {:.3g} to {:.3g} {}", low, high,
                  scale * r.model.minCoeff() + zero, scale * r.model.maxCoeff() + zero, c.recorded_unit);
  std::string what = h.meant.empty() ? fmt::format("{} seems to have the wrong sign: {}", header, range)
                                     : fmt::format("{} looks like {}: {}", header, h.meant, range);
  std::string instead = fmt::format("Write `{}` for {} in the map of the file", h.instead, c.name);
  if (c.unit == "m" && (h.meant == "mm" || h.meant == "um"))
    instead = fmt::format("Call the column {}_{}, or write `{}` for it in the map of the file", c.name, h.meant, h.instead);
  if (h.meant.empty()) instead += ", or change the sign in the scenario";
  return {.path = b.run.path, .what = std::move(what), .instead = std::move(instead), .nats = nats};
}

/// A blunder of readings, and the channels that it concerns.
struct OfReadings {
  Blunder blunder;
  std::vector<std::size_t> channels;
};

/// Whether no machine reads such temperatures, but it may if they are shown so: then a fault may be there, too, and the
/// scenario need not meet them.
bool is_impossible_but_for(const ReadBeside& r, const Showing& shown) {
  if (!r.is_temperature) return false;
  const double read_K = r.read.mean(), model_K = r.model.mean();
  return std::abs(read_K - model_K) > kFarBeside_K &&
         std::abs((read_K - shown.shift) / shown.scale - model_K) <= kFarBeside_K;
}

void try_headers(const Beside& b, std::size_t at, double reference_C, bool may_be_turned, std::vector<OfReadings>& tried,
                 std::size_t& n_tried) {
  const MeasuredChannel& c = b.run.channels[at];
  const ReadBeside r = read_beside(c, b.prediction, c.output);
  for (const ForeignHeader& h : foreign_headers(c, reference_C, may_be_turned)) {
    ++n_tried;
    const Match mended = match(r, h.shown, b.independent[at]);
    if (b.is_met[at] || !(mended.is_met() || is_impossible_but_for(r, h.shown))) continue;
    const double nats = mended.nats - nats_without(r, b.independent[at]);
    tried.push_back({header_blunder(b, at, h, reference_C, nats), {at}});
  }
}

/// One of two channels beside the simulated course of the other one.
struct CrossMatch {
  double gain_nats = 0.0, beyond_scatter = 0.0;
};
CrossMatch cross_match(const Beside& b, std::size_t at, std::size_t other, double course) {
  const MeasuredChannel& c = b.run.channels[at];
  const ReadBeside own = read_beside(c, b.prediction, c.output),
                   there = read_beside(c, b.prediction, b.run.channels[other].output);
  const double n = std::min(b.independent[at], independent_readings(there));
  const Match m = match(there, {}, n);
  return {m.nats - nats_without(own, n), beyond_scatter(m, there.read, course)};
}

void try_exchange(const Beside& b, std::size_t i, std::size_t j, std::vector<OfReadings>& tried, std::size_t& n_tried) {
  ++n_tried;
  const MeasuredChannel &a = b.run.channels[i], &c = b.run.channels[j];
  const Eigen::ArrayXd read_a = read_beside(a, b.prediction, a.output).read,
                       read_c = read_beside(c, b.prediction, c.output).read;
  const double course = std::max(course_of(read_a), course_of(read_c));  // one of the two may hardly move
  // Both gains are off at once, in opposite directions, so the two count together.
  if (std::hypot(beyond_scatter(b.matched[i], read_a, course), beyond_scatter(b.matched[j], read_c, course)) <= 1.0) return;
  const CrossMatch one = cross_match(b, i, j, course), other = cross_match(b, j, i, course);
  if (std::hypot(one.beyond_scatter, other.beyond_scatter) > 1.0) return;
  tried.push_back(
      {{.path = b.run.path,
        .what =
            fmt::format("{} and {} look exchanged: each reads what the scenario simulates for the other", a.name, c.name),
        .instead = fmt::format("Exchange the two names in the header of the file or in its map ({}_{} and {}_{})", a.name,
                               a.recorded_unit, c.name, c.recorded_unit),
        .nats = one.gain_nats + other.gain_nats},
       {i, j}});
}

/// The blunders of readings, the likeliest first, each channel in one of them.
std::vector<Blunder> reading_blunders(const Beside& b, double reference_C, std::size_t n_tried) {
  std::vector<OfReadings> tried;
  const bool may_be_turned = thermometers_follow(b);
  for (std::size_t i = 0; i < b.run.channels.size(); ++i) {
    if (!says_something(b.run.channels[i])) continue;
    try_headers(b, i, reference_C, may_be_turned, tried, n_tried);
    for (std::size_t j = i + 1; j < b.run.channels.size(); ++j) {
      if (b.run.channels[j].unit == b.run.channels[i].unit && says_something(b.run.channels[j]))
        try_exchange(b, i, j, tried, n_tried);
    }
  }
  std::stable_sort(tried.begin(), tried.end(),
                   [](const OfReadings& x, const OfReadings& y) { return x.blunder.nats > y.blunder.nats; });
  std::vector<Blunder> said;
  std::vector<char> is_taken(b.run.channels.size(), 0);
  for (OfReadings& t : tried) {
    const auto taken = [&](std::size_t c) { return is_taken[c] != 0; };
    if (t.blunder.nats < price_of_blunder(n_tried) || std::any_of(t.channels.begin(), t.channels.end(), taken)) continue;
    for (std::size_t c : t.channels) is_taken[c] = 1;
    said.push_back(std::move(t.blunder));
  }
  return said;
}

// --- the drive ------------------------------------------------------------------------------------------

/// The evidence of several channels. One fault of the machine may change all gains, so the largest price of a gain counts
/// once if that is cheaper than one for each.
struct AllChannels {
  double nats = 0.0;
  int n_met = 0;
};
AllChannels all_channels(const std::vector<ReadBeside>& channels, const std::vector<double>& independent,
                         bool without_blunder) {
  AllChannels t;
  double each = 0.0, in_common = 0.0, dearest = 0.0;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const Match priced = match(channels[c], {}, independent[c]), free = match(channels[c], {}, independent[c], false);
    each += without_blunder ? nats_without(channels[c], independent[c]) : priced.nats;
    in_common += free.nats;
    dearest = std::max(dearest, 0.5 * std::pow(std::log(free.gain) / effects::kFactorSd, 2));
    t.n_met += priced.is_met() ? 1 : 0;
  }
  t.nats = std::max(each, in_common - dearest);
  return t;
}

/// How much likelier the readings are with another drive; none if it does not meet most of the channels that the two
/// predictions differ in, or if the drive as recorded meets most of them. Another ambient changes them less, so it is
/// sufficient that one channel is not met as recorded.
std::optional<double> gain_with(const Beside& b, const OtherDrive& o, const Eigen::MatrixXd& prediction) {
  const MeasuredRun& other = o.run;
  std::vector<ReadBeside> before, after;
  std::vector<double> independent;
  double as_ambient = 0.0;  // of a course that was read as a temperature of the machine, and now as the ambient
  for (std::size_t c = 0; c < b.run.channels.size(); ++c) {
    const MeasuredChannel& channel = b.run.channels[c];
    if (!says_something(channel) || !says_something(other.channels[c])) continue;
    ReadBeside was = read_beside(channel, b.prediction, channel.output),
               is = read_beside(other.channels[c], prediction, channel.output);
    const Eigen::ArrayXd differ = was.model.size() == is.model.size() ? is.model - was.model : is.model;
    const double apart = std::sqrt((differ - differ.mean()).square().mean());
    if (apart < 2.0 * reading_noise(was.read)) continue;
    independent.push_back(std::min(independent_readings(was), independent_readings(is)));
    if (channel.name == o.ambient_from)
      as_ambient = nats_of_unrelated(was, independent.back()) - nats_of_unrelated(is, independent.back());
    before.push_back(std::move(was));
    after.push_back(std::move(is));
  }
  if (before.empty()) return std::nullopt;
  const AllChannels as_recorded = all_channels(before, independent, true), mended = all_channels(after, independent, false);
  const auto n = static_cast<int>(before.size());
  if (2 * mended.n_met <= n || (o.is_of_ambient() ? as_recorded.n_met == n : 2 * as_recorded.n_met > n)) return std::nullopt;
  return mended.nats - as_recorded.nats + as_ambient;
}

std::optional<Eigen::MatrixXd> readings_as_written(const Twin& twin, const MeasuredRun& run, Twin::Workspace& workspace) {
  Eigen::MatrixXd prediction;
  if (!has_solution([&] { prediction = twin.readings(twin.as_written(), run, workspace); })) return std::nullopt;
  return prediction.allFinite() ? std::optional(std::move(prediction)) : std::nullopt;
}

/// The body whose simulated temperature the recorded ambient follows, and how much likelier the recorded ambient is then.
struct BodyAtAmbient {
  std::string name;
  double nats = -std::numeric_limits<double>::infinity();
};
std::optional<BodyAtAmbient> body_at_ambient(const Twin& twin, const MeasuredRun& run, const Eigen::MatrixXd& prediction) {
  const Eigen::VectorXd ambient = ambient_rows(run);
  if (!((ambient.array() - ambient[0]).abs().maxCoeff() > 0.0)) return std::nullopt;
  BodyAtAmbient body;
  for (std::size_t o = 0; o < twin.outputs().name.size(); ++o) {
    if (twin.outputs().unit[o] != "K" || twin.outputs().ambient[static_cast<Eigen::Index>(o)] != 0.0) continue;
    const ReadBeside r = read_beside(ambient, prediction.row(static_cast<Eigen::Index>(o)).transpose(), true);
    const double n = independent_readings(r);
    const Match m = match(r, {}, n);
    const double nats = m.nats - nats_of_unrelated(r, n);
    if (m.is_met() && nats > body.nats) body = {twin.outputs().name[o], nats};
  }
  return body.name.empty() ? std::nullopt : std::optional(body);
}

/// How much likelier the readings are on a machine that is merely slower or faster, at most.
double gain_of_other_pace(const Beside& b, double factor, const Twin& twin) {
  double most = -std::numeric_limits<double>::infinity();
  Twin::Workspace workspace(twin);
  for (const double share : {0.25, 0.5, 0.75}) {
    const MeasuredRun slower = with_clock(b.run, std::pow(factor, share));
    const auto prediction = readings_as_written(twin, slower, workspace);
    if (!prediction) continue;
    const double price = 0.5 * std::pow(share * std::log(factor) / effects::kFactorSd, 2);
    std::vector<ReadBeside> was, is;
    std::vector<double> independent;
    for (const MeasuredChannel& c : b.run.channels) {
      if (!says_something(c)) continue;
      was.push_back(read_beside(c, b.prediction, c.output));
      is.push_back(read_beside(c, *prediction, c.output));
      independent.push_back(std::min(independent_readings(was.back()), independent_readings(is.back())));
    }
    most = std::max(most, all_channels(is, independent, true).nats - all_channels(was, independent, true).nats - price);
  }
  return most;
}

struct OfDrive {
  Blunder blunder;
  MeasuredRun run;  // without it
  Eigen::MatrixXd prediction;
};

/// The likeliest blunder of drive, clock or ambient.
std::optional<OfDrive> drive_blunder(const Beside& b, const Twin& twin, std::size_t& n_tried) {
  const double longest_s = twin.machine().system.is_linear() ? kLongest_s : kLongestInSteps_s;
  std::vector<OtherDrive> others = other_drives(b.run, b.is_met, longest_s);
  const bool may_be_other_drive = few_met(b);
  std::erase_if(others, [&](const OtherDrive& o) { return !o.is_of_ambient() && !may_be_other_drive; });
  if (std::all_of(b.is_met.begin(), b.is_met.end(), [](char met) { return met != 0; })) others.clear();
  n_tried += others.size();
  std::vector<std::optional<Eigen::MatrixXd>> predictions(others.size());
  for_each_index(
      others.size(), [&] { return Twin::Workspace(twin); },
      [&](std::size_t i, Twin::Workspace& workspace) {
        predictions[i] = readings_as_written(twin, others[i].run, workspace);
      });
  std::optional<std::size_t> best;
  double most = price_of_blunder(n_tried);
  for (std::size_t i = 0; i < others.size(); ++i) {
    if (!predictions[i]) continue;
    OtherDrive& o = others[i];
    std::optional<double> nats = gain_with(b, o, *predictions[i]);
    if (!nats) continue;
    std::optional<BodyAtAmbient> body;
    if (o.is_still_air) {
      body = body_at_ambient(twin, b.run, *predictions[i]);
      if (!body || *nats <= 0.0) continue;
      *nats += body->nats;
    }
    if (*nats < most) continue;
    if (o.time_factor != 1.0) nats = *nats - std::max(0.0, gain_of_other_pace(b, o.time_factor, twin));
    if (*nats < most) continue;
    if (body) {
      const double reference_C = twin.reference_K() - kZeroCelsius_K;
      o.what = fmt::format(
          "ambient_degC looks like a thermometer on the machine: it follows what the scenario simulates for {}, and the "
          "simulation agrees if the air stays at {:.1f} degC",
          body->name, o.run.ambient.at(0.0) + reference_C);
      o.instead = fmt::format(
          "Call the column by the name of a sensor at {} and write the temperature of the air into the scenario "
          "(`ambient`), "
          "or record it with a thermometer in the air",
          body->name);
    }
    most = *nats;
    best = i;
  }
  if (!best) return std::nullopt;
  OtherDrive& o = others[*best];
  return OfDrive{{.path = b.run.path, .what = o.what, .instead = o.instead, .nats = most},
                 std::move(o.run),
                 *std::move(predictions[*best])};
}

// --- names ------------------------------------------------------------------------------------------

/// The name that a column without one probably has: of the outputs that the record lacks, the one that it meets, if it is
/// clearly likelier than each other and than none.
std::optional<Renaming> renaming_of(const MeasuredRun& run, const MeasuredChannel& c, const Twin& twin,
                                    const Eigen::MatrixXd& prediction) {
  const solver::Outputs& own = twin.machine().system.outputs;
  std::string best;
  double most = -std::numeric_limits<double>::infinity(), second = most;
  std::size_t n_tried = 0;
  for (std::size_t o = 0; o < own.name.size(); ++o) {
    if (own.unit[o] != c.unit || run.find(own.name[o])) continue;
    ++n_tried;
    const ReadBeside r = read_beside(c, prediction, static_cast<int>(o));
    const double n = independent_readings(r);
    const Match m = match(r, {}, n);
    const double nats = m.is_met() ? m.nats - nats_of_unrelated(r, n) : 0.0;
    second = std::max(second, std::min(nats, most));
    if (nats <= most) continue;
    most = nats;
    best = own.name[o];
  }
  if (best.empty() || most < price_of_blunder(n_tried) || (n_tried > 1 && most - second < log_odds(kSaidIsRight)))
    return std::nullopt;
  return Renaming{.path = run.path, .column = c.name + "_" + c.recorded_unit, .header = best + "_" + c.recorded_unit};
}

}  // namespace

RecordCheck check_record(const MeasuredRun& run, const std::vector<MeasuredChannel>& unnamed, const Twin& twin) {
  RecordCheck check;
  Twin::Workspace workspace(twin);
  auto prediction = readings_as_written(twin, run, workspace);
  if (!prediction) return check;
  const double reference_C = twin.reference_K() - kZeroCelsius_K;
  const Beside b = beside_of(run, *std::move(prediction));
  std::size_t n_tried = 0;
  auto drive = drive_blunder(b, twin, n_tried);
  check.blunders = reading_blunders(b, reference_C, n_tried);
  double of_all = 0.0;
  for (const Blunder& r : check.blunders) of_all += r.nats;
  if (drive && drive->blunder.nats > of_all) {
    check.blunders = reading_blunders(beside_of(drive->run, std::move(drive->prediction)), reference_C, n_tried);
    check.blunders.insert(check.blunders.begin(), std::move(drive->blunder));
  }
  if (!check.blunders.empty()) return check;
  for (const MeasuredChannel& c : unnamed) {
    if (!says_something(c)) continue;
    if (auto renaming = renaming_of(run, c, twin, b.prediction)) check.renamings.push_back(*std::move(renaming));
  }
  return check;
}

std::string words(const std::vector<Blunder>& blunders) {
  std::string text;
  for (const Blunder& b : blunders)
    text += fmt::format("{}{}: {}. {}.", text.empty() ? "" : "\n", b.path, b.what, b.instead);
  return text;
}

}  // namespace driftwright::diagnosis
