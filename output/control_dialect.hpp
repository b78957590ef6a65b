#pragma once
// The language of a control, as the formula of a correction is written in it (control_program.hpp). One file a language;
// each makes its Dialect, without lines yet.

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "output/control_program.hpp"

namespace driftwright::output {

/// How many digits a language keeps of a constant: significant ones, and after the point; the largest that it takes.
struct NumberFormat {
  int significant = 17, decimals = 300;
  double most = HUGE_VAL;
};

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

  [[nodiscard]] std::string number(double x) const;  ///< without exponent; a negative one in parentheses
  [[nodiscard]] const NumberFormat& digits() const { return digits_; }
  void at_least(const std::string& target, const std::string& low) { set_if(target, Compare::kLess, low, target, low); }
  void at_most(const std::string& target, const std::string& high) { set_if(target, Compare::kGreater, high, target, high); }

 protected:
  std::string text_;

 private:
  NumberFormat digits_;
};

/// The sign of a comparison in a language that writes them so.
[[nodiscard]] const char* sign_of(Dialect::Compare compare, const char* less, const char* equal, const char* greater);

/// Letters, digits and single underscores, as every language allows them.
[[nodiscard]] std::string plain_name(const std::string& text);

/// IEC 61131-3, for a PLC. @param guards  of the readings, in their order
[[nodiscard]] std::unique_ptr<Dialect> structured_text(const std::string& name,
                                                       const std::vector<compensation::FailSafe::Guard>& guards);
/// Synchronized actions of a SINUMERIK 840D, one row every period_s.
[[nodiscard]] std::unique_ptr<Dialect> siemens(const std::string& name, const ControlAxis& axis, double period_s);
/// @throws InputError  for more readings than a PLC passes to an NC program
[[nodiscard]] std::unique_ptr<Dialect> heidenhain(const std::string& name, const ControlAxis& axis, std::size_t n_readings);
[[nodiscard]] std::unique_ptr<Dialect> fanuc(const std::string& name, const ControlAxis& axis, std::size_t n_readings);

}  // namespace driftwright::output
