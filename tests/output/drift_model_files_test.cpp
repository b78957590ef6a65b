// A formula as text.

#include "output/drift_model_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/shared/deployed_model.hpp"

namespace driftwright::output::drift_model_files_test {
namespace {

using compensation::DriftModel;
using fixtures::deployed;
using ::testing::HasSubstr;

TEST(FormulaText, SaysUnitsRangesAndLimits) {
  DeployedModel d = deployed(true, 60.0);
  const std::string text = formula_text(d);
  for (const char* part : {"drift_y [um] =", "um/degC", "um/rpm^2", "LAG(13 min, (X1 - X1 at start))",
                           "+ 3 um * LAG(9 min, ON(spindle))", "+ 0.4 um * ON(spindle)\n", "ON(x): 1 while x is not 0",
                           "<= X1 - start <=", "<= spindle <=", "um/min", "95 % of the drift"})
    EXPECT_THAT(text, HasSubstr(part));
  d.interval_um = NAN;
  EXPECT_EQ(formula_text(d).find("95 %"), std::string::npos);
  std::erase_if(d.model.terms, [](const DriftModel::Term& t) { return t.is_running; });
  EXPECT_EQ(formula_text(d).find("ON("), std::string::npos);
}

}  // namespace
}  // namespace driftwright::output::drift_model_files_test
