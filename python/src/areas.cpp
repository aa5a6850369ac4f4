// Areas of maps, and roofs and facades of scenes: what targets are made of.
#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <tuple>

#include "arrays.h"
#include "bindings.h"
#include "calls.h"
#include "scene.h"
#include "vantage/city.h"
#include "vantage/error.h"
#include "vantage/target.h"

namespace vantage::python {

using namespace nb::literals;

namespace {

using Tags = std::vector<std::pair<std::string, std::string>>;
/// Rings of (longitude, latitude): the outer one, then holes.
using PolygonRow = std::vector<AreaPolygon::Ring>;
/// Id in the source, name, tags, polygons, latitude and longitude of the middle, square metres.
using AreaRow = std::tuple<std::string, std::string, Tags, std::vector<PolygonRow>, std::array<double, 2>, double>;

AreaRow row_of(MapArea& area) {
  std::vector<PolygonRow> polygons;
  for (AreaPolygon& polygon : area.polygons) {
    polygons.push_back({std::move(polygon.outer)});
    std::move(polygon.holes.begin(), polygon.holes.end(), std::back_inserter(polygons.back()));
  }
  return {std::move(area.source_id), std::move(area.name), std::move(area.tags),
          std::move(polygons),       area.center_deg,      area.area_m2};
}

std::vector<AreaRow> areas(const std::filesystem::path& file, const std::vector<std::string>& tags, bool named,
                           const std::optional<std::array<double, 2>>& center, double radius_m,
                           const std::optional<std::array<double, 4>>& bbox, nb::object progress) {
  AreaFilter filter{{}, named, {center, radius_m, bbox}};
  for (const std::string& tag : tags) filter.tags.push_back(area_tag(tag, "tags"));
  std::vector<AreaRow> rows;
  for (MapArea& area :
       computed(std::move(progress), 0, [&](const Progress& told) { return read_areas(file, filter, told); })) {
    rows.push_back(row_of(area));
  }
  return rows;
}

/// Index of the object, which of its faces it is, counted from 1, normal, square metres, parts, and the side that a
/// target of it must be seen from, if it says.
using FaceRow = std::tuple<std::uint32_t, std::size_t, std::vector<double>, double, std::vector<PointView>,
                           std::optional<std::vector<double>>>;

struct NumberedFace {
  Face face;
  std::size_t number = 1;
};

FaceRow row_of(const NumberedFace& numbered) {
  const Face& face = numbered.face;
  std::vector<PointView> parts;
  for (const std::vector<Vec3>& part : face.parts) {
    auto kept = std::make_shared<const std::vector<Vec3>>(part);
    parts.push_back(points_view(*kept, kept));
  }
  const Target target = target_of({&face, 1}, "face");
  std::optional<std::vector<double>> front;
  if (target.front) front = list_of(*target.front);
  return {face.object, numbered.number, list_of(face.normal), face.area_m2, std::move(parts), std::move(front)};
}

FaceKind face_kind(const std::string& name) {
  for (const FaceKind kind : {FaceKind::roof, FaceKind::facade}) {
    if (name == name_of(kind)) return kind;
  }
  throw Error(ErrorCode::unknown_choice, "there is no kind of face '" + name + "'", "kind",
              "choose 'roof' or 'facade'");
}

/// Objects per call: so often progress is told, and Ctrl-C heard.
constexpr std::size_t kObjects = 64;

std::vector<NumberedFace> faces_of(const Scene& scene, const std::vector<std::uint32_t>& objects, FaceKind kind,
                                   double min_area_m2, const Progress& progress) {
  const FaceFinder finder(scene);
  std::vector<NumberedFace> found;
  std::size_t number = 0;
  std::uint32_t object = 0;
  for (std::size_t done = 0; done < objects.size(); done += kObjects) {
    if (!progress("faces", static_cast<double>(done) / static_cast<double>(objects.size()))) {
      throw Error(ErrorCode::cancelled, "cancelled", "", "");
    }
    const auto some = std::span(objects).subspan(done, std::min(kObjects, objects.size() - done));
    for (Face& face : finder.faces(some, kind)) {
      number = face.object == object ? number + 1 : 1;
      object = face.object;
      if (face.area_m2 >= min_area_m2) found.push_back({std::move(face), number});
    }
  }
  return found;
}

std::vector<FaceRow> faces(const PyScene& scene, const std::vector<std::uint32_t>& objects, const std::string& kind,
                           double min_area_m2, nb::object progress) {
  const FaceKind wanted = face_kind(kind);
  std::vector<FaceRow> rows;
  for (const NumberedFace& face : computed(std::move(progress), 0, [&](const Progress& told) {
         return faces_of(scene.scene(), objects, wanted, min_area_m2, told);
       })) {
    rows.push_back(row_of(face));
  }
  return rows;
}

}  // namespace

void bind_areas(nb::module_& module) {
  module.def("areas", &areas, "file"_a, "tags"_a, "named"_a, "center"_a, "radius_m"_a, "bbox"_a,
             "progress"_a = nb::none());
  module.def("faces", &faces, "scene"_a, "objects"_a, "kind"_a, "min_area_m2"_a, "progress"_a = nb::none());
}

}  // namespace vantage::python
