// The section `spheres` of a mission file.
#pragma once

#include <array>
#include <string_view>
#include <type_traits>

#include "request/description.h"
#include "vantage/spheres.h"

namespace vantage::internal::request {

inline constexpr std::array kSphereKinds = {
    Choice<SpheresOptions::Sphere>{SpheresOptions::Sphere::conservative, "conservative"},
    Choice<SpheresOptions::Sphere>{SpheresOptions::Sphere::centers, "centers"},
};
inline constexpr std::array kSplits = {
    Choice<SpheresOptions::Split>{SpheresOptions::Split::euler, "euler"},
    Choice<SpheresOptions::Split>{SpheresOptions::Split::always, "always"},
};

template <>
inline constexpr std::string_view kSection<SpheresOptions> = "spheres";

template <typename Settings, typename Visit>
requires std::is_same_v<std::remove_const_t<Settings>, SpheresOptions>
void describe(Settings& settings, Visit& visit) {
  auto& [sphere, cubemap, resolution, merge, split, max_splits, min_edge_m, device, threads] = settings;
  static_cast<void>(threads);  // of a run, not of a mission

  visit.choice({.path = "sphere",
                .says = "`conservative`: each sphere is inside the region that its vertex sees; `centers`: texel "
                        "centres are connected, as in the paper",
                .form = "write conservative or centers"},
               sphere, kSphereKinds);
  visit.whole({"cubemap", "texels along the side of a face of the cube map"}, cubemap,
              {1, 8192, Unit::none, "give the texels along a face's side, such as 200"});
  visit.grid({.path = "resolution",
              .says = "instead of `cubemap`, the number of samples in longitude (3 or more) and in latitude (2 or "
                      "more), as in the paper",
              .without = "none",
              .form = "write the samples in longitude and latitude: [160, 80]"},
             resolution, {3, 32'768, Unit::none, "give the samples in longitude, such as 160"},
             {2, 32'768, Unit::none, "give the samples in latitude, such as 80"});
  visit.number({"merge",
                "facets of the cube map's grid are merged if that moves them by at most this part of their distance "
                "from the vertex (inwards with `conservative`)",
                "With 0 none are merged."},
               merge, {0, 0.05, Unit::none, "give the part of its distance that a facet may be off, such as 0.00025"},
               Only{});
  visit.choice({.path = "split",
                .says = "`euler`: an edge is halved while the intersection of the spheres at its ends is not a "
                        "topological sphere; `always`: `max_splits` times, whatever the test says",
                .form = "write euler or always"},
               split, kSplits);
  visit.whole({"max_splits", "how often an edge may be halved"}, max_splits,
              {0, 16, Unit::none, "give how often an edge may be halved, such as 6"});
  visit.number({"min_edge", "an edge is not halved into parts shorter than this"}, min_edge_m,
               {0, kLongest, Unit::metres, "give for example 0.5", "", Bounds::Ends::without_least}, Only{});
  visit.device({.path = "device",
                .says = "`auto`, `cpu`, `opengl`, `gpu`, or a number of `vantage devices`. `auto` falls back to the "
                        "CPU. With the others, a device that is missing is an error. `vantage compute --device` "
                        "overrides it",
                .without = "`auto`"},
               device);
}

}  // namespace vantage::internal::request
