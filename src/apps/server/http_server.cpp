// SPDX-License-Identifier: Apache-2.0
#include "apps/server/http_server.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <boost/asio/dispatch.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/strand.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <deque>
#include <limits>
#include <thread>
#include <utility>  // Boost 1.74 uses std::exchange without it

#include "apps/server/guard.h"
#include "core/base/error.h"

namespace cei3d {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using tcp = asio::ip::tcp;
using Seconds = std::chrono::seconds;
using BoostError = beast::error_code;

constexpr int kThreads = 2;  // enough, because they only transfer bytes
constexpr int kMaxConnections = 64;
constexpr size_t kMaxHeader = size_t(16) << 10;    // bytes
constexpr size_t kMaxMessage = size_t(256) << 10;  // bytes, from a WebSocket
constexpr Seconds kIdle{60}, kBodyTime{300}, kLinger{2};
constexpr Seconds kFirstMessage{2};  // a WebSocket without a message after this time is closed

std::string text_of(beast::string_view v) { return {v.data(), v.size()}; }

template <class Message>
HttpRequest head_of(const Message& m) {
  HttpRequest r;
  r.method = text_of(m.method_string());
  const std::string target = text_of(m.target());
  const size_t question = target.find('?');
  r.path = target.substr(0, question);
  if (question != std::string::npos) r.query = target.substr(question + 1);
  r.host = text_of(m[http::field::host]);
  r.origin = text_of(m[http::field::origin]);
  r.fetch_site = text_of(m["Sec-Fetch-Site"]);
  r.authorization = text_of(m[http::field::authorization]);
  r.content_type = text_of(m[http::field::content_type]);
  r.if_match = text_of(m[http::field::if_match]);
  r.if_none_match = text_of(m[http::field::if_none_match]);
  return r;
}

HttpResponse too_large() { return error_response(413, "This is more than the editor takes."); }

// One WebSocket: reads messages, and writes those of its queue one after the other.
class WebSocket : public Socket, public std::enable_shared_from_this<WebSocket> {
 public:
  WebSocket(tcp::socket socket, HttpApp& app, std::shared_ptr<std::atomic<int>> count)
      : stream_(std::move(socket)), silence_(stream_.get_executor()), app_(app), count_(std::move(count)) {}
  ~WebSocket() override { --*count_; }

  void accept(const http::request<http::empty_body>& request) {
    stream_.set_option(websocket::stream_base::timeout::suggested(beast::role_type::server));
    stream_.set_option(websocket::stream_base::decorator([](websocket::response_type& r) {
      for (const auto& [name, value] : safety_headers()) r.set(name, value);
    }));
    stream_.read_message_max(kMaxMessage);
    stream_.async_accept(request, [self = shared_from_this()](BoostError error) {
      if (error) return;
      self->app_.opened(self);
      self->open_ = true;
      self->close_if_silent();
      self->read();
    });
  }

  void send(std::string text) override { queue({std::move(text), true, 0}); }
  void send_picture(std::string bytes, uint64_t group) override { queue({std::move(bytes), false, group}); }
  void close() override {
    asio::dispatch(stream_.get_executor(), [self = shared_from_this()] {
      beast::get_lowest_layer(self->stream_).cancel();
      beast::get_lowest_layer(self->stream_).close();
    });
  }

 private:
  struct Message {
    std::string bytes;
    bool text;
    uint64_t group;
  };

  void queue(Message message) {
    auto shared = std::make_shared<Message>(std::move(message));
    asio::dispatch(stream_.get_executor(), [self = shared_from_this(), shared] {
      if (self->ended_) return;
      std::deque<Message>& waiting = self->waiting_;
      if (!shared->text) {
        const auto old = [&](const Message& m) { return !m.text && m.group != shared->group; };
        waiting.erase(std::remove_if(waiting.begin(), waiting.end(), old), waiting.end());
      }
      waiting.push_back(std::move(*shared));
      self->write();
    });
  }

  void write() {
    if (writing_ || waiting_.empty() || ended_) return;
    writing_ = true;
    current_ = std::move(waiting_.front());
    waiting_.pop_front();
    stream_.text(current_.text);
    stream_.async_write(asio::buffer(current_.bytes), [self = shared_from_this()](BoostError error, size_t) {
      self->writing_ = false;
      if (error) return self->end();
      self->write();
    });
  }

  // Closes a socket whose first message does not come in time, so that those who have no key cannot use up
  // the connections.
  void close_if_silent() {
    silence_.expires_after(kFirstMessage);
    silence_.async_wait([self = shared_from_this()](BoostError error) {
      if (!error) self->close();
    });
  }

  void read() {
    stream_.async_read(buffer_, [self = shared_from_this()](BoostError error, size_t) {
      self->silence_.cancel();
      // After a failed write the app has dropped this window, so what is still read is ignored.
      if (error || self->ended_) return self->end();
      const std::string text = beast::buffers_to_string(self->buffer_.data());
      self->buffer_.consume(self->buffer_.size());
      self->app_.received(self, text);
      self->read();
    });
  }

  void end() {
    if (std::exchange(ended_, true)) return;
    waiting_.clear();
    if (open_) app_.closed(shared_from_this());
  }

  websocket::stream<beast::tcp_stream> stream_;
  asio::steady_timer silence_;
  HttpApp& app_;
  std::shared_ptr<std::atomic<int>> count_;
  beast::flat_buffer buffer_;
  std::deque<Message> waiting_;
  Message current_{};
  bool writing_ = false, ended_ = false, open_ = false;
};

// One connection: request after request.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(tcp::socket socket, HttpApp& app, std::shared_ptr<std::atomic<int>> count)
      : stream_(std::move(socket)), app_(app), count_(std::move(count)) {}
  ~Connection() {
    if (count_) --*count_;
  }

  void start() {
    asio::dispatch(stream_.get_executor(), [self = shared_from_this()] { self->read_head(); });
  }

 private:
  void read_head() {
    head_.emplace();
    head_->header_limit(kMaxHeader);
    head_->body_limit(std::numeric_limits<uint64_t>::max());  // see read_body()
    stream_.expires_after(kIdle);
    http::async_read_header(stream_, buffer_, *head_, [self = shared_from_this()](BoostError error, size_t) {
      if (error == http::error::header_limit)
        return self->refuse(error_response(431, "The headers are too long."));
      if (error) return self->close();
      self->read_body();
    });
  }

  void read_body() {
    const HttpRequest head = head_of(head_->get());
    const bool upgrade = websocket::is_upgrade(head_->get());
    if (auto refusal = app_.refuse(head)) return refuse(std::move(*refusal));
    if (upgrade) return become_socket(head);
    const size_t limit = app_.body_limit(head);
    if (head_->content_length().value_or(0) > limit) return refuse(too_large());
    body_.emplace(std::move(*head_));
    body_->body_limit(limit);  // of a body in chunks
    stream_.expires_after(kBodyTime);
    http::async_read(stream_, buffer_, *body_, [self = shared_from_this()](BoostError error, size_t) {
      if (error == http::error::body_limit) return self->refuse(too_large());
      if (error) return self->close();
      self->answer();
    });
  }

  void become_socket(const HttpRequest& head) {
    if (head.path != "/socket") return refuse(error_response(404, "There is no such socket."));
    stream_.expires_never();
    http::request<http::empty_body> request = head_->release();
    auto socket = std::make_shared<WebSocket>(stream_.release_socket(), app_, std::move(count_));
    socket->accept(request);
  }

  void answer() {
    http::request<http::string_body> message = body_->release();
    keep_alive_ = message.keep_alive();
    only_head_ = message.method() == http::verb::head;
    HttpRequest request = head_of(message);
    request.body = std::move(message.body());
    stream_.expires_never();  // while the program works
    app_.answer(std::move(request), [self = shared_from_this()](HttpResponse response) {
      auto shared = std::make_shared<HttpResponse>(std::move(response));
      asio::dispatch(self->stream_.get_executor(), [self, shared] { self->write(std::move(*shared)); });
    });
  }

  // Sends the response and ends the connection.
  void refuse(HttpResponse response) {
    keep_alive_ = false;
    write(std::move(response));
  }

  void write(HttpResponse r) {
    response_ = {};
    response_.version(11);
    response_.result(unsigned(r.status));
    for (const auto& [name, value] : safety_headers()) response_.set(name, value);
    response_.set(http::field::content_type, r.type);
    response_.set(http::field::cache_control, "no-store");
    for (const auto& [name, value] : r.headers) response_.set(name, value);
    response_.keep_alive(keep_alive_);
    response_.content_length(r.body.size());
    if (!only_head_ && r.status != 304) response_.body() = std::move(r.body);
    stream_.expires_after(kBodyTime);
    http::async_write(stream_, response_, [self = shared_from_this()](BoostError error, size_t) {
      if (error || !self->keep_alive_) return self->close();
      self->body_.reset();
      self->read_head();
    });
  }

  // Reads and drops what the other side still sends for a while. If the socket were closed at once, the
  // system would discard the part of the answer that the other side has not read yet.
  void close() {
    BoostError ignored;
    stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    stream_.expires_after(kLinger);
    drop_rest();
  }

  void drop_rest() {
    stream_.async_read_some(asio::buffer(dropped_), [self = shared_from_this()](BoostError error, size_t) {
      if (!error) self->drop_rest();
    });
  }

  beast::tcp_stream stream_;
  HttpApp& app_;
  std::shared_ptr<std::atomic<int>> count_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::empty_body>> head_;
  std::optional<http::request_parser<http::string_body>> body_;
  http::response<http::string_body> response_;
  std::array<char, 4096> dropped_;
  bool keep_alive_ = false, only_head_ = false;
};

}  // namespace

struct HttpServer::State {
  explicit State(HttpApp& a) : app(a) {}

  void listen(const HttpOptions& options) {
    BoostError error;
    const auto address = asio::ip::make_address(options.host, error);
    if (error) fail_usage("'{}' is no address to listen at; give one such as 127.0.0.1.", options.host);
    constexpr int kTries = 20;
    for (int i = 0; i < (options.next_if_taken ? kTries : 1); ++i) {
      acceptor = std::make_unique<tcp::acceptor>(context);
      const tcp::endpoint at(address, uint16_t(options.port + i));
      acceptor->open(at.protocol());
      acceptor->set_option(asio::socket_base::reuse_address(true));
      acceptor->bind(at, error);
      if (!error) acceptor->listen(kMaxConnections, error);
      if (!error) return;
    }
    fail("Cannot listen at {}:{}: {}; choose another port with --port.", options.host, options.port,
         error.message());
  }

  void accept() {
    acceptor->async_accept(asio::make_strand(context), [this](BoostError error, tcp::socket socket) {
      if (error == asio::error::operation_aborted) return;
      if (!error && ++*connections <= kMaxConnections) {
        BoostError ignored;
        socket.set_option(tcp::no_delay(true), ignored);
        std::make_shared<Connection>(std::move(socket), app, connections)->start();
      } else if (!error) {
        --*connections;  // refused: the socket closes here
      }
      accept();
    });
  }

  HttpApp& app;
  asio::io_context context{kThreads};
  std::unique_ptr<tcp::acceptor> acceptor;
  std::shared_ptr<std::atomic<int>> connections = std::make_shared<std::atomic<int>>(0);
};

HttpServer::HttpServer(HttpApp& app, const HttpOptions& options) : state_(std::make_unique<State>(app)) {
  state_->listen(options);
}
HttpServer::~HttpServer() = default;

int HttpServer::port() const { return state_->acceptor->local_endpoint().port(); }

void HttpServer::run(const std::function<bool()>& stop) {
  state_->accept();
  std::vector<std::thread> threads;
  for (int i = 0; i < kThreads; ++i) threads.emplace_back([this] { state_->context.run(); });
  while (!stop()) std::this_thread::sleep_for(std::chrono::milliseconds(100));
  state_->context.stop();
  for (std::thread& t : threads) t.join();
}

}  // namespace cei3d
