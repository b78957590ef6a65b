// `driftwright inject` as a user runs it.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <thread>

#include "base/random.hpp"
#include "tests/app/inject_filter.hpp"

namespace driftwright::inject_verb_test {
namespace {

using ::testing::AllOf, ::testing::HasSubstr, ::testing::StartsWith;

std::string file(const std::string& name, const std::string& text) {
  return write_file(name, text);
}

TEST(InjectVerb, InsertsCyclesBehindRowsWhereBothAreLow) {
  const std::string c = file("two.csv", "# by hand\nrow,nose_um\n2,2\n");
  const Filtered f = inject("two", "--period '1 um' --correction " + c, "0 0\n1 0\n1 1\n0 1\n0 0\n1 0\n");
  EXPECT_EQ(f.exit_code, 0);
  EXPECT_EQ(f.rows,
            "0 0\n1 0\n1 1\n0 1\n0 0\n1 0\n1 1\n0 1\n0 0\n1 0\n");  // one cycle after row 5; the other finds no low row
  EXPECT_THAT(f.words, HasSubstr("encoder +5, inserted +4 of +8, control +9"));
}

// Sign by value: a tool +5 um too far, 1 um a count: 5 counts forward; at x4 with 4 um a cycle that is a cycle and a rest
// of one count, which a quarter brings in.
TEST(InjectVerb, UnitsAndCounts) {
  const std::string rows = row_text(legs({400}));
  const std::string um = file("um.csv", "row,e_um\n1,5\n"), count = file("count.csv", "row,e_count\n1,5\n");
  const auto control = [&](const std::string& arguments) {
    return counted(inject("units", arguments, rows).rows).count() - 400;
  };
  EXPECT_EQ(control("--period '4 um' --correction " + um), 4);
  EXPECT_EQ(control("--period '4 um' --insert quarter --correction " + um), 5);
  EXPECT_EQ(control("--period '0.004 mm' --insert quarter --correction " + um), 5);
  EXPECT_EQ(control("--insert quarter --correction " + count), 5);
  EXPECT_EQ(control("--counts x1 --correction " + count), 20);  // five whole cycles
  EXPECT_EQ(control("--counts x2 --insert half --correction " + count), 10);
}

// 11 um are two whole cycles of 4 um, and 11 counts in quarters of 1 um.
TEST(InjectVerb, ALargerCorrectionIsHeldAtTheLimit) {
  const std::string rows = row_text(legs({400}));
  const std::string up = file("up.csv", "row,e_um\n1,50\n"), down = file("down.csv", "row,e_um\n1,-50\n"),
                    small = file("small.csv", "row,e_um\n1,8\n");
  const auto filtered = [&](const std::string& arguments) { return inject("limit", "--period '4 um' " + arguments, rows); };
  const Filtered limited = filtered("--limit '11 um' --correction " + up);
  EXPECT_EQ(counted(limited.rows).count(), 400 + 8);
  EXPECT_THAT(limited.words, HasSubstr("larger than --limit 11 um"));
  EXPECT_EQ(counted(filtered("--limit '11 um' --insert quarter --correction " + up).rows).count(), 400 + 11);
  EXPECT_EQ(counted(filtered("--limit '11 um' --insert quarter --correction " + down).rows).count(), 400 - 11);
  EXPECT_THAT(filtered("--limit '11 um' --correction " + small).words, ::testing::Not(HasSubstr("--limit")));
  const Filtered no_period =
      inject("limit_alone", "--limit '11 um' --correction " + file("n.csv", "row,e_count\n1,5\n"), rows);
  EXPECT_EQ(no_period.exit_code, 2);
  EXPECT_THAT(no_period.words, HasSubstr("--limit requires --period"));
}

TEST(InjectVerb, ACorrectionByTimeHoldsFromItsTimeOn) {
  // Row i is at (i - 1) ms; rows 1, 5, ... are low. Row 42 is just past a low one, row 81 is one: neither early nor late
  // would do. Cycles against the motion, for those with it look the same at any position.
  const std::string rows = row_text(legs({120}));
  const std::string by_time = file("time.csv", "time_s,e_um\n0,0\n0.041,-3\n0.08,-4\n"),
                    by_row = file("row.csv", "row,e_um\n1,0\n42,-3\n81,-4\n");
  const Filtered a = inject("time", "--period '1 um' --row-time '1 ms' --correction " + by_time, rows);
  const Filtered b = inject("row", "--period '1 um' --correction " + by_row, rows);
  EXPECT_EQ(a.rows, b.rows);
  EXPECT_EQ(counted(a.rows).count(), 120 - 16);
}

TEST(InjectVerb, BypassIsTheIdentityByteForByte) {
  Random random(11);
  std::string rows;
  for (int i = 0; i < 50000; ++i) rows += random.chance(0.1) ? "0\t 1\r\n" : random.chance(0.5) ? "1 0\n" : "1 1\n";
  rows += "0 0";  // without its line break
  const std::string c = file("c.csv", "row,e_um\n1,50\n");
  const Filtered f = inject("bypass", "--bypass --period '1 um' --correction " + c, rows);
  EXPECT_EQ(f.exit_code, 0);
  EXPECT_TRUE(f.rows == rows);
  EXPECT_THAT(f.words, HasSubstr("jumps of both lines"));
}

// One row out for each row in: a cycle takes four rows while the encoder rests, and finds no room where it does not.
TEST(InjectVerb, ClockedItGivesARowForARow) {
  const std::string c = file("c.csv", "row,e_um\n1,3\n");
  const Filtered slow = inject("slow", "--clocked --period '1 um' --correction " + c, row_text(legs({40, -40}), 6));
  EXPECT_EQ(slow.rows.size(), 4u * 81u * 6u);
  EXPECT_EQ(counted(slow.rows).count(), 12);
  EXPECT_EQ(counted(slow.rows).n_jumps(), 0);
  const Filtered fast = inject("fast", "--clocked --period '1 um' --correction " + c, row_text(legs({40, -40}), 4));
  EXPECT_EQ(counted(fast.rows).count(), 0);
  EXPECT_THAT(
      fast.words,
      AllOf(HasSubstr("inserted +0 of +12"),
            HasSubstr(
                "nothing was inserted: an insertion requires 5 rows with both lines low, but the longest stretch had 4")));
  EXPECT_THAT(slow.words, Not(HasSubstr("nothing was inserted")));
}

// At the turn the encoder rests twice as long: one insertion fits there, and the missing rest is reported.
TEST(InjectVerb, ClockedItTellsWhatFoundNoRoom) {
  const std::string c = file("c.csv", "row,e_um\n1,3\n");
  std::string rows = row_text(legs({40, -40}), 4) + row_text({0}, 6) + row_text(legs({40}), 4);
  const Filtered f = inject("missing", "--clocked --period '1 um' --correction " + c, rows);
  EXPECT_EQ(f.exit_code, 0);
  EXPECT_THAT(f.words, Not(HasSubstr("nothing was inserted")));
  const Filtered anywhere =
      inject("anywhere", "--clocked --anywhere --period '1 um' --correction " + c, row_text(legs({40}), 3));
  EXPECT_THAT(
      anywhere.words,
      HasSubstr("nothing was inserted: an insertion requires 5 rows between two edges, but the longest stretch had 3"));
}

TEST(InjectVerb, ClockedItCompletesWhatHasBegunWhenTheInputEnds) {
  const std::string c = file("c.csv", "row,e_um\n1,1\n");
  const Filtered f = inject("cut", "--clocked --period '1 um' --correction " + c, row_text({0}, 7));
  EXPECT_EQ(counted(f.rows).count(), 4);
  EXPECT_EQ(f.rows.size(), 4u * 9u);  // begins at row 6, five rows after the first; four steps
}

TEST(InjectVerb, TheIndexColumnIsKept) {
  const std::string c = file("c.csv", "row,e_um\n1,1\n");
  const Filtered f = inject("index", "--period '1 um' --correction " + c, "0 1 0\n0 0 1\n1 0 0\n");
  EXPECT_EQ(f.rows, "0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n0 0 1\n1 0 0\n");
}

TEST(InjectVerb, AFaultIsToldAndTheCorrectionWaits) {
  std::vector<compensation::Lines> rows = legs({100});
  rows.erase(rows.begin() + 50);
  const std::string c = file("c.csv", "row,e_um\n1,3\n");
  const Filtered f = inject("fault", "--period '1 um' --correction " + c, row_text(rows));
  EXPECT_EQ(f.exit_code, 0);
  EXPECT_THAT(f.words, AllOf(HasSubstr("1 jumps of both lines at once"), HasSubstr("encoder +100, inserted +12 of +12")));
  EXPECT_EQ(counted(f.rows).count(), 112);
  EXPECT_EQ(counted(f.rows).n_jumps(), 0);
}

TEST(InjectVerb, TheLogKeepsTheLedger) {
  const std::string c = file("c.csv", "row,e_um\n1,3\n60,-2\n");
  const Filtered f = inject("log", "--period '1 um' --log log.csv --vcd v.vcd --correction " + c, row_text(legs({90, -30})));
  std::istringstream log(read_text(temporary_folder() / "log" / "log.csv"));
  std::string line, last;
  int n = 0;
  while (std::getline(log, line)) {
    long long row, out, in, wished, inserted, control, jumps;
    if (std::sscanf(line.c_str(), "%lld,%lld,%lld,%lld,%lld,%lld,%lld", &row, &out, &in, &wished, &inserted, &control,
                    &jumps) != 7)
      continue;
    EXPECT_EQ(in + inserted, control) << line;
    last = line;
    ++n;
  }
  EXPECT_EQ(n, 1 + 2 + 1 + 5 + 1);  // three cycles forward, the first at once; a new wish, five back; the end
  EXPECT_THAT(last, StartsWith("121,"));
}

TEST(InjectVerb, ReadsAPipeAndAnswersEachRowAtOnce) {
  const auto folder = fresh_folder("live");
  const std::string fifo = (folder / "correction").string(), rows_in = (folder / "in").string(),
                    rows_out = (folder / "out").string();
  for (const std::string& path : {fifo, rows_in, rows_out}) ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  const std::string command = std::string(DRIFTWRIGHT_PROGRAM) + " inject --period '1 um' --correction " + fifo + " <" +
                              rows_in + " >" + rows_out + " 2>/dev/null &";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const int in = open(rows_in.c_str(), O_WRONLY), out = open(rows_out.c_str(), O_RDONLY);
  const auto say = [](int to, const std::string& text) {
    return write(to, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  };
  const auto hear = [&](std::size_t n) {
    std::string text(n, ' ');
    std::size_t have = 0;
    while (have < n) {
      const ssize_t got = read(out, text.data() + have, n - have);
      if (got <= 0) break;
      have += static_cast<std::size_t>(got);
    }
    return text.substr(0, have);
  };
  ASSERT_TRUE(say(in, "0 0\n"));
  EXPECT_EQ(hear(4), "0 0\n");  // the filter waits for no more; and it has opened the pipe
  const int correction = open(fifo.c_str(), O_WRONLY);
  ASSERT_TRUE(say(correction, "1\n"));
  ASSERT_TRUE(say(in, "0 0\n"));
  EXPECT_EQ(hear(20), "0 0\n1 0\n1 1\n0 1\n0 0\n");
  ASSERT_TRUE(say(correction, "0\n"));
  ASSERT_TRUE(say(in, "0 0\n"));
  EXPECT_EQ(hear(20), "0 0\n0 1\n1 1\n1 0\n0 0\n");
  close(in);
  EXPECT_EQ(hear(4), "");
  close(out);
  close(correction);
}

TEST(InjectVerb, EndsQuietlyWhenNobodyReads) {
  const std::string c = file("c.csv", "row,e_um\n1,3\n");
  const std::string rows = file("many.txt", row_text(legs({200000})));
  const int status =
      std::system(("bash -c 'set -o pipefail; " + std::string(DRIFTWRIGHT_PROGRAM) +
                   " inject --period \"1 um\" --correction " + c + " <" + rows + " 2>/dev/null | head -1 >/dev/null'")
                      .c_str());
  EXPECT_EQ(status, 0);
}

TEST(InjectVerb, BypassAnswersTheRowsBeforeABadOne) {
  const std::string c = file("c.csv", "row,e_um\n1,3\n");
  const Filtered f = inject("bypass_bad", "--strict --bypass --period '1 um' --correction " + c, "0 0\n0\t1\r\n0 2\n1 0\n");
  EXPECT_EQ(f.exit_code, 2);
  EXPECT_EQ(f.rows, "0 0\n0\t1\r\n");
  EXPECT_THAT(f.words, HasSubstr("line 3: '0 2'"));
}

// An invalid row counts as the one before it: the axis rests for that row. There is none before the first.
TEST(InjectVerb, ABadRowHoldsIsCountedAndLogged) {
  const std::string c = file("c.csv", "row,e_um\n1,0\n");
  const Filtered f =
      inject("bad_row", "--period '1 um' --log log.csv --correction " + c, "x\n0 0\n1 0\n1 2\n\n1 1\n0 1 1\n0 1\n");
  EXPECT_EQ(f.exit_code, 0);
  EXPECT_EQ(f.rows, "0 0\n1 0\n1 0\n1 0\n1 1\n1 1\n0 1\n");
  EXPECT_THAT(f.words, AllOf(HasSubstr("line 4: '1 2'"), HasSubstr("4 rows and 0 corrections were invalid"),
                             HasSubstr("encoder +3")));
  EXPECT_THAT(read_text(temporary_folder() / "bad_row" / "log.csv"), HasSubstr("# fault at row"));
  const Filtered raw = inject("bad_raw", "--bypass --period '1 um' --correction " + c, "0 0\n0 2\n1 0\n");
  EXPECT_EQ(raw.rows, "0 0\n0 2\n1 0\n");  // a wire
  EXPECT_EQ(raw.exit_code, 0);
}

/// Rows and corrections that come while the filter runs: it answers each row before the next is said. @returns its rows
std::string said_live(const std::string& name, const std::string& arguments,
                      const std::vector<std::pair<std::string, std::string>>& correction_then_row) {
  const auto folder = fresh_folder(name);
  const std::string fifo = (folder / "correction").string(), rows_in = (folder / "in").string(),
                    rows_out = (folder / "out").string();
  for (const std::string& path : {fifo, rows_in}) EXPECT_EQ(mkfifo(path.c_str(), 0600), 0);
  const std::string command = std::string(DRIFTWRIGHT_PROGRAM) + " inject --period '1 um' " + arguments + " --correction " +
                              fifo + " <" + rows_in + " >" + rows_out + " 2>" + (folder / "words").string() + "; echo $? >" +
                              (folder / "code").string();
  std::thread filter([&] { EXPECT_EQ(std::system(command.c_str()), 0); });
  const int in = open(rows_in.c_str(), O_WRONLY);
  int correction = -1;
  while ((correction = open(fifo.c_str(), O_WRONLY | O_NONBLOCK)) < 0) usleep(1000);
  const auto say = [](int to, const std::string& text) {
    EXPECT_EQ(write(to, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  };
  std::size_t answered = 0;
  for (const auto& [wish, row] : correction_then_row) {
    if (!wish.empty()) say(correction, wish + "\n");
    say(in, row + "\n");
    for (int i = 0; i < 10000 && std::filesystem::file_size(rows_out) <= answered; ++i) usleep(1000);
    usleep(20000);
    answered = std::filesystem::file_size(rows_out);
  }
  close(in);
  close(correction);
  filter.join();
  EXPECT_EQ(read_text(folder / "code"), "0\n") << read_text(folder / "words");
  return read_text(rows_out);
}

constexpr const char *kForward = "0 0\n1 0\n1 1\n0 1\n0 0\n", *kBack = "0 0\n0 1\n1 1\n1 0\n0 0\n", *kStay = "0 0\n";

TEST(InjectVerb, ABadCorrectionHoldsOrWithdrawsTheLastOne) {
  EXPECT_EQ(said_live("held", "--on-fault hold", {{"1", "0 0"}, {"nonsense", "0 0"}, {"nan", "0 0"}, {"0", "0 0"}}),
            std::string(kForward) + kStay + kStay + kBack);
  EXPECT_EQ(said_live("withdrawn", "--on-fault bypass", {{"1", "0 0"}, {"nonsense", "0 0"}, {"nan", "0 0"}, {"1", "0 0"}}),
            std::string(kForward) + kBack + kStay + kForward);
}

TEST(InjectVerb, ReadsWhatFollowWrites) {
  const std::string one = R"({"state":"on","axes":{"drift_y":{"correction_um":1}}})",
                    two = R"({"state":"on","axes":{"drift_x":{"correction_um":7},"drift_y":{"correction_um":0}}})";
  EXPECT_EQ(said_live("followed", "--column drift_y", {{one, "0 0"}, {two, "0 0"}}), std::string(kForward) + kBack);
  EXPECT_EQ(said_live("followed_one", "", {{one, "0 0"}, {two, "0 0"}}), std::string(kForward) + kStay);  // which axis?
}

// corrected.csv as `compensate` writes it: the correction is `predicted_um`.
TEST(InjectVerb, ReadsTheTableThatCompensateWrites) {
  const std::string c =
      file("corrected.csv", "# driftwright\ntime_s,drift_um,predicted_um,left_um,at_rest\n0,9,1,8,1\n0.004,9,0,9,0\n");
  const std::string by_name =
      inject("corrected", "--period '1 um' --row-time '1 ms' --correction " + c, "0 0\n0 0\n0 0\n0 0\n0 0\n").rows;
  EXPECT_EQ(by_name, std::string(kForward) + kStay + kStay + kStay + kBack);
  const std::string left =
      inject("left", "--period '1 um' --row-time '1 ms' --column left_um --correction " + c, "0 0\n").rows;
  EXPECT_EQ(left.substr(0, 20), kForward);
}

/// `driftwright inject` by a shell line that says where its streams go.
CommandOutcome inject_with(const std::string& name, const std::string& arguments) {
  const auto folder = fresh_folder(name);
  write_file(name + "/c.csv", "row,e_um\n1,3\n");
  write_file(name + "/in.txt", row_text(legs({40})));
  return run_program("--version >" + (folder / "version").string() + "; cd " + folder.string() + " && (timeout 20 " +
                     DRIFTWRIGHT_PROGRAM + " inject --period '1 um' " + arguments + ")");
}

TEST(InjectVerb, AClosedOrFullOutputIsTold) {
  const CommandOutcome full = inject_with("full", "--correction c.csv <in.txt 2>&1 >/dev/full");
  EXPECT_EQ(full.exit_code, 2);
  EXPECT_THAT(full.output, HasSubstr("standard output: No space left"));
  const CommandOutcome closed = inject_with("closed", "--correction c.csv --log log.csv <in.txt 2>&1 >&-");
  EXPECT_EQ(closed.exit_code, 2);
  EXPECT_THAT(closed.output, HasSubstr("standard output is closed"));
  const CommandOutcome no_rows = inject_with("no_rows_in", "--correction c.csv <&-");
  EXPECT_EQ(no_rows.exit_code, 2);
  EXPECT_THAT(no_rows.output, HasSubstr("standard input is closed"));
  EXPECT_EQ(inject_with("mute", "--correction c.csv --log log.csv <in.txt >out.txt 2>&-; echo $? >code").exit_code, 0);
  EXPECT_EQ(read_text(temporary_folder() / "mute" / "code"), "0\n");
  EXPECT_THAT(read_text(temporary_folder() / "mute" / "log.csv"), ::testing::Not(HasSubstr("rows in")));
  EXPECT_EQ(inject_with("stderr_full", "--correction c.csv <in.txt >out.txt 2>/dev/full").exit_code, 0);
}

TEST(InjectVerb, AnEndlessCorrectionIsRefused) {
  const CommandOutcome zero = inject_with("zero", "--strict --correction /dev/zero <in.txt");
  EXPECT_EQ(zero.exit_code, 2);
  EXPECT_THAT(zero.output, HasSubstr("longer than 4096 characters"));
}

// A log or dump over the correction, or over another, would destroy it.
TEST(InjectVerb, EachFileIsItsOwn) {
  for (const char* arguments :
       {"--correction c.csv --log c.csv", "--correction c.csv --vcd ./c.csv", "--correction c.csv --vcd x --log x",
        "--correction c.csv --halstream x --hal ../own/x", "--correction c.csv --halstream link --log there"}) {
    const auto folder = fresh_folder("own");
    write_file("own/c.csv", "row,e_um\n1,3\n");
    write_file("own/there", "");
    std::filesystem::remove(folder / "link");
    std::filesystem::create_symlink("there", folder / "link");
    const CommandOutcome f = run_program("--version >/dev/null; cd " + folder.string() + " && echo '0 0' | " +
                                         DRIFTWRIGHT_PROGRAM + " inject --period '1 um' " + arguments);
    EXPECT_EQ(f.exit_code, 2) << arguments;
    EXPECT_THAT(f.output, HasSubstr("are the same file")) << arguments;
    EXPECT_EQ(read_text(folder / "c.csv"), "row,e_um\n1,3\n") << arguments;
  }
  const Filtered nowhere =
      inject("nowhere", "--period '1 um' --vcd /dev/null --log /dev/null --correction " + file("c.csv", "row,e_um\n1,3\n"),
             "0 0\n");
  EXPECT_EQ(nowhere.exit_code, 0) << nowhere.words;
}

TEST(InjectVerb, AWaveformBeyondItsTimesIsRefused) {
  const std::string c = file("c.csv", "row,e_um\n1,3\n");
  const std::string times = "--period '1 um' --vcd v.vcd --row-time '123456.789012345 s' --correction " + c;
  EXPECT_EQ(inject("in_time", times, row_text({0}, 50)).exit_code, 0);
  const Filtered late = inject("late", times, row_text({0}, 100));  // 2^63 / 1.2e17 = 74 rows
  EXPECT_EQ(late.exit_code, 2);
  EXPECT_THAT(late.words, HasSubstr("beyond a 64-bit time"));
}

struct BadCase {
  const char* name;
  const char* table;
  const char* arguments;
  const char* rows;
  const char* words;
};
class BadInjection : public ::testing::TestWithParam<BadCase> {};

TEST_P(BadInjection, IsRefusedWithLineAndWhatIsAllowed) {
  const BadCase& bad = GetParam();
  const std::string c = file(std::string(bad.name) + ".csv", bad.table);
  const Filtered f = inject(bad.name, "--correction " + c + " " + bad.arguments, bad.rows);
  EXPECT_EQ(f.exit_code, 2);
  EXPECT_THAT(f.words, HasSubstr(bad.words));
}

constexpr const char* kGood = "row,e_um\n1,3\n";
INSTANTIATE_TEST_SUITE_P(
    InjectVerb, BadInjection,
    ::testing::Values(
        BadCase{"row2", kGood, "--strict --period '1 um'", "0 0\n0 2\n", "line 2: '0 2' must be 2 columns of 0 and 1"},
        BadCase{"first", kGood, "--strict --period '1 um'", "0\n", "line 1: '0' must be two or three columns"},
        BadCase{"columns", kGood, "--strict --period '1 um'", "0 0 1\n0 0\n", "line 2: '0 0' must be 3 columns"},
        BadCase{"empty_line", kGood, "--strict --period '1 um'", "0 0\n\n0 1\n", "line 2: ''"},
        BadCase{"no_period", kGood, "", "0 0\n", "requires --period"},
        BadCase{"bad_period", kGood, "--period '1 kg'", "0 0\n", "--period '1 kg'"},
        BadCase{"zero_period", kGood, "--period '0 um'", "0 0\n", "must be above 0"},
        BadCase{"no_row_time", "time_s,e_um\n0,1\n", "--period '1 um'", "0 0\n", "requires --row-time"},
        BadCase{"header", "when,e_um\n0,1\n", "--period '1 um'", "0 0\n", ":1: the first column is 'when'"},
        BadCase{"unit", "row,e_mm\n1,1\n", "--period '1 um'", "0 0\n", ":1: the second column is 'e_mm'"},
        BadCase{"text", "row,e_um\n1,1\n2,x\n", "--period '1 um'", "0 0\n", ":3: '2,x' must be two finite numbers"},
        BadCase{"nan", "row,e_um\n1,nan\n", "--period '1 um'", "0 0\n", ":2: '1,nan'"},
        BadCase{"order", "row,e_um\n5,1\n5,2\n", "--period '1 um'", "0 0\n", ":3: 5 does not come after"},
        BadCase{"zero_row", "row,e_um\n0,1\n", "--period '1 um'", "0 0\n", ":2: row 0"},
        BadCase{"huge", "row,e_um\n1,1e300\n", "--period '1 um'", "0 0\n", ":2: "},
        BadCase{"no_rows", "row,e_um\n", "--period '1 um'", "0 0\n", "no correction follows after the header"},
        BadCase{"three_columns", "row,a_um,b_um\n1,2,3\n", "--period '1 um'", "0 0\n", "no column 'predicted_um'"},
        BadCase{"no_such_column", "row,a_um,b_um\n1,2,3\n", "--period '1 um' --column c_um", "0 0\n", "no column 'c_um'"},
        BadCase{"ragged", "row,predicted_um,b_um\n1,2\n", "--period '1 um'", "0 0\n",
                ":2: '1,2' has 2 columns, but the header has 3"},
        BadCase{"strict_and_hold", kGood, "--period '1 um' --strict --on-fault hold", "0 0\n", "--on-fault"},
        BadCase{"hal_alone", kGood, "--period '1 um' --hal h.hal", "0 0\n", "--halstream"},
        BadCase{"interval", kGood, "--period '1 um' --interval 5", "0 0\n", "add --clocked"},
        BadCase{"separation", kGood, "--period '1 um' --separation 5", "0 0\n", "add --clocked"},
        BadCase{"unit_of_table", kGood, "--period '1 um' --unit count", "0 0\n", "end it in _count"},
        BadCase{"less_than_a_count", kGood, "--period '1 um' --counts x1 --insert quarter", "0 0\n",
                "less than one count at x1"},
        BadCase{"hal_name", kGood, "--period '1 um' --halstream \"a'b\" --hal h.hal", "0 0\n", "with a blank"},
        BadCase{"hal_blank", kGood, "--period '1 um' --halstream 'my rows' --hal h.hal", "0 0\n", "with a blank"},
        BadCase{"hal_x2", kGood, "--period '1 um' --counts x2 --halstream s --hal h.hal", "0 0\n", "not x2"}),
    [](const auto& case_info) { return std::string(case_info.param.name); });

TEST(InjectVerb, RefusesAMissingCorrectionAndStandardInputForIt) {
  EXPECT_EQ(inject("none", "--correction nowhere.csv --period '1 um'", "0 0\n").exit_code, 2);
  const Filtered dash = inject("dash", "--correction - --period '1 um'", "0 0\n");
  EXPECT_EQ(dash.exit_code, 2);
  EXPECT_THAT(dash.words, HasSubstr("standard input has the rows"));
}

TEST(InjectVerb, HelpHasAnExample) {
  const CommandOutcome help = run_program("inject --help");
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_THAT(help.output, AllOf(HasSubstr("Example:"), HasSubstr("--correction"), HasSubstr("--clocked")));
}

}  // namespace
}  // namespace driftwright::inject_verb_test
