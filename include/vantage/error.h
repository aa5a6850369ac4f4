// The one exception type of vantage, and what to know before relying on a result.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "vantage/export.h"

namespace vantage {

/// What kind of failure an Error tells of; the program's exit code follows from it.
enum class ErrorKind {
  input,      ///< a file, a mission or an argument is wrong: the caller must mend it (exit code 2)
  output,     ///< a result could not be written; nothing was left half-written (exit code 2)
  cancelled,  ///< the caller's progress callback asked to stop
  internal,   ///< a defect of vantage itself: an invariant did not hold
};

/// What is wrong, for programs: a code says what the person must mend, not which function noticed it. Codes and their
/// names stay as they are from version to version, the words of messages may change. docs/errors.md says for each what
/// to do.
enum class ErrorCode {
  // files that are read
  file_not_found,      ///< a file or folder that is named does not exist
  not_a_file,          ///< a folder, a device or a pipe stands where a file is needed
  file_unreadable,     ///< a file cannot be opened, or not be read to its end
  file_empty,          ///< a file has no content
  file_too_large,      ///< a file is larger than what is read of its kind
  file_changed,        ///< a file shrank while it was read
  compression_broken,  ///< the gzip or bzip2 data of a file is cut off or corrupt
  stdin_not_possible,  ///< a file cannot come from standard input here
  out_of_memory,       ///< there is not enough memory for what is asked
  system_limit,        ///< the system gives no more threads or open files
  record_garbled,      ///< what vantage itself wrote into a file was changed

  // meshes in files
  mesh_format_unknown,      ///< a mesh file is of no format that is read
  mesh_syntax,              ///< a mesh file breaks the rules of its format
  mesh_unsupported,         ///< a mesh file is valid, but uses what cannot be read here
  mesh_empty,               ///< a mesh has no triangles
  mesh_too_large,           ///< a mesh has more vertices, triangles or corners than can be handled
  level_of_detail_missing,  ///< no object of a CityJSON file has the level of detail that is asked for

  // coordinates and arrays
  coordinate_not_finite,  ///< a coordinate is infinite or not a number
  coordinate_too_large,   ///< a coordinate is too far from the origin
  index_out_of_range,     ///< a triangle, object, cause or label index is out of range
  array_sizes_differ,     ///< arrays that belong together have different lengths
  nothing_given,          ///< an empty list is passed where something is needed

  // solids
  mesh_not_closed,         ///< an edge of a mesh has an odd number of triangles
  mesh_not_oriented,       ///< neighbouring triangles of a mesh turn different ways
  mesh_inside_out,         ///< the triangles of a mesh, or of a part of it, face inward
  mesh_intersects_itself,  ///< triangles of a mesh pass through others, or parts of it overlap
  mesh_without_inside,     ///< a closed mesh encloses no space

  // mission files and other YAML
  not_utf8_text,     ///< a YAML file is not UTF-8 text
  yaml_syntax,       ///< a file is not valid YAML
  yaml_unsupported,  ///< a file uses YAML that is not understood here, as aliases and tags
  unknown_key,       ///< there is no such key
  duplicate_key,     ///< a key is given twice
  missing_key,       ///< a key is missing that must be there
  conflicting_keys,  ///< keys or options are given that exclude each other
  not_applicable,    ///< a key or an option is for another kind of input

  // values of keys, options and fields
  wrong_type,          ///< a value is of the wrong type, as a list where a number belongs
  not_a_number,        ///< a text stands where a number belongs
  value_out_of_range,  ///< a number is too large, too small or not finite
  value_syntax,        ///< a value is not written in the form that is needed
  value_unsupported,   ///< the value is that of another program or method and cannot be followed here
  unknown_choice,      ///< a word is none of those to choose from
  edges_mismatch,      ///< the edges of a target do not fit its vertices

  // targets
  target_vertex_count,       ///< a target has too few or too many vertices
  target_vertices_coincide,  ///< two vertices of a target are the same point
  target_not_planar,         ///< the vertices of a target are not in one plane
  target_not_convex,         ///< a target is not convex, or its vertices are not in order
  target_without_area,       ///< the vertices of a target lie on one line
  target_parts_invalid,      ///< a target lacks the part that is asked for, or mixes a point with other parts
  target_of_parts,           ///< a target has several parts, and the function takes one
  target_pierced,            ///< scene geometry stands on a target or passes through it
  target_inside_solid,       ///< a target lies inside a solid of the scene
  target_off_ground,         ///< a target reaches beyond the ground of the scene
  direction_invalid,         ///< a direction is zero, or parallel to what it must not be parallel to
  tolerance_too_fine,        ///< a tolerance would take too many facets at this range

  // viewpoints
  viewpoint_on_surface,    ///< a viewpoint lies on a surface of the scene
  viewpoint_inside_solid,  ///< a viewpoint lies inside a solid of the scene

  // limits
  limits_reversed,   ///< a lower limit is above the upper one
  limits_empty,      ///< limits leave no room between them
  heights_differ,    ///< the heights of two files are measured from different levels
  zone_not_simple,   ///< the outline of a zone crosses or touches itself, or a hole of it lies elsewhere
  zone_file_syntax,  ///< a file is no file of zones that can be read

  // places on the earth
  not_georeferenced,  ///< a scene or raster does not say where on the earth it lies
  not_on_earth,       ///< a latitude or longitude is not a place on the earth
  too_far_away,       ///< a place is too far from the scene
  crs_unknown,        ///< there is no such coordinate reference system
  crs_unusable,       ///< a coordinate reference system cannot be converted to longitudes and latitudes
  crs_missing,        ///< coordinates are given without their coordinate reference system
  library_missing,    ///< a library that is loaded when it is needed is not installed

  // maps
  map_format_unknown,  ///< a file is no OpenStreetMap file
  map_syntax,          ///< an OpenStreetMap file is cut off or garbled
  map_empty,           ///< a map holds nothing that can be built
  map_object_missing,  ///< a map has no such area
  ground_missing,      ///< a scene has no ground to put a target on, or to be above
  scene_incomplete,    ///< the source says that more stands there than can be built, and that is to be refused
  object_missing,      ///< a scene has no object of that name, or none at that place
  face_missing,        ///< an object has no roof or no wall of the sort that is asked for
  region_invalid,      ///< a region is not valid: reversed, without extent or too large
  region_outside,      ///< a region lies outside the map or raster
  region_empty,        ///< nothing in a region can be used

  // rasters
  raster_unreadable,        ///< a file is not a raster that can be read, or is damaged
  raster_not_heights,       ///< a raster holds something other than heights in metres
  raster_grid_unsupported,  ///< the rows of a raster do not run east, or its pixels have no size
  raster_too_large,         ///< a region has more posts of a raster than can be handled

  // cameras
  camera_invalid,      ///< numbers of a camera are missing, impossible or contradict each other
  camera_list_syntax,  ///< a file is no list of cameras that can be read

  // devices and pictures
  device_missing,  ///< there is no such device, or none that can do what is asked
  device_failed,   ///< a device that was insisted on cannot go on

  // the page
  port_unavailable,  ///< a port of this machine cannot be listened on
  page_missing,      ///< the page is not installed, or it is of another version

  // the command line
  unknown_command,      ///< there is no such command
  unknown_option,       ///< a command has no such option
  command_line_syntax,  ///< an argument is missing, or one too many
  table_syntax,         ///< a row of a table of points cannot be read

  // plans of flights
  plan_syntax,     ///< a file is no plan of a flight that can be read
  plan_empty,      ///< a plan holds no positions
  height_unknown,  ///< it is not known what a height is measured from, or where that level lies in the scene

  // output
  output_name_missing,      ///< an output has no file name
  output_format_unknown,    ///< the name of an output does not end in a known format
  output_not_a_file,        ///< an output is a folder, a device, a pipe or a terminal
  output_folder_missing,    ///< the folder of an output does not exist
  output_named_twice,       ///< two results would be written to one file
  output_overwrites_input,  ///< an output would overwrite an input of the same run
  output_of_others,         ///< an output whose name was not given would replace a file that vantage did not write
  folder_in_use,            ///< a folder that would be replaced holds other things
  output_unwritable,        ///< a result cannot be written: no permission, no room, or a fault of the disk
  format_too_small,         ///< the format of an output cannot hold the result

  // the run itself
  work_too_large,     ///< a computation would take more work than its limit allows
  component_missing,  ///< the program lacks a library of vantage that is needed
  cancelled,          ///< the caller asked to stop
  internal_defect,    ///< a defect of vantage: an invariant did not hold
};

/// All codes, in the order of their declaration.
VANTAGE_API std::span<const ErrorCode> error_codes();

/// "target-not-convex".
VANTAGE_API const char* name_of(ErrorCode code);

/// The code of that name, if there is one.
VANTAGE_API std::optional<ErrorCode> error_code(std::string_view name);

/// Each code is of one kind.
VANTAGE_API ErrorKind kind_of(ErrorCode code);

/// Thrown by every public function that fails. Three short lines for the person who must fix it: what is wrong, where
/// (file, line, object), and what to do. `what()` returns the three joined by newlines; `where` and `fix` may be empty.
/// Each is made printable(): they hold names from files.
class VANTAGE_API Error : public std::runtime_error {
 public:
  Error(ErrorCode code, std::string problem, std::string where, std::string fix,
        std::optional<std::uint32_t> object = std::nullopt);

  ErrorCode code() const { return code_; }
  ErrorKind kind() const { return kind_of(code_); }
  const std::string& problem() const { return problem_; }
  const std::string& where() const { return where_; }
  const std::string& fix() const { return fix_; }
  /// Index of the object of the scene that is in the way: of ErrorCode::target_pierced, target_inside_solid,
  /// viewpoint_on_surface and viewpoint_inside_solid.
  std::optional<std::uint32_t> object() const { return object_; }

  /// The same error with other words for the place or for what to do, for callers who know more of it.
  Error with_where(std::string where) const { return {code_, problem_, std::move(where), fix_, object_}; }
  Error with_fix(std::string fix) const { return {code_, problem_, where_, std::move(fix), object_}; }

 private:
  ErrorCode code_;
  std::string problem_, where_, fix_;
  std::optional<std::uint32_t> object_;
};

/// The three lines as the program prints them: "PROBLEM", "  where: PLACE" and "  what to do: ADVICE", each ended by a
/// newline; lines that would be empty are left out.
VANTAGE_API std::string message_of(const Error& error);

/// What a program should exit with: 2 for bad input and for output that could not be written, 3 for a defect of
/// vantage, 130 when the caller asked to stop, as after Ctrl-C.
VANTAGE_API int exit_code(ErrorKind kind);

// ---- Warnings: what to know before relying on a result, though nothing is wrong by itself

/// What a warning tells, for programs. Codes and their names stay as they are from version to version, the words may
/// change: docs/errors.md.
enum class WarningCode {
  range_beyond_data,   ///< the range reaches beyond the map, the raster or the ground: what hides there is missing
  range_beyond_scene,  ///< nothing of the scene is within range of the target
  scene_on_its_side,   ///< the scene seems to lie on its side
  target_in_degrees,   ///< the target is so small that its vertices seem to be longitudes and latitudes
  target_underground,  ///< the target seems to lie under the ground
  target_inside,       ///< the target lies inside a closed object of the scene
  target_from_below,   ///< the target is looked at from below, where nothing of the scene is
  target_covered,      ///< the scene covers the target within a hand's breadth: most likely its wrong side is looked at
  volume_below_scene,  ///< the whole volume lies below the scene
  pixel_in_metres,     ///< the size of a pixel on the target is so large that centimetres seem to be meant
  ground_extended,     ///< the ground was made larger to hold the target
  zones_left_out,      ///< a file of zones holds what was not taken as a zone
  clearance_from_all,  ///< the scene does not say what of it is ground: the clearance is kept from all of it
  above_surface,       ///< heights above the ground are measured from a raster's surface, with roofs and trees
  faces_together,      ///< the target is several faces of an object, all of which must be seen from one position
  plan_left_out,       ///< a plan of a flight holds what is not flown here
  plan_joined,         ///< several tracks of a plan are flown one after the other
  plan_assumed,        ///< a plan leaves something open, and it says what was taken
  plan_beyond_zones,   ///< a flight goes where zones of the earth may be off: far from a scene of 3D Tiles
  volume_small,        ///< the volume is smaller than a cubic metre, far less than the range allows
  scene_incomplete,    ///< what the source says stands within reach is not built as it stands: Scene::ledger
  // of a volume's file
  volume_changed,           ///< the mesh is not the one that the file was written with
  volume_of_other_scene,    ///< the volume was computed in another scene
  volume_of_other_mission,  ///< the volume was computed for another mission
  volume_moved,             ///< the volume lies about another origin on the earth and was moved
  heights_differ,           ///< heights are measured from another level than the scene's
  rounding_overstated,      ///< the file states a larger rounding than its numbers can have
};

/// All codes, in the order of their declaration.
VANTAGE_API std::span<const WarningCode> warning_codes();

/// "range-beyond-data".
VANTAGE_API const char* name_of(WarningCode code);

struct Warning {
  WarningCode code;
  std::string text;  ///< a sentence for people, without a full stop

  bool operator==(const Warning&) const = default;
};

}  // namespace vantage
