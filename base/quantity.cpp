#include "base/quantity.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <link.h>
#include <udunits2.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <mutex>

#include "base/errors.hpp"

namespace driftwright {
namespace {

struct FreeSystem {
  void operator()(ut_system* s) const { ut_free_system(s); }
};
struct FreeUnit {
  void operator()(ut_unit* u) const { ut_free(u); }
};
struct FreeConverter {
  void operator()(cv_converter* c) const { cv_free(c); }
};
using UnitPtr = std::unique_ptr<ut_unit, FreeUnit>;
using ConverterPtr = std::unique_ptr<cv_converter, FreeConverter>;

/// The unit table that is unpacked with this program or library (cmake/bundle.py). Empty if there is none.
std::filesystem::path bundled_unit_table() {
  Dl_info info;
  void* found = nullptr;  // the link_map of the file that this code is in; the program's own has no name
  if (dladdr1(reinterpret_cast<const void*>(&bundled_unit_table), &info, &found, RTLD_DL_LINKMAP) == 0) return {};
  const std::string loaded = static_cast<const link_map*>(found)->l_name;
  std::error_code failed;
  const std::filesystem::path file = std::filesystem::canonical(loaded.empty() ? "/proc/self/exe" : loaded, failed);
  const std::filesystem::path table = file.parent_path().parent_path() / "share/driftwright/units/udunits2.xml";
  return std::filesystem::exists(table, failed) ? table : std::filesystem::path();
}

ut_system* unit_system() {  // the only table of units, read from UDUNITS' own files at first use
  static const std::unique_ptr<ut_system, FreeSystem> system = [] {
    ut_set_error_message_handler(ut_ignore);
    const char* chosen = std::getenv("UDUNITS2_XML_PATH");
    const std::filesystem::path bundled = chosen && *chosen ? std::filesystem::path() : bundled_unit_table();
    return std::unique_ptr<ut_system, FreeSystem>(ut_read_xml(bundled.empty() ? nullptr : bundled.c_str()));
  }();
  if (!system) throw std::runtime_error("the unit table of UDUNITS-2 cannot be read (package libudunits2-data)");
  return system.get();
}

/// Common spellings of units and their meaning: UDUNITS would read W/m2K as W K/m2 if at all, and C as coulomb.
std::string meant_by(const std::string& unit) {
  static const std::map<std::string, std::string> meant = {
      {"C", "degC"},          {"°C", "degC"},        {"W/m2K", "W/(m^2 K)"}, {"W/m^2K", "W/(m^2 K)"},
      {"W/m²K", "W/(m^2 K)"}, {"W/mK", "W/(m K)"},   {"J/kgK", "J/(kg K)"},  {"kJ/kgK", "kJ/(kg K)"},
      {"um/mK", "um/(m K)"},  {"µm/mK", "um/(m K)"}, {"1/min", "rpm"},       {"U/min", "rpm"},
      {"l/min", "L/min"},     {"Nm", "N m"}};
  const auto at = meant.find(unit);
  return at == meant.end() ? "" : fmt::format("; write '{}'", at->second);
}

UnitPtr parse_unit(const std::string& text) {
  UnitPtr unit(ut_parse(unit_system(), text == "deg" ? "degree" : text.c_str(), UT_UTF8));  // UDUNITS has no deg
  if (!unit) throw RangeError(fmt::format("unknown unit '{}'{}", text, meant_by(text)));
  return unit;
}

/// UDUNITS treats the radian as 1, so that 1 Hz would be 9.55 rpm. Here an angle is a dimension.
bool carries_angle(const UnitPtr& unit) {
  char text[256];
  const int length = ut_format(unit.get(), text, sizeof text, UT_ASCII | UT_DEFINITION);
  return length > 0 && std::string(text, std::min<std::size_t>(length, sizeof text)).find("rad") != std::string::npos;
}

ConverterPtr make_converter(const std::string& from, const std::string& to) {
  const UnitPtr a = parse_unit(from), b = parse_unit(to);
  if (ut_are_convertible(a.get(), b.get()) == 0 || carries_angle(a) != carries_angle(b)) {
    if (to == "1")
      throw RangeError(fmt::format("wrong unit '{}': the value must be a number or a share, such as 20 %", from));
    throw RangeError(fmt::format("wrong unit '{}': the value must be a quantity in {}{}", from, to, meant_by(from)));
  }
  return ConverterPtr(ut_get_converter(a.get(), b.get()));
}

/// UDUNITS' parser is not thread-safe.
std::mutex& one_at_a_time() {
  static std::mutex mutex;
  return mutex;
}

/// Each thread keeps the converters that it has used: making one takes longer than all the rest of reading a value.
const cv_converter* converter(const std::string& from, const std::string& to) {
  thread_local std::map<std::pair<std::string, std::string>, ConverterPtr> known;
  const auto found = known.find({from, to});
  if (found != known.end()) return found->second.get();
  const std::lock_guard lock(one_at_a_time());
  return known.emplace(std::pair(from, to), make_converter(from, to)).first->second.get();
}

// What ut_accept_visitor() calls for each kind of unit, with a BaseUnits; a kind without one is refused.
ut_status add_power(const ut_unit* basic, int power, BaseUnits& to) {
  const std::string symbol = ut_get_symbol(basic, UT_ASCII);
  if (symbol != "rad") to.powers[symbol] += power;
  return UT_SUCCESS;
}
ut_status visit_basic(const ut_unit* unit, void* to) {
  return add_power(unit, 1, *static_cast<BaseUnits*>(to));
}
ut_status visit_product(const ut_unit*, int n, const ut_unit* const* basic, const int* power, void* to) {
  for (int i = 0; i < n; ++i) add_power(basic[i], power[i], *static_cast<BaseUnits*>(to));
  return UT_SUCCESS;
}
ut_status visit_scaled(const ut_unit*, double scale, const ut_unit* of, double, void* to);
ut_status visit_date(const ut_unit*, const ut_unit*, double, void*) {
  return UT_MEANINGLESS;
}
ut_status visit_logarithm(const ut_unit*, double, const ut_unit*, void*) {
  return UT_MEANINGLESS;
}
constexpr ut_visitor kToBaseUnits = {visit_basic, visit_product, visit_scaled, visit_date, visit_logarithm};
ut_status visit_scaled(const ut_unit*, double scale, const ut_unit* of, double, void* to) {
  static_cast<BaseUnits*>(to)->factor *= scale;
  return ut_accept_visitor(of, &kToBaseUnits, to);
}

Quantity split(const std::string& text, const std::string& wanted) {
  const char* begin = text.c_str();
  char* end = nullptr;
  const double number = std::strtod(begin, &end);
  if (end == begin) throw RangeError(fmt::format("'{}' is not a number with a unit, such as '1 {}'", text, wanted));
  if (!std::isfinite(number)) throw RangeError(fmt::format("'{}' is not a finite number", text));
  std::string unit(end);
  if (unit.size() > 1 && unit[0] == ',' && unit[1] >= '0' && unit[1] <= '9') {
    std::string meant = text;
    meant[static_cast<std::size_t>(end - begin)] = '.';
    throw RangeError(fmt::format("decimals need a point: {}, not {}", meant, text));
  }
  unit.erase(0, unit.find_first_not_of(" \t"));
  return {number, unit};
}

/// The most likely unit of a bare number of a machine: feeds are written in m/min and mm/min, lengths in mm.
const char* likely_unit_of(double number, const std::string& unit) {
  struct UpTo {
    const char* wanted;
    double most;  ///< largest likely number in it
    const char* likely;
  };
  constexpr double kAny = std::numeric_limits<double>::infinity();
  constexpr UpTo kUnits[] = {
      {"m/s", 4.0, "m/s"}, {"m/s", 240.0, "m/min"}, {"m/s", kAny, "mm/min"},  // 240 m/min: linear motors
      {"m", 10.0, "m"},    {"m", kAny, "mm"},       {"N/m", 5000.0, "N/um"}};
  for (const UpTo& u : kUnits) {
    if (unit == u.wanted && std::abs(number) <= u.most) return u.likely;
  }
  return unit.c_str();
}

}  // namespace

double parse_quantity(const std::string& text, const std::string& unit) {
  const auto [number, given] = split(text, unit);
  if (given.empty() && unit != "1") {
    throw RangeError(fmt::format("'{}' has no unit; it must be a quantity in {}, such as '{} {}'", text, unit, text,
                                 likely_unit_of(number, unit)));
  }
  const cv_converter* c = converter(given.empty() ? "1" : given, unit);
  if (unit == "K" && has_offset(given)) {
    throw RangeError(fmt::format("'{}' is a temperature; it must be a temperature difference in K", text));
  }
  return cv_convert_double(c, number);
}

double parse_temperature_K(const std::string& text) {
  const auto [number, given] = split(text, "degC");
  if (given.empty()) throw RangeError(fmt::format("'{}' has no unit; it must be a temperature such as '20 degC'", text));
  if (given == "C" || given == "F")  // coulomb and farad
    throw RangeError(fmt::format("'{}' is no temperature; write '{:g} deg{}'", text, number, given));
  if (given == "deg") throw RangeError(fmt::format("'{}' is an angle; write '{:g} degC'", text, number));
  return cv_convert_double(converter(given, "K"), number);
}

double unit_factor(const std::string& from, const std::string& to) {
  const cv_converter* c = converter(from, to);
  return cv_convert_double(c, 1.0) - cv_convert_double(c, 0.0);
}

BaseUnits in_base_units(const std::string& unit) {
  BaseUnits base;
  const std::lock_guard lock(one_at_a_time());
  const UnitPtr parsed = parse_unit(unit.empty() ? "1" : unit);
  if (ut_accept_visitor(parsed.get(), &kToBaseUnits, &base) != UT_SUCCESS)
    throw RangeError(fmt::format("'{}' has no base units", unit));
  std::erase_if(base.powers, [](const auto& p) { return p.second == 0.0; });
  return base;
}

Quantity split_quantity(const std::string& text) {
  Quantity quantity = split(text, "m");
  if (!quantity.unit.empty()) (void)converter(quantity.unit, quantity.unit);
  return quantity;
}

double convert(double number, const std::string& from, const std::string& to) {
  if (from == to) return number;
  return cv_convert_double(converter(from.empty() ? "1" : from, to.empty() ? "1" : to), number);
}

bool has_offset(const std::string& unit) {
  try {
    return cv_convert_double(converter(unit, "K"), 0.0) != 0.0;
  } catch (const RangeError&) {  // not a temperature
    return false;
  }
}

std::string unit_in_name(const std::string& unit) {
  std::string name;
  for (std::size_t i = 0; i < unit.size(); ++i) {
    const auto c = static_cast<unsigned char>(unit[i]);
    if (unit.compare(i, 2, "µ") == 0) {
      name += 'u';
      ++i;
    } else if (std::isalnum(c) || c == '_' || c == '-') {
      name += unit[i];
    } else if (c == '/') {
      name += '_';
    } else if (c == '%') {
      name += "percent";
    }
  }
  return name.empty() ? "1" : name;
}

}  // namespace driftwright
