// Results on the disk: found out before a long computation whether they can be written, and written all or none.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/atomic_file.h"
#include "vantage/export.h"
#include "vantage/scene.h"
#include "vantage/volume.h"

namespace vantage {
namespace internal::io {
class TilesFolder;
}

/// Throws Error(output or input) unless a file can be made at `file`: its folder exists and takes new files, `file` is
/// no folder and no device, and an existing file is not write-protected.
VANTAGE_API void check_can_write(const std::filesystem::path& file);

/// For a file whose name was not given, but follows from that of an output ("volume.report.json" of "volume.ply"):
/// check_can_write, and Error(input) where a file of that name is there that vantage did not write. It is known by what
/// vantage writes first, to the letter and with a version: the first comment of PLY, OBJ and KML (of KMZ that of the
/// first file in it), the header of STL, the generator of GLB, the software of PNG; the columns of a table, the keys of
/// a report and of a place file, the format of a certificate. Cost: reads a JSON file of up to 64 MB, and the first 64
/// KiB of another one.
VANTAGE_API void check_derived_output(const std::filesystem::path& file);

/// What chooses the format: the extension in lower case, ".ply".
VANTAGE_API std::string format_extension(const std::filesystem::path& file);

/// What is told of a format that volumes and scenes are written in. Lists of formats, in help, messages, documents,
/// Python and the page, are made of it.
struct FormatFacts {
  std::string_view name;       ///< "PLY"
  std::string_view extension;  ///< ".ply": in lower case, with its dot
  std::string_view holds;      ///< for lists: "scene frame, causes"
  bool is_single;              ///< its coordinates have single precision, not double
  bool is_text;                ///< a terminal can show it
  bool in_scene_frame;         ///< metres, z up; else in axes of its own, or of the scene's file
  bool is_for_maps = false;    ///< longitudes, latitudes and heights above the sea, of volumes alone; not read back
};

/// All of them; src/io/output_formats.cpp has the table.
VANTAGE_API std::vector<FormatFacts> known_formats();

/// Those that are folders, which volumes alone are written in, and which are not read: 3D Tiles.
VANTAGE_API std::vector<FormatFacts> folder_formats();

/// Whether the name is of one of these: "volume.tiles", "volume.tiles/".
VANTAGE_API bool is_folder_format(const std::filesystem::path& file);

/// Without a slash at the end, of what is_folder_format(); as it is otherwise.
VANTAGE_API std::filesystem::path volume_output(const std::filesystem::path& file);

/// ".ply, .obj, .stl, .glb, .kml, .kmz or .tiles": all that volumes are written in.
VANTAGE_API std::string volume_extensions_text();

/// Of an output on the globe: what z of the scene is taken as there, where that is not what it is measured from. Empty
/// where there is nothing to tell.
VANTAGE_API std::string height_note(const std::optional<Georeference>& georeference,
                                    const std::filesystem::path& output);

/// What --format takes: the extensions without the dot. mesh_format_words: of those that hold scenes, too, and are read
/// back.
VANTAGE_API std::vector<std::string> format_words();
VANTAGE_API std::vector<std::string> mesh_format_words();

/// ".ply, .obj, .stl, .glb, .kml or .kmz"; of those that hold scenes, too; of these those that keep double precision;
/// "ply, obj, stl, glb, kml or kmz"; likewise of those that hold scenes; "PLY and STL", those in the scene frame.
VANTAGE_API std::string extensions_text();
VANTAGE_API std::string scene_extensions_text();
VANTAGE_API std::string double_extensions_text();
VANTAGE_API std::string format_words_text();
VANTAGE_API std::string mesh_format_words_text();
VANTAGE_API std::string scene_frame_names_text();

/// check_can_write, and the extension must be one that write_volume knows. Of a format with a file beside it
/// ("volume.stl.place.json") check_derived_output of that, too. Of a folder: there is none, or it is empty, or holds a
/// tileset that vantage wrote and nothing else.
VANTAGE_API void check_volume_output(const std::filesystem::path& file);

/// The same of a scene, which is not written as a folder: Error(output_format_unknown) for a format that holds volumes
/// alone.
VANTAGE_API void check_scene_output(const std::filesystem::path& file);

/// The same of a certificate, and of what lies beside it: it replaces nothing that vantage did not write.
VANTAGE_API void check_certificate_output(const std::filesystem::path& file);

/// To call before a long computation: whether the formats of these files can place volumes of a scene there on the
/// earth. `sea_level_z_m`, of KML: z of the mean sea level (sea_level_m of a mission); without it 0 where the scene's
/// heights are above a geoid. Throws Error(not_georeferenced) and Error(height_unknown), with what to give.
VANTAGE_API void check_volume_place(const std::vector<std::filesystem::path>& files,
                                    const std::optional<Georeference>& georeference,
                                    std::optional<double> sea_level_z_m);

/// Throws Error(input) if `output` is one of the `inputs`, or a folder that holds one: writing it would destroy what it
/// was made from.
VANTAGE_API void check_not_an_input(const std::filesystem::path& output,
                                    const std::vector<std::filesystem::path>& inputs);

/// A volume that is written but not in place yet: for commit_volumes.
struct StagedVolume {
  std::vector<std::unique_ptr<AtomicFile>>
      files;  ///< the volume's first; for STL the one beside it too; of a folder none
  std::shared_ptr<internal::io::TilesFolder> folder = nullptr;  ///< of a format that is one
  WrittenVolume report;
};

/// Does all that write_volume does but the last step. Throws as write_volume does. `sea_level_z_m`: of KML, as
/// check_volume_place has it.
VANTAGE_API StagedVolume stage_volume(const Volume& volume, const std::filesystem::path& file,
                                      UpAxis obj_up = UpAxis::z, double obj_scale = 1.0,
                                      std::optional<double> sea_level_z_m = std::nullopt);

/// Puts volumes, and `others`, in place: all or none, as commit_all does; folders first, of which one that cannot be
/// put there stops all behind it, and leaves those before it. All is on the disk before the first is put in place. Call
/// once, last. Throws as commit_all, and as check_volume_output for folders.
VANTAGE_API void commit_volumes(std::vector<StagedVolume> volumes,
                                std::vector<std::unique_ptr<AtomicFile>> others = {});

/// A scene that is written but not in place yet: give the files to commit_all.
struct StagedScene {
  std::vector<std::unique_ptr<AtomicFile>> files;  ///< the scene's first; for STL the one beside it too
  double rounding_m = 0;                           ///< what write_scene returns
};

/// Does all that write_scene does but the last step. Throws as write_scene does.
VANTAGE_API StagedScene stage_scene(const Scene& scene, const std::filesystem::path& file);

}  // namespace vantage
