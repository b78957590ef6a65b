#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "base/characters.hpp"
#include "base/errors.hpp"
#include "output/control_languages/dialect.hpp"

namespace driftwright::output {
namespace {

constexpr int kFanucFirst = 501, kFanucLast = 999;  // common variables that survive power-off

class Fanuc final : public Dialect {
 public:
  Fanuc(const std::string& name, const ControlAxis& axis, std::size_t n_readings)
      : Dialect({.significant = 8, .decimals = 7, .most = 1e7}),  // eight digits with the zero before the point
        name_(upper_case(plain_name(name))),
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
      head += fmt::format("({})\n", upper_case(r));
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

}  // namespace

std::unique_ptr<Dialect> fanuc(const std::string& name, const ControlAxis& axis, std::size_t n_readings) {
  return std::make_unique<Fanuc>(name, axis, n_readings);
}

}  // namespace driftwright::output
