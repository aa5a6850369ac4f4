// What a stranger's program needs to check the proof of a volume: docs/proof.md has the format.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "vantage/export.h"
#include "vantage/geometry.h"

namespace vantage {

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
};

/// The files that a certificate lies beside, and their hashes (docs/hashes.md).
struct CertifiedFiles {
  std::string scene_file;  ///< PLY with double precision, in the scene frame; relative to the certificate's folder
  std::string scene_hash;
  std::string volume_file;  ///< PLY
  std::string volume_hash;
  std::string mission_hash;
};

/// JSON, UTF-8, a newline at the end.
VANTAGE_API std::string certificate_text(const Certificate& certificate, const CertifiedFiles& files);

}  // namespace vantage
