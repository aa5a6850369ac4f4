// A tileset from its files to a scene.
#include <algorithm>
#include <cmath>
#include <new>
#include <utility>

#include "common/input.h"
#include "common/shown_address.h"
#include "core/format.h"
#include "core/read_limits.h"
#include "core/text.h"
#include "tiles/http_source.h"
#include "tiles/place.h"
#include "tiles/walk.h"

namespace vantage {
namespace internal::tiles {
namespace {

constexpr std::uint32_t kNoObject = ~std::uint32_t{0};

void check_options(const TilesetOptions& options, const std::string& where) {
  const auto refuse = [&](ErrorCode code, const char* problem, const char* fix) {
    throw Error(code, problem, where, fix);
  };
  if (options.center_deg && !options.radius_m) {
    refuse(ErrorCode::missing_key, "a tileset has a center without a radius", "give the radius in metres, too");
  }
  if (options.radius_m && !options.center_deg) {
    refuse(ErrorCode::missing_key, "a tileset has a radius without a center", "give the center: latitude, longitude");
  }
  if (options.radius_m && !(*options.radius_m > 0 && *options.radius_m <= geo::kFarthestM)) {
    refuse(ErrorCode::value_out_of_range, "the radius of a tileset is not a length up to 100 km",
           "give the radius in metres");
  }
  if (!(options.detail_m >= 0) || !std::isfinite(options.detail_m)) {
    refuse(ErrorCode::value_out_of_range, "the detail of a tileset is not a length",
           "give the largest geometric error in metres, as in 1.0");
  }
  if (options.ground_m && !(std::abs(*options.ground_m) <= core::kMaxCoordinate)) {
    refuse(ErrorCode::value_out_of_range, "the ground of a tileset is not a height", "give its z in metres");
  }
}

std::shared_ptr<const TilesetDocument> root_document(TileSource& source, const core::ProgressReporter& progress,
                                                     const core::ReadLimits& limits, TilesetReport& report) {
  const std::string address = source.root();
  const std::string text = source.read(address, progress);
  report.bytes += text.size();
  if (!is_tileset_text(text)) {
    throw Error(ErrorCode::mesh_format_unknown, "the file is no tileset of 3D Tiles", source.shown(address),
                "give the tileset.json at the root of the tileset");
  }
  return std::make_shared<TilesetDocument>(address, source.shown(address), text, progress, limits);
}

/// The new numbers of what stands in. Of a coarser tile whose first object is left out it is the first that is not.
void number_stand_ins(Scene& scene, std::vector<std::uint32_t> new_index, const CoarserTiles& coarser) {
  for (const auto& [first, tile] : coarser) {
    for (std::size_t i = tile.first; i < tile.second && new_index[first] == kNoObject; ++i) {
      new_index[first] = new_index[scene.object_of[i]];
    }
  }
  for (LedgerEntry& entry : scene.ledger) {
    if (!entry.stand_in) continue;
    entry.stand_in = new_index[*entry.stand_in];
    if (entry.stand_in != kNoObject) continue;
    entry.stand_in.reset();
    entry.instead.clear();
  }
}

/// Leaves out the objects that lie wholly beyond the radius, as coarse tiles reach far beyond it, and what is missing
/// there. Returns how many objects.
std::size_t keep_within(Scene& scene, double radius_m, const CoarserTiles& coarser) {
  const auto is_box_near = [&](const Box& box) {
    const Eigen::Vector2d nearest = Eigen::Vector2d::Zero().cwiseMax(box.min.head<2>()).cwiseMin(box.max.head<2>());
    return nearest.norm() <= radius_m;
  };
  const auto is_near = [&](const Triangle& triangle) {
    Box box;
    for (const std::uint32_t corner : triangle) box.extend(scene.mesh.vertices[corner]);
    return is_box_near(box);  // of the box: no triangle within is missed
  };
  std::erase_if(scene.ledger, [&](const LedgerEntry& entry) { return entry.box && !is_box_near(*entry.box); });
  std::vector<std::uint32_t> new_index(scene.objects.size(), kNoObject);
  for (const LedgerEntry& entry : scene.ledger) {  // what is held may stick out of what holds it
    const bool is_own = entry.stand_in && scene.objects[*entry.stand_in].kind == ObjectKind::stand_in;
    if (is_own && entry.box) new_index[*entry.stand_in] = 0;
  }
  for (std::size_t i = 0; i < scene.mesh.triangles.size(); ++i) {
    std::uint32_t& kept = new_index[scene.object_of[i]];
    if (kept == kNoObject && is_near(scene.mesh.triangles[i])) kept = 0;
  }
  std::vector<SceneObject> objects;
  for (std::size_t i = 0; i < new_index.size(); ++i) {
    if (new_index[i] == kNoObject) continue;
    new_index[i] = static_cast<std::uint32_t>(objects.size());
    objects.push_back(std::move(scene.objects[i]));
  }
  number_stand_ins(scene, new_index, coarser);
  const std::size_t left_out = scene.objects.size() - objects.size();
  scene.objects = std::move(objects);
  std::vector<std::uint32_t> new_vertex(scene.mesh.vertices.size(), kNoObject);
  std::vector<Vec3> vertices;
  std::size_t count = 0;
  for (std::size_t i = 0; i < scene.mesh.triangles.size(); ++i) {
    const std::uint32_t object = new_index[scene.object_of[i]];
    if (object == kNoObject) continue;
    Triangle triangle = scene.mesh.triangles[i];
    for (std::uint32_t& corner : triangle) {
      if (new_vertex[corner] == kNoObject) {
        new_vertex[corner] = static_cast<std::uint32_t>(vertices.size());
        vertices.push_back(scene.mesh.vertices[corner]);
      }
      corner = new_vertex[corner];
    }
    scene.mesh.triangles[count] = triangle;
    scene.object_of[count++] = object;
  }
  scene.mesh.triangles.resize(count);
  scene.object_of.resize(count);
  scene.mesh.vertices = std::move(vertices);
  return left_out;
}

/// A square of two triangles, which faces up.
void add_ground(Scene& scene, double z, const std::optional<double>& radius_m) {
  Box box = bounding_box(scene.mesh);
  if (radius_m) {
    box.extend(Vec3(-*radius_m, -*radius_m, z));
    box.extend(Vec3(*radius_m, *radius_m, z));
  }
  const auto first = static_cast<std::uint32_t>(scene.mesh.vertices.size());
  const auto object = static_cast<std::uint32_t>(scene.objects.size());
  for (const auto& [x, y] : {std::pair{box.min.x(), box.min.y()},
                             {box.max.x(), box.min.y()},
                             {box.max.x(), box.max.y()},
                             {box.min.x(), box.max.y()}}) {
    scene.mesh.vertices.emplace_back(x, y, z);
  }
  scene.mesh.triangles.push_back({first, first + 1, first + 2});
  scene.mesh.triangles.push_back({first, first + 2, first + 3});
  scene.object_of.insert(scene.object_of.end(), 2, object);
  scene.objects.push_back({"ground", "", ObjectKind::ground});
  scene.notes.push_back(core::format("the ground is a plane at z = {:.6g} m, as asked for", z));
}

[[noreturn]] void fail_for_nothing(const TilesetReport& report, bool has_circle, const std::string& where) {
  if (report.objects_outside > 0) {
    throw Error(ErrorCode::region_empty,
                "nothing of the tileset lies in the circle: the nearest tiles have " +
                    std::to_string(report.objects_outside) + " objects, all outside",
                where, "give another center, or a larger radius");
  }
  if (report.holes > 0) {
    throw Error(ErrorCode::mesh_empty,
                "none of the " + std::to_string(report.holes) + " files of the tileset that are needed can be read",
                where, "correct the first: " + report.first_hole);
  }
  if (report.contents + report.without_surfaces > 0) {
    throw Error(ErrorCode::mesh_empty,
                "the tiles hold no triangles (" + std::to_string(report.without_surfaces) +
                    " files of points or lines were passed over)",
                where, "give a tileset of meshes");
  }
  if (!has_circle) {
    throw Error(ErrorCode::mesh_empty, "no tile of the tileset has a content", where, "give a tileset of meshes");
  }
  throw Error(ErrorCode::region_empty, "no tile of the tileset with a content reaches into the circle", where,
              "give another center, or a larger radius");
}

TilesetScene read(TileSource& source, const std::filesystem::path& file, const TilesetOptions& options,
                  const core::ProgressReporter& progress) {
  check_options(options, file.string());
  const core::ReadLimits limits = core::ReadLimits::of_tiles();
  TilesetScene result;
  const auto document = root_document(source, progress, limits, result.report);
  const Tile root = document->tile(document->root());
  const Volume bounds = moved(root.bounds, root.transform);
  const World world = world_of(bounds, options);
  const Reach reach = reach_of(world, bounds, options, file);

  Collector collected;
  Walk(source, collected, {reach, options.detail_m, world, options.missing}, result.report, progress, limits)
      .run(document);
  if (collected.triangles.empty()) fail_for_nothing(result.report, reach.is_limited(), file.string());
  const CoarserTiles coarser = std::move(collected.coarser);
  result.scene = placed_scene(world, std::move(collected), options, file, progress);
  if (options.radius_m) result.report.objects_outside = keep_within(result.scene, *options.radius_m, coarser);
  if (result.scene.mesh.triangles.empty()) fail_for_nothing(result.report, reach.is_limited(), file.string());
  if (world == World::earth) measure_frame(result.scene, result.report);
  if (options.ground_m) add_ground(result.scene, *options.ground_m, options.radius_m);
  result.report.triangles = result.scene.mesh.triangles.size();
  result.report.objects = result.scene.objects.size();
  for (std::string& note : notes_of(result.report)) result.scene.notes.push_back(std::move(note));
  return result;
}

}  // namespace
}  // namespace internal::tiles

std::vector<std::string> notes_of(const TilesetReport& report) {
  std::vector<std::string> notes;
  if (report.holes > 0) {
    notes.push_back(internal::core::format(
        "{} of the tileset's files cannot be read: the ledger says what holds their place. The first: {}", report.holes,
        report.first_hole));
  }
  if (report.coarser_kept > 0) {
    notes.push_back(internal::core::format(
        "{} coarser tiles are kept, as finer ones that replace them cannot be read: they hide what is behind "
        "them, too",
        report.coarser_kept));
  }
  if (report.unreadable_properties > 0) {
    notes.push_back(
        internal::core::format("{} names or ids of features cannot be read: taken as missing. The first: {}",
                               report.unreadable_properties, report.first_unreadable));
  }
  if (report.features_by_texture > 0) {
    notes.push_back(internal::core::count_text(report.features_by_texture, "primitive has features by texture",
                                               "primitives have features by texture") +
                    ", which are not told apart: no images are read");
  }
  if (report.without_surfaces > 0) {
    notes.push_back(internal::core::format(
        "{} of the tileset's files hold points or lines, no surfaces: see the ledger", report.without_surfaces));
  }
  notes.push_back(internal::core::format("the largest geometric error of a tile that was taken is {:.6g} m",
                                         report.largest_error_m));
  if (report.coarse > 0) {
    notes.push_back(
        internal::core::format("{} tiles are coarser than asked: the tileset has no finer ones", report.coarse));
  }
  if (report.objects_outside > 0) {
    notes.push_back(
        internal::core::format("{} objects lie wholly beyond the radius: left out", report.objects_outside));
  }
  if (report.rim_drop_m > 0) {
    notes.push_back(
        internal::core::format("heights are above the plane that touches the ellipsoid at the origin; at the rim the "
                               "ellipsoid drops {:.3f} m below it, and x and y differ by up to {:.3f} m from the map",
                               report.rim_drop_m, report.rim_shift_m));
  }
  return notes;
}

bool is_web_address(const std::filesystem::path& file) { return internal::tiles::is_http(file.string()); }

TilesetScene read_tileset(const std::filesystem::path& file, const TilesetOptions& options, const Progress& callback) {
  const internal::core::ProgressReporter progress(callback, shown_address(file).string());
  try {
    const std::string address = file.string();
    if (internal::tiles::is_http(address)) {
      internal::tiles::HttpSource source(address);
      return internal::tiles::read(source, internal::tiles::without_query(address), options, progress);
    }
    internal::tiles::FolderSource source(file);
    return internal::tiles::read(source, file, options, progress);
  } catch (const std::bad_alloc&) {
    throw Error(ErrorCode::out_of_memory, "there is not enough memory to read the tileset",
                shown_address(file).string(), "give a smaller radius, or a larger detail");
  }
}

}  // namespace vantage
