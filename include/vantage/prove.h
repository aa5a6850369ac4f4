// The proof of a volume: every facet is looked at, no sample is drawn. It shares no code with the methods.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "vantage/export.h"
#include "vantage/geometry.h"
#include "vantage/navigation.h"
#include "vantage/progress.h"
#include "vantage/scene.h"
#include "vantage/target.h"

namespace vantage {

// ---- Certificates: what a stranger's program needs to check a proof; certificate_text has the format

/// A box that all of the volume keeps to. Infinite where there is no limit.
struct CertifiedBox {
  std::string name;  ///< of the limit
  Box box;
};

/// One part of a target, and how each view of it from the volume is separated from the scene.
struct CertificatePart {
  std::vector<Vec3> target;           ///< as the target was given, scene frame
  double shift_m = 0;                 ///< so far along `normal` from there is what was proved
  Vec3 centre = Vec3::Zero();         ///< scene frame: a point of the part; facets whose plane holds it need no test
  std::vector<Vec3> corners;          ///< of what is proved to be seen, about `centre`
  Vec3 normal = Vec3::Zero();         ///< to the side that is looked at; unit length, but for rounding
  bool all_sides = false;             ///< a point that is looked at from all sides: nothing is cut
  double cut_height_m = 0;            ///< what of the scene lies lower over the plane through `centre` does not count
  std::vector<std::uint32_t> facets;  ///< the tested ones by number, in the order in which they are halved
  /// Group by group of facets, and for each what becomes of the nodes of the scene's tree: the number of a plane that
  /// is known (0 to 15); 16 and a new plane's normal, three whole numbers; 17: to be taken apart; 18: left to the
  /// halves of the group; 19: nothing of it lies in front of the target.
  std::vector<std::int64_t> steps;
};

struct Certificate {
  double shrink = 0;       ///< ProveOptions::shrink
  double rounding_m = 0;   ///< ProveOptions::rounding_m
  double max_range_m = 0;  ///< of every point to every corner of the target
  std::vector<CertifiedBox> boxes;
  std::vector<CertificatePart> parts;  ///< all of them are seen from everywhere in the volume
  std::string scene_incomplete = {};   ///< ProofReport::scene_incomplete
};

/// The files that a certificate lies beside, and their hashes (docs/hashes.md).
struct CertifiedFiles {
  std::string scene_file;  ///< PLY with double precision, in the scene frame; relative to the certificate's folder
  std::string scene_hash;
  std::string volume_file;  ///< PLY
  std::string volume_hash;
  std::string mission_hash;
};

/// JSON, UTF-8, a newline at the end. These keys, each once, and no others:
///   format         "vantage certificate 1"
///   scene_incomplete  what of the scene is not built as it stands, for people; only where anything is within reach
///   scene, volume  "file", beside the certificate, and "hash"
///   mission_hash, shrink, rounding_m, max_range_m
///   boxes          limits that all of the volume keeps: name, min, max; null: no limit
///   parts          of the target; each with
///     target, shift_m, normal   corners as given; how far they were moved along the normal (offset and lift)
///     centre, corners           c, and what is proved to be seen, about c: the target less the strip
///     cut_height_m              1.5 margins; null: a point that is seen from all sides
///     facets                    to the base of 36, in the order in which groups are made
///     steps                     what becomes of the scene, group by group: a text
///
/// Facets are halved (the first half is the smaller one) until a group has at most 256. For each group, depth first,
/// the scene's tree is gone through from its root. The checker makes the tree from the scene, and its boxes are exact:
/// triangles are halved by the middle of their boxes along the axis along which those middles spread most, in doubles,
/// ties by number; leaves hold one or two. A step says what becomes of a node or a triangle:
///   0 to f   the plane of this number has the group's hull strictly on one side, the box or triangle on the other
///   (x,y,z)  the same for a new plane with this normal, to the base of 36. It gets the next number, after f again 0
///   >        taken apart: the children come next, the first one first
///   <        left to the two halves of the group, which come when all else of the group is done
///   .        nothing of it lies higher than the cut
/// The vertices of the hull are (1 - shrink) * (vertex - centre), in doubles, the corners, and c. Normals are whole
/// numbers, as small as they can be.
///
/// A checker refuses what is not written exactly so. Numbers have the digits of ASCII that a double holds; whole
/// numbers to the base of 36 no signs, zeros and blanks that are not needed. Of the PLY files: the lines of the header
/// are "ply", the format, comments, vertices with their properties, faces with theirs, and "end_header", each with
/// single blanks and a line feed at its end; the size of the file is the one that they say. Letters are those of ASCII,
/// but in the names of causes. Comments hold no control characters and not "end_header".
VANTAGE_API std::string certificate_text(const Certificate& certificate, const CertifiedFiles& files);

// ---- Proofs

/// `wrong` has a witness, a viewpoint that anybody can check by hand. What is not proved may be right all the same.
enum class ProofVerdict { proved, not_proved, wrong };

/// "proved", "not proved", "wrong".
VANTAGE_API const char* name_of(ProofVerdict verdict);

/// Why no position beyond a facet belongs to the volume.
enum class WitnessKind : std::uint8_t {
  none,
  navigation,        ///< a limit of navigation is broken there
  sensor,            ///< a limit of the sensor besides its range
  range,             ///< a corner of the target is out of range
  hidden,            ///< one convex polygon of the scene hides something of the target from all of the facet
  hidden_in_pieces,  ///< different ones do from pieces of the facet
  edge_on,           ///< the facet's plane holds the target's centre: nothing is beyond it
  target_plane,      ///< likewise: the facet lies in the target's plane
};

/// "none", "navigation", "sensor", "range", "hidden", "hidden in pieces", "edge-on", "target plane".
VANTAGE_API const char* name_of(WitnessKind kind);

struct ProveOptions {
  double shrink = 1e-6;   ///< the proof is of the volume shrunk by this part of the distance towards the
                          ///< target; at least 0, less than 1
  double rounding_m = 0;  ///< of the volume's file (Scene::rounding_m): limits may be broken by so much, and
                          ///< sight is wrong only where it is hidden deeper below the facet. Not more is believed
                          ///< than numbers of single precision are rounded by: 2^-22 of the largest coordinate
  /// How far each part of the target was raised (Volume::lift_m), 0 to kMostLift; empty: not at all. Of what is more
  /// than its surface needs (lifts_needed_m) the rest is not believed.
  std::vector<double> lift_m = {};
  static constexpr double kMostLift = 0.01;
  bool maximal = false;       ///< whether the volume is as large as it can be, too
  double tolerance_m = 0.01;  ///< for `maximal`: how far the volume's range facets may lie inside the range
                              ///< (ExactOptions::tolerance_m); at least 0
  bool certificate = false;   ///< record one: takes longer, as all of the scene goes into its tree

  /// Of a target that may be seen from one side or the other, one side: how far the plane of the other one, raised as
  /// well, lies behind its plane. At least 0. Then what lies behind is left to a call for the other side, and nothing
  /// may lie between the planes. For targets of one part with a front.
  std::optional<double> other_side_m = {};
};

/// The most that a part of a target may have to be raised by, to clear the surface that it lies on: what of the scene
/// lies straight over it and reaches no higher than 2 mm, and what hardly rises above its plane beside it
/// (docs/proof.md). For a point that is seen from all sides up to 2 mm more. One for each part. `range_m`: of the
/// sensor; in worlds with less than 20 m it is less. Cost: n log n of the triangles, and for each part what is near its
/// plane. Throws Error(input) for a target that is wrong in itself; Error(cancelled) when told to stop.
VANTAGE_API std::vector<double> lifts_needed_m(const Scene& scene, const Target& target, double range_m,
                                               const Progress& progress = {});

/// A place in the shrunk volume from which a point of the target is hidden.
struct HiddenView {
  Vec3 viewpoint = Vec3::Zero(), target_point = Vec3::Zero();  ///< scene frame
  std::uint32_t triangle = 0;  ///< of the scene: the segment between the two passes through it
  std::string object;          ///< its name
  std::uint32_t facet = 0;     ///< of the volume: the viewpoint lies on it, or straight in front of it
  double depth_m = 0;          ///< from the facet towards the target so far positions are hidden as well, at least
};

/// One of the things that a volume claims besides sight.
struct ClaimProof {
  std::string name;  ///< "sight", "range", "front", or name_of(Limit)
  ProofVerdict verdict = ProofVerdict::not_proved;
  std::string text;  ///< by what, why not, or where it is wrong

  /// Of range, front or a limit that is wrong: a place of the volume, scene frame, that breaks it, and by how many
  /// metres at least.
  std::optional<Vec3> place = {};
  double broken_by_m = 0;
};

/// Of a facet: of its area that has a witness, what most of it has.
struct FacetWitness {
  WitnessKind kind = WitnessKind::none;
  std::uint32_t limit = 0;  ///< of kind navigation and sensor: in MaximalProof::limits
  double open = 1;          ///< part of its area that has no witness
};

struct MaximalCondition {
  std::string text;
  bool holds = false;
};

/// Whether the volume is as large as it can be. This is no part of the verdict: a smaller volume is right, too.
struct MaximalProof {
  struct Row {
    WitnessKind kind = WitnessKind::none;
    std::string limit;       ///< of kind navigation and sensor
    std::size_t facets = 0;  ///< of which it is the witness; of `none`: those that have none at all
    double area_share = 0;   ///< of the whole surface
  };
  std::vector<Row> rows;             ///< `none` last; those without facets are left out
  double proved_share = 0;           ///< by area, of the whole surface
  std::vector<std::uint32_t> open;   ///< facets of which a part, or all, has no witness
  std::vector<FacetWitness> facets;  ///< one for each of the volume's facets
  std::vector<std::string> limits;   ///< names that the facets refer to
  std::vector<std::string> sampled;  ///< limits that are given, and for which no facet can have a witness
  /// With all of them, and with a witness for each facet, no position outside belongs to the volume. Else each facet is
  /// where it must be, and a piece that is missing as a whole is not noticed.
  std::vector<MaximalCondition> conditions;
  double grow = 0;     ///< facets were moved out by this part of the distance from the target
  double range_m = 0;  ///< less the tolerance: for this range it is proved
  double tolerance_m = 0;
  double point_radius_m = 0;  ///< of a target that is a point: a ball of this radius about it must be seen
  double seconds = 0;

  VANTAGE_API bool conditions_hold() const;
};

/// Of volumes that must claim two targets: a facet's witness is that of one of them. `volume`: the mesh.
VANTAGE_API MaximalProof join(const MaximalProof& a, const MaximalProof& b, const Mesh& volume);

struct ProofReport {
  std::vector<ClaimProof> claims;
  std::size_t facets = 0;               ///< of the volume
  std::size_t tested_facets = 0;        ///< whose plane does not hold the centre of a part, summed over the parts
  std::vector<std::uint32_t> unproved;  ///< facets of which it is not proved that the target is seen from them
  double unproved_area_share = 0;       ///< of the whole surface
  std::optional<HiddenView> witness;    ///< the deepest that was found; of `wrong` sight
  std::size_t separations = 0;          ///< planes that were found between a part of the view and obstacles
  double shrink = 0;                    ///< what was asked for
  double margin_m = 0;                 ///< a strip of the target along its outline, and what lies lower over its plane,
                                       ///< is left out: so much; with a layer the strip is four times as wide
  double lift_m = 0;                   ///< the largest of a part, as far as it is believed
  std::vector<double> lift_of_part_m;  ///< of each part, of all targets, likewise
  double rounding_m = 0;               ///< what was allowed
  double layer_m = 0;            ///< sight and front are proved of the volume less what is nearer than this to places
                                 ///< outside of it: for what numbers are rounded; 0: of all of it
  double limit_tolerance_m = 0;  ///< limits besides altitude and a single box may be broken by so much (docs/proof.md):
                                 ///< rounding_m, `shrink` times the distance of a facet, and rounding; the largest
  /// The proof is of the scene as built. What of its ledger lies within reach of the mission's target, as the warning
  /// scene_incomplete tells it; empty: nothing, or no mission was given.
  std::string scene_incomplete;
  double seconds = 0;
  std::optional<MaximalProof> maximal;     ///< where it was asked for
  std::optional<Certificate> certificate;  ///< where sight, range and front are proved and nothing is wrong

  /// The worst of the claims; not_proved without any.
  VANTAGE_API ProofVerdict verdict() const;
};

/// Proves or refutes that every point of the volume sees the whole target and keeps its range. docs/proof.md has the
/// theorem and what exactly is stated. `volume` is any closed mesh in the scene frame, whoever made it, cut or not;
/// vertices in one place count as one. All parts of the target must be seen. Each limit of navigation and of the sensor
/// is a claim of its own, and those without a proof are told as not proved.
///
/// With `maximal` it also looks beyond the facets, for what is missing: docs/proof.md, "Maximal".
///
/// The report does not depend on the number of threads. Cost: a few times that of the exact method, and linear in the
/// triangles of the scene near the volume. Throws Error(input) for a target, sensor, limit or option that is wrong in
/// itself, a sensor with a VisibleShare or a link (what these claim is not the sight of all of a target) and for a mesh
/// that has no triangles, is not closed or not oriented, is inside out, has an index out of range or a coordinate that
/// is not finite; Error(cancelled) when told to stop.
VANTAGE_API ProofReport prove_volume(const Scene& scene, const Target& target, const Sensor& sensor,
                                     const Navigation& navigation, const Mesh& volume, const ProveOptions& options = {},
                                     const Progress& progress = {});

/// What prove_volume finds with `maximal`, without its proof of sight, range and limits: whether a mesh, which need not
/// be right, holds all that belongs to the volume. Each part of the target must be seen; a facet's witness is that of
/// one of them. `options`: shrink, rounding_m, lift_m and tolerance_m count. Throws as prove_volume, and Error(input)
/// with `other_side_m`. Cost: less than half of it.
VANTAGE_API MaximalProof prove_maximal(const Scene& scene, const Target& target, const Sensor& sensor,
                                       const Navigation& navigation, const Mesh& volume,
                                       const ProveOptions& options = {}, const Progress& progress = {});

}  // namespace vantage
