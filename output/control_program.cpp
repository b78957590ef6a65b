#include "output/control_program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <memory>
#include <stdexcept>

#include "base/errors.hpp"

namespace driftwright::output {
namespace {

using compensation::DriftModel;
using compensation::FailSafe;

constexpr std::size_t kHeidenhainReadings = 8;      // Q100 to Q107 are what the PLC passes to an NC program
constexpr int kSiemensActions = 254;                // numbers of synchronized actions that a user may give
constexpr int kFanucFirst = 501, kFanucLast = 999;  // common variables that survive power-off
constexpr double kNarrowest = 1e-9;                 // width of a validity range; a narrower one would divide by zero

/// Letters, digits and single underscores, as every language allows them.
std::string plain_name(const std::string& text) {
  std::string name = text.empty() || !std::isalpha(static_cast<unsigned char>(text[0])) ? "X_" : "";
  for (char ch : text) {
    const char plain = std::isalnum(static_cast<unsigned char>(ch)) ? ch : '_';
    if (plain != '_' || name.back() != '_') name += plain;
  }
  return name;
}

std::string upper(std::string text) {
  for (char& ch : text) ch = static_cast<char>(std::toupper(static_cast<unsigned char>(ch)));
  return text;
}

/// How many digits a language keeps of a constant: significant ones, and after the point; the largest that it takes.
struct NumberFormat {
  int significant = 17, decimals = 300;
  double most = HUGE_VAL;
};

/// A number without exponent; a negative one in parentheses.
std::string digits_of(double x, const NumberFormat& digits) {
  if (!std::isfinite(x)) throw std::logic_error("a control's program needs finite numbers");
  if (std::abs(x) >= digits.most)
    throw InputError(
        fmt::format("the formula has the number {:g}, and a constant of this control must be below {:g}; let a "
                    "PLC or PC compute this one (--as st, --as c)",
                    x, digits.most));
  const int magnitude = x == 0.0 ? 0 : static_cast<int>(std::floor(std::log10(std::abs(x))));
  std::string text = fmt::format("{:.{}f}", std::abs(x), std::clamp(digits.significant - 1 - magnitude, 1, digits.decimals));
  while (text.back() == '0' && text[text.size() - 2] != '.') text.pop_back();
  return x < 0.0 ? fmt::format("( -{} )", text) : text;
}

/// A language: where variables are, how a value is set, always or if two values compare. Expressions have blanks around
/// each sign; values that are compared are a variable or a number.
class Dialect {
 public:
  enum class Compare { kLess, kEqual, kGreater };

  explicit Dialect(const NumberFormat& digits) : digits_(digits) {}
  virtual ~Dialect() = default;
  [[nodiscard]] virtual bool is_called() const = 0;  ///< by an NC program; otherwise it runs in a cycle
  /// The variable of this name, made at its first use.
  [[nodiscard]] virtual std::string variable(const std::string& name) = 0;
  /// One that keeps its value until the next row.
  [[nodiscard]] virtual std::string kept(const std::string& name) { return variable(name); }
  [[nodiscard]] virtual std::string reading(std::size_t k) = 0;
  virtual void set(const std::string& target, const std::string& value) = 0;
  virtual void set_if(const std::string& a, Compare compare, const std::string& b, const std::string& target,
                      const std::string& value) = 0;
  [[nodiscard]] virtual ControlProgram program(const std::vector<std::string>& remarks, const std::string& correction) = 0;
  /// The correction where the axis is, from those of places of its travel, as program() takes it.
  [[nodiscard]] virtual std::string over_travel(const std::vector<double>& /*at_mm*/,
                                                const std::vector<std::string>& /*corrections*/) {
    throw std::logic_error("a language that knows no position");
  }

  [[nodiscard]] std::string number(double x) const { return digits_of(x, digits_); }
  [[nodiscard]] const NumberFormat& digits() const { return digits_; }
  void at_least(const std::string& target, const std::string& low) { set_if(target, Compare::kLess, low, target, low); }
  void at_most(const std::string& target, const std::string& high) { set_if(target, Compare::kGreater, high, target, high); }

 protected:
  std::string text_;

 private:
  NumberFormat digits_;
};

/// The sign of a comparison in a language that writes them so.
const char* sign_of(Dialect::Compare compare, const char* less, const char* equal, const char* greater) {
  return compare == Dialect::Compare::kLess ? less : compare == Dialect::Compare::kEqual ? equal : greater;
}

class StructuredText final : public Dialect {
 public:
  StructuredText(const std::string& name, const std::vector<FailSafe::Guard>& guards)
      : Dialect({}), name_(plain_name(name)) {
    for (const FailSafe::Guard& g : guards) {
      const std::string plain = plain_name(fmt::format("in_{}_{}", g.input, g.unit));
      std::string own = plain;
      const auto is_taken = [&](const std::string& other) { return upper(other) == upper(own); };  // case does not count
      for (int k = 2; std::any_of(readings_.begin(), readings_.end(), is_taken); ++k) own = fmt::format("{}_{}", plain, k);
      readings_.push_back(own);
    }
  }
  bool is_called() const override { return false; }
  std::string variable(const std::string& name) override {
    if (std::find(variables_.begin(), variables_.end(), name) == variables_.end()) variables_.push_back(name);
    return name;
  }
  std::string reading(std::size_t k) override { return readings_[k]; }
  void set(const std::string& target, const std::string& value) override {
    text_ += fmt::format("{} := {};\n", target, value);
  }
  void set_if(const std::string& a, Compare compare, const std::string& b, const std::string& target,
              const std::string& value) override {
    text_ += fmt::format("IF {} {} {} THEN {} := {}; END_IF;\n", a, sign_of(compare, "<", "=", ">"), b, target, value);
  }
  std::string over_travel(const std::vector<double>& at_mm, const std::vector<std::string>& corrections) override {
    readings_.emplace_back(kPosition);
    const std::string along = variable("along");
    set(along, corrections.front());
    for (std::size_t k = 1; k < at_mm.size(); ++k)
      set_if(kPosition, Compare::kGreater, number(at_mm[k - 1]), along,
             fmt::format("{0} + ( {1} - {0} ) * ( {2} - {3} ) / {4}", corrections[k - 1], corrections[k], kPosition,
                         number(at_mm[k - 1]), number(at_mm[k] - at_mm[k - 1])));
    set_if(kPosition, Compare::kGreater, number(at_mm.back()), along, corrections.back());
    return along;
  }
  ControlProgram program(const std::vector<std::string>& remarks, const std::string& correction) override {
    std::string head = fmt::format("FUNCTION_BLOCK {}\n", name_);
    for (const std::string& r : remarks) head += fmt::format("(* {} *)\n", r);
    head += "VAR_INPUT\n";
    for (const std::string& r : readings_) head += fmt::format("  {} : LREAL;\n", r);
    head += "END_VAR\nVAR_OUTPUT\n  correction_um : LREAL; (* the axis moves by its negative *)\nEND_VAR\nVAR\n";
    for (const std::string& v : variables_) head += fmt::format("  {} : LREAL;\n", v);
    head += "END_VAR\n";
    return {name_ + ".st", fmt::format("{}{}correction_um := {};\nEND_FUNCTION_BLOCK\n", head, text_, correction)};
  }

 private:
  static constexpr const char* kPosition = "position_mm";
  std::string name_;
  std::vector<std::string> readings_, variables_;
};

class Siemens final : public Dialect {
 public:
  Siemens(const std::string& name, const ControlAxis& axis, double period_s)
      : Dialect({}), name_(upper(plain_name(name)).substr(0, 24)), axis_(axis), period_s_(period_s) {}
  bool is_called() const override { return false; }
  std::string variable(const std::string& name) override {
    const auto [at, is_new] = index_.emplace(name, index_.size());
    return fmt::format("$AC_PARAM[{}]", at->second);
  }
  std::string reading(std::size_t k) override { return fmt::format("$A_DBR[{}]", 4 * k); }
  void set(const std::string& target, const std::string& value) override {
    action(fmt::format("WHENEVER $AC_MARKER[0]==1 DO {}={}", target, value));
  }
  void set_if(const std::string& a, Compare compare, const std::string& b, const std::string& target,
              const std::string& value) override {
    action(fmt::format("WHENEVER ($AC_MARKER[0]==1) AND ({}{}{}) DO {}={}", a, sign_of(compare, "<", "==", ">"), b, target,
                       value));
  }
  ControlProgram program(const std::vector<std::string>& remarks, const std::string& correction) override {
    if (!is_over_travel_)
      set(fmt::format("$$SA_TEMP_COMP_ABS_VALUE[{}]", axis_.letter), fmt::format("{} * {}", correction, mm_of_axis()));
    action("DO $AC_MARKER[0]=0");
    if (n_actions_ > kSiemensActions)
      throw InputError(
          fmt::format("the formula needs {} synchronized actions, and at most {} have a number; export it "
                      "--as st for the PLC, or take a formula with fewer terms",
                      n_actions_, kSiemensActions));
    std::string head = fmt::format("PROC {} DISPLOF\n", name_);
    for (const std::string& r : remarks) head += fmt::format("; {}\n", r);
    head += fmt::format(
        "; $A_DBR is the memory that PLC and NCK share: 32 bits a reading, 4 bytes apart. Uses $AC_PARAM[0] to [{}], "
        "$AC_TIMER[0], $AC_MARKER[0], IDS 1 to {}.\n"
        "; MD28254 must be at least {}, MD28256 and MD28258 at least 1 (timers are 0 as delivered), and MD28250 large "
        "enough "
        "for these actions: an alarm of an illegal array index or of too few elements names what is missing.\n"
        "; Call once after power-on. It needs MD32750 {} of the axis; MD32760 limits the speed of the correction.\n"
        "; Measure the sign before use: SD43900 = 0.1 with the axis at rest and a dial gauge on it; an axis that moves "
        "{} by 0.1 mm agrees with this file, otherwise export with --axis-moves {}.\n",
        index_.size() - 1, n_actions_, index_.size(),
        is_over_travel_ ? "= 3 (bits 0 and 1), and the axis referenced: positions are those of the machine," : "bit 0 = 1",
        axis_.against_dk ? "to minus" : "to plus", axis_.against_dk ? "by_dk" : "against_dk");
    head +=
        "IF $MN_SCALING_SYSTEM_IS_METRIC==TRUE GOTOF METRIC\n"
        "SETAL(65024)                            ; mm are required: SD43900 of a control in inches is in inches\n"
        "RET\n"
        "METRIC:\n";
    for (std::size_t k = 0; k < index_.size(); ++k) head += fmt::format("$AC_PARAM[{}]=0\n", k);
    head += fmt::format("$AC_MARKER[0]=0\n$AC_TIMER[0]={}\n", number(period_s_));
    return {name_ + ".SPF", head + text_ + "RET\n"};
  }
  /// In each cycle the straight piece in which the axis is: all three data at once, so that the value never jumps.
  std::string over_travel(const std::vector<double>& at_mm, const std::vector<std::string>& corrections) override {
    is_over_travel_ = true;
    const std::string place = fmt::format("$AA_IM[{}]", axis_.letter);
    const auto piece = [&](const std::string& where, std::size_t k, const std::string& slope) {
      action(
          fmt::format("WHENEVER {1} DO $$SA_TEMP_COMP_REF_POSITION[{0}]={2} $$SA_TEMP_COMP_ABS_VALUE[{0}]={3} * {4} "
                      "$$SA_TEMP_COMP_SLOPE[{0}]={5}",
                      axis_.letter, where, number(at_mm[k]), corrections[k], mm_of_axis(), slope));
    };
    const std::size_t last = at_mm.size() - 1;
    piece(fmt::format("{}<{}", place, number(at_mm.front())), 0, number(0.0));
    for (std::size_t k = 0; k < last; ++k)
      piece(fmt::format("({0}>={1}) AND ({0}<{2})", place, number(at_mm[k]), number(at_mm[k + 1])), k,
            fmt::format("( {} - {} ) * {} / {}", corrections[k + 1], corrections[k], mm_of_axis(),
                        number(at_mm[k + 1] - at_mm[k])));
    piece(fmt::format("{}>={}", place, number(at_mm.back())), last, number(0.0));
    return "";
  }
  /// The first actions: once a period the marker is 1 in one cycle.
  void begin() {
    action(fmt::format("WHENEVER $AC_TIMER[0]>={} DO $AC_MARKER[0]=1", number(period_s_)));
    action(fmt::format("WHENEVER $AC_MARKER[0]==1 DO $AC_TIMER[0]=$AC_TIMER[0] - {}", number(period_s_)));
  }

 private:
  void action(const std::string& words) { text_ += fmt::format("IDS={} {}\n", ++n_actions_, words); }
  /// What makes a correction in um a compensation in mm.
  [[nodiscard]] const char* mm_of_axis() const { return axis_.against_dk ? "0.001" : "( -0.001 )"; }

  std::string name_;
  ControlAxis axis_;
  double period_s_;
  std::map<std::string, std::size_t> index_;
  int n_actions_ = 0;
  bool is_over_travel_ = false;
};

class Heidenhain final : public Dialect {
 public:
  Heidenhain(const std::string& name, const ControlAxis& axis)
      : Dialect({.significant = 12, .decimals = 14, .most = 1e9}),
        name_(upper(plain_name(name)).substr(0, 24)),
        axis_(axis) {}
  bool is_called() const override { return true; }
  std::string variable(const std::string& name) override {
    return fmt::format("QL{}", locals_.emplace(name, locals_.size()).first->second);
  }
  std::string kept(const std::string& name) override {
    return fmt::format("QR{}", kept_.emplace(name, kept_.size()).first->second);
  }
  std::string reading(std::size_t k) override { return fmt::format("Q{}", 100 + k); }
  void set(const std::string& target, const std::string& value) override { block(fmt::format("{} = {}", target, value)); }
  /// Passed over where the comparison fails; equal values need no setting.
  void set_if(const std::string& a, Compare compare, const std::string& b, const std::string& target,
              const std::string& value) override {
    ++n_labels_;
    block(fmt::format(
        "{} {} GOTO LBL {}",
        fmt::format(fmt::runtime(sign_of(compare, "FN 11: IF {} GT", "FN 10: IF {} NE", "FN 12: IF {} LT")), with_sign(a)),
        with_sign(b), n_labels_));
    set(target, value);
    block(fmt::format("LBL {}", n_labels_));
  }
  ControlProgram program(const std::vector<std::string>& remarks, const std::string& correction) override {
    const std::string shift = variable("shift");
    set(shift, fmt::format("( -0.001 ) * {}", correction));
    block("CYCL DEF 7.0 DATUM SHIFT");
    block(fmt::format("CYCL DEF 7.1 {}+{}", axis_.letter, shift));
    std::vector<std::string> head = {fmt::format("BEGIN PGM {} MM", name_)};
    for (const std::string& r : remarks) head.push_back("; " + r);
    head.push_back("; Q100 to Q107 come from the PLC: have the machine's builder pass the thermometers there, in degC");
    head.push_back(
        fmt::format("; It sets the datum shift (cycle 7) of {}: call it before each part and where no other datum "
                    "shift is in force",
                    axis_.letter));
    if (!kept_.empty())
      head.push_back(
          fmt::format("; Rises count from the first call: set {} = 0 before the first call of a run", kept("started")));
    std::string text;
    std::size_t n = 0;
    for (const auto* list : {&head, &blocks_}) {
      for (const std::string& b : *list) text += fmt::format("{} {}\n", n++, b);
    }
    return {name_ + ".H", text + fmt::format("{} END PGM {} MM\n", n, name_)};
  }

 private:
  void block(std::string words) { blocks_.push_back(std::move(words)); }
  static std::string with_sign(std::string value) {
    if (value.starts_with("( ")) value = value.substr(2, value.size() - 4);
    return value.starts_with("-") ? value : "+" + value;
  }

  std::string name_;
  ControlAxis axis_;
  std::map<std::string, std::size_t> locals_, kept_;
  std::vector<std::string> blocks_;
  int n_labels_ = 0;
};

class Fanuc final : public Dialect {
 public:
  Fanuc(const std::string& name, const ControlAxis& axis, std::size_t n_readings)
      : Dialect({.significant = 8, .decimals = 7, .most = 1e7}),  // eight digits with the zero before the point
        name_(upper(plain_name(name))),
        axis_(axis),
        next_(kFanucFirst + static_cast<int>(n_readings)) {}
  bool is_called() const override { return true; }
  std::string variable(const std::string& name) override {
    const auto found = index_.find(name);
    if (found != index_.end()) return fmt::format("#{}", found->second);
    if (next_ > kFanucLast)
      throw InputError(
          fmt::format("the formula needs more than the common variables #{} to #{}; take one with fewer "
                      "readings",
                      kFanucFirst, kFanucLast));
    index_.emplace(name, next_);
    return fmt::format("#{}", next_++);
  }
  std::string reading(std::size_t k) override { return fmt::format("#{}", kFanucFirst + static_cast<int>(k)); }
  void set(const std::string& target, const std::string& value) override {
    text_ += fmt::format("{}={}\n", target, brackets(value));
  }
  void set_if(const std::string& a, Compare compare, const std::string& b, const std::string& target,
              const std::string& value) override {
    text_ += fmt::format("IF [{} {} {}] THEN {}={}\n", brackets(a), sign_of(compare, "LT", "EQ", "GT"), brackets(b), target,
                         brackets(value));
  }
  ControlProgram program(const std::vector<std::string>& remarks, const std::string& correction) override {
    std::string head = fmt::format("%\nO9010 ({})\n", name_);
    for (std::string r : remarks) {
      std::erase_if(r, [](char ch) { return ch == '(' || ch == ')'; });
      head += fmt::format("({})\n", upper(r));
    }
    head += fmt::format(
        "(THE THERMOMETERS MUST BE IN THESE VARIABLES IN DEGC: FROM THE PMC OR FROM A PC)\n"
        "(USES #{} TO #{}. IT SETS THE EXTERNAL WORK ZERO OFFSET OF {} ALONE: CALL IT BEFORE EACH PART, IN G21 AND G90)\n",
        kFanucFirst, next_ - 1, axis_.letter);
    head +=  // modal codes of groups 6 and 3
        "IF [#4006 LT 21] THEN #3000=1 (MM ARE REQUIRED, G21 FIRST)\n"
        "IF [#4003 GT 90] THEN #3000=2 (G90 IS REQUIRED)\n";
    if (index_.contains("started"))
      head += fmt::format("(RISES COUNT FROM THE FIRST CALL: SET #{} TO 0 BEFORE THE FIRST CALL OF A RUN)\n",
                          index_.at("started"));
    return {name_ + ".NC",
            fmt::format("{}{}G10 L2 P0 {}[{} * [ -0.001 ]]\nM99\n%\n", head, text_, axis_.letter, correction)};
  }

 private:
  static std::string brackets(std::string value) {
    std::replace(value.begin(), value.end(), '(', '[');
    std::replace(value.begin(), value.end(), ')', ']');
    return value;
  }

  std::string name_;
  ControlAxis axis_;
  int next_;
  std::map<std::string, int> index_;
};

/// @throws InputError  for what a program without time cannot hold
void require_static(const DriftModel& model, const std::string& control) {
  for (const DriftModel::Term& t : model.terms) {
    const bool is_speed = compensation::is_drive(t.unit);
    if (!is_speed && t.lag_s == 0.0) continue;
    throw InputError(fmt::format(
        "the formula has {} of '{}', and a program that {} runs once a part knows no time; take a formula of thermometers "
        "without lags, or let a PLC or PC compute this one (--as st, --as c)",
        is_speed ? "the speed" : "a lag", t.input, control));
  }
}

/// A formula among those of a program.
struct FormulaPart {
  const DriftModel& model;
  const FailSafe& safe;
  std::vector<std::size_t> readings;  ///< of the program, one for each guard
  std::string own;                    ///< before the names of what it keeps: "", or "p0_"
};

/// Readings as drift_repair() leaves them while it doubts none, in x0, x1, ..., and the trust that they deserve.
void write_readings(Dialect& to, const FormulaPart& part) {
  const FailSafe& safe = part.safe;
  const std::string deserved = to.variable("deserved"), out = to.variable("out"), room = to.variable("room");
  to.set(deserved, to.number(1.0));
  for (std::size_t k = 0; k < safe.guards.size(); ++k) {
    const FailSafe::Guard& g = safe.guards[k];
    const std::string x = to.variable(fmt::format("x{}", k)), low = to.number(g.low), high = to.number(g.high);
    to.set(x, to.reading(part.readings[k]));
    if (safe.from_start && !compensation::is_drive(g.unit)) {
      const std::string base = to.kept(fmt::format("{}base{}", part.own, k));
      to.set_if(to.kept("started"), Dialect::Compare::kEqual, to.number(0.0), base, x);
      to.set(x, fmt::format("{} - {}", x, base));
    }
    to.set(out, fmt::format("{} - {}", low, x));
    to.set(room, fmt::format("{} - {}", x, high));
    to.at_least(out, room);
    to.at_least(out, to.number(0.0));
    to.set(room, fmt::format("{} - {} / {}", to.number(1.0), out, to.number(std::max(kNarrowest, g.high - g.low))));
    to.at_least(room, to.number(0.0));
    to.at_most(deserved, room);
    to.at_least(x, low);
    to.at_most(x, high);
  }
}

/// The formula of these readings, in `sum`.
void write_formula(Dialect& to, const FormulaPart& part) {
  const DriftModel& model = part.model;
  const FailSafe& safe = part.safe;
  const std::string sum = to.variable("sum"), value = to.variable("value"), started = to.kept("started");
  const auto if_first = [&](const std::string& target, const std::string& v) {
    to.set_if(started, Dialect::Compare::kEqual, to.number(0.0), target, v);
  };
  to.set(sum, to.number(model.intercept));
  for (std::size_t j = 0; j < model.terms.size(); ++j) {
    const DriftModel::Term& t = model.terms[j];
    const auto guard =
        std::find_if(safe.guards.begin(), safe.guards.end(), [&](const FailSafe::Guard& g) { return g.input == t.input; });
    if (guard == safe.guards.end()) throw std::logic_error("a term of a model has no guard");
    const bool holds = compensation::is_drive(t.unit);
    const double first = model.from_start && !holds ? std::clamp(0.0, guard->low, guard->high) : 0.0;
    const std::string x = to.variable(fmt::format("x{}", guard - safe.guards.begin()));
    const std::string z = first == 0.0 ? x : fmt::format("( {} - {} )", x, to.number(first));
    if (t.is_running) {
      to.set(value, to.number(1.0));
      to.set_if(x, Dialect::Compare::kEqual, to.number(first), value, to.number(0.0));
    } else {
      std::string product = z;
      for (int p = 1; p < t.power; ++p) product += " * " + z;
      to.set(value, product);
    }
    if (t.lag_s > 0.0) {
      const std::string lag = to.kept(fmt::format("{}lag{}", part.own, j)),
                        before = to.kept(fmt::format("{}before{}", part.own, j));
      const std::string share = to.number(1.0 - std::exp(-safe.period_s / t.lag_s));
      if_first(lag, holds ? to.number(0.0) : value);
      if_first(before, holds ? to.number(0.0) : value);
      const std::string towards = holds ? before : fmt::format("{} * ( {} + {} )", to.number(0.5), before, value);
      to.set(lag, fmt::format("{0} + {1} * ( {2} - {0} )", lag, share, towards));
      to.set(before, value);
      to.set(value, lag);
    }
    to.set(sum, fmt::format("{} + {} * {}", sum, to.number(t.coefficient), value));
  }
}

/// What may go to the axis. @return the variable with it
std::string write_guard(Dialect& to, const FormulaPart& part) {
  const FailSafe& safe = part.safe;
  const std::string deserved = to.variable("deserved"), sum = to.variable("sum"), wanted = to.variable("wanted");
  const std::string started = to.kept("started"), correction = to.kept(part.own + "correction");
  const auto if_first = [&](const std::string& target, const std::string& v) {
    to.set_if(started, Dialect::Compare::kEqual, to.number(0.0), target, v);
  };
  if (to.is_called()) {
    to.set(wanted, fmt::format("{} * {}", deserved, sum));
  } else {
    const std::string trust = to.kept(part.own + "trust");
    if_first(trust, deserved);
    to.set(trust, fmt::format("{0} + {1} * ( {2} - {0} )", trust, to.number(1.0 - std::exp(-safe.period_s / safe.fade_s)),
                              deserved));
    to.set(wanted, fmt::format("{} * {}", trust, sum));
  }
  to.at_least(wanted, to.number(safe.lowest_um));
  to.at_most(wanted, to.number(safe.highest_um));
  if (to.is_called()) {
    to.set(correction, wanted);
  } else {
    const double most_um = safe.most_rate_um_s * safe.period_s;
    if_first(correction, wanted);
    to.set(wanted, fmt::format("{} - {}", wanted, correction));
    to.at_least(wanted, to.number(-most_um));
    to.at_most(wanted, to.number(most_um));
    to.set(correction, fmt::format("{} + {}", correction, wanted));
  }
  return correction;
}

/// Whether the readings of two formulas are the same, with the same ranges.
bool read_alike(const FormulaPart& a, const FormulaPart& b) {
  const auto is_same = [](const FailSafe::Guard& x, const FailSafe::Guard& y) {
    return x.input == y.input && x.unit == y.unit && x.low == y.low && x.high == y.high;
  };
  return std::equal(a.safe.guards.begin(), a.safe.guards.end(), b.safe.guards.begin(), b.safe.guards.end(), is_same);
}

/// The formulas one after the other. @return the variables with their corrections
std::vector<std::string> write_parts(Dialect& to, const std::vector<FormulaPart>& parts) {
  std::vector<std::string> corrections;
  for (const FormulaPart& part : parts) {
    if (&part == &parts.front() || !read_alike(part, *(&part - 1))) write_readings(to, part);
    write_formula(to, part);
    corrections.push_back(write_guard(to, part));
  }
  to.set(to.kept("started"), to.number(1.0));
  return corrections;
}

/// @param of      what is corrected, by which formula: a line each
/// @param guards  of the readings, in the program's order
std::vector<std::string> remarks_of(const std::vector<std::string>& of, const FailSafe& safe,
                                    const std::vector<FailSafe::Guard>& guards, Dialect& to, const std::string& made_by,
                                    double error_um) {
  const auto plain = [](std::string text) {  // safe in a comment of any of these languages
    std::replace_if(
        text.begin(), text.end(), [](char ch) { return ch < ' ' || ch > '~' || ch == '*'; }, '_');
    return text;
  };
  std::vector<std::string> list = {plain(made_by)};
  for (const std::string& line : of) list.push_back(plain(line));
  for (std::size_t k = 0; k < guards.size(); ++k) {
    const FailSafe::Guard& g = guards[k];
    list.push_back(
        plain(fmt::format("{}: {} in {}, valid from {:.5g} to {:.5g}{}", to.reading(k), g.input, g.unit, g.low, g.high,
                          safe.from_start && !compensation::is_drive(g.unit) ? " above the first reading" : "")));
  }
  if (!to.is_called()) {
    list.push_back(fmt::format("One row every {:g} s", safe.period_s));
    list.push_back(fmt::format("Where a run begins (the machine starts cold) set {} = 0", to.kept("started")));
  }
  list.push_back(fmt::format("Equal to what was judged within {:.1g} um while every reading is right", error_um));
  list.push_back(
      "It knows no broken thermometer but one out of range: a wire that breaks must stop the correction, by the PLC");
  return list;
}

/// Each constant is rounded by half a unit of its last digit, each product of them by a few: by so much the sum may differ.
double rounding_um(const DeployedModel& d, const NumberFormat& digits) {
  double size_um = std::abs(d.model.intercept), values = 1.0;
  for (const DriftModel::Term& t : d.model.terms) {
    double most = 1.0;
    for (const FailSafe::Guard& g : d.safe.guards) {
      if (g.input == t.input && !t.is_running) most = std::pow(std::max(std::abs(g.low), std::abs(g.high)), t.power);
    }
    size_um += (1.0 + t.power) * std::abs(t.coefficient) * most;
    values += most;
  }
  return std::max(1e-9, std::pow(10.0, 1 - digits.significant) * size_um + std::pow(10.0, -digits.decimals) * values);
}

/// A program of a language that runs in a cycle, or that is called, without lines yet.
std::unique_ptr<Dialect> dialect(ControlLanguage language, const std::string& name,
                                 const std::vector<FailSafe::Guard>& guards, double period_s, const ControlAxis& axis) {
  switch (language) {
    case ControlLanguage::kStructuredText:
      return std::make_unique<StructuredText>(name, guards);
    case ControlLanguage::kSiemens: {
      auto siemens = std::make_unique<Siemens>(name, axis, period_s);
      siemens->begin();
      return siemens;
    }
    case ControlLanguage::kHeidenhain:
      if (guards.size() > kHeidenhainReadings)
        throw InputError(
            fmt::format("the formula reads {} thermometers, and the PLC of a Heidenhain control passes at most "
                        "{} numbers to an NC program (Q100 to Q107); take a formula of fewer",
                        guards.size(), kHeidenhainReadings));
      return std::make_unique<Heidenhain>(name, axis);
    case ControlLanguage::kFanuc:
      return std::make_unique<Fanuc>(name, axis, guards.size());
  }
  throw std::logic_error("a control's language without a dialect");
}

void require_one_start(const DeployedModel& d) {
  if (d.safe.from_start != d.model.from_start) throw std::logic_error("formula and fail-safe count from different rows");
}

}  // namespace

ControlProgram control_program(const DeployedModel& d, ControlLanguage language, const std::string& name,
                               const ControlAxis& axis, const std::string& made_by) {
  require_one_start(d);
  if (language == ControlLanguage::kHeidenhain) require_static(d.model, "Heidenhain's control");
  if (language == ControlLanguage::kFanuc) require_static(d.model, "Fanuc's control");
  const std::unique_ptr<Dialect> to = dialect(language, name, d.safe.guards, d.safe.period_s, axis);
  const double error_um = rounding_um(d, to->digits());
  const std::vector<std::string> remarks =
      remarks_of({fmt::format("Correction of {} by {}: the axis moves by its negative", d.model.target, d.model.kind)},
                 d.safe, d.safe.guards, *to, made_by, error_um);
  std::vector<std::size_t> readings;
  for (std::size_t k = 0; k < d.safe.guards.size(); ++k) readings.push_back(k);
  ControlProgram program = to->program(remarks, write_parts(*to, {FormulaPart{d.model, d.safe, readings, ""}}).front());
  program.error_um = error_um;
  return program;
}

ControlProgram control_program_over_travel(std::span<const PlacedModel> places, ControlLanguage language,
                                           const std::string& name, const ControlAxis& axis, const std::string& made_by) {
  if (language == ControlLanguage::kHeidenhain || language == ControlLanguage::kFanuc)
    throw InputError(fmt::format(
        "a program that {} calls sets one shift for the whole travel, so it cannot follow the position of the axis; take "
        "--as siemens, linuxcnc, st or c, or one --model of the place where the parts are",
        language == ControlLanguage::kFanuc ? "Fanuc's control" : "Heidenhain's control"));
  require_of_one_run(places);
  const FailSafe& first = places.front().model.safe;
  std::vector<FailSafe::Guard> guards;
  std::vector<FormulaPart> parts;
  std::vector<std::string> of = {
      "One correction over the travel, straight between these places, held beyond: the axis moves by "
      "its negative"};
  std::vector<double> at_mm;
  for (const PlacedModel& p : places) {
    const FailSafe& safe = p.model.safe;
    require_one_start(p.model);
    FormulaPart part{p.model.model, safe, {}, fmt::format("p{}_", parts.size())};
    for (const FailSafe::Guard& g : safe.guards) part.readings.push_back(reading_among(guards, g));
    parts.push_back(std::move(part));
    at_mm.push_back(p.at_mm);
    of.push_back(fmt::format("At {:g} mm {} by {}", p.at_mm, p.model.model.target, p.model.model.kind));
  }
  const std::unique_ptr<Dialect> to = dialect(language, name, guards, first.period_s, axis);
  double error_um = 0.0;
  for (const PlacedModel& p : places) error_um = std::max(error_um, rounding_um(p.model, to->digits()));
  const std::vector<std::string> remarks = remarks_of(of, first, guards, *to, made_by, error_um);
  const std::vector<std::string> corrections = write_parts(*to, parts);
  ControlProgram program = to->program(remarks, to->over_travel(at_mm, corrections));
  program.error_um = error_um;
  return program;
}

}  // namespace driftwright::output
