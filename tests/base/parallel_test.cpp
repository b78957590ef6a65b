#include "base/parallel.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <atomic>
#include <stdexcept>
#include <string>

namespace driftwright::parallel_test {
namespace {

TEST(ForEachIndex, DoesEachOnceAndThrowsTheFirstFailureByIndex) {
  for (int again = 0; again < 50; ++again) {
    std::vector<std::atomic<int>> done(40);
    std::string what;
    try {
      for_each_index(
          done.size(), [] { return 0; },
          [&](std::size_t i, int&) {
            ++done[i];
            if (i == 7 || i == 8 || i == 33) throw std::runtime_error("failed at " + std::to_string(i));
          });
    } catch (const std::runtime_error& e) {
      what = e.what();
    }
    EXPECT_EQ(what, "failed at 7");
    for (const auto& n : done) EXPECT_EQ(n, 1);
  }
}

TEST(ForEachIndex, CarriesAFailureToMakeTheSpace) {
  EXPECT_THROW(for_each_index(
                   3, []() -> int { throw std::logic_error("no space"); }, [](std::size_t, int&) {}),
               std::logic_error);
}

TEST(ParallelFor, GivesASinglePieceAllThreads) {
  bool was_parallel = true;
  parallel_for(1, [&](std::size_t) { was_parallel = omp_in_parallel() != 0; });
  EXPECT_FALSE(was_parallel);
}

TEST(ParallelFor, CarriesWhatAListenerThrows) {
  const auto throwing = [](Listener listener) {
    return [listener] {
      parallel_for(
          20, [](std::size_t) {}, listener);
    };
  };
  EXPECT_THROW(
      throwing({.on_begin = {}, .on_share = [](double) { throw std::runtime_error("share"); }, .wants_end_now = {}})(),
      std::runtime_error);
  EXPECT_THROW(
      throwing({.on_begin = {}, .on_share = {}, .wants_end_now = []() -> bool { throw std::runtime_error("end"); }})(),
      std::runtime_error);
}

TEST(ParallelFor, LeavesOutWhatHasNotBegunOnceAnEndIsWanted) {
  std::atomic<int> n_done = 0;
  parallel_for(1000, [&](std::size_t) { ++n_done; },
               {.on_begin = {}, .on_share = {}, .wants_end_now = [&] { return n_done > 20; }});
  EXPECT_GT(n_done, 20);
  EXPECT_LT(n_done, 200);
}

}  // namespace
}  // namespace driftwright::parallel_test
