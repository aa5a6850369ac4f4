// The server of the page, over real sockets of this machine.
#include <atomic>
#include <boost/asio/connect.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "live/page_server.h"
#include "live/session.h"
#include "support/cli_fixture.h"
#include "vantage/error.h"

namespace vantage::live {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;
using Json = nlohmann::json;
using Socket = websocket::stream<asio::ip::tcp::socket>;

/// Where computations are held until it is opened.
class WorkGate {
 public:
  void pass() {
    std::unique_lock lock(mutex_);
    if (is_open_ || (most_ > 0 && came_ >= most_)) return;
    ++came_;
    changed_.notify_all();
    changed_.wait(lock, [this] { return is_open_; });
  }
  /// From now on: holds so many, and lets all others pass.
  void close(int most) {
    const std::lock_guard lock(mutex_);
    is_open_ = false;
    most_ = most;
  }
  void open() {
    const std::lock_guard lock(mutex_);
    is_open_ = true;
    changed_.notify_all();
  }
  void wait_for(int count) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return came_ >= count; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_open_ = true;
  int came_ = 0, most_ = 0;
};

class LiveServerThread : public testing::Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    session_.open_file(folder_ / "mission.yaml");
    server_ = std::make_unique<PageServer>(0);
    server_->set_before_work([this](const std::string& call) {
      if (call == "compute") gate_.pass();
    });
    thread_ = std::thread(
        [this] { server_->run(session_, "<html><!--LIVE--></html>", 0, [this] { return is_over_.load(); }); });
  }
  void TearDown() override {
    gate_.open();
    is_over_ = true;
    if (thread_.joinable()) thread_.join();
    Cli::TearDown();
  }

  std::string host() const { return "127.0.0.1:" + std::to_string(server_->port()); }
  std::string path(const std::string& to = "/") const { return to + "?token=" + server_->token(); }

  asio::ip::tcp::socket connected() {
    asio::ip::tcp::socket socket(context_);
    socket.connect({asio::ip::address_v4::loopback(), server_->port()});
    return socket;
  }

  http::response<http::string_body> get(const std::string& target, const std::string& host,
                                        http::verb verb = http::verb::get) {
    asio::ip::tcp::socket socket = connected();
    http::request<http::empty_body> request(verb, target, 11);
    request.set(http::field::host, host);
    http::write(socket, request);
    beast::flat_buffer buffer;
    http::response<http::string_body> response;
    http::read(socket, buffer, response);
    return response;
  }

  /// No error is a yes.
  beast::error_code handshake(Socket& socket, const std::string& origin, const std::string& target) {
    socket.set_option(websocket::stream_base::decorator(
        [&](websocket::request_type& request) { request.set(http::field::origin, origin); }));
    beast::error_code error;
    socket.handshake(host(), target, error);
    return error;
  }

  /// The header of the answer.
  static Json ask(Socket& socket, const Json& message) {
    socket.write(asio::buffer(message.dump()));
    return next(socket);
  }
  static Json next(Socket& socket) {
    beast::flat_buffer buffer;
    socket.read(buffer);
    const std::string text = beast::buffers_to_string(buffer.data());
    std::uint32_t length = 0;
    std::memcpy(&length, text.data(), sizeof length);
    return Json::parse(text.substr(4, length));
  }
  /// Waits for no answer before all is asked. The headers of the answers, by id.
  static std::map<int, Json> ask_at_once(Socket& socket, const std::vector<Json>& messages) {
    for (const Json& message : messages) socket.write(asio::buffer(message.dump()));
    std::map<int, Json> answers;
    for (std::size_t n = 0; n < messages.size(); ++n) {
      const Json answer = next(socket);
      answers[answer["id"]] = answer;
    }
    return answers;
  }

  Socket opened() {
    Socket socket(connected());
    EXPECT_EQ(handshake(socket, "http://" + host(), path("/socket")), beast::error_code());
    return socket;
  }

  asio::io_context context_;
  WorkGate gate_;
  Session session_;
  std::unique_ptr<PageServer> server_;
  std::atomic<bool> is_over_ = false;
  std::thread thread_;
};

TEST_F(LiveServerThread, ThePageIsForWhoHasTheToken) {
  const http::response<http::string_body> page = get(path(), host());
  EXPECT_EQ(page.result(), http::status::ok);
  EXPECT_NE(page.body().find(path("/socket")), std::string::npos);
  const auto policy = page["Content-Security-Policy"];
  EXPECT_FALSE(policy.empty());
  EXPECT_EQ(get("/", host()).result(), http::status::forbidden);
  EXPECT_EQ(get(path() + "0", host()).result(), http::status::forbidden);
  EXPECT_EQ(get(path("/../etc/passwd"), host()).result(), http::status::forbidden);
  EXPECT_EQ(get(path(), "evil.example").result(), http::status::misdirected_request);
  EXPECT_EQ(get(path(), host(), http::verb::delete_).result(), http::status::method_not_allowed);
}

TEST_F(LiveServerThread, WhatIsNoRequestIsToldSo) {
  for (const char* const text : {"\x16\x03\x01 secure?\r\n\r\n", "GET\r\n\r\n", "GET / HTTP/1.1\r\nno colon\r\n\r\n"}) {
    asio::ip::tcp::socket socket = connected();
    asio::write(socket, asio::buffer(std::string(text)));
    beast::flat_buffer buffer;
    http::response<http::string_body> response;
    http::read(socket, buffer, response);
    EXPECT_EQ(response.result(), http::status::bad_request) << text;
  }
  EXPECT_EQ(get(path(), host()).result(), http::status::ok);
}

TEST_F(LiveServerThread, NothingMayBeSentBeforeTheSocketIsOpen) {
  const std::string request = "GET " + path("/socket") + " HTTP/1.1\r\nHost: " + host() + "\r\nOrigin: http://" +
                              host() +
                              "\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
                              "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n";
  for (const bool is_early : {false, true}) {
    asio::ip::tcp::socket socket = connected();
    asio::write(socket, asio::buffer(request + (is_early ? std::string("\x81\x80....", 6) : std::string())));
    beast::flat_buffer buffer;
    http::response<http::string_body> response;
    http::read(socket, buffer, response);
    EXPECT_EQ(response.result(), is_early ? http::status::bad_request : http::status::switching_protocols);
  }
}

TEST_F(LiveServerThread, TheSocketIsForThePage) {
  for (const std::string& origin : {std::string("http://evil.example"), std::string("null"), std::string()}) {
    Socket socket(connected());
    EXPECT_EQ(handshake(socket, origin, path("/socket")), websocket::error::upgrade_declined) << origin;
  }
  Socket socket(connected());
  EXPECT_EQ(handshake(socket, "http://" + host(), "/socket?token=0"), websocket::error::upgrade_declined);
}

TEST_F(LiveServerThread, AnswersAndDropsWhatIsStale) {
  Socket socket = opened();
  const Json hello = ask(socket, {{"id", 1}, {"request", {{"call", "hello"}}}});
  EXPECT_EQ(hello["value"]["name"], "mission.yaml");
  const auto compute = [](int id, double range) {
    return Json{{"id", id},
                {"request",
                 {{"call", "compute"},
                  {"text", std::string(testing::kTarget) + "sensor: {max_range: " + std::to_string(range) + "}\n"}}}};
  };
  for (int id = 2; id < 20; ++id) socket.write(asio::buffer(compute(id, 30.0 + id).dump()));
  // Each is answered once, with its own range or as stale; the last one is never stale.
  std::set<int> ids;
  for (int n = 2; n < 20; ++n) {
    const Json answer = next(socket);
    const int id = answer["id"];
    EXPECT_TRUE(ids.insert(id).second) << id;
    EXPECT_NE(answer.contains("stale"), answer.contains("value")) << id;
    if (answer.contains("value")) {
      const double range = answer["value"]["limits"]["max_range"];
      EXPECT_EQ(range, 30.0 + id);
    }
    EXPECT_FALSE(id == 19 && answer.contains("stale"));
  }
  EXPECT_EQ(*ids.begin(), 2);
  EXPECT_EQ(*ids.rbegin(), 19);
}

TEST_F(LiveServerThread, StopsWhatIsComputed) {
  Socket socket = opened();
  const auto compute = [](int id, double tolerance) {
    const std::string text =
        std::string(testing::kTarget) + testing::kSensor + "exact: {tolerance: " + std::to_string(tolerance) + "}\n";
    return Json{{"id", id}, {"request", {{"call", "compute"}, {"text", text}}}};
  };
  ASSERT_TRUE(ask(socket, compute(1, 0.01)).contains("value"));
  constexpr double kFine = 1e-5;  // millions of facets: seconds
  std::map<int, Json> answers =
      ask_at_once(socket, {compute(2, kFine), compute(3, kFine), {{"id", 4}, {"request", {{"call", "stop"}}}}});
  EXPECT_EQ(answers[2]["error"]["code"], "cancelled") << answers[2].dump(1).substr(0, 300);
  EXPECT_EQ(answers[3]["error"]["code"], "cancelled");
  EXPECT_TRUE(answers[4].contains("value"));
  // The last volume is still there, and what is asked next is not stopped.
  EXPECT_TRUE(ask(socket, {{"id", 5}, {"request", {{"call", "slice"}, {"z", 10}}}}).contains("value"));
  EXPECT_TRUE(ask(socket, compute(6, 0.02)).contains("value"));
}

Json compute_request(int id) {
  const std::string text = std::string(testing::kTarget) + testing::kSensor;
  return Json{{"id", id}, {"request", {{"call", "compute"}, {"text", text}}}};
}

// What takes long in one window holds up none of the others.
TEST_F(LiveServerThread, AWindowDoesNotWaitForAnotherOne) {
  gate_.close(1);
  Socket slow = opened(), other = opened();
  slow.write(asio::buffer(compute_request(1).dump()));
  gate_.wait_for(1);
  EXPECT_TRUE(ask(other, compute_request(2)).contains("value"));
  EXPECT_TRUE(ask(other, {{"id", 3}, {"request", {{"call", "slice"}, {"z", 10}}}}).contains("value"));
  gate_.open();
  const Json answer = next(slow);
  EXPECT_EQ(answer["id"], 1);
  EXPECT_TRUE(answer.contains("value"));
}

// Four compute at once; others wait, are told so, and can be stopped. What is quick goes on.
TEST_F(LiveServerThread, AFewComputeAtOnce) {
  gate_.close(0);
  std::vector<std::unique_ptr<Socket>> windows;
  for (int i = 0; i < 4; ++i) {
    windows.push_back(std::make_unique<Socket>(opened()));
    windows.back()->write(asio::buffer(compute_request(1).dump()));
  }
  gate_.wait_for(4);
  Socket fifth = opened(), sixth = opened();
  for (Socket* const late : {&fifth, &sixth}) {
    const Json notice = ask(*late, compute_request(1));
    EXPECT_EQ(notice, (Json{{"id", 1}, {"waits", true}}));
  }
  EXPECT_TRUE(ask(*windows[0], {{"id", 9}, {"request", {{"call", "stop"}}}}).contains("value"));
  Socket seventh = opened();
  EXPECT_TRUE(ask(seventh, {{"id", 1}, {"request", {{"call", "about"}}}}).contains("value"));
  std::map<int, Json> stopped = ask_at_once(sixth, {{{"id", 2}, {"request", {{"call", "stop"}}}}});
  const Json last = next(sixth);
  stopped[last["id"]] = last;
  EXPECT_EQ(stopped[1]["error"]["code"], "cancelled");
  EXPECT_TRUE(stopped[2].contains("value"));
  gate_.open();
  EXPECT_EQ(next(fifth), (Json{{"id", 1}, {"waits", false}}));
  EXPECT_TRUE(next(fifth).contains("value"));
  for (std::size_t i = 1; i < windows.size(); ++i) EXPECT_TRUE(next(*windows[i]).contains("value"));
  EXPECT_TRUE(ask(sixth, compute_request(3)).contains("value"));
}

// A proof that waits for its turn can be stopped, too.
TEST_F(LiveServerThread, StopsAProofThatWaits) {
  Socket proving = opened();
  EXPECT_TRUE(ask(proving, compute_request(1)).contains("value"));
  gate_.close(0);
  std::vector<std::unique_ptr<Socket>> windows;
  for (int i = 0; i < 4; ++i) {
    windows.push_back(std::make_unique<Socket>(opened()));
    windows.back()->write(asio::buffer(compute_request(1).dump()));
  }
  gate_.wait_for(4);
  EXPECT_EQ(ask(proving, {{"id", 2}, {"request", {{"call", "prove"}}}}), (Json{{"id", 2}, {"waits", true}}));
  EXPECT_EQ(ask(proving, {{"id", 3}, {"request", {{"call", "stop"}}}})["error"]["code"], "cancelled");
  EXPECT_TRUE(next(proving).contains("value"));
  gate_.open();
}

// Whoever knows the token gets in, however many there are who do not.
TEST_F(LiveServerThread, ConnectionsWithoutTheTokenDoNotKeepTheOwnerOut) {
  std::vector<asio::ip::tcp::socket> unauthenticated;
  for (int i = 0; i < 150; ++i) {
    unauthenticated.push_back(connected());
    if (i % 2 == 0)
      asio::write(unauthenticated.back(), asio::buffer(std::string("GET / HTTP/1.1\r\nHost: 127")));  // never more
  }
  EXPECT_EQ(get(path(), host()).result(), http::status::ok);
  Socket socket = opened();
  EXPECT_TRUE(ask(socket, {{"id", 1}, {"request", {{"call", "about"}}}}).contains("value"));
  // The oldest ones were closed.
  char byte = 0;
  beast::error_code error;
  unauthenticated.front().read_some(asio::buffer(&byte, 1), error);
  EXPECT_TRUE(error == asio::error::eof || error == asio::error::connection_reset) << error.message();
  EXPECT_EQ(get("/", host()).result(), http::status::forbidden);
}

TEST_F(LiveServerThread, TalksToSixteenWindows) {
  std::vector<std::unique_ptr<Socket>> windows;
  for (int i = 0; i < 16; ++i) windows.push_back(std::make_unique<Socket>(opened()));
  Socket one_more(connected());
  EXPECT_EQ(handshake(one_more, "http://" + host(), path("/socket")), websocket::error::upgrade_declined);
  for (const auto& window : windows)
    EXPECT_TRUE(ask(*window, {{"id", 1}, {"request", {{"call", "about"}}}}).contains("value"));
  windows.front()->close(websocket::close_code::normal);
  windows.erase(windows.begin());
  beast::error_code error = websocket::error::upgrade_declined;
  for (int tries = 0; tries < 100 && error; ++tries) {  // until the server has noticed
    Socket again(connected());
    error = handshake(again, "http://" + host(), path("/socket"));
    if (error) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_FALSE(error) << error.message();
}

TEST_F(LiveServerThread, StopsAProof) {
  Socket socket = opened();
  const std::string text = std::string(testing::kTarget) + testing::kSensor + "exact: {tolerance: 0.001}\n";
  ASSERT_TRUE(ask(socket, {{"id", 1}, {"request", {{"call", "compute"}, {"text", text}}}}).contains("value"));
  std::map<int, Json> answers = ask_at_once(
      socket, {{{"id", 2}, {"request", {{"call", "prove"}}}}, {{"id", 3}, {"request", {{"call", "stop"}}}}});
  EXPECT_EQ(answers[2]["error"]["code"], "cancelled") << answers[2].dump(1).substr(0, 300);
  EXPECT_TRUE(answers[3].contains("value"));
  const Json proved = ask(socket, {{"id", 4}, {"request", {{"call", "prove"}}}});
  EXPECT_EQ(proved["value"]["verdict"], "proved") << proved.dump(1).substr(0, 300);
}

TEST_F(LiveServerThread, AnswersAllThatIsAskedHoweverLateItIsRead) {
  Socket socket = opened();
  const Json compute{{"id", 0},
                     {"request", {{"call", "compute"}, {"text", std::string(testing::kTarget) + testing::kSensor}}}};
  ASSERT_TRUE(ask(socket, compute).contains("value"));
  constexpr int kMany = 150;  // more than may wait
  std::thread asking([&] {
    for (int id = 1; id <= kMany; ++id)
      socket.write(asio::buffer(Json{{"id", id}, {"request", {{"call", "slice"}, {"z", 10}}}}.dump()));
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  for (int id = 1; id <= kMany; ++id) {
    const Json answer = next(socket);
    EXPECT_EQ(answer["id"], id);
    EXPECT_TRUE(answer.contains("value"));
  }
  asking.join();
}

TEST_F(LiveServerThread, EachPageHasItsOwnSession) {
  Socket one = opened(), other = opened();
  const Json compute{{"id", 1},
                     {"request", {{"call", "compute"}, {"text", std::string(testing::kTarget) + testing::kSensor}}}};
  EXPECT_TRUE(ask(one, compute).contains("value"));
  EXPECT_TRUE(ask(other, {{"id", 2}, {"request", {{"call", "prove"}}}}).contains("error"));
  EXPECT_TRUE(ask(one, {{"id", 3}, {"request", {{"call", "prove"}}}}).contains("value"));
}

TEST_F(LiveServerThread, OthersThanThePageAreLeft) {
  for (const std::string& message :
       {std::string("{"), std::string("\xff\xfe"), std::string(5 << 20, 'x'), std::string("[1]")}) {
    Socket socket = opened();
    beast::error_code error;
    socket.write(asio::buffer(message), error);
    beast::flat_buffer buffer;
    socket.read(buffer, error);
    EXPECT_TRUE(error);
  }
  {
    asio::ip::tcp::socket garbage = connected();
    asio::write(garbage, asio::buffer(std::string(20000, 'x')));
  }
  { Socket leaves_in_the_middle = opened(); }
  EXPECT_EQ(get(path(), host()).result(), http::status::ok);
}

TEST_F(LiveServerThread, AUsedPortAndAnotherPageAreErrors) {
  const auto code_of = [&](const std::string& page, std::uint16_t port) {
    try {
      PageServer second(port);
      second.run(Session(), page, 0, [] { return true; });
    } catch (const Error& error) {
      return error.code();
    }
    return ErrorCode::internal_defect;
  };
  EXPECT_EQ(code_of("<!--LIVE-->", server_->port()), ErrorCode::port_unavailable);
  EXPECT_EQ(code_of("<html></html>", 0), ErrorCode::page_missing);
}

}  // namespace
}  // namespace vantage::live
