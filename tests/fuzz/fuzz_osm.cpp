// libFuzzer target: any bytes as an OpenStreetMap file, XML (plain, gzip, bzip2) or PBF; after a "B" as one block of a
// PBF, not compressed. They may be refused with an input error; what is read must be on the earth and bounded, and what
// is built of it must be a scene.
#include <cmath>
#include <string>

#include "fuzz/bytes.h"
#include "fuzz/files.h"
#include "maps/osm/extract.h"
#include "support/pbf_writer.h"
#include "vantage/city.h"

namespace vantage::fuzzing {
namespace {

using internal::osm::Extract;
using internal::osm::LonLat;

void check(LonLat position) {
  require(std::abs(position.latitude_deg) <= 90, "a latitude is one");
  require(std::abs(position.longitude_deg) <= 180, "a longitude is one");
}

void check(const internal::osm::Tags& tags) {
  for (const auto& [key, value] : tags.all) {
    require(key.find('\0') == std::string::npos && value.find('\0') == std::string::npos, "a text ends with NUL");
    require(key.size() <= 1024 && value.size() <= 1024, "a text has at most 1024 bytes");
  }
}

void check(const Extract& extract) {
  for (const auto& area : extract.areas) {
    check(area.tags);
    require(!area.polygons.empty(), "an area has a polygon");
    for (const auto& polygon : area.polygons) {
      require(polygon.outer.size() >= (polygon.incomplete ? 1U : 3U), "a ring has three corners, or what is known");
      for (const LonLat position : polygon.outer) check(position);
      for (const auto& hole : polygon.holes) require(hole.size() >= 3, "a hole has three corners");
    }
  }
  for (const auto& line : extract.lines) {
    check(line.tags);
    for (const LonLat position : line.points) check(position);
  }
  for (const auto& point : extract.points) check(point.position);
}

void check(const Scene& scene) {
  for (const Vec3& vertex : scene.mesh.vertices) require(vertex.allFinite(), "coordinates are finite");
  require(scene.object_of.size() == scene.mesh.triangles.size(), "every triangle has an object");
  for (const std::uint32_t object : scene.object_of) require(object < scene.objects.size(), "objects are in range");
}

template <class Action>
void try_to(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    check_refusal(error);
  }
}

}  // namespace
}  // namespace vantage::fuzzing

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vantage::fuzzing;
  std::string bytes(text_of(data, size));
  if (bytes.starts_with("B")) bytes = vantage::testing::pbf_header() + vantage::testing::pbf_raw_block(bytes.substr(1));
  const auto file = folder().write("map.osm", bytes);
  try_to([&] { check(vantage::internal::osm::read_extract(file)); });
  try_to([&] { check(vantage::build_city(file).scene); });
  return 0;
}
