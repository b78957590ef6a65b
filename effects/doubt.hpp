#pragma once
// Doubts: the ways in which a machine may differ from its scenario. A doubt is a set of effects to add, with the numbers of
// them that a diagnosis fits. Each effect kind lists its own doubts in EffectKind::doubts, as plain data.

#include <array>
#include <map>
#include <span>

#include "effects/effect.hpp"

namespace driftwright::effects {

inline constexpr double kFactorSd = 0.7;  ///< prior of an unknown factor: 1 sigma of its logarithm
/// Change of that logarithm at which a diagnosis computes the factor's signature.
inline constexpr double kFactorTrial = 0.2;

/// The data that an effect kind may use when it lists its doubts.
struct DoubtScene {
  double reference_K = 293.15;  ///< reference temperature of the scenario
  double typical_rpm = 1.0;     ///< speed at which the sizes of laws of speed are stated
  double top_rpm = 1.0;         ///< highest speed of all records, after the scenario's own effects on the drive
  /// Between two speeds that are held for a while: where a gear may change; at most six.
  std::vector<double> speed_steps_rpm;
  double heat_W = 1.0;  ///< sum of all sources at the highest speed
  bool turns = false;   ///< the spindle turns in some record
  std::array<double, 3> top_feed_m_s = {0.0, 0.0,
                                        0.0};  ///< highest in all records, of the axes x, y, z; 0: the axis never moves
  std::array<bool, 3> axis_rests = {false, false, false};  ///< the axis rests for a while in some record
  bool starts_and_stops = false;                           ///< the spindle both turns and rests in one record
  struct Run {
    std::string name;
    double length_s = 0.0;
    bool has_ambient = false;     ///< the ambient temperature was recorded
    double row_s = 0.0;           ///< typical interval of two rows
    bool starts_as_read = false;  ///< its first readings give the temperature of the machine at its start
  };
  std::vector<Run> runs;
  struct Displacement {
    std::string name;
    bool is_tilt = false;
    [[nodiscard]] const char* unit() const { return is_tilt ? "urad" : "um"; }
  };
  std::vector<Displacement> displacements;  ///< that were measured; likewise the sensors
  std::vector<std::string> sensors;
  std::map<std::string, Body> sensor_bodies;  ///< the lumped node that a sensor is on, if the scenario says so
  std::vector<Effect> own;                    ///< effects of the scenario
  HeatBalance balance;                        ///< heat balance of these, with radiation as films
  std::vector<Body> bodies;                   ///< regions and lumped nodes
  std::vector<std::string> surfaces;          ///< outer surfaces
  struct Material {
    Body body;
    bool conducts = false, stores = false;
    bool expands = false;                    ///< and thereby deforms the mesh
    std::vector<std::string> sensitivities;  ///< displacements that have a sensitivity to its temperature in the scenario
    double capacity_J_K = 0.0;               ///< of the whole body
  };
  std::vector<Material> materials;
  /// A column that is recorded in every record and changes there (Cyclogram::Column), or the cutting power.
  struct Column {
    std::string header, unit;
    double span = 1.0;         ///< largest minus smallest value, > 0
    double top = 1.0;          ///< largest absolute value
    int n_levels = 2;          ///< number of different absolute values, counted up to three
    std::vector<Body> drives;  ///< bodies that the scenario already heats or cools by this column
    std::vector<Body> heats;   ///< those of them that it heats in proportion to the column
    [[nodiscard]] bool is_temperature() const { return unit == "degC"; }
  };
  std::vector<Column> columns;

  /// Duration of the longest run.
  [[nodiscard]] double longest_s() const;
  /// Prior of an unknown source of heat: 1 sigma [W].
  [[nodiscard]] double unknown_heat_W() const;
  /// Typical conductance of an unknown path of heat [W/K]: the geometric mean of the scenario's own links at the typical
  /// speed. Without links, the conductance over which the unknown heat makes 10 K.
  [[nodiscard]] double typical_conductance_W_K() const;
};

/// One number of a doubted effect. Its value is nominal + x, or nominal exp(x), with x normal about zero with prior_sd
/// (diagnosis/fit.hpp).
struct DoubtedNumber {
  std::string name, unit;  ///< as reported; set() receives the value in this unit, a time in s
  double nominal = 0.0;
  double prior_sd = 1.0, step = 0.1;  ///< of x; `step` is the step of finite differences
  double low = -1e300, high = 1e300;  ///< of the value
  bool is_log = false;
  bool is_time = false;  ///< also found by a search on a grid, not by slopes alone
  /// For a logarithmic number other than the size: its starting value grows in proportion to the size, so that their ratio
  /// (a time constant) is kept.
  bool grows_with_size = false;
  /// Writes the value into a copy of Doubt::added. Empty: sets the parameter of that name in each of them.
  std::function<void(std::span<Effect>, double value)> set = {};
};

/// One law by which the machine may differ from what is written: effects to add, and their numbers.
struct Doubt {
  std::string finding, where;          ///< key of the effect and place, as in diagnosis.json
  std::string law;                     ///< in words
  std::string when = {};               ///< the records it applies to, in words ("in monday"); "": as `law` says, or all
  std::vector<Effect> added;           ///< without effect while the first number is nominal
  std::vector<DoubtedNumber> numbers;  ///< first the size, then the numbers that shape it
  double trial = kFactorTrial;         ///< x of the size at which its signature is computed
  std::vector<std::vector<double>> grid = {{}};  ///< x of the numbers after the size to try first
  double at_speed_rpm = 0.0;                     ///< the speed at which its size is stated; 0: none
  /// It is either there or not, as two swapped cables: the size is not fitted but equals the trial.
  bool all_or_nothing = false;
  double rarity = 0.0;       ///< how much less likely it is than other laws before any reading [nats]
  bool is_built_in = false;  ///< a property of how the machine is built: in all records or in none
  bool scatters = false;     ///< its size is one of those that no scenario knows to better than 10 %
};

/// A number with a normal prior about zero or another nominal value, in its unit. @param prior_sd, step  of the value
[[nodiscard]] DoubtedNumber doubted(std::string name, std::string unit, double prior_sd, double step, double nominal = 0.0);
/// A factor about one, for the parameter `factor`.
[[nodiscard]] DoubtedNumber doubted_factor();
/// The time at which something began, in s within a run. time_grid() gives the n - 1 values of x to try first.
[[nodiscard]] DoubtedNumber doubted_time(std::string name, double run_length_s,
                                         std::function<void(std::span<Effect>, double)> set = {});
[[nodiscard]] std::vector<std::vector<double>> time_grid(double run_length_s, int n);

/// True if an exchange joins the two bodies directly.
[[nodiscard]] bool are_joined(const DoubtScene& s, const Body& a, const Body& b);
/// True if both are joined to a common third body.
[[nodiscard]] bool have_common_neighbour(const DoubtScene& s, const Body& a, const Body& b);

/// True if the surface has a film that is the same everywhere on it.
[[nodiscard]] bool has_even_film(const HeatBalance& balance, const std::string& surface);
/// True if the surface has a film.
[[nodiscard]] bool has_film(const HeatBalance& balance, const std::string& surface);

/// The name of an exchange's place in a diagnosis: a surface, a joint, or both ends "housing,ambient".
[[nodiscard]] std::string where_of(const Exchange& exchange);
/// The name of an effect's place: that of its exchange if the exchange is doubted as a whole, else its own.
[[nodiscard]] std::string where_of(const Effect& effect);

}  // namespace driftwright::effects
