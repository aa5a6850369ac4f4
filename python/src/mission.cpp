#include "mission.h"

#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <tuple>

#include "arrays.h"
#include "bindings.h"
#include "calls.h"
#include "errors.h"
#include "vantage/mission_keys.h"
#include "vantage/navigation.h"
#include "vantage/result.h"
#include "volume.h"

namespace vantage::python {

using namespace nb::literals;

PreparedScene PyMission::prepared(const Progress& progress) const {
  return is_in_scene() ? scene->prepared(progress) : PreparedScene(mission->scene(), progress);
}

RunOptions PyMission::run_options(const Progress& progress) const {
  RunOptions options;
  if (!is_in_scene()) return options;
  options.prepared = scene->prepared(progress);
  options.scene_hash = scene->hash();
  return options;
}

namespace {

/// A run of a mission of one volume.
struct PyResult {
  PyMission mission;
  Result result;
  PyVolume volume;

  PyResult(PyMission of, Result made)
      : mission(std::move(of)), result(std::move(made)), volume(std::move(result.volume)) {}

  /// The result whole again, for what writes it.
  Result whole() const {
    Result copy = result;
    copy.volume = *volume;
    return copy;
  }
};

/// Meshes to stay in, by vertices, faces and name.
using MeshRow = std::tuple<PointArray, FaceArray, std::string>;

std::vector<KeepInMesh> keep_in_meshes(const std::vector<MeshRow>& rows) {
  std::vector<KeepInMesh> meshes;
  for (const auto& [vertices, faces, name] : rows) meshes.push_back({mesh_of(vertices, faces), name});
  return meshes;
}

PyMission resolve(std::shared_ptr<const PyScene> scene, const std::string& text, const std::string& name,
                  const std::vector<MeshRow>& rows, nb::object progress) {
  std::vector<KeepInMesh> meshes = keep_in_meshes(rows);
  return computed_here(std::move(progress), 0, [&](const Progress& told) {
    MissionFile file = read_mission_text(text, name, scene->source());
    file.sea_level_m = scene->sea_level_m();
    Mission mission = resolve_mission(file, scene->loaded(), told);
    std::move(meshes.begin(), meshes.end(), std::back_inserter(mission.navigation.meshes));
    return PyMission{scene, std::make_shared<const Mission>(std::move(mission))};
  });
}

/// The mission of a mission file, whose scene is loaded.
PyMission read(const std::filesystem::path& path, nb::object progress) {
  return computed(std::move(progress), 0, [&](const Progress& told) {
    const MissionFile file = read_mission(path);
    Mission mission = resolve_mission(file, told);
    auto scene = std::make_shared<const PyScene>(mission.loaded, file.scene, file.sea_level_m);
    return PyMission{std::move(scene), std::make_shared<const Mission>(std::move(mission))};
  });
}

PyMission one(const PyMission& mission, std::size_t index) {
  const bool is_part = mission.is_part || volume_count(*mission) > 1;
  return {mission.scene, std::make_shared<const Mission>(one_volume(*mission, index)), is_part};
}

std::vector<PyResult> run(const PyMission& mission, int threads, nb::object progress) {
  std::vector<Result> results = computed_here(std::move(progress), threads, [&](const Progress& told) {
    return run_missions(*mission, mission.run_options(told), told);
  });
  std::vector<PyResult> made;
  for (std::size_t i = 0; i < results.size(); ++i) {
    made.emplace_back(results.size() == 1 ? mission : one(mission, i), std::move(results[i]));
  }
  return made;
}

/// A result or an error for each volume.
nb::list try_each(const PyMission& mission, int threads, nb::object progress) {
  std::vector<Attempt> attempts = computed_here(std::move(progress), threads, [&](const Progress& told) {
    return try_missions(*mission, mission.run_options(told), told);
  });
  nb::list made;
  for (std::size_t i = 0; i < attempts.size(); ++i) {
    if (attempts[i].error) {
      made.append(python_error(*attempts[i].error));
    } else {
      made.append(PyResult(one(mission, i), std::move(*attempts[i].result)));
    }
  }
  return made;
}

/// How many volumes a text asks for. Throws what is wrong with its limits and with its targets where they are;
/// `prepares`: also what is found when these are prepared, which a run does again.
std::size_t check(const PyScene& scene, const std::string& text, const std::string& name,
                  const std::vector<MeshRow>& rows, bool prepares, nb::object progress) {
  std::vector<KeepInMesh> meshes = keep_in_meshes(rows);
  return computed_here(std::move(progress), 0, [&](const Progress& told) {
    MissionFile file = read_mission_text(text, name, scene.source());
    file.sea_level_m = scene.sea_level_m();
    Mission mission = resolve_mission(file, scene.loaded(), told);
    std::move(meshes.begin(), meshes.end(), std::back_inserter(mission.navigation.meshes));
    check_navigation(mission.navigation, told);
    if (!prepares) return volume_count(mission);
    const bool is_in_scene = mission.loaded == scene.loaded();
    const PreparedScene prepared = is_in_scene ? scene.prepared(told) : PreparedScene(mission.scene(), told);
    for (std::size_t i = 0; i < volume_count(mission); ++i) prepare_views(one_volume(mission, i), prepared);
    return volume_count(mission);
  });
}

std::vector<std::pair<std::string, std::string>> notes_of(const PyMission& mission) {
  std::vector<std::pair<std::string, std::string>> rows;
  const Released released;  // what it looks up may be locked
  for (const Warning& note : mission_warnings(*mission)) rows.emplace_back(name_of(note.code), note.text);
  return rows;
}

/// The parts of each target that is in the mission.
std::vector<PointView> target_parts(const PyMission& mission) {
  std::vector<PointView> parts;
  for (const std::vector<Vec3>& part : mission->target.parts) {
    auto kept = std::make_shared<const std::vector<Vec3>>(part);
    parts.push_back(points_view(*kept, kept));
  }
  return parts;
}

std::string report_of(const PyResult& result) {
  const ResultRequest request = result_request(*result.mission, result.whole(), {});
  return report_json(*result.volume, measure(result.volume->mesh), request.source);
}

/// Writes the volume to all of the files, each with a report beside it.
std::vector<std::string> save(const PyResult& result, const std::vector<std::filesystem::path>& files,
                              nb::object progress) {
  return computed(std::move(progress), 0, [&](const Progress& told) {
    check_result_files(files, input_files(result.mission->as_written));
    const Result whole = result.whole();
    Volume volume = whole.volume;
    const WrittenResults written = write_results(volume, result_request(*result.mission, whole, files), told);
    std::vector<std::string> reports;
    for (const std::filesystem::path& report : written.reports) reports.push_back(report.string());
    return reports;
  });
}

}  // namespace

void bind_mission(nb::module_& module) {
  module.def("mission_keys", [] {
    nb::list rows;
    for (const MissionKey& key : mission_keys()) {
      nb::dict row;
      row["section"] = key.section;
      row["path"] = key.path;
      row["kind"] = name_of(key.kind);
      row["unit"] = key.unit;
      row["is_old"] = key.is_old;
      row["text"] = key.text;
      rows.append(row);
    }
    return rows;
  });
  nb::class_<PyMission>(module, "Mission")
      .def_prop_ro("scene", [](const PyMission& m) { return m.scene; })
      .def_prop_ro("hash", [](const PyMission& m) { return mission_hash(*m); })
      .def_prop_ro("notes", &notes_of)
      .def_prop_ro("count", [](const PyMission& m) { return volume_count(*m); })
      .def_prop_ro("target_name", [](const PyMission& m) { return m->target.name; })
      .def_prop_ro("target_parts", &target_parts, kKept)
      .def_prop_ro("range_m", [](const PyMission& m) { return range_limit_m(m->sensor); })
      .def_prop_ro("tolerance_m", [](const PyMission& m) { return m->as_written.exact.tolerance_m; })
      .def_prop_ro("method", [](const PyMission& m) { return name_of(m->as_written.method); })
      .def("one", &one, "index"_a)
      .def(
          "text",
          [](const PyMission& m, const std::filesystem::path& folder) { return mission_text(m->as_written, folder); },
          "folder"_a)
      .def("run", &run, "threads"_a = 0, "progress"_a = nb::none())
      .def("try_each", &try_each, "threads"_a = 0, "progress"_a = nb::none());

  nb::class_<PyResult>(module, "Result")
      .def_prop_ro("mission", [](const PyResult& r) { return r.mission; })
      .def_prop_ro("volume", [](const PyResult& r) { return r.volume; })
      .def_prop_ro("spheres",
                   [](const PyResult& r) -> std::optional<std::string> {
                     if (!r.result.spheres) return std::nullopt;
                     return spheres_json({r.mission->as_written.spheres, *r.result.spheres});
                   })
      .def("report", &report_of)
      .def("save", &save, "files"_a, "progress"_a = nb::none());

  module.def("resolve", &resolve, "scene"_a, "text"_a, "name"_a, "meshes"_a, "progress"_a = nb::none());
  module.def("check", &check, "scene"_a, "text"_a, "name"_a, "meshes"_a, "prepares"_a, "progress"_a = nb::none());
  module.def("read_mission", &read, "file"_a, "progress"_a = nb::none());
}

}  // namespace vantage::python
