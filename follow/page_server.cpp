#include "follow/page_server.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <httplib.h>
#include <pthread.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstring>
#include <semaphore>
#include <thread>

#include "base/errors.hpp"
#include "follow/page_history.hpp"

namespace driftwright::follow {
namespace {

constexpr int kMostReaders = 8;  // of events, each of which holds a thread
constexpr int kThreads = kMostReaders + 4;
constexpr int kMostConnections = 32;  // behind which others wait in the system's queue
constexpr auto kGather = std::chrono::milliseconds(100);
constexpr auto kBeat = std::chrono::seconds(2);
constexpr int kPatience_s = 5;  // with one who does not read or does not write
constexpr std::size_t kLeastToken = 16;
constexpr int kNicer = 10;

bool is_loopback(const std::string& host) {
  in_addr number{};
  if (inet_pton(AF_INET, host.c_str(), &number) == 1) return (ntohl(number.s_addr) >> 24U) == 127U;
  return host == "localhost" || host == "::1";
}

/// Names that a page on loopback is asked by. Another one is a page of elsewhere whose name was made to point here.
bool is_own_name(const std::string& host_and_port) {
  const std::string host =
      host_and_port.substr(0, host_and_port.starts_with('[') ? host_and_port.find(']') + 1 : host_and_port.find(':'));
  return host == "[::1]" || is_loopback(host);
}

/// httplib's threads with a bound to what waits for them.
class BoundedTasks final : public httplib::TaskQueue {
 public:
  void enqueue(std::function<void()> task) override {
    room_.acquire();
    pool_.enqueue([this, task = std::move(task)] {
      task();
      room_.release();
    });
  }
  void shutdown() override { pool_.shutdown(); }

 private:
  std::counting_semaphore<kMostConnections> room_{kMostConnections};
  httplib::ThreadPool pool_{kThreads};
};

/// What this thread and those it begins do comes behind the stream, whatever priority that has.
void step_back() {
  const sched_param usual{};
  (void)pthread_setschedparam(pthread_self(), SCHED_OTHER, &usual);
  (void)setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), kNicer);
}

/// Begins a thread that no signal goes to: those are the stream's.
template <class Work>
std::thread quiet_thread(Work work) {
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  std::thread thread([work] {
    step_back();
    work();
  });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return thread;
}

}  // namespace

void require_safe(const PageAddress& address) {
  if (address.port < 0 || address.port > 65535)
    throw InputError(fmt::format("--serve {}: a port from 1 to 65535 is required, or 0 for any that is free", address.port));
  if (!address.token.empty() && address.token.size() < kLeastToken)
    throw InputError(
        fmt::format("--token: {} characters can be guessed; {} or more are required", address.token.size(), kLeastToken));
  if (address.token.empty() && !is_loopback(address.host))
    throw InputError(
        fmt::format("--bind {}: others than this computer could read the page; beyond loopback (127.0.0.1, ::1, "
                    "localhost) it wants --token WORD, of {} characters or more",
                    address.host, kLeastToken));
}

bool is_same_token(const std::string& given, const std::string& token) {
  unsigned difference = given.size() == token.size() ? 0U : 1U;
  for (std::size_t i = 0; i < given.size(); ++i)
    difference |=
        static_cast<unsigned char>(given[i]) ^ static_cast<unsigned char>(token.empty() ? '\0' : token[i % token.size()]);
  return difference == 0U;
}

struct PageServer::Running {
  Running(const PageAddress& where, std::string text)
      : address(where),
        html(std::move(text)),
        history(fmt::format("{:x}{:x}", std::chrono::system_clock::now().time_since_epoch().count(), getpid())) {}

  PageAddress address;
  std::string html;
  PageFeed feed;
  std::mutex mutex;  // of what follows; threads of the server alone
  std::condition_variable came, ended;
  PageHistory history;
  bool is_over = false;
  std::atomic<int> n_readers = 0;
  std::atomic<bool> has_stopped = false;
  httplib::Server server;
  std::thread listening, gathering;

  void set_up() {
    server.new_task_queue = [] { return new BoundedTasks; };  // NOLINT: httplib deletes it
    server.set_socket_options([](socket_t socket) {  // a port that is taken is one; one who does not read is not waited for
      const int yes = 1;
      const timeval patience{.tv_sec = kPatience_s, .tv_usec = 0};
      (void)setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
      (void)setsockopt(socket, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
    });
    server.set_tcp_nodelay(true);
    server.set_keep_alive_timeout(1);
    server.set_read_timeout(kPatience_s);
    server.set_write_timeout(kPatience_s);
    server.set_payload_max_length(1024);
    server.set_default_headers(
        {{"Cache-Control", "no-store"}, {"Referrer-Policy", "no-referrer"}, {"X-Content-Type-Options", "nosniff"}});
    server.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
      if (is_allowed(request)) return httplib::Server::HandlerResponse::Unhandled;
      response.status = address.token.empty() ? 403 : 401;
      response.set_content(address.token.empty() ? "This page is asked for as localhost or 127.0.0.1.\n"
                                                 : "This page wants the token that it is served with: ?token=...\n",
                           "text/plain");
      return httplib::Server::HandlerResponse::Handled;
    });
    server.Get("/", [this](const httplib::Request&, httplib::Response& response) {
      response.set_content_provider(html.size(), "text/html; charset=utf-8",  // as it is: to compress it would take seconds
                                    [this](std::size_t from, std::size_t length, httplib::DataSink& sink) {
                                      return sink.write(html.data() + from, std::min<std::size_t>(length, 65536));
                                    });
    });
    server.Get("/events",
               [this](const httplib::Request& request, httplib::Response& response) { send_events(request, response); });
  }

  [[nodiscard]] bool is_allowed(const httplib::Request& request) const {
    if (address.token.empty()) return is_own_name(request.get_header_value("Host"));
    constexpr std::string_view kBearer = "Bearer ";
    const std::string header = request.get_header_value("Authorization");
    return is_same_token(header.starts_with(kBearer) ? header.substr(kBearer.size()) : request.get_param_value("token"),
                         address.token);
  }

  void send_events(const httplib::Request& request, httplib::Response& response) {
    if (n_readers.fetch_add(1) >= kMostReaders) {
      --n_readers;
      response.status = 503;
      response.set_content("So many pages are open already that this one has to wait.\n", "text/plain");
      return;
    }
    auto seen = std::make_shared<std::uint64_t>(0);
    {
      const std::lock_guard lock(mutex);
      *seen = history.number_of(request.get_param_value("since"));
    }
    response.set_chunked_content_provider(
        "text/event-stream",
        [this, seen](std::size_t, httplib::DataSink& sink) {
          std::string text = "event: beat\ndata: \n\n";
          {
            std::unique_lock lock(mutex);
            came.wait_for(lock, kBeat, [&] { return is_over || history.n_rows() > *seen; });
            if (is_over) return false;
            if (history.n_rows() > *seen) {
              text = history.news(*seen);
              *seen = history.n_rows();
            }
          }
          return sink.write(text.data(), text.size());
        },
        [this](bool) { --n_readers; });
  }

  void gather() {
    std::unique_lock lock(mutex);
    while (!is_over) {
      std::deque<PageRow> rows = feed.taken();
      for (PageRow& row : rows) history.add(std::move(row));
      if (!rows.empty()) came.notify_all();
      ended.wait_for(lock, kGather, [&] { return is_over; });
    }
  }
};

PageServer::PageServer(const PageAddress& address, std::string html) {
  require_safe(address);
  running_ = std::make_unique<Running>(address, std::move(html));
  Running& r = *running_;
  r.set_up();
  errno = 0;
  if (address.port == 0) r.address.port = r.server.bind_to_any_port(address.host);
  if (address.port == 0 ? r.address.port <= 0 : !r.server.bind_to_port(address.host, address.port))
    throw InputError(fmt::format("--serve {}: nobody can listen at {}: {}", address.port, address.host,
                                 errno != 0 ? std::strerror(errno) : "it is no address of this computer"));
  r.listening = quiet_thread([&r] {
    (void)r.server.listen_after_bind();
    r.has_stopped = true;
  });
  r.gathering = quiet_thread([&r] { r.gather(); });
}

PageServer::~PageServer() {
  Running& r = *running_;
  {
    const std::lock_guard lock(r.mutex);
    r.is_over = true;
  }
  r.came.notify_all();
  r.ended.notify_all();
  if (r.gathering.joinable()) r.gathering.join();
  if (!r.listening.joinable()) return;
  while (!r.server.is_running() && !r.has_stopped)  // stop() of one that does not listen yet is lost
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  r.server.stop();
  r.listening.join();
}

void PageServer::begin(const std::vector<Channel>& channels) {
  const std::lock_guard lock(running_->mutex);
  running_->history.begin(channels);
}

PageFeed& PageServer::feed() {
  return running_->feed;
}

std::string PageServer::url() const {
  const PageAddress& a = running_->address;
  return a.host.find(':') != std::string::npos ? fmt::format("http://[{}]:{}/", a.host, a.port)
                                               : fmt::format("http://{}:{}/", a.host, a.port);
}

}  // namespace driftwright::follow
