#include "tests/fuzz/driver.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstring>
#include <map>

#include "app/exit_code.hpp"
#include "base/file_bytes.hpp"
#include "tests/fuzz/mutation.hpp"

namespace driftwright::fuzz {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int kLongest_s = 20;          // of processor time, so that a busy machine finds the same
constexpr double kLongestWait_s = 400;  // for what waits and does nothing
constexpr rlim_t kMostMemory = rlim_t(6) << 30;

struct Options {
  double seconds = 5.0;
  std::uint64_t inputs = ~std::uint64_t(0), seed = 1, from = 0;
  std::string keep;
  bool only = false;
};

/// What child and parent both see.
struct Shared {
  std::atomic<std::uint64_t> number;        ///< of the input that is read
  std::atomic<std::int64_t> begun_ns;       ///< when
  std::atomic<std::uint64_t> n_of_code[4];  ///< inputs that ended with exit code 0, 1, 2, 3
  std::atomic<bool> is_done;
};

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now().time_since_epoch()).count();
}

int code_of(const Target& target, const fs::path& file) {
  try {
    target.read(file);
    return 0;
  } catch (...) {
    return app::exit_code_of(std::current_exception());
  }
}

fs::path write_input(const Target& target, const std::vector<Sample>& corpus, const Options& options, std::uint64_t number,
                     const fs::path& folder) {
  const Sample sample = mutated(corpus, target.words, options.seed, number);
  const fs::path file = folder / (target.file_name + sample.extension);
  write_bytes(file, sample.bytes);
  return file;
}

void be_quiet() {
  if (const int sink = open("/dev/null", O_WRONLY); sink >= 0) {
    dup2(sink, STDOUT_FILENO);
    dup2(sink, STDERR_FILENO);
  }
}

[[noreturn]] void run_child(const Target& target, const std::vector<Sample>& corpus, const Options& options,
                            const fs::path& folder, std::int64_t end_ns, Shared& shared) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  be_quiet();
  const rlimit none = {0, 0}, memory = {kMostMemory, kMostMemory};
  setrlimit(RLIMIT_CORE, &none);
#if !defined(__SANITIZE_ADDRESS__)
  setrlimit(RLIMIT_AS, &memory);
#endif
  for (std::uint64_t number = shared.number; number < options.inputs && now_ns() < end_ns; ++number) {
    const fs::path file = write_input(target, corpus, options, number, folder);
    shared.begun_ns = now_ns();
    shared.number = number;
    const itimerval longest = {{0, 0}, {kLongest_s, 0}};
    setitimer(ITIMER_PROF, &longest, nullptr);
    const int code = code_of(target, file);
    ++shared.n_of_code[code & 3];
    if (code == 1) _exit(1);  // the parent keeps it
  }
  shared.is_done = true;
  _exit(0);
}

/// Waits for a child. @return how it failed, empty when it came to the end of its inputs
std::string outcome_of(pid_t child, Shared& shared) {
  int status = 0;
  bool is_hanging = false;
  while (waitpid(child, &status, WNOHANG) == 0) {
    if (!shared.is_done && static_cast<double>(now_ns() - shared.begun_ns) > 1e9 * kLongestWait_s) {
      is_hanging = true;
      kill(child, SIGKILL);
    }
    usleep(20000);
  }
  if (is_hanging) return fmt::format("no answer within {:.0f} s", kLongestWait_s);
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGPROF)
    return fmt::format("no answer within {} s of processor time", kLongest_s);
  if (WIFSIGNALED(status)) return strsignal(WTERMSIG(status));
  if (WEXITSTATUS(status) == 1) return "exit code 1";
  return WEXITSTATUS(status) == 0 ? "" : fmt::format("exit code {}", WEXITSTATUS(status));  // a sanitizer's
}

bool read_options(int argc, char** argv, Options& options) {
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string key = argv[i], value = argv[i + 1];
    if (key == "--seconds") {
      options.seconds = std::stod(value);
    } else if (key == "--inputs") {
      options.inputs = std::stoull(value);
      options.seconds = 1e9;
    } else if (key == "--seed") {
      options.seed = std::stoull(value);
    } else if (key == "--from" || key == "--only") {
      options.from = std::stoull(value);
      options.only = key == "--only";
    } else if (key == "--keep") {
      options.keep = value;
    } else {
      return false;
    }
  }
  return argc % 2 == 1;
}

}  // namespace

int run(int argc, char** argv, const Target& target) {
  Options options;
  if (!read_options(argc, argv, options)) {
    fmt::print(stderr, "{}: --seconds S, --inputs N, --seed K, --from N, --only N, --keep FOLDER are known\n", argv[0]);
    return 2;
  }
  const std::vector<Sample> corpus = read_corpus(target.corpus, target.extensions);
  std::string made = (fs::exists("/dev/shm") ? fs::path("/dev/shm") : fs::temp_directory_path()) / "driftwright-fuzz-XXXXXX";
  if (!mkdtemp(made.data())) return 2;
  const fs::path folder = made;
  if (options.only) {
    const fs::path file = write_input(target, corpus, options, options.from, folder);
    fmt::print("{}\n", file.string());
    std::fflush(stdout);
    return code_of(target, file);
  }
  auto* shared = new (mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)) Shared{};
  shared->number = options.from;
  options.inputs = options.inputs == ~std::uint64_t(0) ? options.inputs : options.from + options.inputs;
  const std::int64_t begin_ns = now_ns(),
                     end_ns = begin_ns + static_cast<std::int64_t>(1e9 * std::min(options.seconds, 1e9));
  std::map<std::string, std::uint64_t> findings;
  std::uint64_t n_findings = 0;
  while (!shared->is_done) {
    shared->begun_ns = now_ns();
    const pid_t child = fork();
    if (child < 0) return 2;
    if (child == 0) run_child(target, corpus, options, folder, end_ns, *shared);
    const std::string how = outcome_of(child, *shared);
    if (how.empty()) continue;
    const std::uint64_t number = shared->number;
    fmt::print("{}: input {} of seed {}: {}\n", target.name, number, options.seed, how);
    ++findings[how];
    ++n_findings;
    if (!options.keep.empty()) {
      fs::create_directories(options.keep);
      const fs::path input = write_input(target, corpus, options, number, folder);
      fs::copy_file(
          input,
          fs::path(options.keep) / fmt::format("{}-{}-{}{}", target.name, options.seed, number, input.extension().string()),
          fs::copy_options::overwrite_existing);
    }
    shared->number = number + 1;
  }
  const auto n = [&](int code) { return shared->n_of_code[code].load(); };
  fmt::print(
      "{}: {} inputs of seed {} from {} files in {:.1f} s: {} read, {} refused, {} given up by numerics; findings: {}\n",
      target.name, n(0) + n(2) + n(3) + n_findings, options.seed, corpus.size(),
      1e-9 * static_cast<double>(now_ns() - begin_ns), n(0), n(2), n(3), n_findings);
  for (const auto& [how, count] : findings) fmt::print("  {}: {}\n", how, count);
  fs::remove_all(folder);
  return n_findings == 0 ? 0 : 1;
}

}  // namespace driftwright::fuzz
