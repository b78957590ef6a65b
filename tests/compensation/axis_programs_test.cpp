// The touch cycle of one axis as programs of controls: places, limits, order of what is written, refusals.

#include "compensation/frames/axis_programs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <sstream>

#include "base/errors.hpp"
#include "tests/shared/one_hal.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::compensation::axis_programs_test {
namespace {

using ::testing::AllOf, ::testing::HasSubstr, ::testing::Not;

AxisProgram program(int axis = 2, double toward = -1.0) {
  AxisProgram p{.axis = axis, .toward = toward, .at_m = {0.1, 0.05, -0.02}};
  p.first_um = 60.0;
  p.step_um = 30.0;
  p.most_um = 100.0;
  p.made_by = "a test";
  return p;
}

std::string file(const std::string& name, const AxisProgram& p = program()) {
  for (const ProgramFile& f : axis_programs(p)) {
    if (f.name == name) return f.text;
  }
  return "no such file";
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

TEST(AxisProgram, TouchesFromFiveMillimetresBeforeToThreeBeyond) {
  expect_in_order(file("linuxcnc/probe_z.ngc"), {"[#<_z> LT 30.0000]\nG0 Z30.0000\n", "endif\nG0 X100.0000 Y50.0000\n",
                                                 "G0 Z30.0000\nG38.3 Z-15.0000 F1500\n", "G38.3 Z-23.0000 F300\n",
                                                 "G91 G1 Z0.5000", "G38.3 Z-23.0000 F30\n"});
  expect_in_order(file("linuxcnc/probe_x.ngc", program(0, 1.0)),
                  {"G0 Z30.0000\n", "G0 X95.0000 Y50.0000\n", "G38.3 Z-20.0000 F1500\n", "G38.3 X103.0000 F300\n",
                   "G91 G1 X-0.5000", "G38.3 X103.0000 F30\n", "G1 X95.0000 F2000\nG0 Z30.0000\n"});
  expect_in_order(file("siemens/TOUCHY.SPF", program(1, -1.0)),
                  {"IF $AA_IW[Z]>=30.0000 GOTOF ABOVE", "G0 Z=30.0000\n", "ABOVE:\nG0 X=100.0000 Y=55.0000\n",
                   "MEAS=1 G1 Z=-20.0000 F1500\n", "MEAS=1 G1 Y=47.0000 F300\n", "G91 G1 Y=0.5000",
                   "MEAS=1 G1 Y=47.0000 F30\n", "TA_READ=$AA_MW[Y]\n", "AWAY:\nG1 Y=55.0000 F2000\nG0 Z=30.0000\n"});
}

// A cutter is no probe, a spindle that turns breaks one, and what lies above the gauge is met by a touch.
TEST(AxisProgram, RefusesBeforeItComesNearTheGauge) {
  AxisProgram p = program();
  p.probe_tool = 9;
  expect_in_order(
      file("linuxcnc/probe_z.ngc", p),
      {"M73\nG21 G90 G94 G17 G40 G61\n", "[#5400 NE 9]", "o<probe_z> return [1]", "[#<_spindle_on> EQ 1]",
       "o<probe_z> return [6]", "G38.3 Z-15", "[#5070 EQ 1]", "G0 Z30.0000\nM66", "o<probe_z> return [5]", "G38.3 Z-23"});
  const std::string touch = file("siemens/TOUCHZ.SPF");
  expect_in_order(
      touch, {"GOTOF NOPROBE\nM5\nG17 G40 G60\n", "IF $A_PROBE[1]==1 GOTOF DEFLECTED\nMEAS=1 G1 Z=-15",
              "IF $AC_MEA[1]==1 GOTOF INTHEWAY\n", "IF $A_PROBE[1]==1 GOTOF DEFLECTED\nMEAS=1 G1 Z=-23.0000 F300",
              "IF $A_PROBE[1]==1 GOTOF DEFLECTED\nMEAS=1 G1 Z=-23.0000 F30\n", "INTHEWAY:\nTA_STATUS=65021", "GOTOF AWAY\n",
              "AWAY:\nG0 Z=30.0000\nBACK:\nSTOPRE\nRET\n"});
  EXPECT_THAT(touch, Not(HasSubstr("SETAL"))) << "an alarm may end the program where it is: the probe must be away before";
  expect_in_order(file("siemens/PROBEZ.SPF"), {"OR ($P_GG[13]==1) OR ($P_GG[13]==3) GOTOF INCHES\n", "TOUCHZ(", "REFUSED:\n",
                                               "SETAL(PA_STATUS)\nRET\n"});
}

// Each control writes the offset once, after the last check; what refuses comes before it or jumps past it.
TEST(AxisProgram, WritesTheOffsetAfterAllChecks) {
  const std::string ngc = file("linuxcnc/probe_z.ngc");
  expect_in_order(
      ngc, {"[#5070 EQ 0]", "o<probe_z> return [3]", "[#5070 EQ 0]", "#<_hal[axis.z.eoffset]>",
            "#<read> = [#5063 - #160 * #<led>]", "#<bound> = 0.03000", "[#<now> EQ 0]", "#<bound> = 0.06000", "GT #<bound>",
            "o<probe_z> return [4]", "GT 0.10000", "o<probe_z> return [4]", "G10 L2 P7 Z#<new>\nG10 L2 P9 X["});
  EXPECT_EQ(ngc.find("G10 L2 P7"), ngc.rfind("G10 L2 P7"));
  EXPECT_EQ(ngc.find("G10 L2 P9"), ngc.rfind("G10 L2 P9"));
  const std::string update = file("siemens/PROBEZ.SPF");
  expect_in_order(update, {"PA_FRAME=$P_BFRAME\n", "PA_NOW=$P_UBFR[Z,FI]\n", "TOUCHZ(PA_READ, PA_STATUS)\n",
                           "IF PA_STATUS<>0 GOTOF REFUSED\n", "PA_NEW=PA_READ-(-20.0000)\n", "PA_BOUND=0.03000\n",
                           "PA_BOUND=0.06000", "PA_STEP=PA_NEW-PA_NOW\n", "IF ABS(PA_STEP)>PA_BOUND GOTOF TOOFAR\n",
                           "IF ABS(PA_NEW)>0.10000 GOTOF TOOMUCH\n", "$P_UBFR[Z,FI]=PA_NEW", "$P_BFRAME=PA_FRAME\n", "RET\n",
                           "TOOFAR:\n", "TOOMUCH:\n", "REFUSED:\n$P_BFRAME=PA_FRAME\nSTOPRE\nSETAL(PA_STATUS)\nRET\n"});
  EXPECT_EQ(update.find("$P_UBFR[Z,FI]="), update.rfind("$P_UBFR[Z,FI]="));
  EXPECT_THAT(update.substr(0, update.find('\n')), Not(HasSubstr("SAVE"))) << "SAVE takes the offset away at the return";
  const std::string touch = file("siemens/TOUCHZ.SPF");
  EXPECT_THAT(touch, AllOf(HasSubstr(") SAVE DISPLOF\n"), Not(HasSubstr("$P_UBFR"))));
  expect_in_order(touch, {"IF $P_TOOL==0 GOTOF NOLENGTH\n", "($P_ACTFRAME[X,RT]<>0)", "GOTOF OTHERFRAME\n",
                          "IF $AC_MEA[1]==0 GOTOF NOGAUGE\n", "IF $AC_MEA[1]==0 GOTOF NOGAUGE\n",
                          "TA_READ=$AA_MW[Z]\nGOTOF AWAY\n", "NOGAUGE:\nTA_STATUS=65018"});
  const std::string klartext = file("heidenhain/PROBEZ.H");
  expect_in_order(klartext, {"FN 0: Q59 = +1\n", "TCH PROBE 427", "FN 11: IF +Q58 GT +Q60 GOTO LBL 99\n",
                             "FN 11: IF +Q61 GT +0.10000 GOTO LBL 99\n", "FN 1: Q48 = +Q48 + +Q57\n",
                             "CYCL DEF 7.1 IZ+Q57\n", "FN 0: Q59 = +0\n", "LBL 99\n"});
  EXPECT_EQ(klartext.find("Q48 = "), klartext.rfind("Q48 = "));
}

// Q160 and the place of the touch count from the datum shift in force, whatever it is.
TEST(AxisProgram, TakesTheDatumShiftOfHeidenhainIntoAccount) {
  expect_in_order(
      file("heidenhain/PROBEY.H", program(1, 1.0)),
      {"FN 18: SYSREAD Q50 = ID220 NR2 IDX1\n", "FN 18: SYSREAD Q51 = ID220 NR2 IDX2\n",
       "FN 18: SYSREAD Q52 = ID220 NR2 IDX3\n", "FN 2: Q53 = +100.0000 - +Q50\n", "FN 2: Q54 = +50.0000 - +Q51\n",
       "FN 2: Q55 = -20.0000 - +Q52\n", "Q56 = +Q55 + +50.0000\n", "Q263=+Q53", "Q264=+Q54", "Q261=+Q55", "Q272=+2",
       "Q267=+1", "Q260=+Q56", "Q309=+0", "Q57 = Q160 + Q51 - ( 50.0000 ) - Q47\n", "FN 0: Q60 = +0.03000\n",
       "IF +Q47 NE +0", "FN 0: Q60 = +0.06000\n", "IY+Q57\n"});
}

TEST(AxisProgram, GivesTheValueToTheComponentOfAModel) {
  AxisProgram given = program();
  given.to_component = true;
  const std::string ngc = file("linuxcnc/probe_z.ngc", given);
  expect_in_order(
      ngc, {"M73\n", "\nM65 P2\n", "G38.3", "#<left_um> = [[-20.0000 - #<read>] * 1000]\nM68 E2 Q#<left_um>\nM64 P2\n",
            "M65 P2\nM66 E0 L0\n", "#<_hal[thermal.probe-verdict]>", "o<probe_z> return [4]"});
  EXPECT_THAT(ngc, AllOf(Not(HasSubstr("G10 L2 P7")), Not(HasSubstr("G10 L2 P9"))));
}

TEST(AxisProgram, RefusesZUpward) {
  EXPECT_THROW((void)axis_programs(program(2, 1.0)), InputError);
}

// rs274 lets each touch end where it was sent, 3 mm beyond the face, and refuses nothing: -3 mm for G59.1, and for G59.3
// above G54. It keeps inches.
TEST(AxisProgram, IsReadByTheInterpreterOfLinuxcnc) {
  if (std::system("command -v rs274 >/dev/null 2>&1") != 0) GTEST_SKIP() << "rs274 is not installed (linuxcnc-uspace)";
  write_file("probe_z.ngc", file("linuxcnc/probe_z.ngc"));
  const std::string values =
      write_file("rs274.var", "5220 1\n5221 4000\n5222 50\n5223 -10\n5230 30\n5341 2\n5343 0\n5383 0\n");
  EXPECT_EQ(std::system(("cd " + temporary_folder().string() + " && " + kOneHal +
                         "rs274 -g -v rs274.var probe_z.ngc > rs274.out 2>&1")
                            .c_str()),
            0);
  EXPECT_THAT(read_text(temporary_folder() / "rs274.out"),
              AllOf(HasSubstr("STRAIGHT_PROBE(100.0000, 50.0000, -23"), HasSubstr("PROGRAM_END"), Not(HasSubstr("rror"))));
  std::istringstream after(read_text(values));
  std::map<int, double> found;
  for (int number = 0; after >> number;) after >> found[number];
  for (const auto& [number, value] : std::map<int, double>{{5223, -10.0},
                                                           {5341, 2.0},
                                                           {5343, -3.0 / 25.4},
                                                           {5381, 4002.0},
                                                           {5382, 50.0},
                                                           {5383, -10.0 - 3.0 / 25.4},
                                                           {5390, 30.0}})
    EXPECT_NEAR(found[number], value, 1e-5) << number;
}

}  // namespace
}  // namespace driftwright::compensation::axis_programs_test
