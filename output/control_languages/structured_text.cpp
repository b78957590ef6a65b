#include <fmt/format.h>

#include <algorithm>

#include "base/characters.hpp"
#include "output/control_languages/dialect.hpp"

namespace driftwright::output {
namespace {

using compensation::FailSafe;

class StructuredText final : public Dialect {
 public:
  StructuredText(const std::string& name, const std::vector<FailSafe::Guard>& guards)
      : Dialect({}), name_(plain_name(name)) {
    for (const FailSafe::Guard& g : guards) {
      const std::string plain = plain_name(fmt::format("in_{}_{}", g.input, g.unit));
      std::string own = plain;
      const auto is_taken = [&](const std::string& other) {
        return upper_case(other) == upper_case(own);
      };  // case does not count
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

}  // namespace

std::unique_ptr<Dialect> structured_text(const std::string& name, const std::vector<compensation::FailSafe::Guard>& guards) {
  return std::make_unique<StructuredText>(name, guards);
}

}  // namespace driftwright::output
