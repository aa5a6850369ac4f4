// From a file's axes, unit and coordinate reference system into the scene frame.
#include <algorithm>
#include <cmath>
#include <string>

#include "geo/local_frame.h"
#include "io/mesh_file.h"
#include "io/object_text.h"
#include "vantage/error.h"

namespace vantage::internal::io {
namespace {

constexpr double kFootM = 0.3048;  // the foot of the US survey differs by 2 ppm

geo::LonLat lonlat(const std::array<double, 2>& latitude_longitude) {
  return {latitude_longitude[1], latitude_longitude[0]};
}

std::string as_in(const std::filesystem::path& file) { return "as in " + file.filename().string(); }

Box bounds_of(const RawMesh& mesh, const core::ProgressReporter& progress) {
  Box box;
  for (const Triangle& triangle : mesh.triangles) {
    progress.tick();
    for (const std::uint32_t vertex : triangle) box.extend(mesh.vertices[vertex]);
  }
  return box;
}

/// From axes with y up to those with z up.
Box turned_up(const Box& box) {
  return {Vec3(box.min.x(), -box.max.z(), box.min.y()), Vec3(box.max.x(), -box.min.z(), box.max.y())};
}

/// "EPSG:7415 (Amersfoort / RD New + NAP height)" without what is in brackets.
std::string short_name(const std::string& name) {
  const std::size_t bracket = name.find(" (");
  const bool is_code = bracket != std::string::npos && name.find(':') < bracket;
  return is_code ? name.substr(0, bracket) : name;
}

/// Moves the boxes and outlines of the ledger, and what is to stand in. One that lies where the move has no value is
/// dropped.
template <typename Move>
void move_ledger(RawMesh& mesh, const Move& move, const core::ProgressReporter& progress) {
  for (auto& [entry, holder, is_stated] : mesh.ledger) {
    if (!entry.box) continue;
    Box box;
    try {
      for (Vec3& vertex : holder.vertices) {
        progress.tick();
        vertex = move(vertex);
      }
      for (const Vec3& corner : box_mesh(*entry.box).vertices) {
        Vec3 finite = corner;
        if (!std::isfinite(corner.z())) finite.z() = 0;
        Vec3 moved = move(finite);
        if (!std::isfinite(corner.z())) moved.z() = corner.z();
        box.extend(moved);
      }
      const double z = std::isfinite(entry.box->min.z()) ? entry.box->min.z() : 0;
      for (auto& ring : entry.outlines) {
        for (auto& [x, y] : ring) {
          const Vec3 moved = move(Vec3(x, y, z));
          x = moved.x();
          y = moved.y();
        }
      }
      const bool is_place = box.min.head<2>().allFinite() && box.max.head<2>().allFinite();
      if (is_place) entry.box = box;
      if (!is_place) entry.box.reset();
    } catch (const Error& error) {
      if (error.code() == ErrorCode::cancelled) throw;
      entry.box.reset();
    }
    if (entry.box) continue;
    if (is_stated) entry.stand_in.reset();
    entry.outlines.clear();
    holder = {};
  }
}

/// x and y from the coordinate system `text` into the local frame.
void project(RawMesh& mesh, const SceneReadOptions& options, const std::filesystem::path& file,
             const core::ProgressReporter& progress) {
  const bool is_asked = !options.crs.empty();
  const std::string& text = is_asked ? options.crs : mesh.crs;
  const geo::CoordinateSystem system(text, is_asked ? "crs of " + file.string() : mesh.crs_place);
  if (is_asked && !mesh.crs.empty() && mesh.crs != text) {
    mesh.notes.push_back("the file says that its coordinate system is " + mesh.crs + "; taken is " + system.name());
  }
  const Box box = bounds_of(mesh, progress);
  const Vec3 middle = (box.min + box.max) / 2;
  const geo::LonLat centre = system.to_lonlat(middle.head<2>());
  const geo::LocalFrame frame(options.origin_deg ? lonlat(*options.origin_deg) : centre);
  geo::check_origin(frame.origin(), centre, file.string());

  if (const auto area = system.area_without(centre)) {
    mesh.notes.push_back("the mesh lies outside the area that " + short_name(system.name()) + " is made for (" + *area +
                         "): is it the right system?");
  }

  const double unit_m = system.vertical_unit_m().value_or(1) * options.scale;
  const auto local = [&](const Eigen::Vector2d& position) { return frame.to_local(system.to_lonlat(position)); };
  if (unit_m == 1 && !system.is_geographic()) {
    const double east_m = (local(middle.head<2>() + Eigen::Vector2d(1, 0)) - local(middle.head<2>())).norm();
    if (std::abs(east_m - kFootM) < 0.01 * kFootM) {
      mesh.notes.emplace_back("its x and y are in feet, z is taken as metres: give the scale 0.3048 if it is in feet");
    }
  }
  const auto moved = [&](const Vec3& point) {
    const Eigen::Vector2d at = local(point.head<2>());
    return Vec3(at.x(), at.y(), point.z() * unit_m);
  };
  for (Vec3& vertex : mesh.vertices) {
    progress.tick();
    vertex = moved(vertex);
  }
  move_ledger(mesh, moved, progress);
  mesh.georeference =
      Georeference{frame.origin().latitude_deg, frame.origin().longitude_deg,
                   system.vertical_name().empty() ? as_in(file) : system.vertical_name(), short_name(system.name())};
}

/// From the local frame that the file names into another.
void move_to(RawMesh& mesh, const std::array<double, 2>& origin_deg, const std::filesystem::path& file,
             const core::ProgressReporter& progress) {
  geo::check_origin(lonlat(origin_deg), {mesh.georeference->longitude_deg, mesh.georeference->latitude_deg},
                    file.string());
  Georeference moved = *mesh.georeference;
  moved.latitude_deg = origin_deg[0];
  moved.longitude_deg = origin_deg[1];
  geo::move_origin(mesh.vertices, *mesh.georeference, moved);
  const auto move = [&](const Vec3& point) {
    std::vector<Vec3> one = {point};
    geo::move_origin(one, *mesh.georeference, moved);
    return one[0];
  };
  move_ledger(mesh, move, progress);
  mesh.georeference = moved;
}

/// A mesh that does not say where it lies is in the local frame about the origin.
void put_at(RawMesh& mesh, geo::LonLat origin, const std::filesystem::path& file,
            const core::ProgressReporter& progress) {
  const geo::LocalFrame frame(origin);  // checks the origin
  const Box box = bounds_of(mesh, progress);
  const double farthest = std::max(box.min.head<2>().cwiseAbs().maxCoeff(), box.max.head<2>().cwiseAbs().maxCoeff());
  if (farthest > geo::kFarthestM) {
    throw Error(ErrorCode::crs_missing,
                "the mesh goes " + std::to_string(std::lround(farthest / 1000)) +
                    " km from its origin: its coordinates are not metres about the origin that is given",
                file.string(), "name their coordinate system with crs, as in EPSG:28992");
  }
  mesh.georeference = Georeference{frame.origin().latitude_deg, frame.origin().longitude_deg, "", ""};
}

void find_place(RawMesh& mesh, const SceneReadOptions& options, const std::filesystem::path& file,
                const core::ProgressReporter& progress) {
  const bool is_nowhere = options.crs == "none";
  if (is_nowhere) mesh.georeference.reset();
  if (!is_nowhere && (!mesh.crs.empty() || !options.crs.empty())) {
    if (mesh.georeference) {
      throw Error(ErrorCode::not_applicable, "a coordinate system is given for a mesh that is in a local frame already",
                  "crs of " + file.string(), "leave crs out: the file says where it lies");
    }
    project(mesh, options, file, progress);
    return;
  }
  for (Vec3& vertex : mesh.vertices) {
    progress.tick();
    vertex *= options.scale;
  }
  const auto scaled = [&](const Vec3& point) { return Vec3(point * options.scale); };
  move_ledger(mesh, scaled, progress);
  if (!options.origin_deg) return;
  if (mesh.georeference) {
    move_to(mesh, *options.origin_deg, file, progress);
  } else {
    put_at(mesh, lonlat(*options.origin_deg), file, progress);
  }
}

}  // namespace

void to_scene_frame(RawMesh& mesh, const SceneReadOptions& options, const std::filesystem::path& file,
                    const core::ProgressReporter& progress) {
  if (!(options.scale > 0) || !std::isfinite(options.scale)) {
    throw Error(ErrorCode::value_out_of_range, "the scale of a mesh must be positive and finite", file.string(),
                "give the length of the file's unit in metres");
  }
  const bool y_up = mesh.format == MeshFormat::gltf || (options.up == UpAxis::y && mesh.format != MeshFormat::cityjson);
  if (y_up) {
    for (Vec3& v : mesh.vertices) {
      progress.tick();
      v = Vec3(v.x(), -v.z(), v.y());
    }
    for (Missing& missing : mesh.ledger) {
      if (missing.entry.box) missing.entry.box = turned_up(*missing.entry.box);
      for (Vec3& v : missing.holder.vertices) v = Vec3(v.x(), -v.z(), v.y());
    }
  }
  find_place(mesh, options, file, progress);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    progress.tick();
    if (mesh.vertices[i].cwiseAbs().maxCoeff() <= core::kMaxCoordinate) continue;
    throw Error(ErrorCode::coordinate_too_large,
                "vertex " + std::to_string(i) + " (counted from 0) is more than " +
                    std::to_string(static_cast<long>(core::kMaxCoordinate / 1000)) + " km from the origin",
                file.string(), "check the scale, or correct the vertex");
  }
}

}  // namespace vantage::internal::io
