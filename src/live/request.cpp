#include "live/request.h"

#include <bit>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "live/answer.h"
#include "vantage/error.h"

namespace vantage::live {
namespace {

using Json = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little, "arrays are sent as they lie in memory");

[[noreturn]] void refuse(const std::string& problem) {
  throw Error(ErrorCode::value_syntax, "this is not a request: " + problem, "", "open the page anew");
}

template <typename T>
void append(std::string& message, const std::vector<T>& numbers) {
  message.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(T));
}

/// `text`: JSON. With what is appended to it.
std::string framed(std::string text, const ViewMesh* mesh, const std::string* bytes) {
  text.append((4 - text.size() % 4) % 4, ' ');
  const auto length = static_cast<std::uint32_t>(text.size());
  std::string message(reinterpret_cast<const char*>(&length), sizeof length);
  message += text;
  if (mesh) {
    append(message, mesh->positions);
    append(message, mesh->triangles);
    append(message, mesh->label_of);
  }
  if (bytes) message += *bytes;
  return message;
}

std::string framed(const Json& header) {
  return framed(header.dump(-1, ' ', false, Json::error_handler_t::replace), nullptr, nullptr);
}

std::string area_of(MapAreas& areas, const Session& session, const Request& request, const Progress& progress) {
  if (request.coordinates.size() != 3) refuse("an area is asked for at one point");
  const Eigen::Vector2d place(request.coordinates[0], request.coordinates[1]);
  const MapArea* area = areas.at(place, session.source(), session.scene(), progress);
  return Json{{"area", area ? Json{{"osm", area->source_id}, {"name", area->name}} : Json()}}.dump(
      -1, ' ', false, Json::error_handler_t::replace);
}

std::string value_of(Session& session, MapAreas& areas, const Request& request, const Progress& progress) {
  if (request.call == "about") return about();
  if (request.call == "hello") return session.hello();
  if (request.call == "shown") return "{}";
  if (request.call == "compute") return session.compute(request.text, progress);
  if (request.call == "read") return session.read(request.text, progress);
  if (request.call == "query") return session.query(request.coordinates);
  if (request.call == "area") return area_of(areas, session, request, progress);
  if (request.call == "flight") return session.flight(progress);
  if (request.call == "volumes") return session.target_volumes(progress);
  if (request.call == "prove") return session.prove(progress);
  if (request.call == "slice") return session.slice(request.z_m);
  if (request.call == "save") return session.save(request.format);
  throw Error(ErrorCode::unknown_choice, "there is no call of that name", "", "use the page of this version");
}

const ViewMesh* mesh_of(const Session& session, const std::string& call) {
  if (call == "hello") return &session.scene_view();
  if (call == "volumes") return &session.target_volumes_view();
  return call == "compute" || call == "shown" ? &session.volume_view() : nullptr;
}

constexpr std::size_t kMostPoints = 1000;

/// Builds what a text describes, and stops where it is more than a request can be. The library's parser builds all of
/// it, or, with a callback, looks through all earlier items of an array after each item: the square of a million.
class RequestReader final : public nlohmann::json_sax<Json> {
 public:
  Json result() { return is_whole_ ? std::move(root_) : Json(Json::value_t::discarded); }

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(Json::number_integer_t value) override { return add(value); }
  bool number_unsigned(Json::number_unsigned_t value) override { return add(value); }
  bool number_float(Json::number_float_t value, const Json::string_t&) override { return add(value); }
  bool string(Json::string_t& value) override { return add(std::move(value)); }
  bool binary(Json::binary_t& value) override { return add(std::move(value)); }
  bool start_object(std::size_t) override { return open(Json::object()); }
  bool start_array(std::size_t) override { return open(Json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(Json::string_t& name) override {
    member_ = &(*open_.back())[name];
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const Json::exception&) override { return false; }

 private:
  static constexpr std::size_t kDeepest = 4;                   // a coordinate, in a point, in a list, in a request
  static constexpr std::size_t kMostValues = 8 * kMostPoints;  // coordinates, points, and the rest

  bool add(Json value) {
    place(std::move(value));
    if (open_.empty()) is_whole_ = true;
    return ++values_ <= kMostValues;
  }
  bool open(Json value) {
    open_.push_back(place(std::move(value)));
    return open_.size() <= kDeepest && ++values_ <= kMostValues;
  }
  bool close() {
    open_.pop_back();
    is_whole_ = open_.empty();
    return true;
  }
  /// Where the value stays until its parent is closed.
  Json* place(Json value) {
    if (open_.empty()) {
      root_ = std::move(value);
      return &root_;
    }
    if (open_.back()->is_array()) {
      open_.back()->push_back(std::move(value));
      return &open_.back()->back();
    }
    *member_ = std::move(value);
    return member_;
  }

  Json root_;
  std::vector<Json*> open_;  // outermost first
  Json* member_ = nullptr;   // of the innermost one: the value of its last key
  std::size_t values_ = 0;
  bool is_whole_ = false;
};

Json parsed(std::string_view text) {
  RequestReader reader;
  const bool is_read = Json::sax_parse(text.begin(), text.end(), &reader);
  return is_read ? reader.result() : Json(Json::value_t::discarded);
}

std::string error_answer(const Request& request, const std::exception& error, const Json& engine_ms) {
  Json header = error_json(error);
  header["id"] = request.id;
  header["engine_ms"] = engine_ms;
  return framed(header);
}

/// Its value is sent as the session has it, however long: it is not read here.
std::string message_of(Session& session, MapAreas& areas, const Request& request, const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  const auto milliseconds = [&] {
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
    return time.count();
  };
  std::string value;
  try {
    value = value_of(session, areas, request, progress);
  } catch (const std::exception& error) {
    return error_answer(request, error, milliseconds());
  }
  const ViewMesh* mesh = mesh_of(session, request.call);
  const std::string* bytes = request.call == "save" ? &session.bytes() : nullptr;
  Json header{{"id", request.id}};
  if (mesh) header["mesh"] = {mesh->positions.size(), mesh->triangles.size(), mesh->label_of.size()};
  if (bytes) header["bytes"] = bytes->size();
  header["engine_ms"] = milliseconds();
  std::string text = header.dump();
  text.back() = ',';
  return framed(text + R"("value":)" + value + "}", mesh, bytes);
}

}  // namespace

Request parse_request(std::string_view text) {
  const Json message = parsed(text);
  if (!message.is_object() || !message.contains("id") || !message["id"].is_number_unsigned()) refuse("it has no id");
  const auto found = message.find("request");
  if (found == message.end() || !found->is_object()) refuse("it asks nothing");
  Request request;
  request.id = message["id"].get<std::uint64_t>();
  const auto text_of = [&](const char* key, std::string& value) {
    const auto at = found->find(key);
    if (at == found->end()) return;
    if (!at->is_string()) refuse(std::string(key) + " is not a text");
    value = at->get<std::string>();
  };
  text_of("call", request.call);
  text_of("text", request.text);
  text_of("format", request.format);
  const auto number = [](const Json& value) {
    if (!value.is_number()) refuse("a coordinate is not a number");
    return value.get<double>();
  };
  if (found->contains("z")) request.z_m = number((*found)["z"]);
  if (const auto points = found->find("points"); points != found->end()) {
    if (!points->is_array() || points->size() > kMostPoints) refuse("the points are not a list of up to 1000");
    for (const Json& point : *points) {
      if (!point.is_array() || point.size() != 3) refuse("a point does not have three coordinates");
      for (const Json& coordinate : point) request.coordinates.push_back(number(coordinate));
    }
  }
  return request;
}

std::string answer(Session& session, MapAreas& areas, const Request& request, const Progress& progress) {
  try {
    return message_of(session, areas, request, progress);
  } catch (const std::exception& error) {  // no room for the message itself
    return error_answer(request, error, 0);
  }
}

std::string cancelled_answer(const Request& request) {
  return error_answer(request, Error(ErrorCode::cancelled, "stopped before its turn", "", ""), 0);
}

std::string waiting_notice(const Request& request, bool waits) {
  return framed(Json{{"id", request.id}, {"waits", waits}});
}

std::string stale_answer(const Request& request) {
  return framed(Json{{"id", request.id}, {"stale", true}, {"engine_ms", 0}});
}

std::string stopped_answer(const Request& request) {
  return framed(Json{{"id", request.id}, {"value", Json::object()}, {"engine_ms", 0}});
}

}  // namespace vantage::live
