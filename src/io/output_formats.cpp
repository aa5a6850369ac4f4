#include "io/output_formats.h"

#include <algorithm>
#include <array>
#include <string>

#include "common/input.h"
#include "common/output.h"
#include "io/scene_writers.h"
#include "io/writers.h"
#include "vantage/error.h"

namespace vantage::internal::io {
namespace {

constexpr std::array<OutputFormat, 4> kFormats = {{
    {".ply", false, false, [](const Volume& volume, const ObjFrame&) { return stored_as_doubles(volume); },
     [](const Volume& volume, const StoredMesh& stored, const ObjFrame&, AtomicFile& file) {
       write_ply(volume, stored, file);
     },
     write_scene_ply},
    {".obj", false, false,
     [](const Volume& volume, const ObjFrame& obj) {
       return obj.scale == 1 ? stored_as_doubles(volume) : stored_in_units(volume, obj.scale);
     },
     [](const Volume& volume, const StoredMesh& stored, const ObjFrame& obj, AtomicFile& file) {
       write_obj(volume, stored, obj.up, obj.scale, file);
     },
     write_scene_obj},
    {".stl", true, true, [](const Volume& volume, const ObjFrame&) { return stored_as_floats(volume); },
     [](const Volume&, const StoredMesh& stored, const ObjFrame&, AtomicFile& file) { write_stl(stored, file); },
     write_scene_stl},
    {".glb", true, false, [](const Volume& volume, const ObjFrame&) { return stored_as_local_floats(volume); },
     [](const Volume& volume, const StoredMesh& stored, const ObjFrame&, AtomicFile& file) {
       write_glb(volume, stored, file);
     },
     write_scene_glb},
}};

/// ".ply, .obj, .stl or .glb".
std::string list_of_extensions() {
  std::string list;
  for (const OutputFormat& format : kFormats) {
    if (!list.empty()) list += &format == &kFormats.back() ? " or " : ", ";
    list += format.extension;
  }
  return list;
}

}  // namespace

std::span<const OutputFormat> output_formats() { return kFormats; }

const OutputFormat* find_output_format(const std::filesystem::path& file) {
  const auto found = std::ranges::find(kFormats, format_extension(file), &OutputFormat::extension);
  return found == kFormats.end() ? nullptr : &*found;
}

const OutputFormat& output_format(const std::filesystem::path& file) {
  if (const OutputFormat* found = find_output_format(file)) return *found;
  const std::string extension = file.extension().string();
  throw Error(ErrorCode::output_format_unknown,
              extension.empty() ? "the output has no extension, so that its format is unknown"
                                : "no format is known for the extension " + in_quotes(extension),
              file.string(), "write " + list_of_extensions());
}

}  // namespace vantage::internal::io
