// The names and kinds of the error codes.
#include <algorithm>
#include <array>
#include <cstddef>

#include "vantage/error.h"

namespace vantage {
namespace {

struct Row {
  ErrorCode code;
  ErrorKind kind;
  const char* name;
};

constexpr std::array kRows = {
    Row{ErrorCode::file_not_found, ErrorKind::input, "file-not-found"},
    Row{ErrorCode::not_a_file, ErrorKind::input, "not-a-file"},
    Row{ErrorCode::file_unreadable, ErrorKind::input, "file-unreadable"},
    Row{ErrorCode::file_empty, ErrorKind::input, "file-empty"},
    Row{ErrorCode::file_too_large, ErrorKind::input, "file-too-large"},
    Row{ErrorCode::file_changed, ErrorKind::input, "file-changed"},
    Row{ErrorCode::compression_broken, ErrorKind::input, "compression-broken"},
    Row{ErrorCode::stdin_not_possible, ErrorKind::input, "stdin-not-possible"},
    Row{ErrorCode::out_of_memory, ErrorKind::input, "out-of-memory"},
    Row{ErrorCode::system_limit, ErrorKind::input, "system-limit"},
    Row{ErrorCode::record_garbled, ErrorKind::input, "record-garbled"},
    Row{ErrorCode::mesh_format_unknown, ErrorKind::input, "mesh-format-unknown"},
    Row{ErrorCode::mesh_syntax, ErrorKind::input, "mesh-syntax"},
    Row{ErrorCode::mesh_unsupported, ErrorKind::input, "mesh-unsupported"},
    Row{ErrorCode::mesh_empty, ErrorKind::input, "mesh-empty"},
    Row{ErrorCode::mesh_too_large, ErrorKind::input, "mesh-too-large"},
    Row{ErrorCode::level_of_detail_missing, ErrorKind::input, "level-of-detail-missing"},
    Row{ErrorCode::coordinate_not_finite, ErrorKind::input, "coordinate-not-finite"},
    Row{ErrorCode::coordinate_too_large, ErrorKind::input, "coordinate-too-large"},
    Row{ErrorCode::index_out_of_range, ErrorKind::input, "index-out-of-range"},
    Row{ErrorCode::array_sizes_differ, ErrorKind::input, "array-sizes-differ"},
    Row{ErrorCode::nothing_given, ErrorKind::input, "nothing-given"},
    Row{ErrorCode::mesh_not_closed, ErrorKind::input, "mesh-not-closed"},
    Row{ErrorCode::mesh_not_oriented, ErrorKind::input, "mesh-not-oriented"},
    Row{ErrorCode::mesh_inside_out, ErrorKind::input, "mesh-inside-out"},
    Row{ErrorCode::mesh_intersects_itself, ErrorKind::input, "mesh-intersects-itself"},
    Row{ErrorCode::mesh_without_inside, ErrorKind::input, "mesh-without-inside"},
    Row{ErrorCode::not_utf8_text, ErrorKind::input, "not-utf8-text"},
    Row{ErrorCode::yaml_syntax, ErrorKind::input, "yaml-syntax"},
    Row{ErrorCode::yaml_unsupported, ErrorKind::input, "yaml-unsupported"},
    Row{ErrorCode::unknown_key, ErrorKind::input, "unknown-key"},
    Row{ErrorCode::duplicate_key, ErrorKind::input, "duplicate-key"},
    Row{ErrorCode::missing_key, ErrorKind::input, "missing-key"},
    Row{ErrorCode::conflicting_keys, ErrorKind::input, "conflicting-keys"},
    Row{ErrorCode::not_applicable, ErrorKind::input, "not-applicable"},
    Row{ErrorCode::wrong_type, ErrorKind::input, "wrong-type"},
    Row{ErrorCode::not_a_number, ErrorKind::input, "not-a-number"},
    Row{ErrorCode::value_out_of_range, ErrorKind::input, "value-out-of-range"},
    Row{ErrorCode::value_syntax, ErrorKind::input, "value-syntax"},
    Row{ErrorCode::value_unsupported, ErrorKind::input, "value-unsupported"},
    Row{ErrorCode::unknown_choice, ErrorKind::input, "unknown-choice"},
    Row{ErrorCode::edges_mismatch, ErrorKind::input, "edges-mismatch"},
    Row{ErrorCode::target_vertex_count, ErrorKind::input, "target-vertex-count"},
    Row{ErrorCode::target_vertices_coincide, ErrorKind::input, "target-vertices-coincide"},
    Row{ErrorCode::target_not_planar, ErrorKind::input, "target-not-planar"},
    Row{ErrorCode::target_not_convex, ErrorKind::input, "target-not-convex"},
    Row{ErrorCode::target_without_area, ErrorKind::input, "target-without-area"},
    Row{ErrorCode::target_parts_invalid, ErrorKind::input, "target-parts-invalid"},
    Row{ErrorCode::target_of_parts, ErrorKind::input, "target-of-parts"},
    Row{ErrorCode::target_pierced, ErrorKind::input, "target-pierced"},
    Row{ErrorCode::target_inside_solid, ErrorKind::input, "target-inside-solid"},
    Row{ErrorCode::target_off_ground, ErrorKind::input, "target-off-ground"},
    Row{ErrorCode::direction_invalid, ErrorKind::input, "direction-invalid"},
    Row{ErrorCode::tolerance_too_fine, ErrorKind::input, "tolerance-too-fine"},
    Row{ErrorCode::viewpoint_on_surface, ErrorKind::input, "viewpoint-on-surface"},
    Row{ErrorCode::viewpoint_inside_solid, ErrorKind::input, "viewpoint-inside-solid"},
    Row{ErrorCode::limits_reversed, ErrorKind::input, "limits-reversed"},
    Row{ErrorCode::limits_empty, ErrorKind::input, "limits-empty"},
    Row{ErrorCode::heights_differ, ErrorKind::input, "heights-differ"},
    Row{ErrorCode::zone_not_simple, ErrorKind::input, "zone-not-simple"},
    Row{ErrorCode::zone_file_syntax, ErrorKind::input, "zone-file-syntax"},
    Row{ErrorCode::not_georeferenced, ErrorKind::input, "not-georeferenced"},
    Row{ErrorCode::not_on_earth, ErrorKind::input, "not-on-earth"},
    Row{ErrorCode::too_far_away, ErrorKind::input, "too-far-away"},
    Row{ErrorCode::crs_unknown, ErrorKind::input, "crs-unknown"},
    Row{ErrorCode::crs_unusable, ErrorKind::input, "crs-unusable"},
    Row{ErrorCode::crs_missing, ErrorKind::input, "crs-missing"},
    Row{ErrorCode::library_missing, ErrorKind::input, "library-missing"},
    Row{ErrorCode::map_format_unknown, ErrorKind::input, "map-format-unknown"},
    Row{ErrorCode::map_syntax, ErrorKind::input, "map-syntax"},
    Row{ErrorCode::map_empty, ErrorKind::input, "map-empty"},
    Row{ErrorCode::map_object_missing, ErrorKind::input, "map-object-missing"},
    Row{ErrorCode::ground_missing, ErrorKind::input, "ground-missing"},
    Row{ErrorCode::scene_incomplete, ErrorKind::input, "scene-incomplete"},
    Row{ErrorCode::object_missing, ErrorKind::input, "object-missing"},
    Row{ErrorCode::face_missing, ErrorKind::input, "face-missing"},
    Row{ErrorCode::region_invalid, ErrorKind::input, "region-invalid"},
    Row{ErrorCode::region_outside, ErrorKind::input, "region-outside"},
    Row{ErrorCode::region_empty, ErrorKind::input, "region-empty"},
    Row{ErrorCode::raster_unreadable, ErrorKind::input, "raster-unreadable"},
    Row{ErrorCode::raster_not_heights, ErrorKind::input, "raster-not-heights"},
    Row{ErrorCode::raster_grid_unsupported, ErrorKind::input, "raster-grid-unsupported"},
    Row{ErrorCode::raster_too_large, ErrorKind::input, "raster-too-large"},
    Row{ErrorCode::camera_invalid, ErrorKind::input, "camera-invalid"},
    Row{ErrorCode::camera_list_syntax, ErrorKind::input, "camera-list-syntax"},
    Row{ErrorCode::device_missing, ErrorKind::input, "device-missing"},
    Row{ErrorCode::device_failed, ErrorKind::input, "device-failed"},
    Row{ErrorCode::port_unavailable, ErrorKind::input, "port-unavailable"},
    Row{ErrorCode::page_missing, ErrorKind::input, "page-missing"},
    Row{ErrorCode::unknown_command, ErrorKind::input, "unknown-command"},
    Row{ErrorCode::unknown_option, ErrorKind::input, "unknown-option"},
    Row{ErrorCode::command_line_syntax, ErrorKind::input, "command-line-syntax"},
    Row{ErrorCode::table_syntax, ErrorKind::input, "table-syntax"},
    Row{ErrorCode::plan_syntax, ErrorKind::input, "plan-syntax"},
    Row{ErrorCode::plan_empty, ErrorKind::input, "plan-empty"},
    Row{ErrorCode::height_unknown, ErrorKind::input, "height-unknown"},
    Row{ErrorCode::output_name_missing, ErrorKind::input, "output-name-missing"},
    Row{ErrorCode::output_format_unknown, ErrorKind::input, "output-format-unknown"},
    Row{ErrorCode::output_not_a_file, ErrorKind::input, "output-not-a-file"},
    Row{ErrorCode::output_folder_missing, ErrorKind::input, "output-folder-missing"},
    Row{ErrorCode::output_named_twice, ErrorKind::input, "output-named-twice"},
    Row{ErrorCode::output_overwrites_input, ErrorKind::input, "output-overwrites-input"},
    Row{ErrorCode::output_of_others, ErrorKind::input, "output-of-others"},
    Row{ErrorCode::folder_in_use, ErrorKind::input, "folder-in-use"},
    Row{ErrorCode::output_unwritable, ErrorKind::output, "output-unwritable"},
    Row{ErrorCode::format_too_small, ErrorKind::output, "format-too-small"},
    Row{ErrorCode::work_too_large, ErrorKind::input, "work-too-large"},
    Row{ErrorCode::component_missing, ErrorKind::input, "component-missing"},
    Row{ErrorCode::cancelled, ErrorKind::cancelled, "cancelled"},
    Row{ErrorCode::internal_defect, ErrorKind::internal, "internal-defect"},
};

constexpr bool are_in_order() {
  for (std::size_t i = 0; i < kRows.size(); ++i) {
    if (static_cast<std::size_t>(kRows[i].code) != i) return false;
  }
  return kRows.back().code == ErrorCode::internal_defect;
}
static_assert(are_in_order(), "one row for each code, in the order of their declaration");

constexpr std::array<ErrorCode, kRows.size()> codes_of_rows() {
  std::array<ErrorCode, kRows.size()> codes{};
  for (std::size_t i = 0; i < kRows.size(); ++i) codes[i] = kRows[i].code;
  return codes;
}
constexpr std::array kCodes = codes_of_rows();

}  // namespace

std::span<const ErrorCode> error_codes() { return kCodes; }

const char* name_of(ErrorCode code) { return kRows.at(static_cast<std::size_t>(code)).name; }

ErrorKind kind_of(ErrorCode code) { return kRows.at(static_cast<std::size_t>(code)).kind; }

std::optional<ErrorCode> error_code(std::string_view name) {
  const auto row =
      std::find_if(kRows.begin(), kRows.end(), [&](const Row& candidate) { return candidate.name == name; });
  return row == kRows.end() ? std::nullopt : std::optional(row->code);
}

}  // namespace vantage
