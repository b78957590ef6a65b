#include "follow/heard_values.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "base/quantity.hpp"
#include "follow/row_text.hpp"

namespace driftwright::follow {
namespace {

/// A message as a cell: a number, or something that is none. @param from, to  units
std::string cell_of(const std::string& text, const std::string& from, const std::string& to) {
  try {
    const double number = stream_number(text, '.');
    return fmt::format("{:.17g}", from.empty() ? number : convert(number, from, to));
  } catch (const RangeError&) {
    return "?";
  }
}

}  // namespace

std::vector<ChannelOrigin> read_origins(const std::vector<std::string>& topics) {
  std::vector<ChannelOrigin> list;
  for (const std::string& given : topics) {
    const std::size_t equals = given.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == given.size())
      throw InputError(fmt::format("--topic '{}' must be CHANNEL=TOPIC, such as t01_degC=shop/mill/t01", given));
    list.push_back({given.substr(0, equals), given.substr(equals + 1)});
  }
  return list;
}

HeardValues::HeardValues(std::vector<ChannelOrigin> origins, double stale_s)
    : origins_(std::move(origins)), values_(origins_.size()), units_(origins_.size()), stale_s_(stale_s) {}

void HeardValues::set_unit(std::size_t k, const std::string& unit) {
  const ColumnUnit& channel = origins_[k].numbers;
  units_[k].clear();
  if (unit.empty() || channel.unit.empty() || unit == channel.unit) return;
  if (channel.is_difference && has_offset(unit))
    throw RangeError(fmt::format("'{}' is a unit of temperatures, and the channel is a difference of two", unit));
  const double factor = unit_factor(unit, channel.unit);
  if (!std::isfinite(factor))  // UDUNITS also turns a quantity into its reciprocal, Hz into s
    throw RangeError(fmt::format("'{}' is a unit of another quantity than '{}'", unit, channel.unit));
  if (factor == 1.0 && convert(0.0, unit, channel.unit) == 0.0) return;
  if (channel.is_scaled)
    throw RangeError(
        fmt::format("the map multiplies numbers in '{}' or adds to them, but they are in '{}'; write that unit "
                    "into the map, without a factor or an offset",
                    channel.unit, unit));
  units_[k] = unit;
}

void HeardValues::hear(const std::string& from, const std::string& text) {
  for (std::size_t k = 0; k < origins_.size(); ++k) {
    if (origins_[k].from == from) values_[k] = {cell_of(text, units_[k], origins_[k].numbers.unit), Clock::now()};
  }
}

void HeardValues::forget(const std::string& from) {
  for (std::size_t k = 0; k < origins_.size(); ++k) {
    if (origins_[k].from == from) values_[k] = {};
  }
}

void HeardValues::forget_all() {
  std::fill(values_.begin(), values_.end(), Value{});
}

std::string HeardValues::header() const {
  std::string text = "time_s";
  for (const ChannelOrigin& o : origins_) text += fmt::format(",{}", o.header);
  return text;
}

std::string HeardValues::row(double time_s) const {
  const Clock::time_point now = Clock::now();
  std::string text = fmt::format("{:.3f}", time_s);
  for (const Value& v : values_) {
    const bool is_known = v.at && std::chrono::duration<double>(now - *v.at).count() < stale_s_;
    text += fmt::format(",{}", is_known ? v.cell : "");
  }
  return text;
}

double Ticks::until_next_s() const {
  return std::max(0.0, std::chrono::duration<double>(due_ - HeardValues::Clock::now()).count());
}

bool Ticks::is_due() {
  const HeardValues::Clock::time_point now = HeardValues::Clock::now();
  if (now < due_) return false;
  due_ += std::chrono::duration_cast<HeardValues::Clock::duration>(std::chrono::duration<double>(every_s_));
  due_ = std::max(due_, now);
  return true;
}

double now_s() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

}  // namespace driftwright::follow
