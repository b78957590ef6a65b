// Films of files through the program as a user runs it: every format, the report, what is not covered, bad files, and the
// reduced model against the full one and against `convection` and `forced_convection`.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>

#include "base/record.hpp"
#include "tests/shared/column_and_head.hpp"
#include "tests/shared/command_line.hpp"

namespace driftwright::films_test {
namespace {

using fixtures::ColumnAndHead;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kHeat = ColumnAndHead::kHeat;
constexpr const char* kFilm = ColumnAndHead::kFilm;
constexpr const char* kContact = ColumnAndHead::kContact;

/// The front of the head: 100 x 100 mm at y = 200 mm, z from 300 to 400 mm, as a CSV of 4 x 2 points.
std::string csv(const std::string& header, const std::function<std::string(double x_mm, double z_mm)>& values) {
  std::string text = header + "\n";
  for (const double z_mm : {325.0, 375.0}) {
    for (const double x_mm : {12.5, 37.5, 62.5, 87.5}) text += fmt::format("{},200,{},{}\n", x_mm, z_mm, values(x_mm, z_mm));
  }
  return text;
}

/// The scenario with a film on the front from a file.
std::string scenario_with(const std::filesystem::path& folder, const std::string& entry,
                          const std::string& model = "reduced", const std::string& name = "scenario") {
  ColumnAndHead machine{.effects = {kHeat, kFilm, kContact, entry}};
  machine.solver =
      fmt::format("{{output_interval: 5 min, fields_format: none, model: {}, reduction_tolerance: 0.001 K}}", model);
  return fixtures::write_column_and_head(folder, machine, name);
}

Record simulated(const std::filesystem::path& folder, const std::string& entry, const std::string& model,
                 const std::string& name) {
  const std::string scenario = scenario_with(folder, entry, model, name);
  const CommandOutcome outcome =
      run_program(fmt::format("simulate {} -o {}", scenario, (folder / ("out_" + name)).string()));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  return read_record_csv((folder / ("out_" + name) / "record.csv").string());
}

double farthest_apart(const Record& a, const Record& b, const std::string& channel) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.time_s.size(); ++i)
    most = std::max(most, std::abs(a.at(channel).values[i] - b.at(channel).values[i]));
  return most;
}

TEST(Films, OverSpeedAreThoseOfForcedConvection) {
  const auto folder = fresh_folder("films_over_speed");
  // The same everywhere: 15 W/(m^2 K) at rest and 45 at 1000 rpm, which at 600 rpm is 33 by either law.
  std::ofstream(folder / "front.csv") << "x_mm,y_mm,z_mm,speed_rpm,h_W_m2K\n"
                                         "10,200,310,0,15\n90,200,390,0,15\n10,200,310,1000,45\n90,200,390,1000,45\n";
  const std::string film = "{type: film_field, surface: front, file: front.csv, reach: 200 mm}";
  const std::string law =
      "{type: convection, surface: front, film: 15 W/(m^2 K)}\n"
      "  - {type: forced_convection, surface: front, growth: 30 W/(m^2 K), at_speed: 1000 rpm, exponent: 1}";
  for (const std::string model : {"full", "reduced"}) {
    const Record of_file = simulated(folder, film, model, "file_" + model),
                 of_law = simulated(folder, law, model, "law_" + model);
    // Full: the integrator's tolerance; reduced: twice that of the reduction.
    const double within_K = model == "full" ? 1e-3 : 2e-3;
    EXPECT_LT(farthest_apart(of_file, of_law, "t_head"), within_K) << model;
  }
  const Record full = read_record_csv((folder / "out_file_full" / "record.csv").string()),
               reduced = read_record_csv((folder / "out_file_reduced" / "record.csv").string());
  EXPECT_LT(farthest_apart(full, reduced, "t_head"), 3e-3);
  const std::string flows = read_text(folder / "out_file_reduced" / "heat_flows.csv");
  EXPECT_THAT(flows, AllOf(HasSubstr("film_field_front"), Not(HasSubstr("film_field_front_2"))));  // one law, one flow
}

TEST(Films, OverTimeAreFollowedByBothModels) {
  const auto folder = fresh_folder("films_over_time");
  std::ofstream(folder / "front.csv")
      << "x_mm,y_mm,z_mm,time_min,h_W_m2K,T_air_degC\n"
         "10,200,310,0,10,25\n90,200,390,0,10,26\n10,200,310,60,80,25\n90,200,390,60,90,30\n";
  const std::string film = "{type: film_field, surface: front, file: front.csv, reach: 200 mm}";
  const Record full = simulated(folder, film, "full", "full"), reduced = simulated(folder, film, "reduced", "reduced");
  EXPECT_LT(farthest_apart(full, reduced, "t_head"), 3e-3);
}

TEST(Films, ARawFileOfOpenFoamIsTheCsvOfItsNumbers) {
  const auto folder = fresh_folder("films_raw");
  std::filesystem::copy_file("tests/data/films/h_front_FACE_DATA.raw", folder / "front.raw");
  std::ofstream(folder / "front.csv") << csv("x_mm,y_mm,z_mm,h_W_m2K", [](double x_mm, double z_mm) {
    return fmt::format("{}", 8.0 + 0.08 * (x_mm - 12.5) + 0.2 * (z_mm - 325.0));
  });
  for (const std::string name : {"raw", "csv"}) {
    const std::string scenario =
        scenario_with(folder, fmt::format("{{type: film_field, surface: front, file: front.{}}}", name));
    const CommandOutcome outcome = run_program("check " + scenario);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    // ∫ h dA of 8 equal areas of 0.01 m^2: the mean of 8 to 24, which is 16.
    EXPECT_THAT(outcome.output, AllOf(HasSubstr("film_field front"), HasSubstr("0.1600"))) << name;
  }
}

// Of our own case: air at 1 m/s and 20 degC along the front at 40 degC, laminar, 10 x 4 x 8 cells, buoyantSimpleFoam of
// Debian's openfoam 1912 with the function objects heatTransferCoeff (TRef 293.15) and surfaces, vtk both as XML and legacy.
// Its surfaceFieldValue says: areaIntegrate(plate) of heatTransferCoeff(T) = -0.1500331.
TEST(Films, OfOpenFoamsSurfaceFilesHaveItsIntegral) {
  const auto folder = fresh_folder("films_openfoam");
  for (const std::string name : {"plate.raw", "plate.vtp", "plate.vtk"}) {
    std::filesystem::copy_file("tests/data/films/openfoam_" + name, folder / name);
    const std::string entry = fmt::format("{{type: film_field, surface: front, air: 20 degC, file: {}, film_column: ", name);
    const CommandOutcome outcome = run_program("check " + scenario_with(folder, entry + "-heatTransferCoeff(T)}"));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    EXPECT_THAT(outcome.output, AllOf(HasSubstr("film_field front"), HasSubstr("0.1500"))) << name;
    const CommandOutcome refused = run_program("check " + scenario_with(folder, entry + "heatTransferCoeff(T)}"));
    EXPECT_EQ(refused.exit_code, 2) << refused.output;
    EXPECT_THAT(refused.output, HasSubstr("write `film_column: -heatTransferCoeff(T)`")) << name;
  }
}

TEST(Films, FilesOfAPatternAreOneAnOperatingPoint) {
  const auto folder = fresh_folder("films_pattern");
  for (const int rpm : {0, 1000}) {
    // Legacy VTK: one quadrilateral over the whole front, the film as data of points.
    const double h = 10.0 + 0.03 * rpm;
    std::ofstream(folder / fmt::format("front_{}.vtk", rpm)) << fmt::format(
        "# vtk DataFile Version 2.0\nsampleSurface\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n"
        "0 0.2 0.3\n0.1 0.2 0.3\n0.1 0.2 0.4\n0 0.2 0.4\nPOLYGONS 1 5\n4 0 1 2 3\n"
        "POINT_DATA 4\nFIELD attributes 1\nhtc 1 4 float\n{} {} {} {}\n",
        h, h + 4.0, h + 4.0, h);
  }
  const CommandOutcome outcome = run_program(
      "mesh " + scenario_with(folder, "{type: film_field, surface: front, file: front_<rpm>.vtk, film_column: htc}") +
      " -o " + (folder / "out").string());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("0.1200"), HasSubstr("0.4200"), HasSubstr("100")));  // 0.01 m^2 of 12 and 42
  EXPECT_THAT(read_text(folder / "out" / "mesh.vtu"),
              AllOf(HasSubstr("h_W_m2K_at_0_rpm"), HasSubstr("h_W_m2K_at_1000_rpm")));
  EXPECT_THAT(read_text(folder / "out" / "report.html"), HasSubstr("film_field front at 1000 rpm"));  // the picture
}

TEST(Films, AreWrittenBesideTheFieldsOfARun) {
  const auto folder = fresh_folder("films_beside_fields");
  std::ofstream(folder / "front.csv") << csv(
      "x_mm,y_mm,z_mm,h_W_m2K,T_air_degC", [](double x_mm, double) { return fmt::format("{},24", x_mm < 50.0 ? 12 : 20); });
  const std::string film = "{type: film_field, surface: front, file: front.csv}";
  const auto out_of = [&](const std::string& model, const std::string& entry, const std::string& format) {
    ColumnAndHead machine{.effects = {kHeat, kFilm, kContact, entry}};
    machine.solver = fmt::format("{{output_interval: 5 min, fields_format: {}, model: {}}}", format, model);
    const auto out = folder / (model + "_" + format + (entry == film ? "_film" : ""));
    const CommandOutcome outcome =
        run_program("simulate " + fixtures::write_column_and_head(folder, machine, "scenario") + " -o " + out.string());
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    return out;
  };
  const auto full = out_of("full", film, "vtu"), reduced = out_of("reduced", film, "vtu");
  const std::string text = read_text(full / "films.vtu");
  EXPECT_THAT(text, AllOf(HasSubstr("Name=\"h_W_m2K\""), HasSubstr("Name=\"T_air_degC\""), Not(HasSubstr("quality"))));
  EXPECT_TRUE(text == read_text(reduced / "films.vtu"));  // whose machine has no faces of its own
  EXPECT_FALSE(std::filesystem::exists(out_of("reduced", film, "none") / "films.vtu"));
  const auto without = out_of("reduced", "{type: convection, surface: front, film: 9 W/(m^2 K)}", "vtu");
  EXPECT_TRUE(std::filesystem::exists(without / "fields.pvd"));
  EXPECT_FALSE(std::filesystem::exists(without / "films.vtu"));
}

TEST(Films, SayWhatIsNotCovered) {
  const auto folder = fresh_folder("films_uncovered");
  std::ofstream(folder / "front.csv")
      << "x_mm,y_mm,z_mm,h_W_m2K\n10,200,310,20\n20,200,310,20\n10,200,320,20\n20,200,320,20\n";
  const CommandOutcome refused =
      run_program("check " + scenario_with(folder, "{type: film_field, surface: front, file: front.csv}"));
  EXPECT_EQ(refused.exit_code, 2) << refused.output;
  EXPECT_THAT(refused.output, AllOf(HasSubstr("does not cover"), HasSubstr("'front'"), HasSubstr("`elsewhere:")));
  const CommandOutcome with_rest = run_program(
      "check " + scenario_with(folder, "{type: film_field, surface: front, file: front.csv, elsewhere: 6 W/(m^2 K)}"));
  EXPECT_EQ(with_rest.exit_code, 0) << with_rest.output;
  EXPECT_THAT(with_rest.output, HasSubstr("84.7"));
}

TEST(Films, BeyondTheSpeedsOfTheFileAreAWarning) {
  const auto folder = fresh_folder("films_beyond");
  std::ofstream(folder / "front.csv") << "x_mm,y_mm,z_mm,speed_rpm,h_W_m2K\n"
                                         "10,200,310,0,15\n90,200,390,0,15\n10,200,310,700,45\n90,200,390,700,45\n";
  const CommandOutcome outcome =
      run_program("check " + scenario_with(folder, "{type: film_field, surface: front, file: front.csv, reach: 200 mm}"));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("films from 0 to 700 rpm"), HasSubstr("at 1000 rpm in cyclogram 'cycle'")));
}

struct BadFile {
  const char *name, *header, *values;  ///< of every row
  const char* message;
};
class BadFilms : public ::testing::TestWithParam<BadFile> {};

TEST_P(BadFilms, AreRefusedWithLineAndColumn) {
  const auto folder = fresh_folder(std::string("films_bad_") + GetParam().name);
  std::ofstream(folder / "front.csv") << csv(GetParam().header,
                                             [](double, double) { return std::string(GetParam().values); });
  const CommandOutcome outcome =
      run_program("check " + scenario_with(folder, "{type: film_field, surface: front, file: front.csv}"));
  EXPECT_EQ(outcome.exit_code, 2) << outcome.output;
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("front.csv:"), HasSubstr(GetParam().message)));
}

INSTANTIATE_TEST_SUITE_P(Each, BadFilms,
                         ::testing::Values(BadFile{"no_film", "x_mm,y_mm,z_mm,htc", "12", "there is no column h_W_m2K"},
                                           BadFile{"no_place", "x_mm,y_mm,z_cm,h_W_m2K", "12", "there is no column z_mm"},
                                           BadFile{"nan", "x_mm,y_mm,z_mm,h_W_m2K", "nan", "nan"},
                                           BadFile{"text", "x_mm,y_mm,z_mm,h_W_m2K", "much", "much"},
                                           BadFile{"negative", "x_mm,y_mm,z_mm,h_W_m2K", "-3", "not possible"},
                                           BadFile{"unit_of_air", "x_mm,y_mm,z_mm,h_W_m2K,T_air_K", "12,22", "_degC"},
                                           BadFile{"cells", "x_mm,y_mm,z_mm,h_W_m2K", "12,22", "5 cells"},
                                           BadFile{"both", "x_mm,y_mm,z_mm,speed_rpm,time_min,h_W_m2K", "0,0,12",
                                                   "the speed or the time"}),
                         [](const auto& bad) { return bad.param.name; });

TEST(Films, TakeTheirAirFromOnePlace) {
  const auto folder = fresh_folder("films_two_airs");
  std::ofstream(folder / "front.csv") << csv("x_mm,y_mm,z_mm,h_W_m2K,T_air_degC",
                                             [](double, double) { return std::string("12,24"); });
  const CommandOutcome outcome =
      run_program("check " + scenario_with(folder, "{type: film_field, surface: front, file: front.csv, air: 22 degC}"));
  EXPECT_EQ(outcome.exit_code, 2) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("the file has air temperatures; leave `air` out"));
}

TEST(Films, InAnotherUnitAreRefused) {
  const auto folder = fresh_folder("films_unit_of_lengths");
  std::ofstream(folder / "front.csv") << csv("x_m,y_m,z_m,h_W_m2K", [](double, double) { return std::string("12"); });
  const CommandOutcome outcome =
      run_program("check " + scenario_with(folder, "{type: film_field, surface: front, file: front.csv}"));
  EXPECT_EQ(outcome.exit_code, 2) << outcome.output;
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("check the unit of its lengths"), HasSubstr("'front'")));
}

TEST(Films, OfAMissingOrForeignFileAreRefused) {
  const auto folder = fresh_folder("films_missing");
  std::ofstream(folder / "front.txt") << "x";
  std::ofstream(folder / "broken.vtp") << "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"4\"";
  const std::pair<const char*, const char*> cases[] = {{"gone.csv", "there is no file"},
                                                       {"front_<rpm>.csv", "no file matches"},
                                                       {"front.txt", "is no format of films"},
                                                       {"broken.vtp", "VTK cannot read it"}};
  for (const auto& [file, message] : cases) {
    const CommandOutcome outcome =
        run_program("check " + scenario_with(folder, fmt::format("{{type: film_field, surface: front, file: {}}}", file)));
    EXPECT_EQ(outcome.exit_code, 2) << outcome.output;
    EXPECT_THAT(outcome.output, HasSubstr(message)) << file;
  }
}

}  // namespace
}  // namespace driftwright::films_test
