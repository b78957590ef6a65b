#pragma once
// A small HTTP server that nobody can keep busy: one thread, sockets that never wait, and a bound to all that a client may take of memory, places and time.
//
// It answers GET and HEAD with a text that it has or with a stream of texts, closes behind each answer, and reads no bodies. Libraries for such
// servers read heads of any length for any time, or hold a thread for each client; of the one in Debian 12 (cpp-httplib 0.11) neither can be set.

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "follow/http_request.hpp"

namespace driftwright::follow {

struct ServerBounds {
  std::size_t head_bytes = 16384;  ///< more are answered by 431
  std::chrono::milliseconds head_within{5000};
  std::size_t n_connections = 64;
  /// Where all places are taken a newcomer gets that of the one whose head has been waited for longest, if so long; else it waits itself.
  std::chrono::milliseconds place_for_sure{250};
  std::chrono::milliseconds patience{5000};  ///< with one who does not read an answer or a message of a stream ...
  double least_bytes_per_s = 20000.0;        ///< ... and by its length as much more as it takes at such a pace
};

struct HttpAnswer {
  int status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::shared_ptr<const std::string> body;  ///< shared by all who read it: a page may be megabytes
  std::function<std::string()>
      next;  ///< of a stream, in place of the body: what has come since it was asked last; "" for nothing
};
[[nodiscard]] HttpAnswer plain_answer(int status, std::string words);

class BoundedServer {
 public:
  using Answer = std::function<HttpAnswer(const HttpRequest&)>;

  /// Listens. @param port  0: any that is free
  /// @throws InputError  where nobody can listen there
  BoundedServer(const std::string& host, int port, Answer answer, ServerBounds bounds = {});
  ~BoundedServer();
  BoundedServer(const BoundedServer&) = delete;
  BoundedServer& operator=(const BoundedServer&) = delete;

  /// Does all that can be done without waiting for anybody, and waits for something to do for so long at most. To be called again and again; answers and
  /// streams are asked for within it.
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
  std::chrono::steady_clock::time_point accepts_from_;  // later than now where the system has no descriptors left
  std::vector<std::unique_ptr<Connection>> connections_;
};

}  // namespace driftwright::follow
