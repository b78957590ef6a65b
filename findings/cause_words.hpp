#pragma once
// A cause in words for somebody at the machine: what is different, what to look at, and how sure that is.

#include "diagnosis/diagnosis.hpp"

namespace driftwright::findings {

/// What a cause changes; none for an effect that is not part of the shipped catalogue.
[[nodiscard]] std::optional<diagnosis::StatedQuantity> quantity_of_cause(const diagnosis::Diagnosis& d, std::size_t cause);

/// What is different, without full stop: "The reading of thermometer t_column is wrong".
[[nodiscard]] std::string difference_text(std::optional<diagnosis::StatedQuantity> quantity, const std::string& where);
/// The same with law and numbers, a sentence: "The reading of thermometer th3 is wrong: constant error; bias 1.52 K.",
/// "The heat in head is not what the scenario says (motor_loss at head, line 7): another power; power 165 W."
[[nodiscard]] std::string cause_sentence(const diagnosis::Diagnosis& d, std::size_t cause);

/// What to look at on the machine, a sentence: "Look at thermometer t_column: ...".
[[nodiscard]] std::string look_text(std::optional<diagnosis::StatedQuantity> quantity, const std::string& where);

/// A probability in words and per cent: "very likely (92 %)".
[[nodiscard]] std::string sure_text(double probability);
/// How sure a cause is, a sentence.
[[nodiscard]] std::string sure_sentence(const diagnosis::Diagnosis& d, std::size_t cause);

/// Whether a cause is a number of the scenario that moved too far, and not one that the search found.
[[nodiscard]] bool is_moved_number(const diagnosis::Diagnosis& d, std::size_t cause);

/// "2 causes", "1 cause".
[[nodiscard]] std::string counted(std::size_t n, const std::string& one, const std::string& many);

}  // namespace driftwright::findings
