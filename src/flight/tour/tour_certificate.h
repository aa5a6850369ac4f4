// The file by which a stranger's program checks a bound of a tour: docs/theory.md, "Tours". tools/check_tour.py is one.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "flight/tour/outer_region.h"
#include "flight/tour/tour_bound.h"

namespace vantage::internal::flight::tour {

/// The mesh of a region, not a point, as binary little-endian PLY of doubles; a comment says which kind of region it
/// is.
std::string region_ply(const OuterRegion& region);

/// JSON, one entry of the tree a line. `files`: of each region the name of its mesh, relative to the certificate's
/// folder; of points it is not read.
///   format      "vantage tour certificate 2"
///   scene_incomplete  MissionTour's; only where it says anything
///   bound_m     what is proved
///   turn_radius_m  of a fixed wing: the track over ground curves no tighter but at points. Else 0
///   closed      first, last: numbers of regions, or null
///   regions     name, kind, dwell_m; file and hash (docs/hashes.md, of a volume) of a mesh, "at" of a point
///   proof       "kind": "insertion", "root": regions, "tree": in preorder
///                 ["insert", region] ["cut", stop, [normal], offset] ["leaf", three whole numbers of each leg]
///                 ["empty"]
///               "kind": "pairs", "origin": subtracted from all points, "vectors": lists by rows of each pair j < i
///               three whole numbers, "tree": in preorder
///                 ["edge", i, j] ["leaf", which vectors, p by rows, d, [[s, regions of the set], ...]]
/// Whole numbers of vectors are in units of 2^-30.
std::string tour_certificate_text(const TourBound& bound, const std::vector<std::string>& files,
                                  const std::string& scene_incomplete);

/// The mesh of a region, beside the certificate: its stem with .region0.ply and so on. What is neither an ASCII letter
/// nor a digit, nor one of "_.-", becomes "_": checkers refuse other names, as they could lead elsewhere.
std::filesystem::path region_file(const std::filesystem::path& certificate, std::size_t region);

/// Writes FILE and, beside it, a mesh of each region, its region_file. All are written whole, or none. Throws
/// Error(output), and as check_derived_output for a mesh.
void write_tour_certificate(const TourBound& bound, const std::filesystem::path& file,
                            const std::string& scene_incomplete = "");

}  // namespace vantage::internal::flight::tour
