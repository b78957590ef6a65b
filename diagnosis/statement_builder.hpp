#pragma once
// Builds the columns of a statement space: the effect of each quantity at each place with each course. Internal to this
// room.

#include "diagnosis/scene.hpp"
#include "diagnosis/statement.hpp"

namespace driftwright::diagnosis {

/// A course in time, for any quantity that has one.
struct TimedCourse {
  std::string follows, law;
  std::vector<Eigen::RowVectorXd> at_row, in_interval;  ///< by run
  bool rests = false;                                   ///< zero while the machine has not been started
};

inline constexpr double kUsualLogarithm = 0.7;  ///< typical logarithm of a wrong factor

class StatementBuilder {
 public:
  StatementBuilder(StatementSpace& space, const Fitter& fitter, const TwinState& state);
  /// All columns and cells of the space.
  void build();

 private:
  using Body = effects::Body;
  using Row = Eigen::RowVectorXd;
  struct Channel {
    std::string name, unit;
    double swing = 1.0;
    int output = -1;
  };
  using Loads = std::vector<LinearOperator::Load>;
  double swing(const std::string& name) const;
  /// The course of a function of the drive.
  TimedCourse of_drive(std::string follows, std::string law, const std::function<double(const Drive&)>& u) const;
  void make_courses();  ///< statement_courses.cpp
  static double value_at(const TimeSeries& series, double t_s);
  void add(Statement says, std::vector<Acting> acts);
  Acting respond(const std::shared_ptr<const Loads>& loads, const TimedCourse& course) const;
  /// Acts on a channel directly. @param course  over the rows, by run
  static Acting alone(const std::string& channel, const std::vector<Row>& course);
  std::vector<Eigen::Index> edges(std::size_t r) const;
  void add_cells(Statement says, std::vector<Acting> acts, bool lasts = false);
  void add_heat_cells(const Statement& says, const std::shared_ptr<const Loads>& loads);

  // of the machine (statement_machine.cpp)
  void heats();
  /// All own heat, and all exchange with the ambient, as states of running.
  void all_alike();
  /// Another size, exponent or growth with temperature of a body's heat.
  void own_laws(const Body& body, const Statement& says, const std::shared_ptr<const Loads>& loads);
  void exchanges();
  /// Exchange of two bodies through an unknown third one, to first order: a body between them with its own way to the
  /// ambient (1 W/K each way; a third of it is seen between any two of the three); or the air within a guard, which their
  /// loss warms over the ambient by a resistance [K/W].
  void by_a_third(const Statement& of_both, const Body& a, const Body& b, double loss_a_W_K, double loss_b_W_K);
  void conductivities();
  void capacities();
  void numbers_at_positions();  ///< statement_numbers.cpp

  // of its instruments (statement_instruments.cpp)
  Row predicted(std::size_t r, const std::string& name) const;
  template <class Of>
  std::vector<Row> by_run(Of of) const {
    std::vector<Row> rows;
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      Row row = of(r);
      rows.push_back(row.size() > 0 ? row : Row(Row::Zero(machine_[r].n_rows())));
    }
    return rows;
  }
  /// What a channel shows too much of whatever happens: each channel by itself.
  void readings();
  /// A statement about one channel, without course and law.
  static Statement about(const Channel& c);
  /// Adds the column of one channel. @param course  over the rows, by run
  void say(const Channel& c, const std::string& follows, const std::string& law, double size, const std::string& unit,
           const std::vector<Row>& course);
  void follows_courses(const Channel& c);
  void follows_itself(const Channel& c);        ///< lags and a gain
  void follows_differences(const Channel& c);   ///< of a thermometer to the ambient and to each body
  void follows_temperatures(const Channel& c);  ///< of a displacement: of each body and of the ambient
  void exchanged_channels();                    ///< any two of one unit
  void expansions();                            ///< of each part, seen in all displacements
  /// Thermometers that are wrong together by the same number: the effect of one of them alone, applied to all at once.
  void instruments_in_common();

  // of the surroundings (statement_surroundings.cpp)
  void surroundings();
  static Statement of_ambient();  ///< without course and law
  void ambients();
  void late_ambients();   ///< where it is recorded
  void stratification();  ///< of a meshed machine
  void speeds();
  void clocks();
  /// The effect of an effect on all channels, by the twin itself. @param size  its size, to scale the columns to one unit
  std::vector<Acting> exactly(const effects::Effect& effect, double size) const;
  /// The same for another state.
  std::vector<Acting> exactly(const TwinState& other, double size) const;

  StatementSpace& space_;
  std::vector<LinearOperator>& machine_;
  const Fitter& fitter_;
  const std::vector<MeasuredRun>& runs_;
  effects::DoubtScene scene_;
  TwinState state_;
  std::vector<Channel> channels_;
  std::vector<TimedCourse> courses_;
  std::size_t n_drives_ = 0;  ///< number of courses of the drive, including the constant
  bool settled_ = false;
};

}  // namespace driftwright::diagnosis
