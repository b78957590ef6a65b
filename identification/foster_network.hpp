#pragma once
// A network of bodies side by side: each stands in the ambient, loses heat to it alone and is heated by one law of one drive, or by none. Thermometers are means of bodies
// and the ambient, displacements sums of their temperatures.
//
//     tau_k dT_b/dt = T_ambient - T_b + rise_b u_b(t),   theta_c = offset_c + sum_b v_cb T_b + v_c T_ambient,  v >= 0, sum v <= 1,   d_c = sum_b s_cb (T_b - T_b(0))
//
// T_ambient is the ambient less its first value in the record. Between a drive and what it heats any linear network of positive capacities and conductances has such a form (Foster).
// A thermometer far from the heat, which follows a step in an S, has weights of both signs and is not met; means with positive weights keep thermometers passive
// at drives that were never fitted; what is left of the sum is a share of something that keeps its temperature: a floor, a cooled part. Given time constants and laws it is linear in v and s, so that there is one best fit and no start to choose.
// Beside a scenario's own simulation S_c the same columns say what is missing of it: y_c = kept_c S_c + heated bodies (rises alone) + ambient parts, 0 <= kept <= 1, of thermometers all weights >= 0
// and kept + ambient parts <= 1; least squares are drawn to kept = 1 and nothing else.
// Sources: Foster, Bell System Technical Journal 3 (1924) 259-267; for heat: Gerstenmaier & Wachutka, Microelectronics Reliability 44 (2004) 1469.

#include <map>
#include <optional>

#include "identification/lagged_inputs.hpp"

namespace driftwright::identification {

/// A time constant with the laws whose heat bodies of it have; beside them one without heat, where there is an ambient.
struct Pole {
  double tau_s = 0.0;
  std::vector<std::size_t> laws;  ///< of Structure::laws
};
struct Structure {
  std::vector<Law> laws;
  std::vector<Pole> poles;
  [[nodiscard]] std::size_t n_heated() const;
};

/// Ridge penalties, each a share of its column's own sum of squares: the larger, the less a fit may do.
struct Smoothness {
  double thermometers = 1e-3, drive = 1e-3, ambient = 1e-3;
  /// Of what a scenario's simulation loses; huge: it is kept whole.
  double scenario_of_thermometers = 1e6, scenario_of_displacements = 1e6;
  double offset = 0.0;  ///< of a thermometer's constant
  /// Of how much warmer or colder than the ambient a record begins, which is true of it alone; huge: it begins in balance.
  double start_of_thermometers = 1e-3, start_of_displacements = 1e-3;
};

/// One channel in numbers. Bodies in the order of bodies_of().
struct ChannelFit {
  Eigen::VectorXd weight;   ///< v of bodies; or s [um/K]
  double of_ambient = 0.0;  ///< v of the ambient itself; of a displacement 0
  double kept = 0.0;        ///< of the scenario's simulation; without one 0
  double offset = 0.0;      ///< of a thermometer in degC [K]
  Eigen::VectorXd
      of_records;  ///< what is true of records alone: a constant of each (of displacements and rises), then each pole's part of how warm it begins
  Eigen::VectorXd
      standard_deviation;  ///< of the heated part of a displacement, n rows counted as n / rows_as_one(); else empty
};

struct NetworkBody {
  double tau_s = 0.0;
  std::optional<std::size_t> law;  ///< none: warmed by the ambient alone
  double rise_K = 0.0;             ///< over the ambient, in the end, where the law is 1
};
[[nodiscard]] std::vector<NetworkBody> bodies_of(const Structure& structure, bool has_ambient, double rise_K);

/// Records and a structure as a problem of linear least squares.
class FosterProblem {
 public:
  /// @param rise_K  of heated bodies where their law is 1: larger than any thermometer's rise, for thermometers are means
  /// @param blocks  of each record: so many rows are taken as one, by their means, once all are computed
  /// @param simulated  what a scenario says of the same rows, if one is to be extended: a record each, with all thermometers and displacements
  FosterProblem(std::span<const Record> records, const RecordRoles& roles, Structure structure, double rise_K,
                const std::vector<std::size_t>& blocks, std::span<const Record> simulated = {});

  [[nodiscard]] const std::vector<NetworkBody>& bodies() const { return bodies_; }
  [[nodiscard]] const Structure& structure() const { return structure_; }
  [[nodiscard]] const std::vector<std::string>& channels() const { return channels_; }  ///< thermometers, then displacements
  [[nodiscard]] std::size_t n_thermometers() const { return n_thermometers_; }
  [[nodiscard]] std::size_t n_rows() const { return static_cast<std::size_t>(columns_.rows()); }
  [[nodiscard]] double reference_degC() const { return reference_degC_; }  ///< the ambient in the first row of all, else 20

  /// Normal equations of the rows that count, one of each set of rows that channels have. Rows of all records, one after the other.
  struct Normal {
    Eigen::MatrixXd g;
    Eigen::MatrixXd c;            ///< a column a channel
    std::vector<double> n;        ///< rows of each channel
    std::vector<std::size_t> of;  ///< of each channel, which of `own`
    std::vector<Eigen::MatrixXd> own;
    Eigen::MatrixXd with_scenario;     ///< products of all columns and a channel's simulation, a column a channel
    Eigen::VectorXd scenario_squares;  ///< of each channel
  };
  [[nodiscard]] Normal normal(const std::vector<bool>& hidden) const;

  [[nodiscard]] ChannelFit fit(const Normal& normal, std::size_t channel, const Smoothness& smoothness) const;
  /// The scenario as it is, with what is true of records alone.
  [[nodiscard]] ChannelFit scenario_alone(const Normal& normal, std::size_t channel, Smoothness smoothness) const;
  [[nodiscard]] bool extends_scenario() const { return n_scenario_ > 0; }
  /// What the scenario says of a channel, as measured() has it.
  [[nodiscard]] Eigen::VectorXd simulated(std::size_t channel) const {
    return simulated_.col(static_cast<Eigen::Index>(channel));
  }
  /// What the network says of all rows. Thermometers less the first ambient of their record. @param in_records  with what is true of records alone
  [[nodiscard]] Eigen::VectorXd predicted(std::size_t channel, const ChannelFit& fit, bool in_records) const;
  /// How much warmer a body is than the first ambient of its record.
  [[nodiscard]] Eigen::VectorXd body_K(std::size_t body) const { return body_columns_.col(static_cast<Eigen::Index>(body)); }
  /// The part of it that is heat's; of a body that none heats 0.
  [[nodiscard]] Eigen::VectorXd heated_K(std::size_t body) const;
  [[nodiscard]] const Eigen::VectorXd& ambient_K() const { return ambient_K_; }
  /// Readings of a channel, thermometers in degC less the first ambient of their record; NaN where missing.
  [[nodiscard]] Eigen::VectorXd measured(std::size_t channel) const {
    return readings_.col(static_cast<Eigen::Index>(channel));
  }
  /// What is missed row by row, with what is true of records alone; NaN where there is no reading. A displacement of a record of which no row was fitted to counts from its
  /// first reading. @param in_records  false: as the written scenario is simulated, which knows nothing of a record's own; displacements and rises count from their first readings
  [[nodiscard]] Eigen::VectorXd misses(std::size_t channel, const ChannelFit& fit, bool in_records = true) const;
  /// Some rows by themselves, for root mean squares of their misses().
  struct Part {
    std::vector<std::size_t> records;  ///< of each row
    Eigen::MatrixXd bodies, of_records, readings, simulated;
    Eigen::VectorXd ambient_K;
  };
  [[nodiscard]] Part part(const std::vector<bool>& rows) const;
  /// NaN where none has a reading.
  [[nodiscard]] double rms(const Part& part, std::size_t channel, const ChannelFit& fit, bool in_records = true) const;

 private:
  [[nodiscard]] Eigen::Index first_of_records() const { return n_heated_ + n_ambient_ + n_direct_ + n_scenario_; }
  /// What a record's misses count from, where not from 0: the first of them.
  [[nodiscard]] double zero_of(std::size_t record, std::size_t channel, const ChannelFit& fit, bool in_records) const;
  [[nodiscard]] ChannelFit fit_thermometer(const Eigen::MatrixXd& g, const Eigen::VectorXd& c, double n, bool is_rise,
                                           const Smoothness& smoothness) const;
  [[nodiscard]] ChannelFit fit_displacement(const Eigen::MatrixXd& g, const Eigen::VectorXd& c, double n,
                                            const Smoothness& smoothness) const;

  Structure structure_;
  bool has_ambient_ = false;
  double reference_degC_ = 20.0;
  std::vector<NetworkBody> bodies_;
  std::vector<std::string> channels_;
  std::size_t n_thermometers_ = 0;
  std::vector<char> counts_from_start_;  ///< of each channel: a displacement, or a rise in K
  std::vector<std::size_t> first_row_;   ///< of each record; last the number of all rows
  Eigen::MatrixXd body_columns_;         ///< T_b less the reference
  Eigen::VectorXd ambient_K_;
  /// Heated parts, ambient parts, ambient, the scenario's simulation (0 here: it differs from channel to channel), a constant of each record, start of each record and pole.
  Eigen::MatrixXd columns_;
  Eigen::MatrixXd readings_, simulated_;
  Eigen::Index n_heated_ = 0, n_ambient_ = 0, n_direct_ = 0, n_scenario_ = 0, n_records_ = 0, n_starts_ = 0;
  std::vector<std::size_t> pole_of_heated_;
};

}  // namespace driftwright::identification
