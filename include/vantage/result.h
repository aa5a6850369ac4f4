// Results as files: volumes with reports beside them, and volumes read again.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vantage/error.h"
#include "vantage/export.h"
#include "vantage/mission.h"
#include "vantage/progress.h"
#include "vantage/prove.h"
#include "vantage/spheres.h"
#include "vantage/verify.h"
#include "vantage/volume.h"

namespace vantage {

// ---- reports ----

/// How the spheres method was run.
struct SpheresRun {
  SpheresOptions options;
  SpheresReport report;
};

/// What the volume was made from, for the report; empty entries are left out.
struct ReportSource {
  std::string mission;                               ///< file
  std::string scene;                                 ///< file
  std::string target;                                ///< name
  std::string volume;                                ///< the file that holds the volume
  std::optional<SpheresRun> spheres = std::nullopt;  ///< the method was spheres; else it was exact
};

/// The part of a report that tells of the spheres method: a JSON object.
VANTAGE_API std::string spheres_json(const SpheresRun& run);

/// A JSON object, UTF-8, two spaces of indentation, a newline at the end. Lengths are metres in the scene frame.
/// `causes` are in the order of Volume::causes, so that the facet property of a PLY file indexes them. `bounding_box`
/// is null for an empty volume; `georeference` is there when the scene has one. Bytes of names that are not UTF-8 are
/// replaced.
VANTAGE_API std::string report_json(const Volume& volume, const MeshMeasures& measures,
                                    const ReportSource& source = {});

// ---- files ----

/// What write_results writes; result_request makes that of a mission.
struct ResultRequest {
  std::vector<std::filesystem::path> volumes;  ///< files to write; each extension chooses a format, see write_volume
  UpAxis obj_up = UpAxis::z;                   ///< as Scene::up
  double obj_scale = 1.0;                      ///< as Scene::scale
  ReportSource source = {};                    ///< `volume` is filled in for each report
  bool are_names_derived = false;              ///< nobody gave the names of `volumes`: only own files are replaced
  std::optional<double> sea_level_z_m = {};    ///< z of the mean sea level, where it is known: KML needs it
};

/// Of a mission's result: an OBJ is written in the axes and the unit of the scene's file.
VANTAGE_API ResultRequest result_request(const Mission& mission, const Result& result,
                                         std::vector<std::filesystem::path> volumes);

/// To call before a long computation: throws, as check_volume_output, check_derived_output and check_not_an_input do,
/// unless each volume and the report beside it can be written. `inputs`: of the mission, see input_files. Throws
/// Error(input) for a file that is named twice.
VANTAGE_API void check_result_files(const std::vector<std::filesystem::path>& volumes,
                                    const std::vector<std::filesystem::path>& inputs);

/// The file of one volume of a mission with Combine::each: "volume.ply" becomes "volume.TARGET.ply", where TARGET is
/// the target's name with '_' for all that is neither a letter, a digit, '-' nor '.' of ASCII. `names`: of all targets,
/// in order; of files that would be one, the second is "volume.TARGET-2.ply".
VANTAGE_API std::vector<std::filesystem::path> volume_files(const std::filesystem::path& file,
                                                            const std::vector<std::string>& names);

/// "volume.ply" of such a mission has the table of its volumes in "volume.table.csv".
VANTAGE_API std::filesystem::path table_file(const std::filesystem::path& file);

/// A row of the table.
struct TableRow {
  std::string target;              ///< name
  std::filesystem::path file;      ///< the first that holds the volume; not used where there is none
  const Volume* volume = nullptr;  ///< with its seconds
  const MeshMeasures* measures = nullptr;
};

/// CSV with a header: target, outcome, reason, volume_m3, area_m2, facets, pieces, lift_m, seconds, file (its name
/// alone). Without a volume its numbers are 0.
VANTAGE_API std::string table_csv(const std::vector<TableRow>& rows);

struct WrittenResults {
  MeshMeasures measures;
  std::vector<WrittenVolume> written;          ///< of each file that is asked for; empty when there is no volume
  std::vector<std::filesystem::path> reports;  ///< those written
  std::string report;                          ///< text of the first file's
};

/// "volume.ply" has its report in "volume.report.json".
VANTAGE_API std::filesystem::path report_file(const std::filesystem::path& volume_file);

/// Writes the volume to every file that is asked for, and a report beside each; only the reports when there is no
/// volume. First of all it is measured. All files are written or none: when anything fails, old ones stay as they were.
/// Fills Volume::seconds.write (until all is ready on the disk) and adds it to the total. Throws Error(internal) for a
/// volume that is not closed and oriented, Error(cancelled) when told to stop, as check_derived_output for a report or,
/// where their names are derived, a volume that it would replace, and as write_volume does.
VANTAGE_API WrittenResults write_results(Volume& volume, const ResultRequest& request, const Progress& progress = {});

/// A volume, or any other mesh, as its file says.
struct VolumeFile {
  std::filesystem::path file;
  Volume volume;  ///< mesh and georeference; `cause_of` and `causes` where the file has them (PLY); provenance,
                  ///< tolerance and lifts where it states them: PLY, OBJ, GLB, and the file beside an STL
  std::string volume_hash;     ///< as stated; empty: not
  double rounding_m = 0;       ///< Scene::rounding_m
  std::vector<Warning> notes;  ///< that the mesh was changed or moved, that its heights do not fit
};

/// Reads a mesh into a frame. OBJ is in the axes and the unit of `obj`, unless it says them; other formats say it
/// themselves. A mesh that says where on the earth it lies is moved about the origin of `frame`, where there is one;
/// any other is taken to be in the frame. Heights stay as they are. Throws as read_scene does, and Error(input) for a
/// mesh that lies more than 100 km away and for causes that are out of range.
VANTAGE_API VolumeFile read_volume(const std::filesystem::path& file, const SceneReadOptions& obj = {},
                                   const std::optional<Georeference>& frame = {}, const Progress& progress = {});

/// The same for what was computed in a scene: OBJ as the scene's own file.
VANTAGE_API VolumeFile read_volume(const std::filesystem::path& file, const Scene& scene,
                                   const Progress& progress = {});

/// Why the file may not be what the mission's volume is: it was computed in another scene or for another mission. Cost:
/// scene_hash.
VANTAGE_API std::vector<Warning> volume_warnings(const VolumeFile& read, const Mission& mission);

/// How verify_volume has to judge a file for a mission: the mission's tolerance, and the lifts and the rounding that
/// the file states. A file without lifts has them from the report beside it, "volume.report.json", and none without
/// that. Throws Error(input) for a report that cannot be read.
VANTAGE_API VerifyOptions verify_options(const VolumeFile& read, const Mission& mission);

/// verify_volume for what a mission's volume claims: its target, or of each list of its views one. In the library
/// with verify_volume.
VANTAGE_API VerifyReport verify_volume(const Mission& mission, const Mesh& volume, const VerifyOptions& options = {},
                                       const Progress& progress = {});

// ---- proofs ----

/// prove_volume for all that a mission's volume claims: each of several targets must be seen, and the certificate has
/// the parts of all. ProveOptions::lift_m: of the parts of all targets, in order. What is told of sight is the worst.
/// Throws Error(input) as that does, and for a mission whose volume is for one of several targets or sides.
VANTAGE_API ProofReport prove_volume(const Mission& mission, const Mesh& volume, const ProveOptions& options = {},
                                     const Progress& progress = {});

/// To call before a long computation: throws Error(input) for a mission that prove_volume refuses whatever its volume
/// is, as that does.
VANTAGE_API void check_provable(const Mission& mission);

/// The same, and Error(input) for a mission that has no certificates: its volume is for both sides of a target.
VANTAGE_API void check_certifiable(const Mission& mission);

/// What a proof refutes by the definitions of verify_volume, which forgive more. Of claims that are wrong these become
/// `not_proved`: sight, where the witness is hidden by nothing but what lies lower than 1 mm over the target, and a
/// limit that is broken by no more than VerifyOptions::depth_tolerance. `options`: of verify_volume.
VANTAGE_API ProofReport with_verify_tolerances(ProofReport proof, const Mission& mission, const VerifyOptions& options);

/// "volume.cert" lies beside its scene in "volume.scene.ply".
VANTAGE_API std::filesystem::path certificate_scene_file(const std::filesystem::path& certificate_file);

/// Throws Error(input) for a volume that a certificate cannot be about: its file is no binary, little-endian PLY of
/// triangles, or lies in another folder than the certificate. Throws as check_can_write and check_not_an_input do
/// unless the certificate and its scene can be written, and Error(output_of_others) where they would replace a file
/// that vantage did not write.
VANTAGE_API void check_certificate_files(const std::filesystem::path& certificate_file,
                                         const std::filesystem::path& volume_file,
                                         const std::vector<std::filesystem::path>& inputs);

/// Writes the certificate of a volume, and its scene beside it: both or none. `volume` is as it was read, and its file
/// is read again: throws Error(input) where that holds another mesh (as when read_volume moved it into the scene's
/// frame), names another scene or mission, or states a larger rounding than its numbers can have.
VANTAGE_API void write_certificate(const Certificate& certificate, const Mission& mission, const VolumeFile& volume,
                                   const std::filesystem::path& certificate_file);

// ---- Outer volumes: a mesh around all that belongs to a mission's volume

struct OuterOptions {
  double tolerance_m = 0;        ///< how coarse facets of the range may be; >= 0. 0: a thousandth of the range
  double limit_margin_m = 0.01;  ///< limits of navigation are made wider by so much on every side; > 0
};

struct OuterVolume {
  Volume volume;  ///< closed; empty only where no position is within range of all corners of a target, or limits leave
                  ///< nothing
  std::size_t facets = 0;            ///< of the star-shaped meshes that it is made of
  std::size_t open_facets = 0;       ///< of these, those without a witness: they were moved out beyond the range
  std::vector<std::string> ignored;  ///< limits that it is not cut to: it is larger than it could be, and right
};

/// Holds every position from which the mission's target, raised by PreparedTarget::lift_m, is seen whole, in range and
/// within the limits. For each part of each target the exact volume of sight and range is moved out from the target's
/// centre by twice its tolerance, and prove_maximal looks at each facet: beyond those that have a witness there is no
/// position. What has none is moved out further, and at last beyond the range. So nothing is taken on trust from the
/// method that computes volumes. The union or the intersection for several targets is as the mission says.
///
/// It is cut to altitude, heights above the ground and boxes (to stay in without zones, to stay out of), all made wider
/// by limit_margin_m, which is far above the rounding of booleans and of cleaning. An incidence of up to 85 degrees
/// cuts it to pyramids round the cones at up to eight corners of the target, as much wider. Other limits of navigation
/// and of the sensor, besides the range, only make the true volume smaller: they are ignored, and named. With a
/// VisibleShare (sensor.visible) all that is in range and in front of the target is taken.
///
/// Left out, as in docs/proof.md, "Maximal": positions lower over the target's plane than a millionth of their distance
/// from its centre, and those that see the target only past triangles without width. A target that is a point is taken
/// for a ball of 0.5 mm.
///
/// `options.threads`: at most so many. Throws as run_mission, and Error(input) for a tolerance or a margin that is no
/// such number. Cost: of a computation with that tolerance, and of prove_maximal, up to three times.
VANTAGE_API OuterVolume outer_volume(const Mission& mission, const RunOptions& options = {},
                                     const OuterOptions& outer = {}, const Progress& progress = {});

}  // namespace vantage
