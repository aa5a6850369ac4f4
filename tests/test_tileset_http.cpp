// Tilesets over the network: a server on this machine that behaves as those of Google's tiles do.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "support/mesh_reading.h"
#include "support/tile_files.h"
#include "support/wording.h"
#include "tiles/http_source.h"
#include "vantage/tileset.h"

namespace vantage {
namespace {

using nlohmann::json;
using testing::box_glb;
using testing::expect_code;
using testing::tile_json;
using testing::tileset_json;

struct Answer {
  int status = 200;
  std::string body;
  std::string headers = {};
  int bytes_per_s = 0;     ///< 0: at once
  bool is_silent = false;  ///< the connection is closed without an answer
};

/// Answers one request after the other, on a port of its own.
class Server {
 public:
  using Handler = std::function<Answer(const std::string& target)>;

  explicit Server(Handler handler) : handler_(std::move(handler)) {
    socket_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t length = sizeof address;
    if (::bind(socket_, reinterpret_cast<sockaddr*>(&address), length) != 0 || ::listen(socket_, 16) != 0) return;
    ::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &length);
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { serve(); });
  }
  ~Server() {
    is_over_ = true;
    ::shutdown(socket_, SHUT_RDWR);
    ::close(socket_);
    if (thread_.joinable()) thread_.join();
  }
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  std::string url(const std::string& target) const { return "http://127.0.0.1:" + std::to_string(port_) + target; }
  std::vector<std::string> asked() {
    const std::lock_guard lock(mutex_);
    return asked_;
  }

 private:
  void serve() {
    while (!is_over_) {
      const int connection = ::accept(socket_, nullptr, nullptr);
      if (connection < 0) return;
      std::string request;
      char buffer[4096];
      while (request.find("\r\n\r\n") == std::string::npos) {
        const ssize_t got = ::recv(connection, buffer, sizeof buffer, 0);
        if (got <= 0) break;
        request.append(buffer, static_cast<std::size_t>(got));
      }
      const std::size_t start = request.find(' ') + 1;
      const std::string target = request.substr(start, request.find(' ', start) - start);
      {
        const std::lock_guard lock(mutex_);
        asked_.push_back(target);
      }
      const Answer answer = handler_(target);
      const std::string text = "HTTP/1.1 " + std::to_string(answer.status) +
                               " x\r\nContent-Length: " + std::to_string(answer.body.size()) +
                               "\r\nConnection: close\r\n" + answer.headers + "\r\n" + answer.body;
      for (std::size_t sent = 0; sent < text.size() && !answer.is_silent && !is_over_;) {
        const std::size_t left = text.size() - sent;
        const ssize_t more = ::send(connection, text.data() + sent, answer.bytes_per_s > 0 ? 1 : left, MSG_NOSIGNAL);
        if (more <= 0) break;
        sent += static_cast<std::size_t>(more);
        if (answer.bytes_per_s > 0) std::this_thread::sleep_for(std::chrono::milliseconds(1000 / answer.bytes_per_s));
      }
      ::close(connection);
    }
  }

  Handler handler_;
  int socket_ = -1;
  int port_ = 0;
  std::atomic<bool> is_over_ = false;
  std::mutex mutex_;
  std::vector<std::string> asked_;
  std::thread thread_;
};

bool has(const std::string& target, const std::string& part) { return target.find(part) != std::string::npos; }

/// The root needs the key, and gives children with a session, which all below them need as well as the key.
class Photorealistic {
 public:
  int files_in_session = 1000;
  int sessions = 1;  ///< that it gives, one after the other, once the last is over

  Answer answer(const std::string& target) {
    if (!has(target, "key=SECRET")) return {403, "no key"};
    if (has(target, "/v1/3dtiles/root.json")) {
      json root = tile_json(1e6, "", 100);
      if (left_ <= 0 && number_ < sessions) {
        ++number_;
        left_ = files_in_session;
      }
      root["children"] =
          json::array({tile_json(1e3, "/v1/3dtiles/datasets/abc/files/top.json?a=1&session=" + session())});
      return {200, tileset_json(root).dump()};
    }
    if (!has(target, "session=" + session()) || left_-- <= 0) return {403, "over"};
    if (has(target, "top.json")) {
      json root = tile_json(1e3, "coarse.glb");
      root["children"] = json::array({tile_json(1, "a.glb"), tile_json(1, "/v1/3dtiles/datasets/abc/files/b.glb")});
      return {200, tileset_json(root).dump()};
    }
    return {200, box_glb({{}})};
  }

 private:
  std::string session() const { return "S" + std::to_string(number_); }

  int number_ = 0, left_ = 0;
};

/// Skips where there is no libcurl.
#define VANTAGE_REQUIRE_CURL()           \
  try {                                  \
    internal::tiles::HttpClient("here"); \
  } catch (const Error& error) {         \
    GTEST_SKIP() << error.what();        \
  }

TilesetOptions in_part() {
  TilesetOptions options;
  options.missing = MissingPolicy::warn;
  return options;
}

TEST(TilesetHttp, PassesTheKeyAndTheSessionOn) {
  VANTAGE_REQUIRE_CURL();
  Photorealistic tiles;
  Server server([&](const std::string& target) { return tiles.answer(target); });
  const TilesetScene read = read_tileset(server.url("/v1/3dtiles/root.json?key=SECRET"));
  EXPECT_EQ(read.report.contents, 2u);
  EXPECT_EQ(read.report.holes, 0u) << read.report.first_hole;
  EXPECT_EQ(read.report.triangles, 24u);
  for (const std::string& target : server.asked()) {
    EXPECT_TRUE(has(target, "key=SECRET")) << target;
    EXPECT_EQ(has(target, "session=S1"), !has(target, "root.json")) << target;
    EXPECT_FALSE(has(target, "coarse")) << target;
  }
  EXPECT_EQ(server.asked().size(), 4u);
  EXPECT_FALSE(has(read.scene.source.string(), "SECRET"));
  for (const SceneObject& object : read.scene.objects) EXPECT_FALSE(has(display_name(object), "SECRET"));
}

TEST(TilesetHttp, AnEndedSessionIsOneError) {
  VANTAGE_REQUIRE_CURL();
  Photorealistic tiles;
  tiles.files_in_session = 2;
  Server server([&](const std::string& target) { return tiles.answer(target); });
  const Error over = expect_code([&] { read_tileset(server.url("/v1/3dtiles/root.json?key=SECRET")); },
                                 ErrorCode::file_unreadable, "127.0.0.1");
  EXPECT_TRUE(has(over.problem(), "403")) << over.what();
  EXPECT_FALSE(has(over.what(), "SECRET"));
  const Error wrong = expect_code([&] { read_tileset(server.url("/v1/3dtiles/root.json?key=WRONG")); },
                                  ErrorCode::file_unreadable, "root.json");
  EXPECT_FALSE(has(wrong.what(), "WRONG"));
}

TEST(TilesetHttp, AsksForANewSessionWhenOneEnds) {
  VANTAGE_REQUIRE_CURL();
  Photorealistic tiles;
  tiles.files_in_session = 1;
  tiles.sessions = 3;
  Server server([&](const std::string& target) { return tiles.answer(target); });
  const TilesetScene read = read_tileset(server.url("/v1/3dtiles/root.json?key=SECRET"));
  EXPECT_EQ(read.report.contents, 2u);
  EXPECT_EQ(read.report.holes, 0u) << read.report.first_hole;
  std::vector<std::string> sessions;
  for (const std::string& target : server.asked()) {
    sessions.push_back(has(target, "root.json") ? "root" : target.substr(target.find("session=") + 8, 2));
    EXPECT_TRUE(has(target, "key=SECRET")) << target;
  }
  EXPECT_EQ(sessions, (std::vector<std::string>{"root", "S1", "S1", "root", "S2", "S2", "root", "S3"}));
}

TEST(TilesetHttp, StopsWhenNoSessionFollows) {
  VANTAGE_REQUIRE_CURL();
  Photorealistic tiles;
  tiles.files_in_session = 1;
  tiles.sessions = 2;
  Server server([&](const std::string& target) { return tiles.answer(target); });
  const Error over = expect_code([&] { read_tileset(server.url("/v1/3dtiles/root.json?key=SECRET")); },
                                 ErrorCode::file_unreadable, "127.0.0.1");
  EXPECT_TRUE(has(over.problem(), "403")) << over.what();
  EXPECT_TRUE(has(over.problem(), " 3 ")) << over.what();  // root, top and a tile were read
  EXPECT_EQ(server.asked().size(), 7u);
}

TEST(TilesetHttp, AServerThatNoLongerAnswersEndsTheReading) {
  VANTAGE_REQUIRE_CURL();
  Server server([&](const std::string& target) -> Answer {
    if (has(target, "a.glb")) return {200, box_glb({{}})};
    if (!has(target, "tileset.json")) return {200, "", "", 0, true};
    json root = tile_json(10);
    root["refine"] = "ADD";
    root["children"] = json::array({tile_json(0, "a.glb")});
    for (int i = 0; i < 1000; ++i) root["children"].push_back(tile_json(0, std::to_string(i) + ".glb"));
    return {200, tileset_json(root).dump()};
  });
  const Error over =
      expect_code([&] { read_tileset(server.url("/tileset.json"), in_part()); }, ErrorCode::file_unreadable, "4.glb");
  EXPECT_TRUE(has(over.problem(), " 5 ")) << over.what();
  EXPECT_TRUE(has(over.problem(), " 2 ")) << over.what();
  EXPECT_EQ(server.asked().size(), 2u + 3 + 4);  // the first is tried three times
}

TEST(TilesetHttp, ASlowServerIsNotWaitedFor) {
  VANTAGE_REQUIRE_CURL();
  Server server([](const std::string&) { return Answer{200, std::string(10'000, 'x'), "", 20}; });
  internal::tiles::HttpPatience patience;
  patience.slow_s = 1;
  patience.tries = patience.failures_in_a_row = 1;
  internal::tiles::HttpSource slow(server.url("/tileset.json"), patience);
  const auto start = std::chrono::steady_clock::now();
  expect_code([&] { slow.read(slow.root(), {}); }, ErrorCode::file_unreadable, "127.0.0.1");
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60));
  patience.all_files_s = 0;
  internal::tiles::HttpSource late(server.url("/tileset.json"), patience);
  const std::size_t before = server.asked().size();
  expect_code([&] { late.read(late.root(), {}); }, ErrorCode::file_unreadable, "127.0.0.1");
  EXPECT_EQ(server.asked().size(), before);
}

TEST(TilesetHttp, MissingFilesAreHolesAndOtherServersAreNotAsked) {
  VANTAGE_REQUIRE_CURL();
  std::atomic<int> busy = 1;
  Server server([&](const std::string& target) -> Answer {
    if (has(target, "gone")) return {404, "gone"};
    if (has(target, "moved")) return {302, "", "Location: http://127.0.0.1:1/x\r\n"};
    if (has(target, "busy") && busy-- > 0) return {503, "later"};
    if (has(target, ".glb")) return {200, box_glb({{}})};
    json root = tile_json(10);
    root["refine"] = "ADD";
    root["children"] = {tile_json(0, "gone.glb"), tile_json(0, "http://127.0.0.2:80/a.glb"), tile_json(0, "moved.glb"),
                        tile_json(0, "file:///etc/passwd"), tile_json(0, "../../busy.glb")};
    return {200, tileset_json(root).dump()};
  });
  const TilesetScene read = read_tileset(server.url("/x/tileset.json"), in_part());
  EXPECT_EQ(read.report.contents, 1u);
  EXPECT_EQ(read.report.holes, 4u);
  EXPECT_EQ(read.scene.ledger.size(), 4u);
  EXPECT_EQ(server.asked().back(), "/busy.glb");
}

// What did not come may come next time: the tileset is not read in part, unless that is asked for.
TEST(TilesetHttp, AFileThatDidNotComeRefusesTheTileset) {
  VANTAGE_REQUIRE_CURL();
  Server server([](const std::string& target) -> Answer {
    if (has(target, "b.glb")) return {503, "later"};
    if (has(target, ".glb")) return {200, box_glb({{}})};
    json root = tile_json(10);
    root["refine"] = "ADD";
    root["children"] = json::array({tile_json(0, "a.glb"), tile_json(0, "b.glb"), tile_json(0, "c.glb")});
    return {200, tileset_json(root).dump()};
  });
  expect_code([&] { read_tileset(server.url("/tileset.json")); }, ErrorCode::scene_incomplete, "b.glb");
  const TilesetScene read = read_tileset(server.url("/tileset.json"), in_part());
  EXPECT_EQ(read.report.contents, 2u);
  EXPECT_EQ(read.scene.ledger.size(), 1u);
}

TEST(TilesetHttp, AServerThatIsOutOfOrderEndsTheReading) {
  VANTAGE_REQUIRE_CURL();
  Server server([](const std::string& target) -> Answer {
    if (has(target, ".glb")) return {503, "later"};
    json root = tile_json(10);
    root["refine"] = "ADD";
    for (int i = 0; i < 1000; ++i) root["children"].push_back(tile_json(0, std::to_string(i) + ".glb"));
    return {200, tileset_json(root).dump()};
  });
  expect_code([&] { read_tileset(server.url("/tileset.json"), in_part()); }, ErrorCode::file_unreadable, "4.glb");
}

TEST(TilesetHttp, ShowsNoKeysAndNoPasswords) {
  for (const auto& [address, shown] : std::vector<std::pair<std::string, std::string>>{
           {"https://me:secret@a.example:8/t@1.json?key=1#x", "https://a.example:8/t@1.json"},
           {"https://me:p@ss@a.example/t.json", "https://a.example/t.json"},
           {"https://me%3Asecret%40a.example/t.json", "https://a.example/t.json"},
           {"https://a.example/t.json%3Fkey=secret", "https://a.example/t.json"},
           {"https://a.example/t.json%3fkey=secret", "https://a.example/t.json"},
           {"https://a.example/t.json;token=secret", "https://a.example/t.json"},
           {"https://me:secret@a.example", "https://a.example"},
           {"https://me:top;secret@a.example/tileset.json", "https://a.example/tileset.json"},
           {"https://me:secret%3F@a.example/x", "https://a.example/x"},
           {"https://me:secret%23%40a.example/x;token=1", "https://a.example/x"},
           {"https://me:top?secret@a.example/x", "https://"},
           {"https://a.example?user=me@b.example&key=secret", "https://"},
           {"https://a.example/x?user=me@b.example&key=secret", "https://a.example/x"},
           {"a.json?from=https://me:secret@a.example", "a.json"},
           {"HTTPS://me:secret@a.example/t.json?key=1", "HTTPS://a.example/t.json"},
           {"ftp://me:secret@a.example/t.json?key=1", "ftp://a.example/t.json"},
           {"a@b/c.json", "a@b/c.json"}}) {
    EXPECT_EQ(internal::tiles::without_query(address), shown);
    EXPECT_EQ(is_web_address(address), address.front() == 'h' || address.front() == 'H');
  }
}

TEST(TilesetHttp, WhatTheServerCompressesHasTheBoundsOfFiles) {
  VANTAGE_REQUIRE_CURL();
  using testing::gzip;
  const std::string tileset = [] {
    json root = tile_json(10);
    root["refine"] = "ADD";
    root["children"] = json::array({tile_json(0, "a.glb")});
    return tileset_json(root).dump();
  }();
  const std::string bomb = gzip(std::string(std::size_t{100} << 20, ' '));  // 100 kB
  Server server([&](const std::string& target) -> Answer {
    const std::string encoded = "Content-Encoding: gzip\r\n";
    if (has(target, "a.glb")) return {200, gzip(box_glb({{}})), encoded};
    if (has(target, "plain")) return {200, tileset};
    if (has(target, "once")) return {200, gzip(tileset), encoded};
    if (has(target, "file")) return {200, gzip(tileset)};
    if (has(target, "twice")) return {200, gzip(gzip(tileset)), encoded};
    if (has(target, "bomb1")) return {200, bomb, encoded};
    return {200, gzip(bomb), encoded};  // 500 bytes
  });
  for (const char* const name : {"plain", "once", "file", "twice"}) {
    EXPECT_EQ(read_tileset(server.url(std::string("/") + name + "/tileset.json")).report.contents, 1u) << name;
  }
  for (const char* const name : {"/bomb1.json", "/bomb2.json"}) {
    expect_code([&] { read_tileset(server.url(name)); }, ErrorCode::file_too_large, name);
  }
}

TEST(TilesetHttp, ABodyThatDoesNotEndTakesNoMoreThanTheLimit) {
  VANTAGE_REQUIRE_CURL();
  Server server([](const std::string&) -> Answer { return {200, std::string(3'000'000, 'x')}; });
  internal::tiles::HttpClient client("here");
  constexpr std::size_t kMost = std::size_t{1} << 20;
  const internal::tiles::HttpAnswer answer = client.get(server.url("/"), kMost, {}, {});
  EXPECT_TRUE(answer.is_too_large);
  EXPECT_LE(answer.body.capacity(), kMost);
}

TEST(TilesetHttp, NobodyAnswers) {
  VANTAGE_REQUIRE_CURL();
  std::string url;
  {
    Server server([](const std::string&) { return Answer{}; });
    url = server.url("/tileset.json");
    expect_code([&] { read_tileset(url); }, ErrorCode::file_empty, "127.0.0.1");
  }
  expect_code([&] { read_tileset(url); }, ErrorCode::file_unreadable, "127.0.0.1");
}

}  // namespace
}  // namespace vantage
