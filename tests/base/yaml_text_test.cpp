// Edits of YAML text: what is changed, and that nothing else is.

#include "base/yaml_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::yaml_text_test {
namespace {

YamlText yaml(const std::string& text) {
  return YamlText(write_file("yaml_text_test.yaml", text));
}

TEST(YamlText, WithoutEditsIsTheFile) {
  const std::string text = "a: 1 # one\n\nlist:\n  - {b: 2}\n# end\n";
  EXPECT_EQ(yaml(text).text({}), text);
}

TEST(YamlText, SeveralNumbersOfALineAreReplacedInPlace) {
  YamlText y = yaml("m: {a: 1 W, b: 22 K}   # note\n");
  const ConfigNode& m = *y.root().find("m");
  EXPECT_TRUE(y.replace(*m.find("a"), "100 W"));
  EXPECT_TRUE(y.replace(*m.find("b"), "3 K"));
  y.comment(1, "why");
  EXPECT_EQ(y.current(*m.find("a")), "100 W");
  EXPECT_EQ(y.text({"head"}), "# head\nm: {a: 100 W, b: 3 K}   # note   # why\n");
}

TEST(YamlText, AKeyAtTheTopIsRemovedWithItsLinesAndWhatIsBesideItStays) {
  YamlText y = yaml("a: 1\nb:\n  c: [1,\n      2]\n# of d\nd: 3\n");
  EXPECT_FALSE(y.remove("e"));
  EXPECT_TRUE(y.remove("b"));
  EXPECT_EQ(y.text({}), "a: 1\n# of d\nd: 3\n");
  YamlText flow = yaml("{a: 1, b: 2}\n");
  EXPECT_FALSE(flow.remove("b"));
}

TEST(YamlText, AnAnchoredValueThatStandsElsewhereTooIsLeftAlone) {
  YamlText y = yaml("a: &x 5 W\nb: *x\nlist:\n  - &e {c: 1}\n  - *e\n");
  EXPECT_FALSE(y.replace(*y.root().find("a"), "6 W"));
  EXPECT_FALSE(y.replace(*y.root().find("list")->items[0]->find("c"), "2"));
}

TEST(YamlText, AQuotedValueIsReplacedWithItsQuotes) {
  YamlText y = yaml("a: \"5 W\"   # five\nb: {csv: 'it''s, {x}.csv', \"key\": \"say \\\"}\\\" # so\"}\nc: ''\n");
  const ConfigNode& b = *y.root().find("b");
  EXPECT_TRUE(y.replace(*y.root().find("a"), "6 W"));
  EXPECT_TRUE(y.replace(*b.find("csv"), "\"/there/it's.csv\""));
  EXPECT_TRUE(y.replace(*b.find("key"), "no"));
  EXPECT_TRUE(y.replace(*y.root().find("c"), "7"));
  EXPECT_TRUE(y.add_pair(b, "new", "8"));
  EXPECT_EQ(y.text({}), "a: 6 W   # five\nb: {csv: \"/there/it's.csv\", \"key\": no, new: 8}\nc: 7\n");
}

TEST(YamlText, QuotesOfSeveralLinesAreLeftAlone) {
  YamlText y = yaml("a: \"5\n  W\"\n");
  EXPECT_FALSE(y.replace(*y.root().find("a"), "6 W"));
}

TEST(YamlText, APairIsAddedBeforeAQuotedKey) {
  YamlText y = yaml("list:\n  - \"a key\": 1\n    b: 2\n");
  EXPECT_TRUE(y.add_pair(*y.root().find("list")->items[0], "new", "8"));
  EXPECT_EQ(y.text({}), "list:\n  - new: 8\n    \"a key\": 1\n    b: 2\n");
}

TEST(YamlText, APairIsAddedToEitherStyleOfMap) {
  YamlText y = yaml("list:\n  - {a: 1, b: [x, '}']}  # }\n  - c: 3\n    d: 4\n");
  const ConfigNode& list = *y.root().find("list");
  EXPECT_TRUE(y.add_pair(*list.items[0], "new", "7"));
  EXPECT_TRUE(y.add_pair(*list.items[1], "new", "8"));
  EXPECT_EQ(y.text({}), "list:\n  - {a: 1, b: [x, '}'], new: 7}  # }\n  - new: 8\n    c: 3\n    d: 4\n");
}

TEST(YamlText, AnEntryIsAppendedToEitherStyleOfList) {
  YamlText y = yaml("a:\n- {x: 1}\n# of b\nb: [{y: 2}]\nc: []\n");
  EXPECT_TRUE(y.append(*y.root().find("a"), "{x: 2}", "note"));
  EXPECT_TRUE(y.append(*y.root().find("b"), "{y: 3}", ""));
  EXPECT_TRUE(y.append(*y.root().find("c"), "{z: 4}", "why"));
  EXPECT_EQ(y.text({}), "a:\n- {x: 1}\n- {x: 2}   # note\n# of b\nb: [{y: 2},\n  {y: 3}\n]\nc: [\n  {z: 4}   # why\n]\n");
}

TEST(YamlText, AnEntryOfSeveralLinesBecomesAComment) {
  YamlText y = yaml("a:\n  - x: 1\n    y: 2\n  # of the next\n  - x: 3\nb: 1\n");
  EXPECT_TRUE(y.comment_out(*y.root().find("a"), 0));
  EXPECT_EQ(y.text({}), "a:\n#   - x: 1\n#     y: 2\n  # of the next\n  - x: 3\nb: 1\n");
  EXPECT_FALSE(yaml("a: [{x: 1}]\n").comment_out(*yaml("a: [{x: 1}]\n").root().find("a"), 0));
}

}  // namespace
}  // namespace driftwright::yaml_text_test
