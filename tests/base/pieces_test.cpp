#include "base/pieces.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <mutex>

#include "base/errors.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::pieces_test {
namespace {

using ::testing::ElementsAre, ::testing::IsEmpty;

TEST(Pieces, OfAShardAreAsItSaysAndEachIsSomeShards) {
  EXPECT_TRUE(read_shard("").is_all());
  for (std::size_t piece = 0; piece < 20; ++piece) {
    int n = 0;
    for (const char* text : {"1/3", "2/3", "3/3"}) n += read_shard(text).has(piece) ? 1 : 0;
    EXPECT_EQ(n, 1) << piece;
  }
  for (const char* wrong : {"0/3", "4/3", "3", "/3", "1/", "a/b", "-1/2", "1/2/3"})
    EXPECT_REFUSED(read_shard(wrong), "--shard '" + std::string(wrong) + "'") << wrong;
}

TEST(Pieces, AreWorkedOutOnceAndFoundAgain) {
  std::map<std::size_t, Pieces::Numbers> kept;
  std::mutex lock;
  int n_worked = 0, n_prepared = 0;
  const auto pieces = [&](const char* shard) {
    Pieces p{.shard = read_shard(shard)};
    p.find = [&](std::size_t i) { return kept.contains(i) ? std::optional(kept.at(i)) : std::nullopt; };
    p.keep = [&](std::size_t i, const Pieces::Numbers& numbers) {
      const std::lock_guard guard(lock);
      EXPECT_TRUE(kept.emplace(i, numbers).second) << "twice: " << i;
    };
    return p;
  };
  const auto work = [&](std::size_t i) {
    const std::lock_guard guard(lock);
    ++n_worked;
    return Pieces::Numbers{static_cast<double>(i)};
  };
  const auto prepare = [&] { ++n_prepared; };
  EXPECT_THAT(pieces("2/3").of_shard(100, 5, prepare, work),
              ElementsAre(IsEmpty(), ElementsAre(1.0), IsEmpty(), IsEmpty(), ElementsAre(4.0)));
  EXPECT_EQ(n_worked, 2);
  EXPECT_EQ(kept.count(101) + kept.count(104), 2u);
  // Another shard needs all of them: its own first, then what is missing, and not what the other has done.
  EXPECT_EQ(pieces("1/3").from(100).of_all(0, 5, prepare, work).size(), 5u);
  EXPECT_EQ(n_worked, 5);
  EXPECT_EQ(n_prepared, 3);
  EXPECT_THAT(pieces("").of_shard(100, 5, prepare, work)[4], ElementsAre(4.0));
  EXPECT_EQ(n_prepared, 3);
  EXPECT_THAT(pieces("1/2").of(104, [&] { return work(9); }), ElementsAre(4.0));
  // What was cut short is not kept.
  EXPECT_THAT(
      pieces("1/2").of(200, [&] { return work(9); }, {.on_begin = {}, .on_share = {}, .wants_end_now = [] { return true; }}),
      ElementsAre(9.0));
  EXPECT_FALSE(kept.contains(200));
}

}  // namespace
}  // namespace driftwright::pieces_test
