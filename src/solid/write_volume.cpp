// Checks a volume, chooses the writer by the file's extension, and holds what the writers share.
#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "solid/volume_check.h"
#include "solid/write_place.h"
#include "solid/writers.h"
#include "vantage/error.h"

namespace vantage {
namespace solid {

void check_count(std::uint64_t count, std::uint64_t limit, const char* what, const char* format) {
  if (count <= limit) return;
  throw Error(ErrorKind::output, std::to_string(count) + " " + what + " are too many for " + format,
              "at most " + std::to_string(limit), "write another format or compute with a larger tolerance");
}

void append_exact(std::string& text, double number) {
  std::array<char, 32> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
  text.append(digits.data(), end);
}

std::string exact_text(double number) {
  std::string text;
  append_exact(text, number);
  return text;
}

std::string one_line(std::string_view text) {
  std::string line(text);
  for (char& c : line) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
  return line;
}

std::string output_extension(const std::filesystem::path& file) {
  std::error_code ignored;
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const bool known = extension == ".ply" || extension == ".obj" || extension == ".stl" || extension == ".glb";
  if (known || std::filesystem::is_directory(file, ignored)) return extension;
  throw Error(ErrorKind::input,
              extension.empty() ? "the output file has no extension"
                                : "unknown output format \"" + file.extension().string() + "\"",
              file.string(), "name a file that ends in .ply, .obj, .stl or .glb");
}

std::unique_ptr<AtomicFile> stage_volume(const Volume& volume, const std::filesystem::path& file, UpAxis obj_up,
                                         double obj_scale) {
  const std::string extension = output_extension(file);
  check_volume(volume);
  auto output = std::make_unique<AtomicFile>(file);
  if (extension == ".ply") write_ply(volume, *output);
  if (extension == ".obj") write_obj(volume, obj_up, obj_scale, *output);
  if (extension == ".stl") write_stl(volume, *output);
  if (extension == ".glb") write_glb(volume, *output);
  return output;
}

}  // namespace solid

void write_volume(const Volume& volume, const std::filesystem::path& file, UpAxis obj_up, double obj_scale) {
  std::vector<std::unique_ptr<solid::AtomicFile>> files;
  files.push_back(solid::stage_volume(volume, file, obj_up, obj_scale));
  if (auto place = solid::stage_place(volume.georeference, file)) files.push_back(std::move(place));
  solid::commit_all(files);
}

}  // namespace vantage
