#pragma once
// A network of parallel bodies: each exchanges heat with the ambient only, and is heated by one law of one drive, or by
// none. Thermometers are weighted means of bodies and the ambient, displacements are sums of body temperatures.
//
//     tau_k dT_b/dt = T_ambient - T_b + rise_b u_b(t), theta_c = offset_c + sum_b v_cb T_b + v_c T_ambient, v >= 0, sum v <=
//     1, d_c = sum_b s_cb (T_b - T_b(0))
// T_ambient is the ambient minus its first value in the record. Any linear network of positive capacities and conductances
// between a drive and the point that it heats has such a form (Foster). A thermometer far from the heat, whose step response
// is S-shaped, has weights of both signs and is not represented exactly. Positive weights keep thermometers passive for
// drives that were never fitted. The remainder of the sum is the share of something at constant temperature: a floor, a
// cooled part. For given time constants and laws the model is linear in v and s, so there is one best fit, and it needs no
// first guess.
//
// If a scenario's simulation S_c is extended, the same columns describe what it lacks: y_c = kept_c S_c + heated bodies
// (rises alone) + ambient parts, with 0 <= kept <= 1; for thermometers all weights are >= 0 and kept + ambient parts <= 1.
// The penalties draw the fit to kept = 1 and nothing else. Sources: Foster, Bell System Technical Journal 3 (1924) 259-267;
// for heat: Gerstenmaier & Wachutka, Microelectronics Reliability 44 (2004) 1469.

#include <map>
#include <optional>

#include "identification/lagged_inputs.hpp"

namespace driftwright::identification {

/// A time constant, and the laws that heat bodies with it; if there is an ambient, one more body without heat has it.
struct Pole {
  double tau_s = 0.0;
  std::vector<std::size_t> laws;  ///< of Structure::laws
};
struct Structure {
  std::vector<Law> laws;
  std::vector<Pole> poles;
  [[nodiscard]] std::size_t n_heated() const;
};

/// Ridge penalties, each relative to its column's sum of squares: a larger penalty restricts the fit more.
struct Smoothness {
  double thermometers = 1e-3, drive = 1e-3, ambient = 1e-3;
  /// On the lost part of a scenario's simulation; huge: it is kept completely.
  double scenario_of_thermometers = 1e6, scenario_of_displacements = 1e6;
  double offset = 0.0;  ///< on a thermometer's constant
  /// On the initial difference of a record from the ambient, which belongs to that record alone; huge: it begins in balance.
  double start_of_thermometers = 1e-3, start_of_displacements = 1e-3;
  bool is_scenario_alone = false;  ///< the unchanged scenario; of the penalties those of starts count
};

/// The fit of one channel. Bodies are in the order of bodies_of().
struct ChannelFit {
  Eigen::VectorXd weight;   ///< v of the bodies; of a displacement s [um/K]
  double of_ambient = 0.0;  ///< v of the ambient itself; 0 for a displacement
  double kept = 0.0;        ///< share of the scenario's simulation; 0 without one
  double offset = 0.0;      ///< of a thermometer in degC [K]
  /// Terms of single records: a constant for each (displacements and rises), then per pole the initial warmth.
  Eigen::VectorXd of_records;
  /// Of the bodies' weights, of their heated part where they have one, with n rows counted as n / rows_as_one(). It is that
  /// of ridge regression as a Bayesian sees it; a thermometer's weights at 0 have none. Empty for a scenario alone.
  Eigen::MatrixXd covariance;
};

/// The mean of fits, term by term. With the same columns it predicts the mean of their predictions. The covariance is the
/// mean, too: the fits have the same rows, so their errors do not cancel.
[[nodiscard]] ChannelFit mean_fit(std::span<const ChannelFit> fits);
/// Mean square distance of the weights of fits from their mean: what the choice of one among them adds to its covariance.
[[nodiscard]] Eigen::MatrixXd spread(std::span<const ChannelFit> fits);

/// A body of the network.
struct NetworkBody {
  double tau_s = 0.0;
  std::optional<std::size_t> law;  ///< none: only the ambient warms it
  double rise_K = 0.0;             ///< steady rise over the ambient where the law is 1
};
[[nodiscard]] std::vector<NetworkBody> bodies_of(const Structure& structure, bool has_ambient, double rise_K);

/// A fold as a mask over the rows of all records, one after the other.
struct HiddenRows {
  std::string kind;
  std::vector<bool> hidden;
};

/// The linear least squares problem of records and a structure.
class FosterProblem {
 public:
  /// @param rise_K  of heated bodies where their law is 1: larger than any thermometer's rise, because thermometers are
  ///                means
  /// @param blocks  of each record: this many rows are averaged into one, after all are computed
  /// @param simulated  simulation of the same rows by the scenario to be extended, if any: one record each, with all
  ///                   thermometers and displacements
  FosterProblem(std::span<const Record> records, const RecordRoles& roles, Structure structure, double rise_K,
                const std::vector<std::size_t>& blocks, std::span<const Record> simulated = {});

  [[nodiscard]] const std::vector<NetworkBody>& bodies() const { return bodies_; }
  [[nodiscard]] const Structure& structure() const { return structure_; }
  [[nodiscard]] const std::vector<std::string>& channels() const { return channels_; }  ///< thermometers, then displacements
  [[nodiscard]] std::size_t n_thermometers() const { return n_thermometers_; }
  [[nodiscard]] std::size_t n_rows() const { return static_cast<std::size_t>(columns_.rows()); }
  [[nodiscard]] double reference_degC() const {
    return reference_degC_;
  }  ///< the first ambient value of all records, else 20

  /// Normal equations of the rows that are not hidden; channels with the same valid rows share one matrix. The rows of all
  /// records follow each other.
  struct Normal {
    Eigen::MatrixXd g;
    Eigen::MatrixXd c;            ///< one column per channel
    std::vector<double> n;        ///< number of rows of each channel
    std::vector<std::size_t> of;  ///< for each channel, the index into `own`
    std::vector<Eigen::MatrixXd> own;
    Eigen::MatrixXd with_scenario;     ///< products of all columns and a channel's simulation, one column per channel
    Eigen::VectorXd scenario_squares;  ///< of each channel
  };
  [[nodiscard]] Normal normal(const std::vector<bool>& hidden) const;

  [[nodiscard]] ChannelFit fit(const Normal& normal, std::size_t channel, const Smoothness& smoothness) const;
  /// One fit for each of several penalties.
  [[nodiscard]] std::vector<ChannelFit> fits(const Normal& normal, std::size_t channel,
                                             std::span<const Smoothness> members) const;
  [[nodiscard]] bool extends_scenario() const { return n_scenario_ > 0; }
  /// The scenario's simulation of a channel, in the units of measured().
  [[nodiscard]] Eigen::VectorXd simulated(std::size_t channel) const {
    return simulated_.col(static_cast<Eigen::Index>(channel));
  }
  /// The network's values for all rows; thermometers minus the first ambient of their record. @param in_records with the
  /// terms of single records
  [[nodiscard]] Eigen::VectorXd predicted(std::size_t channel, const ChannelFit& fit, bool in_records) const;
  /// Temperature of a body minus the first ambient of its record.
  [[nodiscard]] Eigen::VectorXd body_K(std::size_t body) const { return body_columns_.col(static_cast<Eigen::Index>(body)); }
  /// The part of it that is caused by heat; 0 for a body without a law.
  [[nodiscard]] Eigen::VectorXd heated_K(std::size_t body) const;
  [[nodiscard]] const Eigen::VectorXd& ambient_K() const { return ambient_K_; }
  /// Readings of a channel, thermometers in degC minus the first ambient of their record; NaN where missing.
  [[nodiscard]] Eigen::VectorXd measured(std::size_t channel) const {
    return readings_.col(static_cast<Eigen::Index>(channel));
  }
  /// Residuals row by row, with the terms of single records; NaN without a reading. A displacement of a record without any
  /// fitted row counts from its first reading. @param in_records false: as the written scenario is simulated, without terms
  /// of single records; displacements and rises then count from their first readings
  [[nodiscard]] Eigen::VectorXd misses(std::size_t channel, const ChannelFit& fit, bool in_records = true) const;
  /// A subset of rows, prepared for root mean squares of misses().
  struct Part {
    std::vector<std::size_t> records;  ///< record of each row
    Eigen::MatrixXd bodies, of_records, readings, simulated;
    Eigen::VectorXd ambient_K;
  };
  [[nodiscard]] Part part(const std::vector<bool>& rows) const;
  /// Root mean square of the residuals; NaN without readings.
  [[nodiscard]] double rms(const Part& part, std::size_t channel, const ChannelFit& fit, bool in_records = true) const;

 private:
  [[nodiscard]] Eigen::Index first_of_records() const { return n_heated_ + n_ambient_ + n_direct_ + n_scenario_; }
  /// Zero point of a record's residuals: the first of them, or 0.
  [[nodiscard]] double zero_of(std::size_t record, std::size_t channel, const ChannelFit& fit, bool in_records) const;
  /// The unchanged scenario, with the terms of single records.
  [[nodiscard]] ChannelFit scenario_alone(const Normal& normal, std::size_t channel, Smoothness smoothness) const;
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
  std::vector<char> counts_from_start_;  ///< of each channel: true for a displacement or a rise in K
  std::vector<std::size_t> first_row_;   ///< of each record, followed by the number of all rows
  Eigen::MatrixXd body_columns_;         ///< T_b minus the reference
  Eigen::VectorXd ambient_K_;
  /// Heated parts, ambient parts, ambient, the scenario's simulation (0 here, because it differs by channel), a constant per
  /// record, start per record and pole.
  Eigen::MatrixXd columns_;
  Eigen::MatrixXd readings_, simulated_;
  Eigen::Index n_heated_ = 0, n_ambient_ = 0, n_direct_ = 0, n_scenario_ = 0, n_records_ = 0, n_starts_ = 0;
  std::vector<std::size_t> pole_of_heated_;
};

}  // namespace driftwright::identification
