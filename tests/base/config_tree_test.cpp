#include "base/config_tree.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::config_tree_test {
namespace {

std::string line_of(const std::string& yaml) {
  return written(*read_config_tree(write_file("tree.yaml", yaml)));
}

TEST(WrittenTree, IsTheSameHoweverTheFileIsLaidOut) {
  const std::string flow = "{name: a b, list: [1, 2 mm, {deep: x}], none: ~}";
  const std::string block = "# a comment\nname: 'a b'   # and one more\nlist:\n  - 1\n\n  - \"2 mm\"\n  - deep: x\nnone:\n";
  EXPECT_EQ(line_of(flow), line_of(block));
  EXPECT_EQ(line_of(flow), line_of(flow));
  EXPECT_NE(line_of(flow), "");
}

TEST(WrittenTree, AnAliasIsWrittenAsWhatItStandsFor) {
  EXPECT_EQ(line_of("{a: &x [1, 2], b: *x}"), line_of("{a: [1, 2], b: [1, 2]}"));
}

TEST(ConfigTree, AliasesThatStandForBillionsAreRefusedWithTheNumber) {
  std::string bomb = "a0: &a0 [x, x, x, x, x, x, x, x, x]\n", chain = "a0: &a0 [x]\n";
  for (int i = 1; i < 12; ++i)
    bomb += fmt::format("a{0}: &a{0} [*a{1}, *a{1}, *a{1}, *a{1}, *a{1}, *a{1}, *a{1}, *a{1}, *a{1}]\n", i, i - 1);
  for (int i = 1; i < 5000; ++i) chain += fmt::format("a{0}: &a{0} [*a{1}]\n", i, i - 1);
  EXPECT_REFUSED(line_of(bomb), "tree.yaml:7:", "1000000 values");
  EXPECT_REFUSED(line_of(chain), "more than 200 deep");
  EXPECT_REFUSED(line_of(std::string(100000, '[')), "tree.yaml", "more than 200 deep");
}

TEST(ConfigTree, ASecondDocumentIsRefusedWithItsLine) {
  EXPECT_REFUSED(line_of("name: x\n---\nname: y\n"), "tree.yaml:2:", "a second YAML document begins here");
  EXPECT_REFUSED(line_of("name: x\n...\n# more\nlist: [1]\n"), "tree.yaml:4:", "a second YAML document begins here");
  EXPECT_EQ(line_of("# one\n---\nname: x\n...\n# the end\n"), line_of("name: x"));
}

TEST(ConfigTree, IsReadFromTheEncodingsOfRecords) {
  EXPECT_EQ(line_of("name: Geh\xE4use"), "{\"name\": \"Geh\xC3\xA4use\"}");  // Latin-1
  EXPECT_EQ(line_of("\xEF\xBB\xBFname: x"), "{\"name\": \"x\"}");
  EXPECT_EQ(line_of(std::string("\xFF\xFEn\0:\0 \0x\0", 10)), "{\"n\": \"x\"}");
  EXPECT_REFUSED(read_config_tree(temporary_folder().string()), "is a folder");
}

TEST(WrittenTree, DiffersWhereTreesDiffer) {
  // Among them texts that look like the tree they are not.
  const std::vector<std::string> trees = {"{a: 1, b: 2}",
                                          "{b: 2, a: 1}",
                                          "{a: 1, b: 3}",
                                          "{a: 1}",
                                          "[a, 1]",
                                          "[[a], 1]",
                                          "[[a, 1]]",
                                          "['a, 1']",
                                          R"(['a", "1'])",
                                          R"(['a\', '1'])",
                                          R"(['a\\', '1'])",
                                          "{a: ''}",
                                          "{a: ~}",
                                          "{a: '~'}",
                                          "{a: []}",
                                          "{a: {}}",
                                          "{a: '[]'}",
                                          R"({a: "x\ny"})",
                                          R"({a: 'x\ny'})",
                                          R"({a: "x y"})",
                                          R"({'a: "1", b': 2})",
                                          R"({'a: {"b"': 2})",
                                          "{a: {b: 2}}",
                                          R"({a: "ä"})",
                                          R"({a: "a"})",
                                          "a",
                                          "~",
                                          "''",
                                          R"({'a, b': 1})"};
  std::set<std::string> lines;
  for (const std::string& tree : trees) EXPECT_TRUE(lines.insert(line_of(tree)).second) << tree << " -> " << line_of(tree);
}

TEST(WrittenTree, IsOneLine) {
  EXPECT_EQ(line_of("{a: \"x\\ny\", b: [\"\\r\", 1]}").find('\n'), std::string::npos);
}

TEST(WrittenTree, AnEditShowsAndItsUndoIsTheSameAgain) {
  const ConfigNodePtr tree = read_config_tree(write_file("edited.yaml", "{a: [1, 2], b: 3}"));
  const std::vector<std::size_t> steps = {0, 1};
  const ConfigNodePtr edited = replaced(tree, steps, scalar_at(*tree, "5")),
                      undone = replaced(edited, steps, scalar_at(*tree, "2"));
  EXPECT_NE(written(*edited), written(*tree));
  EXPECT_EQ(written(*undone), written(*tree));
}

}  // namespace
}  // namespace driftwright::config_tree_test
