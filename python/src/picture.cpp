// Pictures of a mission and its volume.
#include "vantage/picture.h"

#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "arrays.h"
#include "bindings.h"
#include "calls.h"
#include "mission.h"
#include "volume.h"

namespace vantage::python {

using namespace nb::literals;

namespace {

struct AskedView {
  std::string kind;
  std::optional<double> azimuth_deg;
  double elevation_deg;
  std::vector<double> from;
};

PictureView picture_view(const AskedView& view) {
  PictureView result;
  result.azimuth_deg = view.azimuth_deg;
  result.elevation_deg = view.elevation_deg;
  if (view.kind == "top") {
    result.kind = PictureView::Kind::top;
  } else if (view.kind == "from") {
    if (view.from.size() != 3) {
      throw Error(ErrorCode::array_sizes_differ, "a place to look from has three coordinates", "view",
                  "pass (x, y, z)");
    }
    result.kind = PictureView::Kind::from;
    result.from = Vec3(view.from[0], view.from[1], view.from[2]);
  } else if (view.kind != "oblique") {
    throw Error(ErrorCode::unknown_choice, "there is no view '" + view.kind + "'", "view",
                "choose 'oblique', 'top' or a place (x, y, z)");
  }
  return result;
}

using Pixels = View<std::uint8_t, nb::shape<-1, -1, 4>>;

Pixels render(const PyMission& mission, const PyVolume* volume, const std::string& kind,
              std::optional<double> azimuth_deg, double elevation_deg, const std::vector<double>& from, int width,
              int height, const std::string& title, const std::string& subtitle, nb::object progress) {
  const PictureView view = picture_view({kind, azimuth_deg, elevation_deg, from});
  auto picture = std::make_shared<const Picture>(computed(std::move(progress), 0, [&](const Progress& told) {
    PictureRequest request;
    request.target = &mission->target;
    if (volume) request.volume = volume->volume.get();
    request.navigation = mission->navigation;
    request.view = view;
    request.width = width;
    request.height = height;
    request.title = title;
    request.subtitle = subtitle;
    return render_picture(mission->scene(), request, told);
  }));
  const auto rows = static_cast<std::size_t>(picture->height), columns = static_cast<std::size_t>(picture->width);
  return view_of<Pixels>(picture->rgba.data(), {rows, columns, std::size_t{4}}, picture);
}

void save_png(const nb::ndarray<const std::uint8_t, nb::shape<-1, -1, 4>, nb::c_contig, nb::device::cpu>& pixels,
              const std::filesystem::path& file) {
  Picture picture;
  picture.height = static_cast<int>(pixels.shape(0));
  picture.width = static_cast<int>(pixels.shape(1));
  picture.rgba.assign(pixels.data(), pixels.data() + pixels.size());
  const Released released;
  write_png(picture, file);
}

}  // namespace

void bind_picture(nb::module_& module) {
  module.def("render", &render, "mission"_a, "volume"_a.none(), "view"_a, "azimuth_deg"_a.none(), "elevation_deg"_a,
             "from_point"_a, "width"_a, "height"_a, "title"_a, "subtitle"_a, "progress"_a = nb::none());
  module.def("save_png", &save_png, "pixels"_a.noconvert(), "file"_a);
}

}  // namespace vantage::python
