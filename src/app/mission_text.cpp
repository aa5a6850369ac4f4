// A MissionFile as the text that read_mission_text reads.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <variant>

#include "app/described_section.h"
#include "app/links_section.h"
#include "app/sensor_section.h"
#include "app/value_reader.h"
#include "common/input.h"
#include "common/json.h"
#include "request/describe_mission.h"
#include "request/describe_spheres.h"
#include "request/describe_tour.h"
#include "vantage/city.h"
#include "vantage/mission.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

/// A YAML text in double quotes: what JSON writes is YAML.
std::string quoted(const std::string& text) { return json_text(std::string_view{text}); }

template <typename Numbers>
std::string list_of(const Numbers& numbers) {
  std::string text;
  for (const auto number : numbers) text += (text.empty() ? "" : ", ") + shortest(static_cast<double>(number));
  return "[" + text + "]";
}

template <typename Points>
std::string polygon(const Points& vertices) {
  std::string text;
  for (const auto& vertex : vertices) text += (text.empty() ? "" : ", ") + list_of(vertex);
  return "[" + text + "]";
}

const char* axis(UpAxis up) { return up == UpAxis::y ? "y" : "z"; }

/// Keys of one section, each on a line of its own.
class Section {
 public:
  explicit Section(const char* name) : name_(name) {}

  void add(const std::string& key, const std::string& value) { text_ += "  " + key + ": " + value + "\n"; }
  void add(const std::string& key, double value) { add(key, shortest(value)); }

  /// As an entry of a list.
  std::string item() const {
    std::string text;
    for (std::size_t at = 0; at < text_.size();) {
      const std::size_t end = text_.find('\n', at) + 1;
      text.append(at == 0 ? "  - " : "    ").append(text_, at + 2, end - at - 2);
      at = end;
    }
    return text;
  }

  /// Nothing when it has no keys.
  std::string text() const { return text_.empty() ? "" : name_ + ":\n" + text_; }

 private:
  std::string name_, text_;
};

class Writer {
 public:
  Writer(const MissionFile& mission, const fs::path& folder) : mission_(mission), folder_(fs::absolute(folder)) {}

  std::string text() const {
    std::string text = mission_.crs.empty() ? "" : "crs: " + quoted(mission_.crs) + "\n";
    text += scene() + targets() + internal::app::sensor_section_text(mission_) + navigation();
    text += std::string("method: ") + name_of(mission_.method) + "\n";
    text += internal::app::section_text(mission_.exact);
    if (mission_.exact.work_limit != kWorkLimit) text += "work_limit: " + shortest(mission_.exact.work_limit) + "\n";
    text += internal::app::section_text(mission_.spheres);
    if (mission_.tour) text += internal::app::section_text(*mission_.tour);
    text += internal::app::links_section_text(mission_.links);
    return text;
  }

 private:
  /// Relative to the folder where it lies in it.
  std::string path(const fs::path& file) const {
    if (is_web_address(file)) return quoted(file.string());
    const fs::path relative = file.lexically_relative(folder_);
    const bool is_below = !relative.empty() && *relative.begin() != "..";
    return quoted((is_below ? relative : file).string());
  }

  std::string scene() const {
    const SceneSource& source = mission_.scene;
    Section section("scene");
    switch (source.kind) {
      case SceneSource::Kind::mesh:
        section.add("mesh", path(source.file));
        if (source.mesh.up == UpAxis::y) section.add("up", "y");
        if (source.mesh.scale != 1) section.add("scale", source.mesh.scale);
        if (!source.mesh.lod.empty()) section.add("lod", quoted(source.mesh.lod));
        if (!source.mesh.crs.empty()) section.add("crs", quoted(source.mesh.crs));
        if (source.mesh.origin_deg) section.add("origin", list_of(*source.mesh.origin_deg));
        break;
      case SceneSource::Kind::map:
        section.add("osm", path(source.file));
        add_region(source.city.region, section);
        add_city(source.city, section);
        break;
      case SceneSource::Kind::raster:
        section.add("raster", path(source.file));
        add_region({source.raster.region.center_deg, source.raster.region.radius_m, source.raster.region.bbox_deg},
                   section);
        section.add("error", source.raster.max_error_m);
        if (!source.raster.crs.empty()) section.add("crs", quoted(source.raster.crs));
        add_heights(source.raster.heights, section);
        if (source.raster.origin_deg) section.add("origin", list_of(*source.raster.origin_deg));
        break;
      case SceneSource::Kind::tileset:
        section.add("tiles", path(source.file));
        if (source.tileset.center_deg) section.add("center", list_of(*source.tileset.center_deg));
        if (source.tileset.radius_m) section.add("radius", *source.tileset.radius_m);
        section.add("detail", source.tileset.detail_m);
        if (source.tileset.ground_m) section.add("ground", *source.tileset.ground_m);
        if (!source.tileset.crs.empty()) section.add("crs", quoted(source.tileset.crs));
        if (source.terrain.empty()) break;
        section.add("terrain", path(source.terrain));
        section.add("error", source.terrain_options.max_error_m);
        add_heights(source.terrain_options.heights, section);
        break;
    }
    if (missing_of(source) != MissingPolicy::block) section.add("missing", name_of(missing_of(source)));
    if (!mission_.scene.attribution.empty()) section.add("attribution", quoted(mission_.scene.attribution));
    if (mission_.sea_level_m) section.add("sea_level", *mission_.sea_level_m);
    return section.text();
  }

  static void add_region(const CityRegion& region, Section& section) {
    if (region.center_deg) {
      section.add("center", list_of(*region.center_deg));
      section.add("radius", region.radius_m);
    }
    if (region.bbox_deg) section.add("bbox", list_of(*region.bbox_deg));
  }

  static void add_heights(const HeightOptions& heights, Section& section) {
    if (heights.unit) section.add("z_unit", name_of(*heights.unit));
    if (heights.void_m) section.add("void", *heights.void_m);
  }

  void add_city(const CityOptions& city, Section& section) const {
    if (!city.terrain.empty()) section.add("terrain", path(city.terrain));
    section.add("error", city.terrain_error_m);
    if (!city.terrain_crs.empty()) section.add("crs", quoted(city.terrain_crs));
    add_heights(city.terrain_heights, section);
    if (city.partial) section.add("partial", "true");
    std::string without;
    for (const OccluderSwitch& one : occluder_switches()) {
      if (!(city.occluders.*one.on)) without += (without.empty() ? "" : ", ") + std::string(one.name);
    }
    if (!without.empty()) section.add("without", "[" + without + "]");
    const std::string defaults = changed_defaults(city);
    if (!defaults.empty()) section.add("defaults", "{" + defaults + "}");
    if (city.frame) {
      section.add("frame", "{origin: " + list_of(city.frame->origin_deg) + ", ground: " +
                               list_of(city.frame->ground_m) + ", reach: " + shortest(city.frame->reach_m) + "}");
    }
  }

  static std::string changed_defaults(const CityOptions& city) {
    std::string text;
    const auto add = [&](const std::string& name, double value) {
      text += (text.empty() ? "" : ", ") + quoted(name) + ": " + shortest(value);
    };
    CityOptions asked = city, plain;
    for (const CitySetting& setting : city_settings()) {
      if (setting.value(asked) != setting.value(plain)) add(setting.name, setting.value(asked));
    }
    const auto add_kinds = [&](const std::string& family, const auto& kinds, const auto& usual, const auto& value_of) {
      for (const auto& [kind, value] : kinds) {
        const auto found = usual.find(kind);
        if (found == usual.end() || value_of(found->second) != value_of(value)) add(family + kind, value_of(value));
      }
    };
    const auto itself = [](double value) { return value; };
    const auto height = [](const OccluderDefaults::Size& size) { return size.height_m; };
    add_kinds("levels.", asked.defaults.levels_of, plain.defaults.levels_of, itself);
    add_kinds("wall.", asked.occluder_defaults.walls, plain.occluder_defaults.walls, height);
    add_kinds("tower.", asked.occluder_defaults.towers, plain.occluder_defaults.towers, height);
    add_kinds("way.", asked.occluder_defaults.ways, plain.occluder_defaults.ways, itself);
    return text;
  }

  std::string targets() const {
    std::string text;
    if (mission_.targets.size() == 1 && !mission_.is_list) {
      Section section("target");
      add_target(mission_.targets.front(), section);
      text = section.text();
    } else {
      text = "targets:\n";
      for (const MissionTarget& target : mission_.targets) {
        Section section("");
        add_target(target, section);
        text += section.item();
      }
    }
    if (mission_.combine != Combine::all) text += std::string("combine: ") + name_of(mission_.combine) + "\n";
    return text;
  }

  void add_target(const MissionTarget& given, Section& section) const {
    const Target& target = given.target;
    if (!target.name.empty()) section.add("name", quoted(target.name));
    if (const auto* from = std::get_if<TargetFile>(&given.source)) {
      section.add(from->is_volume ? "volume" : "file", path(from->file));
      if (!from->feature.empty()) section.add("feature", quoted(from->feature));
    } else if (const auto* faces = std::get_if<FaceTarget>(&given.source)) {
      add_faces(*faces, section);
    } else if (const auto* ground = std::get_if<GroundTarget>(&given.source)) {
      if (ground->center_deg) {
        section.add("center", list_of(*ground->center_deg));
        section.add("width", ground->width_m);
        section.add("length", ground->length_m);
        section.add("heading", ground->heading_deg);
      } else if (!ground->outlines.empty()) {
        add_outlines(ground->outlines, section);
      } else {
        section.add("osm", quoted(ground->osm));
      }
    } else if (target.is_point()) {
      section.add("point", list_of(target.parts[0][0]));
    } else if (target.parts.size() == 1) {
      section.add("vertices", polygon(target.parts[0]));
    } else {
      std::string parts;
      for (const std::vector<Vec3>& part : target.parts) parts += (parts.empty() ? "" : ", ") + polygon(part);
      section.add("parts", "[" + parts + "]");
    }
    if (target.offset_m != 0) section.add("offset", target.offset_m);
    if (target.front) section.add("front", list_of(*target.front));
    if (given.both_sides) section.add("sides", "both");
  }

  static void add_outlines(const std::vector<TargetOutline>& outlines, Section& section) {
    std::string outers, holes;
    const auto add = [](std::string& text, const std::string& ring) { text += (text.empty() ? "" : ", ") + ring; };
    for (const TargetOutline& one : outlines) {
      std::size_t first = 0;
      const auto ring_text = [&](const Zone::Ring& ring) {
        if (one.z_m.empty()) return polygon(ring);
        std::vector<Vec3> corners;
        for (const Eigen::Vector2d& corner : ring) corners.emplace_back(corner.x(), corner.y(), one.z_m.at(first++));
        return polygon(corners);
      };
      add(outers, ring_text(one.outer));
      for (const Zone::Ring& hole : one.holes) add(holes, ring_text(hole));
    }
    section.add("outline", outlines.size() == 1 ? outers : "[" + outers + "]");
    if (!holes.empty()) section.add("holes", "[" + holes + "]");
  }

  static void add_faces(const FaceTarget& faces, Section& section) {
    if (!faces.object.empty()) section.add("object", quoted(faces.object));
    if (!faces.osm.empty()) section.add("osm", quoted(faces.osm));
    if (faces.at_deg) section.add("at", list_of(*faces.at_deg));
    section.add("part", name_of(faces.kind));
    if (faces.facing_deg) section.add("facing", *faces.facing_deg);
    if (faces.nearest) section.add("nearest", list_of(*faces.nearest));
  }

  /// No height can be beyond this, nor can a file say so.
  static double bound(double z) { return std::clamp(z, -internal::app::kMaxLength, internal::app::kMaxLength); }

  std::string zones(const std::vector<Zone>& zones, const std::vector<ZoneFile>& files) const {
    std::string text;
    for (const Zone& zone : zones) {
      if (zone.is_box) {
        const Box box = zone.box();
        text += (text.empty() ? "" : ", ") + ("{min: " + list_of(box.min) + ", max: " + list_of(box.max)) + "}";
        continue;
      }
      std::string holes;
      for (const Zone::Ring& hole : zone.holes) holes += (holes.empty() ? "" : ", ") + polygon(hole);
      text += (text.empty() ? "" : ", ") + ("{polygon: " + polygon(zone.outer));
      if (!holes.empty()) text += ", holes: [" + holes + "]";
      const bool has_z = std::isfinite(zone.min_z_m) || std::isfinite(zone.max_z_m);
      if (has_z) text += ", z: " + list_of(std::array{bound(zone.min_z_m), bound(zone.max_z_m)});
      if (zone.above_ground)
        text += ", agl: " + list_of(std::array{zone.above_ground->min_m, zone.above_ground->max_m});
      text += has_z || zone.above_ground ? "}" : ", heights: any}";
    }
    for (const ZoneFile& file : files) {
      text += (text.empty() ? "" : ", ") + ("{file: " + path(file.file));
      if (file.z_m) text += ", z: " + list_of(*file.z_m);
      if (file.agl_m) text += ", agl: " + list_of(*file.agl_m);
      if (file.any_height) text += ", heights: any";
      text += file.skip ? ", skip: true}" : "}";
    }
    return "[" + text + "]";
  }

  // All members are named: a limit that is added does not compile here before it is written.
  std::string navigation() const {
    const auto& [altitude, keep_in, keep_out, resolved_meshes, above_ground, clearance] = mission_.navigation;
    Section section("navigation");
    const std::string z = altitude ? list_of(std::array{altitude->min_m, altitude->max_m}) : "";
    if (above_ground) {
      const std::string agl = list_of(std::array{above_ground->min_m, above_ground->max_m});
      section.add("altitude", "{agl: " + agl + (altitude ? ", z: " + z : "") + "}");
    } else if (altitude) {
      section.add("altitude", z);
    }
    if (const auto& ground = mission_.ground) {
      section.add("ground", ground->plane_z_m ? shortest(*ground->plane_z_m) : quoted(ground->object));
    }
    if (clearance) section.add("clearance", shortest(clearance->distance_m));
    const std::string kept = zones(keep_in, mission_.keep_in_files);
    const std::string out = zones(keep_out, mission_.keep_out_files);
    if (kept != "[]") section.add("keep_in", kept);
    if (out != "[]") section.add("keep_out", out);
    std::string meshes;
    for (const NavigationMeshFile& mesh : mission_.navigation_meshes) {
      meshes += (meshes.empty() ? "" : ", ") + ("{mesh: " + path(mesh.file));
      if (mesh.up) meshes += std::string(", up: ") + axis(*mesh.up);
      if (mesh.scale) meshes += ", scale: " + shortest(*mesh.scale);
      meshes += "}";
    }
    if (!meshes.empty()) section.add("meshes", "[" + meshes + "]");
    return section.text();
  }

  const MissionFile& mission_;
  fs::path folder_;
};

}  // namespace

std::string mission_text(const MissionFile& mission, const fs::path& folder) { return Writer(mission, folder).text(); }

}  // namespace vantage
