#include "output/results_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/errors.hpp"
#include "output/json_text.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::output::results_folder_test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf, ::testing::ElementsAre, ::testing::HasSubstr, ::testing::IsEmpty, ::testing::ThrowsMessage;

std::string read(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

class ResultsFolderTest : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(base_);
    fs::create_directories(base_);
  }
  void TearDown() override { fs::remove_all(base_); }

  [[nodiscard]] ResultsFolder folder(bool force = false) const {
    return ResultsFolder(out_, force, {.version = "1.2.3", .scenario = "a.yaml"});
  }
  void commit_with(const std::string& file, const std::string& text, bool force = false) const {
    ResultsFolder results = folder(force);
    results.write_text(file, text);
    results.commit();
  }
  /// Everything in base_, at any depth, sorted.
  [[nodiscard]] std::vector<std::string> all_files() const {
    std::vector<std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(base_)) {
      if (!entry.is_directory()) found.push_back(entry.path().lexically_relative(base_).string());
    }
    std::sort(found.begin(), found.end());
    return found;
  }

  const fs::path base_ = fs::canonical(::testing::TempDir()) / ("results_folder_test-" + std::to_string(getpid()));
  const fs::path out_ = base_ / "out";
};

TEST_F(ResultsFolderTest, AppearsOnlyWhenCommitted) {
  ResultsFolder results = folder();
  results.write_text("fields/a.txt", "A");
  EXPECT_FALSE(fs::exists(out_));
  results.commit();
  EXPECT_THAT(all_files(), ElementsAre("out/driftwright-manifest.json", "out/fields/a.txt"));
  EXPECT_EQ(read(out_ / "fields/a.txt"), "A");
}

TEST_F(ResultsFolderTest, LeavesNothingWhenNotCommitted) {
  {
    ResultsFolder results(base_ / "new/parent/out", false, {});
    results.write_text("a.txt", "A");
  }
  EXPECT_TRUE(fs::is_empty(base_));
}

TEST_F(ResultsFolderTest, KeepsTheOldResultsWhenNotCommitted) {
  commit_with("a.txt", "old");
  { folder().write_text("a.txt", "new"); }
  EXPECT_EQ(read(out_ / "a.txt"), "old");
  EXPECT_THAT(all_files(), ElementsAre("out/a.txt", "out/driftwright-manifest.json"));
}

TEST_F(ResultsFolderTest, ManifestSaysWhatMadeItAndListsTheFiles) {
  commit_with("b/a.txt", "A");
  const auto manifest = nlohmann::json::parse(read(out_ / kManifestName));
  EXPECT_EQ(manifest["version"], "1.2.3");
  EXPECT_EQ(manifest["scenario"], "a.yaml");
  EXPECT_EQ(manifest["files"], (std::vector<std::string>{"b/a.txt"}));
}

TEST_F(ResultsFolderTest, ReplacesAFolderOfOurOwnResults) {
  commit_with("sub/old.txt", "old");
  commit_with("new.txt", "new");
  EXPECT_THAT(all_files(), ElementsAre("out/driftwright-manifest.json", "out/new.txt"));
}

TEST_F(ResultsFolderTest, TakesAnEmptyFolder) {
  fs::create_directories(out_);
  commit_with("a.txt", "A");
  EXPECT_EQ(read(out_ / "a.txt"), "A");
}

TEST_F(ResultsFolderTest, RefusesAFolderWithOtherFilesAndTouchesNothing) {
  commit_with("a.txt", "A");
  std::ofstream(out_ / "thesis.txt") << "mine";
  EXPECT_THAT([&] { (void)folder(); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("thesis.txt"), HasSubstr("--force"), HasSubstr("-o"))));
  EXPECT_THAT(all_files(), ElementsAre("out/a.txt", "out/driftwright-manifest.json", "out/thesis.txt"));
}

TEST_F(ResultsFolderTest, RefusesFilesBesideAManifestThatIsNotOurs) {
  fs::create_directories(out_);
  for (const char* text : {"{ broken", "[]", R"({"program": 5, "files": 3})"}) {
    std::ofstream(out_ / kManifestName) << text;
    EXPECT_REFUSED(folder(), kManifestName);
  }
}

TEST_F(ResultsFolderTest, ForceReplacesAFolderWithOtherFiles) {
  fs::create_directories(out_);
  std::ofstream(out_ / "thesis.txt") << "mine";
  commit_with("a.txt", "A", /*force=*/true);
  EXPECT_THAT(all_files(), ElementsAre("out/a.txt", "out/driftwright-manifest.json"));
}

TEST_F(ResultsFolderTest, KeepsFilesThatCameDuringTheRun) {
  commit_with("a.txt", "old");
  ResultsFolder results = folder();
  results.write_text("a.txt", "new");
  std::ofstream(out_ / "view.pvsm") << "mine";
  results.commit();
  EXPECT_EQ(read(out_ / "a.txt"), "new");
  EXPECT_EQ(read(out_ / "view.pvsm"), "mine");
}

TEST_F(ResultsFolderTest, RefusesAFile) {
  std::ofstream(out_.string()) << "text";
  for (const bool force : {false, true}) {
    EXPECT_REFUSED(folder(force), "is no folder");
  }
}

TEST_F(ResultsFolderTest, RefusesAParentThatIsAFile) {
  std::ofstream(out_.string()) << "text";
  EXPECT_REFUSED(ResultsFolder(out_ / "x", false, {}), "cannot be used");
}

TEST_F(ResultsFolderTest, RefusesTheCurrentFolderAndThoseAboveItEvenWithForce) {
  for (const char* target : {".", "..", "/"}) {
    EXPECT_REFUSED(ResultsFolder(target, true, {}), "current or the home folder");
  }
  EXPECT_THROW((void)ResultsFolder("", true, {}), InputError);
}

TEST_F(ResultsFolderTest, RefusesAMountPoint) {
  EXPECT_REFUSED(ResultsFolder("/proc", true, {}), "mount point");
}

TEST_F(ResultsFolderTest, TakesALinkForTheFolderItLeadsTo) {
  fs::create_directories(base_ / "disk");
  fs::create_directory_symlink(base_ / "disk", out_);
  commit_with("a.txt", "A");
  EXPECT_TRUE(fs::is_symlink(out_));
  EXPECT_EQ(read(base_ / "disk/a.txt"), "A");
}

TEST_F(ResultsFolderTest, DeletesLinksButNotWhatTheyLeadTo) {
  fs::create_directories(base_ / "elsewhere");
  std::ofstream(base_ / "elsewhere/data.txt") << "mine";
  fs::create_directories(out_);
  fs::create_directory_symlink(base_ / "elsewhere", out_ / "link");
  EXPECT_THROW((void)folder(), InputError);  // the link itself is a file of others
  commit_with("a.txt", "A", /*force=*/true);
  EXPECT_EQ(read(base_ / "elsewhere/data.txt"), "mine");
  EXPECT_FALSE(fs::exists(out_ / "link"));
}

TEST_F(ResultsFolderTest, RemovesPartialFoldersOfDeadProcessesOnly) {
  const pid_t dead = fork();
  if (dead == 0) _exit(0);
  waitpid(dead, nullptr, 0);
  const std::string prefix = out_.string() + ".partial-";
  fs::create_directories(prefix + std::to_string(dead) + "/fields");
  fs::create_directories(prefix + std::to_string(getppid()));
  fs::create_directories(prefix + "notes");
  commit_with("a.txt", "A");
  EXPECT_FALSE(fs::exists(prefix + std::to_string(dead)));
  EXPECT_TRUE(fs::exists(prefix + std::to_string(getppid())));
  EXPECT_TRUE(fs::exists(prefix + "notes"));
}

TEST_F(ResultsFolderTest, RefusesPathsThatLeadOutOfTheFolder) {
  ResultsFolder results = folder();
  for (const char* bad : {"", "/etc/x", "../x", "a/../../x", "a/"}) {
    EXPECT_THROW((void)results.path(bad), std::logic_error) << bad;
  }
  results.commit();
  EXPECT_THROW((void)results.path("late.txt"), std::logic_error);
}

TEST_F(ResultsFolderTest, AFullDiskIsNoticedAndNamed) {
  ResultsFolder results = folder();
  fs::create_symlink("/dev/full", results.path("a.txt"));
  EXPECT_THAT([&] { results.write_text("a.txt", "A"); },
              ThrowsMessage<std::runtime_error>(AllOf(HasSubstr("a.txt"), HasSubstr("No space left"))));
}

TEST(JsonText, RoundsToSixDigitsAndWritesNanAsNull) {
  const nlohmann::ordered_json value = {
      {"z", 0.1 + 0.2}, {"a", {1234567.0, std::numeric_limits<double>::quiet_NaN()}}, {"n", 123456789}};
  EXPECT_EQ(nlohmann::ordered_json::parse(json_text(value)).dump(), R"({"z":0.3,"a":[1234570.0,null],"n":123456789})");
  EXPECT_EQ(nlohmann::ordered_json::parse(json_text(4.9e-324)).get<double>(),
            4.9e-324);  // such as the odds of what is out of the question
}

}  // namespace
}  // namespace driftwright::output::results_folder_test
