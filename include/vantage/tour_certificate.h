// Bounds of tours, judged from their certificates alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vantage/export.h"
#include "vantage/progress.h"

namespace vantage {

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
/// proved, or no tour is possible), "turn_radius_m", "closed", "proof", "nodes", "regions". Lengths in metres.
VANTAGE_API std::string json_text(const TourCertificateCheck& check);

}  // namespace vantage
