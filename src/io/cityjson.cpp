// CityJSON 1.0, 1.1 and 2.0 (OGC Community Standard 20-072r5), and its text sequences: the surfaces of all city
// objects. Semantics, textures and materials are passed over, and so are points and lines. See docs/scene.md.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "common/input.h"
#include "core/format.h"
#include "geo/local_frame.h"
#include "io/cityjson_document.h"
#include "io/cityjson_surfaces.h"
#include "io/json_text.h"
#include "io/lod.h"
#include "io/mesh_builder.h"
#include "io/mesh_readers.h"
#include "io/object_text.h"

namespace vantage::internal::io {
namespace {

using cityjson::Finding;
using cityjson::Header;
using cityjson::Json;
using cityjson::Trail;
using cityjson::Vertices;

constexpr double kNoLod = -1;  // of a geometry that does not say; below all that do

/// What the arrays of a geometry's boundaries stand for, from the outside in; rings and vertices follow.
struct GeometryType {
  std::string_view name;
  std::vector<const char*> levels;
};
const std::array<GeometryType, 5> kSurfaceTypes = {{{"MultiSurface", {"surface"}},
                                                    {"CompositeSurface", {"surface"}},
                                                    {"Solid", {"shell", "surface"}},
                                                    {"MultiSolid", {"solid", "shell", "surface"}},
                                                    {"CompositeSolid", {"solid", "shell", "surface"}}}};

std::string lod_text(double lod) {
  if (lod == kNoLod) return "none";
  std::string text = core::format("{:f}", lod);  // "2.200000"
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

std::string type_of(const Json& object, const Trail& trail) {
  const auto type = object.find("type");
  if (type == object.end() || !type->is_string()) trail.fail("\"type\" is missing");
  return type->get<std::string>();
}

class CityJsonReader {
 public:
  CityJsonReader(const MeshSource& source, const core::ProgressReporter& progress, const core::ReadLimits& limits,
                 const std::string& lod, const std::string& crs)
      : source_(source),
        progress_(progress),
        limits_(limits),
        asked_crs_(crs),
        trail_(source),
        builder_(source, MeshFormat::cityjson, MeshBuilder::PlaceUnit::byte, limits),
        surfaces_(builder_, trail_, limits) {
    if (lod.empty()) return;
    asked_ = parse_lod(lod);
    if (!asked_) {
      throw Error(ErrorCode::value_syntax, "no level of detail: " + shown_word(lod), source.file().string(),
                  "give a number as in CityJSON, such as 1 or 2.2");
    }
  }

  RawMesh read() {
    const std::string_view bytes = source_.bytes();
    const bool is_sequence = bytes.find("\"CityJSONFeature\"") != std::string_view::npos;
    std::size_t first_end = is_sequence ? line_end(0) : bytes.size();
    const Json root = parse(bytes.substr(0, first_end), is_sequence ? 1 : 0);
    header_ = cityjson::read_header(root, trail_);
    read_objects(root);
    std::uint64_t line = 1;
    for (std::size_t at = first_end + 1; at < bytes.size(); at = line_end(at) + 1) {
      ++line;
      const std::string_view text = bytes.substr(at, line_end(at) - at);
      if (text.find_first_not_of(" \t\r") == std::string_view::npos) continue;
      const Json feature = parse(text, line);
      if (!feature.is_object() || type_of(feature, trail_) != "CityJSONFeature") {
        trail_.fail("the line is not of type CityJSONFeature");
      }
      read_objects(feature);
    }
    check_lod();
    return finish();
  }

 private:
  std::size_t line_end(std::size_t at) const {
    return std::min(source_.bytes().find('\n', at), source_.bytes().size());
  }

  /// `line`: of a sequence; 0 for the one document of a file.
  Json parse(std::string_view text, std::uint64_t line) {
    trail_.set_line(line);
    trail_.set_object("");
    try {
      return parse_json(text, progress_, limits_);
    } catch (const JsonProblem& problem) {
      std::string where = source_.file().string();
      if (problem.line > 0) {
        where.append(", line ").append(std::to_string(line > 0 ? line : problem.line));
        where.append(", column ").append(std::to_string(problem.column));
      }
      throw Error(ErrorCode::mesh_syntax, "not a valid CityJSON file: " + problem.text, where, Trail::kGarbled);
    }
  }

  void read_objects(const Json& root) {
    Vertices vertices = cityjson::read_vertices(root, header_, trail_);
    const Json& objects = cityjson::required(root, "CityObjects", Json::value_t::object, trail_);
    std::uint64_t done = 0;
    for (const auto& [id, object] : objects.items()) {
      progress_.tick(done++, objects.size());
      trail_.set_object(id.empty() ? "(no id)" : id);
      if (!object.is_object()) trail_.fail("it is not an object");
      read_object(id, object, vertices);
    }
    for (const Bodiless& one : bodiless_) {
      trail_.set_object(one.id);
      tell_bodiless(one, objects);
    }
    bodiless_.clear();
    bodies_.clear();
    trail_.set_object("");
    objects_ += objects.size();
  }

  /// An object that is not built as a body, until all that may be its parts are read.
  struct Bodiless {
    std::string id;
    const Json* object;
    std::string reason;               // empty where it has no geometry at all
    Box box = {};                     // of its points
    std::size_t first = 0, last = 0;  // the triangles of its footprint
    bool may_be_roof = true;          // what the file has may be its upper edge, so that the body is below
  };

  void read_object(const std::string& id, const Json& object, Vertices& vertices) {
    type_of(object, trail_);  // any type that has surfaces may hide something
    const auto geometry = object.find("geometry");
    const bool has_geometry = geometry != object.end() && !geometry->is_null();
    if (has_geometry && !geometry->is_array()) trail_.fail("\"geometry\" is not an array");
    if (!has_geometry || geometry->empty()) {
      bodiless_.push_back({id, &object, ""});
      return;
    }
    std::vector<std::pair<std::size_t, double>> candidates;  // which of them hold surfaces, and their levels
    std::vector<double> levels;
    for (std::size_t i = 0; i < geometry->size(); ++i) {
      const Trail::Step step(trail_, "geometry", i);
      const Json& item = (*geometry)[i];
      if (!item.is_object()) trail_.fail("it is not an object");
      if (!has_surfaces(item)) continue;
      levels.push_back(lod_of(item));
      candidates.emplace_back(i, levels.back());
    }
    if (levels.empty()) {
      bodiless_.push_back(
          {id, &object, "it has points or lines, and no surfaces", cityjson::box_of_points(*geometry, vertices)});
      return;
    }
    found_lods_.insert(levels.begin(), levels.end());
    const double wanted = choose_lod(levels, asked_);
    double chosen = wanted;

    const std::size_t before = builder_.triangle_count();
    builder_.identify_object(builder_.add_object(id), cityjson::identity_of(id, object));
    bool lacks_one = false;
    for (; !has_area(before) && !levels.empty(); std::erase(levels, chosen)) {
      chosen = choose_lod(levels, asked_);
      for (const auto& [i, lod] : candidates) {
        if (lod != chosen) continue;
        const Trail::Step step(trail_, "geometry", i);
        const std::size_t count = builder_.triangle_count();
        read_geometry((*geometry)[i], vertices);
        lacks_one |= !has_area(count);
      }
    }
    if (!has_area(before)) {
      empty_.add(id);
      bodiless_.push_back({id, &object, "its surfaces have no extent", cityjson::box_of_points(*geometry, vertices)});
      return;
    }
    Box box;
    for (std::size_t i = before; i < builder_.triangle_count(); ++i) {
      progress_.tick();
      for (const std::uint32_t corner : builder_.triangle(i)) box.extend(builder_.vertex(corner));
    }
    if (lacks_one) {
      own_faults_.push_back({id, "geometry of LoD " + lod_text(wanted), "its surfaces have no extent",
                             chosen == wanted ? "its other geometry" : "its geometry of LoD " + lod_text(chosen), box});
    }
    if (asked_ && !meets_lod(wanted, *asked_)) {
      other_lod_.add(id);
      own_faults_.push_back(
          {id, "geometry of LoD " + lod_text(*asked_), "it has none", "its geometry of LoD " + lod_text(chosen), box});
    }
    if (is_footprint(object, box, chosen)) {
      std::string reason = "the file has only its footprint";
      if (chosen == 0) reason += " (LoD 0)";
      bodiless_.push_back({id, &object, std::move(reason), box, before, builder_.triangle_count(), chosen != 0});
    } else if (box.min.z() < box.max.z()) {
      bodies_.insert(id);
    }
  }

  bool has_area(std::size_t first) const {
    for (std::size_t i = first; i < builder_.triangle_count(); ++i) {
      const Triangle& t = builder_.triangle(i);
      const Vec3 &a = builder_.vertex(t[0]), &b = builder_.vertex(t[1]), &c = builder_.vertex(t[2]);
      if ((b - a).cross(c - a).norm() > 0) return true;
    }
    return false;
  }

  /// Whether surfaces are no body: of LoD 0, or flat where the file states a height. Without a level also those that
  /// are low beside that.
  bool is_footprint(const Json& object, const Box& box, double lod) {
    if (lod >= 0 && lod < 1) return true;
    const auto stated_m = cityjson::height_of(object);
    const Box extent = cityjson::extent_of(object);
    const double height = box.max.z() - box.min.z();
    if (height == 0) return lod == kNoLod || stated_m || (!extent.empty() && extent.min.z() < extent.max.z());
    return lod == kNoLod && stated_m && 2 * height * std::abs(unit_m()) < *stated_m;
  }

  /// Whether all of what an object consists of is in the file, and some of it is no mere fitting, and has a body.
  bool parts_stand_for_it(const std::string& id, const Json& object, const Json& objects) const {
    const auto children = object.find("children");
    if (children == object.end() || !children->is_array()) return false;
    bool has_body = false;
    for (const Json& child : *children) {
      const auto part = child.is_string() ? objects.find(child.get_ref<const std::string&>()) : objects.end();
      if (part == objects.end() || child == Json(id) || !part->is_object()) return false;
      has_body |= is_part(cityjson::text_in(*part, "type"), cityjson::text_in(object, "type")) &&
                  bodies_.contains(child.get_ref<const std::string&>());
    }
    return has_body;
  }

  /// Installations and furniture are in or on a thing and not what it consists of. A group has members of all types.
  static bool is_part(std::string_view type, std::string_view whole) {
    return whole == "CityObjectGroup" || type.ends_with("Part") || type.ends_with("ConstructiveElement");
  }

  /// Metres in one unit of z, as to_scene_frame takes it: negative where z is a depth.
  double unit_m() {
    const std::string& crs = asked_crs_.empty() ? header_.crs : asked_crs_;
    if (crs.empty() || crs == "none") return limits_.unit_m;
    if (!vertical_unit_m_) {
      const geo::CoordinateSystem system(crs, asked_crs_.empty() ? crs_place() : "crs of " + source_.file().string());
      vertical_unit_m_ = system.vertical_unit_m().value_or(1);
    }
    return *vertical_unit_m_ * limits_.unit_m;
  }

  std::string crs_place() const { return source_.file().string() + ", metadata, referenceSystem"; }

  /// Tells of an object without a body, and of its extent by itself where that lies elsewhere, or reaches farther than
  /// its footprint.
  void tell_bodiless(Bodiless one, const Json& objects) {
    const Json& object = *one.object;
    const bool is_footprint = one.first < one.last;
    if ((is_footprint || one.reason.empty()) && parts_stand_for_it(one.id, object, objects)) return;
    if (is_footprint && !cityjson::height_of(object) && cityjson::is_flat(type_of(object, trail_))) return;
    if (one.reason.empty()) {
      empty_.add(one.id);
      one.reason = object.contains("children") ? "it has no surfaces, and its parts are not all there, or have none"
                                               : "it has neither surfaces nor parts";
    }
    const Box extent = cityjson::extent_of(object);
    const auto lies_in = [](const Box& a, const Box& b) {
      return (a.min.head<2>().array() >= b.min.head<2>().array()).all() &&
             (a.max.head<2>().array() <= b.max.head<2>().array()).all();
    };
    Box common{one.box.min.cwiseMax(extent.min), one.box.max.cwiseMin(extent.max)};
    common.min.z() = common.max.z() = 0;
    constexpr double kShare = 1e-3;  // of its width, by which an extent may differ from rounding
    const Vec3 slack = kShare * (extent.max - extent.min);
    const bool is_all =
        one.box.empty() || extent.empty() ||
        (!common.empty() && (!is_footprint || lies_in({extent.min + slack, extent.max - slack}, one.box)));
    tell_place(one, is_all || !common.empty() ? extent : Box{});
    if (!is_all) tell_place({one.id, one.object, one.reason}, extent);
  }

  /// What holds the place of an object is never smaller than what the file states: its extent, its height, and where
  /// its points are.
  void tell_place(const Bodiless& one, const Box& extent) {
    LedgerEntry entry;
    entry.object = cityjson::identity_of(one.id, *one.object);
    entry.what = type_of(*one.object, trail_);
    entry.reason = one.reason;
    entry.height_m = cityjson::height_of(*one.object);
    const double unit = unit_m(), up = entry.height_m.value_or(0) / unit;
    const double down = one.may_be_roof && extent.empty() ? -up : 0;
    const auto column = [&](const Box& place) {
      Box box = place;
      for (const double by : {up, down}) {
        box.extend(place.min + Vec3(0, 0, by));
        box.extend(place.max + Vec3(0, 0, by));
      }
      box.min.z() = std::min(box.min.z(), extent.min.z());
      box.max.z() = std::max(box.max.z(), extent.max.z());
      return box;
    };
    const bool is_footprint = one.first < one.last;
    Box box = one.box.empty() ? one.box : column(one.box);
    if (!is_footprint && !extent.empty()) {
      Box ground = extent;
      (unit > 0 ? ground.max : ground.min).z() = (unit > 0 ? ground.min : ground.max).z();
      box.extend(column(ground));
    }
    constexpr double kLeastM = 0.1;  // above that a footprint's extent says more than the footprint
    const double bare = is_footprint ? one.box.max.z() - one.box.min.z() + kLeastM / std::abs(unit) : 0;
    const bool is_high = entry.height_m || (!extent.empty() && box.max.z() - box.min.z() > bare);
    if (!box.empty()) entry.box = box;
    if (!is_high || !(box.min.x() < box.max.x() && box.min.y() < box.max.y())) {
      if (is_footprint) entry.reason += ", and no measuredHeight";
      if (!is_high && entry.box && !cityjson::is_flat(entry.what)) {
        (unit > 0 ? entry.box->max : entry.box->min).z() = std::copysign(std::numeric_limits<double>::infinity(), unit);
      }
      ledger_.push_back({std::move(entry), {}});
      return;
    }
    if (!extent.empty()) {
      entry.height_m = std::max(entry.height_m.value_or(0), (extent.max.z() - extent.min.z()) * std::abs(unit));
    }
    if (is_footprint) {
      entry.instead = core::format("its footprint, {:.4g} m high", *entry.height_m);
      ledger_.push_back({std::move(entry), prisms(one, column)});
      return;
    }
    entry.may_be_larger = extent.empty();
    ledger_.push_back(held_by_box(std::move(entry), box));
    ledger_.back().entry.instead = extent.empty() ? "the box of its points" : "the box of its extent";
  }

  /// What is above and below the triangles of a footprint.
  template <class Column>
  Mesh prisms(const Bodiless& one, const Column& column) const {
    Mesh mesh;
    for (std::size_t i = one.first; i < one.last; ++i) {
      progress_.tick();
      const auto at = static_cast<std::uint32_t>(mesh.vertices.size());
      for (const bool is_top : {false, true}) {
        for (const std::uint32_t corner : builder_.triangle(i)) {
          const Box box = column(Box{builder_.vertex(corner), builder_.vertex(corner)});
          mesh.vertices.push_back(is_top ? box.max : box.min);
        }
      }
      mesh.triangles.push_back({at, at + 2, at + 1});
      mesh.triangles.push_back({at + 3, at + 4, at + 5});
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t a = at + k, b = at + (k + 1) % 3;
        mesh.triangles.push_back({a, b, b + 3});
        mesh.triangles.push_back({a, b + 3, a + 3});
      }
    }
    return mesh;
  }

  /// What is wrong with objects that are built.
  void tell_faults(RawMesh& mesh) {
    std::map<std::string_view, std::uint32_t> number;
    for (std::uint32_t i = 0; i < mesh.objects.size(); ++i) number.try_emplace(mesh.objects[i].source_id, i);
    const auto tell = [&](const cityjson::SurfaceBuilder::Fault& fault) {
      LedgerEntry entry;
      const auto known = number.find(clean_name(fault.object));
      entry.object = known == number.end() ? SceneObject{"", fault.object} : mesh.objects[known->second];
      entry.what = fault.what;
      entry.reason = fault.reason;
      entry.box = fault.box;
      entry.instead = fault.instead;
      const bool is_held = !fault.holder.triangles.empty();
      entry.may_be_larger = is_held;
      if (!is_held && known != number.end()) entry.stand_in = known->second;
      mesh.ledger.push_back({std::move(entry), fault.holder});
    };
    for (const auto& fault : surfaces_.faults()) tell(fault);
    for (const auto& fault : own_faults_) tell(fault);
    for (Missing& missing : ledger_) mesh.ledger.push_back(std::move(missing));
  }

  static const GeometryType* find_type(std::string_view name) {
    const auto* found = std::find_if(kSurfaceTypes.begin(), kSurfaceTypes.end(),
                                     [&](const GeometryType& type) { return type.name == name; });
    return found == kSurfaceTypes.end() ? nullptr : found;
  }

  /// Whether a geometry, or the template that it is an instance of, holds surfaces; counts those that do not.
  bool has_surfaces(const Json& geometry) {
    const std::string type = type_of(geometry, trail_);
    if (type == "GeometryInstance") return has_surfaces(template_of(geometry));
    if (type == "MultiPoint" || type == "MultiLineString") {
      no_surfaces_.add(trail_.object());
      return false;
    }
    if (!find_type(type)) trail_.fail("its geometry type " + shown_word(type) + " is unknown");
    return true;
  }

  const Json& template_of(const Json& instance) const {
    const auto number = instance.find("template");
    if (number == instance.end()) trail_.fail("\"template\" is missing");
    const Json& geometry =
        header_.templates[cityjson::index_below(*number, header_.templates.size(), "template", trail_)];
    if (!geometry.is_object()) trail_.fail("its template is not an object");
    if (type_of(geometry, trail_) == "GeometryInstance") trail_.fail("its template is an instance itself");
    return geometry;
  }

  double lod_of(const Json& item) const {
    const Json& geometry = type_of(item, trail_) == "GeometryInstance" ? template_of(item) : item;
    const auto lod = geometry.find("lod");
    if (lod == geometry.end()) return kNoLod;
    const auto value = lod->is_string()   ? parse_lod(lod->get<std::string>())  // a number in version 1.0
                       : lod->is_number() ? parse_lod(lod->dump())
                                          : std::nullopt;
    if (!value) trail_.fail("its \"lod\" " + shown_word(lod->dump()) + " is not a level of detail");
    return *value;
  }

  void read_geometry(const Json& geometry, Vertices& vertices) {
    if (type_of(geometry, trail_) != "GeometryInstance") {
      read_surfaces(geometry, vertices, Eigen::Affine3d::Identity());
      return;
    }
    const Json& anchor = cityjson::required(geometry, "boundaries", Json::value_t::array, trail_);
    if (anchor.size() != 1) trail_.fail("the \"boundaries\" of an instance hold no single vertex");
    const std::size_t place = cityjson::index_below(anchor[0], vertices.size(), "vertex", trail_);
    const Json& matrix = cityjson::required(geometry, "transformationMatrix", Json::value_t::array, trail_);
    const std::vector<double> rows = cityjson::numbers(matrix, 16, "\"transformationMatrix\"", trail_);
    if (rows[12] != 0 || rows[13] != 0 || rows[14] != 0 || rows[15] != 1) {
      trail_.fail("the last row of \"transformationMatrix\" is not 0, 0, 0, 1");
    }
    Eigen::Affine3d placement;
    placement.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(rows.data());
    placement.pretranslate(vertices.position(place));
    header_.template_vertices.begin_instance();
    const std::size_t before = builder_.triangle_count();
    builder_.make_room(header_.template_vertices.size(), largest_instance_, progress_);
    read_surfaces(template_of(geometry), header_.template_vertices, placement);
    largest_instance_ = std::max(largest_instance_, builder_.triangle_count() - before);
    const std::size_t room = limits_.repeated_triangles + source_.bytes().size() / 3;
    if (builder_.triangle_count() > room) {
      trail_.fail_as(ErrorCode::mesh_too_large,
                     "its instances repeat templates to more than " + std::to_string(room) + " triangles",
                     "cut the file to the part that is needed");
    }
  }

  void read_surfaces(const Json& geometry, Vertices& vertices, const Eigen::Affine3d& placement) {
    vertices_ = &vertices;
    placement_ = placement;
    mirrored_ = placement.linear().determinant() < 0;
    const GeometryType& type = *find_type(type_of(geometry, trail_));
    read_level(cityjson::required(geometry, "boundaries", Json::value_t::array, trail_), type, 0);
  }

  void read_level(const Json& boundaries, const GeometryType& type, std::size_t level) {
    if (level == type.levels.size()) {
      read_surface(boundaries);
      return;
    }
    const std::string_view what = type.levels[level];
    for (std::size_t i = 0; i < boundaries.size(); ++i) {
      const Trail::Step step(trail_, type.levels[level], i);
      if (!boundaries[i].is_array()) trail_.fail("its boundaries are nested less deep than its type has levels");
      if (what == "shell") surfaces_.begin_shell(i > 0);
      read_level(boundaries[i], type, level + 1);
      if (what == "shell") surfaces_.end_shell();
    }
  }

  void read_surface(const Json& rings) {
    if (rings.empty()) trail_.fail("a surface has no rings");
    rings_.resize(rings.size());
    for (std::size_t i = 0; i < rings.size(); ++i) {
      const Trail::Step step(trail_, "ring", i);
      if (!rings[i].is_array()) trail_.fail("its boundaries are nested less deep than its type has levels");
      rings_[i].clear();
      for (const Json& index : rings[i]) {
        progress_.tick();
        const std::size_t vertex = cityjson::index_below(index, vertices_->size(), "vertex", trail_);
        rings_[i].push_back(vertices_->use(vertex, placement_, builder_));
      }
      if (rings_[i].size() < 3)
        trail_.fail("a ring has " + std::to_string(rings_[i].size()) + " vertices, not 3 or more");
      if (mirrored_) std::reverse(rings_[i].begin(), rings_[i].end());
    }
    surfaces_.add(rings_);
  }

  /// An object without the level gives another, but when none has it that is most likely a mistake.
  void check_lod() const {
    if (!asked_ || found_lods_.empty()) return;
    const bool any =
        std::any_of(found_lods_.begin(), found_lods_.end(), [&](double lod) { return meets_lod(lod, *asked_); });
    if (any) return;
    std::string levels;
    for (const double lod : found_lods_) levels.append(levels.empty() ? "" : ", ").append(lod_text(lod));
    throw Error(ErrorCode::level_of_detail_missing, "no CityObject has a geometry of LoD " + lod_text(*asked_),
                source_.file().string(), "ask for one that the file has: " + levels);
  }

  RawMesh finish() {
    if (builder_.triangle_count() == 0) {
      source_.fail(ErrorCode::mesh_empty,
                   "the CityJSON file holds no surfaces (" + std::to_string(objects_) + " CityObjects)",
                   "give a file whose CityObjects have surfaces or solids");
    }
    RawMesh mesh = builder_.finish();
    mesh.crs = header_.crs;
    mesh.crs_place = crs_place();
    if (asked_) {
      const std::string missing = " no geometry of LoD " + lod_text(*asked_) + ": the nearest is taken";
      other_lod_.note(mesh.notes, "CityObject has", "CityObjects have", missing);
    }
    empty_.note(mesh.notes, "CityObject has neither surfaces nor parts", "CityObjects have neither surfaces nor parts");
    no_surfaces_.note(mesh.notes, "geometry of points or lines is passed over",
                      "geometries of points or lines are passed over");
    surfaces_.add_notes(mesh.notes);
    tell_faults(mesh);
    return mesh;
  }

  const MeshSource& source_;
  const core::ProgressReporter& progress_;
  const core::ReadLimits& limits_;
  const std::string& asked_crs_;
  Trail trail_;
  MeshBuilder builder_;
  cityjson::SurfaceBuilder surfaces_;
  std::optional<double> asked_;

  Header header_;
  std::optional<double> vertical_unit_m_;  // of the coordinate system, when it is needed
  std::set<double> found_lods_;
  std::size_t objects_ = 0, largest_instance_ = 0;  // triangles of an instance of a template
  Finding other_lod_, empty_, no_surfaces_;
  std::vector<cityjson::SurfaceBuilder::Fault> own_faults_;
  std::vector<Bodiless> bodiless_;  // of the document or feature that is read, as are the next
  std::set<std::string> bodies_;    // ids of what is built as a body
  std::vector<Missing> ledger_;

  // For the geometry that is being read.
  Vertices* vertices_ = nullptr;
  Eigen::Affine3d placement_ = Eigen::Affine3d::Identity();
  bool mirrored_ = false;
  std::vector<std::vector<std::uint32_t>> rings_;
};

}  // namespace

bool is_cityjson(std::string_view bytes) {
  constexpr std::string_view kValue = "\"CityJSON", kKey = "\"type\"";
  for (std::size_t at = bytes.find(kValue); at != std::string_view::npos; at = bytes.find(kValue, at + 1)) {
    const std::string_view after = bytes.substr(at + kValue.size());
    if (!after.starts_with("\"") && !after.starts_with("Feature\"")) continue;
    const auto trim = [](std::string_view text) {
      const std::size_t last = text.find_last_not_of(" \t\r\n");
      return text.substr(0, last == std::string_view::npos ? 0 : last + 1);
    };
    std::string_view before = trim(bytes.substr(0, at));
    if (!before.ends_with(":")) continue;
    before.remove_suffix(1);
    if (trim(before).ends_with(kKey)) return true;
  }
  return false;
}

RawMesh read_cityjson(const MeshSource& source, const core::ProgressReporter& progress, const core::ReadLimits& limits,
                      const std::string& lod, const std::string& crs) {
  progress.begin("parse CityJSON");
  return CityJsonReader(source, progress, limits, lod, crs).read();
}

}  // namespace vantage::internal::io
