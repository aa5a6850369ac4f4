// What tells a file that vantage wrote from others.
#pragma once

#include <filesystem>
#include <string_view>

namespace vantage::internal::io {

/// The first line of a table of volumes.
inline constexpr std::string_view kVolumeTableHeader =
    "target,outcome,reason,volume_m3,area_m2,facets,pieces,lift_m,seconds,file";

/// What a KML file of a volume begins with; the version, and words for a volume, stand behind it.
inline constexpr std::string_view kKmlStart = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!-- vantage ";

/// What certificates begin with, whatever their names; the version stands behind it.
inline constexpr std::string_view kCertificateStart = "{\"format\":\"vantage certificate ";
inline constexpr std::string_view kTourCertificateStart = "{\"format\":\"vantage tour certificate ";

/// Whether the file, which is there, is one that vantage wrote; false where it cannot be read.
bool is_own_file(const std::filesystem::path& file);

/// Whether `bytes` begin with `start`, a version, and words for a scene or a volume: what the writers of formats with
/// comments write first.
bool begins_as_own(std::string_view bytes, std::string_view start);

/// Whether vantage wrote a file of the format that begins so; for the table of formats.
bool is_own_ply(std::string_view bytes);
bool is_own_obj(std::string_view bytes);
bool is_own_stl(std::string_view bytes);
bool is_own_glb(std::string_view bytes);
bool is_own_kml(std::string_view bytes);
bool is_own_kmz(std::string_view bytes);

}  // namespace vantage::internal::io
