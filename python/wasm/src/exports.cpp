// What Python calls of the engine in WebAssembly: one function, which takes the name of a call and its arguments as
// JSON and answers JSON; python/wasm/vantage/_core/_engine.py is the other side. Arrays are passed by their places in
// the memory.
#include <emscripten/emscripten.h>

#include <algorithm>
#include <cstring>
#include <new>

#include "held.h"
#include "vantage/error.h"
#include "vantage/georeference.h"

extern "C" {
/// Of the host (host.js): tells the progress. Returns how many calls it need not be told of after this one; below 0:
/// stop.
int vantage_host_progress(const char* stage, int length, double fraction);
}

namespace vantage::wasm {
namespace {

/// Answers that Python has not read yet.
std::vector<std::vector<double>> doubles;
std::vector<std::vector<std::uint8_t>> bytes;
int untold = 0;

const char* name_of(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::input:
      return "input";
    case ErrorKind::output:
      return "output";
    case ErrorKind::cancelled:
      return "cancelled";
    case ErrorKind::internal:
      return "internal";
  }
  return "internal";
}

const Calls& calls() {
  static const Calls all = [] {
    Calls made;
    add_scene_calls(made);
    add_mission_calls(made);
    add_volume_calls(made);
    add_judge_calls(made);
    add_list_calls(made);
    return made;
  }();
  return all;
}

Json answer(const std::string& text) {
  try {
    const Json request = Json::parse(text);
    return {{"value", calls().at(request.at("call").get<std::string>())(request.at("arguments"))}};
  } catch (const Error& error) {
    return {{"error", error_json(error)}};
  } catch (const std::bad_alloc&) {
    return {{"error", error_json(Error(ErrorCode::out_of_memory, "there is not enough memory for this", "",
                                       "use a smaller scene or range"))}};
  } catch (const std::exception& error) {
    return {{"error", error_json(Error(ErrorCode::internal_defect, error.what(), "", "please report this"))}};
  }
}

}  // namespace

Handle new_handle() {
  static Handle last = 0;
  return ++last;
}

Json answer_array(std::vector<double> values) {
  Json array = array_at(doubles.emplace_back(std::move(values)));
  array["kind"] = "f8";
  return array;
}

Json answer_array(std::vector<std::uint8_t> values) {
  Json array = array_at(bytes.emplace_back(std::move(values)));
  array["kind"] = "u1";
  return array;
}

std::vector<Vec3> points_of(const Json& array) {
  const auto* const first = reinterpret_cast<const double*>(array.at("at").get<std::uintptr_t>());
  std::vector<Vec3> points(array.at("count").get<std::size_t>() / 3);
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = Vec3(first[3 * i], first[3 * i + 1], first[3 * i + 2]);
  return points;
}

std::vector<std::uint32_t> indices_of(const Json& array) {
  const auto* const first = reinterpret_cast<const std::uint32_t*>(array.at("at").get<std::uintptr_t>());
  return {first, first + array.at("count").get<std::size_t>()};
}

Mesh mesh_of(const Json& arguments) {
  Mesh mesh;
  mesh.vertices = points_of(arguments.at("vertices"));
  const std::vector<std::uint32_t> corners = indices_of(arguments.at("faces"));
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
    mesh.triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
  return mesh;
}

Json json(const std::vector<Warning>& notes) {
  Json rows = Json::array();
  for (const Warning& note : notes) rows.push_back({vantage::name_of(note.code), note.text});
  return rows;
}

Json place_json(const std::optional<Georeference>& place) {
  if (!place) return nullptr;
  return {place->latitude_deg, place->longitude_deg, place->vertical, place->source_crs};
}

Json projection_json(const std::optional<Georeference>& place) {
  return place ? Json(projection_text(*place)) : Json();
}

Json error_json(const Error& error) {
  return {{"kind", name_of(error.kind())},
          {"code", vantage::name_of(error.code())},
          {"problem", error.problem()},
          {"where", error.where()},
          {"fix", error.fix()},
          {"object", error.object() ? Json(*error.object()) : Json()}};
}

bool tell_progress(std::string_view stage, double fraction) {
  if (untold-- > 0) return true;
  untold = vantage_host_progress(stage.data(), static_cast<int>(stage.size()), fraction);
  return untold >= 0;
}

}  // namespace vantage::wasm

extern "C" {

/// Kept until the next call.
EMSCRIPTEN_KEEPALIVE const char* vantage_python_call(const char* text) {
  using namespace vantage::wasm;
  static std::string last;
  doubles.clear();
  bytes.clear();
  untold = 0;
  last = answer(text).dump(-1, ' ', false, Json::error_handler_t::replace);
  return last.c_str();
}

}  // extern "C"
