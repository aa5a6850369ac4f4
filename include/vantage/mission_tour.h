// The tour that a mission asks for: its volumes, the flight through them, and a bound that no flight is shorter.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vantage/export.h"
#include "vantage/flight.h"
#include "vantage/geometry.h"
#include "vantage/mission.h"
#include "vantage/progress.h"
#include "vantage/scene.h"
#include "vantage/tour.h"
#include "vantage/volume.h"

namespace vantage {

/// What proves a bound: for write_tour_certificate.
struct TourProof;

/// What no tour can be shorter than. Where there is a home: no tour that begins where this one does, straight above it
/// (start_above_home_m), and comes back there where it is closed. One that begins at another height may be shorter.
struct TourLowerBound {
  double length_m = 0;
  double gap = 1;                    ///< (length - bound) / length of the tour that was found
  std::string kind = {};             ///< "insertion", "pairs": docs/theory.md, "Tours"
  std::vector<std::string> ignored;  ///< what makes tours longer, and the bound does not know
  std::shared_ptr<const TourProof> proof = {};
  /// No tour takes less time: the bound's length at full speed or, where targets are viewed one after the other, all
  /// dwells, whichever is more. It ignores speeding up, hovering besides, and what the length ignores.
  double time_s = 0;
};

/// A target of a tour.
struct MissionTourTarget {
  std::string name;
  Vec3 centre = Vec3::Zero();  ///< the camera looks there; scene frame
  Mesh volume;                 ///< computed: from its inside the target is seen
  bool is_volume = false;      ///< the target is a volume itself: `volume` is that, within the limits of navigation
};

struct MissionTour {
  TourSettings settings;
  Tour tour;
  std::vector<MissionTourTarget> targets;   ///< of the mission, in its order
  std::optional<Vec3> home = std::nullopt;  ///< on the ground; scene frame
  /// So far above `home`, up to 20 m, it may climb at first: the airspace allows it from the tour's start on.
  std::optional<double> highest_takeoff_m = std::nullopt;
  /// Where it hovers, where the fewest positions were asked for; targets by their index in `targets`.
  std::optional<FewestPositions> fewest = {};
  std::optional<TourLowerBound> bound = {};  ///< of the targets that are visited; nothing where it was not asked for
  std::vector<std::string> notes = {};       ///< what to know before relying on it
  /// What of the scene's ledger lies within reach of the flight, or else of the targets, as the warning
  /// scene_incomplete tells it; in `notes` too. Empty: nothing.
  std::string scene_incomplete = {};

  /// Whether all targets are visited.
  bool is_complete() const { return tour.problems.empty(); }
  /// Whether the gap that the settings ask for was reached.
  bool reaches_gap() const { return bound && bound->gap <= settings.gap.value_or(kTourGap); }
};

/// Of a mission whose one target is a volume (Target::volume): what the limits of navigation leave of it. Throws
/// Error(not_applicable) for another target, and as cut_to_navigation does.
VANTAGE_API Volume volume_to_fly_through(const Mission& mission, const Progress& progress = {});

/// How far above its home the flight of a tour begins: where flying is allowed first, in steps of 0.5 m. Nothing where
/// there is no home, or no flight.
VANTAGE_API std::optional<double> start_above_home_m(const MissionTour& tour);

struct MissionTourOptions {
  int threads = 0;         ///< at most; 0: as many as the machine has
  bool with_bound = true;  ///< it takes outer volumes, which take longer than the volumes
  /// Of the bound; beside "tour.cert" come the meshes it is of, "tour.region0.ply" and so on. Empty: none is written.
  std::filesystem::path certificate = {};
  std::optional<PreparedScene> prepared = {};  ///< the mission's scene, where it is prepared already
  /// Of each target the position that it is viewed from, scene frame: within 1 cm of it, so it lies at least so deep in
  /// the target's volume. TourSettings::margin_m is not looked at. Empty: the tour finds positions itself.
  std::vector<Vec3> positions = {};
  /// The tour hovers at as few positions as possible (vantage/tour.h), TourSettings::margin_m deep in the
  /// volumes of the targets that are viewed from them; their exact queries are asked, too. No flight is compared with
  /// it: there is no bound of its length, and `with_bound` is whether to find out how many positions are necessary. A
  /// multirotor alone, without `positions` and `certificate`; else Error(input).
  bool fewest_positions = false;
};

/// Computes a volume of each target of the mission, and plans the tour that MissionFile::tour asks for (TourSettings()
/// where it asks for none): plan_tour, with the mission's limits of navigation and its clearance from the scene as the
/// airspace. From the home it climbs straight up to where flying is allowed. The bound is over outer volumes
/// (vantage/result.h), in which every position lies from which a target is seen: so no tour is shorter, whatever its
/// order and its positions.
///
/// A target that is a volume (Target::volume) is visited inside it, within the limits of navigation; the camera looks
/// at nothing there. The bound is over its mesh as it is. Where its file states a rounding, which may have taken
/// something away, the bound is less by four roundings for each.
///
/// The time limit is that of the search for the tour, and once more that of the bound, or of the search for positions;
/// volumes come on top.
///
/// Throws Error(input) as run_missions and plan_tour do; for positions that are not as many as the targets, or not in
/// their volumes; for a target that cannot be seen from anywhere, with its name; for a home inside a solid, and one
/// from which nothing can be reached straight up, with what stands there; for zones to stay in that are too narrow for
/// a fixed wing to turn; and before anything is computed for a certificate whose meshes would replace an input, or a
/// file that vantage did not write. Error(cancelled) before there is a tour; later the tour is returned without a
/// bound.
VANTAGE_API MissionTour plan_mission_tour(const Mission& mission, const MissionTourOptions& options = {},
                                          const Progress& progress = {});

/// The tour as a plan for ground stations: photos where targets are seen, the camera turned so that they are whole in
/// the picture. Where several are viewed one after the other from one place, its point comes once for each, with a
/// share of the hold. From a home it takes off; it returns there if the tour is closed. Heights are above the home,
/// where there is one. Of a scene without a place on the earth it is x, y and z of the scene frame, which a table (CSV)
/// alone can state.
VANTAGE_API FlightOut plan_of_tour(const MissionTour& tour, const Mission& mission);
/// The same as a format can state it: KML, GPX, GeoJSON and CZML have no heights above the home, and get those they
/// know; CZML gets the targets, and when they are seen (check_flight, which may throw). Throws Error(not_georeferenced)
/// where the format needs a place on the earth, and the scene has none.
VANTAGE_API FlightOut plan_of_tour(const MissionTour& tour, const Mission& mission, PlanFormat format);

/// Writes what proves the bound of a tour, for tools/check_tour.py, and the meshes that it is of beside it: FILE's stem
/// with .region0.ply and so on. All are written whole, or none. Throws Error(input) for a tour without a bound;
/// Error(output).
VANTAGE_API void write_tour_certificate(const MissionTour& tour, const std::filesystem::path& file);

/// JSON (UTF-8, indented, a newline at the end). Lengths in metres, the scene frame. Visits of targets that are
/// volumes, and such targets that are left out, have `"volume": true`.
VANTAGE_API std::string json_text(const MissionTour& tour);

// ---- Bounds of tours, judged from their certificates alone

/// What is to be visited, as a certificate says it.
struct TourCertificateRegion {
  enum class Kind : std::uint8_t {
    outer,  ///< an outer volume: it holds every position from which a target is seen
    given,  ///< the region itself: a mesh that somebody drew
    point,  ///< a place, such as the home
  };
  std::string name;
  Kind kind = Kind::outer;
  double dwell_m = 0;          ///< so long a stretch in it serves no other region
  std::filesystem::path file;  ///< of the mesh; of a point none
};

/// "outer", "given", "point".
VANTAGE_API const char* name_of(TourCertificateRegion::Kind kind);

struct TourCertificateCheck {
  bool is_accepted = false;
  std::string reason;  ///< why it is refused; empty where it is accepted
  double bound_m = 0;  ///< that the certificate states: no tour is shorter, where it is accepted
  /// What its proof proves, rounded down; nothing where the proof is none. At least bound_m where it is accepted.
  std::optional<double> proved_m = std::nullopt;
  /// Of the tours that the bound is of: their track over ground curves no tighter but at points; 0: it may.
  double turn_radius_m = 0;
  bool closed = true;     ///< of tours that end where they begin; in the same direction, but at a point
  std::string kind;       ///< of the proof: "insertion", "pairs" (docs/theory.md, "Tours")
  std::size_t nodes = 0;  ///< of its tree
  std::vector<TourCertificateRegion> regions;  ///< no tour that visits them all is shorter
  std::string scene_incomplete;  ///< as the certificate has it, MissionTour::scene_incomplete; no proof depends on it
};

/// Whether a certificate of plan_mission_tour proves its bound. Reads the certificate and the meshes that it names,
/// which lie beside it and must have the hashes that it states; nothing of what found the bound is used or believed.
/// All is decided in whole numbers: nothing is rounded. tools/check_tour.py is a second program for the same.
///
/// That the outer volumes hold all positions from which a target is seen is not judged: their files say so.
///
/// Throws Error(input) for a file that is not there or cannot be read as what it should be, a proof that takes more
/// memory than any honest one does, and Error(cancelled).
VANTAGE_API TourCertificateCheck verify_tour_certificate(const std::filesystem::path& file,
                                                         const Progress& progress = {});

/// JSON (UTF-8, indented, a newline at the end): "accepted", "reason", "bound_m", "proved_m" (null where nothing is
/// proved, or no tour is possible), "turn_radius_m", "closed", "proof", "nodes", "regions", "scene_incomplete" (null:
/// nothing). Lengths in metres.
VANTAGE_API std::string json_text(const TourCertificateCheck& check);

}  // namespace vantage
