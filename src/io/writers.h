// One writer per file format, and what they share. The volumes that they get are checked, and rounded to the numbers of
// the format: write_volume.cpp.
#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "common/atomic_file.h"
#include "io/stored_mesh.h"
#include "vantage/volume.h"

namespace vantage::internal::io {

void write_ply(const Volume& volume, const StoredMesh& stored, AtomicFile& file);
/// Throws Error(input) for a `scale` (metres in one unit of the file) that cannot be written in.
void check_obj_scale(const Volume& volume, double scale);
void write_obj(const Volume& volume, const StoredMesh& stored, UpAxis up, double scale, AtomicFile& file);
void write_stl(const StoredMesh& stored, AtomicFile& file);
void write_glb(const Volume& volume, const StoredMesh& stored, AtomicFile& file);

/// Throws Error(not_georeferenced) and Error(height_unknown), with what to give. `sea_level_z_m`: z of the mean sea
/// level; without it 0 where the scene's heights are above a geoid.
void check_kml_place(const std::optional<Georeference>& georeference, std::optional<double> sea_level_z_m);
/// As doubles; the rounding is that of the file's decimals.
StoredMesh stored_for_kml(const Volume& volume);
/// For a volume that check_kml_place allows. KMZ is the same, zipped.
void write_kml(const Volume& volume, const StoredMesh& stored, std::optional<double> sea_level_z_m, AtomicFile& file);
void write_kmz(const Volume& volume, const StoredMesh& stored, std::optional<double> sea_level_z_m, AtomicFile& file);

/// A mesh as binary STL; `content` says in the header what it is.
void write_stl_mesh(const Mesh& mesh, std::string_view content, AtomicFile& file);

/// Throws Error(output) when a format that counts in 32 bits cannot hold that many. `limit` is the largest number
/// allowed.
void check_count(std::uint64_t count, std::uint64_t limit, const char* what, const char* format);

/// From the scene frame, z up, to axes with y up: (x, y, z) becomes (x, z, -y).
inline Vec3 to_y_up(const Vec3& v) { return {v.x(), v.z(), -v.y()}; }

/// Appends the shortest text that reads back as the same number: shortest(), without a string for each.
void append_exact(std::string& text, double number);

/// Appends a number's bytes, the lowest first, on any machine.
template <typename Number>
requires std::is_arithmetic_v<Number>
void append_little_endian(std::string& bytes, Number number) {
  using Bits =
      std::conditional_t<sizeof(Number) == 8, std::uint64_t,
                         std::conditional_t<sizeof(Number) == 4, std::uint32_t,
                                            std::conditional_t<sizeof(Number) == 2, std::uint16_t, std::uint8_t>>>;
  const auto bits = std::bit_cast<Bits>(number);
  for (unsigned i = 0; i < sizeof(Number); ++i) bytes.push_back(static_cast<char>(bits >> (8 * i) & 0xff));
}

}  // namespace vantage::internal::io
