#include "base/file_name.hpp"

#include <gtest/gtest.h>

#include "base/delimited_text.hpp"

namespace driftwright::file_name_test {
namespace {

TEST(FileName, ShortNamesStayAsTheyAre) {
  EXPECT_EQ(file_name("monday", ".csv"), "monday.csv");
  EXPECT_EQ(file_name("Gehäuse links", ".csv"), "Gehäuse links.csv");
}

TEST(FileName, LongNamesFitAndStayTwo) {
  const std::string stem(254, 'x');
  const std::string one = file_name(stem + "1", ".csv"), two = file_name(stem + "2", ".csv");
  EXPECT_EQ(one.size(), kLongestFileName);
  EXPECT_EQ(two.size(), kLongestFileName);
  EXPECT_NE(one, two);
  EXPECT_TRUE(one.ends_with(".csv"));
  EXPECT_EQ(file_name(std::string(kLongestFileName - 4, 'x'), ".csv"), std::string(kLongestFileName - 4, 'x') + ".csv");
}

TEST(FileName, IsCutBetweenLetters) {
  for (std::size_t n : {std::size_t(0), std::size_t(1), std::size_t(2)}) {
    std::string stem(n, 'x');
    for (int i = 0; i < 90; ++i) stem += "€";
    const std::string name = file_name(stem, ".ngc");
    EXPECT_LE(name.size(), kLongestFileName);
    EXPECT_EQ(clean_name(name), name) << "half a letter is no UTF-8, and would be taken as Latin-1";
    EXPECT_TRUE(name.starts_with(stem.substr(0, 180)));
  }
}

TEST(FileName, NeitherLeadsElsewhereNorBreaksALine) {
  EXPECT_EQ(file_name("../evil", ".csv"), ".._evil.csv");
  EXPECT_EQ(file_name("a\nG0 X999", ".ngc"), "a G0 X999.ngc");
  EXPECT_EQ(file_name("", ""), "_");
  EXPECT_EQ(file_name("..", ""), "_..");
}

TEST(FileName, IsUtf8) {
  EXPECT_EQ(file_name("Geh\xE4use", ".csv"), "Gehäuse.csv");
}

TEST(Utf8Text, KeepsWhatIsUtf8AndTakesTheRestAsLatin1) {
  EXPECT_EQ(utf8_text("µm of Geh\xE4use €"), "µm of Gehäuse €");
  EXPECT_EQ(utf8_text("\xE4\xE4"), "ää");
  EXPECT_EQ(utf8_text("a\xC3"), "aÃ");
  EXPECT_EQ(utf8_text("line\nline"), "line\nline");
}

TEST(FileName, AnEndingAsLongAsANameIsCutToo) {
  EXPECT_EQ(file_name("a", "." + std::string(250, 'x')).size(), kLongestFileName);
}

}  // namespace
}  // namespace driftwright::file_name_test
