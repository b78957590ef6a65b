#include <fmt/format.h>

#include <map>

#include "base/characters.hpp"
#include "base/errors.hpp"
#include "output/control_languages/dialect.hpp"

namespace driftwright::output {
namespace {

constexpr int kSiemensActions = 254;  // numbers of synchronized actions that a user may give

class Siemens final : public Dialect {
 public:
  Siemens(const std::string& name, const ControlAxis& axis, double period_s)
      : Dialect({}), name_(upper_case(plain_name(name)).substr(0, 24)), axis_(axis), period_s_(period_s) {}
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

}  // namespace

std::unique_ptr<Dialect> siemens(const std::string& name, const ControlAxis& axis, double period_s) {
  auto made = std::make_unique<Siemens>(name, axis, period_s);
  made->begin();
  return made;
}

}  // namespace driftwright::output
