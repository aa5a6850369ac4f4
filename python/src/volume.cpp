#include "volume.h"

#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <cmath>
#include <optional>
#include <tuple>

#include "arrays.h"
#include "bindings.h"
#include "calls.h"
#include "common/json.h"
#include "common/output.h"
#include "places.h"
#include "scene.h"
#include "vantage/result.h"
#include "vantage/simplify.h"
#include "vantage/solid.h"
#include "vantage/volume.h"

namespace vantage::python {

using namespace nb::literals;

namespace {

/// Kind, name, area, index of the object, its id, its kind by number.
using CauseRow = std::tuple<std::string, std::string, double, std::optional<std::uint32_t>, std::string, int>;

std::vector<CauseRow> cause_rows(const PyVolume& volume) {
  std::vector<CauseRow> rows;
  for (const Cause& cause : volume->causes) {
    rows.emplace_back(name_of(cause.kind), cause.name, cause.area_m2, cause.object, cause.source_id,
                      static_cast<int>(cause.object_kind));
  }
  return rows;
}

std::vector<std::pair<std::string, std::string>> note_rows(const std::vector<Warning>& notes) {
  std::vector<std::pair<std::string, std::string>> rows;
  for (const Warning& note : notes) rows.emplace_back(name_of(note.code), note.text);
  return rows;
}

using Entries = std::initializer_list<std::pair<const char*, nb::object>>;

nb::dict dict_of(Entries entries) {
  nb::dict values;
  for (const auto& [name, value] : entries) values[name] = value;
  return values;
}

nb::dict measures_of(const MeshMeasures& m) {
  nb::object bounds = nb::none();
  if (!m.bounds.empty()) bounds = nb::make_tuple(list_of(m.bounds.min), list_of(m.bounds.max));
  return dict_of({{"vertices", nb::cast(m.vertices)},
                  {"facets", nb::cast(m.facets)},
                  {"pieces", nb::cast(m.pieces)},
                  {"euler", nb::cast(m.euler)},
                  {"closed", nb::cast(m.closed)},
                  {"oriented", nb::cast(m.oriented)},
                  {"volume_m3", nb::cast(m.volume_m3)},
                  {"area_m2", nb::cast(m.area_m2)},
                  {"bounds", bounds}});
}

std::optional<nb::dict> provenance_of(const PyVolume& volume) {
  if (!volume->provenance) return std::nullopt;
  const VolumeProvenance& from = *volume->provenance;
  return dict_of({{"version", nb::cast(from.version)},
                  {"method", nb::cast(from.method)},
                  {"target", nb::cast(from.target.name)},
                  {"scene_hash", nb::cast(from.scene_hash)},
                  {"mission_hash", nb::cast(from.mission_hash)}});
}

nb::dict seconds_of(const Seconds& s) {
  return dict_of({{"read", nb::cast(s.read)},
                  {"prepare", nb::cast(s.prepare)},
                  {"engine", nb::cast(s.engine)},
                  {"navigation", nb::cast(s.navigation)},
                  {"write", nb::cast(s.write)},
                  {"total", nb::cast(s.total)}});
}

PyVolume read_file(const std::filesystem::path& file, const std::string& up, double scale, const PyScene* scene,
                   nb::object progress) {
  return computed(std::move(progress), 0, [&](const Progress& told) {
    SceneReadOptions options;
    options.up = up == "y" ? UpAxis::y : UpAxis::z;
    options.scale = scale;
    VolumeFile read = scene ? read_volume(file, scene->scene(), told) : read_volume(file, options, {}, told);
    for (Warning& note : read.notes) read.volume.notes.push_back(std::move(note));
    return PyVolume(std::move(read.volume), read.rounding_m, std::move(read.volume_hash));
  });
}

PyVolume volume_from_arrays(const PointArray& vertices, const FaceArray& faces, const std::string& cause) {
  return PyVolume(volume_of_mesh(mesh_of(vertices, faces), cause));
}

/// How far rounding to the file's numbers moved the surface, and how many facets the file holds.
std::pair<double, std::size_t> save_file(const PyVolume& volume, const std::filesystem::path& file,
                                         const std::string& up, double scale, std::optional<double> sea_level_m) {
  const Released released;
  std::vector<StagedVolume> staged;
  staged.push_back(stage_volume(*volume, file, up == "y" ? UpAxis::y : UpAxis::z, scale, sea_level_m));
  const WrittenVolume report = staged.front().report;
  commit_volumes(std::move(staged));
  return {report.rounding_m, report.facets};
}

std::tuple<std::string, PyVolume, PyVolume> compare_two(const PyVolume& a, const PyVolume& b, const std::string& name_a,
                                                        const std::string& name_b, nb::object progress) {
  Comparison found = computed(std::move(progress), 0, [&](const Progress& told) {
    return compare_volumes(a->mesh, b->mesh, name_a, name_b, told);
  });
  const std::string text = json_text(found, name_a, name_b, {});
  return {text, PyVolume(volume_of_mesh(std::move(found.only_a), "only in " + name_a)),
          PyVolume(volume_of_mesh(std::move(found.only_b), "only in " + name_b))};
}

std::pair<PyVolume, std::string> simplified(const PyVolume& volume, const SimplifyOptions& options,
                                            nb::object progress) {
  SimplifiedVolume simple = computed(
      std::move(progress), 0, [&](const Progress& told) { return simplify_volume(volume->mesh, options, told); });
  std::string text = json_text(simple, "", "", {});
  return {PyVolume(with_mesh(*volume, std::move(simple)), volume.rounding_m), std::move(text)};
}

std::vector<Volume> copies(const std::vector<const PyVolume*>& volumes) {
  std::vector<Volume> all;
  for (const PyVolume* one : volumes) all.push_back(**one);
  return all;
}

}  // namespace

void bind_volume(nb::module_& module) {
  nb::class_<PyVolume>(module, "Volume")
      .def_prop_ro(
          "vertices", [](const PyVolume& v) { return points_view(v->mesh.vertices, v.volume); }, kKept)
      .def_prop_ro(
          "faces", [](const PyVolume& v) { return faces_view(v->mesh.triangles, v.volume); }, kKept)
      .def_prop_ro(
          "cause_of", [](const PyVolume& v) { return list_view(v->cause_of, v.volume); }, kKept)
      .def_prop_ro(
          "polygon_of", [](const PyVolume& v) { return list_view(v->polygon_of, v.volume); }, kKept)
      .def_prop_ro("causes", &cause_rows)
      .def_prop_ro("outcome", [](const PyVolume& v) { return name_of(v->outcome); })
      .def_prop_ro("reason", [](const PyVolume& v) { return v->reason; })
      .def_prop_ro("hint", [](const PyVolume& v) { return v->hint; })
      .def_prop_ro("notes", [](const PyVolume& v) { return note_rows(v->notes); })
      .def_prop_ro("tolerance_m", [](const PyVolume& v) { return v->tolerance_m; })
      .def_prop_ro("lift_m", [](const PyVolume& v) { return v->lift_m; })
      .def_prop_ro("rounding_m", [](const PyVolume& v) { return v.rounding_m; })
      .def_prop_ro("stated_hash", [](const PyVolume& v) { return v.stated_hash; })
      .def_prop_ro("seconds", [](const PyVolume& v) { return seconds_of(v->seconds); })
      .def_prop_ro("provenance", &provenance_of)
      .def_prop_ro("place", [](const PyVolume& v) { return place_row(v->georeference); })
      .def_prop_ro("projection", [](const PyVolume& v) { return projection_row(v->georeference); })
      .def_prop_ro(
          "hash", [](const PyVolume& v) { return volume_hash(v->mesh); }, nb::call_guard<Released, Computing>())
      .def("measures", [](const PyVolume& v) { return measures_of(measure(v->mesh)); })
      .def("report", [](const PyVolume& v) { return report_json(*v, measure(v->mesh)); })
      .def("save", &save_file, "file"_a, "up"_a = "z", "scale"_a = 1.0, "sea_level_m"_a = nb::none())
      .def("compare", &compare_two, "other"_a, "name"_a, "other_name"_a, "progress"_a = nb::none())
      .def(
          "simplify_to",
          [](const PyVolume& v, std::size_t facets, nb::object progress) {
            SimplifyOptions options;
            options.facets = facets;
            return simplified(v, options, std::move(progress));
          },
          "facets"_a, "progress"_a = nb::none())
      .def(
          "simplify_within",
          [](const PyVolume& v, double error_m, nb::object progress) {
            SimplifyOptions options;
            options.error_m = error_m;
            return simplified(v, options, std::move(progress));
          },
          "error_m"_a, "progress"_a = nb::none());

  module.def("read_volume", &read_file, "file"_a, "up"_a, "scale"_a, "scene"_a.none(), "progress"_a = nb::none());
  module.def("volume_from_arrays", &volume_from_arrays, "vertices"_a.noconvert(), "faces"_a.noconvert(), "cause"_a);
  module.def(
      "empty_volume",
      [](const std::string& outcome, const std::string& reason) {
        Volume volume;
        for (const Outcome one :
             {Outcome::out_of_range, Outcome::blocked_at_once, Outcome::outside_limits, Outcome::no_common_view}) {
          if (outcome == name_of(one)) volume.outcome = one;
        }
        volume.reason = reason;
        return PyVolume(std::move(volume));
      },
      "outcome"_a, "reason"_a);
  module.def(
      "output_formats", [](bool scenes) { return scenes ? mesh_format_words() : format_words(); }, "scenes"_a);
  module.def(
      "intersect_volumes",
      [](const std::vector<const PyVolume*>& volumes, nb::object progress) {
        return computed(std::move(progress), 0,
                        [&](const Progress& told) { return PyVolume(intersect_volumes(copies(volumes), told)); });
      },
      "volumes"_a, "progress"_a = nb::none());
  module.def(
      "unite_volumes",
      [](const std::vector<const PyVolume*>& volumes, nb::object progress) {
        return computed(std::move(progress), 0,
                        [&](const Progress& told) { return PyVolume(unite_volumes(copies(volumes), told)); });
      },
      "volumes"_a, "progress"_a = nb::none());
}

}  // namespace vantage::python
