#include "io/output_formats.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "common/input.h"
#include "common/output.h"
#include "io/scene_writers.h"
#include "io/writers.h"
#include "io/written_marks.h"
#include "vantage/error.h"

namespace vantage::internal::io {
namespace {

constexpr OutputFormat kPly = {{.name = "PLY",
                                .extension = ".ply",
                                .holds = "scene frame, causes; of scenes no names",
                                .is_single = false,
                                .is_text = false,
                                .in_scene_frame = true},
                               /*has_sidecar=*/false,
                               /*is_local=*/false,
                               is_own_ply,
                               /*check_frame=*/nullptr,
                               [](const Volume& volume, const FileFrame&) { return stored_as_doubles(volume); },
                               [](const Volume& volume, const StoredMesh& stored, const FileFrame&, AtomicFile& file) {
                                 write_ply(volume, stored, file);
                               },
                               write_scene_ply};

constexpr OutputFormat kObj = {
    {.name = "OBJ",
     .extension = ".obj",
     .holds = "volumes in the axes and the unit of the scene file, a group per cause; objects of scenes",
     .is_single = false,
     .is_text = true,
     .in_scene_frame = false},
    /*has_sidecar=*/false,
    /*is_local=*/false,
    is_own_obj,
    [](const Volume& volume, const FileFrame& frame) { check_obj_scale(volume, frame.scale); },
    [](const Volume& volume, const FileFrame& frame) {
      return frame.scale == 1 ? stored_as_doubles(volume) : stored_in_units(volume, frame.scale);
    },
    [](const Volume& volume, const StoredMesh& stored, const FileFrame& frame, AtomicFile& file) {
      write_obj(volume, stored, frame.up, frame.scale, file);
    },
    write_scene_obj};

constexpr OutputFormat kStl = {
    {.name = "STL",
     .extension = ".stl",
     .holds = "scene frame; no causes, no names",
     .is_single = true,
     .is_text = false,
     .in_scene_frame = true},
    /*has_sidecar=*/true,
    /*is_local=*/false,
    is_own_stl,
    /*check_frame=*/nullptr,
    [](const Volume& volume, const FileFrame&) { return stored_as_floats(volume); },
    [](const Volume&, const StoredMesh& stored, const FileFrame&, AtomicFile& file) { write_stl(stored, file); },
    write_scene_stl};

constexpr OutputFormat kGlb = {{.name = "GLB",
                                .extension = ".glb",
                                .holds = "y up, a material per kind of cause; objects of scenes",
                                .is_single = true,
                                .is_text = false,
                                .in_scene_frame = false},
                               /*has_sidecar=*/false,
                               /*is_local=*/true,
                               is_own_glb,
                               /*check_frame=*/nullptr,
                               [](const Volume& volume, const FileFrame&) { return stored_as_local_floats(volume); },
                               [](const Volume& volume, const StoredMesh& stored, const FileFrame&, AtomicFile& file) {
                                 write_glb(volume, stored, file);
                               },
                               write_scene_glb};

constexpr OutputFormat kKml = {
    {.name = "KML",
     .extension = ".kml",
     .holds = "volumes on the earth, metres above sea level, a folder per kind of cause; the target",
     .is_single = false,
     .is_text = true,
     .in_scene_frame = false,
     .is_for_maps = true},
    /*has_sidecar=*/false,
    /*is_local=*/false,
    is_own_kml,
    /*check_frame=*/nullptr,
    [](const Volume& volume, const FileFrame&) { return stored_for_kml(volume); },
    [](const Volume& volume, const StoredMesh& stored, const FileFrame& frame, AtomicFile& file) {
      write_kml(volume, stored, frame.sea_level_z_m, file);
    },
    /*write_scene=*/nullptr};

constexpr OutputFormat zipped_kml() {
  OutputFormat format = kKml;
  format.name = "KMZ";
  format.extension = ".kmz";
  format.holds = "KML, compressed";
  format.is_text = false;
  format.is_own = is_own_kmz;
  format.write_volume = [](const Volume& volume, const StoredMesh& stored, const FileFrame& frame, AtomicFile& file) {
    write_kmz(volume, stored, frame.sea_level_z_m, file);
  };
  return format;
}

constexpr std::array kFormats = {kPly, kObj, kStl, kGlb, kKml, zipped_kml()};

// src/io/write_tiles.cpp.
constexpr std::array kFolderFormats = {FormatFacts{.name = "3D Tiles",
                                                   .extension = ".tiles",
                                                   .holds = "volumes alone: a folder for the globe, with a feature per "
                                                            "cause; needs a georeference",
                                                   .is_single = true,
                                                   .is_text = false,
                                                   .in_scene_frame = false}};

using Texts = std::vector<std::string>;

/// Of the formats that `is_listed`.
template <typename IsListed>
Texts texts_of(std::string_view FormatFacts::*text, const IsListed& is_listed) {
  Texts texts;
  for (const OutputFormat& format : kFormats) {
    if (is_listed(format)) texts.emplace_back(format.*text);
  }
  return texts;
}

constexpr auto kAll = [](const FormatFacts&) { return true; };
constexpr auto kMeshes = [](const FormatFacts& format) { return !format.is_for_maps; };

/// "a, b or c".
std::string joined(const Texts& texts, const char* last) {
  std::string list;
  for (const std::string& text : texts) {
    if (!list.empty()) list += &text == &texts.back() ? last : ", ";
    list += text;
  }
  return list;
}

}  // namespace

std::span<const OutputFormat> output_formats() { return kFormats; }

const OutputFormat* find_output_format(const std::filesystem::path& file) {
  const auto found = std::ranges::find(kFormats, format_extension(file), &OutputFormat::extension);
  return found == kFormats.end() ? nullptr : &*found;
}

namespace {

const OutputFormat& known_format(const std::filesystem::path& file, const std::string& choice) {
  if (const OutputFormat* found = find_output_format(file)) return *found;
  const std::string extension = file.extension().string();
  throw Error(ErrorCode::output_format_unknown,
              extension.empty() ? "the output has no extension, so that its format is unknown"
                                : "no format is known for the extension " + in_quotes(extension),
              file.string(), "write " + choice);
}

}  // namespace

const OutputFormat& output_format(const std::filesystem::path& file) {
  return known_format(file, volume_extensions_text());
}

const OutputFormat& scene_format(const std::filesystem::path& file) {
  const OutputFormat& format = known_format(file, scene_extensions_text());
  if (format.write_scene) return format;
  throw Error(ErrorCode::output_format_unknown, std::string(format.name) + " holds volumes, and no scenes",
              file.string(), "write " + scene_extensions_text());
}

}  // namespace vantage::internal::io

namespace vantage {

using namespace internal::io;

std::vector<FormatFacts> known_formats() { return {kFormats.begin(), kFormats.end()}; }

std::vector<FormatFacts> folder_formats() { return {kFolderFormats.begin(), kFolderFormats.end()}; }

bool is_folder_format(const std::filesystem::path& file) {
  const std::string extension = format_extension(file.has_filename() ? file : file.parent_path());
  return std::ranges::any_of(kFolderFormats, [&](const FormatFacts& format) { return format.extension == extension; });
}

std::filesystem::path volume_output(const std::filesystem::path& file) {
  return is_folder_format(file) && !file.has_filename() ? file.parent_path() : file;
}

std::string volume_extensions_text() {
  Texts extensions = texts_of(&FormatFacts::extension, kAll);
  for (const FormatFacts& format : kFolderFormats) extensions.emplace_back(format.extension);
  return joined(extensions, " or ");
}

namespace {

std::vector<std::string> without_dot(std::vector<std::string> extensions) {
  for (std::string& extension : extensions) extension.erase(0, 1);
  return extensions;
}

}  // namespace

std::vector<std::string> format_words() { return without_dot(texts_of(&FormatFacts::extension, kAll)); }

std::vector<std::string> mesh_format_words() { return without_dot(texts_of(&FormatFacts::extension, kMeshes)); }

std::string extensions_text() { return joined(texts_of(&FormatFacts::extension, kAll), " or "); }

std::string scene_extensions_text() { return joined(texts_of(&FormatFacts::extension, kMeshes), " or "); }

std::string double_extensions_text() {
  const auto is_double = [](const FormatFacts& format) { return kMeshes(format) && !format.is_single; };
  return joined(texts_of(&FormatFacts::extension, is_double), " or ");
}

std::string format_words_text() { return joined(format_words(), " or "); }

std::string mesh_format_words_text() { return joined(mesh_format_words(), " or "); }

std::string scene_frame_names_text() {
  return joined(texts_of(&FormatFacts::name, [](const FormatFacts& format) { return format.in_scene_frame; }), " and ");
}

}  // namespace vantage
