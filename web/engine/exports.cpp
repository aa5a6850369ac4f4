// What JavaScript calls: web/src/engine.ts. Answers are JSON texts; a call that fails answers {"error": {...}}.
#include <emscripten/emscripten.h>

#include <exception>
#include <new>
#include <nlohmann/json.hpp>

#include "live/session.h"
#include "vantage/error.h"

namespace {

using Json = nlohmann::ordered_json;

vantage::live::Session& session() {
  static vantage::live::Session one;
  return one;
}

std::string error_json(const std::string& code, const std::string& problem, const std::string& where,
                       const std::string& fix) {
  return Json{{"error", {{"code", code}, {"problem", problem}, {"where", where}, {"fix", fix}}}}.dump(
      -1, ' ', false, Json::error_handler_t::replace);
}

/// What `work()` returns, kept until the next call.
template <typename Work>
const char* answered(Work&& work) {
  static std::string answer;
  try {
    answer = work();
  } catch (const vantage::Error& error) {
    answer = error_json(name_of(error.code()), error.problem(), error.where(), error.fix());
  } catch (const std::bad_alloc&) {
    answer =
        error_json("out-of-memory", "the browser has not enough memory for this", "", "use a smaller scene or range");
  } catch (const std::exception& error) {
    answer = error_json("internal", error.what(), "", "please report this");
  }
  return answer.c_str();
}

const vantage::live::ViewMesh& view(int which) { return which == 0 ? session().scene_view() : session().volume_view(); }

}  // namespace

extern "C" {

EMSCRIPTEN_KEEPALIVE const char* vantage_about() {
  return answered([] { return vantage::live::about(); });
}

EMSCRIPTEN_KEEPALIVE const char* vantage_open(const char* text) {
  return answered([&] { return session().open(text); });
}

EMSCRIPTEN_KEEPALIVE const char* vantage_compute(const char* text) {
  return answered([&] { return session().compute(text); });
}

EMSCRIPTEN_KEEPALIVE const char* vantage_query(const double* coordinates, int count) {
  return answered([&] { return session().query({coordinates, coordinates + count}); });
}

EMSCRIPTEN_KEEPALIVE const char* vantage_prove() {
  return answered([&] { return session().prove(); });
}

EMSCRIPTEN_KEEPALIVE const char* vantage_slice(double z_m) {
  return answered([&] { return session().slice(z_m); });
}

EMSCRIPTEN_KEEPALIVE const char* vantage_save(const char* file) {
  return answered([&] { return session().save(file); });
}

// Arrays of the scene (0) and of the volume (1): where they begin and how many numbers they have.
EMSCRIPTEN_KEEPALIVE const float* vantage_positions(int which) { return view(which).positions.data(); }
EMSCRIPTEN_KEEPALIVE std::size_t vantage_position_count(int which) { return view(which).positions.size(); }
EMSCRIPTEN_KEEPALIVE const std::uint32_t* vantage_triangles(int which) { return view(which).triangles.data(); }
EMSCRIPTEN_KEEPALIVE std::size_t vantage_triangle_count(int which) { return view(which).triangles.size(); }
EMSCRIPTEN_KEEPALIVE const std::uint32_t* vantage_labels(int which) { return view(which).label_of.data(); }
EMSCRIPTEN_KEEPALIVE std::size_t vantage_label_count(int which) { return view(which).label_of.size(); }

}  // extern "C"
