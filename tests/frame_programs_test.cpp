// The thermal frame as programs of controls; LinuxCNC's is read by its own interpreter, where that is installed.

#include "compensation/frame_programs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "tests/temporary_file.hpp"

namespace driftwright::compensation {
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

std::string file(const std::string& name) {
  for (const ProgramFile& f : frame_programs(program())) {
    if (f.name == name) return f.text;
  }
  return "no such file";
}

TEST(FrameProgram, GivesSiemensTheSlopeInSettingData) {
  EXPECT_THAT(file("siemens/THERMDATA.SPF"),
              AllOf(HasSubstr("$SA_TEMP_COMP_SLOPE[AX1]=0.000132 "), HasSubstr("$SA_TEMP_COMP_ABS_VALUE[AX1]=0.012 "),
                    HasSubstr("$SA_TEMP_COMP_REF_POSITION[AX1]=100.000 "), HasSubstr("MD32750"), HasSubstr("MD32760"),
                    HasSubstr("follows at 300 mm/min")));
}

TEST(FrameProgram, ChainsTheSiemensFrameAsWeDo) {
  const std::string text = file("siemens/THERMFRAME.SPF");
  EXPECT_THAT(text, AllOf(HasSubstr("TEMP_SCALE=(X2N-X1N)/(X2-X1)"), HasSubstr("TEMP_SHIFT=X1N/TEMP_SCALE-X1"),
                          HasSubstr(":CROT(Z,TURN,Y,TILT):CSCALE(X,TEMP_SCALE):CTRANS(X,TEMP_SHIFT)"),
                          HasSubstr("ABS(TEMP_SCALE-1)>0.001"), HasSubstr("$P_BFRAME=CTRANS()  ")));
  EXPECT_THAT(file("siemens/RINGMEAS.SPF"), AllOf(HasSubstr("MEAS=1"), HasSubstr("$AA_MM[X]"), HasSubstr("wrong side")));
  EXPECT_THAT(file("heidenhain/THERMFRAME.H"),
              AllOf(HasSubstr("TCH PROBE 421"), HasSubstr("CYCL DEF 26.1 XQ20 CCX+0"), HasSubstr("CYCL DEF 7.1 X+Q21")));
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
  const std::string path = write_file("thermframe.ngc", file("linuxcnc/thermframe.ngc"));
  EXPECT_EQ(std::system(("cd " + temporary_folder().string() + " && rs274 -g thermframe.ngc > rs274.out 2>&1").c_str()), 0);
  const std::string said = read_text(temporary_folder() / "rs274.out");
  EXPECT_THAT(said, AllOf(HasSubstr("STRAIGHT_PROBE(-4775"), HasSubstr("PROGRAM_END"), HasSubstr("SET_G5X_OFFSET(1"),
                          Not(HasSubstr("rror"))));
  std::size_t n_probes = 0;
  for (std::size_t at = said.find("STRAIGHT_PROBE"); at != std::string::npos; at = said.find("STRAIGHT_PROBE", at + 1))
    ++n_probes;
  EXPECT_EQ(n_probes, 10u);
}

TEST(FrameProgram, WantsTwoRings) {
  FrameProgram p = program();
  p.rings.pop_back();
  EXPECT_THROW((void)frame_programs(p), std::logic_error);
}

}  // namespace
}  // namespace driftwright::compensation
