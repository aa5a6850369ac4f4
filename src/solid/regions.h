// What volumes are cut to, as labelled solids.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "solid/csg.h"
#include "vantage/volume.h"

namespace vantage::internal::solid {

/// What a label stands for: a cause with the polygon of the scene, or a side of a box, in whose plane its facets must
/// lie.
struct FacetSource {
  std::uint32_t cause = 0;
  std::optional<Eigen::Index> axis = std::nullopt;
  double at = 0;  ///< scene frame
  std::uint32_t polygon = kNoPolygon;
};

/// What the facets of volumes are due to, each pair of cause and polygon once.
class FacetSourceList {
 public:
  /// Labels for the triangles of a volume. `cause`: its number for each of the volume's causes.
  std::vector<std::uint32_t> add(const Volume& volume, const std::vector<std::uint32_t>& cause);

  const std::vector<FacetSource>& sources() const { return sources_; }

 private:
  std::vector<FacetSource> sources_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> index_;
};

/// Gives the volume the mesh, and the causes and polygons that its labels stand for.
void set_mesh(LabelledMesh labelled, const std::vector<FacetSource>& sources, std::vector<Cause> causes,
              Volume& volume);

/// Why a limit leaves nothing.
struct Emptiness {
  std::string reason, hint;
};

/// What the limits before one leave of a volume: not empty.
struct Remainder {
  const Solid& solid;  ///< about `origin`
  const std::string& name;
  const Vec3& origin;

  std::string text() const;  ///< "the volume, which spans x -9 to 11, y -8 to 12, z 3 to 13 m"
};

/// Space to stay in or out of. All zones to stay in are one region, since the volume is cut to their union.
struct Region {
  std::string name;  ///< "the altitude band 20 to 120 m", "zone 0", "the mesh airspace.ply", "keep_out zone park"
  Solid solid;       ///< about Regions::origin; empty when it misses the volume's bounds
  /// What to say where it leaves nothing. None: it is one of those to stay out of, of which all are told together.
  std::function<Emptiness(const Region&, const Remainder&)> explain = {};
  /// What it has in common with others costs more than to cut the volume to one after the other.
  bool is_cut_alone = false;
};

struct Regions {
  Vec3 origin = Vec3::Zero();        ///< scene frame; the solids are relative to it
  std::vector<Cause> causes;         ///< those of the volume, then those of the limits
  std::vector<FacetSource> sources;  ///< by label; the first ones are the volume's
  std::vector<Region> kept;          ///< the volume is cut to each
  std::vector<Region> forbidden;     ///< each is taken away
};

/// But for the clearance. Leaves out every limit that a volume with these bounds keeps anyway. `meshes` are the
/// navigation's, checked and welded. Boxes and zones are clipped a little outside the bounds, where that changes
/// nothing, to keep coordinates small.
Regions make_regions(const std::vector<Cause>& volume_causes, const std::vector<FacetSource>& volume_sources,
                     const Box& bounds, const Navigation& navigation, const std::vector<Mesh>& meshes,
                     const core::ProgressReporter& progress = {});

/// Forbids what is nearer to obstacles than the clearance, where there is any of it near. `volume`: what is to be cut,
/// about Regions::origin; `from`: see make_clearance, scene frame.
void add_clearance_region(const Clearance& clearance, const Mesh& volume, const std::optional<Vec3>& from,
                          Regions& regions, const core::ProgressReporter& progress);

/// The mesh with its vertices relative to `origin`.
LabelledMesh moved_to_origin(const Mesh& mesh, std::vector<std::uint32_t> labels, const Vec3& origin);

}  // namespace vantage::internal::solid
