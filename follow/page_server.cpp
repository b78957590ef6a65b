#include "follow/page_server.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <pthread.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <mutex>
#include <thread>

#include "base/errors.hpp"
#include "follow/bounded_server.hpp"
#include "follow/page_history.hpp"

namespace driftwright::follow {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMostReaders = 32;  // connections to `events`; half of all places
constexpr auto kGather = std::chrono::milliseconds(100);
constexpr auto kBeat = std::chrono::seconds(2);
constexpr std::size_t kLeastToken = 16;
constexpr int kNicer = 10;

bool is_loopback(const std::string& host) {
  in_addr number{};
  if (inet_pton(AF_INET, host.c_str(), &number) == 1) return (ntohl(number.s_addr) >> 24U) == 127U;
  return host == "localhost" || host == "::1";
}

/// Names under which a page on loopback may be requested. Any other name belongs to a foreign page whose name was made to
/// point here (DNS rebinding).
bool is_own_name(const std::string& host_and_port) {
  const std::string host =
      host_and_port.substr(0, host_and_port.starts_with('[') ? host_and_port.find(']') + 1 : host_and_port.find(':'));
  return host == "[::1]" || is_loopback(host);
}

/// Lowers this thread's priority below that of the stream, whatever priority that has.
void step_back() {
  const sched_param usual{};
  (void)pthread_setschedparam(pthread_self(), SCHED_OTHER, &usual);
  (void)setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), kNicer);
}

/// Starts a thread that receives no signals: the stream handles those.
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
        fmt::format("--bind {}: other computers could read the page; beyond loopback (127.0.0.1, ::1, localhost) --token "
                    "WORD is required, of {} characters or more",
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
  Running(PageAddress where, std::string text)
      : address(std::move(where)),
        html(std::make_shared<const std::string>(std::move(text))),
        history(fmt::format("{:x}{:x}", std::chrono::system_clock::now().time_since_epoch().count(), getpid())),
        server(address.host, address.port, [this](const HttpRequest& request) { return answer(request); }) {}

  PageAddress address;
  std::shared_ptr<const std::string> html;
  PageFeed feed;
  std::mutex mutex;  // guards `history`
  PageHistory history;
  BoundedServer server;
  std::atomic<bool> is_over = false;
  std::thread serving;

  [[nodiscard]] bool is_allowed(const HttpRequest& request) const {
    if (address.token.empty()) return is_own_name(value_of(request.headers, "host"));
    constexpr std::string_view kBearer = "Bearer ";
    const std::string header = value_of(request.headers, "authorization");
    return is_same_token(header.starts_with(kBearer) ? header.substr(kBearer.size()) : value_of(request.query, "token"),
                         address.token);
  }

  HttpAnswer answer(const HttpRequest& request) {
    if (!is_allowed(request))
      return address.token.empty() ? plain_answer(403, "This page is asked for as localhost or 127.0.0.1.\n")
                                   : plain_answer(401, "This page requires the token that it is served with: ?token=...\n");
    if (request.path == "/") return {.type = "text/html; charset=utf-8", .body = html, .next = {}};
    if (request.path == "/events") return events(request);
    return plain_answer(404, "The page is at /.\n");
  }

  HttpAnswer events(const HttpRequest& request) {
    if (server.n_streams() >= kMostReaders)
      return plain_answer(503, "So many pages are open already that this one has to wait.\n");
    const std::lock_guard lock(mutex);
    return {.type = "text/event-stream",
            .body = nullptr,
            .next = [this, seen = history.number_of(value_of(request.query, "since")), told = Clock::now()]() mutable {
              const std::lock_guard next_lock(mutex);
              const bool has_news = history.n_rows() > seen;
              if (!has_news && Clock::now() < told + kBeat) return std::string();
              told = Clock::now();
              if (!has_news) return std::string("event: beat\ndata: \n\n");
              std::string news = history.news(seen);
              seen = history.n_rows();
              return news;
            }};
  }

  void serve() {
    for (Clock::time_point gathers = Clock::now(); !is_over;) {
      if (Clock::now() >= gathers) {
        const std::lock_guard lock(mutex);
        for (PageRow& row : feed.taken()) history.add(std::move(row));
        gathers = Clock::now() + kGather;
      }
      server.turn(std::chrono::ceil<std::chrono::milliseconds>(std::max(gathers - Clock::now(), Clock::duration::zero())));
    }
  }
};

PageServer::PageServer(const PageAddress& address, std::string html) {
  require_safe(address);
  running_ = std::make_unique<Running>(address, std::move(html));
  Running& r = *running_;
  r.address.port = r.server.port();
  r.serving = quiet_thread([&r] { r.serve(); });
}

PageServer::~PageServer() {
  running_->is_over = true;
  if (running_->serving.joinable()) running_->serving.join();
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
