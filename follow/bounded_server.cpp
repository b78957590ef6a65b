#include "follow/bounded_server.hpp"

#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "base/errors.hpp"

namespace driftwright::follow {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kBacklog = 64;
constexpr int kSystemHolds = 1 << 18;     // send buffer of one client in the system [bytes]
constexpr std::size_t kAtOnce = 1 << 18;  // bytes sent to one client before the next one's turn
constexpr std::size_t kPassedOver =
    1 << 18;  // most bytes read and dropped after a request, so that closing does not lose the answer
constexpr auto kLinger = std::chrono::milliseconds(2000);  // time for the client to close
constexpr auto kRest = std::chrono::milliseconds(1000);    // pause when the system cannot accept a connection

const char* reason(int status) {
  switch (status) {
    case 200:
      return "OK";
    case 400:
      return "Bad Request";
    case 401:
      return "Unauthorized";
    case 403:
      return "Forbidden";
    case 404:
      return "Not Found";
    case 405:
      return "Method Not Allowed";
    case 431:
      return "Request Header Fields Too Large";
    case 503:
      return "Service Unavailable";
    default:
      return "Error";
  }
}

struct FreeAddresses {
  void operator()(addrinfo* a) const { freeaddrinfo(a); }
};

}  // namespace

/// Owns a descriptor.
struct BoundedServer::Socket {
  explicit Socket(int number) : fd(number) {}
  ~Socket() { (void)::close(fd); }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  int fd;
};

struct BoundedServer::Connection {
  enum class State { kHead, kAnswer, kStream, kLinger, kOver };

  explicit Connection(int fd) : socket(fd) {}

  Socket socket;
  State state = State::kHead;
  Clock::time_point since = Clock::now();
  Clock::time_point until;  // end of the state; for a stream, of the message being sent
  std::string head;
  std::string text;                         // to be sent, before the body
  std::shared_ptr<const std::string> body;  // null if there is none
  std::size_t n_said = 0;                   // bytes sent of both
  std::size_t n_passed_over = 0;
  std::function<std::string()> next;

  [[nodiscard]] std::size_t n_to_say() const { return text.size() + (body ? body->size() : 0) - n_said; }
  [[nodiscard]] short waits_for() const {
    if (state == State::kHead || state == State::kLinger) return POLLIN;
    return n_to_say() > 0 ? POLLOUT : 0;
  }
};

HttpAnswer plain_answer(int status, std::string words) {
  return {.status = status, .body = std::make_shared<const std::string>(std::move(words)), .next = {}};
}

BoundedServer::BoundedServer(const std::string& host, int port, Answer answer, ServerBounds bounds)
    : answer_(std::move(answer)), bounds_(bounds), accepts_from_(Clock::now()) {
  addrinfo wanted{};
  wanted.ai_socktype = SOCK_STREAM;
  wanted.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
  addrinfo* found = nullptr;
  const int failure = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &wanted, &found);
  const std::unique_ptr<addrinfo, FreeAddresses> addresses(found);
  std::string why = failure != 0 ? gai_strerror(failure) : "";
  for (const addrinfo* a = addresses.get(); a; a = a->ai_next) {
    const int fd = ::socket(a->ai_family, a->ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, a->ai_protocol);
    if (fd < 0) {
      why = std::strerror(errno);
      continue;
    }
    auto socket = std::make_unique<Socket>(fd);
    const int yes = 1, no = 0;
    (void)setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &yes,
                     sizeof yes);  // connections of an earlier run that are still closing do not block the port
    if (a->ai_family == AF_INET6) (void)setsockopt(fd, IPPROTO_IPV6, IPV6_V6ONLY, &no, sizeof no);
    if (::bind(fd, a->ai_addr, a->ai_addrlen) != 0 || ::listen(fd, kBacklog) != 0) {
      why = std::strerror(errno);
      continue;
    }
    sockaddr_storage bound{};
    socklen_t length = sizeof bound;
    (void)getsockname(fd, reinterpret_cast<sockaddr*>(&bound), &length);
    port_ = ntohs(bound.ss_family == AF_INET6 ? reinterpret_cast<const sockaddr_in6&>(bound).sin6_port
                                              : reinterpret_cast<const sockaddr_in&>(bound).sin_port);
    listening_ = std::move(socket);
    return;
  }
  throw InputError(fmt::format("the page cannot be served at {}, port {}: {}", host, port, why));
}

BoundedServer::~BoundedServer() = default;

std::size_t BoundedServer::n_streams() const {
  return static_cast<std::size_t>(std::count_if(connections_.begin(), connections_.end(),
                                                [](const auto& c) { return c->state == Connection::State::kStream; }));
}

void BoundedServer::turn(std::chrono::milliseconds at_most) {
  std::vector<pollfd> polled;
  for (const auto& c : connections_) polled.push_back({c->socket.fd, c->waits_for(), 0});
  // The listening socket comes last, and only if a connection can be taken: otherwise poll() would not wait at all.
  const bool accepts = Clock::now() >= accepts_from_ && (connections_.size() < bounds_.n_connections || who_makes_room());
  if (accepts) polled.push_back({listening_->fd, POLLIN, 0});
  if (::poll(polled.data(), polled.size(), static_cast<int>(at_most.count())) < 0) return;
  for (std::size_t i = 0; i < connections_.size(); ++i) {
    Connection& c = *connections_[i];
    const short came = polled[i].revents;
    if ((came & (POLLERR | POLLHUP | POLLNVAL)) != 0 && (came & POLLIN) == 0) c.state = Connection::State::kOver;
    if ((came & POLLIN) != 0) c.state == Connection::State::kLinger ? linger(c) : hear(c);
    if ((came & POLLOUT) != 0) say(c);
    if (c.state == Connection::State::kStream && c.n_to_say() == 0) begin_message(c);
    const bool waits = c.state != Connection::State::kStream || c.n_to_say() > 0;
    if (waits && Clock::now() > c.until) c.state = Connection::State::kOver;
  }
  std::erase_if(connections_, [](const auto& c) { return c->state == Connection::State::kOver; });
  if (accepts && polled.back().revents != 0) accept_all();
}

/// The connection whose request head, or whose client's closing, has been awaited longest, if long enough to give its
/// place away.
const BoundedServer::Connection* BoundedServer::who_makes_room() const {
  const Connection* oldest = nullptr;
  for (const auto& c : connections_) {
    if (c->state != Connection::State::kHead && c->state != Connection::State::kLinger) continue;
    if (Clock::now() > c->since + bounds_.place_for_sure && (!oldest || c->since < oldest->since)) oldest = c.get();
  }
  return oldest;
}

void BoundedServer::accept_all() {
  for (;;) {
    const Connection* leaves = nullptr;
    if (connections_.size() >= bounds_.n_connections && !(leaves = who_makes_room())) return;
    const int fd = ::accept4(listening_->fd, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (fd < 0) {
      if (errno == EMFILE || errno == ENFILE || errno == ENOBUFS || errno == ENOMEM) accepts_from_ = Clock::now() + kRest;
      return;
    }
    std::erase_if(connections_, [&](const auto& c) { return c.get() == leaves; });
    auto c = std::make_unique<Connection>(fd);
    const int yes = 1;
    (void)setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    (void)setsockopt(fd, SOL_SOCKET, SO_SNDBUF, &kSystemHolds, sizeof kSystemHolds);
    c->until = c->since + bounds_.head_within;
    connections_.push_back(std::move(c));
  }
}

void BoundedServer::hear(Connection& c) {
  std::array<char, 4096> piece;
  while (c.state == Connection::State::kHead) {
    const ssize_t n = ::recv(c.socket.fd, piece.data(), piece.size(), 0);
    if (n < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR)) return;
    if (n <= 0) {
      c.state = Connection::State::kOver;
      return;
    }
    const std::size_t searched = c.head.size() < 3 ? 0 : c.head.size() - 3;
    c.head.append(piece.data(), static_cast<std::size_t>(n));
    const std::size_t end = c.head.find("\r\n\r\n", searched);
    if (std::min(end, c.head.size()) > bounds_.head_bytes) {
      begin_answer(c, plain_answer(431, fmt::format("A head of {} bytes at most is read.\n", bounds_.head_bytes)), true);
    } else if (end != std::string::npos) {
      const std::optional<HttpRequest> request = read_request(std::string_view(c.head).substr(0, end));
      if (!request) {
        begin_answer(c, plain_answer(400, "This is no request of HTTP/1.1.\n"), true);
      } else if (request->method != "GET" && request->method != "HEAD") {
        begin_answer(c, plain_answer(405, "The page is there to be read, by GET and HEAD.\n"), true);
      } else {
        begin_answer(c, answer_(*request), request->method == "GET");
      }
    }
  }
}

void BoundedServer::begin_answer(Connection& c, const HttpAnswer& answer, bool with_body) {
  std::string().swap(c.head);
  c.text = fmt::format(
      "HTTP/1.1 {} {}\r\nContent-Type: {}\r\n{}{}Connection: close\r\nCache-Control: no-store\r\nReferrer-Policy: "
      "no-referrer\r\n"
      "X-Content-Type-Options: nosniff\r\n\r\n",
      answer.status, reason(answer.status), answer.type,
      answer.next ? "" : fmt::format("Content-Length: {}\r\n", answer.body ? answer.body->size() : 0),
      answer.status == 405 ? "Allow: GET, HEAD\r\n" : "");
  c.n_said = 0;
  if (with_body) {
    c.body = answer.body;
    c.next = answer.next;
  }
  c.state = c.next ? Connection::State::kStream : Connection::State::kAnswer;
  c.until = when_read(c);
  say(c);
}

/// The time by which the client must have read all that is to be sent.
std::chrono::steady_clock::time_point BoundedServer::when_read(const Connection& c) const {
  const std::chrono::duration<double> length_s(static_cast<double>(c.n_to_say()) / bounds_.least_bytes_per_s);
  return Clock::now() + bounds_.patience + std::chrono::duration_cast<Clock::duration>(length_s);
}

void BoundedServer::begin_message(Connection& c) {
  c.text = c.next();
  c.n_said = 0;
  if (c.text.empty()) return;
  c.until = when_read(c);
  say(c);
}

void BoundedServer::say(Connection& c) {
  for (std::size_t at_once = 0; c.n_to_say() > 0 && at_once < kAtOnce;) {
    const bool is_text = c.n_said < c.text.size();
    const std::string& from = is_text ? c.text : *c.body;
    const std::size_t at = is_text ? c.n_said : c.n_said - c.text.size();
    const ssize_t n = ::send(c.socket.fd, from.data() + at, std::min(from.size() - at, kAtOnce), MSG_NOSIGNAL);
    if (n < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR)) return;
    if (n <= 0) {
      c.state = Connection::State::kOver;
      return;
    }
    c.n_said += static_cast<std::size_t>(n);
    at_once += static_cast<std::size_t>(n);
  }
  if (c.n_to_say() > 0 || c.state != Connection::State::kAnswer) return;
  // All is sent. Closing with unread bytes would reset the connection, and the answer could be lost: so the client closes
  // first, or its time runs out.
  (void)::shutdown(c.socket.fd, SHUT_WR);
  c.body.reset();
  c.state = Connection::State::kLinger;
  c.since = Clock::now();
  c.until = c.since + kLinger;
}

void BoundedServer::linger(Connection& c) {
  std::array<char, 16384> piece;
  for (;;) {
    const ssize_t n = ::recv(c.socket.fd, piece.data(), piece.size(), 0);
    if (n < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR)) return;
    if (n > 0) c.n_passed_over += static_cast<std::size_t>(n);
    if (n <= 0 || c.n_passed_over > kPassedOver) {
      c.state = Connection::State::kOver;
      return;
    }
  }
}

}  // namespace driftwright::follow
