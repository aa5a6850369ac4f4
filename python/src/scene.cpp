#include "scene.h"

#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <tuple>

#include "arrays.h"
#include "bindings.h"
#include "calls.h"
#include "common/json.h"
#include "common/ledger.h"
#include "places.h"
#include "vantage/earth.h"
#include "vantage/geometry.h"
#include "vantage/volume.h"

namespace vantage::python {

using namespace nb::literals;

PreparedScene PyScene::prepared(const Progress& progress) const {
  const std::lock_guard lock(prepared_mutex_);
  if (prepared_) return *prepared_;
  PreparedScene made(scene(), progress);
  if (!prepared_) prepared_.emplace(std::move(made));
  return *prepared_;
}

const std::string& PyScene::hash() const {
  const std::lock_guard lock(hash_mutex_);
  if (hash_.empty()) hash_ = scene_hash(scene());
  return hash_;
}

namespace {

/// Name, id in the source, kind by number.
using ObjectRow = std::tuple<std::string, std::string, int>;

/// An entry of the ledger: its object, what, reason, box (min, max), height, stand-in, instead, may be larger,
/// outlines.
using Outlines = std::vector<std::vector<std::array<double, 2>>>;
using LedgerRow = std::tuple<ObjectRow, std::string, std::string, std::optional<std::array<double, 6>>,
                             std::optional<double>, std::optional<std::uint32_t>, std::string, bool, Outlines>;

std::shared_ptr<PyScene> load(const std::string& text, const std::string& name, nb::object progress) {
  return computed(std::move(progress), 0, [&](const Progress& told) {
    const MissionFile mission = read_scene_text(text, name);
    auto loaded = std::make_shared<const LoadedScene>(load_scene(mission.scene, told));
    return std::make_shared<PyScene>(std::move(loaded), mission.scene, mission.sea_level_m);
  });
}

std::vector<SceneObject> objects_of(const std::vector<ObjectRow>& rows) {
  std::vector<SceneObject> objects;
  for (const auto& [name, id, kind] : rows) objects.push_back({name, id, static_cast<ObjectKind>(kind)});
  return objects;
}

std::vector<LedgerEntry> ledger_of(const std::vector<LedgerRow>& rows) {
  std::vector<LedgerEntry> ledger;
  for (const auto& [object, what, reason, box, height_m, stand_in, instead, may_be_larger, outlines] : rows) {
    LedgerEntry entry{objects_of({object}).front(), what, reason};
    if (box) entry.box = Box{Vec3(box->data()), Vec3(box->data() + 3)};
    entry.height_m = height_m;
    entry.stand_in = stand_in;
    entry.instead = instead;
    entry.may_be_larger = may_be_larger;
    entry.outlines = outlines;
    ledger.push_back(std::move(entry));
  }
  return ledger;
}

/// As ledger_of takes them.
std::vector<LedgerRow> ledger_rows(const PyScene& scene) {
  std::vector<LedgerRow> rows;
  for (const LedgerEntry& entry : written_ledger(scene.scene())) {
    std::optional<std::array<double, 6>> box;
    if (entry.box) {
      const auto& [min, max] = *entry.box;
      box = {min.x(), min.y(), min.z(), max.x(), max.y(), max.z()};
    }
    const ObjectRow object{entry.object.name, entry.object.source_id, static_cast<int>(entry.object.kind)};
    rows.emplace_back(object, entry.what, entry.reason, box, entry.height_m, entry.stand_in, entry.instead,
                      entry.may_be_larger, entry.outlines);
  }
  return rows;
}

std::shared_ptr<PyScene> from_arrays(const PointArray& vertices, const FaceArray& faces, const IndexArray& object_of,
                                     const std::vector<ObjectRow>& objects, const std::optional<PlaceRow>& place,
                                     std::optional<double> sea_level_m,
                                     const std::optional<std::array<double, 6>>& whole, const std::string& attribution,
                                     const std::vector<LedgerRow>& ledger) {
  LoadedScene loaded;
  loaded.scene.mesh = mesh_of(vertices, faces);
  loaded.scene.object_of.assign(object_of.data(), object_of.data() + object_of.shape(0));
  loaded.scene.objects = objects_of(objects);
  if (place) {
    loaded.scene.georeference = place_of(*place);
  }
  loaded.scene.ledger = ledger_of(ledger);
  loaded.scene.attribution = attribution;
  if (auto& known = loaded.scene.georeference) known->attribution = attribution_of(loaded.scene);  // for files
  if (whole) loaded.scene.whole = Box{Vec3(whole->data()), Vec3(whole->data() + 3)};
  return std::make_shared<PyScene>(std::make_shared<const LoadedScene>(std::move(loaded)), SceneSource{}, sea_level_m);
}

/// What a scene that was kept elsewhere had been loaded from.
void set_source(PyScene& scene, const std::string& text, const std::string& name) {
  scene.set_source(read_scene_text(text, name).scene);
}

std::vector<ObjectRow> object_rows(const PyScene& scene) {
  std::vector<ObjectRow> rows;
  for (const SceneObject& object : scene.scene().objects) {
    rows.emplace_back(object.name, object.source_id, static_cast<int>(object.kind));
  }
  return rows;
}

}  // namespace

void bind_scene(nb::module_& module) {
  nb::class_<PyScene>(module, "Scene")
      .def_prop_ro(
          "vertices", [](const PyScene& s) { return points_view(s.scene().mesh.vertices, s.loaded()); }, kKept)
      .def_prop_ro(
          "faces", [](const PyScene& s) { return faces_view(s.scene().mesh.triangles, s.loaded()); }, kKept)
      .def_prop_ro(
          "object_of", [](const PyScene& s) { return list_view(s.scene().object_of, s.loaded()); }, kKept)
      .def_prop_ro("objects", &object_rows)
      .def_prop_ro("ledger_rows", &ledger_rows)
      .def_prop_ro("place", [](const PyScene& s) { return place_row(s.scene().georeference); })
      .def_prop_ro("projection", [](const PyScene& s) { return projection_row(s.scene().georeference); })
      .def_prop_ro("attribution", [](const PyScene& s) { return attribution_of(s.scene()); })
      .def_prop_ro("source", [](const PyScene& s) { return s.scene().source; })
      .def_prop_ro("sea_level_m", &PyScene::sea_level_m)
      .def_prop_ro("whole",
                   [](const PyScene& s) -> std::optional<std::array<double, 6>> {
                     const std::optional<Box>& box = s.scene().whole;
                     if (!box) return std::nullopt;
                     return std::array{box->min.x(), box->min.y(), box->min.z(),
                                       box->max.x(), box->max.y(), box->max.z()};
                   })
      .def_prop_ro(
          "hash", [](const PyScene& s) { return s.hash(); }, nb::call_guard<Released, Computing>())
      .def("set_source", &set_source, "text"_a, "name"_a)
      .def(
          "prepare",
          [](const PyScene& s, nb::object progress) {
            computed(std::move(progress), 0, [&](const Progress& told) { return s.prepared(told); });
          },
          "progress"_a = nb::none())
      .def("report",
           [](const PyScene& s) {
             return computed(nb::none(), 0, [&](const Progress& told) {
               return json_text(*s.loaded(), s.prepared(told).statistics());
             });
           })
      .def("ledger", [](const PyScene& s) { return json_text(s.scene().ledger); })
      .def(
          "save", [](const PyScene& s, const std::filesystem::path& file) { return write_scene(s.scene(), file); },
          "file"_a, nb::call_guard<Released, Computing>());

  module.def("load_scene", &load, "text"_a, "name"_a, "progress"_a = nb::none());
  module.def("scene_from_arrays", &from_arrays, "vertices"_a.noconvert(), "faces"_a.noconvert(),
             "object_of"_a.noconvert(), "objects"_a, "place"_a, "sea_level_m"_a, "whole"_a = nb::none(),
             "attribution"_a = "", "ledger"_a = std::vector<LedgerRow>());
  module.def("object_kinds", [] {
    std::vector<std::string> names;
    for (int i = 0; i <= static_cast<int>(ObjectKind::stand_in); ++i)
      names.emplace_back(name_of(static_cast<ObjectKind>(i)));
    return names;
  });
  module.def(
      "scene_position",
      [](const PyScene& s, double latitude_deg, double longitude_deg, double z_m) {
        const Eigen::Vector2d at = scene_position(place_of(s.scene()), longitude_deg, latitude_deg, z_m);
        return std::tuple(at.x(), at.y());
      },
      "scene"_a, "latitude_deg"_a, "longitude_deg"_a, "z_m"_a = 0.0);
  module.def(
      "seems_swapped",
      [](const PyScene& s, double latitude_deg, double longitude_deg) {
        const Scene& scene = s.scene();
        return scene.georeference &&
               seems_swapped(*scene.georeference, bounding_box(scene.mesh), longitude_deg, latitude_deg);
      },
      "scene"_a, "latitude_deg"_a, "longitude_deg"_a);
}

}  // namespace vantage::python
