// The ground that heights are measured from, and rasters of heights as scenes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vantage/export.h"
#include "vantage/geometry.h"
#include "vantage/georeference.h"
#include "vantage/progress.h"
#include "vantage/scene.h"

namespace vantage {

/// A plane, or triangles. Beyond the triangles, in plan, there is no ground.
struct Ground {
  double plane_z_m = 0;  ///< where `surface` is null: the ground lies at this z everywhere
  /// Scene frame, metres; shared, since it may be as large as the scene. Triangles may face up or down, and may lie
  /// over each other. Vertical ones do not count.
  std::shared_ptr<const Mesh> surface = {};
};

/// The ground of a scene: its objects of ObjectKind::ground, or else of ObjectKind::surface, which is the highest of
/// ground, roofs and trees. Flat ground of a map goes on beyond the map: it is a plane. Nothing where the scene has no
/// such object with triangles. Throws Error(input) for arrays that PreparedScene refuses. Cost: linear.
VANTAGE_API std::optional<Ground> ground_of(const Scene& scene);

/// The triangles of one object. Throws Error(input) for an index out of range, an object without triangles, and as
/// above.
VANTAGE_API Ground ground_of(const Scene& scene, std::uint32_t object);

/// How high the ground is, for many places.
class VANTAGE_API GroundLevels {
 public:
  /// Throws Error(input) as check_navigation does for a ground. Cost: O(n log n) in the triangles.
  explicit GroundLevels(const Ground& ground);
  ~GroundLevels();
  GroundLevels(GroundLevels&&) noexcept;
  GroundLevels& operator=(GroundLevels&&) noexcept;

  /// z of the lowest and the highest piece of ground at a place: they differ where pieces lie over each other.
  struct Range {
    double lowest_m, highest_m;
  };
  /// Nothing where there is no ground. A place within a few roundings of the border of the ground may be taken for
  /// either side.
  std::optional<Range> at(double x, double y) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

// ---- Rasters of heights as the ground of a scene: docs/terrain.md

enum class HeightUnit {
  metre,
  foot,           ///< 0.3048 m
  us_survey_foot  ///< 1200/3937 m
};

/// "m", "ft", "us-ft".
VANTAGE_API const char* name_of(HeightUnit unit);
/// The other way round. Throws Error(input) for another word, with `where`.
VANTAGE_API HeightUnit height_unit(const std::string& name, const std::string& where);

/// What is given of a raster's heights, where its file does not say it.
struct HeightOptions {
  /// What the heights are in, whatever the file says. Empty: as the file says, else metres. A file whose eastings are
  /// in feet and that does not say what its heights are in is refused.
  std::optional<HeightUnit> unit = std::nullopt;
  /// The height of posts that have none, metres. A void of at most 20 m is never filled lower than its rim with it.
  /// Empty: docs/terrain.md, "Voids".
  std::optional<double> void_m = std::nullopt;
};

struct TerrainOptions {
  double max_error_m = 0.5;  ///< of the triangles above the posts of the raster: see CityOptions
  double margin_m = 50;      ///< how far the ground goes on round the scene
  double reach_m = 0;        ///< it covers at least a square about the origin, so far to each side
  /// z of the mean sea level in the scene: in a tileset on the earth how high the geoid lies above the ellipsoid (its
  /// undulation). Empty: as Georeference::vertical says, where that names a level at the sea.
  std::optional<double> sea_level_z_m = std::nullopt;
  HeightOptions heights = {};
  MissingPolicy missing = MissingPolicy::block;  ///< how posts without a height are filled: docs/terrain.md
};

/// Adds a raster of heights (GeoTIFF, SRTM .hgt, ASCII grid; also in a .zip) to a scene that has a place on the earth,
/// as an object of ObjectKind::ground. Heights of the raster that are above the ellipsoid as those of the scene stay as
/// they are; all others are taken to be above the mean sea level, which Scene::notes then say. In a frame that touches
/// the ellipsoid (Georeference::source_crs EPSG:4978) the ground falls away from the origin as the ellipsoid does.
/// Notes also tell how the objects stand on it.
///
/// Throws Error(input): not_georeferenced; height_unknown, where it is not known at which z the raster's level lies;
/// for what makes a raster unusable, a raster that does not cover the scene, options out of range, and where GDAL is
/// not installed. Error(cancelled) when told to stop. The scene is then as it was. Cost: n log n in the posts.
VANTAGE_API void add_terrain(Scene& scene, const std::filesystem::path& raster, const TerrainOptions& options = {},
                             const Progress& progress = {});

// ---- Rasters of heights as scenes of their own: docs/terrain.md

/// Which part of a raster becomes a scene; at most one of the three, none: all of it.
struct RasterRegion {
  std::optional<std::array<double, 2>> center_deg;  ///< latitude, longitude (WGS 84): a square about it
  double radius_m = 0;                              ///< half the square's side; > 0 with `center_deg`
  std::optional<std::array<double, 4>> bbox_deg;    ///< west, south, east, north; west > east crosses the antimeridian
  std::optional<std::array<int, 4>> pixels;         ///< first column, first row (from 0), columns, rows
};

struct RasterOptions {
  RasterRegion region;
  /// No post of the file lies above the scene, and none farther below it than this, vertically. 0 keeps every post: two
  /// triangles for each square of four.
  double max_error_m = 0.25;
  std::optional<std::array<double, 2>> origin_deg;  ///< of the scene frame: latitude, longitude; else the middle
  std::string crs = {};                             ///< as SceneReadOptions::crs; empty: what the file says
  HeightOptions heights = {};
  MissingPolicy missing = MissingPolicy::block;  ///< how posts without a height are filled: docs/terrain.md
};

struct RasterReport {
  std::size_t columns = 0, rows = 0;  ///< posts in the region
  std::size_t voids = 0;              ///< of these, posts without a value: Scene::ledger
  double largest_error_m = 0;         ///< vertical, measured at every post
  double lowest_m = 0, highest_m = 0;
};

struct RasterScene {
  Scene scene;  ///< one object, of ObjectKind::surface; a second one where the surface in voids may lie lower
  RasterReport report;
};

/// Reads a raster of heights (GeoTIFF, SRTM .hgt, ASCII grid; also in a .zip) and makes its surface a scene, in metres
/// about `origin_deg`: z is the height in the file (see Georeference::vertical). The surface ends on the outermost
/// posts of the region, which covers what was asked for.
///
/// It has one height at every place. Under bridges, eaves and crowns of trees it is solid; walls are as steep as one
/// step of the raster; and what the true surface does between two posts is not known: the triangles take it for flat.
/// A sight line that passes within one post's distance of an edge may be judged either way. With an error above 0 the
/// surface hides that much more than the posts do, and never less.
///
/// Throws Error(input) naming the file for all that makes a raster unusable (docs/terrain.md: among others no
/// coordinate reference system, a region that it does not cover, no value in it), for options out of range, and where
/// GDAL is not installed; Error(cancelled) when told to stop. Cost: n log n in the posts.
VANTAGE_API RasterScene scene_from_raster(const std::filesystem::path& file, const RasterOptions& options = {},
                                          const Progress& progress = {});

}  // namespace vantage
