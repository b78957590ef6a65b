// Paths of a scenario that is written to another folder lead to the same files.

#include "scenarios/reader/moved_paths.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "base/config_text.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::scenarios::moved_paths_test {
namespace {

namespace fs = std::filesystem;

TEST(MovedPath, IsRelativeToAFolderThatNeedNotExist) {
  const fs::path top = fresh_folder("moved");
  EXPECT_EQ(moved_path("a.csv", top, top), "a.csv");
  EXPECT_EQ(moved_path("plans/a.csv", top, top / "results/new"), "../../plans/a.csv");
  EXPECT_EQ(moved_path("../b.csv", top / "plans", top / "results"), "../b.csv");
  EXPECT_EQ(moved_path((top / "c.csv").string(), top / "plans", top / "results"), "../c.csv");
  EXPECT_EQ(moved_path("a.csv", top, ""), (top / "a.csv").string());
}

TEST(MovedPath, FollowsALinkToAFolderWhereItMust) {
  const fs::path top = fresh_folder("moved_by_link");
  fs::create_directories(top / "disk/results");
  fs::create_directories(top / "project");
  fs::create_directory_symlink(top / "disk/results", top / "project/results");
  std::ofstream(top / "project/a.csv") << "found";
  const std::string path = moved_path("a.csv", top / "project", top / "project/results");
  EXPECT_EQ(read_text(top / "project/results" / path), "found") << path;  // not ../a.csv, which is in disk/
}

TEST(WithAbsolutePaths, ChangesPathsAlone) {
  const fs::path top = fresh_folder("absolute");
  const ConfigNodePtr tree = with_absolute_paths(
      read_config_text("name: a.csv\ncyclograms: {c: {csv: ../a.csv}}\nlist: [{file: b.csv}, 3]\n", "x.yaml"),
      top / "results/new");
  EXPECT_EQ(tree->find("name")->text, "a.csv");
  EXPECT_EQ(tree->find("cyclograms")->find("c")->find("csv")->text, (fs::canonical(top) / "results/a.csv").string());
  EXPECT_EQ(tree->find("list")->items[0]->find("file")->text, (fs::canonical(top) / "results/new/b.csv").string());
  EXPECT_EQ(tree->find("list")->items[1]->text, "3");
}

}  // namespace
}  // namespace driftwright::scenarios::moved_paths_test
