// libFuzzer target: any bytes as what a browser sends to `vantage view`: a request to the session, which has a small
// scene open; after a "G" the target and the headers of the request that opens the connection. No answer may be lost,
// and none may be anything but one frame: the length of a JSON text, the text, and the arrays that it announces.
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "fuzz/bytes.h"
#include "fuzz/files.h"
#include "live/access_control.h"
#include "live/request.h"
#include "vantage/city.h"

namespace vantage::fuzzing {
namespace {

using nlohmann::json;

constexpr const char* kScene =
    "o ground\nv -40 -40 0\nv 40 -40 0\nv 40 40 0\nv -40 40 0\nf 1 2 3 4\n"
    "o house\nv 8 -5 0\nv 14 -5 0\nv 14 5 0\nv 8 5 0\nv 8 -5 9\nv 14 -5 9\nv 14 5 9\nv 8 5 9\n"
    "f 9 10 11 12\nf 5 6 10 9\nf 6 7 11 10\nf 7 8 12 11\nf 8 5 9 12\n";
constexpr const char* kMission =
    "scene: {mesh: scene.obj}\ntarget: {vertices: [[-3, -3, 0], [3, -3, 0], [3, 3, 0], [-3, 3, 0]]}\n"
    "sensor: {max_range: 20}\nexact: {tolerance: 0.5}\n";

const live::Session& open_session() {
  static const live::Session session = [] {
    enable_maps();  // targets on the ground
    folder().write("scene.obj", kScene);
    const auto mission = folder().write("mission.yaml", kMission);
    live::Session opened;
    opened.open_file(mission);
    opened.run();
    return opened;
  }();
  return session;
}

void check(const std::string& message, std::uint64_t id) {
  require(message.size() >= 4, "a message has a length");
  std::uint32_t length = 0;
  std::memcpy(&length, message.data(), sizeof length);
  require(length % 4 == 0 && length <= message.size() - 4, "the length is that of its JSON");
  const json header = json::parse(message.substr(4, length), nullptr, false);
  require(header.is_object() && header["id"] == id, "the answer has the id of its request");
  require(header.contains("value") != header.contains("error"), "it is an answer or an error");
  if (header.contains("error")) {
    require(!header["error"]["problem"].get<std::string>().empty(), "an error says what is wrong");
    require(header["error"]["code"] != "internal-defect", "nothing is a defect");
  }
  std::size_t arrays = 0;
  if (header.contains("mesh")) {
    for (const json& count : header["mesh"]) arrays += 4 * count.get<std::size_t>();
  }
  if (header.contains("bytes")) arrays = header["bytes"].get<std::size_t>();
  require(message.size() == 4 + length + arrays, "the arrays are as long as it says");
}

void ask(std::string_view text) {
  live::Request request;
  try {
    request = live::parse_request(text);
  } catch (const Error& error) {
    check_refusal(error);
    return;
  }
  live::Session session = open_session();
  live::MapAreas areas;
  int steps = 0;  // a mission may ask for what takes long: it is stopped as by the page
  check(live::answer(session, areas, request, [&](std::string_view, double) { return ++steps < 200; }), request.id);
}

/// Lines: a target, a host, an origin.
void knock(std::string_view text) {
  const auto line = [&text] {
    const std::string_view first = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), first.size() + 1));
    return first;
  };
  const std::string_view target = line(), host = line(), origin = line();
  static const live::AccessControl access("0123456789abcdef0123456789abcdef");
  if (access.allows(target, "/socket")) require(target == "/socket?token=" + access.token(), "the token alone opens");
  if (live::AccessControl::is_own_host(host)) {
    const std::string_view name = host.substr(0, host.find(':'));
    require(name == "127.0.0.1" || name == "localhost", "the host is this machine");
  }
  if (live::AccessControl::is_own_origin(origin, host))
    require(origin == "http://" + std::string(host), "the page is its own");
}

}  // namespace
}  // namespace vantage::fuzzing

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vantage::fuzzing;
  const std::string_view text = text_of(data, size);
  if (text.starts_with("G")) {
    knock(text.substr(1));
  } else {
    ask(text);
  }
  return 0;
}
