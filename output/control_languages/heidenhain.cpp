#include <fmt/format.h>

#include <map>

#include "base/characters.hpp"
#include "base/errors.hpp"
#include "output/control_languages/dialect.hpp"

namespace driftwright::output {
namespace {

constexpr std::size_t kHeidenhainReadings = 8;  // Q100 to Q107 are what the PLC passes to an NC program

class Heidenhain final : public Dialect {
 public:
  Heidenhain(const std::string& name, const ControlAxis& axis)
      : Dialect({.significant = 12, .decimals = 14, .most = 1e9}),
        name_(upper_case(plain_name(name)).substr(0, 24)),
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

}  // namespace

std::unique_ptr<Dialect> heidenhain(const std::string& name, const ControlAxis& axis, std::size_t n_readings) {
  if (n_readings > kHeidenhainReadings)
    throw InputError(
        fmt::format("the formula reads {} thermometers, and the PLC of a Heidenhain control passes at most "
                    "{} numbers to an NC program (Q100 to Q107); take a formula of fewer",
                    n_readings, kHeidenhainReadings));
  return std::make_unique<Heidenhain>(name, axis);
}

}  // namespace driftwright::output
