// What JavaScript calls: web/src/engine/worker.ts. Answers are JSON texts; a call that fails answers {"error": {...}}.
#include <emscripten/emscripten.h>

#include <functional>
#include <string>

#include "live/answer.h"
#include "live/session.h"

namespace {

vantage::live::Session& session() {
  static vantage::live::Session one;
  return one;
}

/// Kept until the next call.
const char* answered(const std::function<std::string()>& work) {
  static std::string answer;
  answer = vantage::live::answered(work);
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

EMSCRIPTEN_KEEPALIVE const char* vantage_read(const char* text) {
  return answered([&] { return session().read(text); });
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

EMSCRIPTEN_KEEPALIVE const char* vantage_save(const char* format) {
  return answered([&] { return session().save(format); });
}

// The file that vantage_save made.
EMSCRIPTEN_KEEPALIVE const char* vantage_bytes() { return session().bytes().data(); }

// Arrays of the scene (0) and of the volume (1): where they begin and how many numbers they have.
EMSCRIPTEN_KEEPALIVE const float* vantage_positions(int which) { return view(which).positions.data(); }
EMSCRIPTEN_KEEPALIVE std::size_t vantage_position_count(int which) { return view(which).positions.size(); }
EMSCRIPTEN_KEEPALIVE const std::uint32_t* vantage_triangles(int which) { return view(which).triangles.data(); }
EMSCRIPTEN_KEEPALIVE std::size_t vantage_triangle_count(int which) { return view(which).triangles.size(); }
EMSCRIPTEN_KEEPALIVE const std::uint32_t* vantage_labels(int which) { return view(which).label_of.data(); }
EMSCRIPTEN_KEEPALIVE std::size_t vantage_label_count(int which) { return view(which).label_of.size(); }

}  // extern "C"
