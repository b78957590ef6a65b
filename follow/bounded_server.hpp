#pragma once
// A small HTTP server that no client can block: one thread, sockets that never wait, and limits on the memory,
// connections and time that a client may take.
//
// It answers GET and HEAD with a fixed text or with a stream of texts, closes the connection after each answer, and reads
// no bodies. Libraries for such servers read request heads of any length for any time, or hold a thread for each client;
// neither can be limited in the one of Debian 12 (cpp-httplib 0.11).

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "follow/http_request.hpp"

namespace driftwright::follow {

struct ServerBounds {
  std::size_t head_bytes = 16384;  ///< longest request head; a longer one is answered by 431
  std::chrono::milliseconds head_within{5000};
  std::size_t n_connections = 64;
  /// With all connections in use, a newcomer replaces the client whose request head (or whose closing) has been awaited
  /// longest, if that is longer than this; otherwise the newcomer waits.
  std::chrono::milliseconds place_for_sure{250};
  std::chrono::milliseconds patience{5000};  ///< time that a client has to read an answer or a message of a stream ...
  double least_bytes_per_s = 20000.0;        ///< ... plus its length divided by this rate
};

struct HttpAnswer {
  int status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::shared_ptr<const std::string> body;  ///< shared by all readers: a page may have megabytes
  std::function<std::string()>
      next;  ///< for a stream, instead of the body: returns what is new since the last call; "" for nothing
};
[[nodiscard]] HttpAnswer plain_answer(int status, std::string words);

class BoundedServer {
 public:
  using Answer = std::function<HttpAnswer(const HttpRequest&)>;

  /// Starts to listen. @param port  0: any free port
  /// @throws InputError  if it cannot listen there
  BoundedServer(const std::string& host, int port, Answer answer, ServerBounds bounds = {});
  ~BoundedServer();
  BoundedServer(const BoundedServer&) = delete;
  BoundedServer& operator=(const BoundedServer&) = delete;

  /// Does all that is possible without waiting, then waits up to `at_most` for something to do. Call it again and again;
  /// `Answer` and the streams' `next` are called within it.
  void turn(std::chrono::milliseconds at_most);

  [[nodiscard]] int port() const { return port_; }
  [[nodiscard]] std::size_t n_connections() const { return connections_.size(); }
  [[nodiscard]] std::size_t n_streams() const;

 private:
  struct Connection;
  struct Socket;
  void accept_all();
  [[nodiscard]] const Connection* who_makes_room() const;
  [[nodiscard]] std::chrono::steady_clock::time_point when_read(const Connection& c) const;
  void hear(Connection& c);
  void begin_answer(Connection& c, const HttpAnswer& answer, bool with_body);
  void begin_message(Connection& c);
  void say(Connection& c);
  void linger(Connection& c);

  Answer answer_;
  ServerBounds bounds_;
  int port_ = 0;
  std::unique_ptr<Socket> listening_;
  std::chrono::steady_clock::time_point accepts_from_;  // in the future while the system has no descriptors left
  std::vector<std::unique_ptr<Connection>> connections_;
};

}  // namespace driftwright::follow
