#include "mesh/read_apart.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <omp.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <new>

#include "base/c_random.hpp"
#include "base/errors.hpp"
#include "mesh/mesh_bytes.hpp"

namespace driftwright::mesh {
namespace {

std::atomic<bool> all_are_ours = false;  // one per process, like its threads
bool is_child = false;                   // set only in the child

constexpr double kLeastToRead_s = 5, kPerMegabyte_s = 60, kLeastToMesh_s = 10, kCellsPerSecond = 200;

/// The first byte from the child; the data follow.
enum class Answer : char { kMesh, kInputError, kRangeError, kSolveError, kNoMemory, kOther };

bool has_one_thread() {
  std::error_code failed;
  std::filesystem::directory_iterator task("/proc/self/task", failed);
  if (failed) return false;
  return std::distance(begin(task), end(task)) == 1;
}

/// Makes the child silent: no output, no core dump, no exit handlers of the parent; it ends with the parent.
void become_quiet() {
  is_child = true;
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {  // ignored here if the parent handles or ignores it
    struct sigaction parents = {};
    sigaction(signal, nullptr, &parents);
    if (parents.sa_handler != SIG_DFL) std::signal(signal, SIG_IGN);
  }
  for (const int signal : {SIGABRT, SIGSEGV, SIGFPE, SIGBUS, SIGILL}) std::signal(signal, SIG_DFL);
  const rlimit none = {0, 0};
  setrlimit(RLIMIT_CORE, &none);
  if (const int sink = open("/dev/null", O_RDWR); sink >= 0) {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(sink, stream);
  }
  omp_set_num_threads(1);  // the fork has not copied the pool's threads
}

void send(int to, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = write(to, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) _exit(1);
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
}

void send(int to, Answer answer, std::string_view bytes) {
  const std::size_t size = bytes.size();
  std::string head(1, static_cast<char>(answer));
  head.append(reinterpret_cast<const char*>(&size), sizeof size);
  send(to, head);
  send(to, bytes);
}

[[noreturn]] void run_child(int to, const std::function<Mesh()>& read) {
  become_quiet();
  try {
    send(to, Answer::kMesh, mesh_bytes(read()));
  } catch (const InputError& e) {
    send(to, Answer::kInputError, e.what());
  } catch (const RangeError& e) {
    send(to, Answer::kRangeError, e.what());
  } catch (const SolveError& e) {
    send(to, Answer::kSolveError, e.what());
  } catch (const std::bad_alloc&) {
    send(to, Answer::kNoMemory, "");
  } catch (const std::exception& e) {
    send(to, Answer::kOther, e.what());
  } catch (...) {
    std::abort();  // an unknown kind of exception
  }
  _exit(0);
}

std::string received(int from) {
  std::string bytes;
  char some[65536];
  for (;;) {
    const ssize_t n = ::read(from, some, sizeof some);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return bytes;
    bytes.append(some, static_cast<std::size_t>(n));
  }
}

/// The error for a child that ended without an answer.
InputError of_death(const std::string& path, int status) {
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  if (signal == SIGXCPU)
    return InputError(fmt::format(
        "{}: reading it takes longer than {} s of processor time and {} s more for each megabyte, comparing one of its "
        "solids with others or with a point that names it as long again, or meshing it longer "
        "than {} s and 1 s more for each {} expected cells; the file is damaged, or holds what the library that reads "
        "it cannot take. Write it anew, or as another format",
        path, kLeastToRead_s, kPerMegabyte_s, kLeastToMesh_s, kCellsPerSecond));
  const std::string how = signal == SIGKILL ? "was killed, perhaps for lack of memory"
                          : signal != 0     ? fmt::format("crashed ({})", strsignal(signal))
                                            : "ended before its time";
  return InputError(
      fmt::format("{}: the process that read it {}; the file is damaged, or holds what the library that reads it cannot "
                  "take. Write it anew, or as another format",
                  path, how));
}

}  // namespace

void all_threads_are_ours() {
  all_are_ours = true;
}

Mesh read_apart(const std::string& path, const std::function<Mesh()>& read) {
  if (is_child || !(all_are_ours || has_one_thread())) return read();
  int ends[2];
  pid_t child = 0;
  {
    std::unique_lock alone = alone_with_c_random();  // no other thread is inside Gmsh
    if (pipe2(ends, O_CLOEXEC) != 0)
      throw InputError(fmt::format("{}: no pipe to a process that would read it: {}", path, std::strerror(errno)));
    child = fork();
    if (child == 0) {
      alone.unlock();
      run_child(ends[1], read);
    }
    close(ends[1]);  // before another thread forks, because its child would keep this pipe open
  }
  const int why_not = errno;
  const std::string bytes = child < 0 ? "" : received(ends[0]);
  close(ends[0]);
  if (child < 0) throw InputError(fmt::format("{}: no process to read it in: {}", path, std::strerror(why_not)));
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  constexpr std::size_t kHead = 1 + sizeof(std::size_t);
  std::size_t size = 0;
  if (bytes.size() >= kHead) std::memcpy(&size, bytes.data() + 1, sizeof size);
  if (bytes.size() < kHead || bytes.size() - kHead != size) throw of_death(path, status);
  const std::string_view said = std::string_view(bytes).substr(kHead);
  switch (static_cast<Answer>(bytes[0])) {
    case Answer::kMesh:
      return mesh_of_bytes(said);
    case Answer::kInputError:
      throw InputError(std::string(said));
    case Answer::kRangeError:
      throw RangeError(std::string(said));
    case Answer::kSolveError:
      throw SolveError(std::string(said));
    case Answer::kNoMemory:
      throw InputError(path + ": what it says that it holds does not fit into memory; is the file damaged?");
    default:
      throw std::logic_error(std::string(said));
  }
}

BoundedTime::BoundedTime(double most_s) {
  if (!is_child) return;
  rusage used;
  getrusage(RUSAGE_SELF, &used);  // a child starts at 0
  rlimit limit;
  getrlimit(RLIMIT_CPU, &limit);
  before_s_ = limit.rlim_cur;
  const auto most =
      static_cast<rlim_t>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) + static_cast<rlim_t>(std::ceil(most_s));
  limit.rlim_cur = std::min(limit.rlim_cur, most);
  setrlimit(RLIMIT_CPU, &limit);
}

BoundedTime::~BoundedTime() {
  if (!is_child) return;
  rlimit limit;
  getrlimit(RLIMIT_CPU, &limit);
  limit.rlim_cur = before_s_;
  setrlimit(RLIMIT_CPU, &limit);
}

double most_to_read_s(const std::string& path) {
  std::error_code unknown;
  const auto size = std::filesystem::file_size(path, unknown);
  return kLeastToRead_s + (unknown ? 0.0 : kPerMegabyte_s * 1e-6 * static_cast<double>(size));
}

double most_to_compare_s(const std::string& path, std::size_t n_solids, std::size_t n_points) {
  return most_to_read_s(path) * static_cast<double>(n_solids * (1 + n_points));
}

double most_to_mesh_s(double n_cells) {
  return kLeastToMesh_s + std::max(0.0, n_cells) / kCellsPerSecond;
}

}  // namespace driftwright::mesh
