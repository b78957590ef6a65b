// Reduced machines on disk: what is found is what was kept, and nothing else is ever found. One file: each case changes one
// thing of the same machine.

#include "machine/machine_store.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <functional>

#include "base/npy_file.hpp"
#include "machine/machine_key.hpp"
#include "machine/reduced_files.hpp"
#include "machine/run_record.hpp"
#include "solver/bind_laws.hpp"
#include "solver/reduced_transient.hpp"
#include "tests/shared/column_and_head.hpp"
#include "tests/shared/numpy.hpp"

namespace driftwright::scenarios::machine_store_test {
namespace {

namespace fs = std::filesystem;
using fixtures::ColumnAndHead;
using ::testing::AllOf, ::testing::HasSubstr;

constexpr const char* kUpwards = "{type: natural_convection, surface: front, orientation: vertical, length: 100 mm}";
constexpr const char* kOil =
    "{type: coolant, region: head, tank: cooler, flow: 4 L/min, passage_conductance: 60 W/K, volume: 2 L, tank_exchange: 3 "
    "W/K, "
    "pump_power: 40 W, cooling_power: 200 W, set_point: 21 degC, hysteresis: 0.5 K, runs: always}";

Scenario read(const ColumnAndHead& what, const std::string& folder = "machine_store") {
  static std::map<std::string, fs::path> folders;
  if (!folders.count(folder)) folders[folder] = fresh_folder(folder);
  return read_scenario(fixtures::write_column_and_head(folders[folder], what));
}
ReductionPlan plan_of(const Scenario& scenario) {
  return reduction_plan(scenario, {&scenario.cyclograms.front()});
}
std::string key_of(const Scenario& scenario, int n_modes = 20, const std::string& version = "1") {
  ReductionPlan plan = plan_of(scenario);
  plan.n_modes = n_modes;
  return machine_key(*scenario.machine, plan, version);
}
ReducedMachine reduced(const Scenario& s) {
  return reduce(*s.machine, build(*s.machine, place(*s.machine)), plan_of(s));
}
solver::Trajectory run(const Scenario& s, const ReducedMachine& machine) {
  const Cyclogram& cycle = s.cyclograms.front();
  return solver::simulate(machine.system, cycle, s.machine->ambient, output_times_s(cycle, 300.0), {}, machine.start);
}
effects::HeatBalance balance_of(const Scenario& s) {
  return effects::heat_balance(s.machine->effects);
}
ColumnAndHead with_effects(std::vector<std::string> more) {
  ColumnAndHead machine;
  machine.effects.insert(machine.effects.end(), more.begin(), more.end());
  return machine;
}

using Change = std::function<void(ColumnAndHead&)>;
struct KeyCase {
  const char* name;
  Change from, to;
};
const Change kAsItIs = [](ColumnAndHead&) {};
Change effect(std::string text) {
  return [text](ColumnAndHead& m) { m.effects.push_back(text); };
}

class OtherKeys : public ::testing::TestWithParam<KeyCase> {};
class SameKeys : public ::testing::TestWithParam<KeyCase> {};

std::string key_after(const Change& change) {
  ColumnAndHead machine;
  change(machine);
  return key_of(read(machine));
}
TEST_P(OtherKeys, BelongToOtherMachines) {
  EXPECT_NE(key_after(GetParam().from), key_after(GetParam().to));
}
TEST_P(SameKeys, BelongToMachinesThatDifferInLawsWithinTheDemand) {
  EXPECT_EQ(key_after(GetParam().from), key_after(GetParam().to));
}

const char* const kSteel = "{column: cast_iron_gjl250, head: steel_c45}";
Change curves_in_an_ambient_of(const char* ambient) {
  return [ambient](ColumnAndHead& m) {
    m.materials =
        "{column: cast_iron_gjl250, head: {density: 7200 kg/m^3, conductivity: [[20 degC, 50 W/(m K)], [70 degC, 40 W/(m "
        "K)]], "
        "heat_capacity: 500 J/(kg K), youngs_modulus: 110 GPa, poisson_ratio: 0.26, expansion: 11e-6 1/K, source: made up}}";
    m.ambient = ambient;
  };
}
Change ambient_with(const char* ambient, std::vector<std::string> effects, const char* start = "reference") {
  return [=](ColumnAndHead& m) {
    m.ambient = ambient;
    m.start = start;
    m.effects.insert(m.effects.end(), effects.begin(), effects.end());
  };
}
Change node(const char* capacity) {
  return [capacity](ColumnAndHead& m) {
    m.effects.push_back(fmt::format("{{type: node, node: pump, capacity: {}}}", capacity));
    m.effects.push_back("{type: link, node: pump, to: ambient, conductance: 1 W/K}");
  };
}
Change film_from_the_start(const char* film) {
  return effect(fmt::format("{{type: convection, surface: front, film: {}, from: 0 s, until: 10 min}}", film));
}
/// A film whose file has lengths without a unit and two airs of the same mean.
Change film_of_a_file(const char* units, const char* air_column) {
  return [=](ColumnAndHead& m) {
    const std::string file =
        write_file("film_of_a_key.raw", "# x y z h air_a air_b\n0.02 0.2 0.32 10 290 300\n0.08 0.2 0.38 10 300 290\n");
    m.effects.push_back(fmt::format(
        "{{type: film_field, surface: front, file: {}, units: {}, film_column: h, air_column: {}, reach: 200 mm, "
        "elsewhere: 5 W/(m^2 K)}}",
        file, units, air_column));
  };
}

INSTANTIATE_TEST_SUITE_P(
    Of, OtherKeys,
    ::testing::Values(
        KeyCase{"Material", kAsItIs, [](ColumnAndHead& m) { m.materials = kSteel; }},
        KeyCase{"Sensor", kAsItIs, [](ColumnAndHead& m) { m.sensor_y = "149 mm"; }},
        KeyCase{"Start", kAsItIs, [](ColumnAndHead& m) { m.start = "ambient"; }},
        KeyCase{"StartTemperature", [](ColumnAndHead& m) { m.start = "21 degC"; },
                [](ColumnAndHead& m) { m.start = "22 degC"; }},
        KeyCase{"AmbientToStartFrom", ambient_with("[[0 h, 20.2 degC]]", {}, "ambient"),
                ambient_with("[[0 h, 20.4 degC]]", {}, "ambient")},
        KeyCase{"LawsOfASteadyStart", [](ColumnAndHead& m) { m.start = "steady"; },
                [](ColumnAndHead& m) {
                  m.start = "steady";
                  m.effects[0] = "{type: heat_source, region: head, power: 61 W, at_speed: 1000 rpm, exponent: 1}";
                }},
        KeyCase{"FactorOnAMaterial", effect("{type: conductivity, region: head, factor: 1.2}"),
                effect("{type: conductivity, region: head, factor: 1.21}")},
        KeyCase{"FactorOnAnotherProperty", effect("{type: conductivity, region: head, factor: 1.2}"),
                effect("{type: expansion, region: head, factor: 1.2}")},
        KeyCase{"FeltAmbientToStartFrom", ambient_with("[[0 h, 20.2 degC]]", {"{type: ambient, offset: 0.1 K}"}, "ambient"),
                ambient_with("[[0 h, 20.2 degC]]", {"{type: ambient, offset: 0.2 K}"}, "ambient")},
        KeyCase{"FourTimesTheSpeed", kAsItIs, effect("{type: speed_override, factor: 4}")},
        KeyCase{"NodeCapacity", node("900 J/K"), node("901 J/K")},
        KeyCase{"Tolerance", kAsItIs,
                [](ColumnAndHead& m) { m.solver = "{fields_format: none, model: reduced, reduction_tolerance: 4e-3 K}"; }},
        KeyCase{"Fields", kAsItIs, [](ColumnAndHead& m) { m.solver = "{model: reduced}"; }},
        KeyCase{"ConstantFilm", kAsItIs,
                [](ColumnAndHead& m) { m.effects[1] = "{type: convection, surface: outside, film: 11 W/(m^2 K)}"; }},
        KeyCase{"PlaceOfAnEffect", kAsItIs,
                [](ColumnAndHead& m) {
                  m.effects[0] = "{type: heat_source, region: column, power: 60 W, at_speed: 1000 rpm, exponent: 1}";
                }},
        KeyCase{"FourTimesThePower", kAsItIs,
                [](ColumnAndHead& m) {
                  m.effects[0] = "{type: heat_source, region: head, power: 240 W, at_speed: 1000 rpm, exponent: 1}";
                }},
        KeyCase{"HeldTemperature", effect("{type: fixed_temperature, surface: front, temperature: 24 degC}"),
                effect("{type: fixed_temperature, surface: front, temperature: 25 degC}")},
        KeyCase{"UnitsOfAFilmOfAFile", film_of_a_file("m", "air_a"), film_of_a_file("mm", "air_a")},
        KeyCase{"AirOfAFilmOfAFile", film_of_a_file("m", "air_a"), film_of_a_file("m", "air_b")},
        KeyCase{"Gradient", effect("{type: stratification, gradient: 1 K/m, level: 0 m}"),
                effect("{type: stratification, gradient: 1.1 K/m, level: 0 m}")},
        // What modal predictors are made at: the films at standstill, the ambient that laws are frozen in.
        KeyCase{"FilmAtStandstill", film_from_the_start("10 W/(m^2 K)"), film_from_the_start("11 W/(m^2 K)")},
        KeyCase{"AmbientOfFrozenLaws", ambient_with("[[0 h, 20.2 degC]]", {kUpwards}),
                ambient_with("[[0 h, 20.4 degC]]", {kUpwards})},
        KeyCase{"AmbientOfFrozenMaterials", curves_in_an_ambient_of("[[0 h, 20.2 degC]]"),
                curves_in_an_ambient_of("[[0 h, 20.4 degC]]")}),
    [](const auto& one) { return std::string(one.param.name); });

Change cyclogram(const char* text) {
  return [text](ColumnAndHead& m) { m.cyclograms = text; };
}
Change fan(const char* growth) {
  return effect(fmt::format(
      "{{type: forced_convection, surface: outside, growth: {} W/(m^2 K), at_speed: 1000 rpm, exponent: 0.7}}", growth));
}

INSTANTIATE_TEST_SUITE_P(
    Of, SameKeys,
    ::testing::Values(KeyCase{"AFanOfTheSameOctave", fan("12"), fan("13")},
                      KeyCase{"ErrorsOfInstruments", kAsItIs, effect("{type: sensor_bias, sensor: t_head, bias: 1 K}")},
                      KeyCase{"ErrorsOfInstrumentsOfASteadyStart", ambient_with("[[0 h, 20.2 degC]]", {}, "steady"),
                              ambient_with("[[0 h, 20.2 degC]]", {"{type: clock_offset, offset: 1 min}"}, "steady")},
                      KeyCase{"SpeedOfTheSameOctave", kAsItIs, effect("{type: speed_override, factor: 0.9}")},
                      KeyCase{"PowerOfTheSameOctave", kAsItIs,
                              [](ColumnAndHead& m) {
                                m.effects[0] =
                                    "{type: heat_source, region: head, power: 50 W, at_speed: 1000 rpm, exponent: 1}";
                              }},
                      KeyCase{"ACyclogramThatAsksNearlyTheSame", cyclogram("{cycle: [[80 min, 1000 rpm], [10 min, 0 rpm]]}"),
                              cyclogram("{other: [[70 min, 950 rpm], [15 min, 0 rpm]]}")},
                      KeyCase{"AnAmbientThatEndsElsewhere", kAsItIs,
                              [](ColumnAndHead& m) { m.ambient = "[[0 min, 20 degC], [60 min, 21.7 degC]]"; }}),
    [](const auto& one) { return std::string(one.param.name); });

TEST(MachineKey, CountsTheProgramTheModesAndTheBytesOfTheMesh) {
  const Scenario s = read({});
  EXPECT_NE(key_of(s), key_of(s, 20, "2"));
  EXPECT_NE(key_of(s), key_of(s, 19));
  const Scenario same = read({}, "machine_store_elsewhere");  // as the same file in another folder
  EXPECT_EQ(key_of(s), key_of(same));
  const fs::path mesh = fs::path(same.path).parent_path() / "machine.inp";
  std::string text = read_text(mesh);
  ASSERT_NE(text.find(", 100, "), std::string::npos);
  std::ofstream(mesh) << text.replace(text.find(", 100, "), 7, ", 101, ");
  EXPECT_NE(key_of(s), key_of(same));
  fs::remove(mesh);
  EXPECT_THROW((void)key_of(same), InputError);
}

TEST(MachineKey, CountsDimensions) {
  const auto with = [](const std::string& wall) {
    std::string text = read_text("scenarios/fp3_spindle.yaml");
    text.replace(text.find("wall: 30 mm"), 11, "wall: " + wall);
    return machine_text(*read_scenario(write_file("fp3.yaml", text)).machine);
  };
  EXPECT_EQ(with("30 mm"), machine_text(*read_scenario("scenarios/fp3_spindle.yaml").machine));
  EXPECT_NE(with("30 mm"), with("30.1 mm"));
}

TEST(MachineKey, LeavesTheFilmAtStandstillOutWithoutModalPredictors) {
  // Sweeps make none: their members share one reduced machine.
  const auto with = [](const char* film) {
    ColumnAndHead machine;
    film_from_the_start(film)(machine);
    return key_of(read(machine), 0);
  };
  EXPECT_EQ(with("10 W/(m^2 K)"), with("11 W/(m^2 K)"));
}

void expect_same(const solver::Trajectory& a, const solver::Trajectory& b) {
  EXPECT_EQ(a.outputs, b.outputs);
  EXPECT_EQ(a.heat_J, b.heat_J);
  EXPECT_EQ(a.stored_J, b.stored_J);
  ASSERT_EQ(a.flows.size(), b.flows.size());
  for (std::size_t j = 0; j < a.flows.size(); ++j) {
    EXPECT_EQ(a.flows[j].name, b.flows[j].name);
    EXPECT_EQ(a.flows[j].kind, b.flows[j].kind);
  }
}

class RoundTrips : public ::testing::TestWithParam<std::pair<const char*, ColumnAndHead>> {};

TEST_P(RoundTrips, GiveTheSameBits) {
  ColumnAndHead what = GetParam().second;
  what.solver = "{output_interval: 5 min, model: reduced}";  // with fields
  const Scenario s = read(what);
  const ReducedMachine kept = reduced(s);
  const fs::path store = fresh_folder(std::string("store_") + GetParam().first);
  const std::string key = key_of(s);
  EXPECT_FALSE(load_machine(store, key, balance_of(s)));
  save_machine(store, key, kept);
  const auto found = load_machine(store, key, balance_of(s));
  ASSERT_TRUE(found);
  expect_same(run(s, kept), run(s, *found));
  EXPECT_EQ(found->n_unknowns, kept.n_unknowns);
  EXPECT_EQ(found->start, kept.start);
  EXPECT_EQ(found->error.temperature_K, kept.error.temperature_K);
  EXPECT_EQ(found->error.displacement_m, kept.error.displacement_m);
  EXPECT_EQ(found->system.outputs.name, kept.system.outputs.name);
  EXPECT_EQ(found->system.outputs.unit, kept.system.outputs.unit);
  EXPECT_EQ(found->system.reference_K, kept.system.reference_K);
  EXPECT_GT(kept.displacement_m.size(), 0);
  EXPECT_EQ(found->temperature, kept.temperature);
  EXPECT_EQ(found->displacement_m, kept.displacement_m);
  EXPECT_EQ(found->mesh.coords, kept.mesh.coords);
  for (auto which : {&mesh::Mesh::cells, &mesh::Mesh::facets}) {
    const mesh::Cells &read = found->mesh.*which, &written = kept.mesh.*which;
    EXPECT_GT(written.size(), 0);
    EXPECT_EQ(read.shape, written.shape);
    EXPECT_EQ(read.offset, written.offset);
    EXPECT_EQ(read.node, written.node);
    EXPECT_EQ(read.group, written.group);
  }
  EXPECT_EQ(found->mesh.regions, kept.mesh.regions);
  EXPECT_EQ(found->mesh.surfaces, kept.mesh.surfaces);
  ASSERT_EQ(found->mesh.joints.size(), kept.mesh.joints.size());
  ASSERT_FALSE(kept.mesh.joints.empty());
  for (std::size_t j = 0; j < kept.mesh.joints.size(); ++j) {
    EXPECT_EQ(found->mesh.joints[j].name, kept.mesh.joints[j].name);
    EXPECT_EQ(found->mesh.joints[j].side_a, kept.mesh.joints[j].side_a);
    EXPECT_EQ(found->mesh.joints[j].side_b, kept.mesh.joints[j].side_b);
  }
  ASSERT_EQ(found->modal.has_value(), kept.modal.has_value());
  if (!kept.modal) return;
  for (auto which : {&compensation::ModalPredictors::bare, &compensation::ModalPredictors::completed}) {
    const compensation::ModalPredictor &read = (*found->modal).*which, &written = (*kept.modal).*which;
    EXPECT_EQ(read.time_constant_s, written.time_constant_s);
    expect_same(read.predict(s.cyclograms.front(), s.machine->ambient, {600, 3600}),
                written.predict(s.cyclograms.front(), s.machine->ambient, {600, 3600}));
  }
  EXPECT_FALSE(load_machine(store, key + " ", balance_of(s)));
}

INSTANTIATE_TEST_SUITE_P(
    Of, RoundTrips,
    ::testing::Values(
        std::pair{"Constants", ColumnAndHead{}},
        std::pair{"LawsOfTemperature", with_effects({kUpwards, "{type: stratification, gradient: 1 K/m, level: 0 m}"})},
        std::pair{"AThermostat", with_effects({kOil})},
        std::pair{"AHeldFaceAndADraught",
                  with_effects({"{type: fixed_temperature, surface: front, temperature: 24 degC}",
                                "{type: convection, surface: outside, film: 5 W/(m^2 K), from: 10 min, until: 30 "
                                "min}"})}),
    [](const auto& one) { return std::string(one.param.first); });

TEST(MachineStore, GivesAMachineTheLawsOfWhoAsks) {
  ColumnAndHead twelve, thirteen;
  fan("12")(twelve);
  fan("13")(thirteen);
  const Scenario s = read(twelve), other = read(thirteen);
  const fs::path store = fresh_folder("store_laws");
  ASSERT_EQ(key_of(s), key_of(other));
  const ReducedMachine kept = reduced(s);
  save_machine(store, key_of(s), kept);
  const auto found = load_machine(store, key_of(other), balance_of(other));
  ASSERT_TRUE(found);
  ReducedMachine bound = kept;
  solver::bind_laws(bound.system, effects::with_radiation_as_films(balance_of(other)));
  expect_same(run(other, *found), run(other, bound));
  EXPECT_NE(run(other, *found).outputs, run(s, kept).outputs);
}

/// The only folder of a store.
fs::path only_folder(const fs::path& store) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(store)) found.push_back(entry.path());
  EXPECT_EQ(found.size(), 1u);
  return found.front();
}

TEST(MachineStore, TakesADamagedFolderForNone) {
  const Scenario s = read(with_effects({kUpwards}));
  const ReducedMachine kept = reduced(s);
  const fs::path store = fresh_folder("store_damaged");
  const std::string key = key_of(s);
  const solver::Trajectory right = run(s, kept);
  save_machine(store, key, kept);
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(only_folder(store))) names.push_back(entry.path().filename().string());
  EXPECT_GT(names.size(), 20u);
  for (const std::string& name : names) {
    const fs::path file = only_folder(store) / name;
    const std::string whole = read_text(file);
    const std::function<void()> harms[] = {[&] { fs::remove(file); },
                                           [&] { fs::resize_file(file, 0); },
                                           [&] { fs::resize_file(file, whole.size() / 2); },
                                           [&] { fs::resize_file(file, whole.size() - 1); },
                                           [&] {  // of the same size, and of values that might be right
                                             std::string other = whole;
                                             other.back() = static_cast<char>(other.back() ^ 1);
                                             std::ofstream(file, std::ios::binary) << other;
                                           },
                                           [&] {
                                             std::string zeros = whole;
                                             std::fill(zeros.begin() + static_cast<std::ptrdiff_t>(zeros.size() / 2),
                                                       zeros.end(), '\0');
                                             if (zeros == whole) zeros.back() = 1;  // it held nothing but zeros
                                             std::ofstream(file, std::ios::binary) << zeros;
                                           },
                                           [&] {
                                             fs::remove(file);
                                             fs::create_directory(file);
                                           }};
    for (const auto& harm : harms) {
      harm();
      std::string damage;
      EXPECT_FALSE(load_machine(store, key, balance_of(s), &damage)) << name;
      EXPECT_THAT(damage, HasSubstr(name == "hashes.json" || damage.find("hashes.json") != std::string::npos ? "hashes.json"
                                                                                                             : name));
      save_machine(store, key, kept);  // made anew
      const auto found = load_machine(store, key, balance_of(s));
      ASSERT_TRUE(found) << name;
      EXPECT_EQ(run(s, *found).outputs, right.outputs);
    }
  }
}

TEST(MachineStore, TakesAListOfFilesThatNestsWithoutEndForDamage) {
  const Scenario s = read(with_effects({kUpwards}));
  const fs::path store = fresh_folder("store_nested");
  save_machine(store, key_of(s), reduced(s));
  std::ofstream(only_folder(store) / "hashes.json")
      << "{\"model.json\":" << std::string(300000, '[') << std::string(300000, ']') << "}";
  std::string damage;
  EXPECT_FALSE(load_machine(store, key_of(s), balance_of(s), &damage));
  EXPECT_THAT(damage, AllOf(HasSubstr("hashes.json"), HasSubstr("more than 100 deep")));
}

TEST(MachineStore, TakesArraysOfAnotherMachineForDamage) {
  // Files that are whole, but of other sizes than model.json says.
  const Scenario s = read({});
  const fs::path store = fresh_folder("store_mixed");
  save_machine(store, key_of(s), reduced(s));
  for (const char* name : {"conduction.npy", "exchanges.npy", "offset.npy", "modal_bare_start.npy", "loads.npy", "start.npy",
                           "outputs.npy", "ones.npy", "to_hall.npy", "flow.npy", "outputs_hall.npy", "mesh_coords.npy",
                           "modal_completed_conduction.npy", "temperature.npy", "displacement_m.npy"}) {
    const fs::path file = only_folder(store) / name;
    const std::string whole = read_text(file);
    if (std::string(name) == "temperature.npy" || std::string(name) == "displacement_m.npy") {
      write_npy(file, Eigen::MatrixXf(Eigen::MatrixXf::Zero(3, 2)));
    } else {
      write_npy(file, Eigen::MatrixXd(Eigen::MatrixXd::Zero(3, 2)));
    }
    EXPECT_FALSE(load_machine(store, key_of(s), balance_of(s))) << name;
    std::ofstream(file, std::ios::binary) << whole;
  }
  EXPECT_TRUE(load_machine(store, key_of(s), balance_of(s)));
}

TEST(MachineStore, ServesProcessesThatSaveAtOnce) {
  const Scenario s = read({});
  const ReducedMachine kept = reduced(s);
  const solver::Trajectory right = run(s, kept);
  const fs::path store = fresh_folder("store_at_once");
  const std::string key = key_of(s);
  std::vector<pid_t> children;
  for (int i = 0; i < 3; ++i) {
    children.push_back(fork());
    if (children.back() == 0) {
      try {
        for (int k = 0; k < 30; ++k) save_machine(store, key, kept);
      } catch (...) {
        _exit(1);
      }
      _exit(0);
    }
  }
  int n_found = 0;
  while (!children.empty()) {
    int status = 0;
    if (waitpid(children.back(), &status, WNOHANG) != 0) {
      EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
      children.pop_back();
    }
    const auto found = load_machine(store, key, balance_of(s));
    if (!found) continue;
    ++n_found;
    ASSERT_EQ(run(s, *found).outputs, right.outputs);
  }
  RecordProperty("n_found", n_found);
  EXPECT_GT(n_found, 3);
  EXPECT_TRUE(load_machine(store, key, balance_of(s)));
  (void)only_folder(store);  // nothing half-written is left
}

TEST(MachineStore, SaysWhereItCannotWriteAndLeavesNothingThere) {
  const Scenario s = read({});
  const ReducedMachine kept = reduced(s);
  const fs::path below_a_file = write_file("no_folder", "");
  EXPECT_THROW(save_machine(below_a_file, key_of(s), kept), InputError);
  EXPECT_FALSE(load_machine(below_a_file, key_of(s), balance_of(s)));
  // A disk that takes some files and then no more.
  const fs::path store = fresh_folder("store_full");
  save_machine(store, key_of(s), kept);
  const fs::path work = only_folder(store).string() + fmt::format(".partial-{}", getpid());
  fs::create_directories(work / "temperature.npy");
  EXPECT_THROW(save_machine(store, key_of(s), kept), InputError);
  EXPECT_FALSE(fs::exists(work));
  EXPECT_TRUE(load_machine(store, key_of(s), balance_of(s))) << "what was there is still there";
}

TEST(MachineStore, StandsWhereTheEnvironmentSays) {
  const auto at = [](const char* cache, const char* home) {
    cache ? setenv("XDG_CACHE_HOME", cache, 1) : unsetenv("XDG_CACHE_HOME");
    home ? setenv("HOME", home, 1) : unsetenv("HOME");
    return machine_store().string();
  };
  const std::string home_before = std::getenv("HOME") ? std::getenv("HOME") : "";
  EXPECT_EQ(at("/var/cache", "/home/me"), "/var/cache/driftwright");
  EXPECT_EQ(at(nullptr, "/home/me"), "/home/me/.cache/driftwright");
  EXPECT_EQ(at("", "/home/me"), "/home/me/.cache/driftwright");
  EXPECT_EQ(at("relative", "/home/me"), "/home/me/.cache/driftwright");  // as the XDG specification requires
  EXPECT_EQ(at(nullptr, nullptr), "");
  EXPECT_EQ(at(nullptr, ""), "");
  setenv("HOME", home_before.c_str(), 1);
  const Scenario s = read({});
  EXPECT_NO_THROW(save_machine("", key_of(s), reduced(s)));  // nothing is kept
  EXPECT_FALSE(load_machine("", key_of(s), balance_of(s)));
}

TEST(ExportReduced, IsWhatNumPyIntegratesToTheSameRecord) {
  if (!has_numpy()) GTEST_SKIP() << "no python3 with numpy";
  ColumnAndHead what = with_effects({"{type: stratification, gradient: 2 K/m, level: 0 m}"});
  fan("12")(what);
  what.start = "21 degC";
  const Scenario s = read(what);
  const ReducedMachine machine = reduced(s);
  const Cyclogram& cycle = s.cyclograms.front();
  const fs::path folder = fresh_folder("exported");
  std::vector<Drive> drives;
  for (const auto& section : cycle.sections) drives.push_back(section.drive);
  export_reduced(machine.system, machine.start, machine.error, drives,
                 [&](const std::string& name) { return folder / name; });
  std::vector<double> ends_s = {0.0};
  for (const auto& section : cycle.sections) ends_s.push_back(ends_s.back() + section.duration_s);
  const solver::Trajectory right = solver::simulate(machine.system, cycle, s.machine->ambient, ends_s, {}, machine.start);
  EXPECT_GT(right.outputs.row(0).maxCoeff(), 3.0);
  write_npy(folder / "right.npy", right.outputs);
  // The ambient rises by 1.5 K in the first hour and stays; sections end at 40, 60 and 90 min, so it bends where one ends.
  EXPECT_EQ(run_numpy(R"(
import sys; sys.path.insert(0, 'exported')
from reduced_model import *
right = np.load('exported/right.npy')
assert [o for o in model['outputs']['name']] == ['t_head', 't_column', 't_ambient', 'z'], model['outputs']
assert [x['name'] for x in model['sources']], model['sources']
assert len(model['drives']) == 3 and model['drives'][0]['speed_rpm'] == 1000
def expm(a):
    n = max(0, int(np.ceil(np.log2(max(np.abs(a).sum(1).max(), 1e-300)))) + 6)
    a, e, term = a / 2.0**n, np.eye(len(a)), np.eye(len(a))
    for k in range(1, 14): term = term @ a / k; e = e + term
    for _ in range(n): e = e @ e
    return e
z, ambient, t = a['start'].copy(), 0.0, 0.0
for k, (drive, duration, slope) in enumerate(zip(model['drives'], [2400, 1200, 1800], [1.5 / 3600, 1.5 / 3600, 0])):
    A, B, C = ABC(drive)
    P = drive['powers_W']
    big = np.zeros((r + 2, r + 2))  # z, ambient, 1
    big[:r, :r], big[:r, r], big[:r, r + 1] = A, B[:, -2], B[:, :-2] @ P + B[:, -1]
    big[r, r + 1] = slope
    x = expm(big * duration) @ np.concatenate([z, [ambient, 1]])
    z, ambient = x[:r], x[r]
    y = C @ z + a['outputs_hall'] * ambient
    off = np.abs(y - right[:, k + 1])
    assert off.max() < 1e-8 and off[3] < 1e-14, (k, y, right[:, k + 1])
)"),
            "");
}

}  // namespace
}  // namespace driftwright::scenarios::machine_store_test
