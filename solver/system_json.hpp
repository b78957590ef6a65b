#pragma once
// A reduced system as names and numbers in JSON, and arrays, which the caller stores: in files, or in the same JSON.

#include <Eigen/Core>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "effects/heat_balance.hpp"
#include "solver/reduced_model.hpp"

namespace driftwright::solver {

/// Stores an array under a name, or returns the stored one.
using WriteArray = std::function<void(const std::string& name, const Eigen::MatrixXd& values)>;
using ReadArray = std::function<Eigen::MatrixXd(const std::string& name)>;

/// Writes the arrays. @return names and numbers, which belong to the arrays. @throws what `write` throws
[[nodiscard]] nlohmann::ordered_json write_system(const ReducedSystem& system, const Eigen::VectorXd& start,
                                                  const WriteArray& write);
/// Reads what write_system() has written. The laws come from a balance of effects::heat_balance().
/// @throws InputError  for an array of another size, and what `read` throws
/// @throws nlohmann::json::exception  for a name or number that is missing
/// @throws std::logic_error  as bind_laws(), for the balance of another machine
[[nodiscard]] ReducedSystem read_system(const nlohmann::ordered_json& json, const effects::HeatBalance& balance,
                                        const ReadArray& read, Eigen::VectorXd& start);

}  // namespace driftwright::solver
