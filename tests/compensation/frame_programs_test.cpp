// The thermal frame as programs of controls; LinuxCNC's is read by its own interpreter, where that is installed.

#include "compensation/frames/frame_programs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <regex>
#include <sstream>

#include "base/errors.hpp"
#include "scenarios/reader/read_table.hpp"
#include "tests/shared/one_hal.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::compensation::frame_programs_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

FrameProgram program() {
  FrameProgram p;
  p.rings = {{"low", {-4.8, 0.1, 0.0}}, {"high", {4.8, 0.1, 0.0}}};
  p.frame.x = {1.0000123, 20e-6};
  p.control = {.reference_K = 296.15, .k0_m = 12e-6, .slope_1_K = 14.21e-6, .reference_position_m = 0.1};
  p.temperature_K = 305.45;
  p.made_by = "test";
  return p;
}

std::string file(const std::string& name, const FrameProgram& p = program()) {
  for (const ProgramFile& f : frame_programs(p)) {
    if (f.name == name) return f.text;
  }
  return "no such file";
}

/// The text after `name` and '=' up to a blank, a comma or the end of the line.
std::string value_of(const std::string& text, const std::string& name) {
  const std::size_t at = text.find("\n" + name + "=");
  if (at == std::string::npos) return "";
  const std::size_t from = at + name.size() + 2;
  return text.substr(from, text.find_first_of(" \n", from) - from);
}

/// A term of a Siemens program: numbers, names, + - * / and parentheses, without blanks.
class Term {
 public:
  Term(std::string text, const std::map<std::string, double>& names) : text_(std::move(text)), names_(names) {}
  double value() {
    double sum = product();
    while (at_ < text_.size() && (text_[at_] == '+' || text_[at_] == '-'))
      sum += text_[at_++] == '+' ? product() : -product();
    return sum;
  }

 private:
  double product() {
    double p = factor();
    while (at_ < text_.size() && (text_[at_] == '*' || text_[at_] == '/')) {
      if (text_[at_++] == '*')
        p *= factor();
      else
        p /= factor();
    }
    return p;
  }
  double factor() {
    if (text_.at(at_) == '(') {
      ++at_;
      const double inner = value();
      ++at_;
      return inner;
    }
    const std::size_t end = std::min(text_.find_first_of("+-*/()", at_ + 1), text_.size());
    const std::string word = text_.substr(at_, end - at_);
    at_ = end;
    return names_.contains(word) ? names_.at(word) : std::stod(word);
  }
  std::string text_;
  const std::map<std::string, double>& names_;
  std::size_t at_ = 0;
};

TEST(FrameProgram, GivesSiemensTheSlopeInSettingData) {
  EXPECT_THAT(file("siemens/THERMDATA.SPF"),
              AllOf(HasSubstr("$SA_TEMP_COMP_SLOPE[AX1]=0.000132 "), HasSubstr("$SA_TEMP_COMP_ABS_VALUE[AX1]=0.012 "),
                    HasSubstr("$SA_TEMP_COMP_REF_POSITION[AX1]=100.000 "), HasSubstr("follows at 300 mm/min"),
                    HasSubstr("MD32750 acts after power-on"), HasSubstr("MD32760 after NEWCONF"), HasSubstr("\nNEWCONF\n")));
}

TEST(FrameProgram, NamesTheLimitOfCorrectionsInEachProgram) {
  FrameProgram limited = program();
  limited.most_correction_um = 80.0;
  for (const char* name :
       {"siemens/THERMFRAME.SPF", "siemens/THERMDATA.SPF", "linuxcnc/thermframe.ngc", "heidenhain/THERMFRAME.H"}) {
    EXPECT_THAT(file(name, limited), HasSubstr("limit of the scenario: no correction above 80 um")) << name;
    EXPECT_THAT(file(name), AllOf(Not(HasSubstr("limit of the scenario")), Not(HasSubstr("no such file")))) << name;
  }
}

// A table that has grown by 132 um/m about P0 and gone 12 um: both ways move the axis along with it, whatever the
// control's sign is.
TEST(FrameProgram, MovesXTheSameWayBySettingDataAndByFrame) {
  for (const bool against_dk : {false, true}) {
    FrameProgram p = program();
    p.against_dk = against_dk;
    const std::string data = file("siemens/THERMDATA.SPF", p), frame = file("siemens/THERMFRAME.SPF", p);
    const auto set = [&](const char* name) {
      return std::stod(value_of(data, std::string("$SA_TEMP_COMP_") + name + "[AX1]"));
    };
    std::smatch sign;
    ASSERT_TRUE(std::regex_search(data, sign, std::regex("the axis moves by ([+-])dK")));
    EXPECT_NEAR(set("SLOPE"), against_dk ? -0.000132 : 0.000132, 1e-12);
    std::map<std::string, double> names = {{"TF_X1", -4800.0}, {"TF_X2", 4800.0}};
    const auto place = [](double x_mm) { return x_mm + 0.012 + 132e-6 * (x_mm - 100.0); };
    names["TF_X1N"] = place(-4800.0);
    names["TF_X2N"] = place(4800.0);
    for (const char* name : {"TEMP_SCALE", "TEMP_SHIFT"}) names[name] = Term(value_of(frame, name), names).value();
    for (double x_mm : {-4950.0, 100.0, 4950.0}) {
      const double dK_mm = set("ABS_VALUE") + set("SLOPE") * (x_mm - set("REF_POSITION"));
      const double by_data_mm = sign[1] == "+" ? dK_mm : -dK_mm;
      const double by_frame_mm = names["TEMP_SCALE"] * (x_mm + names["TEMP_SHIFT"]) - x_mm;
      EXPECT_NEAR(by_data_mm, place(x_mm) - x_mm, 1e-9);
      EXPECT_NEAR(by_frame_mm, by_data_mm, 1e-9);
    }
    const TableFrame ours = data_at(p.control, p.temperature_K).frame();
    EXPECT_NEAR(1e3 * (ours.x.map(4.95) - 4.95), place(4950.0) - 4950.0, 1e-9);
  }
}

TEST(FrameProgram, ChainsTheSiemensFrameAsWeDo) {
  const std::string text = file("siemens/THERMFRAME.SPF");
  EXPECT_THAT(text, AllOf(HasSubstr(":CROT(Z,TF_TURN,Y,TF_TILT):CSCALE(X,TEMP_SCALE):CTRANS(X,TEMP_SHIFT)"),
                          HasSubstr("ABS(TEMP_SCALE-1)>0.001")));
  EXPECT_THAT(file("heidenhain/THERMFRAME.H"),
              AllOf(HasSubstr("TCH PROBE 421"), HasSubstr("CYCL DEF 26.1 XQ42 CCX+0"), HasSubstr("CYCL DEF 7.1 X+Q40")));
}

TEST(FrameProgram, KeepsTheSiemensFrameThroughTheNextG54) {
  const std::string text = file("siemens/THERMFRAME.SPF");
  const std::size_t cleared = text.find("\n$P_UBFR=CTRANS()"), measured = text.find("\nRINGMEAS("),
                    written = text.find("\n$P_UBFR=TF_NEW");
  ASSERT_NE(written, std::string::npos);
  EXPECT_LT(cleared, measured);
  EXPECT_LT(measured, written);
  EXPECT_THAT(text, HasSubstr("\n$P_BFRAME=TF_NEW"));
  EXPECT_THAT(text.substr(0, text.find('\n')), Not(HasSubstr("SAVE"))) << "SAVE takes the frame away at the return";
}

// Every refusal goes to the label that puts both old frames back; the new one is written before it alone.
TEST(FrameProgram, LeavesTheOldSiemensFrameWhereItRefuses) {
  const std::string text = file("siemens/THERMFRAME.SPF"), ring = file("siemens/RINGMEAS.SPF");
  const std::size_t back = text.find("\nREFUSED:\n$P_UBFR=TF_OLDDATA\n$P_BFRAME=TF_OLD\n");
  ASSERT_NE(back, std::string::npos);
  EXPECT_LT(text.rfind("=TF_NEW"), back);
  EXPECT_LT(text.find("TF_OLDDATA=$P_UBFR"), text.find("$P_UBFR=CTRANS()"));
  EXPECT_LT(text.find("TF_OLD=$P_BFRAME"), text.find("$P_BFRAME=CTRANS()"));
  std::size_t asked = 0;
  for (std::size_t call = text.find("\nRINGMEAS("); call != std::string::npos; call = text.find("\nRINGMEAS(", call + 1)) {
    EXPECT_EQ(text.find("TF_STATUS)\nIF TF_STATUS<>0 GOTOF REFUSED\n", call), text.find('\n', call + 1) - 10);
    ++asked;
  }
  EXPECT_EQ(asked, 2u);
  for (const char* label : {"IDENTICAL", "SWAPPED", "NOHEAT"}) {
    const std::size_t at = text.find(std::string("\n") + label + ":\nTF_STATUS=6501");
    ASSERT_NE(at, std::string::npos) << label;
    EXPECT_LT(text.find("GOTOF REFUSED", at), text.find(":\n", at + 14)) << label;
  }
  const std::regex touch("MEAS=1[^\n]*\nSTOPRE\nIF \\$AC_MEA\\[1\\]==0 GOTOF NORING\n");
  EXPECT_EQ(std::distance(std::sregex_iterator(ring.begin(), ring.end(), touch), std::sregex_iterator()),
            6);  // four walls, the height twice
  EXPECT_THAT(ring, HasSubstr("\nNORING:\nTF_STATUS=65013 "));
  EXPECT_EQ(text.find("SETAL"), text.find("SETAL(TF_STATUS)\nM0\nRET\n")) << "one alarm, after the old frames";
  EXPECT_LT(text.find("$P_BFRAME=TF_OLD\n"), text.find("SETAL"));
  EXPECT_THAT(ring, Not(HasSubstr("SETAL"))) << "an alarm may end the program where it is: the probe must be away before";
  EXPECT_THAT(ring, HasSubstr("AWAY:\nG0 Z=TF_CZ+50.000\nBACK:\nSTOPRE\nRET\n"));
}

/// Whether these are in the text in this order.
void expect_in_order(const std::string& text, const std::vector<std::string>& parts) {
  std::size_t at = 0;
  for (const std::string& part : parts) {
    const std::size_t found = text.find(part, at);
    EXPECT_NE(found, std::string::npos) << part << " in\n" << text;
    at = found == std::string::npos ? at : found + part.size();
  }
}

// As the touch cycle of one axis: a cutter is no probe, a spindle that turns breaks one, what is in the way stops the axis,
// and a caller in inches would have all positions in inches.
TEST(FrameProgram, RefusesBeforeItComesNearARing) {
  FrameProgram p = program();
  p.probe_tool = 9;
  const std::string ngc = file("linuxcnc/thermframe.ngc", p);
  expect_in_order(
      ngc, {"M70\nG21 G90 G94 G17 G40 G61\n", "[#5400 NE 9]", "M72\nG54\n", "M2\n", "[#<_spindle_on> EQ 1]", "M2\n",  //
            "o112 if [#<_z> LT 50.0000]\nG0 Z50.0000\no112 endif\nG0 X-4800.0000 Y100.0000\nG0 Z50.0000\n",
            "G38.3 Z-5.0000 F1500\n", "[#5070 EQ 1]", "in the way above ring low", "G38.3 X-47",
            "G0 Z5.0000\nG38.3 X-4770.0000 F1500\n", "[#5070 EQ 1]", "in the way above ring low", "G38.3 Z-3.0000",
            "o132 if [#<_z> LT 50.0000]", "in the way above ring high"});
  EXPECT_THAT(ngc, Not(HasSubstr("G1 Z-5.0000"))) << "down without a touch";
  const std::string ring = file("siemens/RINGMEAS.SPF");
  expect_in_order(ring, {"GOTOF NOLENGTH\n", "($P_ACTFRAME[X,RT]<>0)", "($P_ACTFRAME[Y,SC]<>1)", "($P_ACTFRAME[Z,MI]==TRUE)",
                         "GOTOF NOPROBE\nM5\nG17 G40 G60\n", "IF $AA_IW[Z]>=TF_CZ+50.000 GOTOF ABOVE",
                         "ABOVE:\nG0 X=TF_CX Y=TF_CY\nG0 Z=TF_CZ+50.000\n",
                         "IF $A_PROBE[1]==1 GOTOF DEFLECTED\nMEAS=1 G1 Z=TF_CZ-5.000 F1500\nSTOPRE\n",
                         "IF $AC_MEA[1]==1 GOTOF INTHEWAY\n", "TF_WALL[3]=$AA_MW[Y]",
                         "MEAS=1 G1 X=TF_CX+30.000 F1500\nSTOPRE\nIF $AC_MEA[1]==1 GOTOF INTHEWAY\n", "MEAS=1 G1 Z=TF_CZ-3",
                         "INTHEWAY:\nTF_STATUS=65021", "GOTOF AWAY\n", "NOPROBE:\nTF_STATUS=65023", "GOTOF BACK\n"});
  expect_in_order(file("siemens/THERMFRAME.SPF"), {"OR ($P_GG[13]==1) OR ($P_GG[13]==3) GOTOF INCHES\n",
                                                   "$P_BFRAME=CTRANS()\n", "INCHES:\nTF_STATUS=65024"});
  expect_in_order(file("siemens/THERMDATA.SPF"),
                  {"METRIC==FALSE GOTOF INCHES\n", "$SA_TEMP_COMP_ABS_VALUE[AX1]=", "M17\nINCHES:\nSETAL(65024)"});
}

TEST(FrameProgram, ReadsTheTipOfTheProbeAndNoMachineAxis) {
  const std::string ring = file("siemens/RINGMEAS.SPF"), ngc = file("linuxcnc/thermframe.ngc");
  EXPECT_THAT(ring,
              AllOf(HasSubstr("$AA_MW[X]"), HasSubstr("$AA_MW[Z]"), Not(HasSubstr("$AA_MM")), Not(HasSubstr("SUPA")),
                    HasSubstr("IF $P_TOOL==0 GOTOF NOLENGTH"), HasSubstr("IF ABS($AA_MW[Z]-TF_CZ)>1 GOTOF WRONGHEIGHT")));
  EXPECT_THAT(ngc,
              AllOf(HasSubstr("\nG43\n"), Not(HasSubstr("G49")), HasSubstr("#5400 NE 99"), HasSubstr("[#5070 EQ 0]"),
                    Not(HasSubstr("G38.2")), HasSubstr("ABS[#104 - 0.0000] GT 1]"), HasSubstr("ABS[#124 - 0.0000] GT 1]")));
}

// X1, Y1, Z1 are machine axes, I and TURN words of the language.
TEST(FrameProgram, NamesNoVariableAsAxesAreNamed) {
  for (const char* name : {"siemens/THERMFRAME.SPF", "siemens/RINGMEAS.SPF"}) {
    const std::string text = file(name);
    EXPECT_FALSE(std::regex_search(text, std::regex("(DEF|VAR|PROC)[^\n;]*[ (,]([XYZ][0-9]N?|I|TURN|C[XYZ])\\b"))) << name;
    EXPECT_EQ(text.find("PROC "), 0u);
  }
  EXPECT_THAT(file("siemens/THERMFRAME.SPF"),
              HasSubstr("\nEXTERN RINGMEAS(REAL, REAL, REAL, VAR REAL, VAR REAL, VAR REAL, VAR INT)\n"));
}

// 44 mm are the ring less a ball of 6 mm; the cycle of Heidenhain asks for the bore and its limits.
TEST(FrameProgram, TellsHeidenhainTheBore) {
  const std::string text = file("heidenhain/THERMFRAME.H");
  EXPECT_THAT(
      text, AllOf(HasSubstr("Q262=+50.000"), HasSubstr("Q275=+51.000"), HasSubstr("Q276=+49.000"),
                  HasSubstr("FN 11: IF +Q153 GT +51.000 GOTO LBL 99"), HasSubstr("FN 12: IF +Q153 LT +49.000 GOTO LBL 99")));
  EXPECT_LT(text.find("FN 0: Q42 = +Q20"), text.find(" LBL 99\n", text.find("FN 0: Q44 = +0")))
      << "the frame that is kept is written where nothing was refused";
}

TEST(FrameProgram, CountsFromTheMachinesZero) {
  const FrameProgram here = program(), there = in_machine(here, {6.0, 1.0, -0.8});
  EXPECT_THAT(file("siemens/THERMFRAME.SPF", there),
              AllOf(HasSubstr("TF_X1=1200.0000 TF_Y1=1100.0000 TF_Z1=-800.0000"),
                    HasSubstr("origin of the model is at X6000.0000 Y1000.0000 Z-800.0000")));
  EXPECT_THAT(file("siemens/THERMDATA.SPF", there), HasSubstr("$SA_TEMP_COMP_REF_POSITION[AX1]=6100.000 "));
  EXPECT_THAT(file("linuxcnc/joint_0.comp", there), HasSubstr("11000.0000 0.13530 0.13530\n"));
  const Eigen::Vector3d origin(6.0, 1.0, -0.8), point(2.0, -0.3, 0.0);
  EXPECT_LT((there.frame.frame().map(point + origin) - origin - here.frame.frame().map(point)).norm(), 1e-10);
}

TEST(FrameProgram, WritesTheScaleAsTrimsOfTheJoint) {
  std::istringstream rows(file("linuxcnc/joint_0.comp"));
  double x_mm = 0.0, forward_mm = 0.0, reverse_mm = 0.0, before_mm = -1e9;
  int n = 0;
  while (rows >> x_mm >> forward_mm >> reverse_mm) {
    EXPECT_GT(x_mm, before_mm);
    EXPECT_NEAR(forward_mm, 1.23e-5 * x_mm, 5.1e-6);  // five decimals
    EXPECT_EQ(forward_mm, reverse_mm);
    before_mm = x_mm;
    ++n;
  }
  EXPECT_EQ(n, 21);
  EXPECT_TRUE(rows.eof()) << "a line that cannot be parsed would end the table";
}

TEST(FrameProgram, IsReadByTheInterpreterOfLinuxcnc) {
  if (std::system("command -v rs274 >/dev/null 2>&1") != 0) GTEST_SKIP() << "rs274 is not installed (linuxcnc-uspace)";
  write_file("thermframe.ngc", file("linuxcnc/thermframe.ngc"));
  const std::string values =
      write_file("rs274.var", "5220 1\n5221 4000\n5222 50\n5223 -10\n5230 30\n5381 7\n5382 0\n5383 0\n5390 0\n");
  EXPECT_EQ(std::system(("cd " + temporary_folder().string() + " && " + kOneHal +
                         "rs274 -g -v rs274.var thermframe.ngc > rs274.out 2>&1")
                            .c_str()),
            0);
  const std::string said = read_text(temporary_folder() / "rs274.out");
  EXPECT_THAT(said, AllOf(HasSubstr("STRAIGHT_PROBE(-4775"), HasSubstr("PROGRAM_END"),
                          HasSubstr("SET_G5X_OFFSET(8, 0.0000, 0.0000, 0.0000"), Not(HasSubstr("rror"))));
  std::size_t n_probes = 0;
  for (std::size_t at = said.find("STRAIGHT_PROBE"); at != std::string::npos; at = said.find("STRAIGHT_PROBE", at + 1))
    ++n_probes;
  // of each ring the way down, four for the middle, the way beside, one for the height and a second, slow one
  EXPECT_EQ(n_probes, 16u);
  // Each touch ends where it was sent: both middles as they were, both edges 3 mm lower; rs274 keeps inches. G59.3 is G54
  // with that; G54 stays.
  const std::map<int, double> wanted = {
      {5221, 4000}, {5222, 50}, {5223, -10}, {5230, 30}, {5381, 4000}, {5382, 50}, {5383, -10 - 3 / 25.4}, {5390, 30}};
  std::istringstream after(read_text(values));
  std::map<int, double> found;
  for (int number = 0; after >> number;) after >> found[number];
  for (const auto& [number, value] : wanted) EXPECT_NEAR(found[number], value, 1e-5) << number;
}

TEST(FrameProgram, RefusesRingsThatItWouldMistake) {
  FrameProgram p = program();
  EXPECT_EQ(why_no_program(p.rings), "");
  p.rings[1].at_m[1] += 0.009;  // 9.6 m let through 9.6 mm
  EXPECT_EQ(why_no_program(p.rings), "");
  p.rings[1].at_m[1] += 0.001;
  EXPECT_THAT(why_no_program(p.rings), HasSubstr("10.0 mm across x"));
  EXPECT_THROW((void)frame_programs(p), InputError);
  p = program();
  p.rings.push_back({"third", {0.0, 0.1, 0.0}});
  EXPECT_THAT(why_no_program(p.rings), HasSubstr("3 rings"));
  EXPECT_THROW((void)in_machine(p, Eigen::Vector3d::Zero()), InputError);
  p.rings.resize(1);
  EXPECT_THROW((void)frame_programs(p), InputError);
}

std::string table_text(const std::string& control, const std::string& probe) {
  return "low: [-1 m, -1 m, 0 m]\nhigh: [1 m, 1 m, 0 m]\nhead: [0 m, 0 m, 0 m]\n"
         "scale_x: {sensor: s, material: steel_c45}\n"
         "rings: [{name: a, at: [-1 m, 0 m, 0 m]}, {name: b, at: [1 m, 0 m, 0 m]}]\n"
         "cyclogram: c\njudge_until: 1 h\ntrain_from: 1 h\n"
         "control: {sensor: s" +
         control + "}\nprobe: {feeds: [300 mm/min, 600 mm/min]" + probe + "}\n";
}

scenarios::TableSettings table_of(const std::string& control, const std::string& probe) {
  return scenarios::read_table(
      ConfigMap::read_file(write_file("table.yaml", table_text(control, probe))).described_by(scenarios::table_schema()),
      {"s"}, {"c"});
}

TEST(FrameProgram, TakesOriginSignAndBallFromTheScenario) {
  const auto plain = table_of("", "");
  EXPECT_EQ(plain.origin_m.norm(), 0.0);
  EXPECT_FALSE(plain.against_dk);
  EXPECT_EQ(plain.probe_tool, 99);
  const auto full = table_of(", origin: [6 m, 1 m, -800 mm], axis_moves: against_dk", ", ball_diameter: 5 mm, tool: 7");
  EXPECT_EQ(full.probe_tool, 7);
  EXPECT_LT((full.origin_m - Eigen::Vector3d(6.0, 1.0, -0.8)).norm(), 1e-12);
  EXPECT_TRUE(full.against_dk);
  EXPECT_DOUBLE_EQ(full.ball_diameter_m, 5e-3);
  const auto said = [](const std::string& control, const std::string& probe) -> std::string {
    try {
      (void)table_of(control, probe);
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing";
  };
  EXPECT_THAT(said(", origin: [6 m, 1 m]", ""), AllOf(HasSubstr("table.yaml:9"), HasSubstr("origin")));
  EXPECT_THAT(said(", origin: [600 m, 1 m, 0 m]", ""), AllOf(HasSubstr("table.yaml:9"), HasSubstr("-100 to 100 m")));
  EXPECT_THAT(said(", axis_moves: plus", ""), AllOf(HasSubstr("table.yaml:9"), HasSubstr("against_dk")));
  EXPECT_THAT(said("", ", tool: 0"), AllOf(HasSubstr("table.yaml:10"), HasSubstr("tool")));
  EXPECT_THAT(said("", ", ball_diameter: 1 m"), AllOf(HasSubstr("table.yaml:10"), HasSubstr("ball_diameter")));
}

}  // namespace
}  // namespace driftwright::compensation::frame_programs_test
