#include "identification/record_roles.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <set>

#include "base/characters.hpp"
#include "base/errors.hpp"
#include "base/median.hpp"
#include "base/record_channel.hpp"
#include "base/usual_step.hpp"
#include "identification/lagged_inputs.hpp"

namespace driftwright::identification {
namespace {

constexpr double kAmbientFollows = 0.5;  // share of its squares that drives explain; an ambient has less
constexpr double kHole = 10.0;           // in usual time steps
constexpr std::array kDriveUnits = {"W", "V", "percent", "W_m2", "1", "mm_min", "count"};
constexpr std::array kAmbientNames = {"ambient", "room", "hall", "outdoor", "environment", "surroundings"};

/// True if one of the parts of a name, split at '_', is a word for an ambient.
bool is_ambient_name(const std::string& name) {
  return std::any_of(kAmbientNames.begin(), kAmbientNames.end(), [&](const std::string& word) {
    return ("_" + lower_case(name) + "_").find("_" + word + "_") != std::string::npos;
  });
}

/// True if a scenario allows the name for an output, a column or a node.
bool is_plain(const std::string& name) {
  return !name.empty() &&
         std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; });
}

bool has_readings(std::span<const Record> records, const std::string& channel) {
  return std::all_of(records.begin(), records.end(), [&](const Record& r) {
    const std::vector<double>& v = r.at(channel).values;
    return std::any_of(v.begin(), v.end(), [](double x) { return std::isfinite(x); });
  });
}

bool changes(std::span<const Record> records, const std::string& channel) {
  double least = 1e300, most = -1e300;
  for (const Record& r : records) {
    const Eigen::VectorXd v = held(r.at(channel));
    least = std::min(least, v.minCoeff());
    most = std::max(most, v.maxCoeff());
  }
  return most > least;
}

/// Share of a thermometer's squares, about its mean in each record, that lags of the drives explain, with common
/// coefficients for all records.
double follows(std::span<const Record> records, const std::vector<std::string>& drives, const std::string& thermometer) {
  constexpr std::array kLags = {0.01, 0.05, 0.2};  // as shares of a record
  const auto n = static_cast<Eigen::Index>(kLags.size() * drives.size());
  Eigen::MatrixXd g = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd c = Eigen::VectorXd::Zero(n);
  double all = 0.0;
  for (const Record& r : records) {
    const Eigen::VectorXd y = held(r.at(thermometer));
    const Eigen::VectorXd about = (y.array() - y.mean()).matrix();
    Eigen::MatrixXd x(y.size(), n);
    Eigen::Index at = 0;
    for (const std::string& drive : drives) {
      for (double lag : kLags) {
        x.col(at) = lagged_steps(r.time_s, held(r.at(drive)), lag * (r.time_s.back() - r.time_s.front()));
        x.col(at).array() -= x.col(at).mean();
        ++at;
      }
    }
    g += x.transpose() * x;
    c += x.transpose() * about;
    all += about.squaredNorm();
  }
  const Eigen::VectorXd scale = g.diagonal().cwiseMax(1e-12).cwiseSqrt().cwiseInverse();
  g = scale.asDiagonal() * g * scale.asDiagonal();
  g.diagonal().array() += 1e-6;
  const Eigen::VectorXd scaled = scale.cwiseProduct(c);
  return all > 0.0 ? scaled.dot(g.llt().solve(scaled)) / all : 1.0;
}

/// Names of the channels that all records have, with the same unit and with readings. @param guesses  says which are left
/// out. @throws InputError  for a name that no scenario can hold
std::set<std::string> common_channels(std::span<const Record> records, std::vector<std::string>& guesses) {
  const Record& first = records[0];
  std::set<std::string> common;
  for (const Channel& c : first.channels) {
    if (std::all_of(records.begin(), records.end(), [&](const Record& r) {
          const Channel* other = r.find(c.name);
          return other && other->unit == c.unit;
        }))
      common.insert(c.name);
    else
      guesses.push_back(fmt::format("'{}' takes no part: not all records have it", c.header()));
  }
  for (const Record& r : records.subspan(1)) {
    for (const Channel& c : r.channels) {
      if (!first.find(c.name)) guesses.push_back(fmt::format("'{}' takes no part: not all records have it", c.header()));
    }
  }
  for (const std::string& name : std::vector<std::string>(common.begin(), common.end())) {
    if (!is_plain(name))
      throw InputError(
          fmt::format("{}: a scenario cannot hold the name '{}': letters, digits, '_' and '-' alone; rename the column",
                      first.source, name));
    if (has_readings(records, name)) continue;
    guesses.push_back(fmt::format("'{}' takes no part: a record has no reading of it", name));
    common.erase(name);
  }
  return common;
}

void require_rows(std::span<const Record> records) {
  for (const Record& r : records) {
    if (r.n_samples() < kFewestRows)
      throw InputError(
          fmt::format("{}: {} rows; a network needs {} at least, better a few hundred over several changes of the drive",
                      r.source, r.n_samples(), kFewestRows));
  }
}

/// @throws InputError  for a hint that is not in all records
void check_hints(const Record& first, const std::set<std::string>& common, const RoleHints& hints) {
  const auto require_common = [&](const std::string& name, const std::string& option) {
    if (!common.contains(name)) {
      (void)first.at(name);
      throw InputError(fmt::format("{} {}: not all records have readings of it", option, name));
    }
  };
  for (const std::string& drive : hints.drives) {
    require_common(drive, "--drive");
    if (drive == hints.ambient) throw InputError(fmt::format("'{}' cannot be both --drive and --ambient", drive));
  }
  if (hints.ambient.empty()) return;
  require_common(hints.ambient, "--ambient");
  if (first.at(hints.ambient).unit != "degC")
    throw InputError(fmt::format("--ambient {}: a temperature in degC is required, it is in {}", hints.ambient,
                                 first.at(hints.ambient).unit));
}

/// Gives each common channel its role, the ambient excepted.
void assign_roles(std::span<const Record> records, const std::set<std::string>& common, const RoleHints& hints,
                  RecordRoles& roles) {
  for (const Channel& c : records[0].channels) {
    if (!common.contains(c.name)) continue;
    const bool is_hinted = std::find(hints.drives.begin(), hints.drives.end(), c.name) != hints.drives.end();
    const bool is_speed = c.unit == "rpm" && roles.speed.empty();
    if ((is_hinted && !is_speed) || std::find(kDriveUnits.begin(), kDriveUnits.end(), c.unit) != kDriveUnits.end()) {
      if (changes(records, c.name))
        roles.drives.push_back(c.name);
      else
        roles.guesses.push_back(fmt::format("'{}' never changes and drives nothing", c.header()));
    } else if (is_speed) {
      const bool turns = held(c).cwiseAbs().maxCoeff() > 0.0;
      if (turns || changes(records, c.name)) roles.speed = c.name;
      if (!changes(records, c.name))
        roles.guesses.push_back(
            turns ? fmt::format("'{}' never changes: it is taken as switched on in the first row, after a long rest",
                                c.header())
                  : fmt::format("'{}' is always 0 and drives nothing", c.header()));
    } else if (is_temperature_unit(c.unit) && c.name != roles.ambient) {
      roles.thermometers.push_back(c.name);
    } else if (c.unit == "um") {
      roles.displacements.push_back(c.name);
    } else if (c.unit == "rpm") {
      roles.guesses.push_back(fmt::format(
          "'{}' is a second speed and takes no part; --drive {} makes it a drive, in proportion", c.header(), c.name));
    } else if (c.name != roles.ambient) {
      roles.guesses.push_back(
          fmt::format("'{}' takes no part: a channel in {} is neither drive, thermometer (degC, K) nor displacement (um)",
                      c.header(), c.unit));
    }
  }
}

/// The thermometer that follows the drives least, and by which share.
std::pair<std::string, double> least_driven(std::span<const Record> records, const std::vector<std::string>& drives,
                                            const std::vector<std::string>& thermometers) {
  std::string least;
  double share = 1e300;
  for (const std::string& t : thermometers) {
    if (records[0].at(t).unit != "degC") continue;
    const double of = follows(records, drives, t);
    if (of < share) {
      share = of;
      least = t;
    }
  }
  return {least, share};
}

/// Takes the ambient out of the thermometers: by its name, else the one that follows the drives least.
void guess_ambient(std::span<const Record> records, const std::vector<std::string>& drives, RecordRoles& roles) {
  auto named = std::find(roles.thermometers.begin(), roles.thermometers.end(), "ambient");
  if (named == roles.thermometers.end())
    named = std::find_if(roles.thermometers.begin(), roles.thermometers.end(), is_ambient_name);
  if (named != roles.thermometers.end()) {
    roles.ambient = *named;
    roles.guesses.push_back(fmt::format("'{}' is the ambient, by its name", *named));
  } else if (roles.thermometers.size() > 1) {
    const auto [least, share] = least_driven(records, drives, roles.thermometers);
    if (share < kAmbientFollows) {
      roles.ambient = least;
      roles.guesses.push_back(
          fmt::format("'{}' is the ambient, a guess: of all thermometers it follows the drives least ({:.0f} % of its "
                      "squares); --ambient says another",
                      least, 100.0 * std::max(0.0, share)));
    } else {
      roles.guesses.emplace_back(
          "no thermometer gives the ambient, because all follow the drives: it is taken as constant; --ambient names one");
    }
  } else {
    roles.guesses.emplace_back(
        "there is no ambient temperature: it is taken as constant; a thermometer in the air beside the machine would give "
        "it");
  }
  std::erase(roles.thermometers, roles.ambient);
}

/// @throws InputError  for a column with a name that scenarios have for something else
void refuse_taken_names(const Record& first, const RecordRoles& roles) {
  for (const auto* names : {&roles.thermometers, &roles.displacements, &roles.drives}) {
    for (const std::string& name : *names) {
      if (name == "ambient" || (name == "speed" && roles.speed != name))
        throw InputError(
            fmt::format("{}: the column '{}' is none of the {}; a scenario has no other of that name: rename it",
                        first.source, name, name == "speed" ? "spindle" : "ambient"));
    }
  }
}

void note_holes(std::span<const Record> records, std::vector<std::string>& guesses) {
  for (const Record& r : records) {
    const std::vector<double> steps_s = row_steps_s(r.time_s);
    const double usual_s = upper_median(steps_s), longest_s = *std::max_element(steps_s.begin(), steps_s.end());
    if (longest_s > kHole * usual_s)
      guesses.push_back(
          fmt::format("{} has a hole of {:.0f} min: what drove the machine before it is held. Where something else happened "
                      "in it, cut the record there",
                      r.source, longest_s / 60.0));
  }
}

}  // namespace

RecordRoles record_roles(std::span<const Record> records, const RoleHints& hints) {
  RecordRoles roles;
  const Record& first = records[0];
  const std::set<std::string> common = common_channels(records, roles.guesses);
  require_rows(records);
  check_hints(first, common, hints);
  roles.ambient = hints.ambient;
  assign_roles(records, common, hints, roles);
  std::vector<std::string> drives = roles.drives;
  if (!roles.speed.empty()) drives.push_back(roles.speed);
  if (drives.empty())
    throw InputError(fmt::format(
        "{}: nothing that drives the machine changes. A column such as speed_rpm or heater_W that is switched at least "
        "twice is required, or --drive with a column that is; a machine that is never switched shows nothing of its heat",
        first.source));
  if (roles.ambient.empty()) guess_ambient(records, drives, roles);
  refuse_taken_names(first, roles);
  note_holes(records, roles.guesses);
  if (roles.thermometers.empty() && roles.displacements.empty())
    throw InputError(
        fmt::format("{}: no thermometer (degC) and no displacement (um) is left to be predicted", first.source));
  return roles;
}

}  // namespace driftwright::identification
