// The proof of volumes.
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "bindings.h"
#include "calls.h"
#include "common/json.h"
#include "mission.h"
#include "vantage/prove.h"
#include "vantage/result.h"
#include "volume.h"

namespace vantage::python {

using namespace nb::literals;

namespace {

ProveOptions prove_options(const PyVolume& volume, double shrink, bool maximal, double tolerance_m) {
  return {.shrink = shrink,
          .rounding_m = volume.rounding_m,
          .lift_m = volume->lift_m,
          .maximal = maximal,
          .tolerance_m = tolerance_m};
}

/// The report as JSON.
std::string prove(const PyMission& mission, const PyVolume& volume, double shrink, bool maximal, int threads,
                  nb::object progress) {
  return computed(std::move(progress), threads, [&](const Progress& told) {
    const ProveOptions options = prove_options(volume, shrink, maximal, mission->as_written.exact.tolerance_m);
    return json_text(prove_volume(*mission, volume->mesh, options, told));
  });
}

/// A volume that says itself what it was computed for: its target and its sensor; limits of navigation it does not say.
std::string prove_by_provenance(const PyVolume& volume, const PyScene& scene, double shrink, bool maximal, int threads,
                                nb::object progress) {
  const auto& from = volume->provenance;
  if (!from) {
    throw Error(ErrorCode::nothing_given, "the volume does not say what it was computed for", "",
                "pass the mission: mission.prove(volume)");
  }
  if (!from->views.empty()) {
    throw Error(ErrorCode::not_applicable, "the volume is for several targets", "",
                "pass the mission: mission.prove(volume)");
  }
  if (!from->scene_hash.empty() && from->scene_hash != scene.hash()) {
    throw Error(ErrorCode::not_applicable, "the volume was computed in another scene", from->scene_hash,
                "pass the scene with this hash");
  }
  return computed(std::move(progress), threads, [&](const Progress& told) {
    return json_text(prove_volume(scene.scene(), from->target, from->sensor, {}, volume->mesh,
                                  prove_options(volume, shrink, maximal, volume->tolerance_m), told));
  });
}

/// Proves the file of a volume, and writes a certificate beside it.
std::string certify(const PyMission& mission, const std::filesystem::path& volume_file,
                    const std::filesystem::path& certificate, double shrink, bool maximal, int threads,
                    nb::object progress) {
  return computed(std::move(progress), threads, [&](const Progress& told) {
    std::vector<std::filesystem::path> inputs = input_files(mission->as_written);
    inputs.push_back(volume_file);
    check_certificate_files(certificate, volume_file, inputs);
    const VolumeFile read = read_volume(volume_file, mission->scene(), told);
    const VerifyOptions known = verify_options(read, *mission);
    const ProveOptions options{.shrink = shrink,
                               .rounding_m = known.rounding_m,
                               .lift_m = known.lift_m,
                               .maximal = maximal,
                               .tolerance_m = known.tolerance_m,
                               .certificate = true};
    const ProofReport report = prove_volume(*mission, read.volume.mesh, options, told);
    if (report.certificate) write_certificate(*report.certificate, *mission, read, certificate);
    return json_text(report);
  });
}

}  // namespace

void bind_judges(nb::module_& module) {
  module.def("prove", &prove, "mission"_a, "volume"_a, "shrink"_a, "maximal"_a, "threads"_a = 0,
             "progress"_a = nb::none());
  module.def("prove_by_provenance", &prove_by_provenance, "volume"_a, "scene"_a, "shrink"_a, "maximal"_a,
             "threads"_a = 0, "progress"_a = nb::none());
  module.def("certify", &certify, "mission"_a, "volume_file"_a, "certificate"_a, "shrink"_a, "maximal"_a,
             "threads"_a = 0, "progress"_a = nb::none());
}

}  // namespace vantage::python
