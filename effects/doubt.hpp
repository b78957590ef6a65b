#pragma once
// What may be wrong with a machine: effects that it may have beside those written, and the numbers of them that a diagnosis turns. Each kind says so
// for itself in EffectKind::doubts; what it says is plain data.

#include <array>
#include <map>
#include <span>

#include "effects/effect.hpp"

namespace driftwright::effects {

inline constexpr double kFactorSd = 0.7;  ///< 1 sigma of the logarithm of a factor that is an effect
inline constexpr double kFactorTrial = 0.2;

/// What a kind may look at when it is asked where it could be.
struct DoubtScene {
  double reference_K = 293.15;
  double typical_rpm = 1.0;  ///< laws of speed are stated there
  double top_rpm = 1.0;      ///< the highest of all records, as the scenario's own effects make it
  std::vector<double>
      speed_steps_rpm;  ///< between two speeds that it turns at for a while: where a gear may change; six at the most
  double heat_W = 1.0;  ///< of all sources at the highest speed
  bool turns = false;   ///< in some record
  std::array<double, 3> top_feed_m_s = {0.0, 0.0, 0.0};    ///< of the axes x, y, z in all records; 0: it never moves
  std::array<bool, 3> axis_rests = {false, false, false};  ///< for a while in some record
  bool starts_and_stops = false;                           ///< turns and stands in one record
  struct Run {
    std::string name;
    double length_s = 0.0;
    bool has_ambient = false;     ///< its temperature was recorded
    double row_s = 0.0;           ///< between two rows, as a rule
    bool starts_as_read = false;  ///< its first readings say how warm the machine is there
  };
  std::vector<Run> runs;
  struct Displacement {
    std::string name;
    bool is_tilt = false;
    [[nodiscard]] const char* unit() const { return is_tilt ? "urad" : "um"; }
  };
  std::vector<Displacement> displacements;  ///< that were measured, as the sensors
  std::vector<std::string> sensors;
  std::map<std::string, Body> sensor_bodies;  ///< where they are said to sit, of those on lumped nodes
  std::vector<Effect> own;                    ///< of the scenario
  HeatBalance balance;                        ///< of these, radiation as films
  std::vector<Body> bodies;                   ///< regions and lumped nodes
  std::vector<std::string> surfaces;          ///< outer ones
  struct Material {
    Body body;
    bool conducts = false, stores = false;
    bool expands = false;                    ///< and bends the mesh
    std::vector<std::string> sensitivities;  ///< displacements that follow its temperature by a number of their own
    double capacity_J_K = 0.0;               ///< of the whole body
  };
  std::vector<Material> materials;
  /// Something recorded beside the drive, in every record, that changes there (Cyclogram::Column), or the cutting power.
  struct Column {
    std::string header, unit;
    double span = 1.0;         ///< largest minus smallest value, > 0
    double top = 1.0;          ///< largest absolute value
    int n_levels = 2;          ///< different absolute values, as many as three
    std::vector<Body> drives;  ///< bodies that the scenario heats or cools by it already
    std::vector<Body> heats;   ///< of these, those that it heats in proportion
    [[nodiscard]] bool is_temperature() const { return unit == "degC"; }
  };
  std::vector<Column> columns;

  [[nodiscard]] double longest_s() const;
  /// 1 sigma of a heat that nobody knows of [W].
  [[nodiscard]] double unknown_heat_W() const;
  /// Size of a path of heat that nobody knows of [W/K]: the geometric mean of the scenario's own links at the typical speed; where there are none,
  /// such that the unknown heat makes 10 K.
  [[nodiscard]] double typical_conductance_W_K() const;
};

/// One number of a doubted effect. Its scale is that of its prior: nominal + x or nominal exp(x), x about zero within prior_sd (diagnosis/fit.hpp).
struct DoubtedNumber {
  std::string name, unit;  ///< as it is reported; set() is given it so. A time: in s
  double nominal = 0.0;
  double prior_sd = 1.0, step = 0.1;  ///< of x; a step is what differences are taken over
  double low = -1e300, high = 1e300;  ///< of the value
  bool is_log = false;
  bool is_time = false;  ///< found by search beside slopes
  /// Of a logarithmic number behind the size: what is looked at first grows in proportion to the size, so that their ratio (a time constant) stays.
  bool grows_with_size = false;
  /// Writes the value into the effects that Doubt::added was copied to. Empty: the parameter of that name of each of them.
  std::function<void(std::span<Effect>, double value)> set = {};
};

/// One law by which the machine may differ from what is written: effects to add, and their numbers.
struct Doubt {
  std::string finding, where;          ///< key of the effect and place, as diagnosis.json says them
  std::string law;                     ///< in words
  std::string when = {};               ///< the records it holds in, in words ("in monday"); "": as `law` says, or all
  std::vector<Effect> added;           ///< they do nothing while the first number is nominal
  std::vector<DoubtedNumber> numbers;  ///< the size first, then what shapes it
  double trial = kFactorTrial;         ///< x of the size at which its signature is taken
  std::vector<std::vector<double>> grid = {{}};  ///< x of numbers 1.. to try first
  double at_speed_rpm = 0.0;                     ///< the speed its size is stated at; 0: none
  bool all_or_nothing = false;                   ///< two cables are swapped or not: the size is the trial
  double rarity = 0.0;                           ///< nats: how much rarer it is than other laws, before any reading
  bool is_built_in = false;                      ///< so a machine is built: in all records or in none
  bool scatters = false;                         ///< its size is one of those that no scenario knows better than to 10 %
};

/// A number about zero, or another nominal value, in its unit. @param prior_sd, step  of the value
[[nodiscard]] DoubtedNumber doubted(std::string name, std::string unit, double prior_sd, double step, double nominal = 0.0);
/// A factor about one: of the parameter `factor`.
[[nodiscard]] DoubtedNumber doubted_factor();
/// When something began, in s within a run; and x where to look first, n - 1 of them.
[[nodiscard]] DoubtedNumber doubted_time(std::string name, double run_length_s,
                                         std::function<void(std::span<Effect>, double)> set = {});
[[nodiscard]] std::vector<std::vector<double>> time_grid(double run_length_s, int n);

/// Whether an exchange of its own joins two bodies.
[[nodiscard]] bool are_joined(const DoubtScene& s, const Body& a, const Body& b);
/// Whether both are joined to some third body.
[[nodiscard]] bool have_common_neighbour(const DoubtScene& s, const Body& a, const Body& b);

/// Whether some film lies on a surface.
[[nodiscard]] bool has_film(const HeatBalance& balance, const std::string& surface);

/// What a diagnosis calls the place of an exchange: a surface, a joint, or both ends "housing,ambient".
[[nodiscard]] std::string where_of(const Exchange& exchange);
/// And that of an effect: of its exchange where that is doubted as a whole, else its own.
[[nodiscard]] std::string where_of(const Effect& effect);

}  // namespace driftwright::effects
