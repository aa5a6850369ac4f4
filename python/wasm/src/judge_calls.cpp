// Volumes proved, certified and surrounded, and lists of what the engine knows: as python/src/judges.cpp and others.
#include "common/json.h"
#include "common/output.h"
#include "common/shown_address.h"
#include "held.h"
#include "vantage/camera.h"
#include "vantage/error.h"
#include "vantage/mission_keys.h"
#include "vantage/prove.h"
#include "vantage/result.h"
#include "vantage/version.h"

namespace vantage::wasm {
namespace {

ProveOptions prove_options(const Json& a, const HeldVolume& volume, double tolerance_m) {
  return {.shrink = a.at("shrink").get<double>(),
          .rounding_m = volume.rounding_m,
          .lift_m = volume.volume->lift_m,
          .maximal = a.at("maximal").get<bool>(),
          .tolerance_m = tolerance_m};
}

Json prove(const Json& a) {
  const auto mission = held<HeldMission>(a, "mission");
  const auto volume = held<HeldVolume>(a, "volume");
  const ProveOptions options = prove_options(a, *volume, mission->mission->as_written.exact.tolerance_m);
  return json_text(prove_volume(*mission->mission, volume->volume->mesh, options, tell_progress));
}

Json prove_by_provenance(const Json& a) {
  const auto volume = held<HeldVolume>(a, "volume");
  const auto scene = held<HeldScene>(a, "scene");
  const auto& from = volume->volume->provenance;
  if (!from) {
    throw Error(ErrorCode::nothing_given, "the volume does not say what it was computed for", "",
                "pass the mission: mission.prove(volume)");
  }
  if (!from->views.empty()) {
    throw Error(ErrorCode::not_applicable, "the volume is for several targets", "",
                "pass the mission: mission.prove(volume)");
  }
  if (!from->scene_hash.empty() && from->scene_hash != scene->hash()) {
    throw Error(ErrorCode::not_applicable, "the volume was computed in another scene", from->scene_hash,
                "pass the scene with this hash");
  }
  return json_text(prove_volume(scene->scene(), from->target, from->sensor, {}, volume->volume->mesh,
                                prove_options(a, *volume, volume->volume->tolerance_m), tell_progress));
}

Json certify(const Json& a) {
  const auto mission = held<HeldMission>(a, "mission");
  const std::filesystem::path file = a.at("volume_file").get<std::string>();
  const std::filesystem::path certificate = a.at("certificate").get<std::string>();
  std::vector<std::filesystem::path> inputs = input_files(mission->mission->as_written);
  inputs.push_back(file);
  check_certificate_files(certificate, file, inputs);
  const VolumeFile read = read_volume(file, mission->mission->scene(), tell_progress);
  const VerifyOptions known = verify_options(read, *mission->mission);
  const ProveOptions options{.shrink = a.at("shrink").get<double>(),
                             .rounding_m = known.rounding_m,
                             .lift_m = known.lift_m,
                             .maximal = a.at("maximal").get<bool>(),
                             .tolerance_m = known.tolerance_m,
                             .certificate = true};
  const ProofReport report = prove_volume(*mission->mission, read.volume.mesh, options, tell_progress);
  if (report.certificate) write_certificate(*report.certificate, *mission->mission, read, certificate);
  return json_text(report);
}

Json outer(const Json& a) {
  const auto mission = held<HeldMission>(a, "mission");
  OuterVolume made =
      outer_volume(*mission->mission, mission->run_options(tell_progress),
                   {a.at("tolerance_m").get<double>(), a.at("limit_margin_m").get<double>()}, tell_progress);
  return {keep_volume(std::move(made.volume)), made.facets, made.open_facets, made.ignored};
}

Json keys(const Json&) {
  Json rows = Json::array();
  for (const MissionKey& key : mission_keys()) {
    rows.push_back({{"section", key.section},
                    {"path", key.path},
                    {"kind", name_of(key.kind)},
                    {"unit", key.unit},
                    {"is_old", key.is_old},
                    {"text", key.text}});
  }
  return rows;
}

Json codes(const Json&) {
  Json errors = Json::array(), warnings = Json::array();
  for (const ErrorCode code : error_codes()) errors.push_back(name_of(code));
  for (const WarningCode code : warning_codes()) warnings.push_back(name_of(code));
  return {{"errors", errors}, {"warnings", warnings}};
}

}  // namespace

void add_judge_calls(Calls& calls) {
  calls["prove"] = &prove;
  calls["prove_by_provenance"] = &prove_by_provenance;
  calls["certify"] = &certify;
  calls["outer_volume"] = &outer;
}

void add_list_calls(Calls& calls) {
  calls["mission_keys"] = &keys;
  calls["codes"] = &codes;
  calls["without_secrets"] = [](const Json& a) -> Json {
    return without_secrets(a.at("text").get<std::string>(), a.at("is_address").get<bool>());
  };
  calls["version"] = [](const Json&) -> Json { return VANTAGE_VERSION; };
  calls["object_kinds"] = [](const Json&) -> Json {
    Json names = Json::array();
    for (int i = 0; i <= static_cast<int>(ObjectKind::tree); ++i) names.push_back(name_of(static_cast<ObjectKind>(i)));
    return names;
  };
  calls["output_formats"] = [](const Json& a) -> Json {
    return a.at("scenes").get<bool>() ? mesh_format_words() : format_words();
  };
  calls["cameras"] = [](const Json&) -> Json {
    std::vector<ListedCamera> listed;
    for (const Camera& camera : known_cameras()) listed.push_back({camera, ""});
    return json_text(listed);
  };
}

}  // namespace vantage::wasm
