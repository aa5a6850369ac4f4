// The proof of a mission's volume, and its certificate.
#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "app/certified_ply.h"
#include "app/scene_warnings.h"
#include "common/atomic_file.h"
#include "common/input.h"
#include "common/known_data.h"
#include "common/output.h"
#include "vantage/error.h"
#include "vantage/result.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

/// A target that must be seen whole, or one side of it.
struct ProvedView {
  Target target;
  std::vector<double> lift_m;
  std::optional<double> other_side_m = {};
};

bool have_same_corners(std::vector<Vec3> a, std::vector<Vec3> b) {
  const auto is_before = [](const Vec3& p, const Vec3& q) {
    return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
  };
  std::sort(a.begin(), a.end(), is_before);
  std::sort(b.begin(), b.end(), is_before);
  return a == b;
}

/// Whether two targets are the sides of one, and how far their planes are apart. Others may lie in one plane and face
/// opposite ways: a position in that plane may then see one only, whichever it is.
std::optional<double> two_sides(const std::vector<Target>& list) {
  if (list.size() != 2 || list[0].parts.size() != 1 || list[1].parts.size() != 1) return std::nullopt;
  if (!have_same_corners(list[0].parts[0], list[1].parts[0])) return std::nullopt;
  const TargetFrame a = make_target_frame(list[0]), b = make_target_frame(list[1]);
  // Normals of the same corners, run the other way: the same but for their last digits. What leans away by more leaves
  // a wedge between the two planes, in which anything may hide.
  constexpr double kLastDigits = 16 * std::numeric_limits<double>::epsilon(), kRounding = 1e-12;
  if (a.all_sides || b.all_sides || (a.normal + b.normal).norm() > kLastDigits) return std::nullopt;
  const double apart = a.normal.dot(a.origin - b.origin);
  const double largest = a.origin.cwiseAbs().maxCoeff() + a.enclosing_radius_m;
  return apart >= -kRounding * largest ? std::optional(std::max(apart, 0.0)) : std::nullopt;
}

/// As prove_volume of one target does it, when the volume is there.
void check_claim(const Sensor& sensor) {
  if (!sensor.visible && !sensor.link) return;
  throw Error(ErrorCode::not_applicable,
              std::string("the volume is for ") + (sensor.visible ? "a share of the target" : "a radio link") +
                  ", and only the sight of a whole target can be proved",
              sensor.visible ? "sensor.visible" : "sensor.link", "check it with 'vantage verify'");
}

/// The views that a position must have, all of them; of the two sides of a target, the one that it is in front of.
/// `lift_m`: of the parts of all targets.
std::vector<ProvedView> proved_views(const Mission& mission, const std::vector<double>& lift_m) {
  if (mission.views.empty()) return {{mission.target, lift_m}};
  const auto lift_of = [&](std::size_t part) { return lift_m.empty() ? 0.0 : lift_m.at(part); };
  std::vector<ProvedView> views;
  std::size_t next = 0;
  for (const std::vector<Target>& list : mission.views) {
    std::optional<double> apart = two_sides(list);
    if (list.size() != 1 && !apart) {
      throw Error(ErrorCode::not_applicable,
                  "the volume is for one of several targets, and only the sight of all can be proved", "targets",
                  "check it with 'vantage verify', or compute one volume for each with 'combine: each'");
    }
    if (apart) *apart += lift_of(next) + lift_of(next + 1);  // they are raised away from each other
    for (const Target& target : list) {
      ProvedView& view = views.emplace_back(ProvedView{target, {}, apart});
      for (std::size_t i = 0; i < target.parts.size(); ++i) view.lift_m.push_back(lift_of(next++));
    }
  }
  return views;
}

/// Of the surface: the part that some of its facets are.
double share_of(const std::vector<std::uint32_t>& facets, const Mesh& volume) {
  Mesh some{volume.vertices, {}};
  for (const std::uint32_t facet : facets) some.triangles.push_back(volume.triangles[facet]);
  return surface_area(some) / surface_area(volume);
}

/// The worse of two verdicts on one claim, of several targets. All that was said of it is told, the worse first.
ClaimProof joined(const ClaimProof& a, const ClaimProof& b) {
  const bool is_b_worse = b.verdict != a.verdict ? b.verdict > a.verdict : b.broken_by_m > a.broken_by_m;
  ClaimProof worse = is_b_worse ? b : a;
  const std::string& other = (is_b_worse ? a : b).text;
  if (worse.text.find(other) == std::string::npos) worse.text += "; of another target: " + other;
  return worse;
}

/// What is wrong with the sight of one target is wrong with all.
void join(ProofReport& all, ProofReport&& one, const Mesh& volume) {
  for (std::size_t i = 0; i < all.claims.size(); ++i) all.claims[i] = joined(all.claims[i], one.claims[i]);
  all.tested_facets += one.tested_facets;
  all.separations += one.separations;
  all.seconds += one.seconds;
  all.margin_m = std::max(all.margin_m, one.margin_m);
  all.lift_m = std::max(all.lift_m, one.lift_m);
  all.lift_of_part_m.insert(all.lift_of_part_m.end(), one.lift_of_part_m.begin(), one.lift_of_part_m.end());
  all.layer_m = std::max(all.layer_m, one.layer_m);
  all.limit_tolerance_m = std::max(all.limit_tolerance_m, one.limit_tolerance_m);
  if (!one.unproved.empty()) {
    std::vector<std::uint32_t>& open = all.unproved;
    open.insert(open.end(), one.unproved.begin(), one.unproved.end());
    std::sort(open.begin(), open.end());
    open.erase(std::unique(open.begin(), open.end()), open.end());
    all.unproved_area_share = share_of(open, volume);
  }
  if (one.witness && (!all.witness || one.witness->depth_m > all.witness->depth_m)) all.witness = one.witness;
  if (all.maximal && one.maximal) all.maximal = vantage::join(*all.maximal, *one.maximal, volume);
  if (!one.certificate) all.certificate.reset();
  if (!all.certificate) return;
  for (CertificatePart& part : one.certificate->parts) all.certificate->parts.push_back(std::move(part));
}

fs::path folder_of(const fs::path& file) { return fs::absolute(file).parent_path(); }

/// As files state it.
bool is_same(const Georeference& a, const Georeference& b) {
  return a.latitude_deg == b.latitude_deg && a.longitude_deg == b.longitude_deg && a.vertical == b.vertical &&
         a.source_crs == b.source_crs;
}

/// The checker knows no more than the file: what was proved must be its numbers, and what it says of itself be true.
void check_is_of_file(const Certificate& certificate, const CertifiedFiles& about, const Scene& scene,
                      const VolumeFile& volume) {
  const std::string where = volume.file.string();
  const Scene in_file = read_scene(volume.file, {.missing = MissingPolicy::warn});
  if (volume_hash(in_file.mesh) != about.volume_hash) {
    throw Error(ErrorCode::not_applicable,
                "a certificate is about the numbers in the file, and others were proved: the volume was moved into the "
                "scene's frame, or its file was changed since",
                where, "compute the volume in the scene of this mission");
  }
  if (certificate.rounding_m != 0 && certificate.rounding_m != in_file.rounding_m) {
    throw Error(ErrorCode::not_applicable,
                "a certificate cannot rely on the rounding_m in the file, which is too large", where,
                "compute the volume again and write it as .ply");
  }
  if (in_file.georeference && (!scene.georeference || !is_same(*in_file.georeference, *scene.georeference))) {
    throw Error(ErrorCode::not_applicable,
                "a certificate is about a volume in the scene's frame, and its file names another place on the earth",
                where, "compute the volume in the scene of this mission");
  }
  if (!volume.volume.provenance) return;
  const VolumeProvenance& made = *volume.volume.provenance;
  if (volume.volume_hash != about.volume_hash) {
    throw Error(ErrorCode::not_applicable,
                "a certificate is about a volume as it was written, and this file was changed since: it names the hash "
                "of another mesh",
                where, "write it anew: \"vantage simplify\" with --facets 1000000000 leaves the mesh as it is");
  }
  if (made.scene_hash != about.scene_hash || made.mission_hash != about.mission_hash) {
    throw Error(ErrorCode::not_applicable,
                "a certificate is for the scene and the mission that the volume's file names, and these are others",
                where, "compute the volume for this mission");
  }
}

}  // namespace

ProofReport prove_volume(const Mission& mission, const Mesh& volume, const ProveOptions& options,
                         const Progress& progress) {
  internal::app::refuse_in_stand_ins(mission);
  std::optional<ProofReport> all;
  for (const ProvedView& view : proved_views(mission, options.lift_m)) {
    ProveOptions one = options;
    one.lift_m = view.lift_m;
    one.other_side_m = view.other_side_m;
    ProofReport report =
        prove_volume(mission.scene(), view.target, mission.sensor, mission.navigation, volume, one, progress);
    if (all) {
      join(*all, std::move(report), volume);
    } else {
      all = std::move(report);
    }
  }
  if (const auto missing = incomplete_warning(mission)) all->scene_incomplete = missing->text;
  if (all->certificate) all->certificate->scene_incomplete = all->scene_incomplete;
  return std::move(*all);
}

void check_provable(const Mission& mission) {
  check_claim(mission.sensor);
  proved_views(mission, {});
}

void check_certifiable(const Mission& mission) {
  check_claim(mission.sensor);
  const std::vector<ProvedView> views = proved_views(mission, {});
  const auto is_side = [](const ProvedView& view) { return view.other_side_m.has_value(); };
  if (std::none_of(views.begin(), views.end(), is_side)) return;
  throw Error(ErrorCode::not_applicable, "the volume is for both sides of a target, and certificates are for one",
              "targets", "leave the certificate out, or compute a volume for each side");
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
    check_not_an_input(file, inputs);
    check_certificate_output(file);
  }
  std::error_code ignored;
  if (!fs::equivalent(folder_of(certificate_file), folder_of(volume_file), ignored)) {
    throw Error(ErrorCode::not_applicable, "a certificate lies beside its volume, which is in another folder",
                certificate_file.string(),
                "write " + (volume_file.parent_path() / certificate_file.filename()).string());
  }
  internal::app::check_certified_ply(volume_file);
}

void write_certificate(const Certificate& certificate, const Mission& mission, const VolumeFile& volume,
                       const fs::path& certificate_file) {
  const Scene& scene = mission.scene();
  const fs::path scene_file = certificate_scene_file(certificate_file);
  CertifiedFiles about;
  about.scene_file = scene_file.filename().string();
  about.scene_hash = scene_hash(scene);
  about.volume_file = volume.file.filename().string();
  about.volume_hash = volume_hash(volume.volume.mesh);
  about.mission_hash = mission_hash(mission);
  check_is_of_file(certificate, about, scene, volume);
  auto files = stage_scene(scene, scene_file).files;
  files.push_back(std::make_unique<AtomicFile>(certificate_file));
  files.back()->write(certificate_text(certificate, about));
  for (const fs::path& file : {certificate_file, scene_file}) check_certificate_output(file);  // it may have taken long
  commit_all(files);
}

}  // namespace vantage
