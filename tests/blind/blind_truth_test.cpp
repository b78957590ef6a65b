// The truth of blind cases: its time integration against the program's, its small system against its large one, its bytes.

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "blind/case.hpp"
#include "machine/run_record.hpp"
#include "solver/transient.hpp"

namespace driftwright::blind::blind_truth_test {
namespace {

constexpr const char* kMachines = "tests/blind/machines";
constexpr double kCoarse = 2.0;  // where the mesh does not matter

/// Speeds that leave nothing settled, with a stop.
Cyclogram up_and_down(double top_rpm) {
  return {
      .name = "up_and_down",
      .sections = {{2400.0, {.speed_rpm = top_rpm}}, {1800.0, {.speed_rpm = 0.0}}, {1800.0, {.speed_rpm = 0.4 * top_rpm}}}};
}

struct Apart {
  double temperature_K = 0.0, displacement_m = 0.0;
};

Apart largest(const Subject& s, const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  const auto n = static_cast<Eigen::Index>(s.n_sensors());
  const Eigen::MatrixXd gap = (a - b).cwiseAbs();
  return {gap.topRows(n).maxCoeff(), gap.bottomRows(gap.rows() - n).maxCoeff()};
}

struct Meshed {
  const char* machine;
  double size;  ///< of its cells; both integrate the same matrices, whatever the mesh
};
class BlindIntegration : public testing::TestWithParam<Meshed> {};

TEST_P(BlindIntegration, AgreesWithTheProgramsOwnAtTightToleranceTo2mKAnd5nm) {
  // Same matrices, same laws, another method, other steps: what is left is the truth's own time error, far below the
  // quietest sensor (30 mK and 200 nm).
  const Subject s = make_subject(kMachines, GetParam().machine, GetParam().size);
  const Cyclogram drive = up_and_down(s.top_speed_rpm);
  const TimeSeries ambient{{0.0, drive.duration_s()}, {0.3, 1.5}};
  const Values nominal = nominal_values(s);
  const double step_s = truth_step_s(s);
  const Eigen::MatrixXd own = integrate(full_network(s, nominal), laws_of(balance_of(s, nominal)),
                                        {drive, [&](double t_s) { return ambient.at(t_s); }, drive.duration_s(), step_s});

  const scenarios::Machine machine = scenarios::build(s.model, s.placed, !s.is_lumped());
  const auto every = static_cast<Eigen::Index>(60.0 / step_s);
  const std::vector<double> times_s = scenarios::output_times_s(drive, 60.0);
  const solver::Trajectory theirs =
      solver::simulate(machine.system, drive, ambient, times_s,
                       {.relative_tolerance = 1e-7, .absolute_tolerance_K = 1e-6, .max_step_s = 60.0},
                       Eigen::VectorXd::Zero(machine.system.size()));
  Eigen::MatrixXd at_rows(own.rows(), static_cast<Eigen::Index>(times_s.size()));
  for (Eigen::Index k = 0; k < at_rows.cols(); ++k) at_rows.col(k) = own.col(k * every);
  const Apart apart = largest(s, at_rows, theirs.outputs);
  EXPECT_LT(apart.temperature_K, 2e-3);
  EXPECT_LT(apart.displacement_m, 5e-9);
  EXPECT_GT(theirs.outputs.topRows(static_cast<Eigen::Index>(s.n_sensors())).maxCoeff(), 3.0);  // it did warm up
  RecordProperty("mK", std::to_string(1e3 * apart.temperature_K));
  RecordProperty("nm", std::to_string(1e9 * apart.displacement_m));
}

std::string machine_of(const testing::TestParamInfo<Meshed>& one) {
  return one.param.machine;
}
INSTANTIATE_TEST_SUITE_P(Machines, BlindIntegration,
                         testing::Values(Meshed{"gearbox_spindle", kCoarse}, Meshed{"motor_spindle", kCoarse},
                                         Meshed{"c_frame", kCoarse}),
                         machine_of);
INSTANTIATE_TEST_SUITE_P(MachinesAtLength, BlindIntegration, testing::Values(Meshed{"knee_mill", 1.3}), machine_of);

TEST(BlindSmallSystem, SaysHowLoudAnEffectIsToATenth) {
  // It only sizes effects: what heat, gradient and another conductivity change, against the large system.
  const Subject s = make_subject(kMachines, "iron_frame", kCoarse);
  const Cyclogram drive = up_and_down(s.top_speed_rpm);
  const blind::Run run{drive, [](double t_s) { return 1e-4 * t_s; }, drive.duration_s(), 20.0};
  const Values nominal = nominal_values(s);
  const Laws laws = laws_of(balance_of(s, nominal));
  const Eigen::MatrixXd large = integrate(full_network(s, nominal), laws, run);
  const Eigen::MatrixXd small = integrate(small_network(s, nominal), laws, run);
  EXPECT_LT(largest(s, large, small).temperature_K, 20e-3);
  for (const Hidden& h : {Hidden{.what = Hide::kHeatConstant, .where = "column", .size = 80.0},
                          Hidden{.what = Hide::kStratification, .where = "ambient", .size = 2.0},
                          Hidden{.what = Hide::kConductivity, .where = "head", .size = 0.5},
                          Hidden{.what = Hide::kExpansion, .where = "base", .size = 0.5}}) {
    Values values = nominal;
    hide_in_values(h, s, values);
    effects::HeatBalance balance = balance_of(s, values);
    hide_in_heat(h, s, drive, balance);
    const Eigen::MatrixXd by_large = integrate(full_network(s, values), laws_of(balance), run) - large;
    const Eigen::MatrixXd by_small = integrate(small_network(s, values), laws_of(balance), run) - small;
    const auto n = static_cast<Eigen::Index>(s.n_sensors());
    EXPECT_LE((by_large - by_small).topRows(n).norm(), 0.1 * by_large.topRows(n).norm()) << law_name(h.what);
    const Eigen::Index m = by_large.rows() - n;
    EXPECT_LE((by_large - by_small).bottomRows(m).norm(), 0.1 * by_large.bottomRows(m).norm()) << law_name(h.what);
  }
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Nodes, and a mesh of a drawing, whose scenario is read and whose record fits it.
TEST(BlindCases, TheSameSeedMakesTheSameBytesAndRecordsFitTheirScenario) {
  const std::filesystem::path root = std::filesystem::temp_directory_path() / "driftwright_blind_bytes";
  std::filesystem::remove_all(root);
  for (const std::uint64_t seed : {0, 3}) {
    for (const char* which : {"a", "b"}) EXPECT_TRUE(CaseMaker(kMachines, kCoarse).make(seed, root / which));
  }
  int n_files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root / "a")) {
    if (!entry.is_regular_file()) continue;
    const auto twin = root / "b" / std::filesystem::relative(entry.path(), root / "a");
    EXPECT_EQ(bytes_of(entry.path()), bytes_of(twin)) << entry.path();
    ++n_files;
  }
  EXPECT_EQ(n_files, 2 * 5 + 1);
  EXPECT_FALSE(CaseMaker(kMachines).make(0, root / "a"));  // it is there
  const scenarios::Scenario scenario = scenarios::read_scenario((root / "a/case_0003/scenario.yaml").string());
  const scenarios::MachineModel& model = scenario.machine.value();
  (void)scenarios::place(model);  // the drawing is where the scenario says
  const Record record = read_record_csv((root / "a/case_0003/measured_1.csv").string());
  EXPECT_NE(record.find("speed"), nullptr);
  EXPECT_NE(record.find("ambient"), nullptr);
  for (const auto& sensor : model.sensors) EXPECT_EQ(record.at(sensor.name).unit, "degC");
  for (const auto& d : model.displacements) EXPECT_EQ(record.at(d.name).unit, "um");
  std::filesystem::remove_all(root);
}

}  // namespace
}  // namespace driftwright::blind::blind_truth_test
