#include "output/rows_under_way.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>

#include "base/errors.hpp"
#include "base/file_bytes.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::output::rows_under_way_test {
namespace {

using ::testing::ElementsAre, ::testing::HasSubstr, ::testing::Pair, ::testing::ThrowsMessage;

/// A row as a line of the file.
std::string line(const std::string& row) {
  return row + "\t" + content_hash(row) + "\n";
}

const RowsIdentity kIdentity{"0123abcd", "member,a"};

TEST(RowsUnderWay, AreFoundAgainWithoutALineCutShort) {
  const auto folder = fresh_folder("found") / "parts";
  {
    RowsUnderWay file(folder, "sweep.csv", kIdentity);
    file.append("2,b");
    file.append("1,a");
  }
  std::ofstream(folder / "sweep.csv.partial", std::ios::app) << "3,torn";
  EXPECT_THAT(find_rows(folder, kIdentity), ElementsAre(Pair(1, "1,a"), Pair(2, "2,b")));
  {
    RowsUnderWay file(folder, "sweep.csv", kIdentity);
    EXPECT_FALSE(file.dropped_stale());
    file.append("3,c");
  }
  EXPECT_EQ(read_text(folder / "sweep.csv.partial"),
            "# rows of 0123abcd\nmember,a\n" + line("2,b") + line("1,a") + line("3,c"));
}

TEST(RowsUnderWay, OfAnotherContentOrHeaderAreStale) {
  const auto folder = fresh_folder("stale") / "parts";
  RowsUnderWay(folder, "sweep.csv", kIdentity).append("1,a");
  for (const RowsIdentity& other : {RowsIdentity{"ffff", "member,a"}, RowsIdentity{"0123abcd", "member,b"}}) {
    EXPECT_TRUE(find_rows(folder, other).empty());
  }
  RowsUnderWay file(folder, "sweep.csv", {"ffff", "member,a"});
  EXPECT_TRUE(file.dropped_stale());
  EXPECT_EQ(read_text(folder / "sweep.csv.partial"), "# rows of ffff\nmember,a\n");
}

TEST(RowsUnderWay, AStartCutShortIsBegunAnew) {
  const auto folder = fresh_folder("short");
  std::ofstream(folder / "sweep.csv.partial") << "# rows of 0123";
  RowsUnderWay file(folder, "sweep.csv", kIdentity);
  EXPECT_FALSE(file.dropped_stale());
  EXPECT_EQ(read_text(folder / "sweep.csv.partial"), "# rows of 0123abcd\nmember,a\n");
}

TEST(RowsUnderWay, ThatAreNotAsTheyWereWrittenDoNotCount) {
  const auto folder = fresh_folder("damaged") / "parts";
  {
    RowsUnderWay file(folder, "sweep.csv", kIdentity);
    for (const char* row : {"1,4.25", "2,4.25", "3,4.25"}) file.append(row);
  }
  std::string text = read_text(folder / "sweep.csv.partial");
  text[text.find("2,4.25") + 2] = '8';  // a plausible number
  text += "4,4.25\n";                   // as of a version that wrote no hash
  std::ofstream(folder / "sweep.csv.partial") << text;
  std::size_t n_damaged = 0;
  EXPECT_THAT(find_rows(folder, kIdentity, &n_damaged), ElementsAre(Pair(1, "1,4.25"), Pair(3, "3,4.25")));
  EXPECT_EQ(n_damaged, 2u);
}

TEST(RowsUnderWay, OfAllPartsComeTogetherAndFinishedOnesAreInOrder) {
  const auto folder = fresh_folder("together");
  RowsUnderWay first(folder, "sweep.1of2.csv", kIdentity), second(folder, "sweep.2of2.csv", kIdentity);
  first.append("3,c");
  first.append("1,a");
  second.append("2,b");
  first.finish({{1, "1,a"}, {3, "3,c"}});
  EXPECT_EQ(read_text(folder / "sweep.1of2.csv"), "# rows of 0123abcd\nmember,a\n" + line("1,a") + line("3,c"));
  EXPECT_FALSE(std::filesystem::exists(folder / "sweep.1of2.csv.partial"));
  EXPECT_THAT(find_rows(folder, kIdentity), ElementsAre(Pair(1, "1,a"), Pair(2, "2,b"), Pair(3, "3,c")));
}

TEST(RowsUnderWay, OfOnePartAreOneProcessesAtATime) {
  const auto folder = fresh_folder("locked");
  std::optional<RowsUnderWay> file(std::in_place, folder, "sweep.csv", kIdentity);
  EXPECT_THAT([&] { RowsUnderWay again(folder, "sweep.csv", kIdentity); },
              ThrowsMessage<InputError>(HasSubstr("another process is working on these rows")));
  file.reset();
  EXPECT_NO_THROW(RowsUnderWay again(folder, "sweep.csv", kIdentity));
}

TEST(RemoveRows, SparesWhatIsWrittenToAndWhatIsNotOurs) {
  const auto folder = fresh_folder("removed");
  std::optional<RowsUnderWay> busy(std::in_place, folder, "sweep.1of2.csv", kIdentity);
  std::ofstream(folder / "sweep.2of2.csv") << "x";
  std::ofstream(folder / "notes.csv") << "mine";
  remove_rows(folder);
  EXPECT_TRUE(std::filesystem::exists(folder / "sweep.1of2.csv.partial"));
  EXPECT_FALSE(std::filesystem::exists(folder / "sweep.2of2.csv"));
  busy.reset();
  remove_rows(folder);
  EXPECT_EQ(read_text(folder / "notes.csv"), "mine");
  std::filesystem::remove(folder / "notes.csv");
  remove_rows(folder);
  EXPECT_FALSE(std::filesystem::exists(folder));
}

}  // namespace
}  // namespace driftwright::output::rows_under_way_test
