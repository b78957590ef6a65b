#include "follow/watch_json.hpp"

#include "base/bounded_json.hpp"
#include "base/file_bytes.hpp"
#include "base/hashed_json.hpp"

namespace driftwright::follow {
namespace {

using output::Json;

constexpr const char* kWatchFormat = "driftwright watch 1";

WatchLimits limits_of_file(const Json& j, const std::string& model_hash) {
  if (!j.is_object() || output::value<std::string>(j, "format") != kWatchFormat)
    throw InputError(fmt::format(
        "this file holds no limits of a watch (key `format` must be \"{}\"); `follow --calibrate-watch` writes them",
        kWatchFormat));
  if (!is_whole(j))
    throw InputError(
        "key `hash` does not fit what the file holds: it was damaged or changed, or is of a version that wrote none; "
        "`follow --calibrate-watch` writes it anew");
  if (output::value<std::string>(j, "model_hash") != model_hash)
    throw InputError("they are those of another model file; `follow --calibrate-watch` writes them anew");
  return limits_of(j);
}

}  // namespace

WatchLimits limits_of(const Json& j) {
  WatchLimits limits{.sensors = output::value<std::vector<std::string>>(j, "sensors"),
                     .scales = {},
                     .machine_days = output::finite(j, "machine_days"),
                     .n_alarms = output::value<int>(j, "alarms_simulated")};
  const Json scales = output::list(j, "scales");
  const auto n = static_cast<Eigen::Index>(limits.sensors.size());
  if (scales.size() != limits.scales.size())
    throw InputError(fmt::format("`scales` has {} entries; {} are required", scales.size(), limits.scales.size()));
  for (std::size_t k = 0; k < scales.size(); ++k) {
    if (output::finite(scales[k], "mean_over_s") != kWatchedOver_s[k])
      throw InputError(
          fmt::format("`mean_over_s` is {}; it must be {}", scales[k].at("mean_over_s").dump(), kWatchedOver_s[k]));
    const auto values = output::value<std::vector<double>>(scales[k], "covariance_K2");
    if (static_cast<Eigen::Index>(values.size()) != n * n)
      throw InputError("`covariance_K2` is of another number of sensors");
    limits.scales[k] = {Eigen::Map<const Eigen::MatrixXd>(values.data(), n, n), output::positive(scales[k], "threshold")};
  }
  return limits;
}

Json limits_json(const WatchLimits& limits) {
  Json scales = Json::array();
  for (std::size_t k = 0; k < limits.scales.size(); ++k) {
    const Eigen::MatrixXd& c = limits.scales[k].covariance;
    scales.push_back({{"mean_over_s", kWatchedOver_s[k]},
                      {"threshold", limits.scales[k].threshold},
                      {"covariance_K2", std::vector<double>(c.data(), c.data() + c.size())}});
  }
  return {{"machine_days", limits.machine_days},
          {"alarms_simulated", limits.n_alarms},
          {"sensors", limits.sensors},
          {"scales", std::move(scales)}};
}

Json watch_json(const WatchLimits& limits, const std::string& model_hash) {
  Json j = {{"format", kWatchFormat}, {"model_hash", model_hash}};
  j.update(limits_json(limits));
  return with_hash(std::move(j));
}

WatchLimits read_watch(const std::string& path, const std::string& model_hash) {
  try {
    return limits_of_file(parse_json(read_bytes(path)), model_hash);
  } catch (const nlohmann::json::exception& e) {
    throw InputError(fmt::format("--watch {}: {}", path, e.what()));
  } catch (const InputError& e) {
    throw InputError(fmt::format("--watch {}: {}", path, e.what()));
  }
}

}  // namespace driftwright::follow
