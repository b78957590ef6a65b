// What a client may take of the small server beneath the page, and that those who ask properly are answered meanwhile.

#include "follow/bounded_server.hpp"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <thread>

#include "base/errors.hpp"

namespace driftwright::follow::bounded_server_test {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre, ::testing::EndsWith, ::testing::HasSubstr, ::testing::Pair;
using ::testing::StartsWith;
using Clock = std::chrono::steady_clock;

class Client {
 public:
  explicit Client(int port, int receives_bytes = 0) : fd_(::socket(AF_INET, SOCK_STREAM, 0)) {
    if (receives_bytes > 0) (void)setsockopt(fd_, SOL_SOCKET, SO_RCVBUF, &receives_bytes, sizeof receives_bytes);
    const timeval patience{.tv_sec = 20, .tv_usec = 0};
    (void)setsockopt(fd_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(port));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(fd_, reinterpret_cast<const sockaddr*>(&to), sizeof to), 0);
  }
  ~Client() { (void)::close(fd_); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// @return whether the connection was still open
  bool say(const std::string& text) const {
    return ::send(fd_, text.data(), text.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(text.size());
  }
  void says_no_more() const { (void)::shutdown(fd_, SHUT_WR); }
  /// What comes next; "" at the end, and where the connection was broken off.
  [[nodiscard]] std::string heard() const {
    std::string piece(65536, '\0');
    const ssize_t n = ::recv(fd_, piece.data(), piece.size(), 0);
    piece.resize(n > 0 ? static_cast<std::size_t>(n) : 0);
    return piece;
  }
  /// All until the server closes.
  [[nodiscard]] std::string all() const {
    std::string text;
    for (std::string piece = heard(); !piece.empty(); piece = heard()) text += piece;
    return text;
  }

 private:
  int fd_;
};

/// A server in a thread of its own: `/` is a page of 8 MB, `/numbers` a stream of what count() counts, `/flood` one
/// without end.
class Serving {
 public:
  explicit Serving(ServerBounds bounds = {})
      : page_(std::make_shared<const std::string>(8'000'000, 'x')),
        server_(
            "127.0.0.1", 0, [this](const HttpRequest& r) { return answer(r); }, bounds),
        thread_([this] {
          while (!is_over_) {
            server_.turn(10ms);
            n_streams_ = server_.n_streams();
            n_connections_ = server_.n_connections();
          }
        }) {}
  ~Serving() {
    is_over_ = true;
    thread_.join();
  }
  [[nodiscard]] int port() const { return server_.port(); }
  [[nodiscard]] std::string page() const { return *page_; }
  void count() { ++count_; }
  /// Whether so many streams are left, within a time.
  [[nodiscard]] bool comes_to(std::size_t n_streams, std::chrono::milliseconds within) const {
    for (const auto until = Clock::now() + within; Clock::now() < until; std::this_thread::sleep_for(5ms)) {
      if (n_streams_ == n_streams) return true;
    }
    return false;
  }
  [[nodiscard]] std::size_t n_connections() const { return n_connections_; }

 private:
  HttpAnswer answer(const HttpRequest& request) {
    if (request.path == "/") return {.body = page_, .next = {}};
    if (request.path == "/flood") return {.body = nullptr, .next = [] { return std::string(1'000'000, 'y'); }};
    if (request.path != "/numbers") return plain_answer(404, "none\n");
    return {.body = nullptr, .next = [this, seen = 0]() mutable {
              std::string text;
              while (seen < count_) text += std::to_string(seen++) + ";";
              return text;
            }};
  }

  std::shared_ptr<const std::string> page_;
  std::atomic<int> count_ = 0;
  std::atomic<bool> is_over_ = false;
  std::atomic<std::size_t> n_streams_ = 0, n_connections_ = 0;
  BoundedServer server_;
  std::thread thread_;
};

std::string body_of(const std::string& answer) {
  return answer.substr(answer.find("\r\n\r\n") + 4);
}

constexpr const char* kGet = "GET / HTTP/1.1\r\nHost: localhost\r\n\r\n";

TEST(HttpRequest, IsReadWithItsQueryAndHeaders) {
  const auto r =
      read_request("GET /ev%65nts?since=run-3&token=a+b%2Bc&flag HTTP/1.1\r\nHOST:  localhost:80 \r\nX: \r\n\r\n");
  ASSERT_TRUE(r);
  EXPECT_EQ(r->method, "GET");
  EXPECT_EQ(r->path, "/events");
  EXPECT_THAT(r->query, ElementsAre(Pair("since", "run-3"), Pair("token", "a b+c"), Pair("flag", "")));
  EXPECT_THAT(r->headers, ElementsAre(Pair("host", "localhost:80"), Pair("x", "")));
  EXPECT_EQ(value_of(r->query, "none"), "");
  for (const char* none :
       {"", "GET", "GET / HTTP/2", "GET http://a/ HTTP/1.1", "GET / HTTP/1.1\r\nHost : a", "GET / HTTP/1.1\r\n: a",
        "GET / HTTP/1.1\r\nHost: a\r\nhost: b", " / HTTP/1.1", "GET /a b HTTP/1.1"})
    EXPECT_FALSE(read_request(none)) << none;
  EXPECT_EQ(read_request("GET /%zz% HTTP/1.0")->path, "/%zz%");
}

TEST(BoundedServer, AnswersWholeAlsoOneWhoSaysNoMoreAndOneWhoSaysTooMuch) {
  const Serving serving;
  const Client plain(serving.port()), half(serving.port()), head(serving.port()), posts(serving.port()),
      strange(serving.port());
  ASSERT_TRUE(plain.say(kGet));
  EXPECT_EQ(body_of(plain.all()), serving.page());
  ASSERT_TRUE(half.say(kGet));
  half.says_no_more();  // as `nc` does at the end of its input
  std::this_thread::sleep_for(100ms);
  const std::string answer = half.all();
  EXPECT_THAT(answer.substr(0, 500), AllOf(StartsWith("HTTP/1.1 200 OK\r\n"), HasSubstr("\r\nContent-Length: 8000000\r\n")));
  EXPECT_EQ(body_of(answer), serving.page());
  ASSERT_TRUE(head.say("HEAD / HTTP/1.1\r\n\r\n"));
  EXPECT_THAT(head.all(), AllOf(HasSubstr("Content-Length: 8000000\r\n"), EndsWith("\r\n\r\n")));
  ASSERT_TRUE(posts.say("POST / HTTP/1.1\r\nContent-Length: 200000\r\n\r\n" +
                        std::string(200000, 'z')));  // the answer comes before all is read
  EXPECT_THAT(posts.all(), AllOf(StartsWith("HTTP/1.1 405"), HasSubstr("Allow: GET, HEAD")));
  ASSERT_TRUE(strange.say("\x16\x03\x01 TLS?\r\n\r\n"));
  EXPECT_THAT(strange.all(), StartsWith("HTTP/1.1 400"));
}

TEST(BoundedServer, ReadsAHeadOfItsLengthAndNoLongerOne) {
  const Serving serving;
  const std::string most = "GET /none HTTP/1.1\r\nX: ";
  const Client fits(serving.port()), exceeds(serving.port()), endless(serving.port());
  ASSERT_TRUE(fits.say(most + std::string(16384 - most.size(), 'x') + "\r\n\r\n"));
  EXPECT_THAT(fits.all(), StartsWith("HTTP/1.1 404"));
  ASSERT_TRUE(exceeds.say(most + std::string(16385 - most.size(), 'x') + "\r\n\r\n"));
  EXPECT_THAT(exceeds.all(), StartsWith("HTTP/1.1 431"));
  std::size_t n = 0;
  const std::string piece(65536, 'x');
  while (n < 100'000'000 && endless.say(piece)) n += piece.size();
  EXPECT_LT(n, 20'000'000U);  // what systems hold on the way, and no more
}

TEST(BoundedServer, WaitsForAHeadForItsTimeAltogether) {
  const Serving serving({.head_within = 300ms});
  const Client drips(serving.port());
  const auto began = Clock::now();
  while (drips.say("G") && Clock::now() < began + 5s) std::this_thread::sleep_for(20ms);
  EXPECT_LT(Clock::now() - began, 2s);
}

TEST(BoundedServer, AnswersBesideAHundredWhoKeepSilent) {
  const Serving serving;  // who wait for 5 s each
  std::vector<std::unique_ptr<Client>> silent;
  for (int i = 0; i < 100; ++i) silent.push_back(std::make_unique<Client>(serving.port()));
  const auto began = Clock::now();
  for (int i = 0; i < 5; ++i) {
    const Client asks(serving.port());
    ASSERT_TRUE(asks.say(kGet));
    EXPECT_EQ(body_of(asks.all()).size(), 8'000'000U);
  }
  EXPECT_LT(Clock::now() - began, 3s);
  EXPECT_LE(serving.n_connections(), 64U);
}

TEST(BoundedServer, StreamsWhatComesToEachInItsOrder) {
  Serving serving;
  const Client one(serving.port()), other(serving.port());
  for (const Client* c : {&one, &other}) ASSERT_TRUE(c->say("GET /numbers HTTP/1.1\r\n\r\n"));
  one.says_no_more();  // and listens on
  ASSERT_TRUE(serving.comes_to(2, 2s));
  std::string expected;
  for (int i = 0; i < 100; ++i) {
    serving.count();
    expected += std::to_string(i) + ";";
    std::this_thread::sleep_for(1ms);
  }
  for (const Client* c : {&one, &other}) {
    std::string text;
    while (text.find("\r\n\r\n") == std::string::npos || body_of(text).size() < expected.size()) {
      const std::string piece = c->heard();
      ASSERT_FALSE(piece.empty()) << text;
      text += piece;
    }
    EXPECT_EQ(body_of(text), expected);
    EXPECT_THAT(text, ::testing::Not(HasSubstr("Content-Length")));
  }
}

TEST(BoundedServer, DropsOneWhoDoesNotReadAndOneWhoIsGone) {
  Serving serving({.patience = 300ms, .least_bytes_per_s = 1e7});
  const Client reads_not(serving.port(), 4096);
  ASSERT_TRUE(reads_not.say("GET /flood HTTP/1.1\r\n\r\n"));
  ASSERT_TRUE(serving.comes_to(1, 2s));
  EXPECT_TRUE(serving.comes_to(0, 3s));
  {
    const Client leaves(serving.port());
    ASSERT_TRUE(leaves.say("GET /numbers HTTP/1.1\r\n\r\n"));
    ASSERT_TRUE(serving.comes_to(1, 2s));
  }
  for (int i = 0; i < 3; ++i) {
    serving.count();
    std::this_thread::sleep_for(30ms);
  }
  EXPECT_TRUE(serving.comes_to(0, 2s));
  const Client sips(serving.port(), 4096);  // reads, but so slowly that it would hold its place for hours
  ASSERT_TRUE(sips.say(kGet));
  std::size_t n = 0;
  for (std::string piece = sips.heard(); !piece.empty() && n < 8'000'000; piece = sips.heard()) {
    n += piece.size();
    std::this_thread::sleep_for(20ms);
  }
  EXPECT_LT(n, 8'000'000U);
}

TEST(BoundedServer, SaysWhereNobodyCanListen) {
  const Serving serving;
  for (const auto& [host, port] :
       {std::pair("127.0.0.1", serving.port()), std::pair("203.0.113.9", 0), std::pair("no such host", 0)}) {
    try {
      const BoundedServer second(host, port, [](const HttpRequest&) { return HttpAnswer(); });
      ADD_FAILURE() << host;
    } catch (const InputError& e) {
      EXPECT_THAT(e.what(), HasSubstr(host));
    }
  }
}

}  // namespace
}  // namespace driftwright::follow::bounded_server_test
