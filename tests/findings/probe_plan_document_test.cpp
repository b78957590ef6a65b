// What the document of a plan of probings says first.

#include "findings/probe_plan_document.hpp"

#include <gmock/gmock.h>

namespace driftwright::findings::probe_plan_document_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// Work of an hour for each place, which is at its start, with a drift that is not known there.
studies::ProbePlan plan_of(int n_places, double tolerance_um) {
  const studies::ProbedAxis axis{.process = {5.0, 7200.0}, .probe = {.noise_um = 1e-6}};
  studies::ProbeJob job{.name = "job", .work = {{0.0, 3600.0 * n_places}}};
  for (int k = 0; k < n_places; ++k) job.places.push_back({.time_s = 3600.0 * k, .where = "halt"});
  studies::ProbePlan plan = studies::plan_probings(job, axis, tolerance_um, 0.0);
  plan.target = "nose_z";
  return plan;
}

std::string verdict_of(const studies::ProbePlan& plan) {
  const output::Document document = document_of(plan, scenarios::Scenario(), {}, {});
  for (const output::Block& block : document.body.blocks) {
    if (const auto* verdict = std::get_if<output::Verdict>(&block)) return verdict->title + ": " + verdict->text;
  }
  return "";
}

// An hour after an exact probing the half width is 9.8 sqrt(1 - exp(-1)) = 7.79 um, after two hours 9.11 um.
TEST(ProbePlanDocument, ComparesWithEqualIntervalsFromTwoProbingsOn) {
  EXPECT_THAT(verdict_of(plan_of(1, 8.0)),
              AllOf(HasSubstr("1 probing keeps the tolerance"), Not(HasSubstr("qual intervals"))));
  EXPECT_THAT(verdict_of(plan_of(3, 8.0)),
              AllOf(HasSubstr("3 probings keep the tolerance"), HasSubstr("At equal intervals")));
}

TEST(ProbePlanDocument, QuotesTheLeastThatAnyNumberOfProbingsReaches) {
  EXPECT_THAT(verdict_of(plan_of(60, 4.0)),
              AllOf(HasSubstr("No number of probings keeps the tolerance"),
                    HasSubstr("With 60 probings the largest half width of the 95 % interval is still 7.8")));
}

}  // namespace
}  // namespace driftwright::findings::probe_plan_document_test
