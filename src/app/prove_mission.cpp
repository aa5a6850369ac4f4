// The proof of a mission's volume, and its certificate.
#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "vantage/atomic_file.h"
#include "vantage/error.h"
#include "vantage/hash.h"
#include "vantage/output.h"
#include "vantage/result.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

/// The targets that must be seen, each whole; of several, all.
std::vector<Target> targets_of(const Mission& mission) {
  if (mission.views.empty()) return {mission.target};
  std::vector<Target> targets;
  for (const std::vector<Target>& list : mission.views) {
    if (list.size() != 1) {
      throw Error(ErrorCode::not_applicable,
                  "the volume is for one of several targets or sides, and only the sight of all can be proved",
                  "targets", "check it with 'vantage verify', or compute one volume for each with 'combine: each'");
    }
    targets.push_back(list[0]);
  }
  return targets;
}

/// What is wrong with the sight of one target is wrong with all.
void join(ProofReport& all, ProofReport&& one, const Mesh& volume) {
  for (std::size_t i = 0; i < all.claims.size(); ++i) {
    if (one.claims[i].verdict > all.claims[i].verdict) all.claims[i] = one.claims[i];
  }
  all.far_facets += one.far_facets;
  all.separations += one.separations;
  all.seconds += one.seconds;
  all.margin_m = std::max(all.margin_m, one.margin_m);
  all.lift_m = std::max(all.lift_m, one.lift_m);
  if (one.unproved_area_share > all.unproved_area_share) {
    all.unproved = one.unproved;
    all.unproved_area_share = one.unproved_area_share;
  }
  if (one.witness && (!all.witness || one.witness->depth_m > all.witness->depth_m)) all.witness = one.witness;
  if (all.maximal && one.maximal) all.maximal = vantage::join(*all.maximal, *one.maximal, volume);
  if (!one.certificate) all.certificate.reset();
  if (!all.certificate) return;
  for (CertificatePart& part : one.certificate->parts) all.certificate->parts.push_back(std::move(part));
}

}  // namespace

ProofReport prove_volume(const Mission& mission, const Mesh& volume, const ProveOptions& options,
                         const Progress& progress) {
  std::optional<ProofReport> all;
  std::size_t first = 0;
  for (const Target& target : targets_of(mission)) {
    ProveOptions one = options;
    one.lift_m.clear();
    for (std::size_t i = 0; i < target.parts.size() && first + i < options.lift_m.size(); ++i) {
      one.lift_m.push_back(options.lift_m[first + i]);
    }
    first += target.parts.size();
    ProofReport report =
        prove_volume(mission.loaded.scene, target, mission.sensor, mission.navigation, volume, one, progress);
    if (all) {
      join(*all, std::move(report), volume);
    } else {
      all = std::move(report);
    }
  }
  return std::move(*all);
}

fs::path certificate_scene_file(const fs::path& certificate_file) {
  fs::path scene = certificate_file;
  return scene.replace_extension(".scene.ply");
}

void check_certificate_files(const fs::path& certificate_file, const fs::path& volume_file,
                             const std::vector<fs::path>& inputs) {
  if (format_extension(volume_file) != ".ply") {
    throw Error(ErrorCode::not_applicable, "a certificate is about the numbers of a PLY file", volume_file.string(),
                "write the volume as .ply");
  }
  for (const fs::path& file : {certificate_file, certificate_scene_file(certificate_file)}) {
    check_can_write(file);
    check_not_an_input(file, inputs);
  }
}

void write_certificate(const Certificate& certificate, const Mission& mission, const VolumeFile& volume,
                       const fs::path& certificate_file) {
  const Scene& scene = mission.loaded.scene;
  const fs::path scene_file = certificate_scene_file(certificate_file);
  const fs::path folder = fs::absolute(certificate_file).parent_path();
  CertifiedFiles about;
  about.scene_file = scene_file.filename().string();
  about.scene_hash = scene_hash(scene);
  about.volume_file = fs::absolute(volume.file).lexically_relative(folder).generic_string();
  about.volume_hash = volume_hash(volume.volume.mesh);
  about.mission_hash = mission_hash(mission);
  auto files = stage_scene(scene, scene_file);
  files.push_back(std::make_unique<AtomicFile>(certificate_file));
  files.back()->write(certificate_text(certificate, about));
  commit_all(files);
}

}  // namespace vantage
