// Arrays that Python and C++ share.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <memory>
#include <span>
#include <vector>

#include "vantage/geometry.h"

namespace vantage::python {

namespace nb = nanobind;

/// What Python passes in: the package sees to type, shape and order before (_arrays.py).
using PointArray = nb::ndarray<const double, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using IndexArray = nb::ndarray<const std::uint32_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using FaceArray = nb::ndarray<const std::uint32_t, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;

std::vector<Vec3> points_of(const PointArray& array);
Mesh mesh_of(const PointArray& vertices, const FaceArray& faces);

/// What Python gets: read-only.
template <typename T, typename Shape>
using View = nb::ndarray<nb::numpy, const T, Shape>;
using PointView = View<double, nb::shape<-1, 3>>;
using FaceView = View<std::uint32_t, nb::shape<-1, 3>>;
template <typename T>
using ListView = View<T, nb::ndim<1>>;

/// For properties that return views: these keep alive what they need themselves.
inline constexpr auto kKept = nb::rv_policy::automatic;

/// An array of data that `keeper` keeps alive, also after the object that it was asked of.
template <typename Result, typename T, typename Keeper>
Result view_of(const T* data, std::initializer_list<std::size_t> shape, std::shared_ptr<Keeper> keeper) {
  auto* kept = new std::shared_ptr<Keeper>(std::move(keeper));
  const nb::capsule owner(kept, [](void* pointer) noexcept { delete static_cast<std::shared_ptr<Keeper>*>(pointer); });
  static const T kNothing{};  // numpy takes no null for an empty array
  return Result(data ? data : &kNothing, shape, owner);
}

template <typename Keeper>
PointView points_view(const std::vector<Vec3>& points, std::shared_ptr<Keeper> keeper) {
  return view_of<PointView>(points.empty() ? nullptr : points.front().data(), {points.size(), 3}, std::move(keeper));
}
template <typename Keeper>
FaceView faces_view(const std::vector<Triangle>& faces, std::shared_ptr<Keeper> keeper) {
  return view_of<FaceView>(faces.empty() ? nullptr : faces.front().data(), {faces.size(), 3}, std::move(keeper));
}
template <typename T, typename Keeper>
ListView<T> list_view(const std::vector<T>& values, std::shared_ptr<Keeper> keeper) {
  return view_of<ListView<T>>(values.data(), {values.size()}, std::move(keeper));
}

/// An array of its own.
template <typename T>
ListView<T> array_of(std::vector<T> values) {
  auto kept = std::make_shared<const std::vector<T>>(std::move(values));
  return list_view(*kept, kept);
}

inline std::vector<double> list_of(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace vantage::python
